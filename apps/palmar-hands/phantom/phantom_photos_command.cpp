// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_photos_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hand/side_argument.h"
#include "hands/person_workflow/phantom/phantom_photos.h"
#include "palmar/core/error.h"
#include "phantom/phantom_output.h"
#include "product/colour_argument.h"

namespace palmar::cli {
namespace {

struct PhantomPhotosArguments {
  person_workflow::PhantomPhotosRequest request;
  std::string side = "right",
              posture = std::string(name_of(person_workflow::PhantomPhotosRequest{}.posture));
  std::string skin = "#cc9980";
  std::string block;  ///< edges; empty: the hand
};

hand::ScanPosture posture_named(const std::string& name) {
  for (int p = 0; p < hand::kScanPostureCount; ++p) {
    if (name_of(static_cast<hand::ScanPosture>(p)) == name)
      return static_cast<hand::ScanPosture>(p);
  }
  throw UsageError("--posture: \"" + name + "\" is no posture of palmar phantom mri");
}

int run_photos(const PhantomPhotosArguments& arguments, const Context& context) {
  person_workflow::PhantomPhotosRequest request = arguments.request;
  request.photographs.seed = context.common.seed;
  request.side = parse_side(arguments.side);
  request.posture = posture_named(arguments.posture);
  request.skin = parse_colour("--skin-colour", arguments.skin);
  if (!arguments.block.empty())
    request.block = workflow::parse_vector("--block-mm", arguments.block);
  const person_workflow::PhantomPhotosOutcome made =
      person_workflow::make_phantom_photos(request, make_progress(context.common));
  finish_progress();
  if (context.common.json) {
    print(nlohmann::ordered_json{{"photographs", made.photographs},
                                 {"calibration", made.calibration},
                                 {"folder", made.photo_folder},
                                 {"truth", made.truth_folder}}
              .dump(2) +
          "\n");
  } else {
    print(fmt::format("{} photographs: {}\n{} of the board for the lenses: {}\ntruth: {}\n",
                      made.photographs, made.photo_folder, made.calibration,
                      made.calibration_folder, made.truth_folder));
  }
  return 0;
}

}  // namespace

void add_phantom_photos_command(CLI::App& phantom, Context& context) {
  const auto o = std::make_shared<PhantomPhotosArguments>();
  CLI::App* verb =
      add_verb(phantom, "photos",
               "Photographs of a synthetic person's painted hand on a board, taken by a "
               "rig of cameras, with the truth beside them; --seed chooses the person",
               "palmar phantom photos --seed 3 --out subject3");
  phantom::PhotographsOptions& p = o->request.photographs;
  verb->add_option("--out", o->request.out, "Folder; photos/, calibration/ and truth/ go into it")
      ->required();
  verb->add_option("--posture", o->posture, "Which, by its name in palmar phantom mri")
      ->capture_default_str();
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--cameras", p.cameras, "Cameras, at two heights by turns")
      ->capture_default_str();
  verb->add_option("--positions", p.positions, "Positions of the rig")->capture_default_str();
  verb->add_option("--step-deg", p.step, "From position to position")->capture_default_str();
  verb->add_option("--width-px", p.width, "Width of a photograph")->capture_default_str();
  verb->add_option("--height-px", p.height, "Height of a photograph")->capture_default_str();
  verb->add_option("--calibration", o->request.calibration,
                   "Photographs of the tilted board per camera")
      ->capture_default_str();
  verb->add_option("--jpeg", o->request.jpeg,
                   "JPEG of this quality (1 to 100) with what cameras say of themselves; 0: PNG")
      ->capture_default_str();
  verb->add_option("--skin-colour", o->skin, "#rrggbb")->capture_default_str();
  verb->add_option("--texture", p.texture, "Unevenness of the skin's colour, as a share")
      ->capture_default_str();
  verb->add_option("--noise", p.noise, "Deviation of the sensor's noise, of 255")
      ->capture_default_str();
  verb->add_option("--blur-px", p.blur, "Blur of lens and sensor")->capture_default_str();
  verb->add_option("--exposure", p.exposure, "Deviation of the exposures, as a share")
      ->capture_default_str();
  verb->add_option("--aperture-mm", p.aperture, "Aperture of the lenses: blurs what isn't in focus")
      ->capture_default_str();
  verb->add_option("--focus-mm", p.focus, "Focus behind the hand's middle; negative: in front")
      ->capture_default_str();
  verb->add_option("--gloss", p.gloss, "Oily skin: share of the light that it mirrors")
      ->capture_default_str();
  verb->add_option("--decentring", p.decentring,
                   "Deviation of the lens' terms p1, p2, which Palmar doesn't calibrate")
      ->capture_default_str();
  verb->add_option("--sixth", p.sixth, "And of its term in r^6")->capture_default_str();
  verb->add_option("--vignetting", p.vignetting, "Share of the light lost in the corners")
      ->capture_default_str();
  verb->add_option("--tone", p.tone, "Contrast that the camera adds, 0 to 1")
      ->capture_default_str();
  verb->add_option("--motion-mm", p.motion, "Shift of the hand between positions, RMS")
      ->capture_default_str();
  verb->add_option(
          "--finger-motion-mm", o->request.restless,
          "How far every fingertip is from where it was in the first position, RMS: fingers "
          "bend and spread at their knuckles")
      ->capture_default_str();
  verb->add_option("--motion-deg", p.motion_turn, "And turn, RMS")->capture_default_str();
  verb->add_flag("--light-on-rig", p.light_on_rig, "The lamps go round with the cameras");
  verb->add_flag("--clutter", p.clutter, "Warm things behind the hand, no cloth");
  verb->add_flag("--one-ring", p.one_ring, "All cameras at the lower height");
  verb->add_option("--block-mm", o->block,
                   "A cardboard box of these edges instead of the hand: width,depth,height");
  verb->add_flag("--no-hand", o->request.no_hand, "The board alone");
  verb->add_flag("--free", o->request.is_free, kFreeHelp);
  verb->add_option("--start-hand", o->request.base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_photos(*o, context); }; });
}

}  // namespace palmar::cli
