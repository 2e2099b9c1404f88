// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/anatomy.h"

namespace palmar::capture {

/// Metacarpal and phalanges of a finger from proximal to distal, by the names of Hand::bones.
std::vector<std::string> ray_of(hand::Finger finger);
/// Name of the phalanx that a segment stands for; throws UsageError for the palm.
std::string phalanx_name(hand::Segment segment);
/// Metacarpals II to V and carpals: what stands still with the palm, or nearly.
bool is_palm_bone(std::string_view name);
bool is_forearm_bone(std::string_view name);

/// The bone of that name; null if there is none.
const ScannedBone* bone_named(const ScanSurfaces& surfaces, std::string_view name);

/// Middle of the distal bone's joint surface: mean of its vertices no more than 1 mm farther from
/// the proximal bone than the nearest one; mm.
Vec3 joint_surface_point(const geometry::TriangleMesh& distal,
                         const geometry::TriangleMesh& proximal);

/// b_from_a that brings points of `a` nearest to those of `b`, pair by pair, in the sense of least
/// squares (Kabsch 1976). Needs three pairs that aren't on a line to be determined. Throws
/// UsageError for lists that don't match or are empty.
geometry::Rigid3 align_points(std::span<const Vec3> a, std::span<const Vec3> b,
                              std::span<const double> weight = {});

/// align_points() that leaves out pairs which don't fit: repeatedly those farther than three times
/// the median and than `tolerance` [mm].
geometry::Rigid3 align_points_robustly(std::span<const Vec3> a, std::span<const Vec3> b,
                                       double tolerance);

}  // namespace palmar::capture
