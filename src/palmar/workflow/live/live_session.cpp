// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/live/live_session.h"

#include <cmath>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/grasp/given_grasp.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/workflow/grasp/contact_with_band.h"
#include "palmar/workflow/grasp/hold_product.h"
#include "palmar/workflow/hand/tissue_on_bone.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar {
namespace {

constexpr double kHoldFound = 0.5;  // share of the whole

LivePose checked(const Hand& hand, const LivePose& pose) {
  bool is_finite = pose.product_from_hand.translation.allFinite() &&
                   pose.product_from_hand.rotation.coeffs().allFinite();
  for (const double angle : pose.posture.angle) is_finite = is_finite && std::isfinite(angle);
  if (!is_finite) {
    throw UsageError("live session: an angle or the placement is not finite");
  }
  return {clamp_to_range(hand.skeleton, pose.posture).posture, pose.product_from_hand};
}

}  // namespace

LiveHand prepare_live_hand(const HandChoice& choice, const ContactModel& model) {
  LiveHand result;
  result.hand = load_hand(choice);
  result.prepared = std::make_shared<const PreparedHand>(prepared_hand(choice, result.hand, model));
  result.reference = reference_for(result.hand);
  return result;
}

LiveSession::LiveSession(LiveHand hand, std::shared_ptr<const Product> product)
    : hand_(std::move(hand)), product_(std::move(product)) {}

AssessOptions LiveSession::options_for_task(const LiveTask& task) const {
  AssessOptions options;
  options.contact = refined_contact_with_band();
  options.friction = task.friction.options_for(*product_);
  HeaviestLoad heaviest;
  if (task.rest.is_usual()) heaviest.add(*product_, options.friction.load);
  options.balance = task.rest.options(task.friction.friction, heaviest);
  options.balance.load = options.friction.load;
  return options;
}

AssessmentSet LiveSession::set_of(Assessment assessment) const {
  AssessmentSet set{.hand = hand_.hand, .assessments = {}, .command_line = {}};
  set.assessments.push_back({*product_, std::move(assessment)});
  return set;
}

const RankedHolds& LiveSession::holds(const Progress& progress) {
  if (!places_.contains(1)) {
    places_.emplace(1, GraspPlace(*hand_.reference, *product_,
                                  options_for(GraspSettings{}, *product_), progress));
  }
  return places_.at(1).ranked();
}

AssessmentSet LiveSession::take_hold(int number, const LiveTask& task, const Progress& progress) {
  GraspSettings settings;
  settings.holding.number = number;
  settings.check();
  AssessOptions options = options_for_task(task);
  options.grasp = options_for(settings, *product_);
  if (!grasps_.contains(number)) {
    const Progress search = part_of(progress, 0.0, kHoldFound);
    auto place = places_.find(number);
    if (place == places_.end()) {
      place =
          places_.emplace(number, GraspPlace(*hand_.reference, *product_, options.grasp, search))
              .first;
    }
    const bool is_own = hand_.reference == hand_.hand;
    grasps_.emplace(number, is_own ? place->second.reference_grasp()
                                   : place->second.hold(GraspingHand(hand_.hand), search));
  }
  AssessmentSet set = rest_of(options, grasps_.at(number), part_of(progress, kHoldFound, 1.0));
  const RankedHolds& ranked = places_.at(number).ranked();
  if (!ranked.holds.empty()) {
    set.assessments.front().ways = std::make_shared<const RankedHolds>(ranked);
    set.assessments.front().ways_hand = hand_.reference;
  }
  return set;
}

AssessmentSet LiveSession::rest_of(const AssessOptions& options, const Grasp& grasp,
                                   const Progress& progress) {
  return set_of(assess(*hand_.prepared, *product_, options, progress,
                       [&grasp](const Progress&) { return grasp; }));
}

Grasp LiveSession::given(const LivePose& pose, Grip grip) const {
  const LivePose held = checked(*hand_.hand, pose);
  Grasp grasp = given_grasp(*hand_.hand, *product_, held.posture, held.product_from_hand);
  grasp.grip = grip;
  return grasp;
}

AssessmentSet LiveSession::close_here(const LivePose& pose, std::optional<Grip> grip,
                                      const LiveTask& task, const Progress& progress) {
  const LivePose held = checked(*hand_.hand, pose);
  AssessOptions options = options_for_task(task);
  GraspSettings settings;
  if (grip && is_power(*grip)) settings.grip = grip;
  settings.is_power_only = true;
  settings.placement.product_from_hand = held.product_from_hand;
  settings.check();
  options.grasp = options_for(settings, *product_);
  const Grasp grasp =
      find_grasp(*hand_.hand, *product_, options.grasp, part_of(progress, 0.0, kHoldFound));
  return rest_of(options, grasp, part_of(progress, kHoldFound, 1.0));
}

AssessmentSet LiveSession::rest_here(const LivePose& pose, Grip grip, const LiveTask& task,
                                     const Progress& progress) {
  return rest_of(options_for_task(task), given(pose, grip), progress);
}

AssessmentSet LiveSession::evaluate_here(const LivePose& pose, Grip grip, const LiveTask& task,
                                         const Progress& progress) {
  AssessOptions options;  // nothing is asked of a hand that isn't moved
  options.contact = refined_contact_with_band();
  options.friction = task.friction.options_for(*product_);
  return set_of(evaluate(*hand_.prepared, *product_, given(pose, grip), options, progress));
}

void LiveSession::prepare_to_move() {
  if (solver_) return;
  moving_distance_ = distance_for_moving(product_->mesh, product_->distance);
  solver_.emplace(*hand_.prepared);
}

const ContactResult& LiveSession::move(const LivePose& pose) {
  const LivePose held = checked(*hand_.hand, pose);
  prepare_to_move();
  solver_->solve(pose_skin(*hand_.hand, held.posture), held.product_from_hand, *moving_distance_,
                 moving_);
  return moving_;
}

}  // namespace palmar
