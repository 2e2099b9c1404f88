// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/redesign/held_hand.h"
#include "palmar/report/picture/depth_pictures.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const std::string kOfTouching = "-of-touching";

/// What the hands give besides their skin.
struct HandsOnProduct {
  std::vector<geometry::TriangleMesh> skins;
  Vec3 axis = Vec3::Zero();  ///< of the handle, unit: across the fingers
  Vec3 palm = Vec3::Zero();  ///< from the palm into the product
};

HandsOnProduct hands_on(const HeldOriginal& original, const std::optional<Vec3>& axis,
                        const Progress& progress) {
  HandsOnProduct result;
  redesign::for_each_held_hand(
      original.study.plan, original.study.inputs, original.source(), {}, 0,
      [&](const redesign::HeldHand& held) {
        result.skins.push_back(held.skin);
        result.axis += held.product_from_hand.rotation * Vec3::UnitX();
        result.palm += held.product_from_hand.rotation * Vec3::UnitZ();
      },
      progress);
  // Hands lie a little obliquely on a handle: its own axis is taken if one is near theirs.
  if (axis) {
    result.axis = *axis;
  } else {
    constexpr double kOblique = 0.8;  // cosine of 37 degrees
    const Vec3 across = result.axis.normalized();
    double nearest = kOblique;
    for (const grasp::GripSite& site : grasp::find_grip_sites(original.product().mesh)) {
      const double cosine = site.axis.dot(across);
      if (std::abs(cosine) <= nearest) continue;
      nearest = std::abs(cosine);
      result.axis = std::copysign(1.0, cosine) * site.axis;
    }
  }
  result.axis = result.axis.norm() > 1e-9 ? Vec3(result.axis.normalized()) : Vec3::UnitZ();
  return result;
}

redesign::PressedShapeOptions shape_options(const RedesignPressRequest& request) {
  redesign::PressedShapeOptions options = request.shape;
  for (const std::string& face : request.keep_faces) options.keep_out.add_face(face);
  return options;
}

Json press_settings(const RedesignPressRequest& request) {
  const redesign::PressedShapeOptions& o = request.shape;
  Json boxes = Json::array();
  for (const Box3& box : o.keep_out.boxes) {
    boxes.push_back(
        {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()});
  }
  return {{"share", o.share},
          {"over", name_of(o.combine)},
          {"align", request.aligns ? "axis" : "none"},
          {"depth_limit_mm", o.depth_limit},
          {"wall_mm", o.wall},
          {"smoothing_mm", o.smoothing},
          {"rim_mm", o.rim_width},
          {"edge_mm", o.edge_length},
          {"keep_faces", request.keep_faces},
          {"keep_boxes_mm", std::move(boxes)},
          {"keep_blend_mm", o.keep_out.blend}};
}

Json press_figures(const redesign::PressedShape& shape, const product::Product& original) {
  const auto vector = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
  Json shifts = Json::array();
  for (const double shift : shape.shift) shifts.push_back(shift);
  return {
      {"hands", shape.hands},
      {"triangles", shape.mesh.triangle_count()},
      {"triangles_before", original.mesh.triangle_count()},
      {"is_closed", geometry::examine_topology(shape.mesh).is_closed},
      {"volume_before_mm3", geometry::signed_volume(original.mesh)},
      {"removed_volume_mm3", shape.removed_volume},
      {"deepest_mm", shape.deepest},
      {"deepest_at_mm", vector(shape.deepest_at)},
      {"pressed_area_mm2", shape.pressed_area},
      {"thinnest_wall_mm", std::isfinite(shape.thinnest_wall) ? Json(shape.thinnest_wall) : Json()},
      {"limited_area_mm2",
       {{"depth_limit", shape.limited_by_depth},
        {"wall", shape.limited_by_wall},
        {"keep_out", shape.limited_by_keep_out},
        {"crossing", shape.limited_by_crossing}}},
      {"shift_mm", std::move(shifts)}};
}

Json solid_figures(const PressedSolid& solid) {
  return {{"file", solid.file.string()},
          {"volume_mm3", solid.volume},
          {"end_radius_mm", solid.end_radius},
          {"largest_deviation_mm", solid.largest_deviation},
          {"rms_deviation_mm", solid.deviation},
          {"faces", solid.faces},
          {"poles", solid.poles}};
}

