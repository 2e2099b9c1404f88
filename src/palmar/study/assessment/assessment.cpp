// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/assessment.h"

#include <chrono>

#include "palmar/contact/refine/refined_contact.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/power/grasp_verdict.h"
#include "palmar/grasp/rest/place_at_rest.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/study/assessment/held_torque.h"

namespace palmar::study {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// A clause about what would hold a product that the precision grip asked for doesn't.
std::string other_grip_words(const contact::PreparedHand& hand, const product::Product& product,
                             const AssessOptions& options, const Progress& progress) {
  progress.update(0.55, "looking for a grip that would do");
  const std::optional<grasp::Grip> other = grasp::other_grip_that_holds(
      hand, product, options.grasp, options.balance, options.contact, progress);
  return other ? "; " + std::string(name_of(*other)) + " would hold it"
               : "; no other grip holds it either";
}

/// The segments whose skin carries force.
grasp::Touching touching(const hand::Hand& hand, const contact::ContactResult& contact) {
  grasp::Touching touches{};
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (contact.force[v] > 0.0) touches[index_of(hand.segment[v])] = true;
  }
  return touches;
}

}  // namespace

double grip_force_of(const AssessedProduct& one) {
  const grasp::Balance& balance = one.assessment.balance;
  const bool is_known = balance.status == grasp::BalanceStatus::kBalanced ||
                        balance.status == grasp::BalanceStatus::kSupported;
  if (is_known || one.product.distance == nullptr) return balance.grip_force;
  return grasp::grip_force(one.assessment.contact, *one.product.distance).force;
}

Assessment evaluate(const contact::PreparedHand& hand, const product::Product& product,
                    const grasp::Grasp& grasp, const AssessOptions& options,
                    const Progress& progress, grasp::Balance balance) {
  options.contact.check();
  options.friction.check();

  Assessment result;
  result.hand_name = hand.hand().name;
  result.options = options;
  result.grasp = grasp;
  result.balance = std::move(balance);
  // One load in one run: what hangs from hooked fingers has turned to it.
  if (result.balance.status != grasp::BalanceStatus::kOff) {
    result.options.friction.load = result.options.balance.load = result.balance.load;
  }
  const contact::FrictionOptions& friction = result.options.friction;

  progress.update(0.6, "solving the contact");
  const Stopwatch contact_watch;
  result.posed_skin = hand::pose_skin(hand.hand(), result.grasp.posture);
  result.contact = contact::solve_hand_contact(
      hand, result.posed_skin, result.grasp.product_from_hand, *product.distance, options.contact);
  result.times.contact = contact_watch.seconds();

  const bool is_wrap = grasp::is_power(grasp.grip) && grasp.status == grasp::GraspStatus::kHeld;
  if (is_wrap && result.balance.status == grasp::BalanceStatus::kBalanced) {
    result.grasp.message = grasp::held_words(touching(hand.hand(), result.contact), grasp.grip);
  }

  if (result.balance.nearby && result.contact.total.force > 0.0) {
    result.certainty =
        certainty_of(hand, product, {result.grasp.posture, result.grasp.product_from_hand},
                     *result.balance.nearby, options.contact);
  }

  if (friction.is_on()) {
    progress.update(0.8, "balancing the load by friction");
    const Stopwatch friction_watch;
    result.friction = contact::solve_friction(hand, result.contact, *product.distance,
                                              geometry::centre_of_volume(product.mesh), friction);
    result.times.friction = friction_watch.seconds();
  }

  progress.update(0.85, "judging the grasp");
  const Stopwatch index_watch;
  IndexOptions indices = options.indices;
  indices.effort.strength = options.balance.strength;  // one person in one run
  indices.effort.wrist = options.balance.wrist;
  // One coefficient in one run.
  indices.stability.reduction.friction =
      friction.is_on() ? friction.coefficient : options.balance.friction;
  const contact::ProductLoad& load = friction.is_on() ? friction.load : result.options.balance.load;
  if (load.weight > 0.0 || !load.force.isZero(0.0) || !load.torque.isZero(0.0)) {
    indices.stability.load = load;
  }
  result.indices = grasp_indices(
      hand.hand(), product, {result.grasp, result.balance, result.contact, result.posed_skin},
      load.mass_centre.value_or(geometry::centre_of_volume(product.mesh)), indices);
  if (indices.is_on && indices.torque && result.contact.total.force > 0.0) {
    result.indices.push_back(held_torque_index(held_torque(
        hand, result.contact, *product.distance, {.axis = grasp.grip_axis, .at = grasp.grip_point},
        indices.stability.reduction.friction)));
  }
  result.times.indices = index_watch.seconds();

  // Where pressure is told place by place, of the refined skin, if it was refined.
  const contact::RefinedContact* refined = result.contact.refined.get();
  const hand::Hand& skin_of = refined != nullptr ? *refined->hand : hand.hand();
  const contact::ContactResult& contact = refined != nullptr ? refined->contact : result.contact;
  if (options.footprint) {
    progress.update(0.9, "mapping the pressure to the product");
    result.footprint = contact::map_to_product(skin_of, contact, product.mesh);
    result.faces = face_contacts(result.footprint, product);
  }
  if (options.sensors && contact.total.force > 0.0) {
    result.sensors = sensor_reading(skin_of, product, result.grasp, contact, *options.sensors);
  }
  // Finished is finished: who cancels now still gets it.
  if (progress.report) progress.report(1.0, "assessed");
  return result;
}

Assessment assess(const contact::PreparedHand& hand, const product::Product& product,
                  const AssessOptions& options, const Progress& progress,
                  const std::function<grasp::Grasp(const Progress&)>& hold) {
  options.grasp.check();
  options.balance.check();
  options.contact.check();
  options.friction.check();

  progress.update(0.0, "closing the hand");
  const Stopwatch watch;
  grasp::Grasp grasp =
      hold ? hold(progress) : grasp::find_grasp(hand.hand(), product, options.grasp, progress);
  const double seconds = watch.seconds();
  progress.update(0.5, "letting the grasp come to rest");
  const Stopwatch balance_watch;
  const bool is_held =
      grasp.status == grasp::GraspStatus::kHeld || grasp.status == grasp::GraspStatus::kPartlyHeld;
  grasp::Balance balance;
  Progress stoppable = progress;
  stoppable.report = nullptr;  // its share is not that of the whole
  if (is_held) {
    balance =
        grasp::balance_grasp(hand, product, grasp, options.balance, options.contact, stoppable);
  }
  const double balance_seconds = balance_watch.seconds();
  if (balance.status == grasp::BalanceStatus::kSlipsOut) {
    grasp.status = grasp::GraspStatus::kPartlyHeld;
    grasp.message += "; but it " + balance.message;
  }
  const bool is_at_rest = balance.status == grasp::BalanceStatus::kBalanced ||
                          balance.status == grasp::BalanceStatus::kOff ||
                          balance.status == grasp::BalanceStatus::kSupported;
  if (options.grasp.grip && !grasp::is_power(*options.grasp.grip) &&
      (grasp.status != grasp::GraspStatus::kHeld || !is_at_rest)) {
    grasp.message += other_grip_words(hand, product, options, stoppable);
  }
  Assessment result = evaluate(hand, product, grasp, options, progress, std::move(balance));
  result.times.grasp = seconds;
  result.times.balance = balance_seconds;
  return result;
}

}  // namespace palmar::study
