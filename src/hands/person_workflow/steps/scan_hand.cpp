// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/scan_hand.h"

#include "hands/person_records/mark_label_file.h"
#include "hands/person_records/painted_hand_file.h"
#include "hands/person_report/found_sheet.h"
#include "hands/person_workflow/steps/hand_output.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/person/person_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {

namespace {

/// Surfaces with what was found and named on them, by number; the path of the sheet.
std::string write_found(const std::string& work,
                        std::map<hand::ScanPosture, person_report::ShownScan> shown,
                        const std::map<hand::ScanPosture, capture::SkinMarks*>& named,
                        const Progress& progress) {
  for (auto& [posture, scan] : shown) scan.marks = *named.at(posture);
  formats::create_folder(work);
  const std::vector<person_report::NumberedMark> marks = person_report::numbered_marks(shown);
  formats::write_file(work + "/found.toml", person_report::found_toml(marks));
  const std::string sheet = work + "/found.png";
  formats::write_file(sheet,
                      report::encode_png(person_report::found_sheet(shown, marks, progress)));
  return sheet;
}

}  // namespace

void ScanHandOptions::check() const {
  check_hand_output(out);
  inks.check();
}

void ScanHandOptions::check_files() const {
  if (writes_report && !work.empty()) {
    formats::create_folder(work);
    require_writable(work);
  }
  require_writable(folder_of(out));
  if (!marks.empty()) person_records::read_mark_labels(marks);
  if (!known.empty()) records::read_person(known);
  if (!truth.empty()) person_records::read_scan_truth(truth);
}

ScanHandOutcome make_hand_of_surfaces(
    const ScanHandOptions& options, const std::string& work,
    const std::map<hand::ScanPosture, person_report::ShownScan>& shown,
    const std::vector<std::string>& notes, const Progress& progress) {
  const auto model = workflow::load_hand(options.model);
  std::map<hand::ScanPosture, capture::SurfaceScan> scans;
  std::map<hand::ScanPosture, capture::SkinMarks*> marks;
  for (const auto& [posture, one] : shown) {
    scans[posture] = {one.file, one.surface.mesh, one.marks};
    marks[posture] = &scans[posture].marks;
  }
  const records::PersonFile known =
      options.known.empty() ? records::PersonFile{} : records::read_person(options.known);
  if (!known.marks.empty()) capture::apply_mark_labels(known.marks, marks);
  if (!options.marks.empty())
    capture::apply_mark_labels(person_records::read_mark_labels(options.marks), marks);
  ScanHandOutcome outcome;
  capture::HandFromScan& made = outcome.made;
  if (options.writes_report || options.looks_only) {
    outcome.found = write_found(work, shown, marks, part_of(progress, 0.0, 0.05));
  }
  if (options.looks_only) {
    made.notes = notes;
    return outcome;
  }
  const std::optional<hand::Side> side = options.side ? options.side : known.side;
  made = capture::make_hand_from_scans(*model, scans, side, part_of(progress, 0.05, 0.9));
  made.notes.insert(made.notes.begin(), notes.begin(), notes.end());
  hand::Hand& hand = made.scanned.hand;
  hand.name = options.name.empty() ? hand_name_of(options.out) : options.name;
  records::write_hand(options.out, hand, made.creases.plane);
  if (!options.writes_report) return outcome;
  std::optional<capture::ScanErrors> errors;
  if (!options.truth.empty())
    errors = capture::scan_errors(made, person_records::read_scan_truth(options.truth));
  person_report::write_hand_scan_report(work, made, shown, errors, options.language,
                                        part_of(progress, 0.9, 1.0));
  outcome.report = work + "/report.html";
  return outcome;
}

}  // namespace palmar::person_workflow
