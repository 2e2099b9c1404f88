// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/region_json.h"

#include "palmar/core/error.h"
#include "palmar/formats/json_reason.h"
#include "palmar/geometry/degrees.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

Json json_of(const std::vector<Vec3>& points) {
  Json list = Json::array();
  for (const Vec3& x : points) list.push_back(json_of(x));
  return list;
}

Vec3 vector_from(const Json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

std::vector<Vec3> points_from(const Json& value) {
  std::vector<Vec3> points;
  for (const Json& one : value) points.push_back(vector_from(one));
  return points;
}

product::FaceKind kind_from(const std::string& name) {
  for (const product::FaceKind kind :
       {product::FaceKind::kPlane, product::FaceKind::kCylinder, product::FaceKind::kCone,
        product::FaceKind::kSphere, product::FaceKind::kTorus}) {
    if (name_of(kind) == name) return kind;
  }
  throw InputError("region: \"" + name + "\" is no simple surface");
}

/// Each element of a list under `key`, read by `read`; none if there is no such key.
template <typename Read>
void for_each(const Json& request, const char* key, const Read& read) {
  if (!request.contains(key)) return;
  try {
    for (const Json& one : request.at(key)) read(one);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("region: ") + key + ": " + formats::json_reason(error));
  }
}

}  // namespace

Json region_request(const std::vector<NamedCurve>& curves,
                    const std::vector<NamedSurface>& surfaces,
                    const std::vector<redesign::RidgeRelief>& reliefs) {
  Json request = {
      {"curves", Json::array()}, {"surfaces", Json::array()}, {"reliefs", Json::array()}};
  for (const NamedCurve& one : curves) {
    request["curves"].push_back(
        {{"name", one.name}, {"colour", one.colour}, {"points_mm", json_of(one.points)}});
  }
  for (const NamedSurface& one : surfaces) {
    const redesign::SimpleSurface& s = one.surface;
    request["surfaces"].push_back({{"name", one.name},
                                   {"colour", one.colour},
                                   {"kind", name_of(s.kind)},
                                   {"point_mm", json_of(s.point)},
                                   {"axis", json_of(s.axis)},
                                   {"radius_mm", s.radius},
                                   {"tube_radius_mm", s.tube_radius},
                                   {"half_angle_deg", s.half_angle / geometry::kDegree},
                                   {"points_mm", json_of(one.points)},
                                   {"outline_mm", json_of(one.outline)}});
  }
  for (const redesign::RidgeRelief& one : reliefs) {
    request["reliefs"].push_back({{"name", one.name},
                                  {"start_mm", json_of(one.start)},
                                  {"end_mm", json_of(one.end)},
                                  {"outward", json_of(one.outward)},
                                  {"radius_mm", one.radius},
                                  {"half_angle_deg", one.half_angle / geometry::kDegree},
                                  {"run_out_mm", one.run_out},
                                  {"depth_mm", one.depth},
                                  {"radius_before_mm", one.radius_before},
                                  {"is_open_start", one.is_open_start},
                                  {"is_open_end", one.is_open_end}});
  }
  return request;
}

std::vector<NamedCurve> region_curves(const Json& request) {
  std::vector<NamedCurve> curves;
  for_each(request, "curves", [&](const Json& one) {
    curves.push_back({.name = one.at("name").get<std::string>(),
                      .colour = one.at("colour").get<std::array<float, 3>>(),
                      .points = points_from(one.at("points_mm"))});
  });
  return curves;
}

std::vector<NamedSurface> region_surfaces(const Json& request) {
  std::vector<NamedSurface> surfaces;
  for_each(request, "surfaces", [&](const Json& one) {
    redesign::SimpleSurface s;
    s.kind = kind_from(one.at("kind").get<std::string>());
    s.point = vector_from(one.at("point_mm"));
    s.axis = vector_from(one.at("axis"));
    s.radius = one.at("radius_mm").get<double>();
    s.tube_radius = one.at("tube_radius_mm").get<double>();
    s.half_angle = one.at("half_angle_deg").get<double>() * geometry::kDegree;
    surfaces.push_back({.name = one.at("name").get<std::string>(),
                        .colour = one.at("colour").get<std::array<float, 3>>(),
                        .surface = s,
                        .points = points_from(one.at("points_mm")),
                        .outline = points_from(one.at("outline_mm"))});
  });
  return surfaces;
}

std::vector<redesign::RidgeRelief> region_reliefs(const Json& request) {
  std::vector<redesign::RidgeRelief> reliefs;
  for_each(request, "reliefs", [&](const Json& one) {
    redesign::RidgeRelief relief;
    relief.name = one.at("name").get<std::string>();
    relief.start = vector_from(one.at("start_mm"));
    relief.end = vector_from(one.at("end_mm"));
    relief.outward = vector_from(one.at("outward"));
    relief.radius = one.at("radius_mm").get<double>();
    relief.half_angle = one.at("half_angle_deg").get<double>() * geometry::kDegree;
    relief.run_out = one.at("run_out_mm").get<double>();
    relief.depth = one.at("depth_mm").get<double>();
    relief.radius_before = one.at("radius_before_mm").get<double>();
    relief.is_open_start = one.at("is_open_start").get<bool>();
    relief.is_open_end = one.at("is_open_end").get<bool>();
    reliefs.push_back(std::move(relief));
  });
  return reliefs;
}

}  // namespace palmar::records