void write_pictures(const RedesignPressRequest& request, const redesign::PressedShape& shape,
                    const product::Product& original, const HandsOnProduct& hands,
                    const Progress& progress) {
  report::DepthScene scene;
  scene.mesh = shape.mesh;
  scene.depth = shape.depth;
  scene.title = original.name + ", pressed shape";
  scene.subtitle = fmt::format("{:g} of the overlap of {} hands", request.shape.share, shape.hands);
  scene.axis = hands.axis;
  scene.palm = hands.palm;
  for (const report::Picture& picture : report::depth_pictures(scene, {}, progress)) {
    formats::write_file(request.redesign.out / (picture.name + ".png"),
                        report::encode_png(picture.image));
  }
}

}  // namespace

std::string name_of(const redesign::CombineOptions& combine) {
  const bool is_mean = combine.statistic == redesign::ImprintStatistic::kMean;
  return (is_mean ? "mean" : fmt::format("{:g}", combine.percentile)) +
         (combine.is_among_touching ? kOfTouching : "");
}

redesign::CombineOptions combine_options(const std::string& words) {
  redesign::CombineOptions combine;
  std::string text = words;
  if (text.size() > kOfTouching.size() && text.ends_with(kOfTouching)) {
    combine.is_among_touching = true;
    text.resize(text.size() - kOfTouching.size());
  }
  if (text == "mean") return combine;
  const std::optional<double> percentile = formats::parse_double(text);
  if (!percentile || !std::isfinite(*percentile)) {
    throw UsageError("setting \"over\" is \"" + words +
                     "\"; mean or a percentile, 0 to 100, is allowed");
  }
  combine.statistic = redesign::ImprintStatistic::kPercentile;
  combine.percentile = *percentile;
  return combine;
}

void RedesignPressRequest::check() const {
  redesign.check();
  shape.check();
  if (formats.empty())
    throw UsageError("setting \"formats\" is empty; stl, obj or ply is required");
  for (const std::string& format : formats) {
    if (format != "stl" && format != "obj" && format != "ply") {
      throw UsageError("setting \"formats\" has \"" + format + "\"; stl, obj and ply are allowed");
    }
  }
}

RedesignPressOutcome redesign_press(const RedesignPressRequest& request, const Progress& progress) {
  request.check();
  const HeldOriginal original = grasp_original(request.redesign, progress);
  const product::Product& product = original.product();
  const HandsOnProduct hands = hands_on(original, request.redesign.axis, progress);
  redesign::PressedShapeOptions options = shape_options(request);
  if (request.aligns) options.align_along = hands.axis;
  RedesignPressOutcome outcome;
  outcome.shape = redesign::press_shape(product, hands.skins, options, progress);
  outcome.volume_before = geometry::signed_volume(product.mesh);
  outcome.file = request.redesign.out / ("pressed." + request.formats.front());
  outcome.notes = original.study.notes;
  const redesign::PressedShape& shape = outcome.shape;

  const fs::path& folder = request.redesign.out;
  formats::create_folder(folder);
  for (const std::string& format : request.formats) {
    formats::write_mesh(folder / ("pressed." + format), shape.mesh);
  }
  Json json{{"product", product.name},
            {"source", product.source},
            {"command", request.redesign.command},
            {"seed", request.redesign.seed},
            {"population", request.redesign.populations},
            {"posture", name_of(request.redesign.posture)},
            {"settings", press_settings(request)},
            {"figures", press_figures(shape, product)}};
  if (request.draws) write_pictures(request, shape, product, hands, progress);
  const product::Product pressed =
      redesign::pressed_product(product, shape, product.name + " pressed");
  std::optional<std::string> why_no_solid;
  if (shape.deepest > 0.0) {
    auto solid = write_pressed_solid(request.redesign, original, pressed, options, progress);
    if (const auto* made = std::get_if<PressedSolid>(&solid))
      outcome.solid = *made;
    else
      why_no_solid = std::get<std::string>(solid);
  }
  if (outcome.solid) json["solid"] = solid_figures(*outcome.solid);
  formats::write_file(folder / "pressed.json", json.dump(2) + "\n");
  if (request.on_shape) request.on_shape(outcome);
  outcome.json = json.dump();
  if (why_no_solid) {
    outcome.add_note(request.redesign, "no STEP file of the pressed shape: " + *why_no_solid);
  }
  if (shape.deepest <= 0.0) {
    outcome.add_note(request.redesign, "nothing was pressed: there is nothing to compare");
  }
  if (request.compares && shape.deepest > 0.0) {
    outcome.judge(request.redesign, original, {pressed, "pressed", outcome.file.string()},
                  progress);
  }
  return outcome;
}

}  // namespace palmar::workflow
