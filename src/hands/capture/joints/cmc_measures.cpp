// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/axis_fit.h"
#include "hands/capture/joints/joint_measures.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "hands/capture/two_axis_fit.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

constexpr double kLeastLimit =
    2.0 * geometry::kDegree;  // a limit nearer to the reference posture isn't one
constexpr const char* kMetacarpal = "thumb_metacarpal";

/// One of the four limit postures.
struct Limit {
  hand::ScanPosture posture;
  MainAxis axis;
  double sense;  ///< +1 for flexion and abduction
  hand::CmcLimit hand::ThumbCmc::*place;
  std::optional<geometry::Rigid3> motion;
  double angle = 0.0;  ///< about its axis, as measured; sense included
};

std::array<Limit, 4> limits_in(const MotionsByPosture& motions) {
  std::array<Limit, 4> limits = {
      {{hand::ScanPosture::kThumbFlexion, MainAxis::kFirst, 1.0, &hand::ThumbCmc::flexion, {}, 0.0},
       {hand::ScanPosture::kThumbExtension,
        MainAxis::kFirst,
        -1.0,
        &hand::ThumbCmc::extension,
        {},
        0.0},
       {hand::ScanPosture::kThumbAbduction,
        MainAxis::kSecond,
        1.0,
        &hand::ThumbCmc::abduction,
        {},
        0.0},
       {hand::ScanPosture::kThumbAdduction,
        MainAxis::kSecond,
        -1.0,
        &hand::ThumbCmc::adduction,
        {},
        0.0}}};
  for (Limit& limit : limits) {
    const auto found = motions.find(limit.posture);
    if (found != motions.end()) limit.motion = motion_between(found->second, "", kMetacarpal);
  }
  return limits;
}

/// The point that all motions move least, near `seat`: min sum |N c - c|^2 + (|c - seat| / 3)^2.
Vec3 pivot_of(const std::array<Limit, 4>& limits, const Vec3& seat) {
  constexpr double kSeatSd = 3.0;  // mm for 1 mm of motion
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity() / (kSeatSd * kSeatSd);
  Vec3 b = Vec3::Zero();
  for (const Limit& limit : limits) {
    if (!limit.motion) continue;
    const Eigen::Matrix3d still =
        limit.motion->rotation.toRotationMatrix() - Eigen::Matrix3d::Identity();
    A += still.transpose() * still;
    b -= still.transpose() * (*limit.motion * seat - seat);
  }
  return seat + A.ldlt().solve(b);
}

/// Fixed axes by the motions of each pair alone; where none is known, the joint's.
FixedAxisCmc fixed_axes(const std::array<Limit, 4>& limits, const ReferenceBone& bone,
                        const hand::JointDof& flexion, const hand::JointDof& abduction,
                        const Vec3& centre) {
  FixedAxisCmc fixed{flexion.axis, flexion.centre, abduction.axis, abduction.centre};
  for (const MainAxis which : {MainAxis::kFirst, MainAxis::kSecond}) {
    std::vector<geometry::Rigid3> motions;
    for (const Limit& limit : limits) {
      if (limit.axis == which && limit.motion) motions.push_back(*limit.motion);
    }
    if (motions.empty()) continue;
    const HingeFit fit = fit_hinge(motions, bone.points, centre);
    if (!fit.is_observed) continue;
    const bool is_flexion = which == MainAxis::kFirst;
    Vec3& axis = is_flexion ? fixed.flexion_axis : fixed.abduction_axis;
    axis = fit.axis.dot(axis) < 0.0 ? (-fit.axis).eval() : fit.axis;
    (is_flexion ? fixed.flexion_point : fixed.abduction_point) = fit.point;
  }
  return fixed;
}

}  // namespace

