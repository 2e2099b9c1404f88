// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_from_scan_command.h"

#include "hand/scan_hand_arguments.h"
#include "hands/person_workflow/hand_from_scan.h"

namespace palmar::cli {
namespace {

struct FromScanArguments {
  person_workflow::HandFromScanRequest request;
  std::vector<std::string> posture;
  std::string unit, pick_crease, pick_dot;
  ScanHandArguments hand;
};

int run_from_scan(const FromScanArguments& arguments, const Context& context) {
  person_workflow::HandFromScanRequest request = arguments.request;
  request.hand = arguments.hand.options();
  request.posture = parse_file_postures(arguments.posture);
  request.unit = parse_unit(arguments.unit);
  if (!arguments.pick_crease.empty()) {
    request.pick_crease = workflow::parse_vector("--pick-crease", arguments.pick_crease);
  }
  if (!arguments.pick_dot.empty()) {
    request.pick_dot = workflow::parse_vector("--pick-dot", arguments.pick_dot);
  }
  print_scanned_hand(person_workflow::make_hand_from_scan(request, make_progress(context.common)),
                     request.hand.out, context);
  return 0;
}

}  // namespace

void add_from_scan(CLI::App& hand, Context& context) {
  const auto a = std::make_shared<FromScanArguments>();
  CLI::App* verb =
      add_verb(hand, "from-scan",
               "A person's hand from surface scans: of any scanning app or photogrammetry program, "
               "with creases and dots drawn on the skin if possible",
               "palmar hand from-scan subject3/scan/reference.ply --out "
               "anna.hand.glb");
  verb->add_option("SCAN", a->request.scans,
                   "OBJ with its texture, GLB, PLY with colours, or STL; one file per posture. The "
                   "file's name gives it: reference (or natural), finger_flexion, "
                   "finger_abduction; the reference is needed, a single file is taken for it")
      ->required();
  verb->add_option("--posture", a->posture,
                   "Posture that a file shows: FILE=POSTURE; may be given several times");
  verb->add_option("--unit", a->unit,
                   "Unit of files that carry none: mm, cm, m or inch; default: the one with which "
                   "the scan is a hand");
  verb->add_option("--pick-crease", a->pick_crease,
                   "x,y,z of a point in the reference scan's own coordinates that has the "
                   "creases' colour");
  verb->add_option("--pick-dot", a->pick_dot, "The same for the dots");
  a->hand.add_to(*verb, "Folder for the report; default: beside the hand, *.scan");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_from_scan(*a, context); }; });
}

}  // namespace palmar::cli
