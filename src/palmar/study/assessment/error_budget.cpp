// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/error_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::study {
namespace {

ErrorCase figures_of(ErrorSource source, std::string changed, const contact::ContactResult& contact,
                     const product::Product& product) {
  ErrorCase one{.source = source, .changed = std::move(changed), .failure = {}};
  if (contact.status == contact::ContactStatus::kNotConverged) {
    one.failure = contact.message;
  } else if (!(contact.total.force > 0.0)) {
    one.failure = "nothing is touched";
  }
  if (!one.failure.empty()) return one;
  one.grip_force = grasp::grip_force(contact, *product.distance).force;
  one.force = contact.total.force;
  one.area = contact.total.area;
  one.peak_pressure = contact.total.peak_pressure;
  one.peak_pressure_cells = contact.total.peak_pressure_cells;
  one.mean_pressure = contact.total.mean_pressure;
  return one;
}

/// Figures times what `nominal` has over `usual`: a change that was found on another model.
void scale_by(const ErrorCase& nominal, const ErrorCase& usual, ErrorCase& one) {
  for (double ErrorCase::*figure :
       {&ErrorCase::grip_force, &ErrorCase::force, &ErrorCase::area, &ErrorCase::peak_pressure,
        &ErrorCase::peak_pressure_cells, &ErrorCase::mean_pressure}) {
    if (usual.*figure > 0.0) one.*figure *= nominal.*figure / usual.*figure;
  }
}

std::shared_ptr<const hand::Hand> with_tissue(const hand::Hand& hand, hand::TissueLevel level) {
  auto other = std::make_shared<hand::Hand>(hand);
  for (hand::RegionTissue& tissue : other->tissue.region) {
    tissue.half_space.nominal = hand::law_at(tissue.half_space, level);
    tissue.layered.nominal = hand::law_at(tissue.layered, level);
    tissue.on_bone.nominal = hand::law_at(tissue.on_bone, level);
  }
  return other;
}

/// MCP flexion of the fingers by `angle` more and PIP flexion by as much less, within their range.
hand::Posture bent(const hand::Skeleton& skeleton, hand::Posture posture, double angle) {
  constexpr std::array kMcp = {hand::Dof::kIndexMcpFlexion, hand::Dof::kMiddleMcpFlexion,
                               hand::Dof::kRingMcpFlexion, hand::Dof::kLittleMcpFlexion};
  constexpr std::array kPip = {hand::Dof::kIndexPipFlexion, hand::Dof::kMiddlePipFlexion,
                               hand::Dof::kRingPipFlexion, hand::Dof::kLittlePipFlexion};
  for (std::size_t f = 0; f < kMcp.size(); ++f) {
    posture[kMcp[f]] += angle;
    posture[kPip[f]] -= angle;
  }
  return hand::clamp_to_range(skeleton, posture).posture;
}

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::array<std::string_view, 5> kNames = {"tissue", "bone", "mesh", "friction",
                                                      "posture"};
  return kNames[index_of(source)];
}

hand::Hand split_skin(const hand::Hand& hand, std::vector<Vec3>& points) {
  hand::Hand fine;
  fine.name = hand.name;
  fine.side = hand.side;
  fine.region = hand.region;
  fine.segment = hand.segment;
  fine.skeleton = hand.skeleton;
  fine.bones = hand.bones;
  fine.dimensions = hand.dimensions;
  fine.tissue = hand.tissue;
  fine.skin.vertices = hand.skin.vertices;
  std::map<std::pair<int, int>, int> middle;
  const auto between = [&](int a, int b) {
    const auto [at, is_new] = middle.try_emplace({std::min(a, b), std::max(a, b)},
                                                 static_cast<int>(fine.skin.vertices.size()));
    if (is_new) {
      const int first = std::min(a, b);
      fine.skin.vertices.emplace_back(0.5 * (hand.skin.vertices[a] + hand.skin.vertices[b]));
      points.emplace_back(0.5 * (points[a] + points[b]));
      fine.region.push_back(hand.region[first]);
      fine.segment.push_back(hand.segment[first]);
    }
    return at->second;
  };
  for (const auto& [a, b, c] : hand.skin.triangles) {
    const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
      fine.skin.triangles.push_back(t);
    }
  }
  return fine;
}

