// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/laid_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/grasp/precision/fingertip_ik.h"
#include "palmar/grasp/precision/fingertip_press.h"
#include "palmar/hand/posture/named_postures.h"

namespace palmar::grasp {
namespace {

constexpr double kLaidDepth = 0.5;   // mm that palm and pads are pressed in before forces are known
constexpr double kLaidSlide = 8.0;   // mm that pads like to be off the place below them
constexpr double kLaidSquare = 0.9;  // rad; fingers touch with their sides, too
constexpr double kPalmSquare = 0.5;  // rad
constexpr double kPalmShare = 0.2;   // from the middle finger's knuckle to the wrist; choice
constexpr double kBackStep = 1.0, kMostBack = 40.0;  // mm
constexpr double kPalmSlide = 4.0;                   // mm
constexpr double kOnStand = 3.0;  // mm above what the product stands on; lower is on that
constexpr double kAbove = 80.0;   // mm from where the surface below is looked for
constexpr double kPushReached = 1.0, kPushClash = 1.5;  // mm
constexpr double kPushDepth = 1.0;                      // mm
constexpr int kPushSides = 8;

/// A product and what it stands on.
class StandingProduct : public geometry::DistanceField {
 public:
  StandingProduct(std::shared_ptr<const DistanceField> product, const Vec3& up, double level)
      : product_(std::move(product)), up_(up), level_(level) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    product_->sample(points, range, samples);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double height = up_.dot(points[k]) - level_;
      if (height >= samples[k].distance) continue;
      samples[k] = {height, points[k] - height * up_, up_, -1};
    }
  }
  Box3 bounding_box() const override { return product_->bounding_box(); }

 private:
  std::shared_ptr<const DistanceField> product_;
  Vec3 up_;
  double level_;
};

// What a ray meets first; nothing within `longest`.
std::optional<geometry::DistanceSample> below(const geometry::DistanceField& surface,
                                              const Vec3& from, const Vec3& direction,
                                              double longest) {
  double way = 0.0;
  for (int step = 0; step < 400 && way < longest; ++step) {
    const geometry::DistanceSample sample = surface.at(from + way * direction);
    if (sample.distance < 0.05) return sample;
    way += std::max(sample.distance, 0.05);
  }
  return std::nullopt;
}

// The middle of the palm's skin, as a place that touches.
FingertipPoint palm_point(const hand::Hand& hand) {
  const Vec3 knuckle = hand.skeleton.joint(hand::JointId::kMiddleMcp).centre;
  const Vec3 wrist = hand.skeleton.joint(hand::JointId::kWrist).centre;
  const Vec3 middle = knuckle + kPalmShare * (wrist - knuckle);
  FingertipPoint result;
  result.finger = hand::Finger::kMiddle;
  result.segment = hand::Segment::kPalm;
  result.normal = Vec3::UnitZ();  // the hand frame's z is palmar
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < hand.skin.vertices.size(); ++v) {
    if (hand.segment[v] != hand::Segment::kPalm || hand.region[v] == hand::Region::kDorsum)
      continue;
    const Vec3 off = hand.skin.vertices[v] - middle;
    const double away = std::hypot(off.x(), off.y());
    if (away >= nearest) continue;
    nearest = away;
    result.point = hand.skin.vertices[v];
  }
  return result;
}

std::string laid_finger_words(hand::Finger finger) {
  return finger == hand::Finger::kThumb ? "thumb" : std::string(name_of(finger)) + " finger";
}

