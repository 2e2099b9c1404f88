// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_from_photos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "hands/person_workflow/steps/hand_output.h"
#include "hands/person_workflow/steps/photo_lenses.h"
#include "hands/person_workflow/steps/photo_mesh.h"
#include "hands/person_workflow/steps/posture_files.h"
#include "hands/person_workflow/steps/scan_surface.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

namespace fs = std::filesystem;

constexpr double kLenses = 0.05, kMeshes = 0.8;  // shares of the whole that these end at

bool names_calibration(const fs::path& path) {
  const std::string name = lower_case(path.filename().string());
  return name.starts_with("calib") || name.starts_with("lens");
}

/// Folders of photographs: those given; of one that holds folders instead of photographs, these.
/// One called calibration is where lenses come from if nothing else is said.
std::vector<std::string> folders_in(const std::vector<std::string>& paths, std::string& lenses) {
  std::vector<std::string> folders;
  for (const std::string& path : paths) {
    // "reference/" names what "reference" does.
    fs::path folder = fs::path(path).lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();
    if (!fs::is_directory(folder)) {
      throw InputError(path + ": a folder of photographs is expected");
    }
    std::vector<fs::path> inner;
    if (!person_records::holds_photographs(folder)) {
      for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_directory() && person_records::holds_photographs(entry.path()))
          inner.push_back(entry.path());
      }
      std::sort(inner.begin(), inner.end());
    }
    if (inner.empty()) inner.push_back(folder);
    for (const fs::path& one : inner) {
      if (inner.size() > 1 && names_calibration(one)) {
        if (lenses.empty()) lenses = one.string();
      } else {
        folders.push_back(one.string());
      }
    }
  }
  return folders;
}

/// A set of photographs as the hand's notes describe it.
std::vector<std::string> notes_of(const std::string& folder, const PhotoMeshReport& report) {
  std::vector<std::string> notes = {
      fmt::format("{}: {} photographs, {:.0f} % of the surface measured", folder,
                  report.photographs, 100.0 * report.measured_share)};
  for (const std::string& warning : report.warnings) notes.push_back(folder + ": " + warning);
  return notes;
}

using MeshPlans = std::map<hand::ScanPosture, PhotoMeshPlan>;

/// What is there and what has to be made, and how long that takes.
MeshPlans plan_meshes(const HandFromPhotosRequest& request, const fs::path& work,
                      const std::map<hand::ScanPosture, std::string>& folders,
                      const std::optional<person_records::PhotoLenses>& lenses) {
  const auto on_note = [&](const std::string& text) { workflow::note_to(request.note, text); };
  MeshPlans plans;
  double seconds = 0.0;
  for (const auto& [posture, folder] : folders) {
    PhotoMeshPlan& plan = plans[posture];
    plan = plan_photo_mesh(folder, work / (std::string(name_of(posture)) + ".ply"), lenses,
                           request.mesh);
    seconds += plan.seconds;
    on_note(fmt::format("{}: {} photographs in {}{}", name_of(posture), plan.set.photographs.size(),
                        folder, plan.kept ? ", whose mesh is there already" : ""));
  }
  constexpr double kSecondsPerScan = 20.0;  // of one core, to make the hand
  on_note(fmt::format(
      "this takes about {:.0f} s",
      seconds + kSecondsPerScan * static_cast<double>(plans.size()) / std::max(1, thread_count())));
  return plans;
}

}  // namespace

void HandFromPhotosRequest::check() const {
  hand.check();
  mesh.check();
  if (folders.empty()) {
    throw UsageError("setting \"folders\": there are none; photographs of the hand are required");
  }
}

ScanHandOutcome make_hand_from_photos(const HandFromPhotosRequest& request,
                                      const Progress& progress) {
  request.check();
  workflow::load_hand(request.hand.model);
  std::string lens_path = request.mesh.lenses;
  const std::vector<std::string> paths = folders_in(request.folders, lens_path);
  const auto folders = files_by_posture(paths, request.posture, "folder");
  const std::string work =
      request.hand.work.empty() ? beside_hand(request.hand.out, ".photos") : request.hand.work;
  const WorkFolder work_folder(work);
  request.hand.check_files();

  std::optional<person_records::PhotoLenses> lenses;
  if (!lens_path.empty()) {
    lenses = lenses_of(lens_path, part_of(progress, 0.0, kLenses, "lenses"));
    formats::write_file(fs::path(work) / "lenses.json", person_records::format_lenses(*lenses));
  }
  const MeshPlans plans = plan_meshes(request, work, folders, lenses);
  const auto to_make = static_cast<double>(
      std::count_if(plans.begin(), plans.end(), [](const auto& one) { return !one.second.kept; }));

  std::map<hand::ScanPosture, person_report::ShownScan> shown;
  std::vector<std::string> notes;
  double begin = kLenses;
  const double end_of_meshes = to_make > 0.0 ? kMeshes : 2.0 * kLenses;
  for (const auto& [posture, plan] : plans) {
    const double end =
        plan.kept || to_make == 0.0 ? begin : begin + (end_of_meshes - kLenses) / to_make;
    const PhotoMeshReport report = make_planned_mesh(
        plan, lenses, request.mesh, part_of(progress, begin, end, std::string(name_of(posture))));
    begin = end;
    const std::vector<std::string> reported = notes_of(plan.folder, report);
    notes.insert(notes.end(), reported.begin(), reported.end());
    const std::string file = plan.mesh.string();
    ReadSurface read = read_scan_surface(file, geometry::LengthUnit::kMillimetre);
    notes.insert(notes.end(), read.notes.begin(), read.notes.end());
    capture::SkinMarks marks = capture::find_skin_marks(read.surface, file, request.hand.inks);
    for (const std::string& text : marks.notes) notes.push_back(file + ": " + text);
    shown[posture] = {file, std::move(read.surface), std::move(marks)};
  }
  return make_hand_of_surfaces(request.hand, work, shown, notes,
                               part_of(progress, end_of_meshes, 1.0));
}

}  // namespace palmar::person_workflow
