// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/skin_product.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "palmar/contact/response/skin_geometry.h"

namespace palmar {
namespace {

/// Product and skin normal of a contact point against each other; when they agree by more than
/// this (cosine), the nearest surface is one that the skin can't have come through.
constexpr double kSameSide = 0.5;
constexpr double kOnSurface = 1e-7;  // mm; a trace ends here
constexpr int kMaxTraceSteps = 60;

/// A sampler asks this far, so that skin has some way to go before it must be asked about again.
constexpr double kWatchRange = 9.0;  // mm
constexpr double kRounding = 1e-9;   // mm; of a distance and of the way gone

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

void SkinSampler::sample(const DistanceField& product, const std::vector<Vec3>& posed,
                         const std::vector<int>& near, double wanted,
                         std::vector<DistanceSample>& samples) {
  const bool is_new = product.id() != product_ || sample_.size() != posed.size();
  if (is_new) {
    product_ = product.id();
    position_.assign(posed.size(), Vec3::Zero());
    sample_.assign(posed.size(), {});
    is_known_.assign(posed.size(), 0);
  }
  const bool may_skip = product.is_lipschitz();
  asked_.clear();
  points_.clear();
  found_.clear();
  for (const int v : near) {
    if (may_skip && is_known_[v]) {
      const double least = sample_[v].distance - (posed[v] - position_[v]).norm();
      if (least > wanted + kRounding) continue;
    }
    asked_.push_back(v);
    points_.push_back(posed[v]);
    found_.push_back(sample_[v]);
  }
  if (is_new) {
    product.sample(points_, kWatchRange, found_);
  } else {
    product.resample(points_, kWatchRange, found_);
  }
  for (std::size_t k = 0; k < asked_.size(); ++k) {
    const int v = asked_[k];
    position_[v] = posed[v];
    sample_[v] = found_[k];
    is_known_[v] = 1;
    samples[v] = found_[k];
  }
}

void find_skin_on_product(const Hand& hand, const std::vector<Vec3>& posed,
                          const DistanceField& product, std::optional<Region> only,
                          SkinSampler* sampler, SkinOnProduct& skin, double wanted) {
  vertex_normals(posed, hand.skin.triangles, skin.normal);
  skin.sample.resize(posed.size());
  skin.near.clear();
  skin.collision.clear();
  skin.left_out.clear();
  skin.traced.clear();
  skin.is_too_deep = false;
  skin.message.clear();
  Box3 reach = product.bounding_box();
  if (!reach.isEmpty()) {
    reach.min().array() -= kNearRange;
    reach.max().array() += kNearRange;
  }
  for (std::size_t v = 0; v < posed.size(); ++v) {
    skin.sample[v] = {kNearRange, posed[v], Vec3::UnitZ(), -1};
    if (only && hand.region[v] != *only) continue;
    if (reach.contains(posed[v])) skin.near.push_back(static_cast<int>(v));
  }
  double range = kNearRange;
  if (sampler) {
    sampler->sample(product, posed, skin.near, wanted, skin.sample);
    range = kWatchRange;
  } else {
    sample_vertices(product, posed, skin.near, kNearRange, skin.sample);
  }
  std::vector<int> deep;
  for (const int v : skin.near) {
    DistanceSample& sample = skin.sample[v];
    if (sample.distance <= -range) deep.push_back(v);
    // Fields differ in what they say about far points.
    if (!(sample.distance < kNearRange)) sample = {kNearRange, posed[v], Vec3::UnitZ(), -1};
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
    skin.message = std::to_string(too_deep) + " skin vertices are deeper than " +
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
}

SkinOnProduct find_skin_on_product(const Hand& hand, const std::vector<Vec3>& posed,
                                   const DistanceField& product, std::optional<Region> only) {
  SkinOnProduct skin;
  find_skin_on_product(hand, posed, product, only, nullptr, skin);
  return skin;
}

}  // namespace palmar
