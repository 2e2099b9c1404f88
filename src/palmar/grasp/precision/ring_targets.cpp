// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/ring_targets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::grasp {
namespace {

constexpr double kLeastDisc = 12.0, kMostDisc = 45.0;           // mm; choice
const double kRingsLevel = std::cos(30.0 * geometry::kDegree);  // choice
constexpr double kOffPlane = 16.0;       // mm; a finger's thickness (Greiner 1991)
constexpr double kRingsApart = 1.6;      // mean sizes between two middles; choice
constexpr double kRingFinger = 0.085;    // hand lengths: thickness at the DIP (Greiner 1991)
constexpr double kFingerSpacing = 0.24;  // hand breadths from finger to finger; choice
constexpr double kLongestRay = 70.0;     // mm
constexpr double kBesideRings = 45.0;    // mm beside the rings, from where the shank is looked for
constexpr double kFacing = 0.5;          // cosine; a pad lies on what faces it within 60 degrees

// First place of the surface along a ray from the air, by steps of the distance to it.
std::optional<geometry::DistanceSample> first_wall(const geometry::DistanceField& product,
                                                   const Vec3& from, const Vec3& direction) {
  double way = 0.0;
  for (int step = 0; step < 400 && way < kLongestRay; ++step) {
    const geometry::DistanceSample sample = product.at(from + way * direction);
    if (sample.distance < 0.05) return sample;
    way += std::max(sample.distance, 0.02);
  }
  return std::nullopt;
}

double extent_along(const product::PartOpening& opening, const Vec3& direction) {
  const Vec3 high = opening.axis.cross(opening.wide);
  return std::abs(direction.dot(opening.wide)) * opening.width +
         std::abs(direction.dot(high)) * opening.height;
}

}  // namespace

std::optional<ScissorRings> scissor_rings(const product::ProductParts& parts,
                                          const product::Product& product) {
  std::optional<ScissorRings> best;
  double nearest = std::numeric_limits<double>::infinity();
  const auto is_ring = [](const product::ProductPart& part) {
    return part.opening && part.opening->disc >= kLeastDisc && part.opening->disc <= kMostDisc;
  };
  for (const product::ProductPart& a : parts.parts) {
    for (const product::ProductPart& b : parts.parts) {
      if (b.number <= a.number || !is_ring(a) || !is_ring(b)) continue;
      const Vec3 between = b.opening->centre - a.opening->centre;
      const double size =
          0.25 * (a.opening->width + a.opening->height + b.opening->width + b.opening->height);
      const double away = between.norm();
      if (std::abs(a.opening->axis.dot(b.opening->axis)) < kRingsLevel ||
          std::abs(a.opening->axis.dot(between)) > kOffPlane || away > kRingsApart * size ||
          away >= nearest) {
        continue;
      }
      const auto area = [](const product::ProductPart& part) {
        return part.opening->width * part.opening->height;
      };
      const product::ProductPart& small = area(b) < area(a) ? b : a;
      const product::ProductPart& large = area(b) < area(a) ? a : b;
      ScissorRings rings;
      rings.thumb = *small.opening;
      rings.fingers = *large.opening;
      rings.thumb_part = small.number;
      const Vec3 apart = (rings.thumb.centre - rings.fingers.centre).normalized();
      const Vec3 middle = 0.5 * (rings.thumb.centre + rings.fingers.centre);
      Vec3 toward = geometry::centre_of_volume(product.mesh) - middle;
      toward -= rings.thumb.axis * rings.thumb.axis.dot(toward);
      toward -= apart * apart.dot(toward);
      if (toward.norm() < 1.0) continue;  // nothing lies before the rings
      rings.toward = toward.normalized();
      nearest = away;
      best = rings;
    }
  }
  return best;
}

std::vector<FingertipTarget> ring_targets(const hand::Hand& hand, const product::Product& product,
                                          const ScissorRings& rings) {
  const geometry::DistanceField& surface = *product.distance;
  Vec3 apart = rings.thumb.centre - rings.fingers.centre;
  apart -= rings.thumb.axis * rings.thumb.axis.dot(apart);
  apart.normalize();
  const auto at_thumb = first_wall(surface, rings.thumb.centre, -apart);
  if (!at_thumb) return {};
  std::vector<FingertipTarget> targets = {{hand::Finger::kThumb, at_thumb->closest}};
  const double finger = kRingFinger * hand.dimensions.hand_length;
  const double spacing = kFingerSpacing * hand.dimensions.hand_width;
  const double room = extent_along(rings.fingers, rings.toward);
  const int fingers = std::clamp(static_cast<int>((room - finger) / spacing) + 1, 1, 3);
  // The middle finger is the first of them.
  const double first = 0.5 * spacing * (fingers - 1);
  const auto at_middle = first_wall(surface, rings.fingers.centre + first * rings.toward, apart);
  if (!at_middle) return {};
  const Vec3 before = at_middle->closest + spacing * rings.toward;
  const auto at_index = first_wall(surface, before - kBesideRings * apart, apart);
  if (at_index && at_index->normal.dot(-apart) > kFacing) {
    targets.push_back({hand::Finger::kIndex, at_index->closest});
  }
  targets.push_back({hand::Finger::kMiddle, at_middle->closest});
  if (fingers > 1) {
    const auto at_ring =
        first_wall(surface, rings.fingers.centre + (first - spacing) * rings.toward, apart);
    if (at_ring) targets.push_back({hand::Finger::kRing, at_ring->closest});
  }
  return targets;
}

}  // namespace palmar::grasp
