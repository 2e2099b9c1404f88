// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/grasp_indices.h"

#include "palmar/grasp/indices/comfort.h"
#include "palmar/grasp/indices/ease.h"
#include "palmar/grasp/indices/fitness.h"
#include "palmar/study/assessment/held_torque.h"

namespace palmar::study {
namespace {

grasp::GraspIndex grip_row(const char* key, const char* name, const char* unit,
                           std::optional<double> value) {
  grasp::GraspIndex row;
  row.key = key;
  row.name = name;
  row.group = "grip";
  row.unit = unit;
  row.value = value;
  row.lowest = 0.0;
  return row;
}

grasp::GraspIndices grip_indices(const grasp::Balance& balance) {
  // A grasp that slips out is shown as it was closed: its last state on the way out says nothing.
  const bool slips = balance.status == grasp::BalanceStatus::kSlipsOut;
  const bool is_known = balance.grip_force > 0.0 && !slips;
  const auto known = [&](double value) { return is_known ? std::optional(value) : std::nullopt; };
  grasp::GraspIndices rows;

  grasp::GraspIndex force = grip_row("grip_force_n", "grip force", "N", known(balance.grip_force));
  force.definition =
      "half the sum of |normal force . e| for the direction e that makes it largest: what a "
      "dynamometer between the product's halves would read";
  force.source = "docs/method/balance.md";
  rows.push_back(force);

  grasp::GraspIndex ratio =
      grip_row("normal_over_grip_force", "sum of normal forces over grip force", "",
               known(balance.sum_of_normals / balance.grip_force));
  ratio.lowest = 2.0;
  ratio.definition =
      "2: two opposed contacts; pi: even pressure round a cylinder; people on a 51 mm handle: 2.5";
  ratio.source = "docs/method/validation.md, case G4";
  rows.push_back(ratio);

  grasp::GraspIndex rest = grip_row("unbalanced_over_grip_force", "forces left out of balance", "",
                                    known(balance.residual_share));
  rest.better = grasp::Better::kDown;
  rest.definition =
      "sum of all forces on the product (or their moment over its arm) over the grip force; below "
      "0.01 counts as at rest";
  rest.source = "docs/method/balance.md";
  rows.push_back(rest);

  grasp::GraspIndex friction =
      grip_row("friction_in_use", "friction in use at rest", "", known(balance.friction_use));
  friction.highest = 1.0;
  friction.better = grasp::Better::kDown;
  friction.definition = "sum of tangential forces over the most that friction allows";
  friction.source = "Mindlin 1949; docs/method/balance.md";
  rows.push_back(friction);

  grasp::GraspIndex strength = grip_row("flexion_strength_in_use", "share of the muscles' strength",
                                        "", slips ? std::nullopt : balance.strength_use);
  strength.better = grasp::Better::kDown;
  strength.highest = 1.0;
  strength.definition =
      "least share of the person's strength with which the muscles of fingers, thumb and wrist "
      "hold "
      "these forces and the load; 1: as hard as the hand can";
  strength.source =
      "tendons: An et al. 1979, Synek et al. 2019, Mirakhorlo et al. 2016; docs/method/balance.md";
  if (!balance.strength_use) strength.remark = "only for power grips that came to rest";
  rows.push_back(strength);
  if (!is_known) {
    for (grasp::GraspIndex& row : rows) {
      row.remark = slips ? "the product slips out; all other rows are of the hand as it was closed"
                         : "coming to rest was switched off";
    }
  }
  return rows;
}

void append(grasp::GraspIndices& rows, grasp::GraspIndices more) {
  rows.insert(rows.end(), std::make_move_iterator(more.begin()),
              std::make_move_iterator(more.end()));
}

}  // namespace

void IndexOptions::check() const {
  stability.check();
  effort.check();
}

grasp::GraspIndices grasp_indices(const hand::Hand& hand, const product::Product& product,
                                  const HeldProductState& held, const Vec3& mass_centre,
                                  const IndexOptions& options) {
  grasp::GraspIndices rows;
  if (!options.is_on) return rows;
  options.check();
  append(rows, grip_indices(held.balance));
  append(rows, grasp::to_indices(
                   grasp::assess_stability(hand, held.contact, mass_centre, options.stability)));
  append(rows, grasp::to_indices(grasp::assess_ease(
                   hand.skeleton, held.grasp.posture,
                   options.coordination ? *options.coordination
                                        : grasp::built_in_coordination(hand.skeleton))));
  append(rows, grasp::to_indices(grasp::assess_fitness(
                   hand, held.posed_skin, held.grasp.product_from_hand, *product.distance)));
  append(rows, grasp::to_indices(grasp::assess_comfort(hand, held.contact)));
  contact::FrictionResult friction;
  const hand::HandLoad* at_rest = nullptr;
  if (held.balance.status != grasp::BalanceStatus::kSlipsOut) {
    friction.force = held.balance.friction_force;
    if (held.balance.joint_load) at_rest = &*held.balance.joint_load;
  }
  append(rows, effort::effort_indices(effort::assess_effort(
                   hand, held.grasp.posture, held.contact, held.grasp.product_from_hand,
                   *product.distance, options.effort, friction.force.empty() ? nullptr : &friction,
                   at_rest)));
  return rows;
}

const grasp::GraspIndices& index_catalogue() {
  static const grasp::GraspIndices catalogue = [] {
    grasp::GraspIndices rows;
    append(rows, grip_indices({}));
    grasp::StabilityResult stability;  // with everything that is optional
    stability.linf.norm = grasp::WrenchNorm::kLinf;
    stability.volume.emplace();
    stability.grip.emplace();
    append(rows, grasp::to_indices(stability));
    rows.push_back(held_torque_index(0.0));
    append(rows, grasp::to_indices(grasp::EaseResult{}));
    append(rows, grasp::to_indices(grasp::FitnessResult{}));
    append(rows, grasp::to_indices(grasp::ComfortResult{}));
    append(rows, effort::effort_indices(effort::EffortResult{}));
    for (grasp::GraspIndex& row : rows) {
      row.value.reset();
      row.remark.clear();
    }
    return rows;
  }();
  return catalogue;
}

}  // namespace palmar::study
