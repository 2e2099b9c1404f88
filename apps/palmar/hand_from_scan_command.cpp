// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand_from_scan_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include "colour_argument.h"
#include "hand_output.h"
#include "output_guard.h"
#include "palmar/capture/hand_from_scan.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/io/file.h"
#include "palmar/io/hand_file.h"
#include "palmar/io/hand_from_scan_json.h"
#include "palmar/report/hand_scan_report.h"
#include "scan_surface.h"
#include "side_argument.h"

namespace palmar::cli {
namespace {

struct FromScanArguments {
  std::vector<std::string> paths, posture;
  std::string out, work, model = "template", name, side, unit;
  std::string crease = "green", dot = "blue", pick_crease, pick_dot;
  double dot_mm = SkinMarkOptions{}.dot_diameter;
  bool no_report = false;
};

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
  look("natural", ScanPosture::kReference);
  look("open", ScanPosture::kReference);
  look("flex", ScanPosture::kFingerFlexion);
  look("fist", ScanPosture::kFingerFlexion);
  look("bent", ScanPosture::kFingerFlexion);
  look("abduct", ScanPosture::kFingerAbduction);
  look("spread", ScanPosture::kFingerAbduction);
  return found;
}

std::map<ScanPosture, std::string> files_of(const FromScanArguments& arguments) {
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
  std::map<std::string, ScanPosture> told;
  for (const std::string& text : arguments.posture) {
    const auto cut = text.rfind('=');
    const auto posture =
        cut == std::string::npos ? std::nullopt : posture_in_name(text.substr(cut + 1));
    if (!posture) {
      throw UsageError("--posture: \"" + text +
                       "\" isn't FILE=reference, finger_flexion or finger_abduction");
    }
    const std::string file = text.substr(0, cut);
    if (std::find(arguments.paths.begin(), arguments.paths.end(), file) == arguments.paths.end()) {
      throw UsageError("--posture: \"" + file + "\" isn't among the scans");
    }
    told[file] = *posture;
  }
  for (const std::string& path : arguments.paths) {
    if (const auto known = told.find(path); known != told.end()) {
      put(known->second, path);
    } else if (const auto named = posture_in_name(path)) {
      put(*named, path);
    } else if (arguments.paths.size() == 1) {
      put(ScanPosture::kReference, path);
    } else {
      throw UsageError(path +
                       ": its name doesn't tell the posture (reference, finger_flexion, "
                       "finger_abduction); --posture FILE=POSTURE does");
    }
  }
  if (!files.contains(ScanPosture::kReference)) {
    throw UsageError(
        "no scan shows the reference posture (fingers stretched, a little apart); it is needed");
  }
  return files;
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

int run_from_scan(const FromScanArguments& arguments, const Context& context) {
  check_hand_output(arguments.out);
  std::optional<Side> side;
  if (!arguments.side.empty()) side = parse_side(arguments.side);
  SkinMarkOptions inks;
  inks.crease = parse_colour("--crease-colour", arguments.crease);
  inks.dot = parse_colour("--dot-colour", arguments.dot);
  inks.dot_diameter = arguments.dot_mm;
  inks.check();
  const auto files = files_of(arguments);
  const std::string work =
      arguments.work.empty() ? beside_hand(arguments.out, ".scan") : arguments.work;
  for (const auto& [posture, path] : files) refuse_same_file(path, arguments.out);
  if (!arguments.no_report && !arguments.work.empty()) {
    create_folder(work);
    require_writable(work);
  }
  require_writable(folder_of(arguments.out));
  const auto model = load_hand(arguments.model);
  const Progress progress = make_progress(context.common);

  std::map<ScanPosture, SurfaceScan> scans;
  std::map<ScanPosture, ShownScan> shown;
  std::vector<std::string> notes;
  std::optional<LengthUnit> unit = parse_unit(arguments.unit);
  for (const auto& [posture, path] : files) {
    const double step = 0.15 / static_cast<double>(files.size());
    progress.update(step * static_cast<double>(scans.size()), "reading " + path);
    // Scans of one hand come from one program: the reference scan's unit holds for all.
    ReadSurface read = read_scan_surface(path, unit);
    if (!unit) unit = read.unit;
    notes.insert(notes.end(), read.notes.begin(), read.notes.end());
    if (posture == ScanPosture::kReference) {
      if (!arguments.pick_crease.empty()) {
        inks.crease = colour_near(read, "--pick-crease", arguments.pick_crease);
      }
      if (!arguments.pick_dot.empty()) {
        inks.dot = colour_near(read, "--pick-dot", arguments.pick_dot);
      }
    }
    SurfaceScan& scan = scans[posture];
    scan.name = path;
    scan.skin = read.surface.mesh;
    if (!read.surface.colour.empty()) {
      scan.marks = find_skin_marks(read.surface, path, inks);
      for (const std::string& text : scan.marks.notes) notes.push_back(path + ": " + text);
    }
    shown[posture] = {path, std::move(read.surface), scan.marks};
  }
  HandFromScan made = make_hand_from_scans(*model, scans, side, part_of(progress, 0.15, 0.9));
  made.notes.insert(made.notes.begin(), notes.begin(), notes.end());
  Hand& hand = made.scanned.hand;
  hand.name = arguments.name.empty() ? hand_name_of(arguments.out) : arguments.name;
  write_hand(arguments.out, hand);
  if (!arguments.no_report) {
    write_hand_scan_report(work, made, shown, part_of(progress, 0.9, 1.0));
  }
  finish_progress();
  for (const std::string& text : made.notes) note(context.common, text);
  print(context.common.json ? hand_from_scan_json(made) + "\n" : text_of(made));
  note(context.common, "wrote " + arguments.out +
                           (arguments.no_report ? "" : "; report: " + work + "/report.html"));
  return 0;
}

}  // namespace

void add_from_scan(CLI::App& hand, Context& context) {
  const auto a = std::make_shared<FromScanArguments>();
  CLI::App* verb = add_verb(hand, "from-scan",
                            "A person's hand from surface scans: of any scanning app or "
                            "photogrammetry program, with drawn creases and dots if it may be",
                            "palmar hand from-scan natural.glb flexed.glb spread.glb --out "
                            "anna.hand.glb");
  verb->add_option(
          "SCAN", a->paths,
          "OBJ with its texture, GLB, PLY with colours, or STL; one file per posture. The "
          "file's name tells it: reference (or natural), finger_flexion, finger_abduction; "
          "the reference is needed, a single file is taken for it")
      ->required();
  verb->add_option("--out", a->out, "File to write, *.hand.glb")->required();
  verb->add_option("--posture", a->posture, "What a file shows: FILE=POSTURE; again for others");
  verb->add_option("--unit", a->unit,
                   "Of files that carry none: mm, cm, m or inch; default: what makes a hand of it");
  verb->add_option("--side", a->side, "right or left; default: found from the shape");
  verb->add_option("--crease-colour", a->crease,
                   "Ink on the creases: green, blue, red, black, purple, orange or #rrggbb")
      ->capture_default_str();
  verb->add_option("--dot-colour", a->dot, "Ink of the dots")->capture_default_str();
  verb->add_option("--pick-crease", a->pick_crease,
                   "x,y,z of a point in the reference scan's own coordinates that has the "
                   "creases' colour");
  verb->add_option("--pick-dot", a->pick_dot, "The same for the dots");
  verb->add_option("--dot-mm", a->dot_mm, "Diameter of the dots")->capture_default_str();
  verb->add_option("--work", a->work, "Folder for the report; default: beside the hand, *.scan");
  verb->add_option("--model", a->model,
                   "Hand whose segments, regions and joints are laid over the scan")
      ->capture_default_str();
  verb->add_option("--name", a->name, "Name of the hand; default: that of the file");
  verb->add_flag("--no-report", a->no_report, "Only the hand");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_from_scan(*a, context); }; });
}

}  // namespace palmar::cli
