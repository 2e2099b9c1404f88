// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_request.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/posture/placement_json.h"
#include "palmar/server/access.h"
#include "palmar/server/job_request.h"

namespace palmar::server {
namespace {

using RequestJson = nlohmann::json;

constexpr double kFarthest = 10'000.0;  // mm; a hand farther from the product's origin is a mistake

[[noreturn]] void refuse(const std::string& member, const RequestJson& value,
                         const std::string& allowed) {
  throw UsageError("live request: \"" + member + "\" is " + formats::in_quotes(value.dump()) +
                   "; " + allowed + " is required");
}

const RequestJson& member_of(const RequestJson& json, const char* name,
                             const std::string& allowed) {
  const auto found = json.find(name);
  if (found == json.end()) {
    throw UsageError(std::string("live request: \"") + name + "\" is missing; " + allowed +
                     " is required");
  }
  return *found;
}

std::string text_of(const RequestJson& json, const char* name, const std::string& allowed) {
  const RequestJson& value = member_of(json, name, allowed);
  if (!value.is_string()) refuse(name, value, allowed);
  return value.get<std::string>();
}

std::optional<double> number_of(const RequestJson& json, const char* name, double lowest,
                                double highest) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return std::nullopt;
  const double value = found->is_number() ? found->get<double>() : NAN;
  if (!(value >= lowest && value <= highest)) {
    refuse(name, *found,
           "a number from " + formats::shortest(lowest) + " to " + formats::shortest(highest));
  }
  return value;
}

int whole_number_of(const RequestJson& json, const char* name, int lowest, int highest) {
  const std::string allowed =
      "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
  const RequestJson& value = member_of(json, name, allowed);
  if (!value.is_number_integer() || value.get<double>() < lowest || value.get<double>() > highest) {
    refuse(name, value, allowed);
  }
  return value.get<int>();
}

LiveVerb verb_named(const std::string& name) {
  if (name == "open") return LiveVerb::kOpen;
  if (name == "hold") return LiveVerb::kHold;
  if (name == "close") return LiveVerb::kClose;
  if (name == "rest") return LiveVerb::kRest;
  if (name == "evaluate") return LiveVerb::kEvaluate;
  if (name == "move") return LiveVerb::kMove;
  throw UsageError("live request: \"do\" is " + formats::in_quotes(name) +
                   "; open, hold, close, rest, evaluate or move is allowed");
}

workflow::LivePose pose_of(const RequestJson& json) {
  const std::string allowed = "a list of " + std::to_string(hand::kDofCount) + " angles in degrees";
  const RequestJson& angles = member_of(json, "posture_deg", allowed);
  if (!angles.is_array() || angles.size() != hand::kDofCount)
    refuse("posture_deg", angles, allowed);
  workflow::LivePose pose;
  for (std::size_t k = 0; k < hand::kDofCount; ++k) {
    const double angle = angles[k].is_number() ? angles[k].get<double>() : NAN;
    if (!(std::abs(angle) <= 360.0))
      refuse("posture_deg", angles[k], "an angle within a full turn");
    pose.posture.angle[k] = geometry::kDegree * angle;
  }
  try {
    pose.product_from_hand =
        records::placement_from_json(member_of(json, "product_from_hand", "a placement"));
  } catch (const InputError& error) {
    throw UsageError(std::string("live request: \"product_from_hand\": ") + error.what());
  }
  if (!(pose.product_from_hand.translation.norm() <= kFarthest)) {
    throw UsageError("live request: \"product_from_hand\" is more than 10 m away");
  }
  return pose;
}

workflow::LiveTask task_of(const RequestJson& json) {
  workflow::LiveTask task;
  task.rest.grip_force = number_of(json, "grip_force_n", 0.1, 2000.0);
  task.friction.mass = number_of(json, "mass_kg", 0.001, 100.0);
  task.friction.friction = number_of(json, "friction", 0.0, 5.0);
  task.rest.check();
  task.friction.check();
  return task;
}

}  // namespace

LiveRequest parse_live_request(std::string_view text) {
  const RequestJson json = RequestJson::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    throw UsageError("live request: " + formats::in_quotes(text) + " is no JSON object");
  }
  LiveRequest request;
  request.verb = verb_named(text_of(json, "do", "open, hold, close, rest, evaluate or move"));
  request.id = static_cast<std::uint32_t>(whole_number_of(json, "id", 0, 2'000'000'000));
  switch (request.verb) {
    case LiveVerb::kOpen: {
      request.product = text_of(json, "product", "the key of a product");
      const std::string person = json.contains("person") && !json["person"].is_null()
                                     ? text_of(json, "person", "a text")
                                     : "";
      if (person.starts_with(kOwnHand)) {
        request.own_hand = person.substr(kOwnHand.size());
        if (!is_plain_name(request.own_hand)) refuse("person", json["person"], "a hand's key");
      } else if (!person.empty()) {
        request.person = workflow::parse_person_of_size(person);
      }
      if (json.contains("left")) {
        if (!json["left"].is_boolean()) refuse("left", json["left"], "true or false");
        request.is_left = json["left"].get<bool>();
      }
      if (json.contains("language")) {
        request.language = language_named(text_of(json, "language", "en or de"));
      }
      break;
    }
    case LiveVerb::kHold:
      request.number = whole_number_of(json, "number", 1, 1000);
      request.task = task_of(json);
      break;
    case LiveVerb::kMove:
      request.pose = pose_of(json);
      break;
    case LiveVerb::kClose:
    case LiveVerb::kRest:
    case LiveVerb::kEvaluate:
      request.pose = pose_of(json);
      request.task = task_of(json);
      if (json.contains("grip") && !json["grip"].is_null()) {
        request.grip = grasp::grip_named(text_of(json, "grip", "a grip"));
        if (!request.grip) refuse("grip", json["grip"], "a grip's name");
      }
      break;
  }
  return request;
}

}  // namespace palmar::server
