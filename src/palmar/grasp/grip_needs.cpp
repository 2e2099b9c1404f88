// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grip_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace palmar::grasp {
namespace {

constexpr int kFingersOfWrap = 2;    // a handle with room for two is still wrapped: choice
constexpr int kFingersOfSphere = 3;  // "five fingertips", of which one may miss: choice

constexpr int kFingersOfRest = 2;  // those on a mouse's buttons: choice

std::string called(hand::Finger finger) {
  return finger == hand::Finger::kThumb ? "thumb" : std::string(name_of(finger)) + " finger";
}

std::string listed_fingers(const std::vector<hand::Finger>& fingers) {
  std::string words;
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    words += k == 0 ? "" : k + 1 == fingers.size() ? " and " : ", ";
    words += called(fingers[k]);
  }
  return words;
}

std::string plain_grip(Grip grip) {
  std::string name(name_of(grip));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::set<hand::Finger> fingers_touching(const std::vector<hand::Region>& touching) {
  std::set<hand::Finger> fingers;
  for (const hand::Region region : touching) {
    const auto segment = hand::segment_of(region);
    if (const auto finger = segment ? hand::finger_of(*segment) : std::nullopt)
      fingers.insert(*finger);
  }
  return fingers;
}

}  // namespace

GripNeeds needs_of(Grip grip) {
  switch (grip) {
    case Grip::kLargeDiameter:
      return {{hand::Finger::kThumb}, kFingersOfWrap};
    case Grip::kPowerSphere:
    case Grip::kPrecisionSphere:
    case Grip::kPrecisionDisk:
    case Grip::kPrismatic:
      return {{hand::Finger::kThumb}, kFingersOfSphere};
    case Grip::kMediumWrap:     // the thumb lies on it or,
    case Grip::kSmallDiameter:  // as far as the fingers come round, on them
    case Grip::kFixedHook:
      return {{}, kFingersOfWrap};
    case Grip::kTipPinch:
    case Grip::kPalmarPinch:
    case Grip::kLateral:
      return {{hand::Finger::kThumb, hand::Finger::kIndex}, 1};
    case Grip::kTripod:
    case Grip::kWritingTripod:
      return {{hand::Finger::kThumb, hand::Finger::kIndex, hand::Finger::kMiddle}, 2};
    case Grip::kDistalType:
      return {{hand::Finger::kThumb, hand::Finger::kMiddle}, 1};
    case Grip::kRestingHand:
    case Grip::kFlatHand:
      return {{}, kFingersOfRest};
    case Grip::kFingerPush:
      return {{hand::Finger::kIndex}, 1};
  }
  return {};
}

std::string lacking_contact(Grip grip, const std::vector<hand::Region>& touching) {
  const GripNeeds needs = needs_of(grip);
  const std::set<hand::Finger> fingers = fingers_touching(touching);
  std::vector<hand::Finger> missing;
  for (const hand::Finger finger : needs.fingers) {
    if (!fingers.contains(finger)) missing.push_back(finger);
  }
  const int others =
      static_cast<int>(fingers.size()) - (fingers.contains(hand::Finger::kThumb) ? 1 : 0);
  if (missing.empty() && others >= needs.least_fingers) return "";
  if (!missing.empty()) {
    return fmt::format("the {} {} touch it, which a {} needs", listed_fingers(missing),
                       missing.size() == 1 ? "doesn't" : "don't", plain_grip(grip));
  }
  return fmt::format("only {} finger{} besides the thumb touch{} it; a {} needs {}", others,
                     others == 1 ? "" : "s", others == 1 ? "es" : "", plain_grip(grip),
                     needs.least_fingers);
}

}  // namespace palmar::grasp
