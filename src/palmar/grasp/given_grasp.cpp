// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/given_grasp.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kFarthestGap = 1000.0;  // mm; how far a gap is reported
constexpr double kDeepest = 15.0;  // mm; half a finger's thickness and more: no contact but a clash

void check(const hand::Posture& posture, const geometry::Rigid3& product_from_hand) {
  for (int d = 0; d < hand::kDofCount; ++d) {
    if (!std::isfinite(posture[static_cast<hand::Dof>(d)])) {
      throw InputError("the angle of " + std::string(name_of(static_cast<hand::Dof>(d))) +
                       " is not finite");
    }
  }
  if (!product_from_hand.translation.allFinite() ||
      !product_from_hand.rotation.coeffs().allFinite()) {
    throw InputError("the product's placement in the hand has a number that is not finite");
  }
}

std::string list_of(const std::vector<hand::Finger>& fingers) {
  std::string text;
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    text += i == 0 ? "" : i + 1 == fingers.size() ? " and " : ", ";
    text += name_of(fingers[i]);
  }
  return text;
}

void judge(Grasp& grasp) {
  std::vector<hand::Finger> touching;
  double deepest = 0.0;
  double nearest = -kFarthestGap;
  for (const SegmentStop& stop : grasp.stops) {
    deepest = std::max(deepest, stop.penetration);
    nearest = std::max(nearest, stop.penetration);
    const auto finger = hand::finger_of(stop.segment);
    if (!finger || stop.penetration <= 0.0) continue;
    if (touching.empty() || touching.back() != *finger) touching.push_back(*finger);
  }
  const bool has_palm = grasp.stops[0].penetration > 0.0;
  grasp.status = touching.size() >= 3            ? GraspStatus::kHeld
                 : !touching.empty() || has_palm ? GraspStatus::kPartlyHeld
                                                 : GraspStatus::kNotGraspable;
  grasp.message = "given posture and placement: ";
  if (touching.empty() && !has_palm) {
    const std::string gap = std::to_string(std::lround(-nearest));
    grasp.message += "no palmar skin touches the product; the nearest is " + gap +
                     " mm away. Is the placement product_from_hand, in mm?";
    return;
  }
  grasp.message += touching.empty() ? "the palm" : list_of(touching);
  if (has_palm && !touching.empty()) grasp.message += ", with the palm,";
  grasp.message += touching.size() == 1 || touching.empty() ? " touches" : " touch";
  grasp.message += " the product";
  if (deepest > kDeepest) {
    grasp.message += "; skin is " + std::to_string(std::lround(deepest)) +
                     " mm deep in it, which is no contact: the placement may be wrong";
  }
}

}  // namespace

Grasp given_grasp(const hand::Hand& hand, const product::Product& product,
                  const hand::Posture& posture, const geometry::Rigid3& product_from_hand) {
  check(posture, product_from_hand);
  Grasp grasp;
  grasp.posture = posture;
  grasp.product_from_hand = product_from_hand;

  std::vector<Vec3> points;
  std::vector<hand::Segment> segment;
  const std::vector<Vec3> skin = hand::pose_skin(hand, posture);
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand.region[v] == hand::Region::kDorsum) continue;
    points.push_back(product_from_hand * skin[v]);
    segment.push_back(hand.segment[v]);
  }
  std::vector<geometry::DistanceSample> samples(points.size());
  product.distance->sample(points, kFarthestGap, samples);
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    grasp.stops[s] = {static_cast<hand::Segment>(s), StopReason::kGiven, -kFarthestGap};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    SegmentStop& stop = grasp.stops[index_of(segment[i])];
    stop.penetration = std::max(stop.penetration, -samples[i].distance);
  }
  const Box3 box = product.distance->bounding_box();
  if (!box.isEmpty()) grasp.grip_point = box.center();
  judge(grasp);
  return grasp;
}

}  // namespace palmar::grasp
