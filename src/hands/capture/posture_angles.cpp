// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/posture_angles.h"

#include <algorithm>
#include <functional>
#include <numbers>

#include "hands/capture/axis_fit.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar {
namespace {

/// One angle that is looked for.
struct Angle {
  double start = 0.0, lower = 0.0, upper = 0.0;  ///< rad
};

using Placed = std::map<std::string, Rigid3>;

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
      const Rigid3& model = placed.at(name);
      const Rigid3& seen = motions.bone.at(name);
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
  LeastSquaresProblem problem;
  problem.evaluate = with_numeric_jacobian(residual);
  problem.lower.resize(n);
  problem.upper.resize(n);
  Eigen::VectorXd x(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Angle& angle = angles[free[j]];
    problem.lower[j] = angle.lower;
    problem.upper[j] = angle.upper;
    x[j] = std::clamp(angle.start, angle.lower, angle.upper);
  }
  const LeastSquaresSolution found = solve_least_squares(
      problem, x, {.max_iterations = 100, .gradient_tolerance = 1e-8, .step_tolerance = 1e-9});
  for (Eigen::Index j = 0; j < n; ++j) all[free[j]] = found.x[j];
  return all;
}

std::vector<Dof> dofs_of(const Skeleton& skeleton, Finger finger) {
  std::vector<Dof> dofs;
  const auto add = [&](JointId id) {
    for (const JointDof& dof : skeleton.joint(id).dofs) dofs.push_back(dof.dof);
  };
  if (finger == Finger::kThumb) add(JointId::kThumbCmc);
  for (const auto& segment : segments_of(finger)) {
    if (segment) add(joint_of(*segment));
  }
  return dofs;
}

std::vector<Angle> angles_of(const Skeleton& skeleton, const std::vector<Dof>& dofs) {
  std::vector<Angle> angles;
  for (const Dof d : dofs) {
    const JointDof& dof = skeleton.dof(d);
    angles.push_back({dof.reference, dof.lower, dof.upper});
  }
  return angles;
}

}  // namespace

Placed bones_of_finger(const PosedSkeleton& posed, Finger finger) {
  Placed placed;
  if (finger == Finger::kThumb) placed["thumb_metacarpal"] = posed.thumb_metacarpal;
  for (const auto& segment : segments_of(finger)) {
    if (segment) {
      placed[phalanx_name(*segment)] = posed.segment[index_of(*segment)];
    }
  }
  return placed;
}

Posture fit_angles(const Skeleton& skeleton, const ReferenceHand& hand,
                   const PostureMotions& motions) {
  Posture posture = reference_posture(skeleton);
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const std::vector<Dof> dofs = dofs_of(skeleton, finger);
    const auto place = [&](const std::vector<double>& angle) {
      Posture p = reference_posture(skeleton);
      for (std::size_t k = 0; k < dofs.size(); ++k) p[dofs[k]] = angle[k];
      return bones_of_finger(pose_skeleton(skeleton, p), finger);
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
  const std::vector<Dof> wrist = {Dof::kWristFlexion, Dof::kWristDeviation, Dof::kWristPronation};
  const auto place = [&](const std::vector<double>& angle) {
    Posture p = reference_posture(skeleton);
    for (std::size_t k = 0; k < wrist.size(); ++k) p[wrist[k]] = angle[k];
    Placed placed;
    const Rigid3 moved = pose_skeleton(skeleton, p).forearm;
    for (const auto& [name, motion] : forearm.bone) placed[name] = moved;
    return placed;
  };
  const std::vector<double> angle =
      nearest_angles(angles_of(skeleton, wrist), place, hand, forearm);
  for (std::size_t k = 0; k < wrist.size(); ++k) posture[wrist[k]] = angle[k];
  return posture;
}

Placed fit_fixed_axis_thumb(const Skeleton& skeleton, const FixedAxisCmc& cmc,
                            const ReferenceHand& hand, const PostureMotions& motions,
                            ScanPosture posture) {
  const bool is_flexion =
      posture == ScanPosture::kThumbFlexion || posture == ScanPosture::kThumbExtension;
  const bool is_abduction =
      posture == ScanPosture::kThumbAbduction || posture == ScanPosture::kThumbAdduction;
  const double reach = 0.75 * std::numbers::pi;
  // The CMC joint's angles count from the reference posture here; its range isn't its business.
  std::vector<Angle> angles = {{0.0, is_abduction ? 0.0 : -reach, is_abduction ? 0.0 : reach},
                               {0.0, is_flexion ? 0.0 : -reach, is_flexion ? 0.0 : reach}};
  const std::vector<Dof> hinges = {Dof::kThumbMpFlexion, Dof::kThumbIpFlexion};
  for (const Angle& angle : angles_of(skeleton, hinges)) angles.push_back(angle);
  const auto place = [&](const std::vector<double>& angle) {
    Placed placed;
    Rigid3 motion = cmc.displacement(angle[0], angle[1]);
    placed["thumb_metacarpal"] = motion;
    const std::array<Segment, 2> phalanges = {Segment::kThumbProximal, Segment::kThumbDistal};
    for (std::size_t k = 0; k < 2; ++k) {
      const JointDof& dof = skeleton.dof(hinges[k]);
      motion = motion * Rigid3::about_axis(dof.axis, dof.centre, angle[k + 2] - dof.reference);
      placed[phalanx_name(phalanges[k])] = motion;
    }
    return placed;
  };
  return place(nearest_angles(angles, place, hand, motions));
}

}  // namespace palmar
