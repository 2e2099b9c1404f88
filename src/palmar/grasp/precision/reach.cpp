// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/power/posable_skin.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/grasp/precision/fingertip_ik.h"
#include "palmar/grasp/precision/opposing_points.h"

namespace palmar::grasp {
namespace {

constexpr double kPlaceReached = 1.0;      // mm
constexpr double kButtonOffSurface = 2.0;  // mm
constexpr double kButtonPadOffset = 3.0;   // mm off the surface, where its distance is smooth
constexpr double kMostTilt =
    60.0 * geometry::kDegree;  // a pad pressed over its edge presses no more
constexpr double kAwkwardTilt = 35.0 * geometry::kDegree;
constexpr double kAwkwardMargin = 8.0 * geometry::kDegree;
constexpr double kAwkwardBend = 25.0 * geometry::kDegree;  // of DIP from 2/3 PIP
constexpr double kMostClash = 3.0;  // mm; deeper in product or neighbour is no way to be
constexpr double kReachFar = 50.0;  // mm; who misses by more hasn't tried
constexpr double kOpposed = 120.0 * geometry::kDegree;
constexpr double kTouchRange = 5.0;  // mm

std::string finger_words(hand::Finger finger) {
  return finger == hand::Finger::kThumb ? "thumb" : std::string(name_of(finger)) + " finger";
}

std::vector<hand::Dof> dofs_of(hand::Finger finger) {
  std::vector<hand::Dof> dofs;
  const int first = finger == hand::Finger::kThumb ? static_cast<int>(hand::Dof::kThumbCmcFlexion)
                                                   : static_cast<int>(hand::Dof::kIndexMcpFlexion) +
                                                         4 * (static_cast<int>(finger) - 1);
  for (int d = first; d < first + 4; ++d) dofs.push_back(static_cast<hand::Dof>(d));
  return dofs;
}

/// One hand on one product: everything that doesn't depend on the button.
class Reacher {
 public:
  Reacher(const hand::Hand& hand, const product::Product& product, const Grasp& grasp)
      : hand_(&hand),
        product_(&product),
        grasp_(&grasp),
        ik_(hand),
        touching_(touching_segments(hand, product, grasp)) {
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      pads_.push_back(fingertip_point(hand, finger, FingertipPart::kPad));
      // Whatever it does, a finger gets no farther from its root than it is long.
      const auto segments = hand::segments_of(finger);
      const bool is_thumb = finger == hand::Finger::kThumb;
      const Vec3 root =
          hand.skeleton.joint(is_thumb ? hand::JointId::kThumbCmc : hand::joint_of(*segments[0]))
              .centre;
      double length = 0.0;
      Vec3 last = root;
      for (std::size_t level = 0; level < 3 && segments[level]; ++level) {
        const Vec3& joint = hand.skeleton.joint(hand::joint_of(*segments[level])).centre;
        length += (joint - last).norm();
        last = joint;
      }
      length += (pads_.back().point - last).norm();
      roots_.push_back(grasp.product_from_hand * root);
      lengths_.push_back(length + (is_thumb ? 10.0 : 2.0));
    }
  }

  /// Not tried where the finger's length alone leaves more than `hopeless` [mm].
  FingerReach send(hand::Finger finger, const Vec3& point, const Vec3& normal, const Vec3& force,
                   double hopeless) const;

  bool may_leave(hand::Finger finger, const Vec3& force) const {
    return is_grip_kept_without(finger, touching_, force);
  }

 private:
  std::vector<hand::Posture> starts(hand::Finger finger) const;

