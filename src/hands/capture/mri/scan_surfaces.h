// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// One bone in a scan. Closed, 2-manifold, oriented outwards; patient frame, mm.
struct ScannedBone {
  std::string name;  ///< as Hand::bones has it ("index_middle_phalanx", "thumb_metacarpal",
                     ///< "capitate", "radius"); "" for one that couldn't be named
  geometry::TriangleMesh mesh;
  bool is_cut = false;  ///< by the edge of the image
};

/// Skin, bones and markers of one scan. Patient frame (volume.h), mm. Bones and markers are where
/// the image shows fat, and the skin, which is water, where it would be if it were shown like fat:
/// `fat_shift` off its place.
struct ScanSurfaces {
  geometry::TriangleMesh skin;  ///< closed (capped where the image cuts the forearm), 2-manifold
  std::vector<ScannedBone> bones;
  std::vector<Vec3> markers;             ///< centres of the spots stuck on the skin
  hand::Side side = hand::Side::kRight;  ///< from the anatomy
  double air_threshold = 0.0;            ///< intensities used, after bias correction
  double bone_threshold = 0.0;
  double noise = 0.0;                ///< standard deviation of the intensity in tissue
  Vec3 fat_shift = Vec3::Zero();     ///< by which the skin was moved, mm
  Vec3 voxel = Vec3::Zero();         ///< of the image, mm; 0: not known
  double bone_error_estimate = 0.0;  ///< expected of the surfaces at this resolution and noise, mm
  std::vector<std::string> notes;    ///< what the user should know: sentences
};

/// What a better scan would be, as a clause: finer voxels where they are coarser than 0.8 mm in the
/// slice and 1 mm across, or aren't known; else less noise.
std::string better_scan(const ScanSurfaces& surfaces);

struct SurfaceOptions {
  double air_threshold = 0.0;   ///< intensity of the file; 0: found from the histogram
  double bone_threshold = 0.0;  ///< likewise
  bool corrects_bias = true;
  double edge_length = 1.2;      ///< mean edge of the meshes, mm
  double marker_diameter = 5.0;  ///< mm; 0: no markers are looked for
  /// How far the scanner's settings show fat off water, mm, but for the sign (ImageFile).
  Vec3 fat_shift = Vec3::Zero();
  bool is_fat_side_known = false;       ///< the sign is right, too: another scan with it showed it
  std::optional<hand::Side> side = {};  ///< which hand it is, if that is known
  /// Bones that fit the other hand with less than this share of the misfit show that `side` is
  /// wrong after all; 0: it is certain.
  double doubted_below = 0.0;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

}  // namespace palmar::capture
