// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/placed_skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "hands/capture/posed_model.h"
#include "hands/capture/skin_registration.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/geometry/rotation.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/instance/segment_scaling.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/skeleton_in_posture.h"

namespace palmar::capture {
namespace {

hand::Hand uniformly_sized(const hand::Hand& model, double factor) {
  hand::SegmentScales scales;
  for (auto& f : scales.segment) f = {factor, factor, factor};
  return hand::SegmentScaling(model).hand(scales);
}

/// Affine map of space near a point.
struct Affine {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Vec3 point(const Vec3& p) const { return to + linear * (p - from); }
  Vec3 direction(const Vec3& d) const { return (linear * d).normalized(); }
};

/// How the skin round `centre` moved: sum w |A (x - x0) - (y - y0)|^2 + held |A - R|^2 least, R the
/// rotation nearest to the A of held = 0.
Affine map_of_skin(const std::vector<Vec3>& before, const std::vector<Vec3>& after,
                   const std::vector<char>& may_count, const Vec3& centre, double breadth) {
  std::vector<std::size_t> near;
  std::vector<double> weight;
  Affine map;
  double sum = 0.0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double squared = (before[v] - centre).squaredNorm();
    if (!may_count[v] || squared > 9.0 * breadth * breadth) continue;
    const double w = std::exp(-0.5 * squared / (breadth * breadth));
    near.push_back(v);
    weight.push_back(w);
    sum += w;
    map.from += w * before[v];
    map.to += w * after[v];
  }
  if (sum < 1e-9) return {centre, centre, Eigen::Matrix3d::Identity()};
  map.from /= sum;
  map.to /= sum;
  Eigen::Matrix3d xx = Eigen::Matrix3d::Zero(), yx = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < near.size(); ++k) {
    const Vec3 x = before[near[k]] - map.from, y = after[near[k]] - map.to;
    xx += weight[k] / sum * x * x.transpose();
    yx += weight[k] / sum * y * x.transpose();
  }
  const double held = 0.5 * xx.trace() / 3.0;
  map.linear = (yx + held * geometry::fit_rotation(yx)) *
               (xx + held * Eigen::Matrix3d::Identity()).inverse();
  return map;
}

/// Parts of the skin that describe a joint: the segments on either side of it.
std::vector<char> beside_joint(const std::vector<hand::Segment>& segment, hand::JointId id) {
  std::set<hand::Segment> sides;
  if (id == hand::JointId::kWrist || id == hand::JointId::kThumbCmc) {
    sides.insert(hand::Segment::kPalm);
  } else {
    for (int f = 0; f < hand::kFingerCount; ++f) {
      hand::Segment before = hand::Segment::kPalm;
      for (const auto& s : hand::segments_of(static_cast<hand::Finger>(f))) {
        if (!s) continue;
        if (hand::joint_of(*s) == id) sides = {before, *s};
        before = *s;
      }
    }
  }
  std::vector<char> result(segment.size());
  for (std::size_t v = 0; v < segment.size(); ++v) result[v] = sides.count(segment[v]) > 0 ? 1 : 0;
  return result;
}

/// Joints as the skin carries them, and the hand frame again by them.
void carry_joints(const hand::Hand& model, const RegisteredSkin& registered,
                  hand::Skeleton& skeleton) {
  const std::vector<Vec3> before = skin_at(registered.start, skeleton);
  const double size = (skeleton.joint(hand::JointId::kMiddleMcp).centre -
                       skeleton.joint(hand::JointId::kWrist).centre)
                          .norm() /
                      90.0;
  for (hand::Joint& joint : skeleton.joints) {
    const bool is_large = joint.id == hand::JointId::kWrist || joint.id == hand::JointId::kThumbCmc;
    const bool is_knuckle = joint.dofs.size() == 2 && !is_large;
    const double breadth = size * (is_large ? 16.0 : is_knuckle ? 12.0 : 8.0);
    const Affine map = map_of_skin(before, registered.skin, beside_joint(model.segment, joint.id),
                                   joint.centre, breadth);
    joint.centre = map.point(joint.centre);
    for (hand::JointDof& dof : joint.dofs) {
      dof.centre = map.point(dof.centre);
      dof.axis = map.direction(dof.axis);
    }
  }
  for (int f = 0; f < hand::kFingerCount; ++f) {
    skeleton.fingertips[f] =
        fingertip_of(registered.skin, model.segment, skeleton, static_cast<hand::Finger>(f));
  }
}

/// Puts the hand frame where the joints have it (hand_frame.h).
void place_frame(PlacedSkeleton& placed) {
  hand::Skeleton& skeleton = placed.skeleton;
  const Vec3 wrist = skeleton.joint(hand::JointId::kWrist).centre;
  const double radial = placed.side == hand::Side::kLeft ? -1.0 : 1.0;  // x of a left hand is ulnar
  const Vec3 y = (skeleton.joint(hand::JointId::kMiddleMcp).centre - wrist).normalized();
  const Vec3 across = radial * (skeleton.joint(hand::JointId::kIndexMcp).centre -
                                skeleton.joint(hand::JointId::kLittleMcp).centre);
  const Vec3 x = (across - across.dot(y) * y).normalized();
  Eigen::Matrix3d axes;
  axes << x, y, x.cross(y);
  const geometry::Rigid3 old_from_new{Quat(axes).normalized(), wrist};
  const geometry::Rigid3 new_from_old = old_from_new.inverse();
  for (hand::Joint& joint : skeleton.joints) {
    joint.centre = new_from_old * joint.centre;
    for (hand::JointDof& dof : joint.dofs) {
      dof.centre = new_from_old * dof.centre;
      dof.axis = new_from_old.rotation * dof.axis;
    }
  }
  for (hand::CmcLimit* limit : {&skeleton.thumb_cmc.flexion, &skeleton.thumb_cmc.extension,
                                &skeleton.thumb_cmc.abduction, &skeleton.thumb_cmc.adduction}) {
    limit->q = new_from_old.rotation * limit->q * old_from_new.rotation;
    limit->t = new_from_old.rotation * limit->t;
  }
  for (Vec3& tip : skeleton.fingertips) tip = new_from_old * tip;
  placed.scan_from_hand = placed.scan_from_hand * old_from_new;
}

