// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/setting_names.h"
#include "palmar/formats/text_scan.h"
#include "palmar/grasp/task_force.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/sex_names.h"
#include "palmar/product/mass.h"
#include "palmar/product/scaled_product.h"
#include "palmar/records/population/dimension_table_file.h"
#include "palmar/records/population/population_file.h"
#include "palmar/records/product/product_file.h"
#include "palmar/records/study/study_file.h"
#include "palmar/records/study/study_store.h"
#include "palmar/study/assessment/held_torque.h"
#include "palmar/study/study_task.h"

namespace palmar::records {
namespace {

/// `body`, with the place in the study file before what it complains of.
template <typename Body>
void at_place(const std::string& where, const Body& body) {
  try {
    body();
  } catch (const UsageError& error) {
    if (where.empty()) throw;
    throw InputError(where + error.what());
  } catch (const InputError& error) {
    throw InputError(where + error.what());
  }
}

/// Hands of a table, each as it was measured.
std::vector<population::HandSample> given_hands(const std::string& path,
                                                std::vector<std::string>& notes) {
  const population::DimensionTable table = read_dimension_table(path);
  for (const std::string& text : table.notes) notes.push_back(path + ": " + text);
  std::vector<population::HandSample> hands;
  for (int s = 0; s < table.subjects(); ++s) {
    population::HandSample hand;
    hand.label = std::to_string(s + 1);
    for (const population::TableColumn& column : table.columns) {
      const bool has_text = !column.is_number && !column.texts[s].empty();
      const bool has_value = column.is_number && column.values[s].has_value();
      if (has_text && column.name == "sex") hand.sex = population::sex_of_text(column.texts[s]);
      if (has_text && column.quantity == population::Quantity::kLabel) hand.label = column.texts[s];
      if (has_value && column.quantity == population::Quantity::kLabel) {
        hand.label = formats::shortest(*column.values[s]);
      }
      if (has_value && column.quantity == population::Quantity::kAge) hand.age = column.values[s];
      if (has_value && column.name == "grip_strength" && column.unit == "n") {
        hand.grip_strength = *column.values[s];  // N
      }
      if (has_value && column.dimension) {
        hand.dimensions.push_back({*column.dimension, *column.values[s]});
      }
    }
    if (hand.dimensions.empty()) {
      throw InputError(path + ":" + std::to_string(table.lines[s]) +
                       ": no dimension of the hand; hand_length_mm is one");
    }
    if (!(hand.grip_strength > 0.0) && hand.sex && hand.age) {
      hand.grip_strength = grasp::grip_strength(*hand.sex, *hand.age).value_or(0.0);
    }
    hands.push_back(std::move(hand));
  }
  return hands;
}

void add_population(const PopulationRequest& request, std::uint64_t seed, LoadedStudy& study) {
  study::StudyPopulation one;
  one.sampling = request.sampling;
  const auto index = static_cast<int>(study.plan.populations.size());
  // Each population its own numbers, so that hand k of one says nothing of hand k of another.
  if (!request.has_seed) one.sampling.seed = seed + static_cast<std::uint64_t>(index);
  std::vector<population::HandSample> hands;
  if (!request.table.empty()) {
    one.population.name = std::filesystem::path(request.table).stem().string();
    // Without its folder: a study is the same wherever it lies.
    one.population.source = std::filesystem::path(request.table).filename().string();
    one.population.title = "hands of " + one.population.source;
    hands = given_hands(request.table, study.notes);
    one.sampling = {};
    one.sampling.hands = static_cast<int>(hands.size());
  } else {
    one.population = request.file.empty() ? population::population_named(request.preset)
                                          : read_population(request.file);
    hands = population::sample_hands(one.population, one.sampling);
  }
  for (const std::string& caution : one.population.cautions) {
    study.notes.push_back(one.population.name + ": " + caution);
  }
  for (population::HandSample& sample : hands)
    study.plan.hands.push_back({index, std::move(sample)});
  study.plan.populations.push_back(std::move(one));
}

/// Settings that a message names are keys, where a study file is read.
std::string advice(const std::string& text, const std::string& where) {
  if (where.empty()) return text;
  return with_setting_names(text, [](const std::string& setting) { return "the key " + setting; });
}

std::string product_name(const ProductRequest& request) {
  if (!request.name.empty()) return request.name;
  if (!request.file.empty()) return std::filesystem::path(request.file).stem().string();
  std::string name = request.made.kind;
  if (!request.made.given.empty())
    name += " " + formats::shortest(request.made.given.front().second);
  return name;
}

std::string sized_name(const std::string& name, double size) {
  return size == 1.0 ? name : name + " x " + formats::shortest(size);
}

void add_product(const ProductRequest& request, LoadedStudy& study) {
  if (is_made(request.file)) {
    ProductRequest solid = request;
    solid.made = made_from(request.file);
    solid.file = "";
    if (solid.name.empty()) solid.name = title_of(solid.made);
    return add_product(solid, study);
  }
  const std::string name = product_name(request);
  std::optional<product::Product> read;
  if (!request.file.empty()) {
    try {
      read = load_product(request.file, {.unit = request.unit});
    } catch (const InputError& error) {
      throw InputError(advice(error.what(), request.where));
    }
    for (const std::string& text : read->notes) {
      study.notes.push_back(name + ": " + advice(text, request.where));
    }
  }
  for (const double size : request.sizes) {
    study::StudyProduct one = request.held;
    one.name = sized_name(name, size);
    if (one.family.empty()) one.family = name;
    if (!read && !one.at && !one.axis && !one.holding.hold && !one.holding.toward) {
      one.holding.toward = thumb_side_of(request.made);
    }
    one.size = size;
    one.file = !read                     ? words_of(request.made)
               : request.written.empty() ? request.file
                                         : request.written;
    if (!one.posture_of.empty()) one.posture_of = sized_name(one.posture_of, size);
    product::Product product =
        read ? product::scaled(*read, size) : make_solid(request.made, {.size = size});
    product.name = one.name;
    one.content_hash = content_hash(product.mesh);
    one.unit = name_of(product.unit);
    study.plan.products.push_back(std::move(one));
    study.inputs.products.push_back(std::move(product));
  }
}

/// What a person's grip strength would be known by.
std::string lacking_for_strength(const population::HandSample& sample) {
  if (!sample.sex && !sample.age) return "sex and age are";
  if (!sample.sex) return "the sex is";
  if (!sample.age) return "the age is";
  return "the strength at that age is";
}

/// Settings that say nothing about how firmly get the usual grip force: the same for all hands and
/// products, whatever sizes and profiles there are.
void fill_in_grip_force(LoadedStudy& study) {
  grasp::HeaviestLoad heaviest;
  for (std::size_t i = 0; i < study.plan.products.size(); ++i) {
    contact::ProductLoad load;
    load.weight = product::kStandardGravity * study.plan.products[i].mass;
    heaviest.add(study.inputs.products[i], load);
  }
  std::set<std::string> words;
  for (study::StudySetting& setting : study.plan.settings) {
    if (!setting.is_balanced || setting.limit_depths) continue;
    if (grasp::says_how_firmly(setting.task)) continue;
    if (setting.grip_force || setting.strength_share) continue;
    const grasp::ShareOfStrength usual = grasp::usual_share(setting.friction, heaviest);
    setting.strength_share = usual.share;
    setting.strength = usual.strength;
    setting.least_grip_force = usual.least;
    setting.follows_product = setting.task == grasp::HandTask::kUsual;
    grasp::ShareOfStrength held = usual;
    held.holds_only = true;
    for (const std::optional<grasp::Grip>& grip : study.plan.grips) {
      const grasp::Grip told = grip.value_or(grasp::Grip::kMediumWrap);
      std::string text = fmt::format(
          "{}{}grip force {:.0f} N for all hands and products: {}",
          study.plan.settings.size() > 1 ? "setting " + setting.name + ": " : std::string(),
          grip ? "grip " + std::string(name_of(*grip)) + ": " : std::string(), usual.force(told),
          usual.words(told));
      if (setting.follows_product) {
        text += fmt::format("; {:.1f} N, {}, if thumb and fingers meet round none of them",
                            held.force(told), held.words(told));
      }
      words.insert(std::move(text));
    }
  }
  study.notes.insert(study.notes.end(), words.begin(), words.end());
}

/// Refuses shares of a grip strength that isn't known, before every grasp fails for it.
void check_strengths(const study::StudyPlan& plan) {
  for (const study::StudySetting& setting : plan.settings) {
    if (!setting.strength_share || setting.strength) continue;
    for (std::size_t p = 0; p < plan.populations.size(); ++p) {
      std::size_t hands = 0, unknown = 0;
      const population::HandSample* first = nullptr;
      for (const study::StudyHand& hand : plan.hands) {
        if (hand.population != static_cast<int>(p)) continue;
        ++hands;
        if (hand.sample.grip_strength > 0.0) continue;
        ++unknown;
        if (first == nullptr) first = &hand.sample;
      }
      if (first == nullptr) continue;
      throw UsageError("setting \"" + setting.name + "\": strength_share is " +
                       formats::shortest(*setting.strength_share) + ", but the grip strength of " +
                       std::to_string(unknown) + " of " + std::to_string(hands) +
                       " hands of population \"" + plan.populations[p].population.name +
                       "\" isn't known (hand \"" + first->label +
                       "\": " + lacking_for_strength(*first) +
                       " missing); grip_force_n, or people whose sex and age or grip_strength_n "
                       "are given, is allowed");
    }
  }
}

/// Refuses a population none of whose hands can be made, before every grasp fails for it.
void check_hands(const LoadedStudy& study) {
  constexpr std::size_t kTries = 8;
  const hand::HandInstanceMaker maker(*study.inputs.base);
  for (std::size_t p = 0; p < study.plan.populations.size(); ++p) {
    study::StudyPlan part;
    for (const study::StudyHand& hand : study.plan.hands) {
      if (hand.population == static_cast<int>(p)) part.hands.push_back(hand);
    }
    if (part.hands.empty()) continue;
    std::string why;
    try {
      maker.make(study::mean_dimensions(part));
      continue;
    } catch (const Error& error) {
      why = error.what();
    }
    // A mean of unlike people may be odd where the people are not.
    bool is_one_made = false;
    for (std::size_t i = 0; i < std::min(kTries, part.hands.size()) && !is_one_made; ++i) {
      try {
        maker.make(part.hands[i].sample.dimensions);
        is_one_made = true;
      } catch (const Error&) {
        continue;
      }
    }
    if (is_one_made) continue;
    throw UsageError("population \"" + study.plan.populations[p].population.name +
                     "\": its hands can't be made: " + why);
  }
}

}  // namespace

void check_products(const study::StudyPlan& plan, const std::filesystem::path& folder) {
  for (const study::StudyProduct& one : plan.products) {
    std::error_code error;
    if (is_made(one.file)) continue;
    bool is_found = false, is_same = false;
    for (const std::filesystem::path& path : {std::filesystem::path(one.file), folder / one.file}) {
      if (is_same || !std::filesystem::is_regular_file(path, error)) continue;
      is_found = true;
      try {
        const product::Product now = product::scaled(
            load_product(path, {.unit = geometry::length_unit(one.unit)}), one.size);
        is_same = content_hash(now.mesh) == one.content_hash;
      } catch (const InputError&) {
        continue;  // no longer a product at all
      }
    }
    if (!is_found || is_same) continue;
    throw UsageError("product \"" + one.name + "\": " + one.file +
                     " has changed since the study began; without the file resume continues with "
                     "the shape in the store");
  }
}

LoadedStudy load_study(const StudyRequest& request, std::shared_ptr<const hand::Hand> hand) {
  LoadedStudy study;
  study::StudyPlan& plan = study.plan;
  plan.name = request.name;
  plan.title = request.title.empty() ? request.name : request.title;
  plan.seed = request.seed;
  plan.hand_hash = content_hash(*hand);
  study.inputs.base = std::move(hand);
  plan.profiles = request.profiles;
  if (plan.profiles.empty()) plan.profiles.push_back({});
  plan.grips = request.grips;
  if (plan.grips.empty()) plan.grips.push_back(std::nullopt);
  plan.settings = request.settings;
  if (plan.settings.empty()) plan.settings.push_back({});
  plan.limits = request.limits;
  // Who sets a limit to what is computed only on demand wants it.
  for (const study::StudyLimit& limit : plan.limits) {
    for (study::StudySetting& setting : plan.settings) {
      setting.wrench_volume |= limit.quantity == "wrench_volume_l1";
      setting.torque |= limit.quantity == study::kHeldTorqueKey;
    }
  }
  for (const PopulationRequest& one : request.populations) {
    at_place(one.where, [&] { add_population(one, request.seed, study); });
  }
  std::vector<std::string> places;  // of the plan's products
  for (const ProductRequest& one : request.products) {
    at_place(one.where, [&] { add_product(one, study); });
    places.resize(plan.products.size(), one.where);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    at_place(places[i], [&] { study::check_product(plan, i); });
  }
  fill_in_grip_force(study);
  at_place(request.where.empty() ? "" : request.where + ": ", [&] {
    plan.check();
    check_strengths(plan);
    check_hands(study);
  });
  return study;
}

}  // namespace palmar::records
