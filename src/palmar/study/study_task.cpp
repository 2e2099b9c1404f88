// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "palmar/contact/footprint/footprint.h"
#include "palmar/contact/hand_family.h"
#include "palmar/contact/refine/refined_contact.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/rest/hold_at_rest.h"
#include "palmar/grasp/rest/place_at_rest.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/grasp/rest/usual_task.h"
#include "palmar/grasp/task_force.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/product/gloved.h"
#include "palmar/product/mass.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/study/grasp_demand.h"

namespace palmar::study {
namespace {

constexpr double kWholeTriangles = 1000.0;  // mm; longer than any edge of a map: none is split

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Why a grasp has no result, for its record.
struct Failure {
  std::string reason;
};

/// A grasp at rest, to be evaluated.
struct HeldGrasp {
  grasp::Grasp grasp;
  grasp::Balance balance;
};

StudyOutcome outcome_of(const HeldGrasp& held) {
  switch (held.grasp.status) {
    case grasp::GraspStatus::kTooLarge:
      return StudyOutcome::kTooLarge;
    case grasp::GraspStatus::kTooSmall:
      return StudyOutcome::kTooSmall;
    case grasp::GraspStatus::kNotGraspable:
      return StudyOutcome::kNotGraspable;
    case grasp::GraspStatus::kHeld:
    case grasp::GraspStatus::kPartlyHeld:
      break;
  }
  if (held.balance.status == grasp::BalanceStatus::kSlipsOut) return StudyOutcome::kSlipsOut;
  return held.grasp.status == grasp::GraspStatus::kHeld ? StudyOutcome::kHeld
                                                        : StudyOutcome::kPartlyHeld;
}

bool is_held(const grasp::Grasp& grasp) {
  return grasp.status == grasp::GraspStatus::kHeld ||
         grasp.status == grasp::GraspStatus::kPartlyHeld;
}

void take_contact(const contact::ContactResult& contact, StudyRecord& record) {
  record.force = contact.total.force;
  record.area = contact.total.area;
  record.peak_pressure = contact.total.peak_pressure;
  record.peak_pressure_cells = contact.total.peak_pressure_cells;
  record.mean_pressure = contact.total.mean_pressure;
  for (const contact::RegionContact& region : contact.regions) {
    record.regions.push_back({.region = region.region,
                              .force = region.force,
                              .area = region.area,
                              .peak_pressure = region.peak_pressure,
                              .peak_pressure_cells = region.peak_pressure_cells,
                              .mean_pressure = region.mean_pressure});
  }
}

/// Somebody as strong as usual.
population::HandSample usual_person() {
  population::HandSample person;
  person.grip_strength = grasp::usual_grip_strength();
  return person;
}

bool is_finite(const StudyRecord& record) {
  for (const double value : {record.force, record.grip_force, record.area, record.peak_pressure,
                             record.peak_pressure_cells, record.mean_pressure,
                             record.demand.range_share, record.demand.nail_room}) {
    if (!std::isfinite(value)) return false;
  }
  return !std::isnan(record.demand.grip_strength);  // infinite: no strength holds the load
}

}  // namespace

namespace {

std::shared_ptr<const hand::Hand> with_range_of(const std::shared_ptr<const hand::Hand>& hand,
                                                const population::HandProfile& profile) {
  if (profile.range_share == 1.0) return hand;
  return std::make_shared<const hand::Hand>(
      population::with_range_share(*hand, profile.range_share));
}

}  // namespace

struct StudyBench::Impl {
  static const hand::Hand& base_of(const StudyInputs& inputs) {
    if (inputs.base == nullptr) throw UsageError("study: has no hand to scale");
    return *inputs.base;
  }
  Impl(const StudyPlan& the_plan, const StudyInputs& the_inputs, StudyDetail the_detail)
      : plan(the_plan), inputs(the_inputs), detail(the_detail), maker(base_of(the_inputs)) {
    plan.check();
    if (inputs.products.size() != plan.products.size()) {
      throw UsageError(fmt::format("study: {} products were given; the plan has {}",
                                   inputs.products.size(), plan.products.size()));
    }
    const bool has_maps = detail == StudyDetail::kAll;
    for (const product::Product& product : inputs.products) {
      if (has_maps) maps.push_back(product_map(product.mesh));
    }
    for (const population::HandProfile& profile : plan.profiles) {
      std::vector<product::Product> as_touched;
      std::vector<geometry::TriangleMesh> touched_maps;
      if (profile.glove_thickness > 0.0) {
        for (std::size_t i = 0; i < inputs.products.size(); ++i) {
          as_touched.push_back(product::gloved(inputs.products[i], profile.glove_thickness));
          if (!has_maps) continue;
          product::Product map = inputs.products[i];
          map.mesh = maps[i];
          touched_maps.push_back(product::gloved(map, profile.glove_thickness).mesh);
        }
      }
      gloved_products.push_back(std::move(as_touched));
      gloved_maps.push_back(std::move(touched_maps));
    }
    for (const StudyProduct& product : plan.products) {
      std::optional<std::size_t> source;
      for (std::size_t i = 0; i < plan.products.size(); ++i) {
        if (!product.posture_of.empty() && plan.products[i].name == product.posture_of) source = i;
      }
      posture_source.push_back(source);
    }
  }