  const hand::Hand* hand_;
  const product::Product* product_;
  const Grasp* grasp_;
  FingertipIk ik_;
  std::vector<TouchingSegment> touching_;
  std::vector<FingertipPoint> pads_;
  std::vector<Vec3> roots_;      ///< product frame
  std::vector<double> lengths_;  ///< mm
};

std::vector<hand::Posture> Reacher::starts(hand::Finger finger) const {
  std::vector<hand::Posture> result = {grasp_->posture};
  // Straight, half and well bent; shares of each joint's range.
  for (const double share : {0.25, 0.5, 0.75}) {
    hand::Posture posture = grasp_->posture;
    for (const hand::Dof d : dofs_of(finger)) {
      const hand::JointDof& dof = hand_->skeleton.dof(d);
      const bool is_sideways = d == abduction_of(finger) && finger != hand::Finger::kThumb;
      posture[d] = dof.lower + (is_sideways ? 0.5 : share) * (dof.upper - dof.lower);
    }
    result.push_back(posture);
  }
  return result;
}

FingerReach Reacher::send(hand::Finger finger, const Vec3& point, const Vec3& normal,
                          const Vec3& force, double hopeless) const {
  const std::size_t f = index_of(finger);
  FingerReach best;
  best.finger = finger;
  best.posture = grasp_->posture;
  best.is_grip_kept = is_grip_kept_without(finger, touching_, force);
  best.miss = (point - roots_[f]).norm() - lengths_[f];
  best.tightest = dofs_of(finger).front();
  if (best.miss > hopeless) return best;
  best.miss = std::numeric_limits<double>::infinity();
  FingertipProblem problem;
  problem.product = product_->distance.get();
  problem.product_from_hand = grasp_->product_from_hand;
  problem.is_hand_free = false;
  problem.is_finger_free.fill(false);
  problem.is_finger_free[f] = true;
  FingertipGoal goal;
  goal.fingertip = pads_[f];
  goal.point = point;
  goal.normal = normal;
  problem.goals = {goal};
  for (const hand::Posture& start : starts(finger)) {
    problem.start = start;
    // Near where the joints are halfway; the finger is no longer part of the grip.
    problem.natural = start;
    const FingertipSolution solution = ik_.solve(problem);
    FingerReach one = best;
    one.miss = solution.miss[0];
    one.tilt = solution.tilt[0];
    one.posture = solution.posture;
    one.margin = std::numeric_limits<double>::infinity();
    for (const hand::Dof d : dofs_of(finger)) {
      const hand::JointDof& dof = hand_->skeleton.dof(d);
      const double q = solution.posture[d];
      const double margin = std::max(0.0, std::min(q - dof.lower, dof.upper - q));
      if (margin >= one.margin) continue;
      one.margin = margin;
      one.tightest = d;
    }
    one.is_blocked = solution.clash > kMostClash;
    one.is_reached = one.miss <= kPlaceReached && one.tilt <= kMostTilt && !one.is_blocked;
    const double bend = finger == hand::Finger::kThumb
                            ? 0.0
                            : std::abs(solution.posture[flexion_of(finger, 2)] -
                                       2.0 / 3.0 * solution.posture[flexion_of(finger, 1)]);
    one.is_awkward = one.margin < kAwkwardMargin || one.tilt > kAwkwardTilt || bend > kAwkwardBend;
    const bool is_better = one.is_reached != best.is_reached                     ? one.is_reached
                           : one.is_reached && one.is_awkward != best.is_awkward ? !one.is_awkward
                           : one.is_reached ? one.margin > best.margin + 1e-6
                                            : one.miss < best.miss - 1e-6;
    if (is_better) best = one;
  }
  return best;
}

bool is_preferred(const FingerReach& a, const FingerReach& b) {
  if (a.is_awkward != b.is_awkward) return !a.is_awkward;
  return a.margin > b.margin;
}

std::string message_of(const ButtonReach& reach) {
  if (reach.best) {
    const FingerReach& best = reach.fingers[index_of(*reach.best)];
    return fmt::format("the {} reaches it{}, {:.0f} degrees from the end of its {}",
                       finger_words(*reach.best), best.is_awkward ? " awkwardly" : "",
                       best.margin / geometry::kDegree, std::string(name_of(best.tightest)));
  }
  const auto loses = std::find_if(reach.fingers.begin(), reach.fingers.end(),
                                  [](const FingerReach& one) { return one.is_reached; });
  if (loses != reach.fingers.end()) {
    return fmt::format("only the {} reaches it, and the rest of the hand doesn't hold the product",
                       finger_words(loses->finger));
  }
  const auto nearest =
      std::min_element(reach.fingers.begin(), reach.fingers.end(),
                       [](const FingerReach& a, const FingerReach& b) { return a.miss < b.miss; });
  if (nearest->miss <= kPlaceReached) {
    return nearest->is_blocked
               ? fmt::format("the {} gets there, but the product or another finger is in its way",
                             finger_words(nearest->finger))
               : fmt::format(
                     "the {} gets there, but not with its pad, which is tilted by {:.0f} degrees",
                     finger_words(nearest->finger), nearest->tilt / geometry::kDegree);
  }
  return fmt::format("no finger reaches it; the {} comes nearest and misses it by {:.1f} mm",
                     finger_words(nearest->finger), nearest->miss);
}

}  // namespace

