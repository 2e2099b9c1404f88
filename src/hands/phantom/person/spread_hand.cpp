// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/spread_hand.h"

#include <fmt/format.h>

#include "hands/capture/skin_registration.h"
#include "hands/phantom/person/person_random.h"
#include "hands/phantom/person/soft_tissue.h"
#include "hands/phantom/person/subject_bones.h"
#include "hands/phantom/person/subject_creases.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/remesh/subdivide.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/dimensions/hand_sections.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/posture/skeleton_in_posture.h"
#include "palmar/hand/posture/table_posture.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::phantom {
namespace {

constexpr std::uint64_t kHandStream = 77, kPersonStream = 79;

std::array<double, hand::kFingerCount> tip_heights(const hand::Skeleton& posed) {
  std::array<double, hand::kFingerCount> z{};
  for (std::size_t f = 0; f < z.size(); ++f) z[f] = posed.fingertips[f].z();
  return z;
}

/// Fingers straight within a few degrees, as people hold them; the thumb in the palm's plane as far
/// as it goes without effort.
hand::Posture straightened(const SubjectPerson& person, RandomStream& random) {
  hand::Posture posture = person.reference;
  for (int f = 0; f < 4; ++f) {
    const int first = static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * f;
    const auto set = [&](int k, double degrees, double most) {
      posture[static_cast<hand::Dof>(first + k)] =
          geometry::kDegree * (degrees + about_zero(random, most));
    };
    set(0, 2.0, 3.0);
    set(2, 3.0, 3.0);
    set(3, 2.0, 2.0);
  }
  posture[hand::Dof::kThumbCmcFlexion] += geometry::kDegree * (-12.0 + about_zero(random, 5.0));
  posture[hand::Dof::kThumbCmcAbduction] += geometry::kDegree * about_zero(random, 4.0);
  posture[hand::Dof::kThumbMpFlexion] = geometry::kDegree * about_zero(random, 4.0);
  posture[hand::Dof::kThumbIpFlexion] = geometry::kDegree * about_zero(random, 5.0);
  return hand::posture_on_table(
      posture, [&](const hand::Posture& p) { return tip_heights(subject_skeleton(person, p)); });
}

/// Spreads fingers as a hand is spread on a table without force.
void fan_out(hand::Posture& posture, double share, RandomStream& random) {
  constexpr std::array<double, 4> kFan{13.0, 1.0, -9.0, -20.0};  // degrees
  for (int f = 0; f < 4; ++f) {
    const auto abduction =
        static_cast<hand::Dof>(static_cast<int>(hand::Dof::kIndexMcpAbduction) + 4 * f);
    posture[abduction] += share * geometry::kDegree *
                          ((0.8 + 0.3 * random.uniform()) * kFan[f] + about_zero(random, 1.5));
  }
}

}  // namespace

void SpreadOptions::check() const {
  if (!(together >= 0.0 && together <= 1.0)) {
    throw UsageError(fmt::format("together is {}; 0 to 1 is allowed", together));
  }
}

SpreadHand spread_hand(const hand::Hand& hand, const SpreadOptions& options) {
  options.check();
  RandomStream random(options.seed, kHandStream);
  hand::Posture posture = *hand::named_posture(hand.skeleton, "spread");
  for (const hand::Dof abduction : {hand::Dof::kIndexMcpAbduction, hand::Dof::kMiddleMcpAbduction,
                                    hand::Dof::kRingMcpAbduction, hand::Dof::kLittleMcpAbduction}) {
    posture[abduction] =
        (1.0 - options.together) * posture[abduction] * (0.75 + 0.2 * random.uniform()) +
        about_zero(random, 1.5) * geometry::kDegree * (1.0 - options.together);
  }
  posture[hand::Dof::kThumbCmcFlexion] *= 0.3;
  posture = hand::posture_on_table(posture, [&](const hand::Posture& p) {
    return tip_heights(hand::skeleton_in_posture(hand.skeleton, p));
  });
  SpreadHand result;
  result.side = hand.side;
  result.skin = {hand::pose_skin(hand, posture), hand.skin.triangles};
  const hand::HandCreases creases(hand.skin, hand.skeleton);
  result.wrist = hand::hand_sections(hand.skin, hand.skeleton, creases).wrist_middle;
  const hand::Skeleton posed = hand::skeleton_in_posture(hand.skeleton, posture);
  for (std::size_t f = 0; f < 4; ++f) result.fingertips[f] = posed.fingertips[f + 1];
  result.dimensions = hand.dimensions;
  return result;
}

