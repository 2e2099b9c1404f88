// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/dotted_thumb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hands/capture/axis_fit.h"
#include "hands/capture/joints/joint_measures.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::capture {
namespace {

constexpr double kDotSd = 1.0, kBaseSd = 1.5;        // mm
constexpr double kTurnSd = 8.0 * geometry::kDegree;  // rad

geometry::Rigid3 hinge(const hand::JointDof& dof, double angle) {
  return geometry::Rigid3::about_axis(dof.axis, dof.centre, angle - dof.reference);
}

Quat turn_of(const Vec3& rotation) {
  const double angle = rotation.norm();
  return angle < 1e-12 ? Quat::Identity() : Quat(Eigen::AngleAxisd(angle, rotation / angle));
}

std::array<Vec3, 6> metacarpal_points(const hand::Hand& hand) {
  for (const hand::Bone& bone : hand.bones) {
    if (bone.is_thumb_metacarpal) return moment_points(bone.mesh);
  }
  const Vec3& base = hand.skeleton.joint(hand::JointId::kThumbCmc).centre;
  const Vec3& head = hand.skeleton.joint(hand::JointId::kThumbMp).centre;
  return {base,
          head,
          base + Vec3(5, 0, 0),
          base + Vec3(0, 0, 5),
          head + Vec3(5, 0, 0),
          head + Vec3(0, 0, 5)};
}

/// The four limit transforms, the joint's axes and ranges.
void measure_limits(const hand::Hand& hand,
                    const std::map<hand::ScanPosture, ThumbReading>& readings,
                    MeasuredJoints& joints) {
  // The person's own hand is its own model: what isn't given stays.
  ReferenceHand reference;
  const auto of = [&](hand::JointId id) { return joints.skeleton.joint(id).centre; };
  reference.ray[0] = {{of(hand::JointId::kThumbCmc), of(hand::JointId::kThumbMp),
                       of(hand::JointId::kThumbIp), joints.skeleton.fingertips[0]},
                      {true, true, true, true}};
  reference.model_ray = reference.ray;
  reference.bones["thumb_metacarpal"].points = metacarpal_points(hand);
  hand::Hand model;
  model.skeleton = joints.skeleton;
  MotionsByPosture motions;
  for (const auto& [posture, reading] : readings) {
    if (is_thumb_limit(posture)) motions[posture].bone["thumb_metacarpal"] = reading.metacarpal;
  }
  JointMeasures measures;
  measures.skeleton = joints.skeleton;
  measure_cmc(reference, model, motions, measures);
  const hand::Joint& cmc = measures.skeleton.joint(hand::JointId::kThumbCmc);
  for (const hand::JointDof& dof : cmc.dofs) {
    const double change = dof.reference - joints.skeleton.dof(dof.dof).reference;
    for (auto& [name, posture] : joints.postures) posture[dof.dof] += change;
    joints.is_measured[index_of(dof.dof)] = measures.measured(dof.dof);
  }
  joints.skeleton.joints[index_of(hand::JointId::kThumbCmc)] = cmc;
  joints.skeleton.thumb_cmc = measures.skeleton.thumb_cmc;
  joints.notes.insert(joints.notes.end(), measures.notes.begin(), measures.notes.end());
}

/// The two angles of the joint that carry the metacarpal nearest to where a motion does.
void carry_metacarpal(const hand::Skeleton& skeleton, const std::array<Vec3, 6>& points,
                      const geometry::Rigid3& motion, hand::Posture& posture) {
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    hand::Posture tried = posture;
    tried[hand::Dof::kThumbCmcFlexion] = x[0];
    tried[hand::Dof::kThumbCmcAbduction] = x[1];
    const geometry::Rigid3 own = hand::cmc_displacement(skeleton, hand::cmc_share(skeleton, tried));
    r.resize(18);
    for (std::size_t k = 0; k < points.size(); ++k) {
      r.segment<3>(static_cast<Eigen::Index>(3 * k)) = own * points[k] - motion * points[k];
    }
  };
  geometry::LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Constant(2, -std::numbers::pi / 2.0);
  problem.upper = Eigen::VectorXd::Constant(2, std::numbers::pi / 2.0);
  problem.evaluate = geometry::with_numeric_jacobian(residual);
  const Eigen::VectorXd start{
      {posture[hand::Dof::kThumbCmcFlexion], posture[hand::Dof::kThumbCmcAbduction]}};
  const geometry::LeastSquaresSolution found =
      geometry::solve_least_squares(problem, start, {.max_iterations = 40});
  posture[hand::Dof::kThumbCmcFlexion] = found.x[0];
  posture[hand::Dof::kThumbCmcAbduction] = found.x[1];
}

}  // namespace