std::vector<TouchingSegment> touching_segments(const hand::Hand& hand,
                                               const product::Product& product,
                                               const Grasp& grasp) {
  std::vector<int> vertices(hand.skin.vertices.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  std::vector<Vec3> skin;
  PosableSkin(hand, std::move(vertices)).pose(grasp.posture, skin);
  for (Vec3& p : skin) p = grasp.product_from_hand * p;
  std::vector<geometry::DistanceSample> samples(skin.size());
  product.distance->sample(skin, kTouchRange, samples);
  std::array<TouchingSegment, hand::kSegmentCount> all;
  std::array<double, hand::kSegmentCount> weight{};
  std::array<Vec3, hand::kSegmentCount> normal;
  normal.fill(Vec3::Zero());
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const double depth = -samples[v].distance;
    // Deeper than the range nothing is known of the surface.
    if (depth <= 0.0 || depth >= kTouchRange) continue;
    const std::size_t s = index_of(hand.segment[v]);
    weight[s] += depth;
    all[s].point += depth * skin[v];
    normal[s] += depth * samples[v].normal;
    all[s].depth = std::max(all[s].depth, depth);
  }
  std::vector<TouchingSegment> touching;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (!(weight[s] > 0.0) || normal[s].norm() < 1e-9) continue;
    all[s].segment = static_cast<hand::Segment>(s);
    all[s].point /= weight[s];
    all[s].normal = normal[s].normalized();
    touching.push_back(all[s]);
  }
  return touching;
}

bool is_grip_kept_without(hand::Finger finger, const std::vector<TouchingSegment>& touching,
                          const Vec3& force) {
  std::array<bool, hand::kFingerCount + 1> part{};  // the last is the palm
  bool is_opposed = false, is_backed = false;
  for (const TouchingSegment& one : touching) {
    const std::optional<hand::Finger> owner = hand::finger_of(one.segment);
    if (owner == finger) continue;
    part[owner ? static_cast<std::size_t>(*owner) : hand::kFingerCount] = true;
    is_backed = is_backed || one.normal.dot(force) >= 0.0;
    for (const TouchingSegment& other : touching) {
      if (hand::finger_of(other.segment) == finger) continue;
      is_opposed = is_opposed || one.normal.dot(other.normal) <= std::cos(kOpposed);
    }
  }
  return std::count(part.begin(), part.end(), true) >= 2 && is_opposed && is_backed;
}

