// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/photo/skin_tint.h"

#include <algorithm>
#include <cmath>

#include "hands/phantom/person/bell.h"
#include "hands/phantom/person/person_random.h"
#include "palmar/core/enum_index.h"

namespace palmar::phantom {
namespace {

enum TintStream : std::uint64_t { kBlotch = 64, kCloud, kRedness };

constexpr double kEdge = 0.4;  // mm over which a nail begins

/// 0 outside, 1 where `depth` [mm] is inside by half an edge.
double inside(double depth) { return std::clamp(depth / kEdge + 0.5, 0.0, 1.0); }

}  // namespace

SkinTint::SkinTint(const SubjectPerson& person, const hand::HandCreases& creases,
                   std::uint64_t seed)
    : creases_(&creases), blotch_(seed, kBlotch, 12.0), cloud_(seed, kCloud, 30.0) {
  RandomStream random(seed, kRedness);
  redness_ = 1.0 + spread(random, 0.35);
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
    const std::size_t last = segments[2] ? 2 : 1;
    const Vec3 joint = person.skeleton.joint(hand::joint_of(*segments[last])).centre;
    const Vec3 link = person.skeleton.fingertips[f] - joint;
    const Vec3 along = link.normalized();
    const Vec3& towards = creases.palmar_direction(static_cast<hand::Finger>(f), 4);
    tip_[f] = {joint,
               along,
               (towards - towards.dot(along) * along).normalized(),
               link.norm(),
               0.5 * person.finger_width[f],
               person.skeleton.joint(hand::joint_of(*segments[last - 1])).centre};
  }
  const auto centre = [&](hand::JointId id) { return person.skeleton.joint(id).centre; };
  const Vec3 wrist = centre(hand::JointId::kWrist);
  thenar_ = 0.5 * (centre(hand::JointId::kThumbCmc) + centre(hand::JointId::kThumbMp));
  hypothenar_ = wrist + 0.4 * (centre(hand::JointId::kLittleMcp) - wrist);
}

std::array<double, 2> SkinTint::nail(const Tip& tip, const Vec3& p) const {
  const Vec3 arm = p - tip.joint;
  const double along = arm.dot(tip.along);
  const double aside = arm.dot(tip.palmar.cross(tip.along));
  const double dorsal = -arm.dot(tip.palmar);
  const double half = 0.68 * tip.half;  // of its width
  const double root = 0.50 * tip.length, end = tip.length - 1.0, round = 0.5 * half;
  // Round at its root; on the back of the finger alone.
  const double back = std::max(0.0, std::abs(aside) - (half - round));
  const double least = root + round - std::sqrt(std::max(0.0, round * round - back * back));
  const double depth = std::min(
      {along - least, end - along, half - std::abs(aside), 3.0 * (dorsal - 0.1 * tip.half)});
  const double share = inside(depth);
  return {share, share * inside(along - (end - 1.3))};
}

geometry::Srgb SkinTint::at(const Vec3& p, hand::Segment segment,
                            const geometry::Srgb& even) const {
  const double palmar = std::clamp(0.5 + creases_->palmar_height(p) / 8.0, 0.0, 1.0);
  double blood = 0.25 * blotch_.at(p) + 0.25 * cloud_.at(p) + 0.35 * palmar;
  blood += 0.5 * palmar * (bell((p - thenar_).norm(), 22.0) + bell((p - hypothenar_).norm(), 22.0));
  const auto finger = hand::finger_of(segment);
  if (finger) {
    const Tip& tip = tip_[index_of(*finger)];
    const double along = (p - tip.joint).dot(tip.along);
    blood += 1.1 * std::clamp(along / tip.length, 0.0, 1.0) * (0.4 + 0.6 * palmar);
    blood += 0.5 * (1.0 - palmar) *
             (bell((p - tip.joint).norm() - tip.half, 4.0) +
              bell((p - tip.knuckle).norm() - tip.half, 5.0));
  }
  const auto b = static_cast<float>(redness_ * std::max(-0.5, blood));
  geometry::Srgb colour =
      even.cwiseProduct(geometry::Srgb(1.0F - 0.02F * b, 1.0F - 0.13F * b, 1.0F - 0.11F * b));
  if (finger) {
    const auto [plate, edge] = nail(tip_[index_of(*finger)], p);
    const geometry::Srgb pink = 0.5F * colour + 0.5F * geometry::Srgb(0.92F, 0.74F, 0.70F);
    colour += static_cast<float>(plate) * (pink - colour);
    colour += static_cast<float>(edge) * (geometry::Srgb(0.92F, 0.88F, 0.82F) - colour);
  }
  return colour.cwiseMax(0.0F).cwiseMin(1.0F);
}

}  // namespace palmar::phantom
