// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/grasp_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "hands/capture/mri/bones/palm_placement.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::capture {
namespace {

/// Distance of the nearest of the points from a solid, mm; up to `range`.
double nearest(const std::vector<Vec3>& points, const geometry::TriangleMesh& solid, double range) {
  std::vector<geometry::DistanceSample> samples(points.size());
  geometry::MeshDistance(solid).sample(points, range, samples);
  double least = std::numeric_limits<double>::infinity();
  for (const geometry::DistanceSample& s : samples) least = std::min(least, s.distance);
  return least;
}

/// From NIfTI's axes (right, front, head) to DICOM's.
geometry::TriangleMesh in_other_axes(geometry::TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v = Vec3(-v.x(), -v.y(), v.z());
  return mesh;
}

}  // namespace

ScanContact grasp_contact(const ScanRecord& record, const geometry::TriangleMesh& product,
                          const std::string& name) {
  const auto scan = std::find_if(
      record.scans.begin(), record.scans.end(),
      [](const RecordedScan& one) { return one.posture == hand::ScanPosture::kGrasp; });
  const auto angles = record.joints.postures.find(hand::ScanPosture::kGrasp);
  if (scan == record.scans.end() || angles == record.joints.postures.end()) {
    throw InputError(name + ": there is no scan of the posture grasp in which it was held");
  }
  const auto moved_palm = place_palm(record.scans.front().surfaces, scan->surfaces);
  if (!moved_palm) {
    throw InputError(scan->title + ": shows too few bones of the palm to align the hand with it");
  }
  constexpr double kRange = 2.0;   // mm; Xie 2014
  constexpr double kReach = 30.0;  // mm
  const std::vector<Vec3>& skin = scan->surfaces.skin.vertices;
  const double gap = nearest(skin, product, kReach);
  if (gap > kRange) {
    const bool is_turned = nearest(skin, in_other_axes(product), kReach) <= kRange;
    throw InputError(fmt::format(
        "{}: is {}{:.1f} mm from the skin in the scan of the grasp; it must be where it was in the "
        "scanner (patient frame of DICOM: x to the left, y to the back, z to the head){}",
        name, gap >= kReach ? "more than " : "", gap,
        is_turned ? "; with x and y negated it is in the hand, so the file has the axes of NIfTI"
                  : ""));
  }
  const geometry::Rigid3 patient_from_hand = *moved_palm * record.made.patient_from_hand;
  geometry::TriangleMesh posed{hand::pose_skin(record.made.hand, angles->second),
                               record.made.hand.skin.triangles};
  for (Vec3& v : posed.vertices) v = patient_from_hand * v;
  return {name, kRange, contact_overlap(posed, scan->surfaces.skin, product, kRange)};
}

}  // namespace palmar::capture
