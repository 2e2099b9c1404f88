// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/joints/posture_angles.h"

#include <algorithm>
#include <functional>
#include <numbers>

#include "hands/capture/axis_fit.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::capture {
namespace {

/// One angle that is looked for.
struct Angle {
  double start = 0.0, lower = 0.0, upper = 0.0;  ///< rad
};

using Placed = std::map<std::string, geometry::Rigid3>;

/// Angles at which `place` comes nearest to the bones' motions; those without room stay.
std::vector<double> nearest_angles(const std::vector<Angle>& angles,
                                   const std::function<Placed(const std::vector<double>&)>& place,
                                   const ReferenceHand& hand, const PostureMotions& motions) {
  std::vector<double> all;
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    all.push_back(std::clamp(angles[k].start, angles[k].lower, angles[k].upper));
    if (angles[k].upper - angles[k].lower > 1e-9) free.push_back(k);
  }
  std::vector<std::pair<std::string, const ReferenceBone*>> bones;
  for (const auto& [name, motion] : place(all)) {
    const auto bone = hand.bones.find(name);
    if (bone != hand.bones.end() && motions.bone.contains(name)) {
      bones.emplace_back(name, &bone->second);
    }
  }
  if (free.empty() || bones.empty()) return all;

  const auto n = static_cast<Eigen::Index>(free.size());
  const auto m = 18 * static_cast<Eigen::Index>(bones.size());
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    std::vector<double> at = all;
    for (Eigen::Index j = 0; j < n; ++j) at[free[j]] = x[j];
    const Placed placed = place(at);
    r.resize(m + n);
    Eigen::Index row = 0;
    for (const auto& [name, bone] : bones) {
      const geometry::Rigid3& model = placed.at(name);
      const geometry::Rigid3& seen = motions.bone.at(name);
      for (const Vec3& p : bone->points) {
        r.segment<3>(row) = model * p - seen * p;
        row += 3;
      }
    }
    // What no bone shows stays where it starts: 1e-3 mm per rad decides nothing else.
    for (Eigen::Index j = 0; j < n; ++j) {
      r[m + j] = 1e-3 * (x[j] - angles[free[j]].start);
    }
  };
  geometry::LeastSquaresProblem problem;
  problem.evaluate = geometry::with_numeric_jacobian(residual);
  problem.lower.resize(n);
  problem.upper.resize(n);
  Eigen::VectorXd x(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Angle& angle = angles[free[j]];
    problem.lower[j] = angle.lower;
    problem.upper[j] = angle.upper;
    x[j] = std::clamp(angle.start, angle.lower, angle.upper);
  }
  const geometry::LeastSquaresSolution found = geometry::solve_least_squares(
      problem, x, {.max_iterations = 100, .gradient_tolerance = 1e-8, .step_tolerance = 1e-9});
  for (Eigen::Index j = 0; j < n; ++j) all[free[j]] = found.x[j];
  return all;
}

std::vector<hand::Dof> dofs_of(const hand::Skeleton& skeleton, hand::Finger finger) {
  std::vector<hand::Dof> dofs;
  const auto add = [&](hand::JointId id) {
    for (const hand::JointDof& dof : skeleton.joint(id).dofs) dofs.push_back(dof.dof);
  };
  if (finger == hand::Finger::kThumb) add(hand::JointId::kThumbCmc);
  for (const auto& segment : hand::segments_of(finger)) {
    if (segment) add(hand::joint_of(*segment));
  }
  return dofs;
}

std::vector<Angle> angles_of(const hand::Skeleton& skeleton, const std::vector<hand::Dof>& dofs) {
  std::vector<Angle> angles;
  for (const hand::Dof d : dofs) {
    const hand::JointDof& dof = skeleton.dof(d);
    angles.push_back({dof.reference, dof.lower, dof.upper});
  }
  return angles;
}

}  // namespace

Placed bones_of_finger(const hand::PosedSkeleton& posed, hand::Finger finger) {
  Placed placed;
  if (finger == hand::Finger::kThumb) placed["thumb_metacarpal"] = posed.thumb_metacarpal;
  for (const auto& segment : hand::segments_of(finger)) {
    if (segment) {
      placed[phalanx_name(*segment)] = posed.segment[index_of(*segment)];
    }
  }
  return placed;
}