std::string laid_list(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

// Fills what follows from the solution: contacts, stops, grip point and axis.
void describe_laid(const hand::Hand& hand, const product::Product& product, const FingertipIk& ik,
                   const FingertipProblem& problem, const FingertipSolution& solution,
                   Grasp& grasp) {
  grasp.posture = solution.posture;
  grasp.product_from_hand = solution.product_from_hand;
  Vec3 middle = Vec3::Zero();
  for (std::size_t k = 0; k < problem.goals.size(); ++k) {
    if (problem.goals[k].fingertip.segment == hand::Segment::kPalm) continue;
    FingertipContact contact;
    contact.finger = problem.goals[k].fingertip.finger;
    contact.target = contact.reached = solution.reached[k];
    if (!problem.goals[k].is_sliding) contact.target = problem.goals[k].point;
    contact.normal = solution.normal[k];
    contact.miss = solution.miss[k];
    middle += contact.reached;
    grasp.fingertips.push_back(contact);
  }
  middle /= static_cast<double>(grasp.fingertips.size());
  const Vec3 radial = hand.skeleton.joint(hand::JointId::kIndexMcp).centre -
                      hand.skeleton.joint(hand::JointId::kLittleMcp).centre;
  grasp.grip_axis = (grasp.product_from_hand.rotation * radial).normalized();
  grasp.grip_point = middle;
  std::vector<Vec3> section;
  for (const geometry::SectionCurve& curve :
       geometry::plane_section(product.mesh, grasp.grip_point, grasp.grip_axis)) {
    section.insert(section.end(), curve.point.begin(), curve.point.end());
  }
  grasp.grip_girth = geometry::girth(section, grasp.grip_axis);
  const SkinDepth skin =
      FingertipPress(ik).look(*product.distance, grasp.posture, grasp.product_from_hand);
  for (std::size_t s = 0; s < grasp.stops.size(); ++s) {
    grasp.stops[s].penetration = skin.palmar[s];
    grasp.stops[s].reason =
        skin.palmar[s] > 0.0 ? StopReason::kLimitDepth : StopReason::kNotReached;
  }
}

Grasp empty_grasp(Grip grip) {
  Grasp grasp;
  grasp.grip = grip;
  for (std::size_t s = 0; s < grasp.stops.size(); ++s) {
    grasp.stops[s].segment = static_cast<hand::Segment>(s);
  }
  return grasp;
}

}  // namespace

Grasp close_laid_hand(const hand::Hand& hand, const product::Product& product, Grip grip,
                      const LaidSite& site) {
  Grasp grasp = empty_grasp(grip);
  const FingertipIk ik(hand);
  double level = std::numeric_limits<double>::infinity();
  for (const Vec3& v : product.mesh.vertices) level = std::min(level, site.up.dot(v));
  const StandingProduct surface(product.distance, site.up, level);

  FingertipProblem problem;
  problem.product = &surface;
  problem.natural = problem.start =
      hand::named_posture(hand.skeleton, grip == Grip::kFlatHand ? "flat" : "relaxed").value();
  problem.max_iterations = 150;
  Eigen::Matrix3d axes;
  axes.col(2) = -site.up;
  axes.col(1) = site.fingers;
  axes.col(0) = axes.col(1).cross(axes.col(2));
  problem.product_from_hand.rotation = Quat(axes).normalized();
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand.skeleton, problem.start);
  std::vector<FingertipPoint> places;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    places.push_back(fingertip_point(hand, static_cast<hand::Finger>(f), FingertipPart::kPad));
  }
  places.push_back(palm_point(hand));
  problem.product_from_hand.translation =
      site.knuckle - problem.product_from_hand.rotation * places.back().point;
  std::vector<Vec3> feet;
  for (const FingertipPoint& place : places) {
    const Vec3 there =
        problem.product_from_hand * Vec3(posed.segment[index_of(place.segment)] * place.point);
    const auto foot = below(surface, there + kAbove * site.up, -site.up, 3.0 * kAbove);
    const auto is_on_stand = [&](const Vec3& p) { return site.up.dot(p) - level < kOnStand; };
    Vec3 at = foot ? foot->closest : there;
    // Fingers that reach beyond its end bend, so that their pads are on it.
    for (double back = kBackStep; is_on_stand(at) && back < kMostBack; back += kBackStep) {
      const auto nearer =
          below(surface, there + kAbove * site.up - back * site.fingers, -site.up, 3.0 * kAbove);
      if (nearer && site.up.dot(nearer->closest) - level > 3.0 * kOnStand) at = nearer->closest;
    }
    if (is_on_stand(at)) at = product.distance->at(at + kOnStand * site.up).closest;
    feet.push_back(at);
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    FingertipGoal goal;
    goal.fingertip = places[k];
    goal.point = feet[k];
    goal.depth = kLaidDepth;
    goal.is_sliding = true;
    goal.is_rest = true;  // nothing is pressed between thumb and fingers
    goal.slide = places[k].segment == hand::Segment::kPalm ? kPalmSlide : kLaidSlide;
    goal.square = places[k].segment == hand::Segment::kPalm ? kPalmSquare : kLaidSquare;
    problem.goals.push_back(goal);
  }
  const FingertipSolution solution = ik.solve(problem);
  describe_laid(hand, product, ik, problem, solution, grasp);
  grasp.score = 1.0 / (1.0 + solution.strain);

  std::vector<std::string> touching;
  if (grasp.stops[index_of(hand::Segment::kPalm)].penetration > 0.0) touching.emplace_back("palm");
  const bool has_palm = !touching.empty();
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const bool touches =
        std::any_of(grasp.stops.begin(), grasp.stops.end(), [&](const SegmentStop& stop) {
          return hand::finger_of(stop.segment) == static_cast<hand::Finger>(f) &&
                 stop.penetration > 0.0;
        });
    if (touches) touching.push_back(laid_finger_words(static_cast<hand::Finger>(f)));
  }
  const std::size_t fingers = touching.size() - (has_palm ? 1 : 0);
  grasp.status = fingers >= (has_palm ? 2U : 3U) ? GraspStatus::kHeld
                 : !touching.empty()             ? GraspStatus::kPartlyHeld
                                                 : GraspStatus::kNotGraspable;
  grasp.message = touching.empty() ? "the hand lies beside it"
                                   : "the hand lies on it with the " + laid_list(touching);
  return grasp;
}

