// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <optional>
#include <vector>

#include "palmar/grasp/rest/grip_mechanics.h"
#include "palmar/hand/tendons/hand_muscles.h"

namespace palmar::grasp {

/// Forces of a grip, linear in its coordinates about a state, and what a step is to reach. Holds
/// references: what it is made of has to outlive it.
struct GripEquations {
  const std::vector<int>& free;  ///< coordinates that move, ascending; the product's six come last
  const Eigen::MatrixXd& k;      ///< their stiffness, made definite
  const GripVector& force;       ///< with passive moments, without muscles, N and N mm
  const GripMatrix& stiffness;   ///< of all coordinates
  const GripVector& squeeze;     ///< change of the sum of normal forces with the coordinates
  /// Change of the sum of normal forces that is asked for, N; nothing: as much as the muscles give.
  std::optional<double> missing;
  /// How far the product has gone, hand frame, mm; given, it is kept where it was taken hold of, as
  /// far as the muscles can at the squeeze asked for.
  const Vec3* moved = nullptr;
};

/// The muscles of the angles that take part.
struct GripMuscles {
  const Eigen::MatrixXd& at_limit;           ///< moments, angles x muscles, N mm
  const Eigen::RowVectorXd& wrist_at_limit;  ///< about the wrist, N mm
  double wrist_load = 0.0;                   ///< N mm
  std::vector<int> held;                     ///< held angles with an equation, ascending
  Eigen::VectorXi stop;                      ///< of each: MuscleProblem::stop
  Eigen::VectorXd given_way;                 ///< of each, since the hand closed, rad
};

/// One step of a grip towards rest: the activations under which held angles, squeeze, wrist and
/// product are in balance once the free coordinates have followed. Held angles whose muscles are
/// too weak give way; those that have given way come back as far as the muscles can bring them.
class MuscleStep {
 public:
  MuscleStep(const GripEquations& equations, const GripMuscles& muscles);
  void solve();

  const Eigen::VectorXd& activation() const { return solution_.activation; }
  /// Moments of the held angles' stops, N mm.
  const Eigen::VectorXd& stops() const { return solution_.stop; }
  bool is_squeeze_short() const { return solution_.missing[held_count_] > 0.0; }
  GripVector way() const;

 private:
  void balance();
  bool is_held() const { return solution_.missing.head(held_count_).isZero(0.0); }
  bool give_way();
  void come_back(Eigen::VectorXd back);

  const GripEquations& equations_;
  const GripMuscles& muscles_;
  Eigen::Index free_count_, held_count_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd by_muscle_;  ///< what a full activation of each muscle moves the free coordinates
  Eigen::VectorXd by_force_;   ///< what the forces as they are move them
  Eigen::MatrixXd between_;    ///< stiffness, held x free
  Eigen::MatrixXd follow_;  ///< how the free follow the held angles, with the sign of a stiffness
  hand::MuscleProblem problem_;  ///< rows: held angles, the squeeze, the wrist, the product's place
  Eigen::VectorXd giving_;       ///< way of the held angles, rad
  Eigen::VectorXd moved_by_force_;  ///< of the free coordinates, with that way
  hand::MuscleSolution solution_;
};

}  // namespace palmar::grasp
