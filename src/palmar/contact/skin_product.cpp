// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/skin_product.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "palmar/contact/skin_geometry.h"

namespace palmar {
namespace {

/// Product and skin normal of a contact point against each other; when they agree by more than
/// this (cosine), the nearest surface is one that the skin can't have come through.
constexpr double kSameSide = 0.5;
constexpr double kOnSurface = 1e-7;  // mm; a trace ends here
constexpr int kMaxTraceSteps = 60;

/// Looks for the surface from an inner point against the skin's normal by sphere tracing. Nothing
/// if there is none within kMaxContactDepth or if it faces the wrong way.
std::optional<DistanceSample> surface_behind(const DistanceField& product, const Vec3& point,
                                             const Vec3& skin_normal) {
  double t = 0.0;
  DistanceSample here = product.at(point);
  for (int step = 0; step < kMaxTraceSteps; ++step) {
    if (here.distance > -kOnSurface) {
      if (skin_normal.dot(here.normal) > -kSameSide / 2) return std::nullopt;
      DistanceSample found = here;
      // Depth along the surface's normal, as for every other vertex.
      found.distance = -t * std::abs(skin_normal.dot(here.normal));
      return found;
    }
    t -= here.distance;
    if (t > kMaxContactDepth) return std::nullopt;
    here = product.at(point - t * skin_normal);
  }
  return std::nullopt;
}

std::string one_decimal(double value) {
  const auto tenths = std::lround(value * 10.0);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

}  // namespace

void sample_vertices(const DistanceField& product, const std::vector<Vec3>& positions,
                     const std::vector<int>& vertices, double range,
                     std::vector<DistanceSample>& samples) {
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const int v : vertices) points.push_back(positions[v]);
  std::vector<DistanceSample> found(vertices.size());
  product.sample(points, range, found);
  for (std::size_t k = 0; k < vertices.size(); ++k) samples[vertices[k]] = found[k];
}

void resample_vertices(const DistanceField& product, const std::vector<Vec3>& positions,
                       const std::vector<int>& vertices, double range,
                       std::vector<DistanceSample>& samples) {
  std::vector<Vec3> points;
  std::vector<DistanceSample> found;
  points.reserve(vertices.size());
  found.reserve(vertices.size());
  for (const int v : vertices) {
    points.push_back(positions[v]);
    found.push_back(samples[v]);
  }
  product.resample(points, range, found);
  for (std::size_t k = 0; k < vertices.size(); ++k) samples[vertices[k]] = found[k];
}

SkinOnProduct find_skin_on_product(const Hand& hand, const std::vector<Vec3>& posed,
                                   const DistanceField& product, std::optional<Region> only) {
  SkinOnProduct skin;
  skin.normal = vertex_normals(posed, hand.skin.triangles);
  skin.sample.resize(posed.size());
  Box3 reach = product.bounding_box();
  if (!reach.isEmpty()) {
    reach.min().array() -= kNearRange;
    reach.max().array() += kNearRange;
  }
  for (std::size_t v = 0; v < posed.size(); ++v) {
    skin.sample[v].distance = kNearRange;
    skin.sample[v].closest = posed[v];
    if (only && hand.region[v] != *only) continue;
    if (reach.contains(posed[v])) skin.near.push_back(static_cast<int>(v));
  }
  sample_vertices(product, posed, skin.near, kNearRange, skin.sample);
  std::vector<int> deep;
  for (const int v : skin.near) {
    if (skin.sample[v].distance <= -kNearRange) deep.push_back(v);
  }
  sample_vertices(product, posed, deep, std::numeric_limits<double>::infinity(), skin.sample);

  double deepest = 0.0;
  int deepest_vertex = -1;
  int far_side = 0;
  for (const int v : skin.near) {
    DistanceSample& sample = skin.sample[v];
    if (!(sample.distance < 0.0)) continue;
    if (skin.normal[v].dot(sample.normal) > kSameSide) {
      const auto behind = surface_behind(product, posed[v], skin.normal[v]);
      if (!behind) {
        skin.left_out.push_back(v);
        ++far_side;
        continue;
      }
      sample = *behind;
      skin.traced.push_back(v);
    }
    if (-sample.distance > kMaxContactDepth) {
      skin.left_out.push_back(v);
      if (-sample.distance > deepest) {
        deepest = -sample.distance;
        deepest_vertex = v;
      }
      if (hand.region[v] != Region::kDorsum) skin.is_too_deep = true;
      continue;
    }
    if (sample.distance < 0.0) skin.collision.push_back(v);
  }
  if (deepest_vertex >= 0) {
    const auto too_deep = static_cast<int>(skin.left_out.size()) - far_side;
    skin.message = std::to_string(too_deep) + " skin vertices lie deeper than " +
                   one_decimal(kMaxContactDepth) + " mm in the product (deepest " +
                   one_decimal(deepest) + " mm, vertex " + std::to_string(deepest_vertex) +
                   ", region " + std::string(name_of(hand.region[deepest_vertex])) +
                   "); they carry no force";
  }
  if (far_side > 0) {
    if (!skin.message.empty()) skin.message += "; ";
    skin.message += std::to_string(far_side) +
                    " skin vertices went right through the product or into it from behind; they "
                    "carry no force";
  }
  return skin;
}

}  // namespace palmar
