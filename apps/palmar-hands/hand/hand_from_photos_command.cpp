// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_from_photos_command.h"

#include "hand/scan_hand_arguments.h"
#include "hands/person_workflow/hand_from_photos.h"
#include "photos/photo_mesh_arguments.h"

namespace palmar::cli {
namespace {

struct FromPhotosArguments {
  person_workflow::HandFromPhotosRequest request;
  std::vector<std::string> posture;
  PhotoMeshArguments mesh;
  ScanHandArguments hand;
};

int run_from_photos(const FromPhotosArguments& arguments, const Context& context) {
  person_workflow::HandFromPhotosRequest request = arguments.request;
  request.hand = arguments.hand.options();
  request.mesh = arguments.mesh.options();
  request.posture = parse_file_postures(arguments.posture);
  request.note = [&context](const std::string& text) { note(context.common, text); };
  print_scanned_hand(person_workflow::make_hand_from_photos(request, make_progress(context.common)),
                     request.hand.out, context);
  return 0;
}

}  // namespace

void add_from_photos(CLI::App& hand, Context& context) {
  const auto a = std::make_shared<FromPhotosArguments>();
  CLI::App* verb =
      add_verb(hand, "from-photos",
               "A person's hand from photographs of it on the printed board (palmar photos board), "
               "a folder per posture",
               "palmar hand from-photos anna/reference anna/flexed --lenses anna/calibration "
               "--out anna.hand.glb");
  verb->add_option("FOLDER", a->request.folders,
                   "Photographs (.png, .jpg) of one posture, or a folder of such folders. The name "
                   "gives the posture: reference (or natural), finger_flexion, finger_abduction; "
                   "the reference is needed, a single folder is taken for it")
      ->required();
  verb->add_option("--posture", a->posture,
                   "Posture that a folder shows: FOLDER=POSTURE; may be given several times");
  a->mesh.add_to(*verb);
  a->hand.add_to(*verb,
                 "Folder for the report and for the meshes, which another run reuses; default: "
                 "beside the hand, *.photos");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_from_photos(*a, context); }; });
}

}  // namespace palmar::cli
