// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/equilibrium/skin_motion.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

inline constexpr double kNoWay = 1e-6;           ///< rad; less is none
inline constexpr double kForcesAccuracy = 5e-4;  ///< relative; of what is reported. Our choice

/// Contact and friction of a hand and a product in one state, in generalised coordinates.
///
/// Normal forces p_v come from the contact solver. With J_v = d(gap of vertex v) / dx their
/// generalised force is sum p_v J_v, and their stiffness sum k_v J_v^T J_v with k_v = 2 p_v / d_r,
/// d_r the largest penetration of the vertex' region: a force that grows with the square of the
/// depth, as those of stiffening skin do. The stiffness only steers the search.
///
/// Skin on skin of the same hand pushes the angles of both apart in the same way, and the product
/// not at all: f_k J_k, J_k = d(gap of touch k) / dx.
///
/// Friction: skin that has gone a tangential way s_v over the product since the start pulls with
/// t_v = -(2/3) k_v s_v (Mindlin 1949, nu = 0.5), |t_v| <= mu p_v. It changes with p_v, too: all of
/// it where the skin slips, half of it where it sticks (p_v grows with the square of the depth, the
/// denominator of k_v with the depth), so the stiffness isn't symmetric. Skin that slips resists
/// ways across its slip by |t_v| / |s_v|, and none along it.
class GripMechanics {
 public:
  /// Keeps references; skin sticks where it is in `start`.
  GripMechanics(const contact::PreparedHand& hand, const product::Product& product,
                const contact::ContactOptions& options, double friction, const GripState& start);

  /// Solves the contact of a state, on bone to `accuracy` of the forces, and fills what follows.
  /// False if it can't be solved.
  bool look(const GripState& state, double accuracy = kForcesAccuracy);

  /// What a common motion of joints by `rate` [rad per mm] does in the state last looked at.
  struct Closing {
    double squeeze = 0.0;  ///< change of the sum of normal forces, N/mm
    /// Change of the contact's force and moment on the product's coordinates, N/mm and N.
    Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
  };
  Closing closing(const hand::Posture& posture, const hand::Posture& rate) const;

  const contact::ContactResult& contact() const { return contact_; }
  /// Of all contacts solved so far.
  const contact::ContactFallbacks& fallbacks() const { return fallbacks_; }
  const GripVector& force() const { return force_; }  ///< of the contact on the coordinates
  /// Forces that coordinates (columns) take from coordinates (rows) per mm and rad.
  const GripMatrix& stiffness() const { return stiffness_; }
  /// Change of the sum of normal forces with the coordinates, N per mm and rad.
  const GripVector& squeeze() const { return squeeze_; }
  /// Whether skin that the angle moves is loaded.
  const std::array<bool, kGripJoints>& is_loaded() const { return is_loaded_; }
  const Vec3& centre() const { return centre_; }  ///< of the normal forces, hand frame, mm
  double arm() const { return arm_; }  ///< root mean square distance of forces from it, mm
  double friction_use() const { return friction_use_; }
  const Squeeze& grip() const { return grip_; }
  /// Wrench on the product of the normal forces of one digit's phalanges; about the centre, hand
  /// frame, N and N mm. Nothing: of the palm (and all else).
  Eigen::Matrix<double, 6, 1> wrench_of(std::optional<hand::Finger> finger) const;
  /// Of the skin on the product, per skin vertex, product frame, N.
  std::vector<Vec3> friction_force() const;

 private:
  Squeeze squeeze_of_normals() const;

  const contact::PreparedHand* hand_;
  SkinMotion skin_;
  const product::Product* product_;
  double friction_ = 0.0;
  contact::ContactSolver::Impl solver_;
  contact::ContactResult contact_;
  contact::ContactFallbacks fallbacks_;
  std::vector<Vec3> posed_;
  std::vector<Vec3> anchor_;  ///< where the skin stuck, product frame, mm
  std::vector<int> loaded_;
  std::vector<Vec3> normal_, tangential_;  ///< per loaded vertex, hand frame; on the skin, N
  std::vector<double> stiff_, drag_;       ///< per loaded vertex, normal and tangential, N/mm
  Quat hand_from_product_;
  GripVector force_, squeeze_;
  GripMatrix stiffness_;
  std::array<bool, kGripJoints> is_loaded_{};
  Vec3 centre_ = Vec3::Zero();
  double arm_ = 1.0, friction_use_ = 0.0;
  Squeeze grip_;
};

}  // namespace palmar::grasp
