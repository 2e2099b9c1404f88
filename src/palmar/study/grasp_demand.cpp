// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/grasp_demand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/indices/contact_reduction.h"
#include "palmar/grasp/indices/stability.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/task_force.h"
#include "palmar/hand/posture/named_postures.h"

namespace palmar::study {
namespace {

// Angles this near to an end count as at the end: what clamping rounds off.
constexpr double kAngleRounding = 1e-12;  // rad

constexpr std::array<double, 3> kAcrossNail = {-1.0 / 3.0, 0.0, 1.0 / 3.0};  // of the width
constexpr double kNailHeight = 0.4;  // of the thickness, dorsal of the tip

hand::Segment distal_of(hand::Finger finger) {
  const auto chain = hand::segments_of(finger);
  return chain[2] ? *chain[2] : *chain[1];
}

/// A straight line from where a nail leaves the fingertip; hand frame.
struct NailLine {
  Vec3 start, along;
};

// Möller, Trumbore 1997: distance along the line to a triangle, or nothing.
std::optional<double> meet(const NailLine& line, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 p = line.along.cross(ac);
  const double determinant = ab.dot(p);
  if (std::abs(determinant) < 1e-12) return std::nullopt;
  const Vec3 from = line.start - a;
  const double u = from.dot(p) / determinant;
  if (u < 0.0 || u > 1.0) return std::nullopt;
  const Vec3 q = from.cross(ab);
  const double v = line.along.dot(q) / determinant;
  if (v < 0.0 || u + v > 1.0) return std::nullopt;
  const double t = ac.dot(q) / determinant;
  return t > 0.0 ? std::optional(t) : std::nullopt;
}

// Room up to the skin of the palm.
double room_to_palm(const hand::Hand& hand, const std::vector<Vec3>& skin, const NailLine& line,
                    double longest) {
  const auto is_palm_and_near = [&](int vertex) {
    return hand.segment[vertex] == hand::Segment::kPalm &&
           (skin[vertex] - line.start).squaredNorm() < 4.0 * kLongestNail * kLongestNail;
  };
  double room = longest;
  for (const Triangle& t : hand.skin.triangles) {
    if (!std::all_of(t.begin(), t.end(), is_palm_and_near)) continue;
    const auto at = [&](std::size_t k) { return skin[t[k]]; };
    if (const auto hit = meet(line, at(0), at(1), at(2))) room = std::min(room, *hit);
  }
  return room;
}

// Room up to the product, by steps of the distance to it: none can pass through.
double room_to_product(const geometry::DistanceField& product,
                       const geometry::Rigid3& product_from_hand, const NailLine& line,
                       double longest) {
  constexpr double kTouch = 0.01;  // mm; nearer than that counts as touching
  constexpr int kSteps = 1000;     // along a line that grazes the product
  const Vec3 start = product_from_hand * line.start;
  const Vec3 along = product_from_hand.rotation * line.along;
  double t = 0.0;
  for (int k = 0; k < kSteps && t < longest; ++k) {
    const Vec3 point = start + t * along;
    geometry::DistanceSample sample;
    product.sample({&point, 1}, longest, {&sample, 1});
    if (sample.distance <= kTouch) return t;
    t += sample.distance;
  }
  return std::min(t, longest);
}

}  // namespace

double range_share_of(const hand::Hand& hand, const hand::Posture& posture) {
  const hand::Posture relaxed = hand::named_posture(hand.skeleton, "relaxed").value();
  double share = 0.0;
  for (const hand::Joint& joint : hand.skeleton.joints) {
    for (const hand::JointDof& dof : joint.dofs) {
      const double way = posture[dof.dof] - relaxed[dof.dof];
      if (std::abs(way) <= kAngleRounding) continue;
      const double whole = way > 0.0 ? dof.upper - relaxed[dof.dof] : relaxed[dof.dof] - dof.lower;
      share = std::max(share, whole > 0.0 ? (std::abs(way) - kAngleRounding) / whole
                                          : std::numeric_limits<double>::infinity());
    }
  }
  return share;
}

namespace {

/// Least grip force [N] that holds the load by friction.
double force_needed(const hand::Hand& hand, const contact::ContactResult& contact,
                    const StrengthQuestion& question) {
  const Vec3 mass_centre = question.load.mass_centre.value_or(question.mass_centre);
  const contact::Wrench load = contact::wrench_of(question.load, mass_centre);
  if (load.force.isZero(0.0) && load.moment.isZero(0.0)) return 0.0;
  grasp::ReductionOptions reduction;
  reduction.friction = question.friction;
  const std::vector<grasp::GraspContact> contacts = grasp::reduce_contact(hand, contact, reduction);
  const grasp::GripForce least = grasp::least_grip_force(contacts, load, mass_centre);
  if (least.status != grasp::GripForceStatus::kHeld) return std::numeric_limits<double>::infinity();
  std::vector<Vec3> normal_forces;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3& normal = contacts[i].normal;
    normal_forces.emplace_back(normal.dot(least.force[i]) * normal);
  }
  return grasp::grip_force(normal_forces).force;
}

}  // namespace

double strength_needed(const hand::Hand& hand, const contact::ContactResult& contact,
                       const StrengthQuestion& question, const grasp::Balance* rest) {
  const double force = std::max(question.stated_force, force_needed(hand, contact, question));
  if (rest != nullptr && rest->status == grasp::BalanceStatus::kBalanced && rest->strength_use &&
      rest->grip_force > 0.0) {
    return *rest->strength_use * force / rest->grip_force * question.muscle_strength *
           grasp::usual_grip_strength();
  }
  return force / grasp::strength_share(question.grip);
}

double nail_room_of(const hand::Hand& hand, const hand::Posture& posture,
                    const std::vector<Vec3>& posed_skin, const geometry::Rigid3& product_from_hand,
                    const product::Product& product) {
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand.skeleton, posture);
  double room = kLongestNail;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const hand::Segment distal = distal_of(finger);
    const hand::Joint& joint = hand.skeleton.joint(hand::joint_of(distal));
    const Vec3& tip = hand.skeleton.fingertips[f];
    const Vec3 along = (tip - joint.centre).normalized();
    // Flexion moves the tip to the palm.
    const Vec3 palmar = joint.dofs.back().axis.cross(along).normalized();
    const Vec3 across = palmar.cross(along);
    const hand::SegmentDimensions& size = hand.dimensions.segment[index_of(distal)];
    const geometry::Rigid3& moved = posed.segment[index_of(distal)];
    for (const double side : kAcrossNail) {
      const Vec3 start = tip - kNailHeight * size.thickness * palmar + side * size.width * across;
      const NailLine line{moved * start, moved.rotation * along};
      room = room_to_product(*product.distance, product_from_hand, line, room);
      room = room_to_palm(hand, posed_skin, line, room);
    }
  }
  return room;
}

GraspDemand demand_of(const hand::Hand& hand, const product::Product& product,
                      const HeldProductState& held, const StrengthQuestion& question) {
  GraspDemand demand;
  demand.range_share = range_share_of(hand, held.grasp.posture);
  demand.grip_strength = strength_needed(hand, held.contact, question, &held.balance);
  demand.nail_room = nail_room_of(hand, held.grasp.posture, held.posed_skin,
                                  held.grasp.product_from_hand, product);
  return demand;
}

}  // namespace palmar::study