  /// A person's hand under a profile, with its whole range of motion.
  std::shared_ptr<const hand::Hand> make_hand(const population::HandSample& person,
                                              const population::HandProfile& profile) const {
    return std::make_shared<const hand::Hand>(
        maker.make(population::with_profile(person, profile).dimensions).hand);
  }
  /// The product for the skin: inside a glove it is thicker.
  const product::Product& product_for(int profile, int product) const {
    const auto& in_glove = gloved_products[profile];
    return (in_glove.empty() ? inputs.products : in_glove)[product];
  }
  const geometry::TriangleMesh& map_for(int profile, int product) const {
    const auto& in_glove = gloved_maps[profile];
    return (in_glove.empty() ? maps : in_glove)[product];
  }

  grasp::GraspOptions grasp_options(const StudyTask& task) const {
    const StudyProduct& product = plan.products[task.product];
    const StudySetting& setting = plan.settings[task.setting];
    grasp::GraspOptions options;
    options.grip = plan.grips[task.grip];
    options.power.palm_limit_depth = setting.palm_limit_depth;
    options.power.finger_limit_depth = setting.finger_limit_depth;
    if (product.at) options.power.placement.at = product.size * *product.at;
    options.power.placement.axis = product.axis;
    options.precision.placement = options.power.placement;
    product.holding.apply_to(options);
    const auto index = static_cast<std::size_t>(task.product);
    // Inside a glove a product is another, thicker one.
    const bool has_glove = plan.profiles[task.profile].glove_thickness > 0.0;
    if (index < inputs.parts.size() && !has_glove) options.parts = inputs.parts[index];
    if (!product.holding.number) options.grip_force = setting.grip_force;
    return options;
  }

  /// Of the product, N. Throws InputError where one is held that encloses no volume.
  double weight_of(const StudyTask& task) const {
    const grasp::RestSettings what{.task = plan.settings[task.setting].task};
    const double mass = plan.products[task.product].mass;
    if (!grasp::holds_load(what.task)) return mass * product::kStandardGravity;
    grasp::FrictionSettings given;
    if (mass > 0.0) given.mass = mass;
    return what.load(given).options_for(inputs.products[task.product]).load.weight;
  }

  /// How a person does a task.
  AssessOptions options_of(const StudyTask& task, const population::HandSample& person) const {
    const StudySetting& setting = plan.settings[task.setting];
    const population::HandProfile& profile = plan.profiles[task.profile];
    AssessOptions options;
    options.grasp = grasp_options(task);
    options.seed = plan.seed;
    options.footprint = false;  // the study's own map serves
    options.indices.is_on = setting.indices;
    options.indices.stability.with_volume = setting.wrench_volume;
    options.indices.torque = setting.torque;
    options.contact.refine = setting.refine;

    if (profile.glove_thickness > 0.0) {
      contact::Coating glove;
      glove.thickness = profile.glove_thickness;
      glove.shear_modulus = profile.glove_shear_modulus;
      options.contact.coatings.push_back(glove);
    }
    options.balance.is_on = setting.is_balanced;
    options.balance.friction = setting.friction;
    options.balance.load.weight = weight_of(task);
    options.balance.grip_force = setting.grip_force;
    options.balance.holds_load = grasp::holds_load(setting.task);
    if (setting.turn) options.balance.turn = 1e3 * *setting.turn;
    // The person's own muscles, before a profile weakens them: whose share a grasp takes is judged
    // afterwards, alike for all profiles (exclusion.h).
    if (person.grip_strength > 0.0) {
      options.balance.strength =
          std::clamp(person.grip_strength / grasp::usual_grip_strength(), 0.01, 10.0);
    }
    if (setting.strength_share) {
      if (!setting.strength && !(person.grip_strength > 0.0)) {
        throw Failure{"a share of the grip strength is requested, but the person's isn't known"};
      }
      options.balance.share_of_strength =
          share_of_strength(setting, population::with_profile(person, profile).grip_strength);
      options.balance.share_of_strength->holds_only =
          setting.follows_product && holds_only[task.setting];
    }
    return options;
  }

