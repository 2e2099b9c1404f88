// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/product/product.h"
#include "palmar/validation/validation.h"

namespace palmar::validation {

/// A cylinder in the template's power grasp, at rest.
struct HeldCylinder {
  product::Product product;
  grasp::Grasp grasp;
  grasp::Balance balance;
  std::vector<Vec3> posed_skin;  ///< hand frame, mm
};

/// What cases share: the hand, prepared once per set of equations, and grasps already closed.
class ValidationBench {
 public:
  /// `compliance` of the hand's skin; none: made when first needed.
  ValidationBench(std::shared_ptr<const hand::Hand> hand,
                  std::shared_ptr<const contact::SkinCompliance> compliance, Progress progress);

  const hand::Hand& hand() const { return *hand_; }
  const contact::PreparedHand& prepared(const contact::ContactModel& model);
  std::shared_ptr<const contact::SkinCompliance> compliance();
  const HeldCylinder& cylinder(double diameter);
  contact::ContactResult contact(const HeldCylinder& held, const contact::ContactModel& model);

  /// Of the case that runs: share done of it.
  void update(double share, const std::string& activity) const;
  double case_begin = 0.0, case_end = 1.0;  ///< share of the whole run

  std::shared_ptr<const hand::Hand> shared_hand() const { return hand_; }
  const Progress& progress() const { return progress_; }

 private:
  std::shared_ptr<const hand::Hand> hand_;
  std::shared_ptr<const contact::SkinCompliance> compliance_;
  Progress progress_;
  std::map<std::string, std::unique_ptr<contact::PreparedHand>> prepared_;
  std::map<double, std::unique_ptr<HeldCylinder>> cylinders_;
};

using ValidationRows = std::vector<ValidationRow>;

/// Enters the history of all rows that have none yet; see ValidationRow.
void set_history(ValidationRows& rows, const std::string& added_in,
                 const std::string& chosen_in = "");

/// The half-space with one region at a time.
contact::ContactModel independent_model();
/// The half-space with bone under the skin.
contact::ContactModel layered_model();

// validation_press.cpp
ValidationRows validate_half_space(ValidationBench& bench);
ValidationRows validate_layer(ValidationBench& bench);
// validation_fingertip.cpp
ValidationRows validate_fingertip(ValidationBench& bench);
// validation_population.cpp
ValidationRows validate_contact_area(ValidationBench& bench);
/// Rows of G6 over 30 hands: the round prism and the redesigns of the sharp one, in the posture
/// that each hand has on the sharp one.
ValidationRows validate_designs_over_hands(ValidationBench& bench, const product::Product& sharp,
                                           const product::Product& round);
// validation_grasp.cpp
ValidationRows validate_grip_force(ValidationBench& bench);
ValidationRows validate_shares(ValidationBench& bench);
ValidationRows validate_fillets(ValidationBench& bench);
ValidationRows validate_coupling(ValidationBench& bench);
// validation_skin.cpp
ValidationRows validate_skin_meshes(ValidationBench& bench);
// validation_predictions.cpp
ValidationRows validate_predictions(ValidationBench& bench);
// validation_motion.cpp
ValidationRows validate_motion(ValidationBench& bench);
ValidationRows validate_structure(ValidationBench& bench);

}  // namespace palmar::validation
