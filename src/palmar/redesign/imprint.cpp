// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/imprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::redesign {
namespace {

// A ray through an edge may meet both triangles there; rays are single precision.
constexpr double kSamePlace = 1e-3;  // mm
// A ray leaves the surface that it starts on before its hits count as the other side of a wall.
constexpr double kOwnSurface = 0.02;  // mm
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Rays in a mesh that know the side of what they meet.
class SidedRays {
 public:
  explicit SidedRays(const geometry::TriangleMesh& mesh)
      : rays_(mesh), normal_(geometry::triangle_normals(mesh)) {}

  bool is_exit(const geometry::RayHit& hit, const Vec3& direction) const {
    return normal_[hit.triangle].dot(direction) > 0.0;
  }
  std::optional<geometry::RayHit> first(const Vec3& origin, const Vec3& direction) const {
    return rays_.first_hit(origin, direction);
  }
  /// Way until a ray that begins `inside` times within the solid has left it; infinity if never.
  double way_out(const Vec3& origin, const Vec3& direction, int inside, double from = 0.0) const {
    double last_exit = -1.0, last_entry = -1.0;
    for (const geometry::RayHit& hit : rays_.all_hits(origin, direction, from)) {
      double& last = is_exit(hit, direction) ? last_exit : last_entry;
      const bool is_again = last >= 0.0 && hit.distance - last < kSamePlace;
      last = hit.distance;
      if (is_again) continue;
      inside += is_exit(hit, direction) ? -1 : 1;
      if (inside <= 0) return hit.distance;
    }
    return kNever;
  }

 private:
  geometry::RayQuery rays_;
  std::vector<Vec3> normal_;
};

void require(bool holds, const char* field, double value, const char* allowed) {
  if (!holds) {
    throw UsageError(fmt::format("imprint: {} is {}; {} is allowed", field, value, allowed));
  }
}

/// Value at `percentile` of ascending values, of which the first `zeros` are 0 and not listed.
double percentile_of(const std::vector<double>& ascending, std::size_t zeros, double percentile) {
  const std::size_t count = ascending.size() + zeros;
  const double place = percentile / 100.0 * static_cast<double>(count - 1);
  const auto low = static_cast<std::size_t>(place);
  const auto at = [&](std::size_t i) { return i < zeros ? 0.0 : ascending[i - zeros]; };
  const double upper = at(std::min(low + 1, count - 1));
  return at(low) + (place - static_cast<double>(low)) * (upper - at(low));
}

}  // namespace

void ImprintOptions::check() const {
  require(largest >= 0.1 && largest <= 100.0, "largest", largest, "0.1 to 100 mm");
  require(wall_share > 0.0 && wall_share <= 1.0, "wall_share", wall_share, "above 0, to 1");
}

void CombineOptions::check() const {
  require(percentile >= 0.0 && percentile <= 100.0, "percentile", percentile, "0 to 100");
}

struct ImprintGauge::Impl {
  std::vector<Vec3> points, outward;
  std::vector<double> wall, most;

  double depth_at(std::size_t i, const SidedRays& skin,
                  const geometry::WindingNumber& winding) const {
    const Vec3& x = points[i];
    const Vec3 inward = -outward[i];
    // Most points aren't covered: then the ray meets no skin, or its front.
    const std::optional<geometry::RayHit> first = skin.first(x, inward);
    if (!first) return 0.0;
    if (!skin.is_exit(*first, inward) && first->distance > most[i]) return 0.0;
    const int inside = static_cast<int>(std::lround(winding.at(x)));
    if (inside < 1) return 0.0;
    const double depth = skin.way_out(x, inward, inside);
    if (inside == 1 && skin.way_out(x, outward[i], inside) < depth) return 0.0;
    return std::min(depth, most[i]);
  }
};

ImprintGauge::ImprintGauge(const geometry::TriangleMesh& product, std::vector<Vec3> points,
                           std::vector<Vec3> outward, const ImprintOptions& options) {
  options.check();
  if (points.size() != outward.size()) {
    throw UsageError(
        fmt::format("imprint: {} points, {} directions", points.size(), outward.size()));
  }
  auto impl = std::make_unique<Impl>();
  impl->points = std::move(points);
  impl->outward = std::move(outward);
  impl->wall.resize(impl->points.size());
  impl->most.resize(impl->points.size());
  const SidedRays rays(product);
  parallel_for(static_cast<int>(impl->points.size()), [&](int k) {
    impl->wall[k] = rays.way_out(impl->points[k], -impl->outward[k], 1, kOwnSurface);
    impl->most[k] = std::min(options.largest, options.wall_share * impl->wall[k]);
  });
  impl_ = std::move(impl);
}

ImprintGauge::~ImprintGauge() = default;

const std::vector<double>& ImprintGauge::wall() const { return impl_->wall; }

Imprint ImprintGauge::measure(const geometry::TriangleMesh& skin) const {
  Imprint imprint;
  if (skin.triangles.empty() || impl_->points.empty()) return imprint;
  const SidedRays rays(skin);
  const geometry::WindingNumber winding(skin);
  const Box3 box = geometry::bounding_box(skin);
  std::vector<double> depth(impl_->points.size(), 0.0);
  parallel_for(static_cast<int>(depth.size()), [&](int k) {
    const auto i = static_cast<std::size_t>(k);
    if (box.contains(impl_->points[i])) depth[i] = impl_->depth_at(i, rays, winding);
  });
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] <= 0.0) continue;
    imprint.point.push_back(static_cast<int>(i));
    imprint.depth.push_back(depth[i]);
  }
  return imprint;
}

std::vector<double> combine_imprints(std::span<const Imprint> imprints, int points,
                                     const CombineOptions& options) {
  options.check();
  std::vector<std::vector<double>> depths(std::max(0, points));
  for (const Imprint& imprint : imprints) {
    for (std::size_t k = 0; k < imprint.point.size(); ++k) {
      const int i = imprint.point[k];
      if (i < 0 || i >= points) {
        throw UsageError(fmt::format("imprint: point {} of {}", i, points));
      }
      depths[i].push_back(imprint.depth[k]);
    }
  }
  std::vector<double> result(depths.size(), 0.0);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    std::vector<double>& values = depths[i];
    if (values.empty()) continue;
    // Sums of sorted values don't depend on the order of the hands.
    std::sort(values.begin(), values.end());
    const std::size_t zeros = options.is_among_touching ? 0 : imprints.size() - values.size();
    if (options.statistic == ImprintStatistic::kMean) {
      result[i] = std::accumulate(values.begin(), values.end(), 0.0) /
                  static_cast<double>(values.size() + zeros);
    } else {
      result[i] = percentile_of(values, zeros, options.percentile);
    }
  }
  return result;
}

}  // namespace palmar::redesign