  const StudyPlan& plan;
  const StudyInputs& inputs;
  StudyDetail detail;
  std::vector<geometry::TriangleMesh> maps;  ///< with StudyDetail::kAll
  // By profile and product; empty for a bare hand.
  std::vector<std::vector<product::Product>> gloved_products;
  std::vector<std::vector<geometry::TriangleMesh>> gloved_maps;
  std::vector<std::optional<std::size_t>> posture_source;  ///< product whose posture one keeps
  hand::HandInstanceMaker maker;
  /// What hands of one mesh share when they are prepared, by equations.
  std::vector<std::pair<contact::ContactModel, std::shared_ptr<const contact::HandFamily>>>
      families;

  const contact::HandFamily* family_of(const contact::ContactModel& model) const {
    for (const auto& [known, family] : families) {
      if (known == model) return family.get();
    }
    return nullptr;
  }

  /// Where the mean hand holds a product, or why that can't be said.
  struct Place {
    std::unique_ptr<const grasp::GraspPlace> place;
    std::shared_ptr<const grasp::HoldAtRest> at_rest;  ///< that hand's, if it is a wrap
    std::string failure;
    bool is_settled = false;  ///< take_holds_at_rest() has looked at it
  };
  std::vector<std::shared_ptr<const hand::Hand>> mean_hands;  ///< by profile; null: not needed
  std::vector<std::string> mean_failures;                     ///< by profile
  std::map<StudyTask, Place> places;                          ///< by task, of hand 0
  /// Mean hands made ready, by profile and setting.
  std::map<std::pair<int, int>, std::unique_ptr<const contact::PreparedHand>> prepared_means;
  std::vector<bool> holds_only;  ///< by setting: products are only held (grasp::UsualTask)

  /// The places that have to be known before one, and that itself: the first product's, that of
  /// the same product under the first profile.
  std::vector<StudyTask> places_for(const StudyTask& place) const;
  /// How the mean hand takes a product there: under other profiles as under the first, other
  /// products like the first where that is as good.
  grasp::GraspOptions place_options(const StudyTask& key) const;
  /// First the first product's, then each product's under the first profile, then the others':
  /// what looks to another comes after it.
  std::vector<std::pair<const StudyTask, Place>*> places_of_wave(int wave);
  void find_places(int wave, const Progress& progress);
  /// Where nothing says which hold it is to be, and the mean hand doesn't come to rest in the one
  /// that was found, takes the next one.
  void take_holds_at_rest(int wave, const Progress& progress);
  const contact::PreparedHand& prepared_mean(const StudyTask& task);
  /// Says what hands do with the products where nothing is said (holds_only).
  void settle_usual_tasks();
  /// Lets the mean hands come to rest on the products.
  void rest_mean_hands(const Progress& progress);

  /// The task that stands for all hands.
  StudyTask place_key(StudyTask task) const {
    task.hand = 0;
    if (const auto source = posture_source[task.product]) {
      task.product = static_cast<int>(*source);
    }
    return task;
  }
};

namespace {

/// One hand under one profile; prepared for the equations that were asked for so far.
class StudySubject {
 public:
  StudySubject(const StudyBench::Impl& bench, int hand, int profile)
      : bench_(bench),
        sample_(bench.plan.hands[hand].sample),
        profile_(bench.plan.profiles[profile]) {
    try {
      whole_range_ = bench.make_hand(sample_, profile_);
      hand_ = with_range_of(whole_range_, profile_);
      grasping_ = std::make_unique<const grasp::GraspingHand>(hand_);
    } catch (const Error& error) {
      failure_ = std::string("the hand can't be made: ") + error.what();
    }
  }

