// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/depth_pictures.h"

#include <algorithm>
#include <array>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {
namespace {

struct ShownSide {
  const char* name;
  const char* words;
  Vec3 direction;  // into the scene
};

double extent_along(const geometry::TriangleMesh& mesh, const Vec3& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& x : mesh.vertices) {
    low = std::min(low, direction.dot(x));
    high = std::max(high, direction.dot(x));
  }
  return std::max(0.0, high - low);
}

}  // namespace

std::vector<Picture> depth_pictures(const DepthScene& scene, const PictureOptions& options,
                                    const Progress& progress) {
  const Vec3 up = scene.axis.normalized();
  Vec3 palm = scene.palm - scene.palm.dot(up) * up;
  palm = palm.norm() > 1e-6 ? Vec3(palm.normalized()) : Vec3(up.unitOrthogonal());
  const Vec3 across = up.cross(palm);
  const double deepest =
      scene.depth.empty() ? 0.0 : *std::max_element(scene.depth.begin(), scene.depth.end());
  ColourScale scale{Colormap::kFern, deepest > 0.0 ? rounded_up(deepest) : 1.0, "Depth", "mm"};
  scale.neutral = kProductColour;

  // A little from above and from the side, so that hollows show by their light.
  const std::array<ShownSide, 4> sides = {{{"shape_in_palm", "side in the palm", palm},
                                           {"shape_under_fingers", "side under the fingers", -palm},
                                           {"shape_left", "left of the palm", across},
                                           {"shape_right", "right of the palm", -across}}};
  const double s = options.height / 700.0;
  const double aspect = static_cast<double>(options.width) / options.height;
  const double bar = static_cast<double>(colour_bar_width(options.height)) / options.width;
  std::vector<Picture> pictures;
  try {
    for (const ShownSide& side : sides) {
      const Vec3 direction = (side.direction - 0.18 * up + 0.30 * side.direction.cross(up));
      const Vec3 right = direction.cross(up).normalized();
      const double step = 1.15 * extent_along(scene.mesh, right);
      SceneObject plain, mapped;
      plain.mesh = mapped.mesh = scene.mesh;
      plain.colour = mapped.colour = kProductColour;
      for (Vec3& x : mapped.mesh.vertices) x += step * right;
      mapped.field = scene.depth;
      mapped.field_upper = scale.upper;
      mapped.map = scale.map;
      const Scene both = {plain, mapped};
      Camera camera =
          fit_camera(both, direction, up, {.aspect = aspect * (1.0 - bar), .margin = 0.1});
      camera.position += 0.035 * camera.view_height * right.cross(camera.direction);
      camera.position += 0.5 * bar * camera.view_height * aspect * right;
      Picture picture{side.name,
                      scene.title + ", " + side.words,
                      scene.title + " seen from the " + side.words +
                          ": as it looks, and with the depth of its hollows in colours.",
                      {}};
      picture.image = std::move(
          render_views(both, {camera}, {.width = options.width, .height = options.height}, progress)
              .front());
      draw_text(picture.image, 24 * s, 40 * s, scene.title, {.cap_height = 14 * s, .weight = 0.15});
      draw_text(picture.image, 24 * s, 64 * s, scene.subtitle + ", " + side.words,
                {.cap_height = 10.5 * s, .colour = Rgb{96, 102, 110}});
      draw_colour_bar(picture.image, scale);
      pictures.push_back(std::move(picture));
    }
  } catch (const Cancelled&) {
    // What is finished stands.
  }
  return pictures;
}

}  // namespace palmar::report
