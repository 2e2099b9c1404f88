// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grasp.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/grasp/closing.h"
#include "palmar/grasp/grip_axis.h"
#include "palmar/grasp/placement.h"
#include "palmar/grasp/site_distance.h"

namespace palmar {
namespace {

constexpr double kCoarse = 5.0;  // mm between the skin points that the search looks at
constexpr double kRival = 0.85;  // share of the best site's score from which one is tried too
// Contacts hold from opposite sides if no gap between them exceeds half a turn by more than two
// friction angles; 30 degrees is a coefficient of 0.58, ordinary for dry skin.
constexpr double kHalfRound = 1.0 / 3.0;  // of a turn
constexpr int kSettleRounds = 6;          // product and fingers give way to each other in turn
constexpr double kLargeGirth = 1.0;       // hand lengths; what a hand spans from thumb to fingertip
constexpr double kSheetWidth = 5.0;       // finger limit depths; wider is a sheet, not a wire
constexpr double kShownDepth = 0.05;      // mm into the palm of what is only laid on it
constexpr int kTrimRounds = 8;
constexpr double kTrimTolerance = 0.02;  // mm
constexpr double kTrimArm = 18.0;        // mm from a finger joint to the skin it presses
constexpr double kTouched = 0.5;  // mm; farther skin can't touch by the exact distance either
constexpr double kAtLimit = 0.1;  // mm; that near to the limit depth counts as there

std::string format(const char* text, double value) {
  std::array<char, 160> buffer{};
  std::snprintf(buffer.data(), buffer.size(), text, value);
  return buffer.data();
}

// Turn of `facing` from the site's wide direction, for a turn asked for in the product's own frame.
double lay_turn(const GripSite& site, double asked) {
  // Zero: the coordinate axis that is most square to the grip axis, made square to it.
  int least = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::abs(site.axis[c]) < std::abs(site.axis[least]) - 1e-9) least = c;
  }
  Vec3 zero = Vec3::Unit(least);
  zero = (zero - site.axis * site.axis.dot(zero)).normalized();
  const Vec3 facing = Eigen::AngleAxisd(asked, site.axis) * zero;
  const Vec3 wide = (site.wide - site.axis * site.axis.dot(site.wide)).normalized();
  return std::atan2(site.axis.dot(wide.cross(facing)), wide.dot(facing));
}

// The quick distance is right to a few hundredths of a millimetre: what went too deep by the exact
// one is opened again at its own joint.
HoldMeasure trimmed(const HandCloser& closer, const HeldProduct& product, const DepthLimits& limits,
                    const Vec3& axis_in_hand, Posture& posture) {
  HoldMeasure measure = closer.measure(product, posture, axis_in_hand);
  for (int round = 0; round < kTrimRounds; ++round) {
    bool is_changed = false;
    for (int s = 1; s < kSegmentCount; ++s) {
      const auto segment = static_cast<Segment>(s);
      const double excess = measure.penetration[static_cast<std::size_t>(s)] - limits.finger;
      if (excess <= kTrimTolerance) continue;
      const Joint& joint = closer.hand().skeleton.joint(joint_of(segment));
      for (const JointDof& dof : joint.dofs) {
        if (dof.dof == abduction_of(*finger_of(segment))) continue;
        posture[dof.dof] = std::max(dof.lower, posture[dof.dof] - (excess + 0.01) / kTrimArm);
        is_changed = true;
      }
    }
    if (!is_changed) break;
    measure = closer.measure(product, posture, axis_in_hand);
  }
  return measure;
}

void finish_stops(const Hand& hand, const HoldMeasure& measure, const DepthLimits& limits,
                  Grasp& grasp) {
  for (int s = 0; s < kSegmentCount; ++s) {
    const auto segment = static_cast<Segment>(s);
    SegmentStop& stop = grasp.stops[static_cast<std::size_t>(s)];
    stop.segment = segment;
    stop.penetration = measure.penetration[static_cast<std::size_t>(s)];
    const double limit = segment == Segment::kPalm ? limits.palm : limits.finger;
    if (segment == Segment::kPalm) {
      stop.reason = stop.penetration > limit - kAtLimit ? StopReason::kLimitDepth
                    : stop.penetration > 0.0            ? StopReason::kDistalStop
                                                        : StopReason::kNotReached;
      continue;
    }
    if (stop.penetration > limit - kAtLimit) {
      stop.reason = StopReason::kLimitDepth;
    } else if (stop.reason == StopReason::kRangeOfMotion && stop.penetration <= 0.0) {
      stop.reason = StopReason::kNotReached;
    } else if (stop.reason == StopReason::kLimitDepth) {
      // Its own skin stopped it on the way, then the rest of the finger moved on.
      stop.reason = StopReason::kProximalStop;
    }
  }
  (void)hand;
}

std::string words_of(Segment segment) {
  static constexpr std::array<const char*, 3> kPart = {"base", "middle part", "tip"};
  const Finger finger = *finger_of(segment);
  const auto segments = segments_of(finger);
  std::size_t level = 0;
  while (segments[level] != segment) ++level;
  if (finger == Finger::kThumb) return std::string("the thumb's ") + kPart[2 * level];
  return std::string("the ") + kPart[level] + " of the " + std::string(name_of(finger)) + " finger";
}

