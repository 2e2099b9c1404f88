// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/words/fingertip_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"

namespace palmar::workflow {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

double parse_angle(const std::string& item, const std::string& value) {
  const std::optional<double> angle = formats::parse_double(value);
  if (!angle || !std::isfinite(*angle)) {
    throw UsageError(fmt::format(
        "setting \"posture\": \"{}\" is not understood; NAME=DEGREES is required", item));
  }
  return *angle;
}

}  // namespace

std::vector<DigitAngle> parse_digit_posture(hand::Finger finger, const std::string& text) {
  if (text.empty()) return {};
  const std::vector<DigitAngleName> known = angle_names_of(finger);
  std::vector<DigitAngle> angles;
  for (const std::string& item : split(text, ',')) {
    const std::size_t equals = item.find('=');
    const std::string name = item.substr(0, equals);
    const auto own =
        std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name; });
    if (own == known.end()) {
      std::vector<std::string> names;
      for (const DigitAngleName& one : known) names.emplace_back(one.name);
      const std::string nearest = nearest_name(name, names);
      throw UsageError(fmt::format(
          "setting \"posture\": the {} has no angle \"{}\"{}; it has {}", name_of(finger), name,
          nearest.empty() ? "" : ", did you mean " + nearest + "?", fmt::join(names, ", ")));
    }
    if (std::any_of(angles.begin(), angles.end(),
                    [&](const DigitAngle& given) { return given.dof == own->dof; })) {
      throw UsageError(fmt::format("setting \"posture\": {} is given twice", name));
    }
    const double angle = parse_angle(item, equals == item.npos ? "" : item.substr(equals + 1));
    angles.push_back({own->dof, angle * geometry::kDegree});
  }
  return angles;
}

hand::Finger parse_finger(const std::string& text) {
  if (const auto finger = hand::finger_named(text)) return *finger;
  throw UsageError(fmt::format(
      "setting \"finger\": \"{}\" is not known; thumb, index, middle, ring or little is allowed",
      text));
}

std::vector<hand::Tendon> parse_tendons(hand::Finger finger, const std::string& text) {
  if (text == "all") return {};
  const auto own = hand::tendons_of(finger);
  std::vector<std::string> names;
  for (const hand::Tendon tendon : own) names.emplace_back(name_of(tendon));
  const auto tendon = hand::tendon_named(text);
  if (tendon && std::find(own.begin(), own.end(), *tendon) != own.end()) return {*tendon};
  const std::string nearest = nearest_name(text, names);
  throw UsageError(fmt::format(
      "setting \"tendon\": the {} has no tendon \"{}\"{}; it has {} (or all)", name_of(finger),
      text, nearest.empty() ? "" : ", did you mean " + nearest + "?", fmt::join(names, ", ")));
}

hand::TendonModel parse_tendon_model(const std::string& points, const std::string& hood) {
  hand::TendonModel model;
  if (points == "an1979") {
    model.points = hand::FingerPoints::kAn1979;
  } else if (points != "synek2019") {
    throw UsageError(fmt::format(
        "setting \"tendon points\": \"{}\" is not known; synek2019 or an1979 is allowed", points));
  }
  if (hood == "chao1989") {
    model.hood = hand::chao1989_hood();
  } else if (hood != "synek2019") {
    throw UsageError(fmt::format(
        "setting \"hood\": \"{}\" is not known; synek2019 or chao1989 is allowed", hood));
  }
  return model;
}

}  // namespace palmar::workflow
