// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grip.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

constexpr std::array<GripDescription, kGripCount> kGrips = {{
    {Grip::kMediumWrap, "medium_wrap", "Medium Wrap", 3, GripFamily::kPower, "cylinder wrap"},
    {Grip::kLargeDiameter, "large_diameter", "Large Diameter", 1, GripFamily::kPower, "large"},
    {Grip::kSmallDiameter, "small_diameter", "Small Diameter", 2, GripFamily::kPower, "small"},
    {Grip::kPowerSphere, "power_sphere", "Power Sphere", 11, GripFamily::kPower, "sphere ball"},
    {Grip::kFixedHook, "fixed_hook", "Fixed Hook", 15, GripFamily::kPower, "hook"},
    {Grip::kTipPinch, "tip_pinch", "Tip Pinch", 24, GripFamily::kPrecision, "tip"},
    {Grip::kPalmarPinch, "palmar_pinch", "Palmar Pinch", 9, GripFamily::kPrecision,
     "pad_pinch pinch pad"},
    {Grip::kTripod, "tripod", "Tripod", 14, GripFamily::kPrecision, "chuck three_jaw"},
    {Grip::kLateral, "lateral", "Lateral", 16, GripFamily::kIntermediate,
     "key key_pinch lateral_pinch"},
    {Grip::kPrecisionSphere, "precision_sphere", "Precision Sphere", 13, GripFamily::kPrecision,
     "five_finger five_fingers precision"},
    {Grip::kPrecisionDisk, "precision_disk", "Precision Disk", 12, GripFamily::kPrecision,
     "disc disk lid"},
    {Grip::kWritingTripod, "writing_tripod", "Writing Tripod", 20, GripFamily::kPrecision,
     "writing pen"},
    {Grip::kDistalType, "distal_type", "Distal Type", 19, GripFamily::kPower,
     "scissors ring ring_grip rings"},
    {Grip::kPrismatic, "prismatic", "Prismatic 4 Finger", 6, GripFamily::kPrecision,
     "prismatic_four_finger four_finger_pinch box"},
    {Grip::kRestingHand, "resting_hand", "Resting Hand", 0, GripFamily::kNonPrehensile,
     "rest relaxed mouse"},
    {Grip::kFlatHand, "flat_hand", "Flat Hand", 0, GripFamily::kNonPrehensile, "flat platform"},
    {Grip::kFingerPush, "finger_push", "Finger Push", 0, GripFamily::kNonPrehensile,
     "push press button"},
}};

std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool joins = c == '-' || c == ' ';
    result += joins ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

}  // namespace

const GripDescription& description_of(Grip grip) { return kGrips[index_of(grip)]; }

std::string_view name_of(Grip grip) { return description_of(grip).name; }

std::string_view name_of(GripFamily family) {
  switch (family) {
    case GripFamily::kPower:
      return "power";
    case GripFamily::kPrecision:
      return "precision";
    case GripFamily::kIntermediate:
      return "intermediate";
    case GripFamily::kNonPrehensile:
      return "non_prehensile";
  }
  return "unknown";
}

std::optional<Grip> grip_named(std::string_view name) {
  const std::string asked = plain(name);
  for (const GripDescription& one : kGrips) {
    if (asked == one.name || asked == plain(one.taxonomy_name)) return one.grip;
    std::istringstream others{std::string(one.also_called)};
    for (std::string other; others >> other;) {
      if (asked == other) return one.grip;
    }
  }
  return std::nullopt;
}

bool is_power(Grip grip) {
  return description_of(grip).family == GripFamily::kPower && grip != Grip::kDistalType;
}

bool is_non_prehensile(Grip grip) {
  return description_of(grip).family == GripFamily::kNonPrehensile;
}

bool is_laid(Grip grip) { return grip == Grip::kRestingHand || grip == Grip::kFlatHand; }

}  // namespace palmar::grasp
