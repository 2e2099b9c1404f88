// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/region_picture.h"

#include <fmt/format.h>
#include <utility>

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {
namespace {

constexpr double kFine = 0.5;  // mm; edges of the painted mesh, so that borders look as they run
constexpr Rgb kPlain{206, 208, 205};

/// The map split fine, each vertex in the colour of the first region that it lies in.
SceneObject painted(const geometry::TriangleMesh& map,
                    const std::vector<redesign::ContactRegion>& regions, double finest) {
  Box3 box;
  for (const Vec3& x : map.vertices) box.extend(x);
  SceneObject object;
  // Large products needn't be finer than pixels.
  const double edge = std::max(finest, box.diagonal().norm() / 400.0);
  object.mesh = geometry::split_long_edges(map, edge);
  const geometry::ClosestPointQuery query(map);
  object.vertex_colours.reserve(object.mesh.vertices.size());
  std::optional<int> hint;
  for (const Vec3& x : object.mesh.vertices) {
    const auto found = query.closest(x, 1e9, hint);
    hint = found->triangle;
    const Triangle& t = map.triangles[static_cast<std::size_t>(found->triangle)];
    Rgb colour = kPlain;
    for (const redesign::ContactRegion& region : regions) {
      double value = 0.0;
      for (int k = 0; k < 3; ++k) {
        value += found->weights[static_cast<std::size_t>(k)] *
                 region.field[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
      }
      if (value >= 0.0) {
        colour = colour_of(region.part);
        break;
      }
    }
    object.vertex_colours.push_back(colour);
  }
  return object;
}

/// From the axis towards the region of the palm, else of whatever there is.
Vec3 towards_palm(const geometry::TriangleMesh& map,
                  const std::vector<redesign::ContactRegion>& regions, const Vec3& axis) {
  Box3 box;
  for (const Vec3& x : map.vertices) box.extend(x);
  Vec3 side = Vec3::Zero();
  for (const bool palm_only : {true, false}) {
    for (const redesign::ContactRegion& region : regions) {
      if (palm_only && region.part != redesign::HandPart::kPalm) continue;
      for (const redesign::RegionPatch& patch : region.patches) {
        side += patch.area * (patch.centre - box.center());
      }
    }
    side -= side.dot(axis) * axis;
    if (side.norm() > 1e-6) return side.normalized();
  }
  return axis.unitOrthogonal();
}

}  // namespace

Rgb colour_of(std::optional<redesign::HandPart> part) {
  if (!part) return {126, 87, 160};
  switch (*part) {
    case redesign::HandPart::kFingers:
      return {196, 52, 46};
    case redesign::HandPart::kThumb:
      return {232, 140, 38};
    case redesign::HandPart::kPalm:
      return {44, 92, 178};
  }
  return kPlain;
}

geometry::ColouredMesh region_surface(const geometry::TriangleMesh& map,
                                      const std::vector<redesign::ContactRegion>& regions) {
  constexpr double kForViews = 1.0;  // mm; for a view that is turned, not printed
  SceneObject object = painted(map, regions, kForViews);
  geometry::ColouredMesh surface;
  surface.mesh = std::move(object.mesh);
  for (const Rgb c : object.vertex_colours) {
    surface.colour.emplace_back(static_cast<float>(c.r) / 255.0F, static_cast<float>(c.g) / 255.0F,
                                static_cast<float>(c.b) / 255.0F);
  }
  return surface;
}

Image region_picture(const geometry::TriangleMesh& map,
                     const std::vector<redesign::ContactRegion>& regions, const Vec3& axis,
                     const std::string& title, const RegionPictureOptions& options,
                     const Progress& progress) {
  for (const redesign::ContactRegion& region : regions) {
    if (region.field.size() != map.vertices.size()) {
      throw UsageError("region picture: a region belongs to another map");
    }
  }
  const Scene scene = {painted(map, regions, kFine)};
  const Vec3 palm = towards_palm(map, regions, axis);
  const Vec3 side = axis.cross(palm);
  const std::array<Vec3, 4> from = {palm, side, -palm, -side};
  const std::array<const char*, 4> words = {"palm side", "turned by 90°", "180°", "270°"};
  const double s = options.height / 900.0;
  const int top = static_cast<int>(100 * s), bottom = static_cast<int>(56 * s);
  const int width = options.width / 4, height = options.height - top - bottom;
  std::vector<Camera> cameras;
  for (const Vec3& eye : from) {
    cameras.push_back(fit_camera(scene, -eye + 0.0 * axis, axis,
                                 {.aspect = static_cast<double>(width) / height, .margin = 0.04}));
  }
  // One scale for all four.
  double tallest = 0.0;
  for (const Camera& camera : cameras) tallest = std::max(tallest, camera.view_height);
  for (Camera& camera : cameras) camera.view_height = tallest;
  const std::vector<Image> views =
      render_views(scene, cameras, {.width = width, .height = height}, progress);
  Image picture(options.width, options.height);
  for (std::size_t k = 0; k < views.size(); ++k) {
    const int left = static_cast<int>(k) * width;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) picture.at(left + x, top + y) = views[k].at(x, y);
    }
    draw_text(picture, left + 0.5 * width, options.height - 20 * s, words[k],
              {.cap_height = 12 * s, .align = Align::kCentre});
  }
  draw_text(picture, 24 * s, 40 * s, title, {.cap_height = 15 * s, .weight = 0.15});
  double x = 24 * s;
  const TextStyle small{.cap_height = 11 * s};
  for (const redesign::ContactRegion& region : regions) {
    const std::string text = fmt::format("{}: {:.0f} mm²", region.title, region.area);
    fill_rectangle(picture, static_cast<int>(x), static_cast<int>(58 * s), static_cast<int>(14 * s),
                   static_cast<int>(14 * s), colour_of(region.part));
    draw_text(picture, x + 22 * s, 71 * s, text, small);
    x += 22 * s + text_width(text, small) + 30 * s;
  }
  return picture;
}

}  // namespace palmar::report