hand::Posture fit_angles(const hand::Skeleton& skeleton, const ReferenceHand& hand,
                         const PostureMotions& motions) {
  hand::Posture posture = hand::reference_posture(skeleton);
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const std::vector<hand::Dof> dofs = dofs_of(skeleton, finger);
    const auto place = [&](const std::vector<double>& angle) {
      hand::Posture p = hand::reference_posture(skeleton);
      for (std::size_t k = 0; k < dofs.size(); ++k) p[dofs[k]] = angle[k];
      return bones_of_finger(hand::pose_skeleton(skeleton, p), finger);
    };
    const std::vector<double> angle =
        nearest_angles(angles_of(skeleton, dofs), place, hand, motions);
    for (std::size_t k = 0; k < dofs.size(); ++k) posture[dofs[k]] = angle[k];
  }

  // A stub of the forearm hardly holds its own turn: a small motion is no motion.
  constexpr double kLeastWristTurn = 0.1;  // rad
  PostureMotions forearm;
  for (const char* name : {"radius", "ulna"}) {
    const auto found = motions.bone.find(name);
    if (found == motions.bone.end()) continue;
    if (fit_axis(found->second, Vec3::Zero()).angle >= kLeastWristTurn) forearm.bone.insert(*found);
  }
  if (forearm.bone.empty()) return posture;
  const std::vector<hand::Dof> wrist = {hand::Dof::kWristFlexion, hand::Dof::kWristDeviation,
                                        hand::Dof::kWristPronation};
  const auto place = [&](const std::vector<double>& angle) {
    hand::Posture p = hand::reference_posture(skeleton);
    for (std::size_t k = 0; k < wrist.size(); ++k) p[wrist[k]] = angle[k];
    Placed placed;
    const geometry::Rigid3 moved = hand::pose_skeleton(skeleton, p).forearm;
    for (const auto& [name, motion] : forearm.bone) placed[name] = moved;
    return placed;
  };
  const std::vector<double> angle =
      nearest_angles(angles_of(skeleton, wrist), place, hand, forearm);
  for (std::size_t k = 0; k < wrist.size(); ++k) posture[wrist[k]] = angle[k];
  return posture;
}

Placed fit_fixed_axis_thumb(const hand::Skeleton& skeleton, const FixedAxisCmc& cmc,
                            const ReferenceHand& hand, const PostureMotions& motions,
                            hand::ScanPosture posture) {
  const bool is_flexion =
      posture == hand::ScanPosture::kThumbFlexion || posture == hand::ScanPosture::kThumbExtension;
  const bool is_abduction = posture == hand::ScanPosture::kThumbAbduction ||
                            posture == hand::ScanPosture::kThumbAdduction;
  const double reach = 0.75 * std::numbers::pi;
  // The CMC joint's angles count from the reference posture here; its range isn't its business.
  std::vector<Angle> angles = {{0.0, is_abduction ? 0.0 : -reach, is_abduction ? 0.0 : reach},
                               {0.0, is_flexion ? 0.0 : -reach, is_flexion ? 0.0 : reach}};
  const std::vector<hand::Dof> hinges = {hand::Dof::kThumbMpFlexion, hand::Dof::kThumbIpFlexion};
  for (const Angle& angle : angles_of(skeleton, hinges)) angles.push_back(angle);
  const auto place = [&](const std::vector<double>& angle) {
    Placed placed;
    geometry::Rigid3 motion = cmc.displacement(angle[0], angle[1]);
    placed["thumb_metacarpal"] = motion;
    const std::array<hand::Segment, 2> phalanges = {hand::Segment::kThumbProximal,
                                                    hand::Segment::kThumbDistal};
    for (std::size_t k = 0; k < 2; ++k) {
      const hand::JointDof& dof = skeleton.dof(hinges[k]);
      motion =
          motion * geometry::Rigid3::about_axis(dof.axis, dof.centre, angle[k + 2] - dof.reference);
      placed[phalanx_name(phalanges[k])] = motion;
    }
    return placed;
  };
  return place(nearest_angles(angles, place, hand, motions));
}

}  // namespace palmar::capture
