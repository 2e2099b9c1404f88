// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_from_scan.h"

#include "hands/person_workflow/steps/hand_output.h"
#include "hands/person_workflow/steps/posture_files.h"
#include "hands/person_workflow/steps/scan_surface.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/records/person/person_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {

void HandFromScanRequest::check() const {
  hand.check();
  if (scans.empty()) {
    throw UsageError("setting \"scans\": there are none; a scan of the hand is required");
  }
  const auto files = files_by_posture(scans, posture, "scan");
  for (const auto& [shown, path] : files) refuse_overwriting(path, hand.out, "scan");
}

ScanHandOutcome make_hand_from_scan(const HandFromScanRequest& request, const Progress& progress) {
  request.check();
  const auto files = files_by_posture(request.scans, request.posture, "scan");
  const std::string work =
      request.hand.work.empty() ? beside_hand(request.hand.out, ".scan") : request.hand.work;
  request.hand.check_files();
  workflow::load_hand(request.hand.model);

  const records::PersonFile known =
      request.hand.known.empty() ? records::PersonFile{} : records::read_person(request.hand.known);
  const std::optional<Vec3> pick_crease =
      request.pick_crease ? request.pick_crease : known.pick_crease;
  const std::optional<Vec3> pick_dot = request.pick_dot ? request.pick_dot : known.pick_dot;
  capture::SkinMarkOptions inks = request.hand.inks;
  std::map<hand::ScanPosture, person_report::ShownScan> shown;
  std::vector<std::string> notes;
  std::optional<geometry::LengthUnit> unit = request.unit;
  for (const auto& [posture, path] : files) {
    const double step = 0.15 / static_cast<double>(files.size());
    progress.update(step * static_cast<double>(shown.size()), "reading " + path);
    // Scans of one hand come from one program: the reference scan's unit holds for all.
    ReadSurface read = read_scan_surface(path, unit);
    if (!unit) unit = read.unit;
    notes.insert(notes.end(), read.notes.begin(), read.notes.end());
    if (posture == hand::ScanPosture::kReference) {
      if (pick_crease) inks.crease = colour_near(read, "pick crease", *pick_crease);
      if (pick_dot) inks.dot = colour_near(read, "pick dot", *pick_dot);
    }
    capture::SkinMarks marks;
    if (!read.surface.colour.empty()) {
      marks = capture::find_skin_marks(read.surface, path, inks);
      for (const std::string& text : marks.notes) notes.push_back(path + ": " + text);
    }
    shown[posture] = {path, std::move(read.surface), std::move(marks)};
  }
  return make_hand_of_surfaces(request.hand, work, shown, notes, part_of(progress, 0.15, 1.0));
}

}  // namespace palmar::person_workflow