Grasp close_finger_push(const hand::Hand& hand, const product::Product& product,
                        const Vec3& point) {
  Grasp grasp = empty_grasp(Grip::kFingerPush);
  const FingertipIk ik(hand);
  const FingertipPoint tip = fingertip_point(hand, hand::Finger::kIndex, FingertipPart::kTip);
  const geometry::DistanceSample at = product.distance->at(point);
  // Where the surface's direction is smooth.
  constexpr double kOff = 3.0;  // mm
  const Vec3 normal = product.distance->at(at.closest + kOff * at.normal).normal;
  FingertipProblem problem;
  problem.product = product.distance.get();
  problem.natural = problem.start = hand::named_posture(hand.skeleton, "point").value();
  problem.max_iterations = 150;
  FingertipGoal goal;
  goal.fingertip = tip;
  goal.point = at.closest;
  goal.normal = normal;
  goal.depth = kPushDepth;
  problem.goals = {goal};
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand.skeleton, problem.start);
  const geometry::Rigid3& carrier = posed.segment[index_of(tip.segment)];
  const Quat facing = Quat::FromTwoVectors(carrier.rotation * tip.normal, -normal);
  FingertipSolution best;
  double least = std::numeric_limits<double>::infinity();
  for (int side = 0; side < kPushSides; ++side) {
    const double sign = hand.side == hand::Side::kRight ? 1.0 : -1.0;
    const double angle = sign * 2.0 * std::numbers::pi * side / kPushSides;
    problem.product_from_hand.rotation = Quat(Eigen::AngleAxisd(angle, normal)) * facing;
    problem.product_from_hand.translation =
        at.closest - problem.product_from_hand.rotation * Vec3(carrier * tip.point);
    const FingertipSolution solution = ik.solve(problem);
    const double cost = std::pow(solution.worst_miss / 0.5, 2) +
                        std::pow(std::max(0.0, solution.clash), 2) + 0.1 * solution.strain +
                        0.5 * std::pow(solution.tilt[0] / (40.0 * geometry::kDegree), 2);
    if (cost >= least - 1e-6) continue;
    least = cost;
    best = solution;
  }
  describe_laid(hand, product, ik, problem, best, grasp);
  grasp.score = 1.0 / (1.0 + least);
  const double miss = grasp.fingertips[0].miss;
  if (miss > kPushReached) {
    grasp.status = GraspStatus::kPartlyHeld;
    grasp.message = fmt::format("the index finger misses its point by {:.1f} mm", miss);
  } else if (best.clash > kPushClash) {
    grasp.status = GraspStatus::kPartlyHeld;
    grasp.message = fmt::format(
        "the index finger reaches its point, but the hand would be {:.1f} mm in the product",
        best.clash);
  } else {
    grasp.status = GraspStatus::kHeld;
    grasp.message = "the tip of the index finger presses it";
  }
  return grasp;
}

}  // namespace palmar::grasp