  StudyRecord run(const StudyTask& task, const Progress& progress) {
    if (!failure_.empty()) throw Failure{failure_};
    const StudySetting& setting = bench_.plan.settings[task.setting];
    const int product_index = task.product;
    const product::Product& product = bench_.product_for(task.profile, task.product);
    const contact::PreparedHand& prepared = prepared_for(setting.model);

    AssessOptions options = bench_.options_of(task, sample_);
    HeldGrasp held;
    if (const auto source = bench_.posture_source[product_index]) {
      StudyTask other = task;
      other.product = static_cast<int>(*source);
      held = at_rest(prepared, other, bench_.options_of(other, sample_), progress);
      held.balance = {};  // at rest is the other product
      options.balance.is_on = false;
    } else {
      held = at_rest(prepared, task, options, progress);
    }

    StudyRecord record;
    record.outcome = outcome_of(held);
    record.grip = held.grasp.grip;
    if (held.grasp.hold) {
      record.hold = StudyHold{*held.grasp.hold, held.grasp.hold_kind, held.grasp.hold_words};
    }
    record.posture = held.grasp.posture;
    record.product_from_hand = held.grasp.product_from_hand;
    record.is_balanced = held.balance.status == grasp::BalanceStatus::kBalanced ||
                         held.balance.status == grasp::BalanceStatus::kSupported;
    if (record.outcome != StudyOutcome::kHeld) record.reason = held.grasp.message;
    if (!is_held(held.grasp)) return record;
    if (options.balance.is_on && !record.is_balanced) record.reason = held.balance.message;

    const Assessment assessment =
        evaluate(prepared, product, held.grasp, options, progress, held.balance);
    const contact::ContactResult& contact = assessment.contact;
    if (contact.status == contact::ContactStatus::kNotConverged) {
      throw Failure{"contact: " + contact.message};
    }
    take_contact(contact, record);
    record.fallbacks = held.balance.fallbacks;
    record.fallbacks += contact.fallbacks;
    if (contact.total.force > 0.0) {
      record.grip_force = record.is_balanced ? held.balance.grip_force
                                             : grasp::grip_force(contact, *product.distance).force;
    }
    const bool has_fields = bench_.detail == StudyDetail::kAll;
    if (has_fields) record.skin_pressure = sparse(contact.pressure);
    if (has_fields && contact.total.force > 0.0) {
      const geometry::TriangleMesh& map = bench_.map_for(task.profile, task.product);
      record.product_pressure =
          sparse(contact::map_to_product(contact.refined ? *contact.refined->hand : prepared.hand(),
                                         contact.refined ? contact.refined->contact : contact, map,
                                         kWholeTriangles)
                     .pressure);
    }
    if (contact.total.force > 0.0) {
      record.demand = demand_of(*whole_range_, product,
                                {held.grasp, held.balance, contact, assessment.posed_skin},
                                {.friction = setting.friction,
                                 .load = options.balance.load,
                                 .mass_centre = geometry::centre_of_volume(product.mesh),
                                 .grip = record.grip,
                                 .stated_force = setting.grip_force.value_or(0.0),
                                 .muscle_strength = options.balance.strength});
    }
    for (const grasp::GraspIndex& index : assessment.indices) {
      if (index.value && std::isfinite(*index.value)) {
        record.indices.push_back({index.key, *index.value});
      }
    }
    if (!is_finite(record)) throw Failure{"a result is no number"};
    return record;
  }

 private:
  const contact::PreparedHand& prepared_for(const contact::ContactModel& model) {
    for (const auto& [known, prepared] : prepared_) {
      if (known == model) return *prepared;
    }
    const contact::HandFamily* family = bench_.family_of(model);
    prepared_.emplace_back(
        model, family != nullptr ? std::make_unique<const contact::PreparedHand>(hand_, *family)
                                 : std::make_unique<const contact::PreparedHand>(hand_, model));
    return *prepared_.back().second;
  }