/// One size for the whole hand is wrong where fingers are long and the palm is narrow: the model
/// with shorter or longer fingers may lie better. Skin hardly shows by how much, but whether.
void take_better_lengths(hand::Hand& base, const geometry::TriangleMesh& mesh, hand::MeshFit& fit,
                         const Progress& progress) {
  constexpr std::array<double, 4> kLonger{0.92, 1.08, 1.16, 1.24};
  std::array<hand::Hand, kLonger.size()> hand;
  std::array<hand::MeshFit, kLonger.size()> tried;
  parallel_for(static_cast<int>(kLonger.size()), [&](int k) {
    if (progress.is_cancelled()) return;
    std::vector<hand::SizedDimension> lengths;
    for (int s = 1; s < hand::kSegmentCount; ++s) {
      lengths.push_back({{hand::DimensionKind::kSegmentLength, static_cast<hand::Segment>(s)},
                         kLonger[k] * base.dimensions.segment[s].length});
    }
    hand[k] = hand::make_hand_instance(base, lengths).hand;
    tried[k] = hand::fit_posture_to_mesh(hand[k], mesh, {.fits_scale = true});
  });
  progress.throw_if_cancelled();
  const hand::Hand* best = nullptr;
  for (std::size_t k = 0; k < tried.size(); ++k) {
    if (tried[k].status != hand::PostureFitStatus::kFitted || tried[k].mean >= fit.mean) continue;
    fit = tried[k];
    best = &hand[k];
  }
  if (best != nullptr) base = *best;
}

}  // namespace

PlacedSkeleton place_skeleton(const hand::Hand& model, const geometry::TriangleMesh& mesh,
                              std::optional<hand::Side> side, const std::string& name,
                              const Progress& progress) {
  PlacedSkeleton placed;
  const hand::MeshFitOptions options{.fits_scale = true};
  hand::Hand base = side && *side != model.side ? hand::mirrored(model) : model;
  placed.fit = hand::fit_posture_to_mesh(base, mesh, options, part_of(progress, 0.0, 0.4));
  if (placed.fit.status == hand::PostureFitStatus::kMirrored) {
    base = hand::mirrored(base);
    if (side) {
      throw InputError(fmt::format(
          "{}: shows a {} hand, not a {} one; or its axes were mirrored when it was exported", name,
          name_of(base.side), name_of(*side)));
    }
    placed.fit = hand::fit_posture_to_mesh(base, mesh, options, part_of(progress, 0.4, 0.6));
  }
  if (placed.fit.status != hand::PostureFitStatus::kFitted) {
    throw InputError(name + ": no hand found: " + placed.fit.message);
  }
  placed.side = base.side;
  take_better_lengths(base, mesh, placed.fit, part_of(progress, 0.6, 0.7));
  const hand::Hand sized = uniformly_sized(base, placed.fit.scale);
  placed.skeleton = hand::skeleton_in_posture(sized.skeleton, placed.fit.posture);
  placed.scan_from_hand = placed.fit.mesh_from_hand;
  const geometry::Rigid3 hand_from_scan = placed.scan_from_hand.inverse();
  SkinScan scan;
  scan.skin = mesh;
  for (Vec3& v : scan.skin.vertices) v = hand_from_scan * v;
  const RegisteredSkin registered =
      register_skin(base, scan, placed.skeleton, part_of(progress, 0.7, 1.0));
  carry_joints(base, registered, placed.skeleton);
  place_frame(placed);
  return placed;
}

void shift_to_creases(PlacedSkeleton& placed, const FoundCreases& creases) {
  constexpr double kShare = 0.85;
  hand::Skeleton& skeleton = placed.skeleton;
  const auto wrist = creases.shift.find(hand::Segment::kPalm);
  if (wrist != creases.shift.end()) {
    hand::Joint& joint = skeleton.joints[index_of(hand::JointId::kWrist)];
    const Vec3 by = wrist->second * Vec3::UnitY();
    joint.centre += by;
    for (hand::JointDof& dof : joint.dofs) dof.centre += by;
  }
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    for (std::size_t k = 1; k < 3; ++k) {
      if (!chain[k]) continue;
      const auto shift = creases.shift.find(*chain[k]);
      if (shift == creases.shift.end()) continue;
      hand::Joint& joint = skeleton.joints[index_of(hand::joint_of(*chain[k]))];
      const Vec3 by = kShare * shift->second * creases.plane.at(*chain[k]).normal;
      joint.centre += by;
      for (hand::JointDof& dof : joint.dofs) dof.centre += by;
    }
  }
  place_frame(placed);
}

}  // namespace palmar::capture
