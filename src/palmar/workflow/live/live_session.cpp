// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/live/live_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/grasp/given_grasp.h"
#include "palmar/grasp/rest/usual_task.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/tendons/joint_limits.h"
#include "palmar/workflow/grasp/contact_with_band.h"
#include "palmar/workflow/grasp/hold_product.h"
#include "palmar/workflow/hand/tissue_on_bone.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::workflow {
namespace {

constexpr double kHoldFound = 0.5;  // share of the whole

LivePose checked(const hand::Hand& hand, const LivePose& pose) {
  bool is_finite = pose.product_from_hand.translation.allFinite() &&
                   pose.product_from_hand.rotation.coeffs().allFinite();
  for (const double angle : pose.posture.angle) is_finite = is_finite && std::isfinite(angle);
  if (!is_finite) {
    throw UsageError("live session: an angle or the placement is not finite");
  }
  // Joints give way a little beyond their ranges.
  LivePose held = pose;
  for (int d = 0; d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = hand.skeleton.dof(static_cast<hand::Dof>(d));
    double& angle = held.posture[dof.dof];
    angle = std::clamp(angle, dof.lower - hand::kPassiveRange, dof.upper + hand::kPassiveRange);
  }
  return held;
}

}  // namespace

LiveHand prepare_live_hand(const HandChoice& choice, const contact::ContactModel& model) {
  LiveHand result;
  result.hand = load_hand(choice);
  result.prepared =
      std::make_shared<const contact::PreparedHand>(prepared_hand(choice, result.hand, model));
  result.reference = reference_for(result.hand);
  return result;
}

LiveSession::LiveSession(LiveHand hand, std::shared_ptr<const product::Product> product)
    : hand_(std::move(hand)), product_(std::move(product)) {}

study::AssessOptions LiveSession::options_for_task(const LiveTask& task) const {
  study::AssessOptions options;
  options.contact = refined_contact_with_band();
  options.friction = task.friction.options_for(*product_);
  grasp::HeaviestLoad heaviest;
  if (task.rest.follows_product()) heaviest.add(*product_, options.friction.load);
  options.balance = task.rest.options(task.friction.friction, heaviest);
  options.balance.load = options.friction.load;
  return options;
}

study::AssessmentSet LiveSession::set_of(study::Assessment assessment) const {
  study::AssessmentSet set{.hand = hand_.hand, .assessments = {}, .command_line = {}};
  set.assessments.push_back({*product_, std::move(assessment)});
  return set;
}

const grasp::RankedHolds& LiveSession::holds(const Progress& progress) {
  if (!places_.contains(1)) {
    places_.emplace(1, grasp::GraspPlace(*hand_.reference, *product_,
                                         options_for(grasp::GraspSettings{}, *product_), progress));
  }
  return places_.at(1).ranked();
}

study::AssessmentSet LiveSession::take_hold(int number, const LiveTask& task,
                                            const Progress& progress) {
  grasp::GraspSettings settings;
  settings.holding.number = number;
  settings.check();
  study::AssessOptions options = options_for_task(task);
  options.grasp = options_for(settings, *product_);
  if (!grasps_.contains(number)) {
    const Progress search = part_of(progress, 0.0, kHoldFound);
    holds(search);
    auto place = places_.find(number);
    if (place == places_.end()) {
      place = places_.emplace(number, places_.at(1).with_hold(number, "", search)).first;
    }
    const bool is_own = hand_.reference == hand_.hand;
    grasps_.emplace(number, is_own ? place->second.reference_grasp()
                                   : place->second.hold(grasp::GraspingHand(hand_.hand), search));
  }
  std::optional<grasp::Grasp> reference;
  if (hand_.reference != hand_.hand) reference = places_.at(number).reference_grasp();
  study::AssessmentSet set =
      rest_of(options, task, grasps_.at(number), part_of(progress, kHoldFound, 1.0), reference);
  const grasp::RankedHolds& ranked = places_.at(number).ranked();
  if (!ranked.holds.empty()) {
    set.assessments.front().ways = std::make_shared<const grasp::RankedHolds>(ranked);
    set.assessments.front().ways_hand = hand_.reference;
  }
  return set;
}

study::AssessmentSet LiveSession::rest_of(study::AssessOptions options, const LiveTask& task,
                                          const grasp::Grasp& grasp, const Progress& progress,
                                          const std::optional<grasp::Grasp>& reference) {
  if (task.rest.follows_product()) {
    options.balance.share_of_strength->holds_only =
        grasp::usual_task(*product_, grasp, hand_.hand->dimensions.hand_length) ==
        grasp::UsualTask::kHold;
  }
  options.balance.like =
      reference_at_rest(reference, hand_.hand, *product_, options, reference_, progress);
  return set_of(study::assess(*hand_.prepared, *product_, options, progress,
                              [&grasp](const Progress&) { return grasp; }));
}

grasp::Grasp LiveSession::given(const LivePose& pose, grasp::Grip grip) const {
  const LivePose held = checked(*hand_.hand, pose);
  grasp::Grasp grasp =
      grasp::given_grasp(*hand_.hand, *product_, held.posture, held.product_from_hand);
  grasp.grip = grip;
  return grasp;
}

study::AssessmentSet LiveSession::close_here(const LivePose& pose, std::optional<grasp::Grip> grip,
                                             const LiveTask& task, const Progress& progress) {
  const LivePose held = checked(*hand_.hand, pose);
  study::AssessOptions options = options_for_task(task);
  grasp::GraspSettings settings;
  if (grip && grasp::is_power(*grip)) settings.grip = grip;
  settings.is_power_only = true;
  settings.placement.product_from_hand = held.product_from_hand;
  settings.check();
  options.grasp = options_for(settings, *product_);
  const grasp::Grasp grasp =
      grasp::find_grasp(*hand_.hand, *product_, options.grasp, part_of(progress, 0.0, kHoldFound));
  return rest_of(options, task, grasp, part_of(progress, kHoldFound, 1.0));
}

study::AssessmentSet LiveSession::rest_here(const LivePose& pose, grasp::Grip grip,
                                            const LiveTask& task, const Progress& progress) {
  return rest_of(options_for_task(task), task, given(pose, grip), progress);
}

study::AssessmentSet LiveSession::evaluate_here(const LivePose& pose, grasp::Grip grip,
                                                const LiveTask& task, const Progress& progress) {
  study::AssessOptions options;  // nothing is asked of a hand that isn't moved
  options.contact = refined_contact_with_band();
  options.friction = task.friction.options_for(*product_);
  return set_of(study::evaluate(*hand_.prepared, *product_, given(pose, grip), options, progress));
}

void LiveSession::prepare_to_move() {
  if (solver_) return;
  moving_distance_ = distance_for_moving(product_->mesh, product_->distance);
  solver_.emplace(*hand_.prepared);
}

const contact::ContactResult& LiveSession::move(const LivePose& pose) {
  const LivePose held = checked(*hand_.hand, pose);
  prepare_to_move();
  solver_->solve(hand::pose_skin(*hand_.hand, held.posture), held.product_from_hand,
                 *moving_distance_, moving_);
  return moving_;
}

}  // namespace palmar::workflow
