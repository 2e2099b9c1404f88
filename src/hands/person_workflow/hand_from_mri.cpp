// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_from_mri.h"

#include <algorithm>
#include <filesystem>

#include "hands/person_records/bone_label_file.h"
#include "hands/person_report/found_bones.h"
#include "hands/person_report/scan_report.h"
#include "hands/person_workflow/steps/hand_output.h"
#include "hands/person_workflow/steps/mri_pipeline.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/person/person_file.h"
#include "palmar/records/product/product_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

/// Which postures there are, and which not.
std::string words_of(const std::vector<SelectedScan>& scans) {
  std::string seen, missing;
  for (int k = 0; k < hand::kScanPostureCount; ++k) {
    const auto posture = static_cast<hand::ScanPosture>(k);
    const bool is_seen = std::any_of(scans.begin(), scans.end(), [&](const SelectedScan& scan) {
      return scan.posture == posture;
    });
    std::string& list = is_seen ? seen : missing;
    list += (list.empty() ? "" : ", ") + std::string(name_of(posture));
  }
  return "scans of " + seen + (missing.empty() ? "" : "; none of " + missing);
}

/// The work folder is written to, so no image may lie where results go.
void require_apart(const std::string& work, const std::vector<SelectedScan>& scans) {
  for (const SelectedScan& scan : scans) {
    if (scan.has_surfaces) continue;
    const auto results = std::filesystem::path(work) / name_of(scan.posture);
    const auto images = std::filesystem::path(scan.files.front()).parent_path();
    std::error_code ignored;
    if (!std::filesystem::equivalent(results, images, ignored)) continue;
    throw UsageError("setting \"work\" " + work + ": " + results.string() +
                     " holds the images themselves; name another folder");
  }
}

/// Those of the known bones that aren't labelled already.
void add_known(std::vector<hand::BoneLabel>& labels, const std::vector<hand::BoneLabel>& known) {
  const std::vector<hand::BoneLabel> said = labels;
  for (const hand::BoneLabel& one : known) {
    const bool is_said =
        std::any_of(said.begin(), said.end(),
                    [&one](const hand::BoneLabel& label) { return label.name == one.name; });
    if (!is_said) labels.push_back(one);
  }
}

}  // namespace

void HandFromMriRequest::check() const {
  if (images.empty()) {
    throw UsageError("setting \"images\": there are none; MR images of the hand are required");
  }
  check_hand_output(out);
  surfaces.check();
}

HandFromMriOutcome make_hand_from_mri(const HandFromMriRequest& request, const Progress& progress) {
  request.check();
  const auto on_note = [&](const std::string& text) { workflow::note_to(request.note, text); };
  const auto model = workflow::load_hand(request.model);
  HandFromMriOutcome outcome;
  outcome.work = request.work.empty() ? beside_hand(request.out, ".mri") : request.work;
  MriPipelineOptions options;
  options.surfaces = request.surfaces;
  options.accepts_odd_slices = request.accepts_odd_slices;
  options.work = outcome.work;
  options.note = on_note;
  options.setting_names = request.setting_names;
  if (!request.labels.empty()) options.labels = person_records::read_bone_labels(request.labels);
  if (!request.known.empty()) {
    const records::PersonFile known = records::read_person(request.known);
    add_known(options.labels, known.bones);
    if (!options.surfaces.side) options.surfaces.side = known.side;
  }
  if (!request.product.empty()) {
    options.product = records::load_product(request.product, {.unit = request.unit});
    for (const std::string& text : options.product->notes) on_note(text);
  }
  progress.update(0.0, "looking for series");
  ScanSelection selection = select_scans(request.images, request.series, request.skip);
  require_apart(options.work, selection.scans);
  const WorkFolder folder(options.work);
  require_writable(folder_of(request.out));
  for (std::string& text : selection.notes) {
    text = with_setting_names(text, request.setting_names);
    on_note(text);
  }
  on_note(words_of(selection.scans));
  options.write = [&](capture::ScanRecord& record, const Progress& part) {
    record.notes.insert(record.notes.begin(), selection.notes.begin(), selection.notes.end());
    hand::Hand& hand = record.made.hand;
    hand.name = request.name.empty() ? hand_name_of(request.out) : request.name;
    records::write_hand(request.out, hand);
    if (request.writes_report)
      person_report::write_scan_report(options.work, record, request.language, part);
  };
  if (request.writes_report || request.looks_only) {
    options.show_reference = [&](const capture::ScanSurfaces& reference, const Progress& part) {
      formats::write_file(options.work + "/found.toml", person_report::found_bones_toml(reference));
      outcome.found = options.work + "/found.png";
      formats::write_file(outcome.found,
                          report::encode_png(person_report::found_bones_sheet(reference, part)));
    };
  }
  options.looks_only = request.looks_only;
  if (request.looks_only) {
    selection.scans.resize(1);  // the reference is the first
    options.product.reset();
  }
  options.write_found = [&](const capture::ScanRecord& found,
                            const capture::ScanRefusal& refusal) -> std::string {
    if (!request.writes_report) return "What was found stays in " + options.work;
    capture::ScanRefusal said = refusal;
    said.message = with_setting_names(refusal.message, request.setting_names);
    person_report::write_refused_scan_report(options.work, found, said, model->bones.size(),
                                             request.language);
    return "What was found, with pictures: " + options.work + "/report.html";
  };
  outcome.record = run_mri_pipeline(selection.scans, *model, options, progress);
  if (request.writes_report && !request.looks_only) outcome.report = outcome.work + "/report.html";
  return outcome;
}

}  // namespace palmar::person_workflow
