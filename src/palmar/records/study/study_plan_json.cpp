// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_plan_json.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "palmar/core/error.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"
#include "palmar/formats/text_scan.h"
#include "palmar/population/sex_names.h"
#include "palmar/records/population/population_file.h"
#include "palmar/records/product/made_product.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

/// Which of `known` a word names.
template <typename Enum, std::size_t kCount>
Enum word_from(const Json& json, const std::array<Enum, kCount>& known) {
  const std::string word = json;
  for (const Enum one : known) {
    if (word == name_of(one)) return one;
  }
  throw InputError("its plan has an unknown word: " + formats::in_quotes(word));
}

Json vector_json(const std::optional<Vec3>& v) { return v ? Json{v->x(), v->y(), v->z()} : Json(); }
std::optional<Vec3> optional_vector_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
std::optional<double> optional_from(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json sex_json(const std::optional<grasp::Sex>& sex) {
  return sex ? Json(population::name_of(*sex)) : Json();
}
std::optional<grasp::Sex> sex_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return population::sex_named(json.get<std::string>());
}

Json population_json(const study::StudyPopulation& one) {
  const population::SamplingOptions& sampling = one.sampling;
  return {{"name", one.population.name},
          {"title", one.population.title},
          {"source", one.population.source},
          {"cautions", one.population.cautions},
          // Given hands have no distribution.
          {"toml", one.population.strata.empty() ? "" : population_toml(one.population)},
          {"design", name_of(sampling.design)},
          {"hands", sampling.hands},
          {"seed", sampling.seed},
          {"residuals", sampling.residuals},
          {"boundary", sampling.boundary},
          {"boundary_points", sampling.boundary_points},
          {"percentiles", sampling.percentiles}};
}

study::StudyPopulation population_from(const Json& json, const std::string& name) {
  study::StudyPopulation one;
  const std::string toml = json.at("toml");
  if (!toml.empty()) one.population = parse_population(toml, name);
  one.population.name = json.at("name");
  one.population.title = json.at("title");
  one.population.source = json.at("source");
  one.population.cautions = json.at("cautions").get<std::vector<std::string>>();
  population::SamplingOptions& sampling = one.sampling;
  sampling.design = word_from(json.at("design"), population::kSamplingDesigns);
  sampling.hands = json.at("hands");
  sampling.seed = json.at("seed");
  sampling.residuals = json.at("residuals");
  sampling.boundary = json.at("boundary");
  sampling.boundary_points = json.at("boundary_points");
  sampling.percentiles = json.at("percentiles").get<std::vector<double>>();
  return one;
}

Json profile_json(const population::HandProfile& profile) {
  return {{"name", profile.name},
          {"range_share", profile.range_share},
          {"strength_share", profile.strength_share},
          {"glove_thickness_mm", profile.glove_thickness},
          {"glove_shear_modulus_mpa", profile.glove_shear_modulus},
          {"nail_length_mm", profile.nail_length},
          {"size_factor", profile.size_factor},
          {"source", profile.source}};
}

population::HandProfile profile_from(const Json& json) {
  population::HandProfile profile;
  profile.name = json.at("name");
  profile.range_share = json.at("range_share");
  profile.strength_share = json.at("strength_share");
  profile.glove_thickness = json.at("glove_thickness_mm");
  profile.glove_shear_modulus = json.at("glove_shear_modulus_mpa");
  profile.nail_length = json.at("nail_length_mm");
  profile.size_factor = json.at("size_factor");
  profile.source = json.at("source");
  return profile;
}

Json hand_json(const study::StudyHand& hand) {
  Json dimensions = Json::object();
  for (const hand::SizedDimension& one : hand.sample.dimensions) {
    dimensions[name_of(one.dimension)] = one.value;
  }
  return {{"population", hand.population},
          {"label", hand.sample.label},
          {"stratum", hand.sample.stratum},
          {"sex", sex_json(hand.sample.sex)},
          {"age_years", optional_json(hand.sample.age)},
          {"grip_strength_n", hand.sample.grip_strength},
          {"dimensions_mm", std::move(dimensions)}};
}

