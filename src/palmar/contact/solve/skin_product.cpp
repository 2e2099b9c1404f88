// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/skin_product.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/smooth_step.h"

namespace palmar::contact {
namespace {

/// Product and skin normal of a contact point against each other; when they agree by more than
/// this (cosine), the nearest surface is one that the skin can't have come through.
constexpr double kSameSide = 0.5;
constexpr double kOnSurface = 1e-7;  // mm; a trace ends here
constexpr double kAhead = 1e-4;      // mm; a trace from outside ends here
constexpr double kLift = 1.0;  // mm; outside the surface, from where its nearest point is asked
constexpr int kMaxTraceSteps = 60;
constexpr double kFleshDepth = 7.0;   // mm; most
constexpr double kFleshShare = 0.25;  // of the hand's thickness: half a finger's
/// From where to where the surface that the skin came through replaces the nearest one: cosine of
/// the nearest one's normal and the skin's.
constexpr double kTurned = 0.7;
/// Of a plate, whose edge skin may be pressed on, sides are nearer than the end that the skin came
/// through: that replaces them between these cosines, where the plate is not thicker than the
/// first and ever less up to the second [mm]. Our choice.
constexpr double kFacesEnd = -0.7, kPassesEnd = -0.2;
constexpr double kThin = 4.0, kThick = 6.0;

/// A sampler asks this far, so that skin has some way to go before it must be asked about again.
constexpr double kWatchRange = 9.0;         // mm
constexpr double kDistanceRounding = 1e-9;  // mm; of a distance and of the way gone
constexpr double kSurely = 0.7;  // of the distance is left: the nearest surface is about the same

/// The sample of a point that has come through the surface at `here`: straight back to it.
geometry::DistanceSample back_through(const geometry::DistanceField& product, const Vec3& point,
                                      const geometry::DistanceSample& here) {
  const double depth = std::max(0.0, (here.closest - point).dot(here.normal));
  geometry::DistanceSample found = product.at(point + (depth + kLift) * here.normal, here);
  const Vec3 way = found.closest - point;
  found.distance = -way.norm();
  found.normal = way.norm() > kAhead ? Vec3(way.normalized()) : here.normal;
  return found;
}

/// Looks for the surface from an inner point, whose sample is `nearest`, against the skin's normal
/// by sphere tracing. Nothing if there is none within kMaxContactDepth or if it faces the wrong
/// way.
std::optional<geometry::DistanceSample> surface_behind(const geometry::DistanceField& product,
                                                       const Vec3& point,
                                                       const geometry::DistanceSample& nearest,
                                                       const Vec3& skin_normal) {
  double t = 0.0;
  geometry::DistanceSample here = nearest;
  for (int step = 0; step < kMaxTraceSteps; ++step) {
    if (here.distance > -kOnSurface) {
      if (skin_normal.dot(here.normal) > -kSameSide / 2) return std::nullopt;
      return back_through(product, point, here);
    }
    t -= here.distance;
    if (t > kMaxContactDepth) return std::nullopt;
    here = product.at(point - t * skin_normal, here);
  }
  return std::nullopt;
}

/// Weight of the surface that skin came through against the nearest one, which looks the skin's own
/// way by `cosine`. Smooth, so that forces don't jump as skin is pressed through a thin rod.
double turned_weight(double cosine) { return geometry::smooth_step(cosine / kTurned); }

/// Thickness of the product across the nearest surface of an inner point, at most kThick, mm.
double thickness_at(const geometry::DistanceField& product,
                    const geometry::DistanceSample& nearest) {
  double t = -nearest.distance;
  geometry::DistanceSample here = nearest;
  for (int step = 0; step < kMaxTraceSteps && t < kThick; ++step) {
    here = product.at(nearest.closest - t * nearest.normal, here);
    if (here.distance > -kOnSurface) return t;
    t -= here.distance;
  }
  return kThick;
}

/// The same as turned_weight() for skin on the edge of a plate, which looks along its sides.
double on_edge_weight(const geometry::DistanceField& product,
                      const geometry::DistanceSample& nearest, double cosine) {
  const double passes = geometry::smooth_step((cosine - kFacesEnd) / (kPassesEnd - kFacesEnd));
  if (passes == 0.0) return 0.0;
  const double thickness = thickness_at(product, nearest);
  return passes * geometry::smooth_step((kThick - thickness) / (kThick - kThin));
}

/// Between the nearest surface and the one that the skin came through.
geometry::DistanceSample between(const geometry::DistanceField& product, const Vec3& point,
                                 const geometry::DistanceSample& nearest,
                                 const geometry::DistanceSample& behind, double weight) {
  const Vec3 way = (1.0 - weight) * (nearest.closest - point) + weight * (behind.closest - point);
  if (weight >= 1.0 || way.norm() < kAhead) return behind;
  const double depth = way.norm();
  geometry::DistanceSample found = product.at(point + (1.0 + kLift / depth) * way, nearest);
  if (found.distance <= 0.0) return weight > 0.5 ? behind : nearest;
  found.normal = way / depth;
  found.distance = -((1.0 - weight) * -nearest.distance + weight * -behind.distance);
  return found;
}

std::string one_decimal(double value) {
  const auto tenths = std::lround(value * 10.0);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

}  // namespace

void SkinOnProduct::begin(const hand::Hand& hand, const std::vector<Vec3>& posed) {
  geometry::area_weighted_normals(posed, hand.skin.triangles, normal);
  sample.resize(posed.size());
  near.clear();
  collision.clear();
  left_out.clear();
  traced.clear();
  is_too_deep = false;
  message.clear();
}

double flesh_depth(const hand::Hand& hand) {
  const double thickness = hand.dimensions.hand_thickness;
  return thickness > 0.0 ? std::min(kFleshDepth, kFleshShare * thickness) : kFleshDepth;
}

std::optional<geometry::DistanceSample> surface_passed(const geometry::DistanceField& product,
                                                       const Vec3& point,
                                                       const geometry::DistanceSample& nearest,
                                                       const Vec3& skin_normal, double flesh) {
  double t = flesh;
  geometry::DistanceSample here = nearest;
  for (int step = 0; step < kMaxTraceSteps; ++step) {
    here = product.at(point - t * skin_normal, here);
    if (here.distance < kAhead) {
      // Bone would be in the product.
      if (here.distance < -kAhead) return std::nullopt;
      if (skin_normal.dot(here.normal) > -kSameSide / 2) return std::nullopt;
      return back_through(product, point, here);
    }
    t -= here.distance;
    if (t <= 0.0) return std::nullopt;
  }
  return std::nullopt;
}

void sample_vertices(const geometry::DistanceField& product, const std::vector<Vec3>& positions,
                     const std::vector<int>& vertices, double range,
                     std::vector<geometry::DistanceSample>& samples) {
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const int v : vertices) points.push_back(positions[v]);
  std::vector<geometry::DistanceSample> found(vertices.size());
  product.sample(points, range, found);
  for (std::size_t k = 0; k < vertices.size(); ++k) samples[vertices[k]] = found[k];
}

void resample_vertices(const geometry::DistanceField& product, const std::vector<Vec3>& positions,
                       const std::vector<int>& vertices, double range,
                       std::vector<geometry::DistanceSample>& samples) {
  std::vector<Vec3> points;
  std::vector<geometry::DistanceSample> found;
  points.reserve(vertices.size());
  found.reserve(vertices.size());
  for (const int v : vertices) {
    points.push_back(positions[v]);
    found.push_back(samples[v]);
  }
  product.resample(points, range, found);
  for (std::size_t k = 0; k < vertices.size(); ++k) samples[vertices[k]] = found[k];
}

void SkinSampler::sample(const geometry::DistanceField& product, const std::vector<Vec3>& posed,
                         const std::vector<Vec3>& normal, const std::vector<int>& near,
                         double wanted, std::vector<geometry::DistanceSample>& samples) {
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
      // Skin that looks at the product can't have passed it.
      const bool looks =
          least > kSurely * sample_[v].distance && normal[v].dot(sample_[v].normal) < 0.0;
      if (least > wanted + kDistanceRounding && (least > kFleshDepth || looks)) continue;
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

void find_skin_on_product(const hand::Hand& hand, const std::vector<Vec3>& posed,
                          const geometry::DistanceField& product, std::optional<hand::Region> only,
                          SkinSampler* sampler, SkinOnProduct& skin, double wanted) {
  skin.begin(hand, posed);
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
    sampler->sample(product, posed, skin.normal, skin.near, wanted, skin.sample);
    range = kWatchRange;
  } else {
    sample_vertices(product, posed, skin.near, kNearRange, skin.sample);
  }
  std::vector<int> deep;
  for (const int v : skin.near) {
    geometry::DistanceSample& sample = skin.sample[v];
    if (sample.distance <= -range) deep.push_back(v);
    // Fields differ in what they say about far points.
    if (!(sample.distance < kNearRange)) sample = {kNearRange, posed[v], Vec3::UnitZ(), -1};
  }
  sample_vertices(product, posed, deep, std::numeric_limits<double>::infinity(), skin.sample);

  const double flesh = flesh_depth(hand);
  double deepest = 0.0;
  int deepest_vertex = -1;
  int far_side = 0;
  for (const int v : skin.near) {
    geometry::DistanceSample& sample = skin.sample[v];
    const double cosine = skin.normal[v].dot(sample.normal);
    double weight = turned_weight(cosine);
    if (!(sample.distance < 0.0)) {
      // Skin may have gone right through a thin part of the product, which then is behind it.
      if (weight == 0.0 || !(sample.distance < std::min(flesh, kNearRange))) continue;
      const auto passed = surface_passed(product, posed[v], sample, skin.normal[v], flesh);
      if (!passed || !(passed->distance < 0.0)) continue;
      sample = *passed;
      sample.distance *= weight;
      skin.traced.push_back(v);
      skin.collision.push_back(v);
      continue;
    }
    if (weight < 1.0) {
      weight = std::max(weight, on_edge_weight(product, sample, cosine));
    }
    if (weight > 0.0) {
      const auto behind = surface_behind(product, posed[v], sample, skin.normal[v]);
      if (behind) {
        sample = between(product, posed[v], sample, *behind, weight);
        skin.traced.push_back(v);
      } else if (cosine > kSameSide) {
        skin.left_out.push_back(v);
        ++far_side;
        continue;
      }
    }
    if (-sample.distance > kMaxContactDepth) {
      skin.left_out.push_back(v);
      if (-sample.distance > deepest) {
        deepest = -sample.distance;
        deepest_vertex = v;
      }
      if (hand.region[v] != hand::Region::kDorsum) skin.is_too_deep = true;
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

SkinOnProduct find_skin_on_product(const hand::Hand& hand, const std::vector<Vec3>& posed,
                                   const geometry::DistanceField& product,
                                   std::optional<hand::Region> only) {
  SkinOnProduct skin;
  find_skin_on_product(hand, posed, product, only, nullptr, skin);
  return skin;
}

}  // namespace palmar::contact
