// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/scan_hand_arguments.h"

#include <fmt/format.h>

#include "hand/side_argument.h"
#include "hands/person_records/hand_from_scan_json.h"
#include "hands/person_workflow/steps/hand_output.h"
#include "hands/person_workflow/steps/posture_files.h"
#include "palmar/core/error.h"
#include "product/colour_argument.h"
#include "text.h"

namespace palmar::cli {
namespace {

std::string scanned_hand_text(const capture::HandFromScan& made) {
  const hand::HandDimensions& d = made.scanned.hand.dimensions;
  const std::string text = fmt::format(
      "{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm, thickness {:.1f} mm\n"
      "skin: {:.2f} mm from the scan in the mean, 95 % within {:.2f} mm\n",
      name_of(made.scanned.hand.side), d.hand_length, d.hand_circumference, d.hand_width,
      d.hand_thickness, made.scanned.registration_mean, made.scanned.registration_p95);
  return text + segments_text(d);
}

}  // namespace

void ScanHandArguments::add_to(CLI::App& verb, const std::string& work_help) {
  verb.add_option("--out", options_.out, "File to write, *.hand.glb")->required();
  verb.add_option("--side", side_, "right or left; default: found from the shape");
  verb.add_option("--crease-colour", crease_,
                  "Ink on the creases: green, blue, red, black, purple, orange or #rrggbb")
      ->capture_default_str();
  verb.add_option("--dot-colour", dot_, "Ink of the dots")->capture_default_str();
  verb.add_option("--dot-mm", options_.inks.dot_diameter, "Diameter of the dots")
      ->capture_default_str();
  verb.add_option("--marks", options_.marks,
                  "Names of drawn creases and dots, those to leave out and to add: marks.csv of an "
                  "earlier run, edited");
  verb.add_option("--known", options_.known,
                  "TOML file of what is known of the person: side, points with the inks' colours, "
                  "names of marks; all commands that make a person's hand take it");
  verb.add_flag("--look", options_.looks_only,
                "Only show by number what was found on the surfaces: found.png, and found.toml to "
                "be edited for --known");
  verb.add_option("--truth", options_.truth,
                  "subject.json of a synthetic person: how far the hand is off, in the report");
  verb.add_option("--start-hand", options_.model,
                  "Hand whose segments, regions and joints are fitted to the surface")
      ->capture_default_str();
  verb.add_option("--name", options_.name, "Name of the hand; default: that of the file");
  verb.add_flag("--no-report", no_report_, "Write only the hand, no report");
  verb.add_option("--language", language_, "Language of the report: en or de")
      ->capture_default_str();
  verb.add_option("--work", options_.work, work_help);
}

person_workflow::ScanHandOptions ScanHandArguments::options() const {
  person_workflow::ScanHandOptions options = options_;
  person_workflow::check_hand_output(options.out);
  if (!side_.empty()) options.side = parse_side(side_);
  options.inks.crease = parse_colour("--crease-colour", crease_);
  options.inks.dot = parse_colour("--dot-colour", dot_);
  options.writes_report = !no_report_;
  options.language = language_named(language_);
  options.check();
  return options;
}

std::map<std::string, hand::ScanPosture> parse_file_postures(
    const std::vector<std::string>& stated) {
  std::map<std::string, hand::ScanPosture> postures;
  for (const std::string& text : stated) {
    const auto cut = text.rfind('=');
    const auto posture = cut == std::string::npos
                             ? std::nullopt
                             : person_workflow::posture_in_name(text.substr(cut + 1));
    if (!posture) {
      throw UsageError("--posture: \"" + text +
                       "\" isn't FILE=reference, finger_flexion, finger_abduction, thumb_flexion, "
                       "thumb_extension, thumb_abduction or thumb_adduction");
    }
    postures[text.substr(0, cut)] = *posture;
  }
  return postures;
}

void print_scanned_hand(const person_workflow::ScanHandOutcome& outcome, const std::string& out,
                        const Context& context) {
  finish_progress();
  for (const std::string& text : outcome.made.notes) note(context.common, text);
  if (outcome.made.scanned.hand.skin.vertices.empty()) {
    note(context.common, "wrote " + outcome.found + " and found.toml beside it; no hand was made");
    return;
  }
  print(context.common.json ? person_records::hand_from_scan_json(outcome.made) + "\n"
                            : scanned_hand_text(outcome.made));
  note(context.common,
       "wrote " + out + (outcome.report.empty() ? "" : "; report: " + outcome.report));
}

}  // namespace palmar::cli
