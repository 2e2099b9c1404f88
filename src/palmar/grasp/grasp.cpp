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

namespace palmar {
namespace {

constexpr double kCoarse = 5.0;      // mm between the skin points that the search looks at
constexpr double kHalfRound = 0.46;  // of a turn: contacts from opposite sides, less a little
                                     // for friction
constexpr int kSettleRounds = 4;     // product and fingers give way to each other in turn
constexpr double kAtLimit = 0.1;     // mm; that near to the limit depth counts as there

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
  const std::vector<GripSite> sites = find_grip_sites(product.mesh, search);
  if (sites.empty()) {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message = "no part of the product is bar-like enough for a power grip";
    return grasp;
  }

  progress.update(0.2, "trying ways to hold " + product.name);
  const DepthLimits asked{options.palm_limit_depth, options.finger_limit_depth};
  std::optional<double> turn;
  if (options.placement.turn) turn = lay_turn(sites.front(), *options.placement.turn);
  const HandCloser coarse(hand, kCoarse);
  const auto hold = find_hold(coarse, *product.distance, sites, asked, turn, progress);
  const GripSite& site = sites[hold->site];
  const DepthLimits limits = limits_for(asked, site.thickness);

  progress.update(0.6, "closing the hand round " + product.name);
  const HandCloser fine(hand, 0.0);
  Placement placement = place(fine, *product.distance, limits, site, hold->placement.lay);
  HeldProduct held{product.distance.get(), placement.product_from_hand};
  HandCloser::ThumbWay way;
  HoldMeasure measure;
  for (int round = 0; round < kSettleRounds; ++round) {
    progress.throw_if_cancelled();
    grasp.posture = fine.close_fingers(held, limits, fine.open_posture(), grasp.stops);
    if (round == 0) {
      way = coarse.find_thumb_way(held, limits, grasp.posture, placement.axis_in_hand);
    }
    grasp.posture = fine.wrap_thumb(held, limits, grasp.posture, way.cmc_flexion, way.cmc_abduction,
                                    grasp.stops);
    measure = fine.measure(held, grasp.posture, placement.axis_in_hand);
    const double excess = measure.penetration[0] - limits.palm;
    if (excess <= 0.02) break;
    // Closing has folded the palm's skin further in: the product gives way.
    held.product_from_hand.translation +=
        held.product_from_hand.rotation * ((excess + 0.02) * placement.push_in_hand);
  }
  grasp.product_from_hand = held.product_from_hand;
  grasp.grip_axis = site.axis;
  grasp.grip_point = site.point + hold->placement.lay.along * site.axis;
  grasp.grip_girth = site.girth;
  finish_stops(hand, measure, limits, grasp);

  if (measure.fingers >= 3 && measure.wrap >= kHalfRound) {
    grasp.status = GraspStatus::kHeld;
  } else if (measure.wrap < kHalfRound && measure.fingers >= 3) {
    grasp.status = GraspStatus::kTooLarge;
    grasp.message = format("girth %.0f mm: ", site.girth) +
                    format("the hand reaches round %.0f % of it", 100.0 * measure.wrap);
  } else if (measure.fingers > 0) {
    grasp.status = GraspStatus::kPartlyHeld;
  } else {
    grasp.status = GraspStatus::kTooSmall;
  }
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