  /// The grasp of a task that doesn't keep another one's posture, come to rest. Kept where another
  /// product wants the same posture.
  HeldGrasp at_rest(const contact::PreparedHand& prepared, const StudyTask& task,
                    const AssessOptions& options, const Progress& progress) {
    const auto known = at_rest_.find(task);
    if (known != at_rest_.end()) return known->second;
    const auto index = static_cast<std::size_t>(task.product);
    const product::Product& product = bench_.product_for(task.profile, task.product);
    const StudySetting& setting = bench_.plan.settings[task.setting];
    const StudyTask key = bench_.place_key(task);
    HeldGrasp held;
    if (setting.is_place_per_hand) {
      held.grasp = grasp::find_grasp(prepared.hand(), product, options.grasp, progress);
    } else {
      const StudyBench::Impl::Place& place = bench_.places.at(key);
      if (place.place == nullptr) throw Failure{place.failure};
      held.grasp = place.place->hold(*grasping_, progress);
    }
    if (is_held(held.grasp)) {
      grasp::BalanceOptions balance = options.balance;
      if (!setting.is_place_per_hand) balance.like = bench_.places.at(key).at_rest;
      held.balance =
          grasp::balance_grasp(prepared, product, held.grasp, balance, options.contact, progress);
      if (held.balance.status == grasp::BalanceStatus::kSlipsOut) {
        held.grasp.message += "; but it " + held.balance.message;
      }
    }
    for (const auto& source : bench_.posture_source) {
      if (source == index) at_rest_[task] = held;
    }
    return held;
  }

