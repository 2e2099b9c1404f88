// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "hands/images/dicom_compressed.h"
#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_slice.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::images {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNamedPositions = 12;  // of missing slices, in a message
constexpr double kSameDirection = 1e-3;      // sine of the angle between slices' axes

std::string file_name(const DicomSlice& slice) {
  return fs::path(slice.name()).filename().string();
}

std::string count_text(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

bool same_directions(const DicomSlice& a, const DicomSlice& b) {
  return (a.row - b.row).norm() < kSameDirection && (a.column - b.column).norm() < kSameDirection;
}

/// What single slices or their mixture forbid.
std::string mixture_problem(const std::vector<DicomSlice>& slices) {
  const auto damaged = std::find_if(slices.begin(), slices.end(),
                                    [](const DicomSlice& slice) { return !slice.damage.empty(); });
  if (damaged != slices.end()) {
    const auto more = std::count_if(damaged + 1, slices.end(),
                                    [](const DicomSlice& slice) { return !slice.damage.empty(); });
    return fmt::format("{}: {}{}", damaged->name(), damaged->damage,
                       more > 0 ? fmt::format(" ({} more {} have errors)", more,
                                              damaged->frames > 1 ? "frames" : "files")
                                : "");
  }
  for (const DicomSlice& slice : slices) {
    if (slice.samples != 1 || slice.photometric == "RGB" ||
        slice.photometric.starts_with("PALETTE") || slice.photometric.starts_with("YBR")) {
      return fmt::format("{}: is a colour image ({}); grey values are required", slice.path,
                         slice.photometric);
    }
    const std::string unread =
        slice.is_encapsulated ? unread_compression(slice.transfer_syntax) : std::string();
    if (!unread.empty()) {
      return fmt::format("{}: is compressed ({}), which isn't read", slice.path, unread);
    }
  }
  const DicomSlice& first = slices.front();
  std::vector<const DicomSlice*> directions;
  for (const DicomSlice& slice : slices) {
    if (std::none_of(directions.begin(), directions.end(),
                     [&](const DicomSlice* other) { return same_directions(*other, slice); })) {
      directions.push_back(&slice);
    }
  }
  if (directions.size() > 1) {
    return fmt::format("slices are in {} directions, as those of a localiser ({} and {})",
                       directions.size(), file_name(*directions[0]), file_name(*directions[1]));
  }
  for (const DicomSlice& slice : slices) {
    if (slice.rows != first.rows || slice.columns != first.columns) {
      return fmt::format("images of several sizes are mixed: {} has {} x {} pixels, {} has {} x {}",
                         file_name(first), first.columns, first.rows, file_name(slice),
                         slice.columns, slice.rows);
    }
    if (std::abs(slice.pixel_width - first.pixel_width) > 1e-3 * first.pixel_width ||
        std::abs(slice.pixel_height - first.pixel_height) > 1e-3 * first.pixel_height) {
      return fmt::format("images of several pixel sizes are mixed: {} has {:g} mm, {} has {:g} mm",
                         file_name(first), first.pixel_width, file_name(slice), slice.pixel_width);
    }
    if (slice.frame_of_reference != first.frame_of_reference) {
      return fmt::format("slices of several frames of reference are mixed ({} and {})",
                         file_name(first), file_name(slice));
    }
  }
  if (first.image_type.find("LOCALIZER") != std::string::npos) {
    return "a localiser (Image Type says so)";
  }
  return {};
}

/// First slice at each position, in order.
std::vector<const DicomSlice*> positions_of(const std::vector<DicomSlice>& slices) {
  std::vector<const DicomSlice*> result;
  for (const DicomSlice& slice : slices) {
    if (result.empty() || slice.along_normal() - result.back()->along_normal() > kSamePosition) {
      result.push_back(&slice);
    }
  }
  return result;
}

/// Slices that aren't there, where distances are multiples of the smallest.
std::string missing_slices(const std::vector<const DicomSlice*>& at, double step) {
  std::vector<double> missing;
  const DicomSlice* before = nullptr;
  const DicomSlice* after = nullptr;
  std::size_t count = 0;
  for (std::size_t s = 1; s < at.size(); ++s) {
    const double distance = at[s]->along_normal() - at[s - 1]->along_normal();
    const double steps = std::round(distance / step);
    if (std::abs(distance - steps * step) > 0.1 * step) return {};
    if (steps < 1.5) continue;
    if (before == nullptr) {
      before = at[s - 1];
      after = at[s];
    }
    count += static_cast<std::size_t>(std::min(steps - 1.0, 1e6));
    for (double k = 1.0; k < steps && missing.size() <= kNamedPositions; ++k) {
      missing.push_back(at[s - 1]->along_normal() + k * step);
    }
  }
  if (count == 0) return {};
  std::string places;
  for (std::size_t k = 0; k < std::min(missing.size(), kNamedPositions); ++k) {
    places += fmt::format("{}{:.2f}", k > 0 ? ", " : "", missing[k]);
  }
  return fmt::format(
      "{} missing, at {}{} mm along the slices' normal (the first behind {} at {:.2f} mm, "
      "before {} at {:.2f} mm; slices are {:.3g} mm apart)",
      count_text(count, "slice is", "slices are"), places,
      missing.size() > kNamedPositions ? ", ..." : "", file_name(*before), before->along_normal(),
      file_name(*after), after->along_normal(), step);
}

/// What the positions forbid.
std::string position_problem(const std::vector<DicomSlice>& slices) {
  const std::vector<const DicomSlice*> at = positions_of(slices);
  if (at.size() < 2) {
    return slices.size() > 1 ? "all slices are at one position; a volume needs two at least"
                             : "has one slice; a volume needs two at least";
  }
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  std::size_t near = 1, far = 1;
  for (std::size_t s = 1; s < at.size(); ++s) {
    const double distance = at[s]->along_normal() - at[s - 1]->along_normal();
    if (distance < smallest) smallest = distance, near = s;
    if (distance > largest) largest = distance, far = s;
  }
  const double step =
      (at.back()->along_normal() - at.front()->along_normal()) / static_cast<double>(at.size() - 1);
  const Vec3 normal = at[0]->row.cross(at[0]->column);
  const double allowed = std::max(0.02, 0.05 * step);  // mm; half of what thin slices show
  for (std::size_t s = 0; s < at.size(); ++s) {
    const Vec3 offset = at[s]->position - at[0]->position;
    const double along = normal.dot(offset);
    if (std::abs(along - static_cast<double>(s) * step) > allowed) {
      const std::string missing = missing_slices(at, smallest);
      if (!missing.empty()) return missing;
      return fmt::format(
          "slices are unevenly spaced: {:.3g} mm between {} and {}, {:.3g} mm between {} and {}",
          smallest, file_name(*at[near - 1]), file_name(*at[near]), largest,
          file_name(*at[far - 1]), file_name(*at[far]));
    }
    const double sideways = (offset - along * normal).norm();
    if (sideways > 0.1) {  // mm; small against a voxel
      return fmt::format(
          "axes aren't square: slices are shifted sideways, {} by {:.2f} mm against {}",
          file_name(*at[s]), sideways, file_name(*at[0]));
    }
  }
  return {};
}

void add_notes(DicomStack& stack) {
  const DicomSlice& first = stack.slices.front();
  const auto at = positions_of(stack.slices);
  const double step =
      (at.back()->along_normal() - at.front()->along_normal()) / static_cast<double>(at.size() - 1);
  if (first.has_assumed_order) {
    stack.notes.push_back(fmt::format(
        "{} says where its first frame lies, not on which side of it the others do: they are taken "
        "to follow along the normal, {:g} mm apart (Spacing Between Slices). If they don't, the "
        "image is mirrored and shows the other hand",
        fs::path(first.path).filename().string(), std::round(step * 1e4) / 1e4));
  }
  if (first.thickness && *first.thickness > 0.0 &&
      std::abs(*first.thickness - step) > 0.02 * step) {
    stack.notes.push_back(
        fmt::format("slices {:g} mm thick are {:g} mm apart (from their positions)",
                    *first.thickness, std::round(step * 1e4) / 1e4));
  }
  if (first.images_in_acquisition > static_cast<int>(at.size())) {
    stack.notes.push_back(fmt::format(
        "the series says it has {} images, {} are there: slices at its ends may be missing",
        first.images_in_acquisition, at.size()));
  }
  if (first.photometric == "MONOCHROME1") {
    stack.notes.push_back("the series asks to be shown inverted; values are taken as stored");
  }
  if (std::any_of(stack.slices.begin(), stack.slices.end(),
                  [](const DicomSlice& slice) { return slice.is_lossy; })) {
    stack.notes.push_back(
        "the images were compressed with loss: fine differences of intensity are gone");
  }
  std::set<std::string> sides;
  for (const DicomSlice& slice : stack.slices) sides.insert(slice.laterality);
  if (sides.size() > 1) {
    stack.notes.push_back("slices contradict each other on the body's side (Laterality)");
    stack.series.laterality.clear();
  }
}

/// Files below a folder, by name.
std::vector<fs::path> files_below(const std::string& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) throw InputError(folder + ": no such folder");
  if (!fs::is_directory(status)) {
    throw InputError(folder +
                     ": is no DICOM file; a folder of them, or one of several frames, is required");
  }
  std::vector<fs::path> files;
  fs::recursive_directory_iterator entries(folder, fs::directory_options::skip_permission_denied,
                                           error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    std::error_code ignored;
    if (entries->is_regular_file(ignored)) files.push_back(entries->path());
  }
  if (error) throw InputError(folder + ": can't be looked through: " + error.message());
  if (files.empty()) throw InputError(folder + ": is empty; DICOM files are required");
  std::sort(files.begin(), files.end());
  return files;
}

