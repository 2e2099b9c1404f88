// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "hands/capture/mri/bones/bone_tracking.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::capture {

/// Points along a finger: base of its metacarpal (the thumb's CMC joint), centres of its joints
/// from proximal to distal, its tip (of the skin; without skin, of the last bone). Five for a
/// finger, four for the thumb; mm.
struct RayNodes {
  std::vector<Vec3> node;
  std::vector<bool> is_seen;  ///< in the scan; else put where the model's proportions have it

  /// Unit direction from node k to the next.
  Vec3 direction(std::size_t k) const { return (node[k + 1] - node[k]).normalized(); }
};

/// One bone of the reference scan, hand frame.
struct ReferenceBone {
  geometry::TriangleMesh mesh;
  std::array<Vec3, 6> points;  ///< moment_points()
};

/// The hand of the reference scan in its own hand frame, placed over a model.
struct ReferenceHand {
  geometry::Rigid3 patient_from_hand;
  std::map<std::string, ReferenceBone> bones;
  std::array<RayNodes, hand::kFingerCount> ray;        ///< hand frame
  std::array<RayNodes, hand::kFingerCount> model_ray;  ///< of the model in its reference posture
  double scale = 1.0;                                  ///< size over the model's, by the palm

  const RayNodes& nodes(hand::Finger f) const { return ray[index_of(f)]; }
  /// A direction that moves with the model's link k of a finger, as it lies in the scan: turned by
  /// the least turn that places the model's link on the scan's.
  Vec3 from_model(hand::Finger finger, std::size_t link, const Vec3& direction) const;
};

/// Hand frame as hand_frame.h defines it: origin at the wrist joint's centre, which the model's
/// palm bones put there (similarity of the bones' centres and ends by name); y to the MCP joint of
/// the middle finger; x in the plane with those of index and little finger. `model` is of the
/// scan's side. Throws InputError with fewer than three bones of the palm to go by.
ReferenceHand place_reference(const ScanSurfaces& reference, const hand::Hand& model);

/// Proximal and distal end of a bone on its longest principal axis, or, if it is hardly longer than
/// broad, on the one that points to `distal`, a point beyond it, which distinguishes the ends.
std::array<Vec3, 2> ends_of(const geometry::TriangleMesh& bone, const Vec3& distal);

/// Centre of a bone's head, the end of it that carries `distal`: of the sphere through what lies
/// within 2.5 mm of the joint's narrowest gap, if that is a sphere of about the head's thickness;
/// else the middle of the head, half its thickness behind its end.
Vec3 head_centre(const geometry::TriangleMesh& bone, const geometry::TriangleMesh& distal);

/// Where the bones of one posture are against the palm, hand frame of the reference: moved point =
/// motion * point.
struct PostureMotions {
  geometry::Rigid3 posture_from_reference;  ///< of the palm; patient frames
  std::map<std::string, geometry::Rigid3> bone;
};
/// The palm's own motion is that of metacarpals II to V and carpals, by their moments, without
/// those that don't go with the others. Throws InputError, naming the posture, if none was tracked.
PostureMotions motions_in_hand(const ReferenceHand& hand, const std::vector<BoneMotion>& motions,
                               hand::ScanPosture posture);

}  // namespace palmar::capture
