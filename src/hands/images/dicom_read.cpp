// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "hands/images/dicom_compressed.h"
#include "hands/images/dicom_slice.h"
#include "hands/images/image_formats.h"
#include "hands/imaging/odd_slices.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/file.h"

namespace palmar::images {
namespace {

std::string listing(const std::vector<DicomStack>& stacks) {
  std::string text;
  for (const DicomStack& stack : stacks) {
    const DicomSeries& series = stack.series;
    text += fmt::format("\n  {} \"{}\", {} of {} x {}{}", series.number, series.description,
                        series.slices == 1 ? "1 slice" : fmt::format("{} slices", series.slices),
                        series.columns, series.rows,
                        series.refusal.empty() ? "" : " (no volume: " + series.refusal + ")");
  }
  return text;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

bool fits(const DicomSeries& series, const SeriesChoice& choice) {
  if (series.uid.empty()) return false;
  if (choice.number && *choice.number != series.number) return false;
  return choice.description.empty() ||
         lower(series.description).find(lower(choice.description)) != std::string::npos;
}

std::string text_of(const SeriesChoice& choice) {
  std::string text;
  if (choice.number) text = fmt::format(" with number {}", *choice.number);
  if (!choice.description.empty()) {
    text += fmt::format("{} with \"{}\" in its description", text.empty() ? "" : " and",
                        choice.description);
  }
  return text;
}

DicomStack& chosen(std::vector<DicomStack>& stacks, const std::string& folder,
                   const SeriesChoice& choice) {
  // A damaged file that doesn't say where it belongs may be a slice of any series.
  for (const DicomStack& stack : stacks) {
    if (stack.series.uid.empty()) {
      if (is_dicom_file(folder)) throw InputError(stack.series.refusal);
      throw InputError(
          fmt::format("{} (it may be a slice of the series: restore it, or move it out of {})",
                      stack.series.refusal, folder));
    }
  }
  const bool is_choice = choice.number || !choice.description.empty();
  std::vector<DicomStack*> candidates;
  for (DicomStack& stack : stacks) {
    if (fits(stack.series, choice)) candidates.push_back(&stack);
  }
  // Without a choice, what can't be meant (localisers) doesn't stand in the way.
  if (candidates.size() > 1) {
    std::vector<DicomStack*> volumes;
    for (DicomStack* stack : candidates) {
      if (stack->series.refusal.empty()) volumes.push_back(stack);
    }
    if (!volumes.empty()) candidates = volumes;
  }
  if (candidates.size() == 1) {
    const DicomSeries& series = candidates[0]->series;
    if (series.refusal.empty()) return *candidates[0];
    if (series.refusal.starts_with(folder + ":") ||
        series.refusal.starts_with(folder + " (frame")) {
      throw InputError(series.refusal);
    }
    throw InputError(fmt::format("{}: series {} \"{}\": {}", folder, series.number,
                                 series.description, series.refusal));
  }
  if (candidates.empty()) {
    throw InputError(
        fmt::format("{}: no series{}; there are:{}", folder, text_of(choice), listing(stacks)));
  }
  throw InputError(
      fmt::format("{}: several series{}; choose one by its number or a part of its "
                  "description:{}",
                  folder, is_choice ? " fit" + text_of(choice) : "", listing(stacks)));
}

/// What tells two images apart by what their files say: "; they differ in echo time (2 ms, 4 ms)".
std::string differences(const DicomSlice& a, const DicomSlice& b) {
  std::string text;
  for (const auto& [name, value] : a.kind) {
    const auto other = b.kind.find(name);
    if (other == b.kind.end() || other->second == value) continue;
    text += fmt::format("{} {} ({}, {})", text.empty() ? "; they differ in" : ",", name, value,
                        other->second);
  }
  return text.empty() ? text : text + ": an image of one of them alone is required";
}

/// Of slices at one position the first is kept; the others must show the same.
std::vector<DicomSlice> without_doubles(const DicomStack& stack, std::vector<std::string>& notes) {
  const auto is_double = [&](std::size_t s) {
    return s > 0 &&
           stack.slices[s].along_normal() - stack.slices[s - 1].along_normal() <= kSamePosition;
  };
  std::vector<DicomSlice> compared;
  for (std::size_t s = 0; s < stack.slices.size(); ++s) {
    if (is_double(s) || is_double(s + 1 < stack.slices.size() ? s + 1 : 0)) {
      compared.push_back(stack.slices[s]);
    }
  }
  const DicomPixels pixels(compared);
  std::vector<DicomSlice> kept;
  std::vector<std::string> doubles;
  for (const DicomSlice& slice : stack.slices) {
    if (kept.empty() || slice.along_normal() - kept.back().along_normal() > kSamePosition) {
      kept.push_back(slice);
      continue;
    }
    if (pixels.values(slice) != pixels.values(kept.back())) {
      throw InputError(fmt::format(
          "{} and {}: two different images at one position ({:.2f} mm along the slices' normal){}",
          kept.back().name(), slice.name(), slice.along_normal(), differences(kept.back(), slice)));
    }
    doubles.push_back(std::filesystem::path(slice.name()).filename().string());
  }
  if (!doubles.empty()) {
    notes.push_back(fmt::format(
        "{} left out that another repeats: {}{}",
        doubles.size() == 1 ? "1 slice was" : fmt::format("{} slices were", doubles.size()),
        doubles.front(), doubles.size() > 1 ? ", ..." : ""));
  }
  return kept;
}

double stored_value(const DicomSlice& slice, std::string_view bytes, std::size_t index) {
  std::uint32_t raw = 0;
  switch (slice.bits_allocated) {
    case 8:
      raw = static_cast<unsigned char>(bytes[index]);
      break;
    case 16:
      raw = formats::read_value<std::uint16_t>(bytes, 2 * index);
      break;
    default:
      raw = formats::read_value<std::uint32_t>(bytes, 4 * index);
  }
  raw >>= slice.high_bit + 1 - slice.bits_stored;
  const std::uint64_t range = std::uint64_t{1} << slice.bits_stored;
  raw &= static_cast<std::uint32_t>(range - 1);
  if (slice.is_signed && (raw & (range >> 1)) != 0) {
    return static_cast<double>(raw) - static_cast<double>(range);
  }
  return static_cast<double>(raw);
}

}  // namespace

DicomPixels::DicomPixels(const std::vector<DicomSlice>& slices, const Progress& progress) {
  std::vector<DicomSlice> packed;
  double packed_pixels = 0.0;
  for (const DicomSlice& slice : slices) {
    check_image_size(slice.path, slice.columns, slice.rows, slice.frames);
    if (slice.is_encapsulated) {
      packed.push_back(slice);
      packed_pixels += static_cast<double>(slice.columns) * slice.rows;
      check_image_size(slice.path, packed_pixels, 1.0, 1.0);
    } else if (slice.frames > 1 && !file_.contains(slice.path)) {
      file_[slice.path] = formats::read_file(slice.path, kMaxImageBytes);
    }
  }
  if (!packed.empty()) unpacked_ = unpacked_pixels(packed, progress);
}

std::vector<float> DicomPixels::values(const DicomSlice& slice) const {
  const std::size_t count =
      static_cast<std::size_t>(slice.rows) * static_cast<std::size_t>(slice.columns);
  const std::size_t size = count * static_cast<std::size_t>(slice.bits_allocated / 8);
  std::string own;
  std::string_view bytes;
  std::uint64_t offset = 0;
  if (slice.is_encapsulated) {
    bytes = unpacked_.at(slice.name());
  } else {
    offset = slice.pixel_offset + static_cast<std::uint64_t>(slice.frame) * size;
    if (slice.frames > 1) {
      bytes = file_.at(slice.path);
    } else {
      bytes = own = formats::read_file(slice.path, kMaxImageBytes);
    }
  }
  if (offset > bytes.size() || bytes.size() - offset < size) {
    throw InputError(slice.path + ": changed while it was read");
  }
  bytes.remove_prefix(static_cast<std::size_t>(offset));
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(stored_value(slice, bytes, i) * slice.slope + slice.intercept);
  }
  return values;
}

ImageFile read_dicom(const std::string& path, const SeriesChoice& choice,
                     const Progress& progress) {
  std::vector<DicomStack> stacks = find_dicom_stacks(path, {});
  const DicomStack& stack = chosen(stacks, path, choice);
  ImageFile file;
  file.description = stack.series.description;
  file.laterality = stack.series.laterality;
  file.fat_shift = stack.slices.front().fat_shift;
  file.notes = stack.notes;
  const std::vector<DicomSlice> slices = without_doubles(stack, file.notes);
  const DicomSlice& first = slices.front();
  check_image_size(path, first.columns, first.rows, static_cast<double>(slices.size()));

  imaging::VolumeGrid& grid = file.image.grid;
  grid.size = {first.columns, first.rows, static_cast<int>(slices.size())};
  const double last = slices.back().along_normal() - first.along_normal();
  grid.spacing =
      Vec3(first.pixel_width, first.pixel_height, last / static_cast<double>(slices.size() - 1));
  grid.axes << first.row, first.column, first.row.cross(first.column);
  grid.origin = first.position;
  const std::size_t plane = grid.at(0, 0, 1);
  // Unpacked first: a small file that claims an enormous image is refused before memory is taken.
  const DicomPixels stored(slices, progress);
  file.image.value.resize(grid.count());
  constexpr std::size_t kAtOnce = 16;  // slices between two looks at the user's wish to stop
  for (std::size_t start = 0; start < slices.size(); start += kAtOnce) {
    progress.update(static_cast<double>(start) / static_cast<double>(slices.size()),
                    "reading " + path);
    const std::size_t count = std::min(kAtOnce, slices.size() - start);
    parallel_for(static_cast<int>(count), [&](int i) {
      const std::size_t s = start + static_cast<std::size_t>(i);
      const std::vector<float> pixels = stored.values(slices[s]);
      std::copy(pixels.begin(), pixels.end(),
                file.image.value.begin() + static_cast<std::ptrdiff_t>(s * plane));
    });
  }
  for (const imaging::OddSlice& odd : imaging::odd_slices(file.image)) {
    file.odd_slices.push_back(
        odd_slice_text(slices[static_cast<std::size_t>(odd.index)].name(), odd));
  }
  return file;
}

}  // namespace palmar::images
