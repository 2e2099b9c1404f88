// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/scan_selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "palmar/core/error.h"

namespace palmar::person_workflow {
namespace {

namespace fs = std::filesystem;

struct Assignment {
  std::string which, text;  ///< "3", "3=thumb_flexion"
  hand::ScanPosture posture{};
  bool is_used = false;
};

std::vector<Assignment> assignments_of(const std::vector<SeriesPosture>& assigned) {
  std::vector<Assignment> all;
  for (const SeriesPosture& one : assigned) {
    all.push_back({one.which, one.which + "=" + std::string(name_of(one.posture)), one.posture});
  }
  return all;
}

/// One image that may show a posture.
struct Candidate {
  SelectedScan scan;
  std::optional<int> number;
  std::string description, folder;  ///< name of the folder that its files are in
  std::string refusal;              ///< why it can't be used; empty if it can
};

std::string title_of(const images::DicomSeries& series, const std::string& path) {
  return fmt::format("series {} \"{}\" of {}", series.number, series.description, path);
}

/// The series of a folder, or of one DICOM file.
void add_series(const std::string& path, std::vector<Candidate>& candidates) {
  for (const images::DicomSeries& series : images::find_dicom_series(path)) {
    Candidate one;
    one.refusal = series.refusal;
    one.scan.files = series.files;
    one.scan.title = title_of(series, path);
    one.number = series.number;
    one.description = series.description;
    one.folder = fs::path(series.files.front()).parent_path().filename().string();
    if (series.files.size() == 1) {
      one.scan.path = series.files.front();  // all slices are frames of one file
    } else {
      // A folder that holds this series alone is read as it is; else the number says which.
      one.scan.path = fs::path(series.files.front()).parent_path().string();
      one.scan.choice.number = series.number;
    }
    candidates.push_back(std::move(one));
  }
}

Candidate file_candidate(const std::string& path) {
  Candidate one;
  one.scan.path = path;
  one.scan.title = path;
  one.scan.files = {path};
  one.description = fs::path(path).filename().string();
  one.folder = fs::path(path).parent_path().filename().string();
  return one;
}

/// Folders of surfaces: `path` itself or those in it.
std::vector<fs::path> surface_folders(const fs::path& path) {
  std::vector<fs::path> found;
  if (fs::exists(path / "scan.json") && fs::exists(path / "skin.ply")) return {path};
  for (const auto& entry : fs::directory_iterator(path)) {
    if (fs::exists(entry.path() / "scan.json") && fs::exists(entry.path() / "skin.ply")) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

Candidate surfaces_candidate(const fs::path& path) {
  Candidate one = file_candidate(path.string());
  one.scan.title = "surfaces in " + path.string();
  one.scan.has_surfaces = true;
  return one;
}

bool is_meant(const Assignment& assignment, const Candidate& candidate) {
  if (candidate.number && assignment.which == std::to_string(*candidate.number)) return true;
  const bool is_number = std::all_of(assignment.which.begin(), assignment.which.end(),
                                     [](char c) { return c >= '0' && c <= '9'; });
  return !is_number && candidate.description.find(assignment.which) != std::string::npos;
}

std::optional<hand::ScanPosture> posture_of(const Candidate& candidate,
                                            std::vector<Assignment>& assignments) {
  const Assignment* first = nullptr;
  for (Assignment& assignment : assignments) {
    if (!is_meant(assignment, candidate)) continue;
    if (first != nullptr && first->posture != assignment.posture) {
      throw UsageError("setting \"series\" " + first->text + " and setting \"series\" " +
                       assignment.text + " both fit " + candidate.scan.title);
    }
    assignment.is_used = true;
    first = &assignment;
  }
  if (first != nullptr) return first->posture;
  if (const auto posture = hand::scan_posture_in(candidate.description)) return posture;
  return hand::scan_posture_in(candidate.folder);
}

std::string listed(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const Candidate& one : candidates) text += "\n  " + one.scan.title;
  return text;
}

/// Series that can't be used: one that should show a posture is an error, as the hand would lack
/// what it shows; a localiser, or a second series of a posture that there is, is passed over.
void pass_over(const std::string& path, const std::vector<Candidate>& refused,
               const std::map<hand::ScanPosture, Candidate>& found, bool has_others,
               std::vector<Assignment>& assignments, std::vector<std::string>& notes) {
  std::string damaged;
  for (const Candidate& one : refused) {
    const auto posture = posture_of(one, assignments);
    if (!posture || found.contains(*posture)) {
      notes.push_back(one.scan.title + " is passed over: " + one.refusal);
      continue;
    }
    damaged += (damaged.empty() ? "" : "\n") + one.scan.title + " can't be used: " + one.refusal +
               (*posture == hand::ScanPosture::kReference
                    ? "; the reference is needed"
                    : "; restore it, or make the hand without it by setting \"skip\" " +
                          std::string(name_of(*posture)));
  }
  if (!damaged.empty()) throw InputError(damaged);
  if (found.empty() && !has_others) {
    std::string why;
    for (const std::string& note : notes) why += "\n  " + note;
    throw InputError(path + ": holds no image that can be used" + why);
  }
}

}  // namespace

ScanSelection select_scans(const std::vector<std::string>& paths,
                           const std::vector<SeriesPosture>& assigned,
                           const std::vector<hand::ScanPosture>& skipped) {
  std::vector<Assignment> assignments = assignments_of(assigned);

  ScanSelection selection;
  std::vector<Candidate> candidates;
  for (const std::string& path : paths) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) throw InputError(path + ": there is no such file or folder");
    if (images::is_dicom_file(path)) {
      add_series(path, candidates);
      continue;
    }
    if (!fs::is_directory(path, ignored)) {
      candidates.push_back(file_candidate(path));
      continue;
    }
    const std::vector<fs::path> surfaces = surface_folders(path);
    for (const fs::path& folder : surfaces) candidates.push_back(surfaces_candidate(folder));
    if (surfaces.empty()) add_series(path, candidates);
  }
  std::map<hand::ScanPosture, Candidate> found;
  std::vector<Candidate> unnamed, refused;
  for (const Candidate& candidate : candidates) {
    const auto posture = posture_of(candidate, assignments);
    if (posture && std::find(skipped.begin(), skipped.end(), *posture) != skipped.end()) {
      continue;
    }
    if (!candidate.refusal.empty()) {
      refused.push_back(candidate);
      continue;
    }
    if (!posture) {
      unnamed.push_back(candidate);
      continue;
    }
    const auto [at, is_new] = found.emplace(*posture, candidate);
    if (!is_new) {
      throw UsageError(
          at->second.scan.title + " and " + candidate.scan.title + " both show " +
          std::string(name_of(*posture)) +
          "; say with setting \"series\" NUMBER=POSTURE what the other one is, or give the "
          "folder of one alone");
    }
  }
  for (const Assignment& assignment : assignments) {
    if (assignment.is_used) continue;
    throw UsageError("setting \"series\" " + assignment.text + " fits no series; there are" +
                     listed(candidates));
  }
  pass_over(paths.front(), refused, found, !unnamed.empty(), assignments, selection.notes);
  if (found.count(hand::ScanPosture::kReference) == 0) {
    if (!found.empty() || unnamed.size() != 1) {
      throw UsageError(
          "none of the series is the reference posture; say which with setting \"series\" "
          "NUMBER=reference. There are" +
          listed(candidates));
    }
    found.emplace(hand::ScanPosture::kReference, unnamed.front());
    selection.notes.push_back(unnamed.front().scan.title + " is taken as the reference posture");
    unnamed.clear();
  }
  for (const Candidate& one : unnamed) {
    selection.notes.push_back(
        one.scan.title +
        " names no posture and is ignored (setting \"series\" NUMBER=POSTURE says what it shows)");
  }
  for (auto& [posture, candidate] : found) {
    candidate.scan.posture = posture;
    selection.scans.push_back(std::move(candidate.scan));
  }
  return selection;
}

}  // namespace palmar::person_workflow
