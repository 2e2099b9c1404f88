// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/precision_grip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/grasp/precision/cost_order.h"
#include "palmar/grasp/precision/fingertip_press.h"
#include "palmar/grasp/precision/opposing_points.h"
#include "palmar/grasp/precision/precision_search.h"
#include "palmar/grasp/precision/precision_shape.h"
#include "palmar/grasp/precision/ring_targets.h"

namespace palmar::grasp {
namespace {

constexpr double kReached = 1.0;         // mm; what counts as reached
constexpr double kOffSurface = 2.0;      // mm; targets may be that far from the surface
constexpr double kLeans = 3.0;           // mm; a pen nearer than that leans on the web
constexpr std::size_t kPressed = 5;      // holds that are pressed and looked at by all their skin
constexpr double kSkinUnit = 2.0;        // mm; cost of skin deeper than the fingertips
constexpr double kAtLimit = 0.15;        // mm; that near to the depth counts as there
constexpr double kDeepSkin = 4.0;        // mm; skin that much deeper than the fingertips can't be
constexpr double kCrossingInRing = 2.5;  // a ring squeezes the finger all round; choice
constexpr double kCrossing = 1.0;        // mm; fingers that much in each other can't be
constexpr double kSmallWidth = 20.0;     // mm; then it is for want of room
constexpr double kFar = 1e-9;

std::string words_of(hand::Finger finger) {
  return finger == hand::Finger::kThumb ? "thumb" : std::string(name_of(finger)) + " finger";
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

std::string list_of(const std::vector<FingertipPoint>& tips) {
  std::vector<std::string> words;
  for (const FingertipPoint& tip : tips) words.push_back(words_of(tip.finger));
  return list_of(words);
}

/// Of the ring grip: fingers that a small pair of scissors has no room for.
bool is_optional(Grip grip, hand::Finger finger) {
  return grip == Grip::kDistalType &&
         (finger == hand::Finger::kIndex || finger == hand::Finger::kRing);
}

/// Goals of the asked points, in the order of the grip's fingers.
std::vector<FingertipGoal> goals_for(const std::vector<FingertipPoint>& tips,
                                     const product::Product& product,
                                     const PrecisionGripOptions& options) {
  const std::string grip(name_of(options.grip));
  for (const FingertipTarget& target : options.targets) {
    const bool is_known = std::any_of(tips.begin(), tips.end(), [&](const FingertipPoint& tip) {
      return tip.finger == target.finger;
    });
    if (is_known) continue;
    throw UsageError(fmt::format("fingertip points: the {} takes no part in grip {}; {} do",
                                 words_of(target.finger), grip, list_of(tips)));
  }
  std::vector<FingertipGoal> goals;
  for (const FingertipPoint& tip : tips) {
    const auto target =
        std::find_if(options.targets.begin(), options.targets.end(),
                     [&](const FingertipTarget& one) { return one.finger == tip.finger; });
    if (target == options.targets.end() && is_optional(options.grip, tip.finger)) continue;
    if (target == options.targets.end()) {
      throw UsageError(fmt::format("fingertip points: there is none for the {}; grip {} needs {}",
                                   words_of(tip.finger), grip, list_of(tips)));
    }
    const geometry::DistanceSample sample = product.distance->at(target->point);
    if (std::abs(sample.distance) > kOffSurface) {
      throw UsageError(fmt::format(
          "fingertip points: that of the {} ({:g}, {:g}, {:g} mm) is {:.1f} mm {} the surface of "
          "{}; at most {:g} mm is allowed",
          words_of(tip.finger), target->point.x(), target->point.y(), target->point.z(),
          std::abs(sample.distance), sample.distance > 0.0 ? "off" : "below", product.name,
          kOffSurface));
    }
    FingertipGoal goal;
    goal.fingertip = tip;
    goal.point = sample.closest;
    const Vec3 outside = sample.closest + kPadOffset * sample.normal;
    goal.normal = product.distance->at(outside).normal;
    goals.push_back(goal);
  }
  return goals;
}

/// A hold whose fingertips are pressed in.
struct PressedHold {
  FingertipSolution solution;
  std::vector<FingertipGoal> goals;
  SkinDepth skin;
  std::vector<double> reached;  ///< depth of every pulp, mm, per goal
  double depth = 0.0;           ///< asked, mm
  double cost = 0.0;
};

PressedHold pressed(const FingertipPress& press, const PrecisionHold& hold,
                    double fingertip_depth) {
  PressedHold result;
  FingertipProblem problem = hold.problem;
  problem.start = hold.solution.posture;
  problem.product_from_hand = hold.solution.product_from_hand;
  // What slid comes to rest where it is, so that deeper goals don't make it wander.
  for (std::size_t k = 0; k < problem.goals.size(); ++k) {
    if (problem.goals[k].is_sliding) problem.goals[k].point = hold.solution.reached[k];
  }
  result.depth = fingertip_depth;
  result.solution = press.press(problem, result.depth);
  result.goals = problem.goals;
  result.skin =
      press.look(*problem.product, result.solution.posture, result.solution.product_from_hand);
  result.reached = press.depth_at(*problem.product, result.solution, result.goals);
  double excess = 0.0;
  for (const double depth : result.skin.any) {
    excess = std::max(excess, depth - result.depth - 2.0 * kAtLimit);
  }
  result.cost = hold.cost + std::pow(std::max(0.0, excess) / kSkinUnit, 2);
  return result;
}

void finish_stops(const PressedHold& hold, Grasp& grasp) {
  for (std::size_t s = 0; s < grasp.stops.size(); ++s) {
    SegmentStop& stop = grasp.stops[s];
    stop.segment = static_cast<hand::Segment>(s);
    stop.penetration = hold.skin.palmar[s];
    stop.reason = stop.penetration > 0.0 ? StopReason::kDistalStop : StopReason::kNotReached;
    for (std::size_t k = 0; k < hold.goals.size(); ++k) {
      const FingertipGoal& goal = hold.goals[k];
      if (goal.is_rest || static_cast<std::size_t>(goal.fingertip.segment) != s) continue;
      // The side of a finger counts as a pad where the grip uses it.
      stop.penetration = std::max({stop.penetration, hold.skin.any[s], hold.reached[k]});
      stop.reason = stop.penetration > hold.depth - kAtLimit ? StopReason::kLimitDepth
                    : stop.penetration > 0.0                 ? StopReason::kRangeOfMotion
                                                             : StopReason::kNotReached;
    }
  }
}

void judge(const PressedHold& hold, double widest_span, double width, Grasp& grasp) {
  std::vector<std::string> held, missing;
  double worst = 0.0;
  for (const FingertipContact& contact : grasp.fingertips) {
    if (contact.miss <= kReached) {
      held.push_back(words_of(contact.finger));
    } else {
      missing.push_back(fmt::format("the {} misses its point by {:.1f} mm",
                                    words_of(contact.finger), contact.miss));
      worst = std::max(worst, contact.miss);
    }
  }
  const bool is_too_wide = width > widest_span + 4.0;
  if (missing.empty()) {
    grasp.status = GraspStatus::kHeld;
    grasp.message = fmt::format("held between {}, {:.0f} mm apart", list_of(held), width);
    for (std::size_t k = 0; k < hold.goals.size(); ++k) {
      if (!hold.goals[k].is_rest) continue;
      const double miss = hold.solution.miss[k];
      grasp.message +=
          miss < kLeans ? "; its long end leans over the web of the thumb"
                        : fmt::format("; its long end is {:.0f} mm off the web of the thumb", miss);
    }
  } else {
    grasp.status = is_too_wide ? GraspStatus::kTooLarge : GraspStatus::kPartlyHeld;
    grasp.message = list_of(missing);
    if (is_too_wide) {
      grasp.message += fmt::format("; the points are {:.0f} mm apart, the hand spans {:.0f} mm",
                                   width, widest_span);
    }
  }
  double deepest = 0.0;
  std::size_t where = 0;
  for (std::size_t s = 0; s < hold.skin.any.size(); ++s) {
    if (hold.skin.any[s] > deepest) {
      deepest = hold.skin.any[s];
      where = s;
    }
  }
  const double crossing = grasp.grip == Grip::kDistalType ? kCrossingInRing : kCrossing;
  if (hold.solution.clash > crossing) {
    if (grasp.status == GraspStatus::kHeld) {
      grasp.status = width < kSmallWidth ? GraspStatus::kTooSmall : GraspStatus::kPartlyHeld;
    }
    grasp.message += fmt::format("; fingers would be {:.1f} mm in each other or the product",
                                 hold.solution.clash);
  }
  if (deepest > hold.depth + kDeepSkin && grasp.status == GraspStatus::kHeld) {
    grasp.status = GraspStatus::kPartlyHeld;  // no hand can be there
  }
  if (deepest > hold.depth + 1.0) {
    std::string name(name_of(static_cast<hand::Segment>(where)));
    std::replace(name.begin(), name.end(), '_', ' ');
    grasp.message += fmt::format("; skin of {} is {:.1f} mm in the product", name, deepest);
  }
}

/// What a grasp says about the hold it is.
void describe(const hand::Hand& hand, const product::Product& product, const PressedHold& hold,
              double widest, Grasp& grasp) {
  grasp.posture = hold.solution.posture;
  grasp.product_from_hand = hold.solution.product_from_hand;
  grasp.fingertips.clear();
  const auto count = static_cast<std::size_t>(
      std::count_if(hold.goals.begin(), hold.goals.end(),
                    [](const FingertipGoal& goal) { return !goal.is_rest; }));
  Vec3 others = Vec3::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    FingertipContact contact;
    contact.finger = hold.goals[k].fingertip.finger;
    contact.target = hold.goals[k].point;
    contact.reached = hold.solution.reached[k];
    contact.normal = hold.solution.normal[k];
    if (hold.goals[k].is_sliding) {
      contact.target = contact.reached;
      contact.miss = hold.solution.miss[k];
    } else {
      contact.miss = (contact.reached - contact.target).norm();
    }
    grasp.fingertips.push_back(contact);
    if (k > 0) others += contact.reached / static_cast<double>(count - 1);
  }
  const Vec3 thumb = grasp.fingertips[0].reached;
  const double width = (others - thumb).norm();
  const Vec3 line = width > 0.0 ? Vec3((others - thumb) / width) : Vec3(Vec3::UnitZ());
  const Vec3 radial =
      grasp.product_from_hand.rotation * (hand.skeleton.joint(hand::JointId::kIndexMcp).centre -
                                          hand.skeleton.joint(hand::JointId::kLittleMcp).centre);
  grasp.grip_point = 0.5 * (thumb + others);
  grasp.grip_axis = (radial - line * line.dot(radial)).normalized();
  std::vector<Vec3> section;
  for (const geometry::SectionCurve& curve :
       geometry::plane_section(product.mesh, grasp.grip_point, grasp.grip_axis)) {
    section.insert(section.end(), curve.point.begin(), curve.point.end());
  }
  grasp.grip_girth = geometry::girth(section, grasp.grip_axis);
  finish_stops(hold, grasp);
  judge(hold, widest, width, grasp);
}

/// Nobody holds it: the hand is shown beside the product, touching nothing.
void put_beside(const hand::Hand& hand, const product::Product& product, Grasp& grasp) {
  const Box3 box = product.distance->bounding_box();
  const double beside = 0.5 * box.diagonal().norm() + 1.5 * hand.dimensions.hand_length;
  grasp.product_from_hand.translation = box.center() + Vec3(0.0, 0.0, -beside);
}

}  // namespace

void PrecisionGripOptions::check() const {
  if (is_power(grip)) {
    throw UsageError(fmt::format(
        "grip {} is no precision grip; tip_pinch, palmar_pinch, tripod, "
        "writing_tripod, lateral, precision_sphere, precision_disk, prismatic or distal_type is "
        "allowed",
        name_of(grip)));
  }
  if (!(fingertip_depth > 0.0) || fingertip_depth > 6.0) {
    throw UsageError(fmt::format("fingertip depth is {:g} mm; above 0 and at most 6 mm is allowed",
                                 fingertip_depth));
  }
  if (candidates < 1 || candidates > 5000) {
    throw UsageError(fmt::format("candidates is {}; 1 to 5000 is allowed", candidates));
  }
  if (placement.at && !placement.at->allFinite()) {
    throw UsageError("placement: at is not a finite point; three lengths in mm are required");
  }
  if (placement.axis && !(placement.axis->allFinite() && placement.axis->norm() > kFar)) {
    throw UsageError("placement: axis has no direction; three numbers, not all 0, are required");
  }
  if (placement.turn) {
    throw UsageError(
        fmt::format("placement: turn is given; grip {} is not turned about an axis, "
                    "at and axis are allowed",
                    name_of(grip)));
  }
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (!targets[i].point.allFinite()) {
      throw UsageError(
          fmt::format("fingertip points: that of the {} is not finite; three lengths "
                      "in mm are required",
                      words_of(targets[i].finger)));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (targets[j].finger != targets[i].finger) continue;
      throw UsageError(fmt::format("fingertip points: the {} has two; one is allowed",
                                   words_of(targets[i].finger)));
    }
  }
}