std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return ending;
}

/// A file that isn't DICOM but is named like one: empty, or its beginning was overwritten.
DicomSlice not_dicom(const fs::path& path) {
  DicomSlice slice;
  slice.path = path.string();
  std::error_code ignored;
  slice.damage = fs::file_size(path, ignored) == 0 ? "is empty (0 bytes)"
                                                   : "doesn't begin as a DICOM file does";
  return slice;
}

void require_uid(DicomSeries& series) {
  if (!series.uid.empty() || !series.refusal.empty()) return;
  series.refusal = series.files.front() + ": has no Series Instance UID (0020,000E)";
}

/// One file with all its frames.
DicomStack stack_of_file(const std::string& path) {
  std::vector<DicomSlice> slices = read_dicom_headers(path);
  if (slices.empty()) throw InputError(path + ": is an index of DICOM files (DICOMDIR), no image");
  const bool is_slice =
      slices.size() == 1 && slices.front().frames == 1 && slices.front().damage.empty();
  const int parts = slices.front().parts;
  DicomStack stack = order_slices(std::move(slices));
  if (is_slice) {
    stack.series.refusal =
        path + ": is one DICOM file of one slice; the folder with its series is required";
  } else if (parts > 1 && stack.series.refusal.empty()) {
    stack.series.refusal = fmt::format(
        "{}: is one of {} files of one image (In-concatenation Total Number (0020,9163)); the "
        "folder "
        "with all of them is required",
        path, parts);
  }
  require_uid(stack.series);
  return stack;
}

}  // namespace

