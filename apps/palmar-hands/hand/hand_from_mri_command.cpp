// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_from_mri_command.h"

#include <fmt/format.h>

#include "hands/person_records/scan_record_json.h"
#include "hands/person_workflow/hand_from_mri.h"
#include "hands/person_workflow/steps/hand_output.h"
#include "mri/surface_arguments.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"

namespace palmar::cli {
namespace {

struct FromMriArguments {
  person_workflow::HandFromMriRequest request;
  std::vector<std::string> series, skip;
  std::string unit;
  SurfaceArguments surfaces;
  std::string language = "en";
  bool no_report = false;
};

/// Throws UsageError naming the option and the nearest posture.
hand::ScanPosture posture_called(const std::string& name, const std::string& option) {
  std::vector<std::string> names;
  for (int k = 0; k < hand::kScanPostureCount; ++k) {
    const auto posture = static_cast<hand::ScanPosture>(k);
    if (name == name_of(posture)) return posture;
    names.emplace_back(name_of(posture));
  }
  const std::string nearest = nearest_name(name, names);
  throw UsageError(fmt::format("{}: \"{}\" is no posture{} Allowed are {}", option, name,
                               nearest.empty() ? "." : "; did you mean " + nearest + "?",
                               fmt::join(names, ", ")));
}

/// "3=thumb_flexion". Throws UsageError.
person_workflow::SeriesPosture parse_series(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError("--series: \"" + text +
                     "\" is not of the form NUMBER=POSTURE or TEXT=POSTURE; 3=thumb_flexion, for "
                     "one, is allowed");
  }
  return {text.substr(0, equals), posture_called(text.substr(equals + 1), "--series " + text)};
}

std::string millimetres(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string text_of(const capture::ScanRecord& record) {
  const hand::HandDimensions& d = record.made.hand.dimensions;
  std::string text = fmt::format(
      "{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm\n"
      "skin: {:.2f} mm from the scan in the mean, 95 % within {:.2f} mm\n",
      name_of(record.made.hand.side), d.hand_length, d.hand_circumference, d.hand_width,
      record.made.registration_mean, record.made.registration_p95);
  const std::vector<capture::ErrorRow> rows = capture::error_rows(record.joints.errors);
  if (!rows.empty()) {
    text += fmt::format("bones, mean distance, mm\n  {:<17} {:<24} {:>6} {:>11} {:>16}\n",
                        "posture", "bones", "ICP", "fixed axes", "CMC interpolated");
  }
  for (const capture::ErrorRow& row : rows) {
    text += fmt::format("  {:<17} {:<24} {:>6.2f} {:>11.2f} {:>16}\n", name_of(row.posture),
                        row.bones, row.icp, row.single_axis, millimetres(row.interpolated_cmc));
  }
  if (!record.made.skin_errors.empty()) {
    text += "skin round the thumb ball, mean distance, mm\n";
    text += fmt::format("  {:<17} {:>15} {:>14} {:>10}\n", "posture", "skinning alone",
                        "markers alone", "corrected");
  }
  for (const capture::SkinError& error : record.made.skin_errors) {
    text += fmt::format("  {:<17} {:>15.2f} {:>14} {:>10}\n", name_of(error.posture),
                        error.skinning_only, millimetres(error.by_markers),
                        millimetres(error.corrected));
  }
  if (record.contact) {
    const capture::ContactOverlap& c = record.contact->overlap;
    text += fmt::format(
        "contact with {}, skin within {:g} mm: hand {:.0f} mm^2, scan {:.0f} mm^2; of the product, "
        "{:.0f} % of what the scan touches is touched by the hand, {:.0f} % the other way round\n",
        record.contact->product, record.contact->range, c.hand_area, c.scanned_area,
        100.0 * c.share_of_scan, 100.0 * c.share_of_hand);
  }
  return text;
}

int run(const FromMriArguments& arguments, const Context& context) {
  person_workflow::HandFromMriRequest request = arguments.request;
  person_workflow::check_hand_output(request.out);
  request.surfaces = arguments.surfaces.options();
  if (!request.product.empty()) request.unit = parse_unit(arguments.unit);
  for (const std::string& text : arguments.series) request.series.push_back(parse_series(text));
  for (const std::string& name : arguments.skip) {
    request.skip.push_back(posture_called(name, "--skip"));
  }
  request.writes_report = !arguments.no_report;
  request.language = language_named(arguments.language);
  request.setting_names = option_named;
  request.note = [&context](const std::string& text) { note(context.common, text); };
  const person_workflow::HandFromMriOutcome made =
      person_workflow::make_hand_from_mri(request, make_progress(context.common));
  finish_progress();
  if (request.looks_only) {
    note(context.common, "wrote " + made.found + " and found.toml beside it; no hand was made");
    return 0;
  }
  print(context.common.json ? person_records::scan_record_json(made.record) + "\n"
                            : text_of(made.record));
  note(context.common, made.report.empty() ? "wrote " + request.out
                                           : "wrote " + request.out + "; report: " + made.report +
                                                 "; what each step made stays in " + made.work);
  return 0;
}

}  // namespace

void add_from_mri(CLI::App& hand, Context& context) {
  const auto a = std::make_shared<FromMriArguments>();
  CLI::App* verb = add_verb(hand, "from-mri", "A person's hand from MR series of several postures",
                            "palmar hand from-mri subject3/mri --out anna.hand.glb");
  verb->add_option(
          "IMAGE", a->request.images,
          "Folders of DICOM series, DICOM files of several frames, NIfTI files, or folders that "
          "palmar mri surfaces made. The "
          "description of a series (or the name of its folder) gives the posture: reference, "
          "thumb_flexion, thumb_extension, thumb_abduction, thumb_adduction, finger_flexion, "
          "finger_abduction, grasp; the reference is needed")
      ->required();
  verb->add_option("--out", a->request.out, "File to write, *.hand.glb")->required();
  verb->add_option("--series", a->series,
                   "What a series shows: NUMBER=POSTURE, or TEXT=POSTURE for part of its "
                   "description; may be given several times");
  verb->add_option("--skip", a->skip,
                   "Posture to leave out, for example because its series is spoilt");
  verb->add_option("--work", a->request.work,
                   "Folder for the report and for what each step makes, which another run reuses; "
                   "default: beside the hand, *.mri");
  verb->add_option("--labels", a->request.labels,
                   "Names for bones of the reference scan: CSV with name, x_mm, y_mm, z_mm");
  verb->add_option("--known", a->request.known,
                   "TOML file of what is known of the person: side, names of bones");
  verb->add_flag("--look", a->request.looks_only,
                 "Only show by number which bones were found in the reference: found.png, and "
                 "found.toml to be edited for --known");
  verb->add_option("--product", a->request.product,
                   "The object that the grasp holds, where it was in the scanner (patient frame): "
                   "contact areas of scan and hand are compared");
  verb->add_option("--unit", a->unit, "Unit of the product's file: mm, cm, m or inch");
  verb->add_option("--start-hand", a->request.model,
                   "Hand to start from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->add_option("--name", a->request.name, "Name of the hand; default: that of the file");
  a->surfaces.add_to(*verb);
  verb->add_flag("--accept-odd-slices", a->request.accepts_odd_slices,
                 "Continue although a slice doesn't fit between its neighbours");
  verb->add_option("--language", a->language, "Language of the report: en or de")
      ->capture_default_str();
  verb->add_flag("--no-report", a->no_report, "Write only the hand, no report");
  verb->callback([&context, a] { context.run = [&context, a] { return run(*a, context); }; });
}

}  // namespace palmar::cli
