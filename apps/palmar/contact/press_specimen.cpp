// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "contact/press_specimen.h"

#include "cli.h"
#include "palmar/core/error.h"

namespace palmar::cli {
namespace {

/// "name:rest" in two; rest is empty without a colon.
std::pair<std::string, std::string> split_kind(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

std::vector<double> numbers_in(const std::string& option, const std::string& text) {
  return text.empty() ? std::vector<double>() : parse_list(option, text);
}

double one_radius(const std::string& kind, const std::string& text) {
  const std::vector<double> values = numbers_in("--indenter", text);
  if (values.size() != 1) {
    throw UsageError("--indenter: " + kind + " needs one radius in mm, as in " + kind + ":5");
  }
  return values.front();
}

}  // namespace

PressSpecimen parse_specimen(const std::string& text, std::string& hand) {
  PressSpecimen specimen;
  const auto [kind, rest] = split_kind(text);
  if (text == "plane") return specimen;
  if (kind == "ellipsoid") {
    const std::vector<double> radii = numbers_in("--specimen", rest);
    if (radii.size() != 2) {
      throw UsageError("--specimen: \"" + text +
                       "\"; ellipsoid:RX,RY with two radii in mm is needed");
    }
    specimen.kind = PressSpecimen::Kind::kEllipsoid;
    specimen.radius_x = radii[0];
    specimen.radius_y = radii[1];
    return specimen;
  }
  const std::size_t colon = text.rfind(':');
  const auto region =
      colon == std::string::npos ? std::nullopt : region_named(text.substr(colon + 1));
  if (!region) {
    throw UsageError(
        "--specimen: \"" + text +
        "\" is not known; plane, ellipsoid:RX,RY or HAND:REGION (template:middle_distal) "
        "is allowed");
  }
  specimen.kind = PressSpecimen::Kind::kHandRegion;
  specimen.region = *region;
  hand = text.substr(0, colon);
  return specimen;
}

PressIndenter parse_indenter(const std::string& text) {
  PressIndenter indenter;
  const auto [kind, rest] = split_kind(text);
  if (text == "plane") {
    indenter.kind = PressIndenter::Kind::kPlane;
  } else if (kind == "sphere" || kind == "punch" || kind == "cylinder") {
    indenter.kind = kind == "sphere"  ? PressIndenter::Kind::kSphere
                    : kind == "punch" ? PressIndenter::Kind::kPunch
                                      : PressIndenter::Kind::kCylinder;
    indenter.radius = one_radius(kind, rest);
  } else if (kind == "punches") {
    const std::vector<double> values = numbers_in("--indenter", rest);
    if (values.size() != 2) {
      throw UsageError(
          "--indenter: punches needs a radius and a distance in mm, as in punches:2,10");
    }
    indenter.kind = PressIndenter::Kind::kTwoPunches;
    indenter.radius = values[0];
    indenter.distance = values[1];
  } else {
    throw UsageError("--indenter: \"" + text +
                     "\" is not known; sphere:R, punch:A, punches:A,DISTANCE, cylinder:R (mm) or "
                     "plane is allowed");
  }
  return indenter;
}

}  // namespace palmar::cli