study::StudyHand hand_from(const Json& json, const std::string& name) {
  study::StudyHand hand;
  hand.population = json.at("population");
  hand.sample.label = json.at("label");
  hand.sample.stratum = json.at("stratum");
  hand.sample.sex = sex_from(json.at("sex"));
  hand.sample.age = optional_from(json.at("age_years"));
  hand.sample.grip_strength = json.at("grip_strength_n");
  for (const auto& [key, value] : json.at("dimensions_mm").items()) {
    const auto dimension = hand::hand_dimension_named(key);
    if (!dimension) throw InputError(name + ": unknown dimension " + formats::in_quotes(key));
    hand.sample.dimensions.push_back({*dimension, value.get<double>()});
  }
  return hand;
}

Json fingertips_json(const grasp::Hold& hold) {
  Json list = Json::array();
  for (const grasp::HoldFingertip& tip : hold.fingertips) {
    list.push_back({{"finger", name_of(tip.finger)},
                    {"along", tip.place.along},
                    {"turn_rad", tip.place.turn},
                    {"height_mm", tip.place.height}});
  }
  return list;
}

Json hold_json(const std::optional<grasp::Hold>& hold) {
  if (!hold) return nullptr;
  Json json = {{"part", hold->part},
               {"part_name", hold->part_name},
               {"grip", name_of(hold->grip)},
               {"along", hold->along},
               {"edge", hold->edge},
               {"toward", hold->toward},
               {"turn_rad", hold->turn},
               {"over_end", hold->is_over_end},
               {"fingertips", fingertips_json(*hold)}};
  const auto say = [&](const char* key, const Vec3& v) { json[key] = {v.x(), v.y(), v.z()}; };
  if (hold->wrist) say("wrist", *hold->wrist);
  if (hold->anchor) {
    say("along_toward", hold->anchor->along);
    say("turn_from", hold->anchor->zero);
  }
  return json;
}

std::optional<grasp::Hold> hold_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  grasp::Hold hold;
  const auto grip = grasp::grip_named(json.at("grip").get<std::string>());
  if (!grip) throw InputError("its plan has an unknown grip: " + json.at("grip").dump());
  hold.part = json.at("part");
  hold.part_name = json.at("part_name");
  hold.grip = *grip;
  hold.along = json.at("along");
  hold.edge = json.at("edge");
  hold.toward = json.at("toward");
  hold.turn = json.at("turn_rad");
  hold.is_over_end = json.at("over_end");
  const auto said = [&](const char* key) {
    const Json& three = json.at(key);
    return Vec3(three.at(0), three.at(1), three.at(2));
  };
  if (json.contains("wrist")) hold.wrist = said("wrist");
  if (json.contains("along_toward")) hold.anchor = {said("along_toward"), said("turn_from")};
  for (const Json& tip : json.at("fingertips")) {
    const auto finger = hand::finger_named(tip.at("finger").get<std::string>());
    if (!finger) throw InputError("its plan has an unknown finger: " + tip.at("finger").dump());
    hold.fingertips.push_back({*finger,
                               {.along = tip.at("along").get<double>(),
                                .turn = tip.at("turn_rad").get<double>(),
                                .height = tip.at("height_mm").get<double>()}});
  }
  return hold;
}

/// By feature: weight, mean, spread, weight where it isn't known how it lies.
Json weights_json(const grasp::HoldWeights& weights) {
  Json json;
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) {
    json[std::string(name_of(static_cast<grasp::HoldFeature>(k)))] = {
        weights.weight[k], weights.mean[k], weights.spread[k], weights.unseen[k]};
  }
  return json;
}

std::shared_ptr<const grasp::HoldWeights> weights_from(const Json& json) {
  grasp::HoldWeights weights;
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) {
    const Json& some = json.at(std::string(name_of(static_cast<grasp::HoldFeature>(k))));
    weights.weight[k] = some.at(0);
    weights.mean[k] = some.at(1);
    weights.spread[k] = some.at(2);
    weights.unseen[k] = some.at(3);
  }
  return std::make_shared<const grasp::HoldWeights>(weights);
}

