// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_from_mri_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "assess/surface_arguments.h"
#include "hand/hand_output.h"
#include "hand/scan_selection.h"
#include "mri/mri_pipeline.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/capture/bone_label_file.h"
#include "palmar/records/capture/scan_record_json.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/product/product_file.h"
#include "palmar/report/scan/scan_report.h"

namespace palmar::cli {
namespace {

struct FromMriArguments {
  std::vector<std::string> paths, series, skip;
  std::string out, work, labels, model = "template", name, product, unit;
  SurfaceArguments surfaces;
  bool no_report = false, accepts_odd_slices = false;
};

/// Folder beside the hand: "anna.hand.glb" -> "anna.mri".
std::string work_folder(const FromMriArguments& arguments) {
  if (!arguments.work.empty()) return arguments.work;
  return beside_hand(arguments.out, ".mri");
}

std::string millimetres(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string text_of(const ScanRecord& record) {
  const HandDimensions& d = record.made.hand.dimensions;
  std::string text = fmt::format(
      "{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm\n"
      "skin: {:.2f} mm from the scan in the mean, 95 % within {:.2f} mm\n",
      name_of(record.made.hand.side), d.hand_length, d.hand_circumference, d.hand_width,
      record.made.registration_mean, record.made.registration_p95);
  const std::vector<ErrorRow> rows = error_rows(record.joints.errors);
  if (!rows.empty()) {
    text += fmt::format("bones, mean distance, mm\n  {:<17} {:<24} {:>6} {:>11} {:>16}\n",
                        "posture", "bones", "ICP", "fixed axes", "CMC interpolated");
  }
  for (const ErrorRow& row : rows) {
    text += fmt::format("  {:<17} {:<24} {:>6.2f} {:>11.2f} {:>16}\n", name_of(row.posture),
                        row.bones, row.icp, row.single_axis, millimetres(row.interpolated_cmc));
  }
  if (!record.made.skin_errors.empty()) {
    text += "skin round the thumb ball, mean distance, mm\n";
    text += fmt::format("  {:<17} {:>15} {:>14} {:>10}\n", "posture", "skinning alone",
                        "markers alone", "corrected");
  }
  for (const SkinError& error : record.made.skin_errors) {
    text += fmt::format("  {:<17} {:>15.2f} {:>14} {:>10}\n", name_of(error.posture),
                        error.skinning_only, millimetres(error.by_markers),
                        millimetres(error.corrected));
  }
  if (record.contact) {
    const ContactOverlap& c = record.contact->overlap;
    text += fmt::format(
        "contact with {}, skin within {:g} mm: hand {:.0f} mm^2, scan {:.0f} mm^2; of the product, "
        "{:.0f} % of what the scan touches is touched by the hand, {:.0f} % the other way round\n",
        record.contact->product, record.contact->range, c.hand_area, c.scanned_area,
        100.0 * c.share_of_scan, 100.0 * c.share_of_hand);
  }
  return text;
}

/// Which postures there are, and which not.
std::string text_of(const std::vector<SelectedScan>& scans) {
  std::string seen, missing;
  for (int k = 0; k < kScanPostureCount; ++k) {
    const auto posture = static_cast<ScanPosture>(k);
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
    throw UsageError("--work " + work + ": " + results.string() +
                     " holds the images themselves; name another folder");
  }
}

int run(const FromMriArguments& arguments, const Context& context) {
  check_hand_output(arguments.out);
  const Progress progress = make_progress(context.common);
  const auto model = load_hand(arguments.model);
  MriPipelineOptions options;
  options.surfaces = arguments.surfaces.options();
  options.side = arguments.surfaces.chosen_side();
  options.accepts_odd_slices = arguments.accepts_odd_slices;
  options.work = work_folder(arguments);
  if (!arguments.labels.empty()) options.labels = read_bone_labels(arguments.labels);
  if (!arguments.product.empty()) {
    options.product = load_product(arguments.product, {.unit = parse_unit(arguments.unit)});
    for (const std::string& text : options.product->notes) note(context.common, text);
  }
  options.tell = [&context](const std::string& text) { note(context.common, text); };
  progress.update(0.0, "looking for series");
  const ScanSelection selection = select_scans(arguments.paths, arguments.series, arguments.skip);
  require_apart(options.work, selection.scans);
  const WorkFolder folder(options.work);
  require_writable(folder_of(arguments.out));
  for (const std::string& text : selection.notes) note(context.common, text);
  note(context.common, text_of(selection.scans));
  options.write = [&](ScanRecord& record, const Progress& part) {
    record.notes.insert(record.notes.begin(), selection.notes.begin(), selection.notes.end());
    Hand& hand = record.made.hand;
    hand.name = arguments.name.empty() ? hand_name_of(arguments.out) : arguments.name;
    write_hand(arguments.out, hand);
    if (!arguments.no_report) write_scan_report(options.work, record, part);
  };
  const ScanRecord record = run_mri_pipeline(selection.scans, *model, options, progress);
  finish_progress();
  print(context.common.json ? scan_record_json(record) + "\n" : text_of(record));
  note(context.common, arguments.no_report
                           ? "wrote " + arguments.out
                           : "wrote " + arguments.out + "; report: " + options.work +
                                 "/report.html; what each step made stays in " + options.work);
  return 0;
}

}  // namespace

void add_from_mri(CLI::App& hand, Context& context) {
  const auto a = std::make_shared<FromMriArguments>();
  CLI::App* verb = add_verb(hand, "from-mri", "A person's hand from MR series of several postures",
                            "palmar hand from-mri scans/ --out anna.hand.glb");
  verb->add_option("IMAGE", a->paths,
                   "Folders of DICOM series, NIfTI or NRRD files, or folders that palmar mri "
                   "surfaces made. The description of a series "
                   "(or the name of its folder) tells the posture: reference, thumb_flexion, "
                   "thumb_extension, thumb_abduction, thumb_adduction, finger_flexion, "
                   "finger_abduction, grasp; the reference is needed")
      ->required();
  verb->add_option("--out", a->out, "File to write, *.hand.glb")->required();
  verb->add_option("--series", a->series,
                   "What a series shows: NUMBER=POSTURE, or TEXT=POSTURE for part of its "
                   "description; again for others");
  verb->add_option("--skip", a->skip, "Posture to leave out, for a spoilt series");
  verb->add_option(
      "--work", a->work,
      "Folder for the report and for what each step makes, which another run takes up; "
      "default: beside the hand, *.mri");
  verb->add_option("--labels", a->labels,
                   "Names for bones of the reference scan: CSV with name, x_mm, y_mm, z_mm");
  verb->add_option(
      "--product", a->product,
      "What the grasp holds, where it was in the scanner (patient frame): contact areas "
      "of scan and hand are compared");
  verb->add_option("--unit", a->unit, "Unit of the product's file: mm, cm, m or inch");
  verb->add_option("--model", a->model, "Hand to start from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->add_option("--name", a->name, "Name of the hand; default: that of the file");
  a->surfaces.add_to(*verb);
  verb->add_flag("--accept-odd-slices", a->accepts_odd_slices,
                 "Go on though a slice doesn't belong between its neighbours");
  verb->add_flag("--no-report", a->no_report, "Only the hand");
  verb->callback([&context, a] { context.run = [&context, a] { return run(*a, context); }; });
}

}  // namespace palmar::cli
