// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/grasp/grip.h"
#include "palmar/product/make_product.h"
#include "palmar/product/parts/part_place.h"
#include "palmar/records/handle_file.h"
#include "palmar/records/handle_json.h"
#include "palmar/records/product/cad_handle.h"
#include "palmar/redesign/contact_region.h"
#include "palmar/redesign/held_hand.h"
#include "palmar/report/picture/depth_pictures.h"

namespace palmar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kLeastEndRadius = 3.0;  // mm; so that an end isn't felt as an edge; our choice

/// How the hands lie: by the hold, which is the same for all; thumb and breadth as means over them.
HandsOnHandle hands_on_handle(const HeldOriginal& original, const Hold& hold,
                              const Progress& progress) {
  const ProductPart& part = original.parts().parts.at(static_cast<std::size_t>(hold.part - 1));
  const Rigid3 place = part_frame(part, hold.along, hold.turn);
  HandsOnHandle result;
  result.place = place.translation;
  result.thumb_side = hold.toward * (place.rotation * Vec3::UnitX());
  result.palm = place.rotation * Vec3::UnitZ();
  Vec3 thumb = Vec3::Zero();
  double pressed = 0.0, breadth = 0.0;
  int hands = 0;
  for_each_held_hand(
      original.study.plan, original.study.inputs, original.source(), {}, 0,
      [&](const HeldHand& held) {
        breadth += held.who->dimensions.hand_width;
        ++hands;
        for (std::size_t i = 0; i < held.pressure.size(); ++i) {
          if (!(held.pressure[i] > 0.0) || part_of(held.who->region[i]) != HandPart::kThumb) {
            continue;
          }
          thumb += held.pressure[i] * held.skin.vertices[i];
          pressed += held.pressure[i];
        }
      },
      progress);
  result.breadth = breadth / hands;
  result.thumb = pressed > 0.0 ? Vec3(thumb / pressed)
                               : Vec3(result.place + 0.36 * result.breadth * result.thumb_side);
  return result;
}

/// The hold that a handle is shaped for. Throws UsageError if it is none of a whole hand round it.
Hold hold_for_shape(const HeldOriginal& original) {
  const std::optional<Hold> hold = original.hold();
  if (!hold) {
    throw UsageError(original.product().name +
                     ": held at given coordinates; a shape is made for a hold (setting \"part\", "
                     "setting \"along\" and setting \"toward\" say which)");
  }
  if (!is_power(hold->grip) || hold->is_over_end) {
    throw UsageError(fmt::format(
        "{}: held in a {} grip; a shape is made for a hand that closes round a handle (setting "
        "\"grips\" medium_wrap, for example)",
        original.product().name, name_of(hold->grip)));
  }
  return *hold;
}

/// Index of the candidate that was asked for.
int picked(int number, const SearchResult& found) {
  const auto count = static_cast<int>(found.history.size());
  if (number > count ||
      !found.history[static_cast<std::size_t>(number - 1)].outcome.failure.empty()) {
    throw UsageError(fmt::format(
        "setting \"pick\" is {}; the number of a candidate that could be made is allowed, 1 to {}",
        number, count));
  }
  return number - 1;
}

std::vector<ShapeVariable> variables_of(const RedesignShapeRequest& request,
                                        const HandleFeatures& start) {
  std::vector<ShapeVariable> variables;
  if (!request.features.empty()) return variables;
  std::vector<std::string> words = request.vary;
  if (words.empty()) words = usual_variables(request.limits.suits_both_hands);
  for (const std::string& one : words) {
    variables.push_back(shape_variable(one, start));
    const HandleFeature& feature = *variables.back().feature;
    if (request.limits.suits_both_hands && feature.is_one_sided) {
      throw UsageError(fmt::format(
          "setting \"vary\" \"{}\": a {} suits one hand only, and setting \"suits both hands\" "
          "is on",
          one, feature.name));
    }
  }
  return variables;
}