Grasp close_precision_grip(const hand::Hand& hand, const product::Product& product,
                           const PrecisionGripOptions& options, const Progress& progress) {
  OpenedHand opened(hand);
  return close_precision_grip(opened, product, options, progress);
}

Grasp close_precision_grip(OpenedHand& opened, const product::Product& product,
                           const PrecisionGripOptions& options, const Progress& progress) {
  options.check();
  const hand::Hand& hand = opened.hand();
  const FingertipIk& ik = opened.ik();
  Grasp grasp;
  grasp.grip = options.grip;
  for (std::size_t s = 0; s < grasp.stops.size(); ++s) {
    grasp.stops[s].segment = static_cast<hand::Segment>(s);
  }
  const std::vector<FingertipPoint> tips = fingertips_of(hand, options.grip);
  std::vector<FingertipGoal> goals =
      options.targets.empty() ? std::vector<FingertipGoal>{} : goals_for(tips, product, options);
  const GripOpenings& openings = opened.openings(options.grip);
  grasp.posture = natural_posture(hand.skeleton, options.grip);
  if (openings.all().empty()) {
    grasp.message = fmt::format("this hand's fingers can't meet in grip {}", name_of(options.grip));
    put_beside(hand, product, grasp);
    return grasp;
  }
  progress.update(0.1, "finding where fingertips hold " + product.name);
  if (options.grip == Grip::kDistalType && goals.empty()) {
    const std::optional<ScissorRings> rings = scissor_rings(product::find_parts(product), product);
    PrecisionGripOptions at_rings = options;
    if (rings) at_rings.targets = ring_targets(hand, product, *rings);
    if (!at_rings.targets.empty()) goals = goals_for(tips, product, at_rings);
  }
  if (options.grip == Grip::kDistalType && goals.empty()) {
    grasp.message = "it has no two rings side by side that thumb and fingers go through";
    put_beside(hand, product, grasp);
    return grasp;
  }
  PrecisionSearch search;
  if (!goals.empty()) {
    search = solve_precision_targets(ik, openings, product, goals, options.wrist, progress);
  } else if (options.from) {
    search.candidates = search.pairs = 1;
    search.widest = openings.widest();
    search.holds = {set_down(ik, openings, product, *options.from)};
  } else {
    search = search_precision_grip(ik, openings, product, options, progress);
  }
  grasp.candidates = search.candidates;
  if (search.holds.empty()) {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message =
        options.grip == Grip::kWritingTripod
            ? fmt::format(
                  "it is no pen for grip {}: longer than 80 mm, 4.5 times as long as "
                  "broad, at most {:.0f} mm thick behind its tip",
                  name_of(options.grip), search.widest)
            : fmt::format(
                  "no two opposite places of it within the hand's span of {:.0f} mm for "
                  "grip {}{}",
                  search.widest, name_of(options.grip),
                  options.placement.at ? " near the given point" : "");
    put_beside(hand, product, grasp);
    return grasp;
  }

  progress.update(0.5, "pressing fingertips to " + product.name);
  const FingertipPress press(ik);
  std::vector<PressedHold> holds;
  for (const PrecisionHold& hold : search.holds) {
    if (holds.size() == kPressed) break;
    progress.throw_if_cancelled();
    holds.push_back(pressed(press, hold, options.fingertip_depth));
  }
  sort_by_cost(holds, kIteratedTie, [](const PressedHold& hold) { return hold.cost; });
  const PressedHold& best = holds.front();
  const auto score_of = [](double cost) { return 1.0 / (1.0 + std::max(0.0, cost)); };
  grasp.score = score_of(best.cost);
  for (std::size_t i = 1; i < holds.size(); ++i) {
    const PressedHold& other = holds[i];
    grasp.runners_up.push_back({options.grip, other.solution.posture,
                                other.solution.product_from_hand, score_of(other.cost)});
  }
  describe(hand, product, best, openings.widest(), grasp);
  return grasp;
}

