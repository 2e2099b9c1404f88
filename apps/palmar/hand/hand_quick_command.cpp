// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_quick_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "hand/outline_picture.h"
#include "hand/side_argument.h"
#include "palmar/capture/sheet/card_view.h"
#include "palmar/capture/sheet/outline_person.h"
#include "palmar/capture/sheet/skin_mask.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/formats/image/exif.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/template_hand.h"
#include "palmar/population/segment_regressions.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/population/population_file.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct QuickArguments {
  std::string photo, population = "ansur2", sheet, side, out, picture;
  std::optional<double> length, circumference, width;
  std::vector<std::string> dimensions;
  double error = 1.5;         // mm, of what a person measured by hand
  double wrist_inside = 0.0;  // mm
  bool palm_up = false;
};

constexpr double kMostTilt = 25.0;  // deg: docs/method/outline.md

constexpr HandDimension kLength{DimensionKind::kHandLength};
constexpr HandDimension kCircumference{DimensionKind::kHandCircumference};
constexpr HandDimension kWidth{DimensionKind::kHandWidth};

constexpr std::array<const char*, 5> kFingers = {"thumb", "index", "middle", "ring", "little"};

struct Photographed {
  RgbImage image;
  OutlineScene scene;
  HandOutline outline;
};

Photographed photographed(const QuickArguments& arguments) {
  const std::string bytes = read_file(arguments.photo, std::uint64_t{256} << 20);
  Photographed result;
  result.image = read_texture(bytes, arguments.photo);
  SheetOptions sheet;
  sheet.most_tilt = kMostTilt;
  if (!arguments.sheet.empty()) sheet.format = sheet_format_named(arguments.sheet);
  if (const auto exif = read_exif(bytes)) {
    sheet.focal = exif->focal_pixels(result.image.width, result.image.height);
  }
  const bool is_card = sheet.format && sheet.format->name == card_format().name;
  OutlineScene& scene = result.scene;
  scene.sheet = is_card ? find_card(result.image, arguments.photo, sheet)
                        : find_sheet(result.image, arguments.photo, sheet);
  scene.grid = is_card ? grid_beside_card(scene.sheet, kOutlineCell)
                       : grid_of_sheet(scene.sheet, kOutlineCell);
  scene.proportions = outline_proportions(template_proportions());
  scene.options.wrist = arguments.wrist_inside;
  scene.options.palm_up = arguments.palm_up;
  const Ground ground = is_card ? Ground::kTable : Ground::kPaper;
  const VoxelMask skin =
      skin_mask(draw_sheet(result.image, scene.sheet, scene.grid, ground), ground, arguments.photo);
  result.outline = measure_outline(scene.grid, skin, scene.sheet, scene.proportions,
                                   arguments.photo, scene.options);
  return result;
}

std::vector<KnownMeasure> measures_of(const QuickArguments& arguments) {
  std::vector<KnownMeasure> list;
  const auto add = [&](HandDimension dimension, const std::optional<double>& value) {
    if (value) list.push_back(KnownMeasure::of(dimension, *value, arguments.error));
  };
  add(kLength, arguments.length);
  add(kCircumference, arguments.circumference);
  add(kWidth, arguments.width);
  for (const std::string& setting : arguments.dimensions) {
    const std::size_t equals = setting.find('=');
    const auto dimension = hand_dimension_named(setting.substr(0, equals));
    if (equals == std::string::npos || !dimension) {
      throw UsageError("--dimension: \"" + setting +
                       "\" is not of the form index_distal_width=14 "
                       "(mm); palmar hand measure lists the names");
    }
    add(*dimension, parse_list("--dimension", setting.substr(equals + 1)).front());
  }
  return list;
}

std::string how(const EstimatedDimension& one) {
  return one.is_measured ? "measured" : name_of(one.evidence);
}

std::string text_of(const PersonEstimate& estimate, const Population& population) {
  std::string text = fmt::format("{:<26} {:>8} {:>8}  (mm; 95 of 100 such hands lie within +-)\n",
                                 "dimension", "value", "+-");
  for (const EstimatedDimension& one : estimate.dimensions) {
    text += fmt::format("{:<26} {:8.1f} {:8.1f}  {}\n", name_of(one.dimension), one.value,
                        1.96 * one.sd, how(one));
  }
  if (population.strata.size() > 1) {
    text += "as among";
    for (std::size_t s = 0; s < population.strata.size(); ++s) {
      text +=
          fmt::format(" {} {:.0f} %", population.strata[s].name, 100.0 * estimate.stratum_share[s]);
    }
    text += "\n";
  }
  return text;
}

