// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/grasp_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

// 30 degrees of friction angle is a coefficient of 0.58, ordinary for dry skin.
constexpr double kHalfRound = 1.0 / 3.0;  // of a turn
constexpr double kLargeGirth = 1.0;       // hand lengths; what a hand spans from thumb to fingertip
constexpr double kSheetWidth = 5.0;       // finger limit depths; wider is a sheet, not a wire
constexpr double kAtLimitDepth = 0.1;     // mm; that near to the limit depth counts as there

std::string words_of(hand::Segment segment) {
  static constexpr std::array<const char*, 3> kPart = {"base", "middle part", "tip"};
  const hand::Finger finger = *hand::finger_of(segment);
  const auto segments = hand::segments_of(finger);
  std::size_t level = 0;
  while (segments[level] != segment) ++level;
  if (finger == hand::Finger::kThumb) return std::string("the thumb's ") + kPart[2 * level];
  return std::string("the ") + kPart[level] + " of the " + std::string(name_of(finger)) + " finger";
}

// A clause about the phalanges without contact; empty if all touch.
std::string open_segments(const Touching& touches, Grip grip) {
  std::vector<std::string> list;
  for (std::size_t s = 1; s < touches.size(); ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    const bool is_thumb = hand::finger_of(segment) == hand::Finger::kThumb;
    if (is_thumb && grip == Grip::kFixedHook) continue;  // takes no part
    if (!touches[s]) list.push_back(words_of(segment));
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
  return std::string(kNumber[fingers]) + (fingers == 1 ? " finger" : " fingers");
}

}  // namespace

std::string held_words(const Touching& touches, Grip grip) {
  std::array<bool, hand::kFingerCount> holds{};
  for (std::size_t s = 1; s < touches.size(); ++s) {
    if (touches[s]) holds[index_of(*hand::finger_of(static_cast<hand::Segment>(s)))] = true;
  }
  return "held by " + count_words(static_cast<int>(std::count(holds.begin(), holds.end(), true))) +
         open_segments(touches, grip);
}

void finish_stops(const HoldMeasure& measure, const DepthLimits& limits, Grasp& grasp) {
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    SegmentStop& stop = grasp.stops[s];
    stop.segment = segment;
    stop.penetration = measure.penetration[s];
    const double limit = segment == hand::Segment::kPalm ? limits.palm : limits.finger;
    if (segment == hand::Segment::kPalm) {
      stop.reason = stop.penetration > limit - kAtLimitDepth ? StopReason::kLimitDepth
                    : stop.penetration > 0.0                 ? StopReason::kDistalStop
                                                             : StopReason::kNotReached;
      continue;
    }
    if (stop.penetration > limit - kAtLimitDepth) {
      stop.reason = StopReason::kLimitDepth;
    } else if (stop.reason == StopReason::kRangeOfMotion && stop.penetration <= 0.0) {
      stop.reason = StopReason::kNotReached;
    } else if (stop.reason == StopReason::kLimitDepth) {
      // Its own skin stopped it on the way, then the rest of the finger moved on.
      stop.reason = StopReason::kProximalStop;
    }
  }
}

void judge_hold(const hand::Hand& hand, const HoldMeasure& measure, const GripSite& site,
                Grasp& grasp) {
  Touching touches{};
  for (std::size_t s = 0; s < touches.size(); ++s) {
    touches[index_of(grasp.stops[s].segment)] = grasp.stops[s].penetration > 0.0;
  }
  const std::string open = open_segments(touches, grasp.grip);
  const std::string girth = fmt::format("its girth at the grip is {:.0f} mm", site.girth);
  if (measure.wrap < kHalfRound && site.girth > kLargeGirth * hand.dimensions.hand_length) {
    grasp.status = GraspStatus::kTooLarge;
    grasp.message =
        girth + fmt::format("; the hand reaches {:.0f} degrees round it", 360.0 * measure.wrap) +
        fmt::format(", {:.0f} degrees are needed to hold it", 360.0 * kHalfRound);
  } else if (measure.fingers >= 3 && measure.wrap >= kHalfRound) {
    grasp.status = GraspStatus::kHeld;
    grasp.message = "held by " + count_words(measure.fingers) + open;
  } else if (measure.fingers > 0) {
    grasp.status = GraspStatus::kPartlyHeld;
    grasp.message = "touched by " + count_words(measure.fingers) +
                    fmt::format(", which reach {:.0f} degrees round it", 360.0 * measure.wrap) +
                    open;
  } else if (site.girth < kLargeGirth * hand.dimensions.hand_length) {
    grasp.status = GraspStatus::kTooSmall;
    grasp.message = girth + "; the fingers close without meeting it";
  } else {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message = girth + "; no finger reaches it";
  }
}

bool is_out_of_reach(const GripSite& site, const PowerGraspOptions& options, Grasp& grasp) {
  if (site.thickness >= options.finger_limit_depth) return false;
  const std::string thin = fmt::format("it is {:.1f} mm thick at the best place", site.thickness) +
                           fmt::format(" and {:.1f} mm wide", site.width);
  const std::string give = fmt::format("thinner than the {:.1f} mm that the skin of a finger gives",
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

}  // namespace palmar::grasp
