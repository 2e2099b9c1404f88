// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "hands/capture/mri/fixture.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "hands/imaging/distance_transform.h"
#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"

namespace palmar::capture {

/// Signals of a T1-weighted image without bias and noise floor; air has 0.
struct ScanLevels {
  double noise = 0.0;   ///< standard deviation in tissue
  double floor = 0.0;   ///< noise whose floor was taken out: 0 where the scanner masked the air
  double dark = 0.0;    ///< cortical bone
  double bright = 0.0;  ///< marrow and fat
  double skin = 0.0;
  double air_threshold = 0.0;   ///< skin from air
  double bone_threshold = 0.0;  ///< marrow from cortical bone
  /// Where the bone threshold lies on the way from dark to bright; 0.5 unless one is given.
  double bone_share() const { return (bone_threshold - dark) / std::max(1e-9, bright - dark); }
};

/// The part of an image that shows the hand, made ready for finding surfaces.
struct ScanImage {
  imaging::Volume image;       ///< free of bias and noise floor, cut to the hand's surroundings
  imaging::Volume smooth;      ///< the same with less noise
  imaging::VoxelMask body;     ///< the hand: without markers and fixture, what is inside filled
  std::vector<float> depth;    ///< below the body's surface, mm; 0 outside
  imaging::VoxelMask covered;  ///< markers and fixture
  std::vector<Vec3> markers;
  Fixture fixture;
  ScanLevels levels;
  std::vector<std::string> notes;
};

/// Cuts out, cleans and measures. Thresholds, unless they are given:
/// - air from tissue: half of the median signal 0.5 to 1.3 mm below the surface, so that a surface
///   lies where half a voxel is skin (the surface that Otsu's threshold gives says where that is).
///   Half way to the air's mean would be too high: noise has no sign in a magnitude image
///   (noise_floor.h);
/// - marrow from cortical bone: half way between the medians of the dark and of the bright class
///   of the inner tissue (three classes, Otsu 1979).
/// Throws InputError, naming `name`: no hand, two hands.
ScanImage prepare_scan(const imaging::Volume& image, const std::string& name,
                       const SurfaceOptions& options, const Progress& progress = {});

/// The signals alone, as prepare_scan() measures them, in half of its time. Throws likewise.
ScanLevels scan_levels(const imaging::Volume& image, const std::string& name,
                       const SurfaceOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::capture
