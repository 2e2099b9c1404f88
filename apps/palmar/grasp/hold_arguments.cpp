// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/hold_arguments.h"

#include <fmt/format.h>

#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/hold/hold_file.h"

namespace palmar::cli {
namespace {

constexpr int kMostNumber = 100'000;

/// The text as a whole number; nothing if it is none. Throws UsageError out of range.
std::optional<int> whole_number(const std::string& option, const std::string& text) {
  const auto value = parse_integer(text);
  if (!value) return std::nullopt;
  if (*value < 1 || *value > kMostNumber) {
    throw UsageError(fmt::format("{} is {}; a number from 1 is required", option, text));
  }
  return static_cast<int>(*value);
}

HoldPurpose parse_purpose(const std::string& text) {
  if (text == "use") return HoldPurpose::kUse;
  if (text == "hand-over" || text == "hand_over") return HoldPurpose::kHandOver;
  throw UsageError("--purpose: \"" + text + "\" is not known; use or hand-over is allowed");
}

}  // namespace

void HoldArguments::add_hold_to(CLI::App& verb) {
  verb.add_option("--hold", hold_,
                  "How to hold the product: a hold's file (.toml), or its number in the list of "
                  "palmar grasp holds; 1 (the best) if nothing is said");
}

void HoldArguments::add_to(CLI::App& verb) {
  verb.add_option("--part", part_,
                  "Hold this part of the product: its name or number (palmar product parts)");
  verb.add_option("--along", along_, "Where along the part, a fraction of its length from 0 to 1");
  verb.add_option("--toward", toward_,
                  "Where the thumb's side points: up, down, an axis of the product (+x, -z) or "
                  "x,y,z");
  verb.add_option("--up", up_,
                  "Which way is up when the product is used: an axis (+y) or x,y,z in the "
                  "product's frame; not known if not given, and +z for --toward up");
  verb.add_option("--purpose", purpose_, "What it is held for: use or hand-over")
      ->capture_default_str();
}

HoldRequest HoldArguments::request() const {
  HoldRequest result;
  if (!hold_.empty()) {
    result.number = whole_number("--hold", hold_);
    if (!result.number) result.hold = read_hold(hold_).hold;
  }
  if (!part_.empty()) {
    result.part = whole_number("--part", part_);
    if (!result.part) result.part_name = part_;
  }
  result.along = along_;
  if (!up_.empty()) result.up = parse_direction("--up", up_);
  if (toward_ == "up" || toward_ == "down") {
    const Vec3 up = result.up.value_or(Vec3::UnitZ());
    result.toward = toward_ == "up" ? up : Vec3(-up);
  } else if (!toward_.empty()) {
    result.toward = parse_direction("--toward", toward_);
  }
  result.purpose = parse_purpose(purpose_);
  return result;
}

Vec3 parse_direction(const std::string& option, const std::string& text) {
  const bool has_sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string axis = has_sign ? text.substr(1) : text;
  if (axis == "x" || axis == "y" || axis == "z") {
    const Vec3 unit = Vec3::Unit(axis[0] - 'x');
    return text[0] == '-' ? Vec3(-unit) : unit;
  }
  if (text.find(',') == text.npos) {
    throw UsageError(fmt::format(
        "{}: \"{}\" is no direction; an axis (+x, -x, +y ...) or three numbers x,y,z are required",
        option, text));
  }
  const Vec3 direction = parse_vector(option, text);
  if (!(direction.norm() > 0.0)) {
    throw UsageError(option + ": " + text + " has no direction; not all may be 0");
  }
  return direction;
}

std::string grip_list() {
  std::string list = "any, power";
  for (int g = 0; g < kGripCount; ++g) list += fmt::format(", {}", name_of(static_cast<Grip>(g)));
  return list;
}

std::optional<Grip> parse_grip(const std::string& text) {
  if (text == "any" || text == "auto" || text == "power") return std::nullopt;
  if (const std::optional<Grip> grip = grip_named(text)) return grip;
  std::vector<std::string> known = {"any", "power"};
  for (int g = 0; g < kGripCount; ++g) known.emplace_back(name_of(static_cast<Grip>(g)));
  const std::string nearest = nearest_name(text, known);
  throw UsageError(fmt::format("--grip: \"{}\" is not known{}; {} is allowed", text,
                               nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest),
                               grip_list()));
}

}  // namespace palmar::cli
