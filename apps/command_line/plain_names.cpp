// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "plain_names.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "palmar/report/words/texts.h"
#include "text.h"

namespace palmar::cli {
namespace {

std::string digit_words(std::string_view finger) {
  return finger == "thumb" ? "thumb" : std::string(finger) + " finger";
}

/// As in docs/glossary.md.
std::string_view joint_name(std::string_view joint) {
  if (joint == "cmc") return "root joint";
  if (joint == "mcp" || joint == "mp") return "knuckle";
  return joint == "pip" ? "middle joint" : "last joint";
}

/// "index", "pip", "flexion" of "index_pip_flexion"; of the wrist the middle one is empty.
struct DofParts {
  std::string_view digit, joint, motion;
};

DofParts parts_of(hand::Dof dof) {
  const std::string_view name = name_of(dof);
  const std::size_t first = name.find('_'), last = name.rfind('_');
  const std::string_view joint =
      first == last ? std::string_view() : name.substr(first + 1, last - first - 1);
  return {name.substr(0, first), joint, name.substr(last + 1)};
}

bool is_of_name(char c) { return std::islower(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// "the tip of the middle finger"; the name itself if it names neither region nor angle.
std::string plain_name(const std::string& name) {
  static const report::Texts english(Language::kEnglish);
  if (hand::region_named(name)) {
    const std::string place = english("region_at." + name);
    return place.substr(place.find(' ') + 1);  // without "at"
  }
  if (const auto dof = hand::dof_named(name)) return joint_words(*dof);
  return name;
}

}  // namespace

std::string finger_words(hand::Finger finger) { return digit_words(name_of(finger)); }

std::string joint_words(hand::Dof dof) {
  const DofParts parts = parts_of(dof);
  if (parts.motion == "deviation") return "bending of the wrist to the thumb's side";
  if (parts.motion == "pronation") return "turning of the forearm";
  const std::string motion = parts.motion == "flexion" ? "bending" : "spreading";
  if (parts.joint.empty()) return motion + " of the " + std::string(parts.digit);
  return fmt::format("{} of the {}'s {}", motion, digit_words(parts.digit),
                     joint_name(parts.joint));
}

std::string posture_text(const hand::Posture& posture) {
  std::string text = "joint angles in degrees; bent and spread to the thumb's side are positive";
  std::string_view digit, joint;
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    const DofParts parts = parts_of(dof);
    const bool is_new_digit = parts.digit != digit;
    if (is_new_digit) {
      const std::string name = parts.joint.empty() ? "wrist" : digit_words(parts.digit);
      text += fmt::format("\n  {:<15} ", name);
    }
    const bool is_new_joint = is_new_digit || parts.joint != joint;
    if (!is_new_digit) text += is_new_joint && !parts.joint.empty() ? "; " : ", ";
    if (is_new_joint && !parts.joint.empty()) text += std::string(joint_name(parts.joint)) + " ";
    const std::string_view motion = parts.motion == "flexion"     ? "bent"
                                    : parts.motion == "abduction" ? "spread"
                                    : parts.motion == "deviation" ? "to the thumb's side"
                                                                  : "forearm turned";
    text +=
        fmt::format("{} {:.0f}", motion, degrees(posture.angle[static_cast<std::size_t>(d)]) + 0.0);
    digit = parts.digit;
    joint = parts.joint;
  }
  return text + "\n";
}

std::string with_plain_names(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_of_name(text[end])) ++end;
    if (end == at) {
      result += text[at++];
      continue;
    }
    const std::string word = text.substr(at, end - at);
    result += plain_name(word);
    at = end;
  }
  return result;
}

}  // namespace palmar::cli