SpreadHand spread_person(const hand::Hand& base, hand::Side side, const SpreadOptions& options) {
  options.check();
  const SubjectPerson person =
      make_person(base.side == hand::Side::kRight ? base : hand::mirrored(base), options.seed,
                  options.dispersion);
  const std::vector<SubjectBone> bones = make_subject_bones(person, options.seed);
  const SoftTissue tissue(person, bones);
  RandomStream random(options.seed, kPersonStream);
  const hand::Posture straight = straightened(person, random);
  hand::Posture fan = straight;
  fan_out(fan, 1.0 - options.together, random);
  for (const hand::Dof flexion : {hand::Dof::kIndexMcpFlexion, hand::Dof::kMiddleMcpFlexion,
                                  hand::Dof::kRingMcpFlexion, hand::Dof::kLittleMcpFlexion}) {
    fan[flexion] += spread(random, options.dispersion.table);
  }
  geometry::SubdivisionOptions finer;
  finer.levels = 1;
  const auto skin_in = [&](const hand::Posture& posture) {
    return geometry::subdivide({tissue.pose(posture).skin, person.skin.triangles}, finer);
  };
  // Fingertips are points of the skin, which moves against the bones a little.
  const hand::HandCreases relaxed(person.skin, person.skeleton);
  std::vector<hand::Segment> segment;
  for (const Vec3& v : person.skin.vertices) segment.push_back(relaxed.label(v).segment);
  // Fingers as thick as people's lie so near to each other that places alone don't say whose skin
  // it is.
  if (options.dispersion.is_free) segment = base.segment;
  const auto joints_in = [&](const hand::Posture& posture, const geometry::TriangleMesh& skin) {
    hand::Skeleton skeleton = subject_skeleton(person, posture);
    const std::vector<Vec3> vertices(
        skin.vertices.begin(), skin.vertices.begin() + static_cast<std::ptrdiff_t>(segment.size()));
    for (int f = 0; f < hand::kFingerCount; ++f) {
      skeleton.fingertips[f] =
          capture::fingertip_of(vertices, segment, skeleton, static_cast<hand::Finger>(f));
    }
    return skeleton;
  };
  // Measured with the thumb at rest: beside the palm its web hides where its base crease is.
  hand::Posture measured = straight;
  for (const hand::Dof dof : {hand::Dof::kThumbCmcFlexion, hand::Dof::kThumbCmcAbduction,
                              hand::Dof::kThumbMpFlexion, hand::Dof::kThumbIpFlexion}) {
    measured[dof] = person.reference[dof];
  }
  const geometry::TriangleMesh flat = skin_in(measured);
  const hand::Skeleton joints = joints_in(measured, flat);
  const hand::HandCreases creases = subject_creases(flat, joints, options.seed, options.dispersion);
  SpreadHand result;
  result.side = side;
  result.dimensions = hand::measure_hand(flat, joints, creases);
  result.skin = skin_in(fan);
  result.wrist = hand::hand_sections(flat, joints, creases).wrist_middle;
  const hand::Skeleton fanned = joints_in(fan, result.skin);
  for (std::size_t f = 0; f < 4; ++f) result.fingertips[f] = fanned.fingertips[f + 1];
  if (side == hand::Side::kLeft) {
    for (Vec3& v : result.skin.vertices) v.x() = -v.x();
    for (Triangle& t : result.skin.triangles) std::swap(t[1], t[2]);
    for (Vec3& tip : result.fingertips) tip.x() = -tip.x();
    result.wrist.x() = -result.wrist.x();
  }
  return result;
}

}  // namespace palmar::phantom