Json json_of(const Photographed& photo, const OutlinePerson& person) {
  const SheetView& sheet = photo.scene.sheet;
  const HandOutline& outline = person.outline;
  const auto point = [](const Eigen::Vector2d& p) { return Json{p.x(), p.y()}; };
  Json fingers = Json::object();
  for (std::size_t f = 0; f < 5; ++f) {
    const OutlineFinger& one = outline.finger[f];
    Json widths = Json::array();
    for (const double w : one.width) {
      if (w > 0.0) widths.push_back(w);
    }
    fingers[kFingers[f]] = {
        {"tip_mm", point(one.tip)}, {"base_mm", point(one.base)}, {"widths_mm", widths}};
    if (f > 0 && one.length > 0.0) fingers[kFingers[f]]["length_mm"] = one.length;
  }
  Json corners = Json::array();
  for (const Eigen::Vector2d& c : sheet.corner) corners.push_back(point(c));
  return {{"sheet", sheet.format.name},
          {"sheet_corners_px", corners},
          {"edge_error_mm", sheet.edge_error},
          {"tilt_deg", sheet.tilt},
          {"camera_mm", {sheet.eye.x(), sheet.eye.y(), sheet.eye.z()}},
          {"focal_px", sheet.focal},
          {"focal_from", sheet.focal_source},
          {"scale_error", sheet.scale_error},
          {"side", outline.is_right ? "right" : "left"},
          {"hand_length_mm", outline.hand_length},
          {"hand_width_mm", outline.hand_width},
          {"measured_against_a_model", person.model.has_value()},
          {"fingers", fingers}};
}

void tell(const Photographed& photo, const Context& context) {
  const SheetView& sheet = photo.scene.sheet;
  const bool is_card = sheet.format.name == card_format().name;
  const double finger = photo.scene.proportions.finger_height[2] * photo.outline.hand_length;
  note(context.common,
       fmt::format("{}, edges straight within {:.2f} mm; camera {:.0f} mm above it, {:.0f} "
                   "degrees off its normal{}",
                   is_card ? "bank card" : sheet.format.name + " sheet", sheet.edge_error,
                   sheet.eye.z(), sheet.tilt,
                   sheet.focal_source == "usual"
                       ? " if its lens is that of most telephones (26 mm on film)"
                       : ""));
  if (is_card) {
    note(context.common,
         fmt::format("lengths follow from so small a card within {:.1f} % (standard error)",
                     100.0 * sheet.scale_error));
  }
  note(context.common,
       fmt::format("skin above the paper looks larger: fingertips by {:.1f} %, which is taken off",
                   100.0 * finger / (sheet.eye.z() - finger)));
  if (photo.outline.hand_width <= 0.0) {
    note(context.common,
         "the thumb lies in the way of the breadth over the knuckles; it follows from the rest");
  }
}

/// What was found, drawn on the photograph, and what the model hides.
void write_picture(const std::string& path, const Photographed& photo,
                   const std::optional<ModelOutline>& model, const Context& context) {
  write_file(path, outline_picture(photo.image, photo.scene.sheet, photo.outline,
                                   model ? &model->outline : nullptr));
  note(context.common, "wrote " + path);
}