/// How a product is to be held without coordinates; only written where something is said.
Json holding_json(const grasp::HoldRequest& holding) {
  Json json = {{"hold", hold_json(holding.hold)},
               {"number", holding.number ? Json(*holding.number) : Json()},
               {"part", holding.part ? Json(*holding.part) : Json()},
               {"part_name", holding.part_name},
               {"along", optional_json(holding.along)},
               {"toward", vector_json(holding.toward)},
               {"up", vector_json(holding.up)},
               {"is_hand_over", holding.purpose == grasp::HoldPurpose::kHandOver}};
  if (holding.weights) json["hold_weights"] = weights_json(*holding.weights);
  return json;
}

grasp::HoldRequest holding_from(const Json& json) {
  grasp::HoldRequest holding;
  holding.hold = hold_from(json.at("hold"));
  if (!json.at("number").is_null()) holding.number = formats::json_whole<int>(json.at("number"));
  if (!json.at("part").is_null()) holding.part = formats::json_whole<int>(json.at("part"));
  holding.part_name = json.at("part_name");
  holding.along = optional_from(json.at("along"));
  holding.toward = optional_vector_from(json.at("toward"));
  holding.up = optional_vector_from(json.at("up"));
  if (json.at("is_hand_over").get<bool>()) holding.purpose = grasp::HoldPurpose::kHandOver;
  if (json.contains("hold_weights")) holding.weights = weights_from(json.at("hold_weights"));
  return holding;
}

Json product_json(const study::StudyProduct& product) {
  Json json = {{"name", product.name},
               {"family", product.family},
               {"size", product.size},
               {"file", product.file},
               {"content_sha256", product.content_hash},
               {"unit", product.unit},
               {"at_mm", vector_json(product.at)},
               {"axis", vector_json(product.axis)},
               {"mass_kg", product.mass},
               {"posture_of", product.posture_of}};
  if (!product.holding.is_empty()) json["holding"] = holding_json(product.holding);
  return json;
}

study::StudyProduct product_from(const Json& json) {
  study::StudyProduct product;
  product.name = json.at("name");
  product.family = json.at("family");
  product.size = json.at("size");
  product.file = json.at("file");
  product.content_hash = json.at("content_sha256");
  product.unit = json.at("unit");
  product.at = optional_vector_from(json.at("at_mm"));
  product.axis = optional_vector_from(json.at("axis"));
  product.mass = json.at("mass_kg");
  product.posture_of = json.at("posture_of");
  if (json.contains("holding")) product.holding = holding_from(json.at("holding"));
  return product;
}

Json setting_json(const study::StudySetting& setting) {
  const contact::ContactModel& model = setting.model;
  Json json = {{"name", setting.name},
               {"palm_limit_depth_mm", setting.palm_limit_depth},
               {"finger_limit_depth_mm", setting.finger_limit_depth},
               {"grip_force_n", optional_json(setting.grip_force)},
               {"strength_share", optional_json(setting.strength_share)},
               {"limit_depths", setting.limit_depths},
               {"strength_n", optional_json(setting.strength)},
               {"least_grip_force_n", setting.least_grip_force},
               {"friction", setting.friction},
               {"is_balanced", setting.is_balanced},
               {"kernel", name_of(model.kernel)},
               {"tissue_model", name_of(model.tissue)},
               {"coupling", name_of(model.coupling)},
               {"skin_distance", name_of(model.distance)},
               {"bulge", name_of(model.bulge)},
               {"indices", setting.indices},
               {"wrench_volume", setting.wrench_volume},
               {"place_per_hand", setting.is_place_per_hand}};
  // Plans without these stay those of older files.
  if (setting.refine) json["refine"] = true;
  if (setting.torque) json["torque"] = true;
  if (setting.follows_product) json["follows_product"] = true;
  if (setting.task != grasp::HandTask::kUsual) json["task"] = name_of(setting.task);
  if (setting.turn) json["turn_n_m"] = *setting.turn;
  return json;
}

