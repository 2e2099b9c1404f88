// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/redesign/held_hand.h"
#include "palmar/redesign/pressed_shape.h"
#include "palmar/report/picture/depth_pictures.h"
#include "redesign/redesign_arguments.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct PressArguments {
  RedesignArguments redesign;
  PressedShapeOptions options;
  std::string over = "mean";
  std::string align = "none";
  std::vector<std::string> keep_faces, keep_boxes;
  std::vector<std::string> formats = {"stl"};
  bool no_pictures = false;
  bool no_compare = false;
};

/// What the hands tell besides their skin.
struct HandsOnProduct {
  std::vector<TriangleMesh> skins;
  Vec3 axis = Vec3::Zero();  ///< of the handle, unit: across the fingers
  Vec3 palm = Vec3::Zero();  ///< from the palm into the product
};

/// "mean", "mean-of-touching", "75" (percentile), "75-of-touching".
CombineOptions combine_from(std::string text) {
  CombineOptions combine;
  const std::string touching = "-of-touching";
  if (text.size() > touching.size() && text.ends_with(touching)) {
    combine.is_among_touching = true;
    text.resize(text.size() - touching.size());
  }
  if (text == "mean") return combine;
  const std::vector<double> numbers = parse_list("--over", text);
  if (numbers.size() != 1) {
    throw UsageError("--over is \"" + text + "\"; mean or a percentile, 0 to 100, is allowed");
  }
  combine.statistic = ImprintStatistic::kPercentile;
  combine.percentile = numbers.front();
  return combine;
}

void read_keep_out(const PressArguments& arguments, KeepOut& keep_out) {
  for (const std::string& face : arguments.keep_faces) {
    const bool is_number = !face.empty() && std::all_of(face.begin(), face.end(), [](char c) {
      return c >= '0' && c <= '9';
    });
    if (is_number && face.size() < 9) {
      keep_out.faces.push_back(std::stoi(face));
    } else {
      keep_out.names.push_back(face);
    }
  }
  for (const std::string& text : arguments.keep_boxes) {
    const std::vector<double> v = parse_list("--keep-box-mm", text);
    if (v.size() != 6 || v[0] > v[3] || v[1] > v[4] || v[2] > v[5]) {
      throw UsageError("--keep-box-mm is \"" + text +
                       "\"; two corners x,y,z,x,y,z in mm are required, the lower first");
    }
    keep_out.boxes.emplace_back(Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5]));
  }
}

HandsOnProduct hands_on(const HeldOriginal& original, const std::string& axis,
                        const Progress& progress) {
  HandsOnProduct result;
  for_each_held_hand(
      original.study.plan, original.study.inputs, original.source(), {}, 0,
      [&](const HeldHand& held) {
        result.skins.push_back(held.skin);
        result.axis += held.product_from_hand.rotation * Vec3::UnitX();
        result.palm += held.product_from_hand.rotation * Vec3::UnitZ();
      },
      progress);
  // Hands lie a little aslant on a handle: its own axis is taken if one is near theirs.
  if (!axis.empty()) {
    result.axis = parse_vector("--axis", axis);
  } else {
    constexpr double kAslant = 0.8;  // cosine of 37 degrees
    const Vec3 across = result.axis.normalized();
    double nearest = kAslant;
    for (const GripSite& site : find_grip_sites(original.product().mesh)) {
      const double cosine = site.axis.dot(across);
      if (std::abs(cosine) <= nearest) continue;
      nearest = std::abs(cosine);
      result.axis = std::copysign(1.0, cosine) * site.axis;
    }
  }
  result.axis = result.axis.norm() > 1e-9 ? Vec3(result.axis.normalized()) : Vec3::UnitZ();
  return result;
}

Json settings_json(const PressArguments& a) {
  const PressedShapeOptions& o = a.options;
  Json boxes = Json::array();
  for (const Box3& box : o.keep_out.boxes) {
    boxes.push_back(
        {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()});
  }
  return {{"share", o.share},
          {"over", a.over},
          {"align", a.align},
          {"depth_limit_mm", o.depth_limit},
          {"wall_mm", o.wall},
          {"smoothing_mm", o.smoothing},
          {"rim_mm", o.rim_width},
          {"edge_mm", o.edge_length},
          {"keep_faces", a.keep_faces},
          {"keep_boxes_mm", std::move(boxes)},
          {"keep_blend_mm", o.keep_out.blend}};
}