int run_quick(const QuickArguments& arguments, const Context& context) {
  const Population population = load_population(arguments.population);
  const std::vector<KnownMeasure> own = measures_of(arguments);
  std::optional<Photographed> photo;
  Side side = arguments.side.empty() ? Side::kRight : parse_side(arguments.side);
  if (!arguments.photo.empty()) {
    photo = photographed(arguments);
    const Side seen = photo->outline.is_right ? Side::kRight : Side::kLeft;
    if (!arguments.side.empty() && seen != side) {
      throw UsageError(
          fmt::format("--side {}: the thumb is that of a {} hand with its {} to the "
                      "camera{}",
                      arguments.side, name_of(seen), arguments.palm_up ? "palm" : "back",
                      arguments.palm_up ? "; is --palm-up meant?"
                                        : "; give --palm-up if the palm is seen, and "
                                          "don't mirror photographs"));
    }
    side = seen;
    tell(*photo, context);
  }
  if (own.empty() && !photo) {
    throw UsageError(
        "nothing is known of the hand: a photograph, --hand-length-mm, --circumference-mm, "
        "--width-mm or --dimension is required");
  }
  OutlinePerson person;
  if (photo) {
    person =
        person_of_outline(*load_hand("template"), population, own, photo->outline, photo->scene);
    for (const std::string& text : person.notes) note(context.common, text);
    if (!arguments.picture.empty()) {
      write_picture(arguments.picture, *photo, person.model, context);
    }
  } else {
    person.measures = static_cast<int>(own.size());
    person.estimate = estimate_person(population, own);
    person.hand = make_hand_instance(*load_hand("template"), sizes_of(person.estimate)).hand;
    if (side == Side::kLeft) person.hand = mirrored(person.hand);
  }
  const PersonEstimate& estimate = person.estimate;
  for (const std::string& text : estimate.notes) note(context.common, text);
  for (const std::string& text : population.cautions) note(context.common, text);
  Hand& hand = person.hand;
  hand.provenance += fmt::format("; sizes from {} measures{} and the people of {}", person.measures,
                                 !photo ? ""
                                 : photo->scene.sheet.format.name == card_format().name
                                     ? " of a photograph beside a bank card"
                                     : " of a photograph on a sheet of paper",
                                 population.name);
  if (!arguments.out.empty()) {
    write_hand(arguments.out, hand);
    note(context.common, fmt::format("wrote {} ({} hand)", arguments.out, name_of(side)));
  }
  if (!context.common.json) {
    print(text_of(estimate, population));
    return 0;
  }
  Json dimensions = Json::object();
  for (const EstimatedDimension& one : estimate.dimensions) {
    dimensions[name_of(one.dimension)] = {
        {"value_mm", one.value}, {"sd_mm", one.sd}, {"how", how(one)}};
  }
  Json json = {
      {"population", population.name}, {"side", name_of(side)}, {"dimensions", dimensions}};
  if (photo) json["photograph"] = json_of(*photo, person);
  print(json.dump(2) + "\n");
  return 0;
}

}  // namespace

void add_hand_quick(CLI::App& hand, Context& context) {
  const auto o = std::make_shared<QuickArguments>();
  CLI::App* verb = add_verb(
      hand, "quick",
      "A hand from a few measures, or from one photograph of it flat on a sheet of A4 or beside a "
      "bank card, and a population; tells how well each dimension is known",
      "palmar hand quick --hand-length-mm 181 --circumference-mm 190 --out anna.hand.glb");
  verb->add_option(
      "PHOTO", o->photo,
      "PNG or JPEG: the hand palm down on a white sheet, fingers spread, the crease of "
      "the wrist over the sheet's edge; or on a plain table, an edge of a bank card beside it "
      "level "
      "with that crease (--sheet card)");
  verb->add_option("--hand-length-mm", o->length, "Wrist crease to tip of the middle finger");
  verb->add_option("--circumference-mm", o->circumference, "Girth over the metacarpal heads");
  verb->add_option("--width-mm", o->width, "Breadth over the metacarpal heads");
  verb->add_option("--dimension", o->dimensions, "Any other, NAME=MM; repeatable")
      ->allow_extra_args(false);
  verb->add_option("--error-mm", o->error, "Standard error of what you measured by hand")
      ->capture_default_str();
  verb->add_option("--population", o->population, "Of what people: a name or a .toml file")
      ->capture_default_str();
  verb->add_option("--sheet", o->sheet, "a4, letter or card; default: a sheet, told by its shape");
  verb->add_option(
          "--wrist-inside-mm", o->wrist_inside,
          "How far inside the sheet's edge the crease of the wrist lies, or beyond the card's")
      ->capture_default_str();
  verb->add_flag("--palm-up", o->palm_up, "The palm looks at the camera");
  verb->add_option("--side", o->side, "right or left; with a photograph only checked");
  verb->add_option("--picture", o->picture,
                   "PNG to write: the photograph with what was found drawn on it");
  verb->add_option("--out", o->out, "File to write, *.hand.glb");
  verb->callback([&context, o] { context.run = [&context, o] { return run_quick(*o, context); }; });
}

}  // namespace palmar::cli
