// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort.h"

#include <fmt/format.h>

#include "palmar/grasp/rest/usual_task.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/grasp/grasp.h"
#include "palmar/workflow/grasp/hold_product.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {

void EffortRequest::check() const {
  product.check();
  grasp.check();
  contact.check();
  friction.options();
  rest.options(friction.friction);
  effort.check();
}

effort::EffortResult effort_of_grasp(const EffortRequest& request, const Progress& progress) {
  request.check();
  const product::Product product = load_product(request.product);
  for (const std::string& text : product.notes) note_to(request.note, text);
  study::AssessOptions options;
  options.grasp = options_for(request.grasp, product);
  options.contact = request.contact;
  options.contact.error_band = false;
  options.friction = request.rest.load(request.friction).options_for(product);
  grasp::HeaviestLoad load;
  if (request.rest.follows_product()) load.add(product, options.friction.load);
  options.balance = request.rest.options(request.friction.friction, load);
  options.balance.load = options.friction.load;
  effort::EffortOptions effort = request.effort;
  effort.strength *= options.balance.strength;
  options.balance.strength = effort.strength;
  options.balance.wrist = effort.wrist;
  options.indices.is_on = false;
  const auto hand = load_hand(request.hand);
  const contact::PreparedHand prepared =
      prepared_hand(request.hand, hand, request.model, request.note);
  HeldProduct taken;
  if (request.grasp_file.empty()) {
    taken = take_product(hand, product, request.grasp, options.grasp, progress);
    if (request.rest.follows_product()) {
      options.balance.share_of_strength->holds_only =
          grasp::usual_task(product, taken.grasp, hand->dimensions.hand_length) ==
          grasp::UsualTask::kHold;
    }
    std::shared_ptr<const contact::PreparedHand> reference;
    options.balance.like =
        reference_at_rest(taken.reference_grasp, hand, product, options, reference, progress);
  }
  study::Assessment held =
      request.grasp_file.empty()
          ? study::assess(prepared, product, options, progress,
                          [&](const Progress&) { return taken.grasp; })
          : study::evaluate(prepared, product, read_grasp(request.grasp_file, *hand, product),
                            options, progress);
  if (const auto asked = options.balance.asked_grip_force(held.grasp.grip);
      asked && request.grasp_file.empty()) {
    note_to(request.note, fmt::format("grip force {:.0f} N: {}", *asked,
                                      options.balance.asked_words(held.grasp.grip)));
  }
  // Friction of the grasp at rest, as in assess; of a given grasp that of the load.
  const hand::HandLoad* at_rest = nullptr;
  if (!held.balance.friction_force.empty() &&
      held.balance.status != grasp::BalanceStatus::kSlipsOut) {
    held.friction.force = held.balance.friction_force;
    if (held.balance.joint_load) at_rest = &*held.balance.joint_load;
  }
  const bool has_friction =
      !held.friction.force.empty() && (options.friction.is_on() || options.balance.is_on);
  return effort::assess_effort(*hand, held.grasp.posture, held.contact,
                               held.grasp.product_from_hand, *product.distance, effort,
                               has_friction ? &held.friction : nullptr, at_rest);
}

}  // namespace palmar::workflow