Json figures_json(const PressedShape& shape, const Product& original) {
  const auto vector = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
  Json shifts = Json::array();
  for (const double shift : shape.shift) shifts.push_back(shift);
  return {
      {"hands", shape.hands},
      {"triangles", shape.mesh.triangle_count()},
      {"triangles_before", original.mesh.triangle_count()},
      {"is_closed", examine_topology(shape.mesh).is_closed},
      {"volume_before_mm3", signed_volume(original.mesh)},
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

std::string figures_text(const PressedShape& shape, const Product& original,
                         const std::string& file) {
  std::string text = fmt::format(
      "{}: pressed over {} hand{}: deepest {:.2f} mm at ({:.1f}, {:.1f}, {:.1f}), {:.0f} mm2 "
      "pressed, {:.0f} mm3 removed ({:.2f} %)\n",
      file, shape.hands, shape.hands == 1 ? "" : "s", shape.deepest, shape.deepest_at.x(),
      shape.deepest_at.y(), shape.deepest_at.z(), shape.pressed_area, shape.removed_volume,
      100.0 * shape.removed_volume / std::max(1e-9, std::abs(signed_volume(original.mesh))));
  if (std::isfinite(shape.thinnest_wall)) {
    text += fmt::format("thinnest wall under it {:.1f} mm\n", shape.thinnest_wall);
  }
  for (const auto& [area, what] :
       {std::pair{shape.limited_by_depth, "the depth limit"},
        {shape.limited_by_wall, "the wall that must remain"},
        {shape.limited_by_keep_out, "the keep-out"},
        {shape.limited_by_crossing, "the surface, which would have folded or crossed itself"}}) {
    if (area > 0.0) text += fmt::format("held back on {:.0f} mm2 by {}\n", area, what);
  }
  if (!shape.shift.empty()) {
    const auto [low, high] = std::minmax_element(shape.shift.begin(), shape.shift.end());
    text += fmt::format("hands shifted by {:+.1f} to {:+.1f} mm onto each other\n", *low, *high);
  }
  return text;
}

void write_pictures(const PressArguments& a, const PressedShape& shape, const Product& original,
                    const HandsOnProduct& hands, const Progress& progress) {
  DepthScene scene;
  scene.mesh = shape.mesh;
  scene.depth = shape.depth;
  scene.title = original.name + ", pressed shape";
  scene.subtitle = fmt::format("{:g} of the overlap of {} hands", a.options.share, shape.hands);
  scene.axis = hands.axis;
  scene.palm = hands.palm;
  for (const Picture& picture : depth_pictures(scene, {}, progress)) {
    write_file(fs::path(a.redesign.out) / (picture.name + ".png"), encode_png(picture.image));
  }
}

int run_press(PressArguments a, const Context& context) {
  a.options.combine = combine_from(a.over);
  read_keep_out(a, a.options.keep_out);
  a.options.check();
  const Progress progress = make_progress(context.common);
  const HeldOriginal original = grasp_original(a.redesign, context, progress);
  const Product& product = original.product();
  const HandsOnProduct hands = hands_on(original, a.redesign.axis, progress);
  if (a.align == "axis") a.options.align_along = hands.axis;
  const PressedShape shape = press_shape(product, hands.skins, a.options, progress);

  const fs::path folder = a.redesign.out;
  create_folder(folder);
  for (const std::string& format : a.formats) {
    write_mesh(folder / ("pressed." + format), shape.mesh);
  }
  const fs::path file = folder / ("pressed." + a.formats.front());
  Json json{{"product", product.name},
            {"source", product.source},
            {"command", context.command_line},
            {"seed", context.common.seed},
            {"population", a.redesign.populations},
            {"posture", a.redesign.posture},
            {"settings", settings_json(a)},
            {"figures", figures_json(shape, product)}};
  write_file(folder / "pressed.json", json.dump(2) + "\n");
  if (!a.no_pictures) write_pictures(a, shape, product, hands, progress);
  finish_progress();
  if (!context.common.json) print(figures_text(shape, product, file.string()));
  if (shape.deepest <= 0.0)
    note(context.common, "nothing was pressed: there is nothing to compare");
  if (!a.no_compare && shape.deepest > 0.0) {
    const std::string comparison = compare_redesigns(
        a.redesign, original,
        {{pressed_product(product, shape, product.name + " pressed"), "pressed", file.string()}},
        context, progress);
    if (context.common.json) json["comparison"] = Json::parse(comparison);
  }
  if (context.common.json) print(json.dump(2) + "\n");
  return 0;
}

}  // namespace

void add_redesign_press_command(CLI::App& noun, Context& context) {
  const auto a = std::make_shared<PressArguments>();
  CLI::App* verb = add_verb(
      noun, "press",
      "Press the product's surface in where hands reach into it: concaves of fingers",
      "palmar redesign press handle.step --hands 30 --share 0.5 --keep-face 4 --out pressed");
  a->redesign.add_to(*verb);
  PressedShapeOptions& o = a->options;
  verb->add_option("--share", o.share,
                   "Of the overlap of undeformed skin and product, 0 to 1: 1 makes room for all")
      ->capture_default_str();
  verb->add_option(
          "--over", a->over,
          "Overlap over hands: mean, or a percentile (75); hands that don't touch count as "
          "0. mean-of-touching, 75-of-touching: without them")
      ->capture_default_str();
  verb->add_option("--align", a->align,
                   "axis: before they are combined, shift every hand along the handle until its "
                   "imprint lies best on those of all")
      ->check(CLI::IsMember({"none", "axis"}))
      ->capture_default_str();
  verb->add_option("--depth-limit-mm", o.depth_limit, "Never deeper")->capture_default_str();
  verb->add_option("--wall-mm", o.wall, "Thickness that must remain")->capture_default_str();
  verb->add_option("--keep-face", a->keep_faces,
                   "CAD face that must stay as it is: its number or name; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--keep-box-mm", a->keep_boxes,
                   "Box that must stay as it is: x,y,z,x,y,z, lower corner first; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--keep-blend-mm", o.keep_out.blend, "Over which the depth grows beside them")
      ->capture_default_str();
  verb->add_option("--smoothing-mm", o.smoothing, "Standard deviation of the smoothing")
      ->capture_default_str();
  verb->add_option("--rim-mm", o.rim_width, "Round the imprint, over which the depth ends")
      ->capture_default_str();
  verb->add_option("--edge-mm", o.edge_length, "Longest edge of triangles that move")
      ->capture_default_str();
  verb->add_option("--format", a->formats, "stl, obj, ply: file of the shape; may be repeated")
      ->check(CLI::IsMember({"stl", "obj", "ply"}))
      ->allow_extra_args(false)
      ->capture_default_str();
  verb->add_flag("--no-pictures", a->no_pictures, "Leave out the pictures");
  verb->add_flag("--no-compare", a->no_compare, "Only make the shape; hands don't hold it again");
  verb->callback([a, &context] { context.run = [a, &context] { return run_press(*a, context); }; });
}

}  // namespace palmar::cli