ErrorBudget error_budget(const std::shared_ptr<const hand::Hand>& hand,
                         const contact::PreparedHand& prepared, const product::Product& product,
                         const grasp::Grasp& closed, const Assessment& nominal,
                         const ErrorBudgetOptions& options, const Progress& progress) {
  ErrorBudget budget;
  budget.nominal = figures_of({}, "", nominal.contact, product);
  if (!budget.nominal.failure.empty()) return budget;
  AssessOptions usual = nominal.options;
  usual.contact.error_band = false;
  constexpr int kSteps = 8;
  const auto step = [&](int done, const std::string& what) {
    progress.update(static_cast<double>(done) / kSteps, "error budget: " + what);
  };
  Progress quiet = progress;
  quiet.report = nullptr;
  const auto hold_again = [&](ErrorSource source, std::string changed,
                              const contact::PreparedHand& with, const grasp::Grasp& grasp,
                              const AssessOptions& how) {
    grasp::Grasp at_rest = grasp;
    const grasp::Balance balance =
        grasp::balance_grasp(with, product, at_rest, how.balance, how.contact, quiet);
    if (balance.status == grasp::BalanceStatus::kSlipsOut ||
        balance.status == grasp::BalanceStatus::kFailed) {
      budget.cases.push_back(
          {.source = source, .changed = std::move(changed), .failure = balance.message});
      return;
    }
    const contact::ContactResult contact =
        contact::solve_hand_contact(with, hand::pose_skin(with.hand(), at_rest.posture),
                                    at_rest.product_from_hand, *product.distance, how.contact);
    budget.cases.push_back(figures_of(source, std::move(changed), contact, product));
  };

  int done = 0;
  const contact::ContactModel& model = prepared.model();
  const auto compliance = [&]() -> std::shared_ptr<const contact::SkinCompliance> {
    return options.compliance ? options.compliance(*hand) : nullptr;
  };
  const std::shared_ptr<const contact::SkinCompliance> own =
      model.tissue == contact::TissueModel::kBone ? compliance() : nullptr;
  for (const auto& [level, name] : {std::pair{hand::TissueLevel::kLow, "soft tissue"},
                                    {hand::TissueLevel::kHigh, "stiff tissue"}}) {
    step(done++, name);
    if (usual.contact.shear_modulus) {
      budget.cases.push_back({.source = ErrorSource::kTissue,
                              .changed = name,
                              .failure = "one shear modulus was given"});
      continue;
    }
    hold_again(ErrorSource::kTissue, name,
               contact::PreparedHand(with_tissue(*hand, level), model, own), closed, usual);
  }

  const bool is_on_bone = model.tissue == contact::TissueModel::kBone;
  contact::ContactModel other;
  other.tissue = is_on_bone ? contact::TissueModel::kHalfSpace : contact::TissueModel::kBone;
  const std::string under = is_on_bone ? "endless tissue" : "tissue on the hand's own bones";
  step(done++, under);
  try {
    hold_again(ErrorSource::kBone, under,
               contact::PreparedHand(hand, other, is_on_bone ? nullptr : compliance()), closed,
               usual);
  } catch (const UsageError& error) {
    budget.cases.push_back(
        {.source = ErrorSource::kBone, .changed = under, .failure = error.what()});
  }

  const std::string split =
      is_on_bone ? "triangles split into four, of endless tissue" : "triangles split into four";
  step(done++, split);
  try {
    std::vector<Vec3> posed = nominal.posed_skin;
    const auto fine = std::make_shared<const hand::Hand>(split_skin(*hand, posed));
    contact::ContactModel solved = model;
    if (is_on_bone) solved.tissue = contact::TissueModel::kHalfSpace;
    contact::ContactOptions as_it_is = usual.contact;  // the skin's own mesh is asked about
    as_it_is.refine = false;
    const auto figures = [&](const std::shared_ptr<const hand::Hand>& with,
                             const std::vector<Vec3>& skin) {
      return figures_of(
          ErrorSource::kMesh, split,
          contact::solve_hand_contact(contact::PreparedHand(with, solved), skin,
                                      nominal.grasp.product_from_hand, *product.distance, as_it_is),
          product);
    };
    ErrorCase one = figures(fine, posed);
    if (is_on_bone) {
      scale_by(budget.nominal, figures(hand, nominal.posed_skin), one);
    }
    budget.cases.push_back(std::move(one));
  } catch (const UsageError& error) {
    budget.cases.push_back(
        {.source = ErrorSource::kMesh, .changed = split, .failure = error.what()});
  }

  for (const double change : {-options.friction_change, options.friction_change}) {
    AssessOptions how = usual;
    how.balance.friction = std::max(0.0, usual.balance.friction + change);
    const std::string name = fmt::format("friction {:.2g}", how.balance.friction);
    step(done++, name);
    if (!how.balance.is_on) {
      budget.cases.push_back({.source = ErrorSource::kFriction,
                              .changed = name,
                              .failure = "the hand was left as it was closed"});
      continue;
    }
    hold_again(ErrorSource::kFriction, name, prepared, closed, how);
  }
  for (const double angle : {options.bend, -options.bend}) {
    const std::string name =
        angle > 0.0 ? "knuckles bent more, fingers less" : "knuckles bent less, fingers more";
    step(done++, name);
    grasp::Grasp grasp = closed;
    grasp.posture = bent(hand->skeleton, closed.posture, angle);
    hold_again(ErrorSource::kPosture, name, prepared, grasp, usual);
  }
  if (progress.report) progress.report(1.0, "error budget done");
  return budget;
}

}  // namespace palmar::study
