// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/joints/measured_joints.h"
#include "hands/capture/mri/bones/reference_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

using MotionsByPosture = std::map<hand::ScanPosture, PostureMotions>;

/// Motion of a bone against the one before it ("" = palm), reference frame: nothing unless both
/// were found. (proximal motion)^-1 * (distal motion).
std::optional<geometry::Rigid3> motion_between(const PostureMotions& motions,
                                               const std::string& proximal,
                                               const std::string& distal);

/// The thumb's CMC joint taken for two fixed axes, one for flexion and extension, one for abduction
/// and adduction: what the interpolated joint is compared with.
struct FixedAxisCmc {
  Vec3 flexion_axis = Vec3::UnitZ(), flexion_point = Vec3::Zero();
  Vec3 abduction_axis = Vec3::UnitX(), abduction_point = Vec3::Zero();
  /// The metacarpal turned about the abduction axis (fixed to it), then the flexion axis.
  geometry::Rigid3 displacement(double flexion, double abduction) const {
    return geometry::Rigid3::about_axis(flexion_axis, flexion_point, flexion) *
           geometry::Rigid3::about_axis(abduction_axis, abduction_point, abduction);
  }
};

/// Joints of the reference hand: measured where the limit postures' motions show them, else those
/// of the model moved onto the bones. Ranges of the fingers' and thumb's hinges are the model's
/// still.
struct JointMeasures {
  hand::Skeleton skeleton;
  std::array<bool, hand::kDofCount> is_measured{};
  std::array<std::optional<double>, hand::kDofCount> axis_error{};  ///< as in MeasuredJoints
  FixedAxisCmc fixed_cmc;
  std::vector<std::string> notes;

  bool& measured(hand::Dof dof) { return is_measured[index_of(dof)]; }
  /// The axis is measured, with that standard error, rad.
  void set_measured(hand::Dof dof, double error) {
    measured(dof) = true;
    axis_error[index_of(dof)] = error;
  }
};

/// Hinges (PIP, DIP, thumb MP, IP): the fixed axis of all limit postures (fit_hinge()). MCP: two
/// axes, flexion fixed to the metacarpal, abduction to the phalanx (fit_two_axes()). Sense and what
/// isn't given: the model's. An axis whose standard error is above 8 degrees is no better than the
/// model's (people's axes differ by 5 to 8) and isn't used; above 4 degrees a note says so. Moves
/// `hand`'s joint centres to the axes found.
void measure_finger_joints(ReferenceHand& hand, const hand::Hand& model,
                           const MotionsByPosture& motions, JointMeasures& measures);

/// CMC joint of the thumb: two axes for its degrees of freedom, and the four limit transforms about
/// the point of the joint that moves least (Xie 2014, eq. 2-5, 2-6). A limit that wasn't scanned is
/// the turn about the axis at the model's range.
void measure_cmc(ReferenceHand& hand, const hand::Hand& model, const MotionsByPosture& motions,
                 JointMeasures& measures);

/// Angle from `from` to `to` seen along `axis`, right-handed, rad.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to);

}  // namespace palmar::capture
