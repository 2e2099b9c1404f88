// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/mould_release.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::redesign {
namespace {

constexpr int kPlaces = 360;           // round a section
constexpr double kSectionStep = 2.0;   // mm
constexpr double kSurfaceStep = 0.05;  // mm, and of a turn by 1000: for normals

struct Place {
  double along = 0.0, across = 0.0;  ///< the pull, mm
  double lean = 0.0;                 ///< cosine between normal and pull, both ways
};

/// Most that `across` goes back on its way from its least to its largest, between two places.
double going_back(const std::vector<Place>& places, std::size_t from, std::size_t to, int step) {
  const auto n = static_cast<int>(places.size());
  double largest = places[from].across, most = 0.0;
  for (auto i = static_cast<int>(from); i != static_cast<int>(to); i = (i + step + n) % n) {
    const double across = places[static_cast<std::size_t>(i)].across;
    most = std::max(most, largest - across);
    largest = std::max(largest, across);
  }
  return most;
}

/// Largest height of neighbours that all lean less than `least`.
double steepest_height(const std::vector<Place>& places, double least) {
  const std::size_t n = places.size();
  std::size_t first = 0;
  while (first < n && places[first].lean < least) ++first;
  double most = 0.0, low = 0.0, high = 0.0;
  bool is_steep = false;
  for (std::size_t k = 0; k < n; ++k) {
    const Place& one = places[(first + k) % n];
    if (one.lean >= least) {
      is_steep = false;
      continue;
    }
    low = is_steep ? std::min(low, one.along) : one.along;
    high = is_steep ? std::max(high, one.along) : one.along;
    is_steep = true;
    most = std::max(most, high - low);
  }
  return most;
}

}  // namespace

MouldRelease mould_release(const HandleShape& shape, const Vec3& pull, double draft) {
  const HandleBody& body = shape.body;
  const Vec3 way = body.product_from_handle.rotation.inverse() * pull.normalized();
  constexpr double kMostOff = 0.2588;  // sine of 15 degrees
  if (!(std::abs(way.z()) <= kMostOff)) {
    throw UsageError(fmt::format(
        "setting \"pull\" is {:.0f} degrees off the sections of the handle; at most 15 are "
        "allowed: a mould parts along a handle",
        std::asin(std::min(1.0, std::abs(way.z()))) * 180.0 / std::numbers::pi));
  }
  const Eigen::Vector2d along = way.head<2>().normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  const Vec3 flat(along.x(), along.y(), 0.0);
  MouldRelease result;
  const double margin = body.is_whole ? shape.end_radius : 0.0;
  for (double z = body.bottom + margin + kSurfaceStep; z < body.top - margin - kSurfaceStep;
       z += kSectionStep) {
    std::vector<Place> places;
    for (int k = 0; k < kPlaces; ++k) {
      const double t = static_cast<double>(k) / kPlaces;
      const auto point = [&](double dz, double dt) {
        const Eigen::Vector2d p = shape.side_point(z + dz, t + dt);
        return Vec3(p.x(), p.y(), z + dz);
      };
      const Vec3 here = point(0.0, 0.0);
      const Eigen::Vector2d out = here.head<2>() - body.centre_at(z);
      if (shape.share_at(z, std::atan2(out.y(), out.x())) < 1.0) break;
      constexpr double kTurn = 1e-3 * kSurfaceStep;
      const Vec3 normal = (point(0.0, kTurn) - point(0.0, -kTurn))
                              .cross(point(kSurfaceStep, 0.0) - point(-kSurfaceStep, 0.0))
                              .normalized();
      places.push_back({.along = here.head<2>().dot(along),
                        .across = here.head<2>().dot(across),
                        .lean = std::abs(normal.dot(flat))});
    }
    if (places.size() < kPlaces) continue;
    const auto [least, most] =
        std::minmax_element(places.begin(), places.end(),
                            [](const Place& a, const Place& b) { return a.across < b.across; });
    const auto from = static_cast<std::size_t>(least - places.begin());
    const auto to = static_cast<std::size_t>(most - places.begin());
    result.undercut = std::max(
        {result.undercut, going_back(places, from, to, 1), going_back(places, from, to, -1)});
    result.steep_height = std::max(result.steep_height, steepest_height(places, std::sin(draft)));
  }
  return result;
}

}  // namespace palmar::redesign