/// Where the search begins: what is `given`, or else nearest to the original, within what a search
/// may vary.
HandleShape start_of(const RedesignShapeRequest& request, const HandleBody& body,
                     const FittedFeatures& fitted, const std::optional<HandleFile>& given) {
  HandleShape start{.body = body, .features = fitted.features};
  start.kept_ends = request.limits.kept_ends;
  start.kept_boxes = request.limits.kept_boxes;
  if (body.is_whole) {
    start.end_radius = request.end_radius.value_or(std::max(kLeastEndRadius, body.end_radius));
  }
  if (given) {
    start.features = given->features;
    start.kept_ends = given->kept_ends;
    start.kept_boxes = given->kept_boxes;
    if (body.is_whole) start.end_radius = given->end_radius;
  } else if (request.limits.suits_both_hands) {
    for (const HandleFeature& one : handle_features()) {
      if (one.is_one_sided) start.features.*one.value = 0.0;
    }
  }
  return start;
}

/// The shape as files, and as the product that hands hold.
Product write_shape(const RedesignShapeRequest& request, const Product& original,
                    RedesignShapeOutcome& outcome, const Progress& progress) {
  const fs::path& folder = request.redesign.out;
  const HandleShape& shape = outcome.shape;
  const HandleSolid solid = make_handle(shape, original.name, 0.01, {}, progress);
  outcome.solid_volume = solid.volume;
  outcome.faces = solid.faces;
  outcome.poles = solid.poles;
  UnitDecision unit;
  unit.unit = LengthUnit::kMillimetre;
  unit.source = UnitSource::kMade;
  const std::string name = original.name + " shaped";
  const bool is_whole = shape.body.is_whole;
  Product product =
      is_whole ? make_product(name, solid.mesh.mesh, unit, "redesign.step", &solid.mesh.faces)
               : shaped_product(original, shape, name);
  outcome.file = folder / (is_whole ? "redesign.step" : "redesign.stl");
  write_file(folder / (is_whole ? "redesign.step" : "handle.step"), solid.step);
  write_mesh(folder / "redesign.stl", product.mesh);
  write_file(folder / "handle.toml", handle_toml(shape, original.name));
  write_file(folder / "handle.FCMacro", freecad_macro(shape, original.name));
  return product;
}

void write_search(const RedesignShapeRequest& request, const RedesignShapeOutcome& outcome) {
  const fs::path& folder = request.redesign.out;
  write_file(folder / "history.csv", history_csv(outcome.story));
  write_file(folder / "history.svg", history_svg(outcome.story));
  write_file(folder / "choices.svg", choices_svg(outcome.story));
}

void write_shape_pictures(const RedesignShapeRequest& request, const Product& original,
                          const Product& redesign, const HandleShape& shape,
                          const Progress& progress) {
  DepthScene scene;
  // The map's even triangles show shading better than a tessellation's long ones.
  scene.mesh = shape.body.is_whole ? handle_mesh(shape) : redesign.mesh;
  std::vector<DistanceSample> samples(scene.mesh.vertices.size());
  constexpr double kFar = 100.0;  // mm
  original.distance->sample(scene.mesh.vertices, kFar, samples);
  for (const DistanceSample& one : samples) scene.depth.push_back(std::abs(one.distance));
  scene.title = original.name + ", shaped anew";
  scene.subtitle = "colours: distance from the original's surface";
  scene.axis = shape.body.product_from_handle.rotation * Vec3::UnitZ();
  scene.palm = -(shape.body.product_from_handle.rotation * Vec3::UnitY());
  for (const Picture& picture : depth_pictures(scene, {}, progress)) {
    write_file(request.redesign.out / (picture.name + ".png"), encode_png(picture.image));
  }
}

Json json_of(const RedesignShapeRequest& request, const RedesignShapeOutcome& outcome) {
  Json json = {
      {"product", request.redesign.product},
      {"command", request.redesign.command},
      {"seed", request.redesign.seed},
      {"population", request.redesign.populations},
      {"search", Json::parse(history_json(outcome.story))},
      {"spread",
       {{"places", request.spread.places},
        {"along_mm", request.spread.along},
        {"turn_deg", handle_feature("turn").scale * request.spread.turn}}},
      {"features", features_json(outcome.shape.features)},
      {"is_whole", outcome.shape.body.is_whole},
      {"end_radius_mm", outcome.shape.end_radius},
      {"fit_rms_mm", outcome.fit_rms},
      {"largest_change_mm", outcome.change.largest},
      {"volume_ratio", outcome.change.volume_ratio},
      {"smallest_radius_mm", outcome.change.smallest_radius},
      {"file", outcome.file.string()},
      {"solid",
       {{"volume_mm3", outcome.solid_volume}, {"faces", outcome.faces}, {"poles", outcome.poles}}}};
  return json;
}

}  // namespace

