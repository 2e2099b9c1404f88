// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/equilibrium/thumb_meeting.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/grasp/rest/fingertip_closing.h"
#include "palmar/grasp/rest/grip_mechanics.h"

namespace palmar::grasp {

/// One run of the search for rest of a hand whose joints are held stiff: precision grips and hooks.
class Settling {
 public:
  /// Keeps references. Skin sticks where it is in `grasp`.
  Settling(const contact::PreparedHand& hand, const product::Product& product, const Grasp& grasp,
           const BalanceOptions& options, const contact::ContactOptions& contact);

  Balance run(const Progress& progress);
  const GripState& state() const { return state_; }

 private:
  struct Misfit {
    GripVector residual = GripVector::Zero();  ///< N, N mm
    GripMatrix stiffness = GripMatrix::Zero();
    double force = 0.0, moment = 0.0;  ///< on the product, N and N mm
    double of_product = 0.0;           ///< those over the grip force
    double of_level = 0.0;             ///< of the grip force against the one asked for
    double sum() const { return of_product + of_level; }
    /// All but at rest.
    bool is_near() const;
  };

  void add_load(GripVector& residual) const;
  double wrist_load() const;
  double extra_grip() const;
  Misfit misfit(double grip) const;
  void step(const Misfit& misfit, double missing);
  void step_fingertips(const Misfit& misfit, double missing);
  double share_of(const GripVector& way, double longest);
  void move_product(const Vec3& shift, const Vec3& turn);
  void finish(Balance& balance);
  bool judge_way(Balance& balance) const;

  const hand::Hand* hand_;
  const BalanceOptions* options_;
  double load_share_ = 1.0;  // of the load that is put on; all of it once the grip is firm enough
  std::optional<double> asked_;  // grip force, N
  bool has_level_;               // the squeeze is brought to the grip force asked for
  GripState start_, state_;
  ThumbMeeting meeting_;
  FingertipClosing closing_;  // how a precision grip presses
  GripMechanics mechanics_;
  contact::Wrench load_;  // product frame
  bool has_load_ = false;
  double target_ = 0.0;      // grip force, N
  double relaxation_ = 1.0;  // share of a step that is taken
  GripVector last_way_ = GripVector::Zero();
  Vec3 moved_ = Vec3::Zero();  // of the product, hand frame, mm
};

}  // namespace palmar::grasp
