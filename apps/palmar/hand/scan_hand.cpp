// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/scan_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "hand/hand_output.h"
#include "hand/side_argument.h"
#include "palmar/capture/scan/hand_from_scan.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/capture/hand_from_scan_json.h"
#include "palmar/records/capture/mark_label_file.h"
#include "palmar/records/capture/painted_hand_file.h"
#include "palmar/records/hand/hand_file.h"
#include "product/colour_argument.h"

namespace palmar::cli {
namespace {

/// The posture that a file's name tells: as for images, or in short.
std::optional<ScanPosture> posture_in_name(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  if (const auto known = scan_posture_in(name)) return known;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::optional<ScanPosture> found;
  const auto look = [&](std::string_view word, ScanPosture posture) {
    if (name.find(word) != std::string::npos && !found) found = posture;
  };
  if (name.find("thumb") != std::string::npos) {
    look("flex", ScanPosture::kThumbFlexion);
    look("ext", ScanPosture::kThumbExtension);
    look("abd", ScanPosture::kThumbAbduction);
    look("add", ScanPosture::kThumbAdduction);
    return found;
  }
  look("natural", ScanPosture::kReference);
  look("open", ScanPosture::kReference);
  look("flex", ScanPosture::kFingerFlexion);
  look("fist", ScanPosture::kFingerFlexion);
  look("bent", ScanPosture::kFingerFlexion);
  look("abduct", ScanPosture::kFingerAbduction);
  look("spread", ScanPosture::kFingerAbduction);
  return found;
}

std::string text_of(const HandFromScan& made) {
  const HandDimensions& d = made.scanned.hand.dimensions;
  std::string text = fmt::format(
      "{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm, thickness {:.1f} mm\n"
      "skin: {:.2f} mm from the scan in the mean, 95 % within {:.2f} mm\n",
      name_of(made.scanned.hand.side), d.hand_length, d.hand_circumference, d.hand_width,
      d.hand_thickness, made.scanned.registration_mean, made.scanned.registration_p95);
  text +=
      fmt::format("{:<18} {:>7} {:>6} {:>10}  (mm)\n", "segment", "length", "width", "thickness");
  for (int k = 0; k < kSegmentCount; ++k) {
    const SegmentDimensions& s = d.segment[static_cast<std::size_t>(k)];
    text += fmt::format("{:<18} {:>7.1f} {:>6.1f} {:>10.1f}\n", name_of(static_cast<Segment>(k)),
                        s.length, s.width, s.thickness);
  }
  return text;
}

}  // namespace

void ScanHandArguments::add_to(CLI::App& verb) {
  verb.add_option("--out", out, "File to write, *.hand.glb")->required();
  verb.add_option("--side", side, "right or left; default: found from the shape");
  verb.add_option("--crease-colour", crease,
                  "Ink on the creases: green, blue, red, black, purple, orange or #rrggbb")
      ->capture_default_str();
  verb.add_option("--dot-colour", dot, "Ink of the dots")->capture_default_str();
  verb.add_option("--dot-mm", dot_mm, "Diameter of the dots")->capture_default_str();
  verb.add_option("--marks", marks,
                  "Names of drawn creases and dots, those to leave out and to add: marks.csv of an "
                  "earlier run, edited");
  verb.add_option("--truth", truth,
                  "subject.json of a synthetic person: how far the hand is off, in the report");
  verb.add_option("--model", model,
                  "Hand whose segments, regions and joints are laid over the surface")
      ->capture_default_str();
  verb.add_option("--name", name, "Name of the hand; default: that of the file");
  verb.add_flag("--no-report", no_report, "Only the hand");
}

SkinMarkOptions ScanHandArguments::inks() const {
  SkinMarkOptions inks;
  inks.crease = parse_colour("--crease-colour", crease);
  inks.dot = parse_colour("--dot-colour", dot);
  inks.dot_diameter = dot_mm;
  inks.check();
  return inks;
}

void ScanHandArguments::check_outputs(const std::string& work_folder) const {
  if (!no_report && !work.empty()) {
    create_folder(work_folder);
    require_writable(work_folder);
  }
  require_writable(folder_of(out));
  if (!marks.empty()) read_mark_labels(marks);
  if (!truth.empty()) read_scan_truth(truth);
}

std::map<ScanPosture, std::string> files_by_posture(const std::vector<std::string>& paths,
                                                    const std::vector<std::string>& told,
                                                    const std::string& what) {
  std::map<ScanPosture, std::string> files;
  const auto put = [&](ScanPosture posture, const std::string& path) {
    const auto [place, is_new] = files.try_emplace(posture, path);
    if (!is_new) {
      throw UsageError(
          fmt::format("{} and {} both show the posture {}; --posture FILE=POSTURE says "
                      "what a file shows",
                      place->second, path, name_of(posture)));
    }
  };
  std::map<std::string, ScanPosture> known;
  for (const std::string& text : told) {
    const auto cut = text.rfind('=');
    const auto posture =
        cut == std::string::npos ? std::nullopt : posture_in_name(text.substr(cut + 1));
    if (!posture) {
      throw UsageError("--posture: \"" + text +
                       "\" isn't FILE=reference, finger_flexion, finger_abduction, thumb_flexion, "
                       "thumb_extension, thumb_abduction or thumb_adduction");
    }
    const std::string file = text.substr(0, cut);
    if (std::find(paths.begin(), paths.end(), file) == paths.end()) {
      throw UsageError("--posture: \"" + file + "\" isn't among the " + what + "s");
    }
    known[file] = *posture;
  }
  for (const std::string& path : paths) {
    if (const auto at = known.find(path); at != known.end()) {
      put(at->second, path);
    } else if (const auto named = posture_in_name(path)) {
      put(*named, path);
    } else if (paths.size() == 1) {
      put(ScanPosture::kReference, path);
    } else {
      throw UsageError(path +
                       ": its name doesn't tell the posture (reference, finger_flexion, "
                       "finger_abduction); --posture FILE=POSTURE does");
    }
  }
  if (!files.contains(ScanPosture::kReference)) {
    throw UsageError(
        "no " + what +
        " shows the reference posture (fingers stretched, a little apart); it is needed");
  }
  return files;
}

void make_hand_of_surfaces(const ScanHandArguments& arguments, const std::string& work,
                           const std::map<ScanPosture, ShownScan>& shown,
                           const std::vector<std::string>& notes, const Context& context,
                           const Progress& progress) {
  const auto model = load_hand(arguments.model);
  std::optional<Side> side;
  if (!arguments.side.empty()) side = parse_side(arguments.side);
  std::map<ScanPosture, SurfaceScan> scans;
  std::map<ScanPosture, SkinMarks*> marks;
  for (const auto& [posture, one] : shown) {
    scans[posture] = {one.file, one.surface.mesh, one.marks};
    marks[posture] = &scans[posture].marks;
  }
  if (!arguments.marks.empty()) apply_mark_labels(read_mark_labels(arguments.marks), marks);
  HandFromScan made = make_hand_from_scans(*model, scans, side, part_of(progress, 0.0, 0.9));
  made.notes.insert(made.notes.begin(), notes.begin(), notes.end());
  Hand& hand = made.scanned.hand;
  hand.name = arguments.name.empty() ? hand_name_of(arguments.out) : arguments.name;
  write_hand(arguments.out, hand, made.creases.plane);
  if (!arguments.no_report) {
    std::optional<ScanErrors> errors;
    if (!arguments.truth.empty()) errors = scan_errors(made, read_scan_truth(arguments.truth));
    write_hand_scan_report(work, made, shown, errors, part_of(progress, 0.9, 1.0));
  }
  finish_progress();
  for (const std::string& text : made.notes) note(context.common, text);
  print(context.common.json ? hand_from_scan_json(made) + "\n" : text_of(made));
  note(context.common, "wrote " + arguments.out +
                           (arguments.no_report ? "" : "; report: " + work + "/report.html"));
}

}  // namespace palmar::cli
