// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/precision_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/grasp/power/finger_motion.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/hand/posture/named_postures.h"

namespace palmar {
namespace {

constexpr double kShapeReached = 0.5;  // mm
constexpr double kSquare = 40.0 * kDegree;
constexpr double kSquareOnBall = 65.0 * kDegree;  // fingertips touch a ball with their sides, too
constexpr double kSideBySide = 17.0;              // mm between the pads of index and middle finger
constexpr std::array<double, 12> kWidths = {2, 8, 14, 20, 28, 36, 45, 55, 65, 75, 85, 95};

Posture named(const Skeleton& skeleton, const char* name) {
  return named_posture(skeleton, name).value_or(reference_posture(skeleton));
}

void set(Posture& posture, Finger finger, const std::array<double, 3>& flexion_deg) {
  for (int level = 0; level < (finger == Finger::kThumb ? 2 : 3); ++level) {
    posture[flexion_of(finger, level)] = kDegree * flexion_deg[level];
  }
}

}  // namespace

std::vector<FingertipPoint> fingertips_of(const Hand& hand, Grip grip) {
  using enum FingertipPart;
  const auto at = [&](Finger finger, FingertipPart part) {
    return fingertip_point(hand, finger, part);
  };
  switch (grip) {
    case Grip::kTipPinch:
      return {at(Finger::kThumb, kTip), at(Finger::kIndex, kTip)};
    case Grip::kPalmarPinch:
      return {at(Finger::kThumb, kPad), at(Finger::kIndex, kPad)};
    case Grip::kTripod:
      return {at(Finger::kThumb, kPad), at(Finger::kIndex, kPad), at(Finger::kMiddle, kPad)};
    case Grip::kLateral:
      return {at(Finger::kThumb, kPad), at(Finger::kIndex, kRadialSide)};
    case Grip::kPrecisionSphere:
      return {at(Finger::kThumb, kPad), at(Finger::kIndex, kPad), at(Finger::kMiddle, kPad),
              at(Finger::kRing, kPad), at(Finger::kLittle, kPad)};
    default:
      return {};
  }
}

Posture natural_posture(const Skeleton& skeleton, Grip grip) {
  Posture posture;
  switch (grip) {
    case Grip::kTipPinch:
      return named(skeleton, "tip_pinch");
    case Grip::kTripod:
      posture = named(skeleton, "tripod");
      set(posture, Finger::kIndex, {52, 42, 22});
      set(posture, Finger::kMiddle, {56, 46, 24});
      break;
    case Grip::kLateral:
      return named(skeleton, "key_pinch");
    case Grip::kPrecisionSphere:
      posture = named(skeleton, "cylinder_grip");
      for (const Finger finger :
           {Finger::kIndex, Finger::kMiddle, Finger::kRing, Finger::kLittle}) {
        set(posture, finger, {40, 38, 22});
      }
      posture[Dof::kIndexMcpAbduction] += 12.0 * kDegree;
      posture[Dof::kRingMcpAbduction] -= 8.0 * kDegree;
      posture[Dof::kLittleMcpAbduction] -= 18.0 * kDegree;
      set(posture, Finger::kThumb, {10, 15, 0});
      break;
    default:  // pads of thumb and index finger
      posture = named(skeleton, "tip_pinch");
      set(posture, Finger::kIndex, {58, 38, 15});
      set(posture, Finger::kThumb, {10, 10, 0});
      break;
  }
  return clamp_to_range(skeleton, posture).posture;
}

GripOpenings::GripOpenings(const FingertipIk& ik, Grip grip)
    : grip_(grip), fingertips_(fingertips_of(ik.hand(), grip)) {
  const Skeleton& skeleton = ik.hand().skeleton;
  const Posture natural = natural_posture(skeleton, grip);
  Posture start = natural;
  for (const double width : kWidths) {
    FingertipProblem problem;
    problem.natural = natural;
    problem.start = start;
    problem.max_iterations = 120;
    const PosedSkeleton posed = pose_skeleton(skeleton, start);
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
    Vec3 radial =
        skeleton.joint(JointId::kIndexMcp).centre - skeleton.joint(JointId::kLittleMcp).centre;
    radial = (radial - z * z.dot(radial)).normalized();
    Eigen::Matrix3d axes;
    axes.col(0) = radial;
    axes.col(1) = z.cross(radial);
    axes.col(2) = z;
    problem.product_from_hand.rotation = Quat(Eigen::Matrix3d(axes.transpose()));
    problem.product_from_hand.translation =
        -(problem.product_from_hand.rotation * Vec3(0.5 * (others + tips[0])));
    const bool is_ball = grip == Grip::kPrecisionSphere;
    const DistanceFieldPtr ball = is_ball ? make_sphere_distance(0.5 * width) : nullptr;
    for (std::size_t k = 0; k < tips.size(); ++k) {
      const Vec3 side = k == 0 ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ());
      FingertipGoal goal;
      goal.fingertip = fingertips_[k];
      if (is_ball) {
        if (width < 25.0) continue;  // five fingertips don't fit
        goal.is_sliding = true;
        goal.slide = kBallSlide;
        goal.square = kBallSquare;
        const Vec3 there = problem.product_from_hand * tips[k];
        goal.point = 0.5 * width * (k == 0 ? side : Vec3(there.normalized()));
      } else {
        goal.point = 0.5 * width * side;
        goal.normal = side;
        if (tips.size() == 3 && k > 0) {
          goal.point.x() = (k == 1 ? 0.5 : -0.5) * kSideBySide;
        }
      }
      problem.goals.push_back(goal);
    }
    if (problem.goals.empty()) continue;
    problem.product = ball.get();
    const FingertipSolution solution = ik.solve(problem);
    const double tilt = *std::max_element(solution.tilt.begin(), solution.tilt.end());
    if (solution.worst_miss > kShapeReached || tilt > (is_ball ? kSquareOnBall : kSquare)) {
      if (openings_.empty()) continue;
      break;
    }
    GripOpening opening;
    opening.width = width;
    opening.posture = start = solution.posture;
    opening.strain = solution.strain;
    const FingerMotion motion(skeleton, solution.posture);
    for (std::size_t k = 0; k < fingertips_.size(); ++k) {
      const Vec3 tip =
          motion.posed().segment[index_of(fingertips_[k].segment)] * fingertips_[k].point;
      if (k == 0) {
        opening.thumb = tip;
      } else {
        opening.others += tip / static_cast<double>(fingertips_.size() - 1);
      }
    }
    openings_.push_back(opening);
  }
}

const GripOpening& GripOpenings::at(double width) const {
  return *std::min_element(openings_.begin(), openings_.end(),
                           [&](const GripOpening& a, const GripOpening& b) {
                             return std::abs(a.width - width) < std::abs(b.width - width);
                           });
}

}  // namespace palmar