void measure_cmc(ReferenceHand& hand, const hand::Hand& model, const MotionsByPosture& motions,
                 JointMeasures& measures) {
  Vec3& node = hand.ray[0].node[0];
  const auto bone = hand.bones.find(kMetacarpal);
  const auto trapezium = hand.bones.find("trapezium");
  if (bone != hand.bones.end() && trapezium != hand.bones.end()) {
    node = joint_surface_point(bone->second.mesh, trapezium->second.mesh);
  }
  std::array<Limit, 4> limits = limits_in(motions);
  if (bone == hand.bones.end()) {
    for (Limit& limit : limits) limit.motion.reset();
  }
  node = pivot_of(limits, node);

  // Flexion is fixed to the trapezium: its axis lies in the palm as the model's does.
  hand::JointDof flexion = model.skeleton.dof(hand::Dof::kThumbCmcFlexion);
  hand::JointDof abduction = model.skeleton.dof(hand::Dof::kThumbCmcAbduction);
  const hand::Joint& drawn = model.skeleton.joint(hand::JointId::kThumbCmc);
  abduction.axis = hand.from_model(hand::Finger::kThumb, 0, abduction.axis);
  abduction.centre =
      node + hand.scale * hand.from_model(hand::Finger::kThumb, 0,
                                          model.skeleton.dof(hand::Dof::kThumbCmcAbduction).centre -
                                              drawn.centre);
  flexion.centre = node + hand.scale * (flexion.centre - drawn.centre);
  const double flexion_up = flexion.upper - flexion.reference;
  const double flexion_down = flexion.lower - flexion.reference;
  for (hand::JointDof* dof : {&flexion, &abduction}) {
    dof->source = "axis: the model's, moved onto the bones (" + dof->source + ")";
  }

  std::vector<geometry::Rigid3> known;
  std::vector<MainAxis> main;
  for (const Limit& limit : limits) {
    if (!limit.motion) continue;
    known.push_back(*limit.motion);
    main.push_back(limit.axis);
  }
  if (!known.empty()) {
    TwoAxisPrior prior;
    prior.near = node;
    prior.place_sd = 5.0;  // the axes are some 5 mm apart (Mirakhorlo et al. 2016)
    prior.first = flexion.axis;
    prior.second = abduction.axis;
    prior.square_sd = 0.5;
    prior.slide_sd = 10.0;  // the saddle is a screw: free
    prior.by_first_sd = prior.by_second_sd = 0.05;
    const TwoAxisFit fit = fit_two_axes(known, main, bone->second.points, prior);
    std::string source = "axis: measured between scans (reference";
    std::size_t k = 0;
    for (Limit& limit : limits) {
      if (!limit.motion) continue;
      source += ", " + std::string(name_of(limit.posture));
      limit.angle = limit.sense * fit.angle[k][limit.axis == MainAxis::kFirst ? 0 : 1];
      ++k;
    }
    source += ")";
    if (fit.is_first_observed) {
      flexion.axis = fit.first_axis;
      flexion.centre = fit.first_point;
      flexion.source = source;
    }
    if (fit.is_second_observed) {
      abduction.axis = fit.second_axis;
      abduction.centre = fit.second_point;
      abduction.source = source;
    }
  }
  // Zero of flexion: the reference posture; of abduction: metacarpal in the plane of the palm.
  const double abduction_up = abduction.upper - abduction.reference;
  const double abduction_down = abduction.lower - abduction.reference;
  const Vec3 along = hand.nodes(hand::Finger::kThumb).direction(0);
  const Vec3 across = (along - along.dot(abduction.axis) * abduction.axis).normalized();
  flexion.reference = 0.0;
  abduction.reference = std::asin(std::clamp(across.z(), -1.0, 1.0));

  const std::array<double, 4> model_angle = {flexion_up, -flexion_down, abduction_up,
                                             -abduction_down};
  bool has_flexion = false, has_abduction = false;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    Limit& limit = limits[k];
    hand::CmcLimit& place = measures.skeleton.thumb_cmc.*limit.place;
    if (limit.motion && limit.angle < kLeastLimit) {
      measures.notes.push_back(
          fmt::format("{}: the thumb's metacarpal is {:.0f} degrees from the reference posture in "
                      "that sense; the model's range is taken there instead.",
                      name_of(limit.posture), limit.angle / geometry::kDegree));
      limit.motion.reset();
    }
    const hand::JointDof& dof = limit.axis == MainAxis::kFirst ? flexion : abduction;
    if (limit.motion) {
      place.q = limit.motion->rotation;
      if (place.q.w() < 0.0) place.q.coeffs() = -place.q.coeffs();
      place.t = *limit.motion * node - node;
      (limit.axis == MainAxis::kFirst ? has_flexion : has_abduction) = true;
    } else {
      limit.angle = std::max(model_angle[k], kLeastLimit);
      const geometry::Rigid3 turn =
          geometry::Rigid3::about_axis(dof.axis, dof.centre, limit.sense * limit.angle);
      place = {turn.rotation, turn * node - node};
    }
  }
  flexion.upper = limits[0].angle;
  flexion.lower = -limits[1].angle;
  abduction.upper = abduction.reference + limits[2].angle;
  abduction.lower = abduction.reference - limits[3].angle;
  if (has_flexion) flexion.source += "; range: scanned limits";
  if (has_abduction) abduction.source += "; range: scanned limits";
  measures.measured(hand::Dof::kThumbCmcFlexion) = has_flexion;
  measures.measured(hand::Dof::kThumbCmcAbduction) = has_abduction;
  measures.skeleton.joints[index_of(hand::JointId::kThumbCmc)] = {
      hand::JointId::kThumbCmc, node, {abduction, flexion}};
  measures.fixed_cmc = {flexion.axis, flexion.centre, abduction.axis, abduction.centre};
  if (bone != hand.bones.end()) {
    measures.fixed_cmc = fixed_axes(limits, bone->second, flexion, abduction, node);
  }
}

}  // namespace palmar::capture