std::vector<std::string> usual_variables(bool suits_both_hands) {
  std::vector<std::string> all = {"width", "depth", "squareness", "taper",
                                  "swell", "waist", "egg",        "palm_swell"};
  if (!suits_both_hands) all.push_back("turn");
  return all;
}

void RedesignShapeRequest::check() const {
  redesign.check();
  search.check();
  limits.check();
  spread.check();
  if (redesign.keeps_posture()) {
    throw UsageError(
        "setting \"posture\" kept: a shape is made for hands that take it in hand; new is "
        "allowed");
  }
  for (const std::string& words : vary) handle_feature(words.substr(0, words.find('=')));
  if (pick && *pick < 1) {
    throw UsageError(fmt::format("setting \"pick\" is {}; 1 or more is allowed", *pick));
  }
  if (end_radius && !(*end_radius >= 0.0 && *end_radius <= 30.0)) {
    throw UsageError(
        fmt::format("setting \"end radius\" is {:g} mm; 0 to 30 mm are allowed", *end_radius));
  }
  if (!features.empty() && !vary.empty()) {
    throw UsageError("setting \"features\" is made as it is; it doesn't go with setting \"vary\"");
  }
}

RedesignShapeOutcome redesign_shape(const RedesignShapeRequest& request, const Progress& progress) {
  request.check();
  RedesignShapeOutcome outcome;
  const FeatureGoal goal = feature_goal(request.goal);
  // Before anything is said of the hold.
  const std::optional<HandleFile> given =
      request.features.empty() ? std::nullopt : std::optional(read_handle(request.features));
  const HeldOriginal original = grasp_original(request.redesign, progress);
  outcome.notes = original.study.notes;
  const Product& product = original.product();
  const Hold hold = hold_for_shape(original);
  const HandleBody body =
      measure_handle(product, original.parts().parts.at(static_cast<std::size_t>(hold.part - 1)),
                     hands_on_handle(original, hold, progress));
  const FittedFeatures fitted = fit_features(body);
  outcome.fit_rms = fitted.rms;

  ShapeRun run{.request = request.redesign,
               .original = original,
               .goal = goal,
               .limits = request.limits,
               .spread = request.spread,
               .start = start_of(request, body, fitted, given),
               .variables = {},
               .offsets = {},
               .before = {}};
  run.variables = variables_of(request, run.start.features);
  run.hold_original(progress);
  outcome.story = run.search(request.search, progress);
  create_folder(request.redesign.out);
  write_search(request, outcome);
  SearchResult& found = outcome.story.result;
  if (request.pick) found.best = picked(*request.pick, found);
  if (!found.best) {
    throw NumericalError(
        fmt::format("{}: no candidate is within the limits; {} has all that were "
                    "tried",
                    request.redesign.product, (request.redesign.out / "history.csv").string()));
  }
  outcome.shape = run.shape_of(found.history[static_cast<std::size_t>(*found.best)].values);
  outcome.change = shape_change(outcome.shape);
  const Product redesign = write_shape(request, product, outcome, progress);
  if (!outcome.shape.body.is_whole) {
    outcome.add_note(
        request.redesign,
        product.name +
            " goes on beyond its handle: redesign.stl has all of it, handle.step the handle alone");
  }
  Json json = json_of(request, outcome);
  if (request.draws) write_shape_pictures(request, product, redesign, outcome.shape, progress);
  write_file(request.redesign.out / "shape.json", json.dump(2) + "\n");
  if (request.on_shape) request.on_shape(outcome);
  outcome.json = json.dump();
  if (request.compares) {
    outcome.judge(request.redesign, original, {redesign, "shaped", outcome.file.string()},
                  progress);
  }
  if (outcome.gains) {
    json["gains"] = Json::parse(gains_json(*outcome.gains));
    write_file(request.redesign.out / "shape.json", json.dump(2) + "\n");
  }
  return outcome;
}

}  // namespace palmar