void take_runner_up(const hand::Hand& hand, const product::Product& product, std::size_t index,
                    Grasp& grasp) {
  const GraspRunnerUp chosen = grasp.runners_up.at(index);
  grasp.runners_up[index] = {grasp.grip, grasp.posture, grasp.product_from_hand, grasp.score};
  grasp.grip = chosen.grip;
  grasp.score = chosen.score;
  const FingertipIk ik(hand);
  PressedHold hold;
  FingertipProblem problem;
  problem.product = product.distance.get();
  problem.natural = problem.start = chosen.posture;
  problem.product_from_hand = chosen.product_from_hand;
  problem.is_refining = true;
  problem.max_iterations = 0;  // as it is
  for (const FingertipPoint& tip : fingertips_of(hand, grasp.grip)) {
    FingertipGoal& goal = problem.goals.emplace_back();
    goal.fingertip = tip;
    goal.is_sliding = true;
  }
  hold.solution = ik.solve(problem);
  const FingertipPress press(ik);
  hold.reached = press.depth_at(*product.distance, hold.solution, problem.goals);
  for (std::size_t k = 0; k < problem.goals.size(); ++k) {
    problem.goals[k].point = hold.solution.reached[k];
    hold.solution.miss[k] = std::max(0.0, -hold.reached[k]);
  }
  hold.depth = *std::max_element(hold.reached.begin(), hold.reached.end());
  hold.goals = std::move(problem.goals);
  hold.skin = press.look(*product.distance, hold.solution.posture, hold.solution.product_from_hand);
  describe(hand, product, hold, std::numeric_limits<double>::infinity(), grasp);
}

}  // namespace palmar::grasp
