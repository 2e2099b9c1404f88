// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_sheet_command.h"

#include <fmt/format.h>

#include "hand/side_argument.h"
#include "hands/person_workflow/phantom/phantom_sheet.h"
#include "palmar/core/error.h"
#include "phantom/phantom_output.h"

namespace palmar::cli {
namespace {

struct PhantomSheetArguments {
  person_workflow::PhantomSheetRequest request;
  std::string side = "right", table = "wood", skin = "light";
  bool no_exif = false;
};

geometry::Srgb colour_named(const std::string& option, const std::string& name,
                            const std::vector<std::pair<std::string, geometry::Srgb>>& colours) {
  std::string names;
  for (const auto& [one, colour] : colours) {
    if (one == name) return colour;
    names += (names.empty() ? "" : ", ") + one;
  }
  throw UsageError(fmt::format("{} \"{}\"; {} are allowed", option, name, names));
}

int run_sheet(const PhantomSheetArguments& arguments, const Context& context) {
  person_workflow::PhantomSheetRequest request = arguments.request;
  request.photograph.seed = context.common.seed;
  request.check();
  request.photograph.table = colour_named("--table", arguments.table,
                                          {{"wood", {0.62F, 0.43F, 0.28F}},
                                           {"dark", {0.16F, 0.14F, 0.13F}},
                                           {"grey", {0.45F, 0.45F, 0.46F}},
                                           {"blue", {0.24F, 0.36F, 0.52F}},
                                           {"white", {0.90F, 0.90F, 0.89F}}});
  request.photograph.skin = colour_named("--skin", arguments.skin,
                                         {{"light", {0.87F, 0.70F, 0.61F}},
                                          {"middle", {0.70F, 0.50F, 0.38F}},
                                          {"dark", {0.36F, 0.23F, 0.17F}}});
  request.side = parse_side(arguments.side);
  request.has_exif = !arguments.no_exif;
  const person_workflow::PhantomSheetOutcome made = person_workflow::make_phantom_sheet(request);
  print(fmt::format("photograph: {}\ntruth: {}, {}\n", made.photograph, made.truth, made.shape));
  return 0;
}

}  // namespace

void add_phantom_sheet(CLI::App& phantom, Context& context) {
  const auto o = std::make_shared<PhantomSheetArguments>();
  CLI::App* verb =
      add_verb(phantom, "sheet",
               "A photograph of a synthetic hand flat on a sheet of paper or beside a bank "
               "card, with the truth beside it; --seed chooses the person",
               "palmar phantom sheet --seed 3 --out sheet3");
  phantom::SheetPhotographOptions& p = o->request.photograph;
  verb->add_option("--out", o->request.out, "Folder; photo.jpg, truth.json, truth.ply go into it")
      ->required();
  verb->add_flag("--free", o->request.is_free, kFreeHelp);
  verb->add_option("--start-hand", o->request.base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->add_option("--hand", o->request.hand,
                   "One of Palmar's hands instead of a synthetic person: \"template\" or a "
                   ".hand.glb file; truth.hand.glb is written then");
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--sheet", o->request.sheet, "a4, letter or card (a bank card beside the hand)")
      ->capture_default_str();
  verb->add_option("--table", o->table, "wood, dark, grey, blue or white")->capture_default_str();
  verb->add_flag("--plain", p.is_plain, "The table has no grain");
  verb->add_option("--skin", o->skin, "light, middle or dark")->capture_default_str();
  verb->add_option("--tilt-deg", p.tilt, "Tilt of the camera from the sheet's normal")
      ->capture_default_str();
  verb->add_option("--distance-mm", p.distance, "Distance of the camera from the sheet")
      ->capture_default_str();
  verb->add_option("--width-px", p.pixels_wide, "Width of the photograph")->capture_default_str();
  verb->add_option("--height-px", p.pixels_high, "Height of the photograph")->capture_default_str();
  verb->add_option("--together", o->request.together, "0: fingers spread; 1: side by side")
      ->capture_default_str();
  verb->add_option("--wrist-inside-mm", p.wrist_inside,
                   "How far inside the sheet's edge the wrist crease is")
      ->capture_default_str();
  verb->add_option(
          "--focal", p.focal,
          "Focal length of the lens over the picture's longer side; 0.74: 26 mm on film, as most "
          "telephones have")
      ->capture_default_str();
  verb->add_option("--k1", p.k1,
                   "First coefficient of the lens' distortion; a telephone's picture: about -0.02")
      ->capture_default_str();
  verb->add_flag("--no-exif", o->no_exif, "The photograph doesn't say what lens took it");
  verb->callback([&context, o] { context.run = [&context, o] { return run_sheet(*o, context); }; });
}

}  // namespace palmar::cli
