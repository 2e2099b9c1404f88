// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first step of every redesign: hands hold the original.
#include "palmar/workflow/redesign/held_original.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/product/parts/part_place.h"
#include "palmar/records/study/people_range.h"
#include "palmar/study/assessment/held_torque.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;

records::StudyRequest study_of(const RedesignRequest& asked) {
  records::StudyRequest request;
  request.hand = asked.hand;
  if (asked.seed != 0) request.seed = asked.seed;
  for (const std::string& name : asked.populations) {
    for (records::PopulationRequest& one : records::population_requests(name)) {
      if (one.table.empty()) one.sampling.hands = asked.hands;  // else given hands
      request.populations.push_back(std::move(one));
    }
  }
  request.grips = asked.grips;
  records::ProductRequest product;
  product.unit = asked.unit;
  if (records::is_made(asked.product)) {
    product.made = records::made_from(asked.product);
    request.name = product.made.kind;
  } else {
    product.file = asked.product;
    request.name = fs::path(asked.product).stem().string();
  }
  product.held.at = asked.at;
  product.held.axis = asked.axis;
  product.held.holding = asked.holding;
  request.products.push_back(std::move(product));
  study::StudySetting setting;
  if (asked.grip_force > 0.0) setting.grip_force = asked.grip_force;
  setting.limit_depths = asked.keeps_posture();
  setting.torque = asked.goal_key == study::kHeldTorqueKey;
  request.settings = {setting};
  return request;
}

/// Grasps the original; `shared` has the hand that is scaled and what its hands share, if known.
HeldOriginal hold_original(const RedesignRequest& request, const records::StudyRequest& asked,
                           study::StudyInputs shared, const Progress& progress) {
  progress.throw_if_cancelled();
  HeldOriginal original{.study = records::load_study(asked, shared.base), .records = {}};
  study::StudyInputs& inputs = original.study.inputs;
  const study::StudyPlan& plan = original.study.plan;
  inputs.parts = shared.parts;
  inputs.compliance =
      shared.compliance ? shared.compliance : tissue_on_bone(*inputs.base, plan, request.on_note);
  inputs.family = shared.family ? shared.family
                                : std::make_shared<const contact::HandFamily>(
                                      inputs.base, plan.settings.front().model, inputs.compliance);
  if (request.on_note) {
    for (const std::string& text : original.study.notes) request.on_note(text);
  }
  study::run_study(
      plan, inputs, {.tasks = study::tasks_of(plan)},
      [&](const study::StudyRecord& record) { original.records.push_back(record); }, progress);
  std::sort(
      original.records.begin(), original.records.end(),
      [](const study::StudyRecord& a, const study::StudyRecord& b) { return a.number < b.number; });
  const auto lost =
      std::find_if_not(original.records.begin(), original.records.end(), study::is_in_hand);
  if (lost == original.records.end()) return original;
  const auto held =
      std::count_if(original.records.begin(), original.records.end(), study::is_in_hand);
  const std::string why = lost->reason.empty() ? "" : " (" + lost->reason + ")";
  if (held > 0) {
    original.study.notes.push_back(fmt::format(
        "{}: {} of {} hands don't hold it{}; the others go on without them", request.product,
        plan.hands.size() - static_cast<std::size_t>(held), plan.hands.size(), why));
    if (request.on_note) request.on_note(original.study.notes.back());
  } else {
    throw NumericalError(
        request.product + ": none of " + std::to_string(plan.hands.size()) + " hands holds it" +
        why +
        "; a redesign starts from hands that do (setting \"at\", setting \"axis\" and setting "
        "\"grips\" say where and how it is held)");
  }
  return original;
}

}  // namespace

study::RecordSource HeldOriginal::source() const {
  return [this](const std::function<void(const study::StudyRecord&)>& visit) {
    for (const study::StudyRecord& record : records) visit(record);
  };
}

std::optional<grasp::Hold> HeldOriginal::hold() const {
  for (const study::StudyRecord& record : records) {
    if (study::is_in_hand(record) && record.hold) return record.hold->hold;
  }
  return std::nullopt;
}

std::shared_ptr<const product::ProductParts> HeldOriginal::shared_parts() const {
  if (!found_parts)
    found_parts = std::make_shared<const product::ProductParts>(product::find_parts(product()));
  return found_parts;
}

HeldOriginal grasp_original(const RedesignRequest& request, const Progress& progress) {
  request.check();
  const records::StudyRequest asked = study_of(request);
  HandChoice hand;
  hand.name = asked.hand;
  hand.is_left = request.is_left;
  study::StudyInputs shared{.base = load_hand(hand), .products = {}};
  return hold_original(request, asked, std::move(shared), progress);
}

redesign::HandsOnHandle hands_in_hold(const HeldOriginal& original, const grasp::Hold& hold) {
  const geometry::Rigid3 place = product::part_frame(original.part_of(hold), hold.along, hold.turn);
  redesign::HandsOnHandle hands;
  hands.place = place.translation;
  hands.thumb_side = hold.toward * (place.rotation * Vec3::UnitX());
  hands.palm = place.rotation * Vec3::UnitZ();
  return hands;
}

Vec3 held_place(const RedesignRequest& request, const HeldOriginal& original) {
  if (request.at) return *request.at;
  if (const std::optional<grasp::Hold> hold = original.hold()) {
    const product::ProductPart& part =
        original.parts().parts.at(static_cast<std::size_t>(hold->part - 1));
    return product::part_frame(part, hold->along, hold->turn).translation;
  }
  return geometry::bounding_box(original.product().mesh).center();
}

JudgingHands judging_hands(const RedesignRequest& request, const HeldOriginal& made_for,
                           const Progress& progress) {
  for (const std::string& name : request.populations) {
    for (const records::PopulationRequest& one : records::population_requests(name)) {
      if (!one.table.empty()) return {.original = made_for, .are_others = false};
    }
  }
  RedesignRequest other = request;
  other.seed = made_for.study.plan.seed + 1;
  other.on_note = nullptr;  // they were said
  if (const std::optional<grasp::Hold> hold = made_for.hold(); hold && !request.at) {
    other.holding = {};
    other.holding.hold = hold;
  }
  other.check();
  study::StudyInputs shared = made_for.study.inputs;
  if (made_for.hold()) shared.parts = {made_for.shared_parts()};
  return {.original = hold_original(other, study_of(other), std::move(shared), progress),
          .are_others = true};
}

}  // namespace palmar::workflow
