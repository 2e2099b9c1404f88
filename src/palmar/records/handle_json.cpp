// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/handle_json.h"

#include "palmar/core/error.h"

namespace palmar::records {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::vector<double> corners_of(const Box3& box) {
  return {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
}

Box3 box_of_corners(std::span<const double> corners) {
  if (corners.size() != 6) {
    throw InputError("a box has " + std::to_string(corners.size()) +
                     " coordinates; 6 of two corners are required");
  }
  Box3 box;
  box.extend(Vec3(corners[0], corners[1], corners[2]));
  box.extend(Vec3(corners[3], corners[4], corners[5]));
  return box;
}

namespace {

Json outlines_json(const redesign::HandleOutlines& outlines) {
  return {{"z_mm", outlines.z}, {"columns", outlines.columns}, {"radius_mm", outlines.radius}};
}

redesign::HandleOutlines outlines_from(const Json& json) {
  const redesign::HandleOutlines outlines{
      .z = json.at("z_mm").get<std::vector<double>>(),
      .columns = json.at("columns").get<int>(),
      .radius = json.at("radius_mm").get<std::vector<std::vector<double>>>()};
  bool fits = outlines.z.size() >= 2 && outlines.columns >= 3 &&
              outlines.radius.size() == outlines.z.size();
  for (const auto& row : outlines.radius) {
    fits = fits && row.size() == static_cast<std::size_t>(outlines.columns);
  }
  if (!fits) throw InputError("the handle's outlines don't fit together");
  return outlines;
}

}  // namespace

Json features_json(const redesign::HandleFeatures& features) {
  Json json = Json::object();
  for (const redesign::HandleFeature& one : redesign::handle_features()) {
    json[one.name] = one.scale * features.*one.value;
  }
  return json;
}

Json handle_shape_json(const redesign::HandleShape& shape) {
  const redesign::HandleBody& body = shape.body;
  const Quat& q = body.product_from_handle.rotation;
  const Vec3& o = body.product_from_handle.translation;
  Json centre = Json::array();
  for (const Eigen::Vector2d& one : body.centre) centre.push_back({one.x(), one.y()});
  Json boxes = Json::array();
  for (const Box3& box : shape.kept_boxes) boxes.push_back(corners_of(box));
  return {{"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"origin_mm", {o.x(), o.y(), o.z()}},
          {"bottom_mm", body.bottom},
          {"top_mm", body.top},
          {"is_whole", body.is_whole},
          {"old_end_radius_mm", body.end_radius},
          {"run_out_mm", body.run_out},
          {"is_free", body.is_free},
          {"centre_mm", std::move(centre)},
          {"outlines", outlines_json(body.outlines)},
          {"breadth_mm", body.hands.breadth},
          {"thumb_at_mm", body.hands.thumb_at},
          {"thumb_phi_rad", body.hands.thumb_phi},
          {"features", features_json(shape.features)},
          {"end_radius_mm", shape.end_radius},
          {"kept_ends_mm", shape.kept_ends},
          {"kept_boxes_mm", std::move(boxes)},
          {"to_kept_faces",
           shape.to_kept_faces.z.empty() ? Json() : outlines_json(shape.to_kept_faces)},
          {"follows", shape.follows ? Json{{"directions_rad", shape.follows->directions},
                                           {"distance_mm", shape.follows->distance}}
                                    : Json()}};
}

redesign::HandleShape handle_shape_from(const Json& json) {
  redesign::HandleShape shape;
  redesign::HandleBody& body = shape.body;
  const auto q = json.at("rotation_xyzw").get<std::array<double, 4>>();
  const auto o = json.at("origin_mm").get<std::array<double, 3>>();
  body.product_from_handle = {Quat(q[3], q[0], q[1], q[2]).normalized(), Vec3(o[0], o[1], o[2])};
  body.bottom = json.at("bottom_mm").get<double>();
  body.top = json.at("top_mm").get<double>();
  body.is_whole = json.at("is_whole").get<bool>();
  body.end_radius = json.at("old_end_radius_mm").get<double>();
  body.run_out = json.at("run_out_mm").get<double>();
  body.is_free = json.at("is_free").get<std::array<bool, 2>>();
  for (std::size_t i = 0; i < body.centre.size(); ++i) {
    const auto at = json.at("centre_mm").at(i).get<std::array<double, 2>>();
    body.centre[i] = {at[0], at[1]};
  }
  body.outlines = outlines_from(json.at("outlines"));
  body.hands = {json.at("breadth_mm").get<double>(), json.at("thumb_at_mm").get<double>(),
                json.at("thumb_phi_rad").get<double>()};
  for (const auto& [name, value] : json.at("features").items()) {
    const redesign::HandleFeature& one = redesign::handle_feature(name);
    shape.features.*one.value = value.get<double>() / one.scale;
  }
  shape.end_radius = json.at("end_radius_mm").get<double>();
  shape.kept_ends = json.at("kept_ends_mm").get<std::array<double, 2>>();
  for (const Json& one : json.at("kept_boxes_mm")) {
    shape.kept_boxes.push_back(box_of_corners(one.get<std::vector<double>>()));
  }
  if (!json.at("to_kept_faces").is_null()) {
    shape.to_kept_faces = outlines_from(json.at("to_kept_faces"));
  }
  if (const Json& grid = json.at("follows"); !grid.is_null()) {
    shape.follows = {grid.at("directions_rad").get<std::vector<double>>(),
                     grid.at("distance_mm").get<double>()};
    if (shape.follows->directions.size() < 8 || !(shape.follows->distance > 0.0)) {
      throw InputError("the grid that the handle's surface follows is too coarse");
    }
  }
  return shape;
}

}  // namespace palmar::records