DicomStack order_slices(std::vector<DicomSlice> slices) {
  DicomStack stack;
  DicomSeries& series = stack.series;
  series.refusal = mixture_problem(slices);
  // By name within one position, so that the order of the directory doesn't matter.
  std::sort(slices.begin(), slices.end(), [](const DicomSlice& a, const DicomSlice& b) {
    return std::tie(a.path, a.frame) < std::tie(b.path, b.frame);
  });
  if (series.refusal.empty()) {
    // One axis for all: a slice's own rounded axes would shift far positions.
    const Vec3 normal = slices.front().row.cross(slices.front().column);
    for (DicomSlice& slice : slices) {
      slice.row = slices.front().row;
      slice.column = slices.front().column;
    }
    std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
      return normal.dot(a.position) < normal.dot(b.position);
    });
    series.refusal = position_problem(slices);
  }
  const DicomSlice& first = slices.front();
  series.uid = first.series_uid;
  series.number = first.series_number;
  series.description = first.description;
  series.modality = first.modality;
  series.laterality = first.laterality;
  series.columns = first.columns;
  series.rows = first.rows;
  series.slices = static_cast<int>(slices.size());
  for (const DicomSlice& slice : slices) {
    // A multi-frame file once.
    if (slice.frames <= 1 ||
        std::find(series.files.begin(), series.files.end(), slice.path) == series.files.end()) {
      series.files.push_back(slice.path);
    }
  }
  stack.slices = std::move(slices);
  if (series.refusal.empty()) add_notes(stack);
  return stack;
}

std::vector<DicomStack> find_dicom_stacks(const std::string& folder, const Progress& progress) {
  if (is_dicom_file(folder)) return {stack_of_file(folder)};
  const std::vector<fs::path> files = files_below(folder);
  std::map<std::string, std::vector<DicomSlice>> by_uid;
  std::vector<fs::path> others;
  std::set<std::string> endings = {".dcm", ".ima"};
  for (std::size_t f = 0; f < files.size(); ++f) {
    progress.update(static_cast<double>(f) / static_cast<double>(files.size()),
                    "looking through " + folder);
    std::error_code ignored;
    std::vector<DicomSlice> slices;
    if (fs::file_size(files[f], ignored) > 0) slices = read_dicom_headers(files[f].string());
    if (slices.empty()) {
      others.push_back(files[f]);
      continue;
    }
    if (const std::string ending = ending_of(files[f]); !ending.empty()) endings.insert(ending);
    std::vector<DicomSlice>& all = by_uid[slices.front().series_uid];
    all.insert(all.end(), slices.begin(), slices.end());
  }
  for (const fs::path& path : others) {
    if (endings.contains(ending_of(path))) by_uid[""].push_back(not_dicom(path));
  }
  if (by_uid.empty()) {
    throw InputError(fmt::format("{}: none of its {} is DICOM", folder,
                                 count_text(files.size(), "file", "files")));
  }
  std::vector<DicomStack> stacks;
  for (auto& [uid, slices] : by_uid) {
    stacks.push_back(order_slices(std::move(slices)));
    if (uid.empty()) require_uid(stacks.back().series);
  }
  std::stable_sort(stacks.begin(), stacks.end(), [](const DicomStack& a, const DicomStack& b) {
    return a.series.number < b.series.number;
  });
  return stacks;
}

std::vector<DicomSeries> find_dicom_series(const std::string& path) {
  std::vector<DicomSeries> result;
  for (DicomStack& stack : find_dicom_stacks(path, {})) result.push_back(std::move(stack.series));
  return result;
}

bool is_dicom_file(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && looks_like_dicom(formats::read_ends(path, 512).head);
}

}  // namespace palmar::images