study::StudySetting setting_from(const Json& json) {
  study::StudySetting setting;
  setting.name = json.at("name");
  setting.palm_limit_depth = json.at("palm_limit_depth_mm");
  setting.finger_limit_depth = json.at("finger_limit_depth_mm");
  setting.grip_force = optional_from(json.at("grip_force_n"));
  setting.strength_share = optional_from(json.at("strength_share"));
  // Before these were written, who asked for no force got that of the limit depths.
  const bool is_old = !json.contains("limit_depths");
  setting.limit_depths =
      is_old ? !setting.grip_force && !setting.strength_share : json.at("limit_depths").get<bool>();
  if (!is_old) setting.strength = optional_from(json.at("strength_n"));
  if (!is_old) setting.least_grip_force = json.at("least_grip_force_n");
  setting.friction = json.at("friction");
  setting.is_balanced = json.at("is_balanced");
  setting.model.kernel = word_from(json.at("kernel"), contact::kKernels);
  setting.model.tissue = word_from(json.at("tissue_model"), contact::kTissueModels);
  setting.model.coupling = word_from(json.at("coupling"), contact::kRegionCouplings);
  setting.model.distance = word_from(json.at("skin_distance"), contact::kSkinDistances);
  setting.model.bulge = word_from(json.at("bulge"), contact::kBulgeLaws);
  setting.indices = json.at("indices");
  setting.wrench_volume = json.at("wrench_volume");
  setting.is_place_per_hand = json.at("place_per_hand");
  setting.refine = json.value("refine", false);
  setting.torque = json.value("torque", false);
  setting.follows_product = json.value("follows_product", false);
  if (json.contains("task")) setting.task = word_from(json.at("task"), grasp::kHandTasks);
  if (json.contains("turn_n_m")) setting.turn = json.at("turn_n_m");
  return setting;
}

Json limit_json(const study::StudyLimit& limit) {
  return {{"quantity", limit.quantity},
          {"lowest", optional_json(limit.lowest)},
          {"highest", optional_json(limit.highest)}};
}

template <typename List, typename Function>
Json list_json(const List& list, const Function& one) {
  Json result = Json::array();
  for (const auto& item : list) result.push_back(one(item));
  return result;
}

Json plan_json(const study::StudyPlan& plan) {
  Json grips = Json::array();
  for (const std::optional<grasp::Grip>& grip : plan.grips) {
    grips.push_back(grip ? std::string(name_of(*grip)) : "auto");
  }
  return {{"name", plan.name},
          {"title", plan.title},
          {"seed", plan.seed},
          {"hand_sha256", plan.hand_hash},
          {"populations", list_json(plan.populations, population_json)},
          {"profiles", list_json(plan.profiles, profile_json)},
          {"products", list_json(plan.products, product_json)},
          {"grips", std::move(grips)},
          {"settings", list_json(plan.settings, setting_json)},
          {"limits", list_json(plan.limits, limit_json)},
          {"hands", list_json(plan.hands, hand_json)}};
}

/// "product \"handle\"", "setting \"default\"", for people.
std::string label_of(const std::string& list, const Json& item, std::size_t index) {
  const std::string noun = list.substr(0, list.size() - 1);
  const char* key = list == "hands" ? "label" : list == "limits" ? "quantity" : "name";
  if (item.is_object() && item.contains(key)) {
    return noun + " \"" + item.at(key).get<std::string>() + "\"";
  }
  return noun + " " + std::to_string(index + 1);
}

