// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/plain_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace palmar::report {

namespace {

std::string finger_words(hand::Finger finger) {
  switch (finger) {
    case hand::Finger::kThumb:
      return "thumb";
    case hand::Finger::kIndex:
      return "index finger";
    case hand::Finger::kMiddle:
      return "middle finger";
    case hand::Finger::kRing:
      return "ring finger";
    case hand::Finger::kLittle:
      return "little finger";
  }
  return "finger";
}

// "index_pip_flexion" -> "index pip flexion"
std::string spaced(std::string_view name) {
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

}  // namespace

std::string plain_words(hand::Segment segment) {
  const auto finger = hand::finger_of(segment);
  if (!finger) return "palm";
  const auto segments = hand::segments_of(*finger);
  if (segments[0] == segment) return finger_words(*finger) + ", base";
  const bool is_tip = *finger == hand::Finger::kThumb || segments[2] == segment;
  return finger_words(*finger) + (is_tip ? ", tip" : ", middle");
}

std::string plain_words(hand::Region region) {
  switch (region) {
    case hand::Region::kDorsum:
      return "back and sides of hand and fingers";
    case hand::Region::kThenar:
      return "ball of the thumb (thenar)";
    case hand::Region::kHypothenar:
      return "heel of the hand (hypothenar)";
    case hand::Region::kCentralPalm:
      return "middle of the palm";
    case hand::Region::kRadialPalm:
      return "pad below index and middle finger";
    case hand::Region::kUlnarPalm:
      return "pad below ring and little finger";
    default:
      break;
  }
  const auto segment = hand::segment_of(region);
  return segment ? plain_words(*segment) : spaced(name_of(region));
}

std::string plain_words(grasp::StopReason reason) {
  switch (reason) {
    case grasp::StopReason::kLimitDepth:
      return "pressed in to the limit depth";
    case grasp::StopReason::kRangeOfMotion:
      return "its joint can't bend further";
    case grasp::StopReason::kProximalStop:
      return "held back by a joint nearer to the palm";
    case grasp::StopReason::kDistalStop:
      return "held back by a segment nearer to the tip";
    case grasp::StopReason::kOtherFinger:
      return "another finger is in the way";
    case grasp::StopReason::kNotReached:
      return "closed fully without touching the product";
    case grasp::StopReason::kGiven:
      return "where the given posture has it";
  }
  return spaced(name_of(reason));
}

std::string plain_words(grasp::GraspStatus status) {
  switch (status) {
    case grasp::GraspStatus::kHeld:
      return "Held";
    case grasp::GraspStatus::kPartlyHeld:
      return "Partly held";
    case grasp::GraspStatus::kTooLarge:
      return "Too large for this hand";
    case grasp::GraspStatus::kTooSmall:
      return "Too small for this hand";
    case grasp::GraspStatus::kNotGraspable:
      return "No place for a power grip";
  }
  return spaced(name_of(status));
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

std::string plain_words(hand::Dof dof) {
  std::string words = spaced(name_of(dof));
  for (const std::string joint : {" mcp ", " pip ", " dip ", " cmc ", " mp ", " ip "}) {
    const auto at = words.find(joint);
    if (at == std::string::npos) continue;
    for (std::size_t i = at; i < at + joint.size(); ++i) {
      words[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[i])));
    }
  }
  return words;
}

std::string exact_number(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string short_number(double value, int significant) {
  if (!std::isfinite(value)) return "–";
  const double size = std::abs(value);
  const int before = size >= 1.0 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 0;
  // Below 1 count from the first digit that isn't 0, but show at most 5 decimals.
  const int leading =
      size > 0.0 && size < 1.0 ? static_cast<int>(-std::floor(std::log10(size))) - 1 : 0;
  const int decimals = size == 0.0 ? 0 : std::clamp(significant - before + leading, 0, 5);
  std::array<char, 340> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

}  // namespace palmar::report
