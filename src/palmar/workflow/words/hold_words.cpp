// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/words/hold_words.h"

#include <fmt/format.h>

#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/hold/hold_file.h"
#include "palmar/records/hold/people_holds_file.h"
#include "palmar/workflow/words/number_words.h"

namespace palmar::workflow {
namespace {

constexpr int kMostNumber = 100'000;

/// The text as a whole number; nothing if it is none. Throws UsageError out of range.
std::optional<int> whole_number(const std::string& what, const std::string& text) {
  const auto value = formats::parse_integer(text);
  if (!value) return std::nullopt;
  if (*value < 1 || *value > kMostNumber) {
    throw UsageError(fmt::format("{} is {}; a number from 1 is required", what, text));
  }
  return static_cast<int>(*value);
}

grasp::HoldPurpose parse_purpose(const std::string& text) {
  if (text == "use") return grasp::HoldPurpose::kUse;
  if (text == "hand-over" || text == "hand_over") return grasp::HoldPurpose::kHandOver;
  throw UsageError("setting \"purpose\": \"" + text +
                   "\" is not known; use or hand-over is allowed");
}

}  // namespace

grasp::HoldRequest hold_request(const HoldWords& words) {
  grasp::HoldRequest result;
  if (!words.hold.empty()) {
    result.number = whole_number("setting \"hold\"", words.hold);
    if (!result.number) result.hold = records::read_hold(words.hold).hold;
  }
  if (!words.part.empty()) {
    result.part = whole_number("setting \"part\"", words.part);
    if (!result.part) result.part_name = words.part;
  }
  result.along = words.along;
  if (!words.up.empty()) result.up = parse_direction("setting \"up\"", words.up);
  if (words.toward == "up" || words.toward == "down") {
    const Vec3 up = result.up.value_or(Vec3::UnitZ());
    result.toward = words.toward == "up" ? up : Vec3(-up);
  } else if (!words.toward.empty()) {
    result.toward = parse_direction("setting \"toward\"", words.toward);
  }
  result.purpose = parse_purpose(words.purpose);
  if (!words.weights.empty()) {
    if (result.purpose == grasp::HoldPurpose::kUse) {
      throw UsageError("setting \"hold weights\" goes with setting \"purpose\" hand-over");
    }
    result.weights =
        std::make_shared<const grasp::HoldWeights>(records::read_hold_weights(words.weights));
  }
  return result;
}

std::string grip_list() {
  std::string list = "any, power";
  for (int g = 0; g < grasp::kGripCount; ++g)
    list += fmt::format(", {}", name_of(static_cast<grasp::Grip>(g)));
  return list;
}

std::optional<grasp::Grip> parse_grip(const std::string& text) {
  if (text == "any" || text == "auto" || text == "power") return std::nullopt;
  if (const std::optional<grasp::Grip> grip = grasp::grip_named(text)) return grip;
  std::vector<std::string> known = {"any", "power"};
  for (int g = 0; g < grasp::kGripCount; ++g)
    known.emplace_back(name_of(static_cast<grasp::Grip>(g)));
  const std::string nearest = nearest_name(text, known);
  throw UsageError(fmt::format("setting \"grip\": \"{}\" is not known{}; {} is allowed", text,
                               nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest),
                               grip_list()));
}

}  // namespace palmar::workflow
