// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

/// One mesh in a picture.
struct SceneObject {
  geometry::TriangleMesh mesh = {};      ///< mm
  Rgb colour{200, 200, 200};             ///< where vertex_colours is empty
  std::vector<Rgb> vertex_colours = {};  ///< one per vertex, or empty
  std::vector<double> field = {};  ///< one per vertex, or empty: shown by `map` where it is above
                                   ///< 0.5 % of field_upper, over the colours above
  double field_upper = 1.0;        ///< value at the top of the map
  Colormap map = Colormap::kEmber;
  double opacity = 1.0;  ///< (0, 1]; below 1 what lies behind shines through
};

using Scene = std::vector<SceneObject>;

/// Eye of a picture. Throws nothing; render_scene() checks it.
struct Camera {
  Vec3 position = Vec3::Zero();     ///< mm
  Vec3 direction = -Vec3::UnitZ();  ///< into the scene, unit
  Vec3 up = Vec3::UnitY();          ///< not parallel to direction
  bool is_orthographic = true;      ///< parallel rays: lengths compare all over the picture
  double view_height = 100.0;       ///< orthographic: height of the picture, mm
  double field_of_view = 0.5;       ///< perspective: vertical opening angle, rad
};

/// Camera that looks along `direction` (from the eye into the scene; any length) with `up` upwards
/// and shows every vertex of the scene in a picture of aspect = width / height, with a free margin
/// (share of the picture on each side). Throws UsageError on an empty scene or a direction of no
/// length or along `up`.
struct FitOptions {
  double aspect = 10.0 / 7.0;
  double margin = 0.06;
  bool is_orthographic = true;
};
Camera fit_camera(const Scene& scene, const Vec3& direction, const Vec3& up,
                  const FitOptions& options = {});

struct RenderOptions {
  int width = 1000;  ///< pixels
  int height = 700;  ///< pixels
  int samples = 3;   ///< rays per side of a pixel where something changes: 3 = 9 rays
  double occlusion_range =
      18.0;                   ///< mm; what is nearer than that keeps ambient light away; 0: none
  double crease_angle = 0.8;  ///< rad; faces meeting at more than that show an edge
  Rgb background = kWhite;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Picture by ray casting on the processor: no display, no graphics card. A key light from the
/// upper left, a fill light, and ambient occlusion; a surface that squarely faces the eye, with
/// nothing near it, shows exactly its own colour. Same input, same bytes, on any number of threads.
///
///     Scene scene;
///     scene.push_back({.mesh = hand.skin, .colour = kSkinColour});
///     scene.push_back({.mesh = product.mesh, .colour = kProductColour, .opacity = 0.35});
///     const Camera camera = fit_camera(scene, {0, 0, -1}, {0, 1, 0});
///     const std::string png = encode_png(render_scene(scene, camera));  // #include "image.h"
///
/// Throws UsageError on bad options, on colours that don't match the vertices, and on vertices that
/// a triangle misses.
Image render_scene(const Scene& scene, const Camera& camera, const RenderOptions& options = {});

/// The same scene seen by several cameras; what doesn't depend on the camera is computed once.
/// Throws Cancelled within a few rows of pixels after the user asked to stop.
std::vector<Image> render_views(const Scene& scene, const std::vector<Camera>& cameras,
                                const RenderOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::report
