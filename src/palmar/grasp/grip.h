// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palmar::grasp {

/// Ways of holding, by the names of the GRASP taxonomy (Feix et al. 2016, IEEE Trans Human-Machine
/// Systems 46(1):66-77); the number is the taxonomy's.
enum class Grip : std::uint8_t {
  kMediumWrap,       ///< 3: cylinder in the palm, fingers and thumb round it
  kLargeDiameter,    ///< 1: the same round a body that fingers and thumb don't close on
  kSmallDiameter,    ///< 2: the same round a thin bar
  kPowerSphere,      ///< 11: fingers spread over a ball in the palm
  kFixedHook,        ///< 15: fingers hooked round a handle, thumb takes no part
  kTipPinch,         ///< 24: tips of thumb and index finger
  kPalmarPinch,      ///< 9: pads of thumb and index finger ("pad pinch")
  kTripod,           ///< 14: thumb against index and middle finger
  kLateral,          ///< 16: thumb pad against the side of the index finger ("key pinch")
  kPrecisionSphere,  ///< 13: five fingertips spread round a body
  kPrecisionDisk,    ///< 12: five fingertips round the rim of a lid or knob, palm over its face
  kWritingTripod,    ///< 20: thumb and index finger press a pen on the side of the middle finger
  kDistalType,       ///< 19: thumb through one ring, fingers through another: scissors
  kPrismatic,    ///< 6, "prismatic 4 finger": thumb pad against the pads of four fingers in line
  kRestingHand,  ///< a relaxed hand lies on a thing: on a computer mouse, a palm rest
  kFlatHand,     ///< a flat hand lies on a thing: on a plate, a table
  kFingerPush,   ///< the index finger presses: on a button, a key
};
inline constexpr int kGripCount = 17;

/// Non-prehensile (Napier 1956, J Bone Joint Surg 38-B:902-913): nothing is grasped, the hand rests
/// on a thing or pushes it ("platform" and "push", Cutkosky 1989, IEEE Trans Robotics Automation
/// 5:269-279). The GRASP taxonomy leaves it out.
enum class GripFamily : std::uint8_t { kPower, kPrecision, kIntermediate, kNonPrehensile };

/// What the taxonomy says of a grip.
struct GripDescription {
  Grip grip{};
  std::string_view name;           ///< "medium_wrap"
  std::string_view taxonomy_name;  ///< "Medium Wrap"
  int taxonomy_number = 0;         ///< 0: not in the taxonomy
  GripFamily family{};
  /// Other names that are taken for it, separated by blanks: "cylinder", "key", "pad-pinch".
  std::string_view also_called;
};
const GripDescription& description_of(Grip grip);
std::string_view name_of(Grip grip);  ///< "medium_wrap", "tip_pinch", ...
std::string_view name_of(GripFamily family);

/// The grip with that name, taxonomy name or other name ("key", "pad-pinch", "tripod"); '-' and '_'
/// and case don't matter. Nothing for an unknown one.
std::optional<Grip> grip_named(std::string_view name);
/// Closed round the product with palm and fingers, or with hooked fingers. Not the distal type,
/// which the taxonomy counts among power grips: it is put on by its fingertips.
bool is_power(Grip grip);
/// Nothing is grasped: the hand rests on a product that stands fast, or a finger pushes it.
bool is_non_prehensile(Grip grip);
/// The whole hand lies on the product: what is_non_prehensile() but for a push.
bool is_laid(Grip grip);

}  // namespace palmar::grasp