  const StudyBench::Impl& bench_;
  const population::HandSample& sample_;
  const population::HandProfile& profile_;
  std::shared_ptr<const hand::Hand> whole_range_, hand_;
  std::unique_ptr<const grasp::GraspingHand> grasping_;
  std::string failure_;
  std::vector<std::pair<contact::ContactModel, std::unique_ptr<const contact::PreparedHand>>>
      prepared_;
  std::map<StudyTask, HeldGrasp> at_rest_;
};

}  // namespace

StudyBench::StudyBench(const StudyPlan& plan, const StudyInputs& inputs, StudyDetail detail)
    : impl_(std::make_unique<Impl>(plan, inputs, detail)) {}
StudyBench::~StudyBench() = default;

void StudyBench::prepare(std::span<const std::int64_t> tasks, const Progress& progress) {
  Impl& bench = *impl_;
  for (const StudySetting& setting : bench.plan.settings) {
    progress.throw_if_cancelled();
    if (bench.family_of(setting.model) != nullptr) continue;
    const auto& known = bench.inputs.family;
    bench.families.emplace_back(
        setting.model, known != nullptr && known->model() == setting.model
                           ? known
                           : std::make_shared<const contact::HandFamily>(
                                 bench.inputs.base, setting.model, bench.inputs.compliance));
  }
  const std::size_t profiles = bench.plan.profiles.size();
  std::vector<bool> is_needed(profiles, false);
  const auto need = [&](std::int64_t number, bool for_all) {
    const StudyTask task = task_at(bench.plan, number);
    const StudySetting& setting = bench.plan.settings[task.setting];
    if (setting.is_place_per_hand || (for_all && !setting.follows_product)) return;
    for (const StudyTask& place : bench.places_for(bench.place_key(task))) {
      bench.places[place];
      is_needed[place.profile] = true;
    }
  };
  for (const std::int64_t number : tasks) need(number, false);
  // What is usual is said of all products, whichever are still to be run.
  const auto hands = static_cast<std::int64_t>(bench.plan.hands.size());
  for (std::int64_t n = 0; n < task_count(bench.plan) / std::max<std::int64_t>(1, hands); ++n) {
    need(n, true);
  }
  bench.mean_hands.resize(profiles);
  bench.mean_failures.resize(profiles);
  population::HandSample mean;
  mean.dimensions = mean_dimensions(bench.plan);
  parallel_for(static_cast<int>(profiles), [&](int p) {
    if (!is_needed[p] || bench.mean_hands[p] != nullptr) return;
    try {
      const population::HandProfile& asked = bench.plan.profiles[p];
      bench.mean_hands[p] = with_range_of(bench.make_hand(mean, asked), asked);
    } catch (const Error& error) {
      bench.mean_failures[p] = std::string("the mean hand can't be made: ") + error.what();
    }
  });
  for (const int wave : {0, 1, 2}) {
    bench.find_places(wave, progress);
    bench.settle_usual_tasks();
    bench.take_holds_at_rest(wave, progress);
  }
  bench.rest_mean_hands(progress);
}

std::vector<StudyTask> StudyBench::Impl::places_for(const StudyTask& place) const {
  StudyTask bare = place;
  bare.profile = 0;
  StudyTask first = bare;
  first.product = 0;
  return {place_key(first), bare, place};
}

grasp::GraspOptions StudyBench::Impl::place_options(const StudyTask& key) const {
  grasp::GraspOptions options = grasp_options(key);
  if (options.hold || options.is_placed()) return options;
  const bool is_numbered =
      plan.products[static_cast<std::size_t>(key.product)].holding.number.has_value();
  const std::vector<StudyTask> others = places_for(key);
  const auto grasp_of = [&](const StudyTask& other) -> const grasp::Grasp* {
    const auto found = places.find(other);
    if (other == key || found == places.end() || found->second.place == nullptr) return nullptr;
    return &found->second.place->reference_grasp();
  };
  if (const grasp::Grasp* bare = grasp_of(others[1]); bare != nullptr && bare->hold) {
    options.hold = bare->hold;  // whatever the profile
  } else if (const grasp::Grasp* first = grasp_of(others[0]);
             first != nullptr && first->hold && !is_numbered) {
    options.holds.like = first->product_from_hand.rotation;
  }
  return options;
}

std::vector<std::pair<const StudyTask, StudyBench::Impl::Place>*> StudyBench::Impl::places_of_wave(
    int wave) {
  std::vector<std::pair<const StudyTask, Place>*> list;
  for (auto& entry : places) {
    const std::vector<StudyTask> before = places_for(entry.first);
    const int own = entry.first == before[0] ? 0 : entry.first == before[1] ? 1 : 2;
    if (own == wave) list.push_back(&entry);
  }
  return list;
}

void StudyBench::Impl::find_places(int wave, const Progress& progress) {
  const std::vector<std::pair<const StudyTask, Place>*> open = places_of_wave(wave);
  parallel_for(static_cast<int>(open.size()), [&](int i) {
    auto& [task, place] = *open[i];
    if (place.place != nullptr || !place.failure.empty()) return;
    if (mean_hands[task.profile] == nullptr) {
      place.failure = mean_failures[task.profile];
      return;
    }
    run_isolated([&, &key = task, &found = place] {
      try {
        found.place = std::make_unique<const grasp::GraspPlace>(
            *mean_hands[key.profile], product_for(key.profile, key.product), place_options(key),
            progress);
      } catch (const Cancelled&) {
        throw;
      } catch (const Error& error) {
        found.failure = std::string("no place on the product for the mean hand: ") + error.what();
      }
    });
  });
}

const contact::PreparedHand& StudyBench::Impl::prepared_mean(const StudyTask& task) {
  auto& hand = prepared_means[{task.profile, task.setting}];
  if (hand == nullptr) {
    hand = std::make_unique<const contact::PreparedHand>(
        mean_hands[task.profile], *family_of(plan.settings[task.setting].model));
  }
  return *hand;
}

void StudyBench::Impl::take_holds_at_rest(int wave, const Progress& progress) {
  std::vector<std::pair<const StudyTask, Place>*> open = places_of_wave(wave);
  std::erase_if(open, [&](const auto* entry) {
    const auto& [task, found] = *entry;
    return found.is_settled || found.place == nullptr || !place_options(task).leaves_hold_open() ||
           !plan.settings[task.setting].is_balanced;
  });
  for (auto* entry : open) prepared_mean(entry->first);
  parallel_for(static_cast<int>(open.size()), [&](int i) {
    auto& [task, place] = *open[i];
    place.is_settled = true;
    run_isolated([&, &key = task, &found = place] {
      const contact::PreparedHand& hand = *prepared_means.at({key.profile, key.setting});
      const product::Product& product = product_for(key.profile, key.product);
      const AssessOptions options = options_of(key, usual_person());
      const std::string flaw = grasp::flaw_at_rest(hand, product, found.place->reference_grasp(),
                                                   options.balance, options.contact, progress);
      if (flaw.empty()) return;
      auto other = grasp::other_place_at_rest(hand, product, *found.place, flaw, options.grasp,
                                              options.balance, options.contact, progress);
      if (other) found.place = std::make_unique<const grasp::GraspPlace>(std::move(*other));
    });
  });
}

void StudyBench::Impl::settle_usual_tasks() {
  holds_only.assign(plan.settings.size(), false);
  for (std::size_t s = 0; s < plan.settings.size(); ++s) {
    std::vector<std::optional<grasp::UsualTask>> usual;
    for (const auto& [task, found] : places) {
      if (task.setting != static_cast<int>(s) || found.place == nullptr) continue;
      usual.push_back(grasp::usual_task(product_for(task.profile, task.product),
                                        found.place->reference_grasp(),
                                        mean_hands[task.profile]->dimensions.hand_length));
    }
    holds_only[s] = grasp::task_of_all(usual) == grasp::UsualTask::kHold;
  }
}

void StudyBench::Impl::rest_mean_hands(const Progress& progress) {
  const population::HandSample mean = usual_person();
  std::vector<std::pair<const StudyTask, Place>*> open;
  for (auto& entry : places) {
    const auto& [task, found] = entry;
    if (found.place == nullptr || found.at_rest != nullptr) continue;
    const grasp::Grasp& grasp = found.place->reference_grasp();
    const grasp::BalanceOptions options = options_of(task, mean).balance;
    const bool is_asked = options.is_on && (options.asked_grip_force(grasp.grip) || options.turn);
    if (!is_asked || !grasp::is_by_whole_hand(grasp.grip)) continue;
    open.push_back(&entry);
    prepared_mean(task);
  }
  parallel_for(static_cast<int>(open.size()), [&](int i) {
    auto& [task, place] = *open[i];
    run_isolated([&, &key = task, &found = place] {
      const AssessOptions options = options_of(key, mean);
      found.at_rest = grasp::hold_at_rest(
          *prepared_means.at({key.profile, key.setting}), product_for(key.profile, key.product),
          found.place->reference_grasp(), options.balance, options.contact, progress);
    });
  });
  prepared_means.clear();
}

void StudyBench::run_hand(int hand, std::span<const std::int64_t> tasks,
                          const std::function<void(const StudyRecord&)>& keep,
                          const Progress& progress) {
  std::unique_ptr<StudySubject> subject;
  int profile = -1;
  for (const std::int64_t number : tasks) {
    progress.throw_if_cancelled();
    const auto start = Clock::now();
    const StudyTask task = task_at(impl_->plan, number);
    StudyRecord record;
    try {
      if (task.profile != profile) {
        subject.reset();
        subject = std::make_unique<StudySubject>(*impl_, hand, task.profile);
        profile = task.profile;
      }
      record = subject->run(task, progress);
    } catch (const Cancelled&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;  // says something of the machine, nothing of the grasp
    } catch (const Failure& failure) {
      record = {};
      record.reason = failure.reason;
    } catch (const std::exception& error) {
      record = {};
      record.reason = error.what();
    }
    record.number = number;
    record.seconds = seconds_since(start);
    keep(record);
  }
}

std::vector<hand::SizedDimension> mean_dimensions(const StudyPlan& plan) {
  std::map<hand::HandDimension, std::pair<double, std::size_t>> sums;
  for (const StudyHand& hand : plan.hands) {
    for (const hand::SizedDimension& one : hand.sample.dimensions) {
      auto& [sum, count] = sums[one.dimension];
      sum += one.value;
      ++count;
    }
  }
  std::vector<hand::SizedDimension> means;
  for (const auto& [dimension, total] : sums) {
    if (total.second != plan.hands.size()) continue;
    means.push_back({dimension, total.first / static_cast<double>(total.second)});
  }
  return means;
}

SparseField sparse(const std::vector<double>& field) {
  SparseField result;
  for (std::size_t v = 0; v < field.size(); ++v) {
    const auto value = static_cast<float>(field[v]);
    if (value == 0.0F) continue;
    result.vertex.push_back(static_cast<int>(v));
    result.value.push_back(value);
  }
  return result;
}

std::vector<double> dense(const SparseField& field, std::size_t size) {
  std::vector<double> result(size, 0.0);
  for (std::size_t i = 0; i < field.vertex.size(); ++i) {
    const auto v = static_cast<std::size_t>(field.vertex[i]);
    if (v >= size) {
      throw UsageError(fmt::format("field: names vertex {}; the mesh has {}", v, size));
    }
    result[v] = field.value[i];
  }
  return result;
}

}  // namespace palmar::study
