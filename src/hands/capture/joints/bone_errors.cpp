// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/joints/bone_errors.h"

#include <string>

#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"

namespace palmar::capture {
namespace {

double mean_distance(const geometry::TriangleMesh& mesh, const geometry::Rigid3& motion,
                     const geometry::ClosestPointQuery& surface) {
  double sum = 0.0;
  std::optional<int> hint;
  for (const Vec3& v : mesh.vertices) {
    const geometry::ClosestPoint found = *surface.closest(motion * v, 1e6, hint);
    hint = found.triangle;
    sum += found.distance;
  }
  return sum / static_cast<double>(mesh.vertices.size());
}

/// One error to be measured.
struct Task {
  BoneError error;
  const ReferenceBone* bone = nullptr;
  const geometry::TriangleMesh* seen = nullptr;
  geometry::Rigid3 patient_from_hand;  ///< of the posture
  geometry::Rigid3 registered, fixed_axis;
  std::optional<geometry::Rigid3> interpolated;
};

const geometry::TriangleMesh* counterpart(const std::vector<BoneMotion>& tracked,
                                          const ScanSurfaces& scan, const std::string& name) {
  for (const BoneMotion& motion : tracked) {
    if (motion.bone != name) continue;
    if (!motion.is_cut_out) return nullptr;
    const ScannedBone* bone =
        bone_named(scan, motion.counterpart.empty() ? name : motion.counterpart);
    return bone != nullptr && !bone->mesh.triangles.empty() ? &bone->mesh : nullptr;
  }
  return nullptr;
}

}  // namespace

std::vector<BoneError> bone_errors(
    const ReferenceHand& hand, const std::map<hand::ScanPosture, ScanSurfaces>& scans,
    const std::map<hand::ScanPosture, std::vector<BoneMotion>>& tracked,
    const MotionsByPosture& motions, const std::map<hand::ScanPosture, hand::Posture>& postures,
    const hand::Skeleton& skeleton, const FixedAxisCmc& fixed_cmc) {
  std::vector<Task> tasks;
  for (const auto& [posture, moved] : motions) {
    const auto scan = scans.find(posture);
    const auto angles = postures.find(posture);
    const auto found = tracked.find(posture);
    if (scan == scans.end() || angles == postures.end() || found == tracked.end()) continue;
    const hand::PosedSkeleton posed = hand::pose_skeleton(skeleton, angles->second);
    const std::map<std::string, geometry::Rigid3> fixed_thumb =
        fit_fixed_axis_thumb(skeleton, fixed_cmc, hand, moved, posture);
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      const bool is_thumb = finger == hand::Finger::kThumb;
      const std::map<std::string, geometry::Rigid3> placed = bones_of_finger(posed, finger);
      for (const std::string& name : ray_of(finger)) {
        const auto model = placed.find(name);
        const auto motion = moved.bone.find(name);
        const auto bone = hand.bones.find(name);
        if (model == placed.end() || motion == moved.bone.end() || bone == hand.bones.end()) {
          continue;
        }
        const geometry::TriangleMesh* seen = counterpart(found->second, scan->second, name);
        if (seen == nullptr) continue;
        Task task;
        task.error.posture = posture;
        task.error.bone = name;
        task.bone = &bone->second;
        task.seen = seen;
        task.patient_from_hand = moved.posture_from_reference * hand.patient_from_hand;
        task.registered = motion->second;
        task.fixed_axis = is_thumb ? fixed_thumb.at(name) : model->second;
        if (is_thumb) task.interpolated = model->second;
        tasks.push_back(task);
      }
    }
  }
  parallel_for(static_cast<int>(tasks.size()), [&](int k) {
    Task& task = tasks[k];
    const geometry::ClosestPointQuery surface(*task.seen);
    const auto error = [&](const geometry::Rigid3& motion) {
      return mean_distance(task.bone->mesh, task.patient_from_hand * motion, surface);
    };
    task.error.icp = error(task.registered);
    task.error.single_axis = error(task.fixed_axis);
    if (task.interpolated) task.error.interpolated_cmc = error(*task.interpolated);
  });
  std::vector<BoneError> errors;
  for (Task& task : tasks) errors.push_back(std::move(task.error));
  return errors;
}

}  // namespace palmar::capture
