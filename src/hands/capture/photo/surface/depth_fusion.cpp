// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/depth_fusion.h"

#include <fmt/format.h>

#include <cmath>

#include "hands/capture/photo/pinhole.h"
#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

/// A depth map that can be asked about points of the world.
struct PosedMap {
  const DepthMap* map = nullptr;
  Pinhole camera;
  Eigen::Matrix3f world_from_camera;  ///< rotation
  Eigen::Matrix3f ray;                ///< world direction of z = 1 from a pixel: R^T K^-1
  Vec3f centre;
  PhotoLens lens;

  PosedMap(const PhotoView& view, const DepthMap& depths) : map(&depths), camera(view.camera) {
    const Eigen::Matrix3d r = view.camera.camera_from_world.rotation.toRotationMatrix();
    world_from_camera = r.transpose().cast<float>();
    ray = (r.transpose() * Pinhole::matrix_of(view.camera.lens).inverse()).cast<float>();
    centre = view.camera.centre().cast<float>();
    lens = view.camera.lens;
  }
  SurfacePoint point_at(int x, int y, std::size_t at) const {
    return {
        centre + map->depth[at] * (ray * Vec3f(static_cast<float>(x), static_cast<float>(y), 1)),
        world_from_camera * map->normal[at], 1};
  }
  /// Covariance of the places that a square patch round a pixel covers on the plane of a point: its
  /// pixels' on a plane across the sight, cast along the sight onto the surface.
  Eigen::Matrix3f patch_of(const SurfacePoint& point, int radius) const {
    const Vec3f to = point.position - centre;
    const float distance = to.norm();
    const Vec3f sight = to / distance;
    constexpr float kLeast = 0.5F;  // more oblique ones reach past the outline of a finger
    const float along = std::min(-kLeast, point.normal.dot(sight));
    const auto side = static_cast<float>(2 * radius + 1);
    const float variance = (side * side - 1.0F) / 12.0F;  // pixels^2, of each direction
    const float pixel = distance / static_cast<float>(lens.focal_x);
    const Eigen::Matrix3f across = Eigen::Matrix3f::Identity() - sight * sight.transpose();
    const Eigen::Matrix3f cast =
        (Eigen::Matrix3f::Identity() - sight * point.normal.transpose() / along) * across;
    return variance * pixel * pixel * cast * cast.transpose();
  }
};

/// No two lenses have the same numbers.
bool is_one_camera(const PhotoLens& a, const PhotoLens& b) {
  return a.width == b.width && a.height == b.height && a.focal_x == b.focal_x &&
         a.focal_y == b.focal_y && a.centre_x == b.centre_x && a.centre_y == b.centre_y;
}

}  // namespace

void DepthFusionOptions::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds)
      throw UsageError(fmt::format("fusion {}: {:g}; {} is allowed", field, value, allowed));
  };
  require(agree > 0 && agree <= 20, "agree", agree, "0 to 20 mm");
  require(agree_angle > 0 && agree_angle <= 90, "agree_angle", agree_angle, "0 to 90 deg");
  require(least_views >= 1 && least_views <= 100, "least_views", least_views, "1 to 100");
  require(still >= 0 && still <= 50, "still", still, "0 to 50 pixels");
  require(patch_radius >= 0 && patch_radius <= 7, "patch_radius", patch_radius, "0 to 7 pixels");
  require(widest_angle > 0 && widest_angle <= 180, "widest_angle", widest_angle, "0 to 180 deg");
}

FusedDepths fuse_depths(const std::vector<PhotoView>& views, const std::vector<DepthMap>& maps,
                        const Vec3& middle, const DepthFusionOptions& options) {
  options.check();
  if (views.size() != maps.size()) throw UsageError("one depth map per view is required");
  std::vector<PosedMap> posed;
  for (std::size_t v = 0; v < views.size(); ++v) posed.emplace_back(views[v], maps[v]);
  const auto least_cosine = static_cast<float>(std::cos(options.agree_angle * geometry::kDegree));
  const auto agree = static_cast<float>(options.agree);

  std::vector<std::vector<SurfacePoint>> found(views.size());
  parallel_for(static_cast<int>(views.size()), [&](int view) {
    const auto v = static_cast<std::size_t>(view);
    const PosedMap& own = posed[v];
    std::vector<std::size_t> others;
    const Vec3 axis = (views[v].camera.centre() - middle).normalized();
    for (std::size_t o = 0; o < views.size(); ++o) {
      const Vec3 other = (views[o].camera.centre() - middle).normalized();
      if (o != v && axis.dot(other) > std::cos(options.widest_angle * geometry::kDegree))
        others.push_back(o);
    }
    for (int y = 0; y < own.map->height; ++y) {
      for (int x = 0; x < own.map->width; ++x) {
        const std::size_t at = views[v].at(x, y);
        if (own.map->depth[at] <= 0.0F) continue;
        const SurfacePoint mine = own.point_at(x, y, at);
        Vec3f position = mine.position, normal = mine.normal;
        int agreeing = 1;
        Eigen::Matrix3f patch = own.patch_of(mine, options.patch_radius);
        for (const std::size_t o : others) {
          const PosedMap& other = posed[o];
          const Vec3f q = other.camera.project(mine.position);
          if (q.z() <= 0.0F) continue;
          const int u = static_cast<int>(std::lround(q.x() / q.z()));
          const int w = static_cast<int>(std::lround(q.y() / q.z()));
          if (u < 0 || w < 0 || u >= other.map->width || w >= other.map->height) continue;
          if (is_one_camera(own.lens, other.lens) &&
              std::hypot(q.x() / q.z() - static_cast<float>(x),
                         q.y() / q.z() - static_cast<float>(y)) < options.still) {
            continue;
          }
          const std::size_t there = views[o].at(u, w);
          if (other.map->depth[there] <= 0.0F) continue;
          const SurfacePoint theirs = other.point_at(u, w, there);
          if (theirs.normal.dot(mine.normal) < least_cosine) continue;
          // Where their plane meets the ray through the point itself, not through the pixel.
          const Vec3f ray = (mine.position - other.centre) / q.z();
          const float along = theirs.normal.dot(ray);
          if (along > -0.05F) continue;
          const float depth = theirs.normal.dot(theirs.position - other.centre) / along;
          if (std::abs(depth - q.z()) > agree) continue;
          position += other.centre + depth * ray;
          normal += theirs.normal;
          patch +=
              other.patch_of({other.centre + depth * ray, theirs.normal, 1}, options.patch_radius);
          ++agreeing;
        }
        if (agreeing < options.least_views) continue;
        const auto count = static_cast<float>(agreeing);
        patch /= count;
        found[v].push_back(
            {position / count,
             normal.normalized(),
             agreeing,
             {patch(0, 0), patch(1, 1), patch(2, 2), patch(0, 1), patch(0, 2), patch(1, 2)}});
      }
    }
  });
  FusedDepths fused;
  for (const auto& of_view : found) {
    fused.points.insert(fused.points.end(), of_view.begin(), of_view.end());
    fused.kept.push_back(static_cast<int>(of_view.size()));
  }
  return fused;
}

}  // namespace palmar::capture
