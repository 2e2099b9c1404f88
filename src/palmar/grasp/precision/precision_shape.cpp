// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/precision_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/hand/posture/named_postures.h"

namespace palmar::grasp {
namespace {

constexpr double kShapeReached = 0.5;  // mm
constexpr double kSquare = 40.0 * geometry::kDegree;
constexpr double kSquareOnBall =
    65.0 * geometry::kDegree;         // fingertips touch a ball with their sides, too
constexpr double kSideBySide = 17.0;  // mm between the pads of index and middle finger
constexpr std::array<double, 12> kWidths = {2, 8, 14, 20, 28, 36, 45, 55, 65, 75, 85, 95};
constexpr double kThickPen = 30.0;  // mm; people write with nothing thicker
constexpr double kThinPen = 5.0;    // mm
constexpr double kBesides = 20.0;   // mm; from fingertip to fingertip along a rim
constexpr double kWidestStep = 38.0 * geometry::kDegree;  // the same as an angle, at most
constexpr double kDiscHeight = 14.0;  // mm; of the disc that hands are opened for
constexpr double kWebSlide = 25.0;    // mm
constexpr double kWebSquare = 1.5;    // rad

hand::Posture named(const hand::Skeleton& skeleton, const char* name) {
  return hand::named_posture(skeleton, name).value_or(hand::reference_posture(skeleton));
}

void set(hand::Posture& posture, hand::Finger finger, const std::array<double, 3>& flexion_deg) {
  for (int level = 0; level < (finger == hand::Finger::kThumb ? 2 : 3); ++level) {
    posture[flexion_of(finger, level)] = geometry::kDegree * flexion_deg[level];
  }
}

}  // namespace

std::vector<FingertipPoint> fingertips_of(const hand::Hand& hand, Grip grip) {
  using enum FingertipPart;
  const auto at = [&](hand::Finger finger, FingertipPart part) {
    return fingertip_point(hand, finger, part);
  };
  switch (grip) {
    case Grip::kTipPinch:
      return {at(hand::Finger::kThumb, kTip), at(hand::Finger::kIndex, kTip)};
    case Grip::kPalmarPinch:
      return {at(hand::Finger::kThumb, kPad), at(hand::Finger::kIndex, kPad)};
    case Grip::kTripod:
      return {at(hand::Finger::kThumb, kPad), at(hand::Finger::kIndex, kPad),
              at(hand::Finger::kMiddle, kPad)};
    case Grip::kLateral:
      return {at(hand::Finger::kThumb, kPad), at(hand::Finger::kIndex, kRadialSide)};
    case Grip::kPrecisionSphere:
    case Grip::kPrismatic:
      return {at(hand::Finger::kThumb, kPad), at(hand::Finger::kIndex, kPad),
              at(hand::Finger::kMiddle, kPad), at(hand::Finger::kRing, kPad),
              at(hand::Finger::kLittle, kPad)};
    case Grip::kPrecisionDisk:
      return fingertips_of(hand, Grip::kPrecisionSphere);
    case Grip::kWritingTripod:
      return {at(hand::Finger::kThumb, kPad), at(hand::Finger::kIndex, kPad),
              at(hand::Finger::kMiddle, kTipSide)};
    case Grip::kDistalType:
      return {at(hand::Finger::kThumb, kPad), at(hand::Finger::kIndex, kPad),
              at(hand::Finger::kMiddle, kMiddlePad), at(hand::Finger::kRing, kMiddlePad)};
    default:
      return {};
  }
}

hand::Posture natural_posture(const hand::Skeleton& skeleton, Grip grip) {
  hand::Posture posture;
  switch (grip) {
    case Grip::kTipPinch:
      return named(skeleton, "tip_pinch");
    case Grip::kTripod:
      posture = named(skeleton, "tripod");
      set(posture, hand::Finger::kIndex, {52, 42, 22});
      set(posture, hand::Finger::kMiddle, {56, 46, 24});
      break;
    case Grip::kLateral:
      return named(skeleton, "key_pinch");
    case Grip::kWritingTripod:
      posture = named(skeleton, "tripod");
      set(posture, hand::Finger::kThumb, {20, 15, 25});
      set(posture, hand::Finger::kIndex, {48, 48, 18});
      set(posture, hand::Finger::kMiddle, {52, 66, 34});
      set(posture, hand::Finger::kRing, {54, 74, 38});
      set(posture, hand::Finger::kLittle, {54, 72, 38});
      break;
    case Grip::kDistalType:
      posture = named(skeleton, "tripod");
      set(posture, hand::Finger::kThumb, {10, 15, 0});
      set(posture, hand::Finger::kIndex, {45, 30, 15});
      set(posture, hand::Finger::kMiddle, {52, 48, 25});
      set(posture, hand::Finger::kRing, {56, 54, 28});
      set(posture, hand::Finger::kLittle, {58, 56, 28});
      break;
    case Grip::kPrismatic:
      posture = named(skeleton, "cylinder_grip");
      for (const hand::Finger finger : {hand::Finger::kIndex, hand::Finger::kMiddle,
                                        hand::Finger::kRing, hand::Finger::kLittle}) {
        set(posture, finger, {45, 32, 18});
      }
      set(posture, hand::Finger::kThumb, {10, 15, 0});
      break;
    case Grip::kPrecisionSphere:
    case Grip::kPrecisionDisk:
      posture = named(skeleton, "cylinder_grip");
      for (const hand::Finger finger : {hand::Finger::kIndex, hand::Finger::kMiddle,
                                        hand::Finger::kRing, hand::Finger::kLittle}) {
        set(posture, finger, {40, 38, 22});
      }
      posture[hand::Dof::kIndexMcpAbduction] += 12.0 * geometry::kDegree;
      posture[hand::Dof::kRingMcpAbduction] -= 8.0 * geometry::kDegree;
      posture[hand::Dof::kLittleMcpAbduction] -= 18.0 * geometry::kDegree;
      set(posture, hand::Finger::kThumb, {10, 15, 0});
      break;
    default:  // pads of thumb and index finger
      posture = named(skeleton, "tip_pinch");
      set(posture, hand::Finger::kIndex, {58, 38, 15});
      set(posture, hand::Finger::kThumb, {10, 10, 0});
      break;
  }
  return hand::clamp_to_range(skeleton, posture).posture;
}

FingertipGoal web_goal(const hand::Hand& hand) {
  FingertipGoal goal;
  goal.fingertip = fingertip_point(hand, hand::Finger::kIndex, FingertipPart::kWeb);
  goal.is_sliding = goal.is_rest = true;
  goal.slide = kWebSlide;
  goal.square = kWebSquare;
  return goal;
}

GripOpenings::Start GripOpenings::start_for(const hand::Skeleton& skeleton,
                                            const hand::Posture& natural, const hand::Posture& from,
                                            double width) const {
  Start result;
  FingertipProblem& problem = result.problem;
  problem.natural = natural;
  problem.start = from;
  problem.max_iterations = 120;
  const hand::PosedSkeleton posed = hand::pose_skeleton(skeleton, from);
  std::vector<Vec3> tips;
  for (const FingertipPoint& tip : fingertips_) {
    tips.push_back(posed.segment[index_of(tip.segment)] * tip.point);
  }
  Vec3 others = Vec3::Zero();
  for (std::size_t k = 1; k < tips.size(); ++k) {
    others += tips[k] / static_cast<double>(tips.size() - 1);
  }
  // The thing's frame: z from the thumb to the other fingers, x to the radial one of them.
  const Vec3 z = (others - tips[0]).normalized();
  Vec3 radial = skeleton.joint(hand::JointId::kIndexMcp).centre -
                skeleton.joint(hand::JointId::kLittleMcp).centre;
  radial = (radial - z * z.dot(radial)).normalized();
  Eigen::Matrix3d axes;
  Vec3 middle = 0.5 * (others + tips[0]);
  const bool is_pen = grip_ == Grip::kWritingTripod, is_disc = grip_ == Grip::kPrecisionDisk;
  const bool is_ball = grip_ == Grip::kPrecisionSphere;
  if (is_pen) {
    // z from the fingertips over the web to the long end.
    const Vec3 web = posed.segment[index_of(web_.fingertip.segment)] * web_.fingertip.point;
    const Vec3 out =
        posed.segment[index_of(web_.fingertip.segment)].rotation * web_.fingertip.normal;
    middle = (tips[0] + tips[1] + tips[2]) / 3.0;
    axes.col(2) = (web + 0.5 * width * out - middle).normalized();
    axes.col(0) = (z - axes.col(2) * axes.col(2).dot(z)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
  } else if (is_disc) {
    // x from the thumb to the other fingers, y to the radial one, z the disc's axis.
    axes.col(0) = z;
    axes.col(1) = radial;
    axes.col(2) = z.cross(radial);
  } else {
    axes.col(0) = radial;
    axes.col(1) = z.cross(radial);
    axes.col(2) = z;
  }
  problem.product_from_hand.rotation = Quat(Eigen::Matrix3d(axes.transpose()));
  problem.product_from_hand.translation = -(problem.product_from_hand.rotation * middle);
  if (is_ball) result.thing = geometry::make_sphere_distance(0.5 * width);
  if (is_pen) result.thing = geometry::make_cylinder_distance({.radius = 0.5 * width});
  if (is_disc) {
    result.thing = geometry::make_cylinder_distance({.radius = 0.5 * width, .length = kDiscHeight});
  }
  problem.product = result.thing.get();
  const bool is_too_small = (is_ball || is_disc) && width < kFiveFit;
  if (is_too_small || (is_pen && (width > kThickPen || width < kThinPen))) return result;
  for (std::size_t k = 0; k < tips.size(); ++k) {
    const Vec3 there = problem.product_from_hand * tips[k];
    FingertipGoal goal;
    goal.fingertip = fingertips_[k];
    if (is_ball || is_disc || is_pen) {
      goal.is_sliding = true;
      goal.slide = kBallSlide;
      goal.square = kBallSquare;
    }
    const Vec3 side = k == 0 ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ());
    if (is_ball) {
      goal.point = 0.5 * width * (k == 0 ? side : Vec3(there.normalized()));
    } else if (is_pen) {
      goal.point = result.thing->at(there).closest;
    } else if (is_disc) {
      const double step = std::min(kWidestStep, 2.0 * std::asin(std::min(1.0, kBesides / width)));
      // Index and middle finger on either side of the place opposite to the thumb.
      const double angle =
          k == 0 ? std::numbers::pi : step * (1.3 - (static_cast<double>(k) - 1.0));
      goal.point = 0.5 * width * Vec3(std::cos(angle), std::sin(angle), 0.0);
    } else {
      goal.point = 0.5 * width * side;
      goal.normal = side;
      // Side by side, the radial one first.
      const double first = 0.5 * (static_cast<double>(tips.size()) - 2.0);
      if (k > 0) goal.point.x() = (first - (static_cast<double>(k) - 1.0)) * kSideBySide;
    }
    problem.goals.push_back(goal);
  }
  if (is_pen) {
    problem.goals.push_back(web_);
    FingertipGoal& web = problem.goals.back();
    web.point = result.thing
                    ->at(problem.product_from_hand *
                         (posed.segment[index_of(web.fingertip.segment)] * web.fingertip.point))
                    .closest;
  }
  return result;
}

std::optional<GripOpening> GripOpenings::solved(const FingertipIk& ik, const Start& start,
                                                double width) const {
  const FingertipSolution solution = ik.solve(start.problem);
  double tilt = 0.0;
  for (std::size_t k = 0; k < fingertips_.size(); ++k) tilt = std::max(tilt, solution.tilt[k]);
  const double most = start.thing != nullptr ? kSquareOnBall : kSquare;
  if (solution.worst_miss > kShapeReached || tilt > most) return std::nullopt;
  GripOpening opening;
  opening.width = width;
  opening.posture = solution.posture;
  opening.strain = solution.strain;
  const hand::PosedSkeleton posed = hand::pose_skeleton(ik.hand().skeleton, solution.posture);
  for (std::size_t k = 0; k < fingertips_.size(); ++k) {
    const Vec3 tip = posed.segment[index_of(fingertips_[k].segment)] * fingertips_[k].point;
    if (k == 0) {
      opening.thumb = tip;
    } else {
      opening.others += tip / static_cast<double>(fingertips_.size() - 1);
    }
  }
  const geometry::Rigid3 hand_from_thing = solution.product_from_hand.inverse();
  if (grip_ == Grip::kPrecisionDisk) {
    opening.others = hand_from_thing * Vec3(0.5 * width, 0.0, 0.0);
    opening.axis = hand_from_thing.rotation * Vec3::UnitZ();
    opening.centre = hand_from_thing.translation;
  }
  if (grip_ == Grip::kWritingTripod) {
    opening.axis = hand_from_thing.rotation * Vec3::UnitZ();
    const Vec3 mean = (opening.thumb + 2.0 * opening.others) / 3.0;
    const Vec3 from = mean - hand_from_thing.translation;
    opening.centre = hand_from_thing.translation + opening.axis * opening.axis.dot(from);
  }
  return opening;
}

GripOpenings::GripOpenings(const FingertipIk& ik, Grip grip)
    : grip_(grip), fingertips_(fingertips_of(ik.hand(), grip)) {
  if (grip == Grip::kWritingTripod) web_ = web_goal(ik.hand());
  const hand::Skeleton& skeleton = ik.hand().skeleton;
  const hand::Posture natural = natural_posture(skeleton, grip);
  hand::Posture from = natural;
  for (const double width : kWidths) {
    const Start start = start_for(skeleton, natural, from, width);
    if (start.problem.goals.empty()) continue;
    const std::optional<GripOpening> opening = solved(ik, start, width);
    if (!opening && openings_.empty()) continue;
    if (!opening) break;
    from = opening->posture;
    openings_.push_back(*opening);
  }
}

const GripOpening& GripOpenings::at(double width) const {
  return *std::min_element(openings_.begin(), openings_.end(),
                           [&](const GripOpening& a, const GripOpening& b) {
                             // Half way between two, rounding doesn't decide.
                             return std::abs(a.width - width) < std::abs(b.width - width) - 1e-6;
                           });
}

const GripOpenings& OpenedHand::openings(Grip grip) {
  const auto known = openings_.find(grip);
  return known != openings_.end() ? known->second
                                  : openings_.emplace(grip, GripOpenings(ik_, grip)).first->second;
}

}  // namespace palmar::grasp