// A clause about the phalanges without contact; empty if all touch.
std::string open_segments(const Grasp& grasp) {
  std::vector<std::string> list;
  for (std::size_t s = 1; s < grasp.stops.size(); ++s) {
    if (grasp.stops[s].penetration <= 0.0) list.push_back(words_of(grasp.stops[s].segment));
  }
  if (list.empty()) return "";
  std::string clause = "; ";
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool is_last = i + 1 == list.size();
    clause += (i == 0 ? "" : is_last ? " and " : ", ") + list[i];
  }
  return clause + (list.size() == 1 ? " does not touch" : " do not touch");
}

std::string count_words(int fingers) {
  static constexpr std::array<const char*, 6> kNumber = {"no",    "one",  "two",
                                                         "three", "four", "five"};
  return std::string(kNumber[static_cast<std::size_t>(fingers)]) +
         (fingers == 1 ? " finger" : " fingers");
}

void judge(const Hand& hand, const HoldMeasure& measure, const GripSite& site, Grasp& grasp) {
  const std::string open = open_segments(grasp);
  const std::string girth = format("its girth at the grip is %.0f mm", site.girth);
  if (measure.wrap < kHalfRound && site.girth > kLargeGirth * hand.dimensions.hand_length) {
    grasp.status = GraspStatus::kTooLarge;
    grasp.message = girth +
                    format("; the hand reaches %.0f degrees round it", 360.0 * measure.wrap) +
                    format(", %.0f degrees are needed to hold it", 360.0 * kHalfRound);
  } else if (measure.fingers >= 3 && measure.wrap >= kHalfRound) {
    grasp.status = GraspStatus::kHeld;
    grasp.message = "held by " + count_words(measure.fingers) + open;
  } else if (measure.fingers > 0) {
    grasp.status = GraspStatus::kPartlyHeld;
    grasp.message = "touched by " + count_words(measure.fingers) +
                    format(", which reach %.0f degrees round it", 360.0 * measure.wrap) + open;
  } else if (site.girth < kLargeGirth * hand.dimensions.hand_length) {
    grasp.status = GraspStatus::kTooSmall;
    grasp.message = girth + "; the fingers close without meeting it";
  } else {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message = girth + "; no finger reaches it";
  }
}

// Shapes that skin can't be closed on, told before trying.
bool is_out_of_reach(const GripSite& site, const PowerGraspOptions& options, Grasp& grasp) {
  if (site.thickness >= options.finger_limit_depth) return false;
  const std::string thin = format("it is %.1f mm thick at the best place", site.thickness) +
                           format(" and %.1f mm wide", site.width);
  const std::string give = format("thinner than the %.1f mm that the skin of a finger gives",
                                  options.finger_limit_depth);
  if (site.width < kSheetWidth * options.finger_limit_depth) {
    grasp.status = GraspStatus::kTooSmall;
    grasp.message = thin + ", " + give + ": the fist closes on itself";
  } else {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message = thin + ", " + give + ": a sheet has nothing to close a hand round";
  }
  return true;
}

}  // namespace

void PowerGraspOptions::check() const {
  const auto depth = [](const char* name, double value, double most) {
    if (!(value > 0.0) || value > most) {
      throw UsageError(std::string(name) + format(" is %g mm; ", value) +
                       format("above 0 and at most %g mm is allowed", most));
    }
  };
  depth("palm limit depth", palm_limit_depth, 15.0);
  depth("finger limit depth", finger_limit_depth, 10.0);
  if (placement.at && !placement.at->allFinite()) {
    throw UsageError("placement: at is not a finite point; three lengths in mm are required");
  }
  if (placement.axis && !(placement.axis->allFinite() && placement.axis->norm() > 1e-9)) {
    throw UsageError("placement: axis has no direction; three numbers, not all 0, are required");
  }
  if (placement.turn && !std::isfinite(*placement.turn)) {
    throw UsageError("placement: turn is not a number; an angle is required");
  }
}

