// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_answer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/records/hold/hold_json.h"
#include "palmar/records/posture/placement_json.h"
#include "palmar/records/posture/posture_file.h"
#include "palmar/report/picture/assessment_pictures.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/texts.h"
#include "palmar/report/words/verdict_words.h"
#include "palmar/study/assessment/verdict.h"

namespace palmar::server {
namespace {

using AnswerJson = nlohmann::ordered_json;

constexpr const char* kPostureFile = "posture.json";

std::string dumped(const AnswerJson& json) {
  return json.dump(-1, ' ', false, AnswerJson::error_handler_t::replace);
}

AnswerJson colour(report::Rgb c) { return AnswerJson::array({c.r, c.g, c.b}); }

AnswerJson colours_object() {
  AnswerJson table = AnswerJson::array();
  for (const report::Rgb c : report::colour_table(report::Colormap::kEmber))
    table.push_back(colour(c));
  return {{"table", std::move(table)},
          {"neutral", colour(report::kNeutralColour)},
          {"skin", colour(report::kSkinColour)},
          {"product", colour(report::kProductColour)}};
}

AnswerJson hand_object(const hand::Hand& hand, Language language) {
  AnswerJson angles = AnswerJson::array();
  const hand::Posture reference = hand::reference_posture(hand.skeleton);
  for (int d = 0; d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = hand.skeleton.dof(static_cast<hand::Dof>(d));
    angles.push_back({{"name", name_of(dof.dof)},
                      {"lower_deg", geometry::kDegreesPerRadian * dof.lower},
                      {"upper_deg", geometry::kDegreesPerRadian * dof.upper},
                      {"reference_deg", geometry::kDegreesPerRadian * reference[dof.dof]}});
  }
  const report::Texts texts(language);
  AnswerJson regions = AnswerJson::array();
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const std::string name(name_of(static_cast<hand::Region>(r)));
    regions.push_back({{"name", name}, {"words", texts("region." + name)}});
  }
  return {{"name", hand.name},
          {"side", name_of(hand.side)},
          {"length_mm", hand.dimensions.hand_length},
          {"vertices", hand.skin.vertices.size()},
          {"angles", std::move(angles)},
          {"regions", std::move(regions)}};
}

AnswerJson product_object(const ShelvedProduct& shelved) {
  AnswerJson object = {
      {"key", shelved.key},
      {"file_name", shelved.file_name},
      {"argument", shelved.argument},
      {"unit", shelved.unit ? AnswerJson(name_of(*shelved.unit)) : AnswerJson(nullptr)},
      {"made_by", shelved.made_by},
      {"is_read", shelved.product != nullptr}};
  if (shelved.product == nullptr) return object;
  const product::Product& product = *shelved.product;
  const Vec3 sides = product.distance->bounding_box().sizes();
  object["name"] = product.name;
  object["triangles"] = product.mesh.triangles.size();
  object["sides_mm"] = {sides.x(), sides.y(), sides.z()};
  object["unit_source"] = name_of(product.unit_source);
  object["notes"] = product.notes;
  return object;
}

AnswerJson posture_object(const grasp::Grasp& grasp) {
  return {{"posture", AnswerJson::parse(records::posture_json(grasp.posture))},
          {"product_from_hand", records::placement_with_matrix(grasp.product_from_hand)},
          {"grip", name_of(grasp.grip)}};
}

}  // namespace

std::string dropped_answer(std::uint32_t request) {
  return dumped({{"say", "dropped"}, {"request", request}});
}

std::string progress_answer(std::uint32_t request, double share, const std::string& doing) {
  return dumped({{"say", "progress"}, {"request", request}, {"share", share}, {"doing", doing}});
}

std::string error_answer(std::uint32_t request, const std::string& message, int code) {
  return dumped({{"say", "error"}, {"request", request}, {"message", message}, {"code", code}});
}

std::string opened_answer(std::uint32_t request, const ShelvedProduct& product,
                          workflow::LiveSession& session, Language language) {
  const report::Phrases phrases(language);
  AnswerJson holds = AnswerJson::parse(
      records::ranked_holds_json(session.holds(), session.product().name, session.hand().side));
  for (AnswerJson& hold : holds["holds"]) {
    for (const char* key : {"words", "against"}) {
      if (hold.contains(key) && hold[key].is_string()) {
        hold[key] = phrases(hold[key].get<std::string>());
      }
    }
  }
  return dumped({{"say", "opened"},
                 {"request", request},
                 {"product", product_object(product)},
                 {"hand", hand_object(session.hand(), language)},
                 {"holds", std::move(holds["holds"])},
                 {"parts", std::move(holds["parts"])},
                 {"colours", colours_object()}});
}

std::string command_of(const LiveRequest& request, const LiveRequest& opened,
                       const ShelvedProduct& product, const std::string& own_hand) {
  const bool is_hold = request.verb == LiveVerb::kHold;
  if (!is_hold && request.verb != LiveVerb::kEvaluate) return "";
  std::string command = is_hold ? "palmar assess " : "palmar grasp evaluate ";
  command += shell_word(product.argument);
  if (product.unit) command += " --unit " + name_of(*product.unit);
  if (is_hold) {
    command += fmt::format(" --hold {}", request.number);
    if (request.task.rest.grip_force) {
      command += " --grip-force-n " + formats::shortest(*request.task.rest.grip_force);
    }
  } else {
    command += std::string(" --posture ") + kPostureFile;
  }
  if (!own_hand.empty()) command += " --hand " + shell_word(own_hand);
  if (opened.person) command += " --person " + workflow::person_argument(*opened.person);
  if (opened.is_left) command += " --left";
  if (request.task.friction.mass)
    command += " --mass-kg " + formats::shortest(*request.task.friction.mass);
  if (request.task.friction.friction) {
    command += " --friction " + formats::shortest(*request.task.friction.friction);
  }
  return command;
}

std::string result_answer(const LiveRequest& request, const study::AssessmentSet& set,
                          Language language) {
  const records::VerdictWords words = report::verdict_words(set, study::verdict_of(set), language);
  const grasp::Grasp& grasp = set.assessments.front().assessment.grasp;
  AnswerJson answer = {{"say", "result"},
                       {"request", request.id},
                       {"is_hold", request.verb == LiveVerb::kHold},
                       {"command", set.command_line},
                       {"posture_file", kPostureFile},
                       {"posture", posture_object(grasp)},
                       {"upper_mpa", report::pressure_scale(set).upper},
                       {"hold_words", report::Phrases(language)(grasp.hold_words)}};
  answer["assessment"] = AnswerJson::parse(records::assessment_json(set, words));
  return dumped(answer);
}

std::string colours_json() { return dumped(colours_object()); }

std::string shelved_product_json(const ShelvedProduct& product) {
  return dumped(product_object(product));
}

}  // namespace palmar::server