std::vector<ButtonReach> reach_buttons(const hand::Hand& hand, const product::Product& product,
                                       const Grasp& grasp, const std::vector<Button>& buttons,
                                       const Progress& progress) {
  struct Place {
    Vec3 point, normal, force;
  };
  std::vector<Place> places;
  for (const Button& button : buttons) {
    if (!button.point.allFinite() || !button.force.allFinite()) {
      throw UsageError(
          fmt::format("button \"{}\": point and force must be finite numbers", button.name));
    }
    const geometry::DistanceSample sample = product.distance->at(button.point);
    if (std::abs(sample.distance) > kButtonOffSurface) {
      throw UsageError(fmt::format(
          "button \"{}\" ({:g}, {:g}, {:g} mm) is {:.1f} mm {} the surface of {}; at most {:g} mm "
          "is allowed",
          button.name, button.point.x(), button.point.y(), button.point.z(),
          std::abs(sample.distance), sample.distance > 0.0 ? "off" : "below", product.name,
          kButtonOffSurface));
    }
    const Vec3 normal =
        product.distance->at(sample.closest + kButtonPadOffset * sample.normal).normal;
    const Vec3 force = button.force.norm() > 0.0 ? button.force : Vec3(-normal);
    places.push_back({sample.closest, -force.normalized(), force});
  }
  const Reacher reacher(hand, product, grasp);
  std::vector<ButtonReach> result;
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    progress.throw_if_cancelled();
    ButtonReach reach;
    reach.button = buttons[i];
    for (int f = 0; f < hand::kFingerCount; ++f) {
      reach.fingers.push_back(reacher.send(static_cast<hand::Finger>(f), places[i].point,
                                           places[i].normal, places[i].force, kReachFar));
    }
    for (const FingerReach& one : reach.fingers) {
      if (!one.is_reached || !one.is_grip_kept) continue;
      if (reach.best && !is_preferred(one, reach.fingers[index_of(*reach.best)])) {
        continue;
      }
      reach.best = one.finger;
    }
    reach.message = message_of(reach);
    result.push_back(std::move(reach));
  }
  return result;
}

ReachMap map_reach(const hand::Hand& hand, const product::Product& product, const Grasp& grasp,
                   int points, const Progress& progress) {
  if (points < 1 || points > 100'000) {
    throw UsageError(fmt::format("reach map: {} points; 1 to 100000 is allowed", points));
  }
  const std::vector<SurfacePoint> places = spread_points(product.mesh, points);
  const Reacher reacher(hand, product, grasp);
  struct Value {
    int finger = -1;
    double margin = 0.0, miss = kReachFar;
  };
  std::vector<Value> values(places.size());
  progress.update(0.0, "sending fingers over the surface");
  parallel_for(static_cast<int>(places.size()), [&](int place) {
    if (progress.is_cancelled()) return;
    Value& value = values[place];
    std::optional<FingerReach> best;
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      if (!reacher.may_leave(finger, -places[place].normal)) continue;
      const FingerReach one = reacher.send(finger, places[place].point, places[place].normal,
                                           -places[place].normal, kPlaceReached);
      value.miss = std::min(value.miss, std::max(0.0, one.miss));
      if (one.is_reached && (!best || is_preferred(one, *best))) best = one;
    }
    if (!best) return;
    value = {static_cast<int>(best->finger), best->margin, 0.0};
  });
  progress.throw_if_cancelled();
  ReachMap map;
  map.points = static_cast<int>(places.size());
  const std::vector<Vec3> normals = geometry::vertex_normals(product.mesh);
  const std::vector<double> areas = geometry::vertex_areas(product.mesh);
  for (std::size_t v = 0; v < product.mesh.vertices.size(); ++v) {
    double nearest = std::numeric_limits<double>::infinity();
    Value value;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double away = (places[i].point - product.mesh.vertices[v]).squaredNorm() *
                          (places[i].normal.dot(normals[v]) > 0.3 ? 1.0 : 25.0);
      if (away >= nearest) continue;
      nearest = away;
      value = values[i];
    }
    map.finger.push_back(value.finger);
    map.margin.push_back(value.margin);
    map.miss.push_back(value.miss);
    if (value.finger >= 0) map.reached_area += areas[v];
  }
  return map;
}

}  // namespace palmar::grasp
