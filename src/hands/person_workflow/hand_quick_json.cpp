// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "hands/person_workflow/hand_quick.h"

namespace palmar::person_workflow {
namespace {

using Json = nlohmann::ordered_json;

Json photograph_json(const PhotographedHand& photo, const capture::OutlinePerson& person) {
  const capture::SheetView& sheet = photo.scene.sheet;
  const capture::HandOutline& outline = person.outline;
  const auto point = [](const Eigen::Vector2d& p) { return Json{p.x(), p.y()}; };
  Json fingers = Json::object();
  for (std::size_t f = 0; f < hand::kFingerCount; ++f) {
    const capture::OutlineFinger& one = outline.finger[f];
    Json& finger = fingers[std::string(name_of(static_cast<hand::Finger>(f)))];
    Json widths = Json::array();
    for (const double w : one.width) {
      if (w > 0.0) widths.push_back(w);
    }
    finger = {{"tip_mm", point(one.tip)}, {"base_mm", point(one.base)}, {"widths_mm", widths}};
    if (f > 0 && one.length > 0.0) finger["length_mm"] = one.length;
  }
  Json corners = Json::array();
  for (const Eigen::Vector2d& c : sheet.corner) corners.push_back(point(c));
  return {{"sheet", sheet.format.name},
          {"sheet_corners_px", corners},
          {"edge_error_mm", sheet.edge_error},
          {"tilt_deg", sheet.tilt},
          {"camera_mm", {sheet.eye.x(), sheet.eye.y(), sheet.eye.z()}},
          {"focal_px", sheet.focal},
          {"focal_from", sheet.focal_source},
          {"scale_error", sheet.scale_error},
          {"side", outline.is_right ? "right" : "left"},
          {"hand_length_mm", outline.hand_length},
          {"hand_width_mm", outline.hand_width},
          {"measured_against_a_model", person.model.has_value()},
          {"fingers", fingers}};
}

}  // namespace

std::string how_known(const population::EstimatedDimension& dimension) {
  return dimension.is_measured ? "measured" : name_of(dimension.evidence);
}

std::string hand_quick_json(const HandQuickOutcome& outcome) {
  Json dimensions = Json::object();
  for (const population::EstimatedDimension& one : outcome.person.estimate.dimensions) {
    dimensions[name_of(one.dimension)] = {
        {"value_mm", one.value}, {"sd_mm", one.sd}, {"how", how_known(one)}};
  }
  Json json = {{"population", outcome.population.name},
               {"side", name_of(outcome.side)},
               {"dimensions", dimensions}};
  if (outcome.photograph) {
    json["photograph"] = photograph_json(*outcome.photograph, outcome.person);
  }
  return json.dump(2) + "\n";
}

}  // namespace palmar::person_workflow
