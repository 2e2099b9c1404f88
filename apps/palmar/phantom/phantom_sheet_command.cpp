// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_sheet_command.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "hand/side_argument.h"
#include "palmar/capture/sheet/sheet_view.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/image/exif.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/template_hand.h"
#include "palmar/phantom/photo/sheet_photograph.h"
#include "palmar/records/hand/hand_file.h"

namespace palmar::cli {
namespace {

struct PhantomSheetArguments {
  std::string out, base = "template", hand, side = "right", sheet = "a4", table = "wood",
                   skin = "light";
  SheetPhotographOptions photograph;
  double together = 0.0;
  bool no_exif = false;
};

Srgb colour_named(const std::string& option, const std::string& name,
                  const std::vector<std::pair<std::string, Srgb>>& colours) {
  std::string names;
  for (const auto& [one, colour] : colours) {
    if (one == name) return colour;
    names += (names.empty() ? "" : ", ") + one;
  }
  throw UsageError(fmt::format("{} \"{}\"; {} are allowed", option, name, names));
}

struct LaidHand {
  SpreadHand spread;
  std::optional<Hand> hand;  ///< if it is one of Palmar's
};

LaidHand laid_hand(const PhantomSheetArguments& arguments, std::uint64_t seed) {
  const Side side = parse_side(arguments.side);
  const SpreadOptions options{.seed = seed, .together = arguments.together};
  if (arguments.hand.empty()) return {spread_person(*load_hand(arguments.base), side, options), {}};
  Hand hand = *load_hand(arguments.hand);
  if (hand.side != side) hand = mirrored(hand);
  return {spread_hand(hand, options), hand};
}

int run_sheet(PhantomSheetArguments arguments, const Context& context) {
  SheetPhotographOptions& photograph = arguments.photograph;
  photograph.seed = context.common.seed;
  photograph.check();
  const SheetFormat& format = sheet_format_named(arguments.sheet);
  photograph.width = format.width;
  photograph.height = format.height;
  photograph.is_card = format.corner > 0.0;
  photograph.corner = format.corner;
  photograph.thickness = format.thickness;
  photograph.table = colour_named("--table", arguments.table,
                                  {{"wood", {0.62F, 0.43F, 0.28F}},
                                   {"dark", {0.16F, 0.14F, 0.13F}},
                                   {"grey", {0.45F, 0.45F, 0.46F}},
                                   {"blue", {0.24F, 0.36F, 0.52F}},
                                   {"white", {0.90F, 0.90F, 0.89F}}});
  photograph.skin = colour_named("--skin", arguments.skin,
                                 {{"light", {0.87F, 0.70F, 0.61F}},
                                  {"middle", {0.70F, 0.50F, 0.38F}},
                                  {"dark", {0.36F, 0.23F, 0.17F}}});
  const LaidHand laid = laid_hand(arguments, context.common.seed);
  const RgbImage image = photograph_on_sheet(laid.spread, photograph);
  PhotoExif exif;
  constexpr double kPixelsPerMm = 1.0 / 0.0014;
  const double longer = std::max(image.width, image.height);
  exif.camera = "Phantom";
  exif.focal_mm = std::round(100.0 * photograph.focal * longer / kPixelsPerMm) / 100.0;
  exif.focal_35mm = std::round(photograph.focal * longer * std::hypot(36.0, 24.0) /
                               std::hypot(image.width, image.height));
  exif.pixels_per_mm = kPixelsPerMm;
  exif.width = image.width;
  exif.height = image.height;
  const std::filesystem::path out(arguments.out);
  create_folder(out);
  write_file(out / "photo.jpg",
             format_jpeg(image, 92, arguments.no_exif ? std::string() : format_exif(exif)));
  nlohmann::ordered_json truth = nlohmann::ordered_json::object();
  for (const HandDimension dimension : all_hand_dimensions()) {
    truth[name_of(dimension) + "_mm"] = value_of(laid.spread.dimensions, dimension);
  }
  write_file(out / "truth.json", truth.dump(1) + "\n");
  const std::string shape = (out / (laid.hand ? "truth.hand.glb" : "truth.ply")).string();
  if (laid.hand) {
    write_hand(shape, *laid.hand);
  } else {
    write_mesh(shape, hand_on_sheet(laid.spread, photograph));
  }
  print(fmt::format("photograph: {}\ntruth: {}, {}\n", (out / "photo.jpg").string(),
                    (out / "truth.json").string(), shape));
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
  SheetPhotographOptions& p = o->photograph;
  verb->add_option("--out", o->out, "Folder; photo.jpg, truth.json, truth.ply go into it")
      ->required();
  verb->add_option("--base", o->base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->add_option("--hand", o->hand,
                   "One of Palmar's hands instead of a person of its own: \"template\" or a "
                   ".hand.glb file; truth.hand.glb is written then");
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--sheet", o->sheet, "a4, letter or card (a bank card beside the hand)")
      ->capture_default_str();
  verb->add_option("--table", o->table, "wood, dark, grey, blue or white")->capture_default_str();
  verb->add_flag("--plain", p.is_plain, "The table has no grain");
  verb->add_option("--skin", o->skin, "light, middle or dark")->capture_default_str();
  verb->add_option("--tilt-deg", p.tilt, "Of the camera from the sheet's normal")
      ->capture_default_str();
  verb->add_option("--distance-mm", p.distance, "Of the camera from the sheet")
      ->capture_default_str();
  verb->add_option("--width-px", p.pixels_wide, "Of the photograph")->capture_default_str();
  verb->add_option("--height-px", p.pixels_high, "Of the photograph")->capture_default_str();
  verb->add_option("--together", o->together, "0: fingers spread; 1: side by side")
      ->capture_default_str();
  verb->add_option("--wrist-inside-mm", p.wrist_inside,
                   "How far inside the sheet's edge the wrist crease lies")
      ->capture_default_str();
  verb->add_option("--focal", p.focal,
                   "Of the lens over the picture's longer side; 0.74: 26 mm on film, as most "
                   "telephones have")
      ->capture_default_str();
  verb->add_option("--k1", p.k1, "Of the lens' distortion; a telephone's picture: about -0.02")
      ->capture_default_str();
  verb->add_flag("--no-exif", o->no_exif, "The photograph doesn't say what lens took it");
  verb->callback([&context, o] { context.run = [&context, o] { return run_sheet(*o, context); }; });
}

}  // namespace palmar::cli
