// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/scan_hand.h"

#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/capture/mark_label_file.h"
#include "palmar/records/capture/painted_hand_file.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/workflow/hand/hand_output.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar {

void ScanHandOptions::check() const {
  check_hand_output(out);
  inks.check();
}

void ScanHandOptions::check_files() const {
  if (writes_report && !work.empty()) {
    create_folder(work);
    require_writable(work);
  }
  require_writable(folder_of(out));
  if (!marks.empty()) read_mark_labels(marks);
  if (!truth.empty()) read_scan_truth(truth);
}

ScanHandOutcome make_hand_of_surfaces(const ScanHandOptions& options, const std::string& work,
                                      const std::map<ScanPosture, ShownScan>& shown,
                                      const std::vector<std::string>& notes,
                                      const Progress& progress) {
  const auto model = load_hand(options.model);
  std::map<ScanPosture, SurfaceScan> scans;
  std::map<ScanPosture, SkinMarks*> marks;
  for (const auto& [posture, one] : shown) {
    scans[posture] = {one.file, one.surface.mesh, one.marks};
    marks[posture] = &scans[posture].marks;
  }
  if (!options.marks.empty()) apply_mark_labels(read_mark_labels(options.marks), marks);
  ScanHandOutcome outcome;
  HandFromScan& made = outcome.made;
  made = make_hand_from_scans(*model, scans, options.side, part_of(progress, 0.0, 0.9));
  made.notes.insert(made.notes.begin(), notes.begin(), notes.end());
  Hand& hand = made.scanned.hand;
  hand.name = options.name.empty() ? hand_name_of(options.out) : options.name;
  write_hand(options.out, hand, made.creases.plane);
  if (!options.writes_report) return outcome;
  std::optional<ScanErrors> errors;
  if (!options.truth.empty()) errors = scan_errors(made, read_scan_truth(options.truth));
  write_hand_scan_report(work, made, shown, errors, options.language, part_of(progress, 0.9, 1.0));
  outcome.report = work + "/report.html";
  return outcome;
}

}  // namespace palmar
