// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/equilibrium/skin_motion.h"
#include "palmar/hand/tendons/digit_pose.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// Contact and friction of a hand and a product in one state, in generalised coordinates x.
///
/// With the tissue's energy W of the gaps g(x), the contact's generalised forces are
///
///     -dW/dx = sum_v p_v dg_v/dx
///
/// p_v from the contact solver. Skin on skin of the same hand adds f_k dg_k/dx and does nothing to
/// the product.
///
/// Friction: skin that has gone a way s over the product since it was taken pulls back with
///
///     t = mu p s / sqrt(|s|^2 + e^2),   e = 3/4 mu d
///
/// d the mean depth of the region's contact: for small s two thirds of the normal stiffness 2 p / d
/// of tissue whose force grows with the square of its depth (Mindlin 1949, nu = 0.5), and never
/// more than mu p. The root in place of a bound at which sticking turns into slip is ours: it makes
/// the force smooth.
///
/// Stiffness: that of forces p_v which grow with the square of their own depth, and of a region's
/// sum with the square of its mean depth, off by a sixth; or, at the cost of a contact, the
/// contact's own (differentiate()).
class ContactForces {
 public:
  /// Keeps references; skin sticks where it is in `start`.
  ContactForces(const contact::PreparedHand& hand, const product::Product& product,
                const contact::ContactOptions& options, double friction, const GripState& start);

  /// Solves the contact of a state, to `accuracy` of its forces, and fills what follows. False if
  /// it can't be solved.
  bool look(const GripState& state, double accuracy);

  /// Stiffness and squeeze's rate of the state last looked at, with the forces' own derivatives in
  /// place of what look() takes for them: by gaps and by the directions in which skin is pressed
  /// (ContactSolver::Impl::stiffness_times()), with how arms and normals turn, and how friction
  /// follows the surface and its region's depth. Set of loaded skin held; off by 0.1 to 2 % per
  /// coordinate, up to 6 % at an IP joint. Where the contact has no derivatives of its own, with
  /// arms and normals alone.
  void differentiate();

  /// Whether the state last looked at is this one.
  bool is_at(const GripState& state) const;
  const std::vector<Vec3>& posed() const { return posed_; }  ///< skin, hand frame, mm
  const contact::ContactFallbacks& fallbacks() const { return fallbacks_; }
  const GripVector& force() const { return force_; }  ///< on the coordinates, N and N mm
  /// Forces that coordinates (columns) take from coordinates (rows) per mm and rad.
  const GripMatrix& stiffness() const { return stiffness_; }
  const Squeeze& grip() const { return grip_; }
  const GripVector& squeeze_rate() const { return rate_; }  ///< of the grip force, N per mm and rad
  /// Whether skin that the angle moves is loaded.
  const std::array<bool, kGripJoints>& is_loaded() const { return is_loaded_; }
  const Vec3& centre() const { return centre_; }  ///< of the normal forces, hand frame, mm
  double arm() const { return arm_; }  ///< root mean square distance of forces from it, mm
  double friction_use() const { return friction_use_; }
  /// Of the skin on the product, per skin vertex, product frame, N.
  std::vector<Vec3> friction_force() const;

 private:
  void add_up();
  std::vector<Eigen::Matrix3d> bends() const;
  GripMatrix geometric_stiffness(const std::vector<Eigen::Matrix3d>& bend) const;
  GripMatrix depth_stiffness(const Eigen::MatrixXd& opening, const Eigen::MatrixXd& lost) const;
  contact::LoadedSkin::Turns turns(const std::vector<Eigen::Matrix3d>& bend) const;
  const contact::PreparedHand* hand_;
  SkinMotion skin_;
  const product::Product* product_;
  double friction_ = 0.0;
  contact::ContactSolver::Impl solver_;
  contact::ContactResult contact_;
  contact::ContactFallbacks fallbacks_;
  std::vector<Vec3> posed_;
  std::vector<Vec3> anchor_;  ///< where the skin stuck, product frame, mm
  // Per loaded vertex.
  std::vector<int> loaded_;
  std::vector<double> pressed_;   ///< N
  std::vector<double> depth_;     ///< mm
  std::vector<Vec3> in_product_;  ///< skin, product frame, mm
  std::vector<Vec3> normal_;      ///< in which the product presses, out of it, hand frame
  std::vector<Vec3> slope_;       ///< of the distance to the product, the same
  /// Per loaded vertex: how coordinates move it over the product, mm per mm and rad.
  std::vector<std::vector<std::pair<int, Vec3>>> motion_;
  std::vector<Vec3> pull_;    ///< friction on the skin, per loaded vertex, hand frame, N
  std::vector<Vec3> way_;     ///< of the skin over the product since it stuck, the same, mm
  std::vector<double> room_;  ///< sqrt(|s|^2 + e^2), mm
  struct RegionDepth {
    double force = 0.0, mean = 0.0;  ///< N; mm
  };
  std::array<RegionDepth, hand::kRegionCount> depth_of_;
  Quat hand_from_product_;
  GripState state_;
  GripVector force_, rate_;
  GripMatrix stiffness_, drag_;  ///< drag_: of stiffness_, friction at given normal forces
  std::array<hand::PosedDigit, hand::kFingerCount> digit_;
  std::array<bool, kGripJoints> is_loaded_{};
  Vec3 centre_ = Vec3::Zero();
  double arm_ = 1.0, friction_use_ = 0.0;
  Squeeze grip_;
};

}  // namespace palmar::grasp
