// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_from_scan_command.h"

#include "hand/hand_output.h"
#include "hand/scan_hand.h"
#include "hand/side_argument.h"
#include "output_guard.h"
#include "palmar/core/progress_part.h"

namespace palmar::cli {
namespace {

struct FromScanArguments {
  std::vector<std::string> paths, posture;
  std::string unit, pick_crease, pick_dot;
  ScanHandArguments hand;
};

int run_from_scan(const FromScanArguments& arguments, const Context& context) {
  const std::string& out = arguments.hand.out;
  check_hand_output(out);
  if (!arguments.hand.side.empty()) parse_side(arguments.hand.side);
  SkinMarkOptions inks = arguments.hand.inks();
  const auto files = files_by_posture(arguments.paths, arguments.posture, "scan");
  const std::string work =
      arguments.hand.work.empty() ? beside_hand(out, ".scan") : arguments.hand.work;
  for (const auto& [posture, path] : files) refuse_same_file(path, out);
  arguments.hand.check_outputs(work);
  load_hand(arguments.hand.model);
  const Progress progress = make_progress(context.common);

  std::map<ScanPosture, ShownScan> shown;
  std::vector<std::string> notes;
  std::optional<LengthUnit> unit = parse_unit(arguments.unit);
  for (const auto& [posture, path] : files) {
    const double step = 0.15 / static_cast<double>(files.size());
    progress.update(step * static_cast<double>(shown.size()), "reading " + path);
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
    SkinMarks marks;
    if (!read.surface.colour.empty()) {
      marks = find_skin_marks(read.surface, path, inks);
      for (const std::string& text : marks.notes) notes.push_back(path + ": " + text);
    }
    shown[posture] = {path, std::move(read.surface), std::move(marks)};
  }
  make_hand_of_surfaces(arguments.hand, work, shown, notes, context, part_of(progress, 0.15, 1.0));
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
  verb->add_option("--posture", a->posture, "What a file shows: FILE=POSTURE; again for others");
  verb->add_option("--unit", a->unit,
                   "Of files that carry none: mm, cm, m or inch; default: what makes a hand of it");
  verb->add_option("--pick-crease", a->pick_crease,
                   "x,y,z of a point in the reference scan's own coordinates that has the "
                   "creases' colour");
  verb->add_option("--pick-dot", a->pick_dot, "The same for the dots");
  a->hand.add_to(*verb);
  verb->add_option("--work", a->hand.work,
                   "Folder for the report; default: beside the hand, *.scan");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_from_scan(*a, context); }; });
}

}  // namespace palmar::cli
