// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "palmar/core/language.h"
#include "palmar/grasp/grip.h"
#include "palmar/workflow/live/live_person.h"
#include "palmar/workflow/live/live_session.h"

namespace palmar::server {

/// What a client may ask for on the live channel, one JSON object per message:
///
///     {"do": "open", "id", "product": "p1", "person": "woman:P5", "left": true, "language": "de"}
///     {"do": "hold", "id", "number", TASK}
///     {"do": "close" | "rest" | "evaluate", "id", POSE, "grip", TASK}
///     {"do": "move", "id", POSE}
///
///     TASK  "grip_force_n" (absent: the usual one), "mass_kg", "friction"
///     POSE  "posture_deg": [23 numbers], "product_from_hand": {"quaternion_wxyz",
///     "translation_mm"}
enum class LiveVerb { kOpen, kHold, kClose, kRest, kEvaluate, kMove };

struct LiveRequest {
  LiveVerb verb{};
  std::uint32_t id = 0;  ///< which the answers carry
  // Of kOpen:
  std::string product;                           ///< its key on the shelf
  std::optional<workflow::PersonOfSize> person;  ///< unset: the template hand, or `own_hand`
  std::string own_hand;                          ///< key of a hand that was made here ("hand:KEY")
  bool is_left = false;
  Language language = Language::kEnglish;
  int number = 1;  ///< of kHold
  workflow::LiveTask task;
  workflow::LivePose pose;
  std::optional<grasp::Grip> grip;
};

/// The longest message that is read.
inline constexpr std::size_t kLongestLiveMessage = std::size_t{64} << 10U;

/// Throws UsageError naming the member, its value and what is allowed.
LiveRequest parse_live_request(std::string_view text);

}  // namespace palmar::server