std::string short_text(const Json& json) {
  std::string text = json.is_null() ? "not set" : json.dump();
  constexpr std::size_t kMost = 40;
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

void compare(const std::string& where, const Json& before, const Json& now,
             std::vector<std::string>& found) {
  // Only written where something is said: it may be in one of them alone.
  if (before.value("holding", Json()) != now.value("holding", Json())) {
    found.push_back(where + "how it is held has changed");
  }
  std::set<std::string> keys;
  for (const Json* json : {&before, &now}) {
    for (const auto& [key, value] : json->items()) keys.insert(key);
  }
  for (const std::string& key : keys) {
    const Json old = before.value(key, Json()), value = now.value(key, Json());
    if (key == "holding" || old == value) continue;
    if (key == "file" && !is_made(old) && !is_made(value)) continue;  // its content counts
    if (key == "content_sha256") {
      found.push_back(where + "its shape has changed (" + now.at("file").get<std::string>() + ")");
    } else if (key == "hand_sha256") {
      found.push_back(where + "the hand that is scaled is another one");
    } else if (key == "toml") {
      found.push_back(where + "its figures have changed");
    } else if (key == "dimensions_mm") {
      found.push_back(where + "its dimensions have changed");
    } else {
      found.push_back(where + key + " was " + short_text(old) + ", now " + short_text(value));
    }
  }
}

void compare_lists(const std::string& list, const Json& before, const Json& now,
                   std::vector<std::string>& found) {
  if (before.size() != now.size()) {
    found.push_back("had " + std::to_string(before.size()) + " " + list + ", now " +
                    std::to_string(now.size()));
    return;
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (before[i] == now[i]) continue;
    if (now[i].is_object()) {
      compare(label_of(list, before[i], i) + ": ", before[i], now[i], found);
    } else {
      found.push_back(list + " " + std::to_string(i + 1) + " was " + short_text(before[i]) +
                      ", now " + short_text(now[i]));
    }
  }
}

}  // namespace

std::string format_plan(const study::StudyPlan& plan) {
  return plan_json(plan).dump(1, ' ', false, Json::error_handler_t::replace);
}

std::string format_identity(const study::StudyPlan& plan) {
  Json json = plan_json(plan);
  for (Json& product : json.at("products")) {
    if (!is_made(product.at("file"))) product.erase("file");
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace);
}

study::StudyPlan parse_plan(const std::string& text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    study::StudyPlan plan;
    plan.name = json.at("name");
    plan.title = json.at("title");
    plan.seed = json.at("seed");
    plan.hand_hash = json.at("hand_sha256");
    for (const Json& one : json.at("populations")) {
      plan.populations.push_back(population_from(one, name));
    }
    for (const Json& one : json.at("profiles")) plan.profiles.push_back(profile_from(one));
    for (const Json& one : json.at("products")) plan.products.push_back(product_from(one));
    for (const Json& one : json.at("grips")) {
      const std::string grip = one;
      plan.grips.push_back(grip == "auto" ? std::nullopt : grasp::grip_named(grip));
    }
    for (const Json& one : json.at("settings")) plan.settings.push_back(setting_from(one));
    for (const Json& one : json.at("limits")) {
      plan.limits.push_back({.quantity = one.at("quantity"),
                             .lowest = optional_from(one.at("lowest")),
                             .highest = optional_from(one.at("highest"))});
    }
    for (const Json& one : json.at("hands")) plan.hands.push_back(hand_from(one, name));
    return plan;
  } catch (const Json::exception& error) {
    throw InputError(name + ": its plan can't be read: " + formats::json_reason(error));
  }
}

std::vector<std::string> plan_differences(const study::StudyPlan& before,
                                          const study::StudyPlan& now, std::size_t most) {
  const Json old_json = plan_json(before);
  const Json new_json = plan_json(now);
  std::vector<std::string> found;
  Json old_plain = Json::object(), new_plain = Json::object();
  for (const auto& [key, value] : new_json.items()) {
    if (value.is_array()) continue;
    old_plain[key] = old_json.at(key);
    new_plain[key] = value;
  }
  compare("", old_plain, new_plain, found);
  for (const auto& [key, value] : new_json.items()) {
    if (value.is_array()) compare_lists(key, old_json.at(key), value, found);
  }
  if (found.size() > most) {
    const std::size_t more = found.size() - most;
    found.resize(most);
    found.push_back("and " + std::to_string(more) + " more");
  }
  return found;
}

}  // namespace palmar::records