bool is_thumb_limit(hand::ScanPosture posture) {
  return posture == hand::ScanPosture::kThumbFlexion ||
         posture == hand::ScanPosture::kThumbExtension ||
         posture == hand::ScanPosture::kThumbAbduction ||
         posture == hand::ScanPosture::kThumbAdduction;
}

ThumbReading read_thumb(const ThumbDots& dots, const hand::Skeleton& skeleton,
                        const hand::Posture& by_skin) {
  const hand::JointDof& mp = skeleton.dof(hand::Dof::kThumbMpFlexion);
  const hand::JointDof& ip = skeleton.dof(hand::Dof::kThumbIpFlexion);
  const Vec3& base = skeleton.joint(hand::JointId::kThumbCmc).centre;
  const geometry::Rigid3 start = hand::pose_skeleton(skeleton, by_skin).thumb_metacarpal;
  const auto reading = [&](const Eigen::VectorXd& x) {
    ThumbReading r;
    const Quat turn = start.rotation * turn_of(x.segment<3>(3));
    r.metacarpal = {turn, start * base + x.head<3>() - turn * base};
    r.mp = by_skin[mp.dof] + x[6];
    r.ip = by_skin[ip.dof] + x[7];
    return r;
  };
  const std::size_t proximal = dots.x_proximal.size(), distal = dots.x_distal.size();
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    const ThumbReading now = reading(x);
    const geometry::Rigid3 first = now.metacarpal * hinge(mp, now.mp),
                           last = first * hinge(ip, now.ip);
    r.resize(static_cast<Eigen::Index>(3 * (proximal + distal) + 8));
    Eigen::Index row = 0;
    for (std::size_t k = 0; k < proximal; ++k, row += 3) {
      r.segment<3>(row) = (first * dots.x_proximal[k] - dots.y_proximal[k]) / kDotSd;
    }
    for (std::size_t k = 0; k < distal; ++k, row += 3) {
      r.segment<3>(row) = (last * dots.x_distal[k] - dots.y_distal[k]) / kDotSd;
    }
    r.segment<3>(row) = x.head<3>() / kBaseSd;
    r.tail<5>() = x.tail<5>() / kTurnSd;
  };
  geometry::LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Constant(8, -1.5);
  problem.upper = Eigen::VectorXd::Constant(8, 1.5);
  problem.lower.head<3>().setConstant(-10.0);
  problem.upper.head<3>().setConstant(10.0);
  problem.evaluate = geometry::with_numeric_jacobian(residual);
  const geometry::LeastSquaresSolution found =
      geometry::solve_least_squares(problem, Eigen::VectorXd::Zero(8), {.max_iterations = 60});
  ThumbReading result = reading(found.x);
  result.dots = static_cast<int>(proximal + distal);
  if (result.dots > 0) {
    const double squared = found.residual.head(found.residual.size() - 8).squaredNorm();
    result.residual = kDotSd * std::sqrt(squared / result.dots);
  }
  return result;
}

void take_thumb_readings(const hand::Hand& hand,
                         const std::map<hand::ScanPosture, ThumbReading>& readings,
                         MeasuredJoints& joints) {
  const std::array<Vec3, 6> points = metacarpal_points(hand);
  if (std::any_of(readings.begin(), readings.end(),
                  [](const auto& r) { return is_thumb_limit(r.first); })) {
    measure_limits(hand, readings, joints);
  }
  const hand::Skeleton& skeleton = joints.skeleton;
  for (const auto& [name, reading] : readings) {
    hand::Posture& posture = joints.postures[name];
    if (is_thumb_limit(name)) posture = hand::reference_posture(skeleton);
    posture[hand::Dof::kThumbMpFlexion] = reading.mp;
    posture[hand::Dof::kThumbIpFlexion] = reading.ip;
    const hand::JointDof& flexion = skeleton.dof(hand::Dof::kThumbCmcFlexion);
    const hand::JointDof& abduction = skeleton.dof(hand::Dof::kThumbCmcAbduction);
    if (name == hand::ScanPosture::kThumbFlexion) posture[flexion.dof] = flexion.upper;
    if (name == hand::ScanPosture::kThumbExtension) posture[flexion.dof] = flexion.lower;
    if (name == hand::ScanPosture::kThumbAbduction) posture[abduction.dof] = abduction.upper;
    if (name == hand::ScanPosture::kThumbAdduction) posture[abduction.dof] = abduction.lower;
    if (!is_thumb_limit(name)) carry_metacarpal(skeleton, points, reading.metacarpal, posture);
  }
}

}  // namespace palmar::capture
