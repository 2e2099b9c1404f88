// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/words/press_words.h"

#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/workflow/words/number_words.h"

namespace palmar::workflow {
namespace {

const std::string kSpecimen = "setting \"specimen\"";
const std::string kIndenter = "setting \"indenter\"";

/// "name:rest" in two; rest is empty without a colon.
std::pair<std::string, std::string> split_kind(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

std::vector<double> numbers_in(const std::string& what, const std::string& text) {
  return text.empty() ? std::vector<double>() : parse_list(what, text);
}

double one_radius(const std::string& kind, const std::string& text) {
  const std::vector<double> values = numbers_in(kIndenter, text);
  if (values.size() != 1) {
    throw UsageError(kIndenter + ": " + kind + " needs one radius in mm, as in " + kind + ":5");
  }
  return values.front();
}

}  // namespace

contact::PressSpecimen parse_specimen(const std::string& text, std::string& hand) {
  contact::PressSpecimen specimen;
  const auto [kind, rest] = split_kind(text);
  if (text == "plane") return specimen;
  if (kind == "ellipsoid") {
    const std::vector<double> radii = numbers_in(kSpecimen, rest);
    if (radii.size() != 2) {
      throw UsageError(kSpecimen + ": \"" + text +
                       "\"; ellipsoid:RX,RY with two radii in mm is needed");
    }
    specimen.kind = contact::PressSpecimen::Kind::kEllipsoid;
    specimen.radius_x = radii[0];
    specimen.radius_y = radii[1];
    return specimen;
  }
  const std::size_t colon = text.rfind(':');
  const auto region =
      colon == std::string::npos ? std::nullopt : hand::region_named(text.substr(colon + 1));
  if (!region) {
    throw UsageError(kSpecimen + ": \"" + text +
                     "\" is not known; plane, ellipsoid:RX,RY or HAND:REGION "
                     "(template:middle_distal) is allowed");
  }
  specimen.kind = contact::PressSpecimen::Kind::kHandRegion;
  specimen.region = *region;
  hand = text.substr(0, colon);
  return specimen;
}

contact::PressIndenter parse_indenter(const std::string& text) {
  contact::PressIndenter indenter;
  const auto [kind, rest] = split_kind(text);
  if (text == "plane") {
    indenter.kind = contact::PressIndenter::Kind::kPlane;
  } else if (kind == "sphere" || kind == "punch" || kind == "cylinder") {
    indenter.kind = kind == "sphere"  ? contact::PressIndenter::Kind::kSphere
                    : kind == "punch" ? contact::PressIndenter::Kind::kPunch
                                      : contact::PressIndenter::Kind::kCylinder;
    indenter.radius = one_radius(kind, rest);
  } else if (kind == "punches") {
    const std::vector<double> values = numbers_in(kIndenter, rest);
    if (values.size() != 2) {
      throw UsageError(kIndenter +
                       ": punches needs a radius and a distance in mm, as in punches:2,10");
    }
    indenter.kind = contact::PressIndenter::Kind::kTwoPunches;
    indenter.radius = values[0];
    indenter.distance = values[1];
  } else {
    throw UsageError(kIndenter + ": \"" + text +
                     "\" is not known; sphere:R, punch:A, punches:A,DISTANCE, cylinder:R (mm) or "
                     "plane is allowed");
  }
  return indenter;
}

hand::TissueLevel parse_tissue_level(const std::string& text) {
  if (const auto level = contact::tissue_level_named(text)) return *level;
  throw UsageError("setting \"tissue level\": \"" + text +
                   "\" is not known; low, nominal or high is allowed");
}

contact::ContactModel press_model(const ContactModelWords& words, std::optional<double> layer,
                                  bool is_hand) {
  if (is_hand) return contact_model(words);
  ContactModelWords flat = words;
  if (flat.tissue_model.empty()) flat.tissue_model = "halfspace";
  contact::ContactModel model = contact_model(flat);
  if (model.tissue == contact::TissueModel::kBone) {
    throw UsageError(
        "setting \"tissue model\" bone: a plane or ellipsoid has no bones; "
        "setting \"specimen\" template:REGION is needed");
  }
  const bool is_layered = model.tissue == contact::TissueModel::kLayered;
  if (layer && !is_layered && !words.tissue_model.empty()) {
    throw UsageError("setting \"layer\" and setting \"tissue model\" halfspace exclude each other");
  }
  if (is_layered && !layer) {
    throw UsageError(
        "setting \"tissue model\" layered: a plane or ellipsoid needs setting \"layer\" as well");
  }
  if (layer) model.tissue = contact::TissueModel::kLayered;
  return model;
}

contact::Coating parse_cover(const std::string& text) {
  contact::Coating cover = parse_coating(text);
  if (cover.where.isEmpty()) return cover;
  throw UsageError("setting \"coating\": \"" + text +
                   "\": the cover of an indenter is all round it; thickness in mm, shear modulus "
                   "in kPa and Poisson's ratio are allowed (2 or 3 numbers)");
}

}  // namespace palmar::workflow