Grasp close_power_grasp(const Hand& hand, const Product& product, const PowerGraspOptions& options,
                        const Progress& progress) {
  options.check();
  Grasp grasp;
  for (int s = 0; s < kSegmentCount; ++s) {
    grasp.stops[static_cast<std::size_t>(s)].segment = static_cast<Segment>(s);
  }
  grasp.posture = reference_posture(hand.skeleton);
  progress.update(0.0, "finding a place to hold " + product.name);
  GripSearchOptions search;
  search.hand_length = hand.dimensions.hand_length;
  search.palm_breadth = hand.dimensions.hand_width;
  search.at = options.placement.at;
  if (options.placement.axis) search.axis = options.placement.axis->normalized();
  std::vector<GripSite> sites = find_grip_sites(product.mesh, search);
  if (sites.empty()) {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message = options.placement.at
                        ? "nothing near the given point is bar-like enough for a power grip"
                        : "no part of the product is bar-like enough for a power grip";
    // Nobody holds it: the hand is shown beside the product, touching nothing.
    const Box3 box = product.distance->bounding_box();
    const double beside = 0.5 * box.diagonal().norm() + 1.5 * hand.dimensions.hand_length;
    grasp.product_from_hand.translation = box.center() + Vec3(0.0, 0.0, -beside);
    return grasp;
  }

  grasp.grip_point = sites.front().point;
  grasp.grip_axis = sites.front().axis;
  grasp.grip_girth = sites.front().girth;
  if (is_out_of_reach(sites.front(), options, grasp)) {
    // The open hand is shown with the product on the palm.
    const HandCloser hint(hand, kCoarse);
    const GripSite& site = sites.front();
    const DepthLimits least{kShownDepth, kShownDepth};
    const auto quick = distance_near(product.mesh, product.distance, site);
    grasp.posture = hint.open_posture();
    grasp.product_from_hand = place(hint, *quick, least, site, {}).product_from_hand;
    return grasp;
  }

  progress.update(0.2, "trying ways to hold " + product.name);
  const DepthLimits asked{options.palm_limit_depth, options.finger_limit_depth};
  std::optional<double> turn;
  if (options.placement.turn) turn = lay_turn(sites.front(), *options.placement.turn);
  const HandCloser coarse(hand, kCoarse);
  std::vector<std::unique_ptr<DistanceField>> near;
  std::vector<const DistanceField*> distances;
  for (GripSite& candidate : sites) {
    if (near.size() == 2 || candidate.score < kRival * sites.front().score) break;
    candidate.wall =
        wall_at(product.mesh, *product.distance, candidate, hand.dimensions.hand_width);
    near.push_back(distance_near(product.mesh, product.distance, candidate));
    distances.push_back(near.back().get());
  }
  const auto hold =
      find_hold(coarse, distances, sites, asked, turn, options.placement.at.has_value(), progress);
  const GripSite& site = sites[hold->site];
  const DepthLimits limits = limits_for(asked, site);

  progress.update(0.6, "closing the hand round " + product.name);
  const HandCloser fine(hand, 0.0);
  const DistanceField& quick = *distances[hold->site];
  const Placement placement = place(fine, quick, limits, site, hold->placement.lay);
  HeldProduct held{&quick, placement.product_from_hand, site.point, site.axis,
                   site.girth / std::numbers::pi};
  const auto exact = exact_where_touched(quick, *product.distance, kTouched);
  const auto exact_held = [&exact](HeldProduct seen) {
    seen.distance = exact.get();
    return seen;
  };
  ThumbWay way;
  HoldMeasure measure;
  for (int round = 0; round < kSettleRounds; ++round) {
    progress.throw_if_cancelled();
    grasp.posture = fine.close_fingers(held, limits, fine.open_posture(), grasp.stops);
    if (round == 0) {
      way = fine.thumb().best_of(
          coarse.thumb().find_ways(held, limits, grasp.posture, placement.axis_in_hand), held,
          limits, grasp.posture, placement.axis_in_hand);
    }
    grasp.posture = fine.thumb().wrap(held, limits, grasp.posture, way, grasp.stops);
    measure = trimmed(fine, exact_held(held), limits, placement.axis_in_hand, grasp.posture);
    const double excess = measure.penetration[0] - limits.palm;
    if (excess <= kTrimTolerance) break;
    // Closing has folded the palm's skin further in: the product gives way.
    held.product_from_hand.translation +=
        held.product_from_hand.rotation * ((1.2 * excess + 0.02) * placement.push_in_hand);
    if (round + 1 < kSettleRounds) continue;
    measure = trimmed(fine, exact_held(held), limits, placement.axis_in_hand, grasp.posture);
  }
  grasp.product_from_hand = held.product_from_hand;
  grasp.grip_axis = site.axis;
  grasp.grip_point = site.point + hold->placement.lay.along * site.axis;
  grasp.grip_girth = site.girth;
  finish_stops(hand, measure, limits, grasp);

  judge(hand, measure, site, grasp);
  return grasp;
}

std::string name_of(StopReason reason) {
  switch (reason) {
    case StopReason::kLimitDepth:
      return "limit_depth";
    case StopReason::kRangeOfMotion:
      return "range_of_motion";
    case StopReason::kProximalStop:
      return "proximal_stop";
    case StopReason::kDistalStop:
      return "distal_stop";
    case StopReason::kOtherFinger:
      return "other_finger";
    case StopReason::kNotReached:
      return "not_reached";
    case StopReason::kGiven:
      return "given";
  }
  return "unknown";
}

std::string name_of(GraspStatus status) {
  switch (status) {
    case GraspStatus::kHeld:
      return "held";
    case GraspStatus::kPartlyHeld:
      return "partly_held";
    case GraspStatus::kTooLarge:
      return "too_large";
    case GraspStatus::kTooSmall:
      return "too_small";
    case GraspStatus::kNotGraspable:
      return "not_graspable";
  }
  return "unknown";
}

}  // namespace palmar
