// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/photo/photo_mask.h"
#include "hands/capture/photo/surface/depth_fusion.h"
#include "hands/capture/photo/surface/patch_match.h"
#include "hands/capture/photo/surface/point_cells.h"
#include "hands/capture/photo/surface/poisson_surface.h"
#include "hands/capture/photo/surface/vertex_colours.h"
#include "hands/capture/photo/surface/visual_hull.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::capture {

struct PhotoModelOptions {
  /// Where the hand is: above the middle of the board, mm.
  Box3 box = Box3(Vec3(-110.0, -110.0, 0.0), Vec3(110.0, 110.0, 260.0));
  double board_half = 198.0;  ///< half the edge of the board's pattern, mm; 0: no board in view
  double pixel = 0.5;         ///< mm that a pixel should cover for stereo
  double cut = 5.0;           ///< the hand is cut off so far above the board, mm
  PhotoMaskOptions mask;
  VisualHullOptions hull;
  PatchMatchOptions stereo;
  DepthFusionOptions fusion;
  PoissonOptions surface;
  VertexColourOptions colours;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// What became of one photograph.
struct PhotoUse {
  double mask_share = 0.0;    ///< of the box' outline that may be hand
  double around_share = 0.0;  ///< of what is around it in the picture, by its colour
  double glare_share = 0.0;   ///< of the hand's pixels that are as bright as can be
  double depth_share = 0.0;   ///< of the hand's pixels that got a depth
  double kept_share = 0.0;    ///< of those, depths that other photographs agree with
  double gain = 1.0;          ///< its exposure, corrected
};

/// A hand as the photographs show it, in the board's frame, mm.
struct PhotoModel {
  geometry::ColouredMesh skin;  ///< open below
  std::vector<int> views;       ///< per vertex: photographs that see it
  std::vector<char>
      measured;  ///< per vertex: 0 where too few photographs agreed and the surface is a guess
  std::vector<PhotoUse> photographs;
  int reduction = 1;            ///< of the photographs for stereo
  std::size_t points = 0;       ///< that photographs agreed about
  double hull_volume = 0.0;     ///< mm^3
  double measured_share = 0.0;  ///< of the area
  SkinLight light;              ///< gloss, lamps that moved
  CameraHeights heights;        ///< from which the cameras look
  bool has_background = false;  ///< masks show little: what is behind the hand looks like skin;
                                ///< what wasn't measured is left out then
  std::vector<std::string> warnings;
};

/// The hand from photographs whose cameras are known. Masks, visual hull, stereo in every
/// photograph, points that agree, a surface, colours; each in its own header. Throws InputError
/// naming what is wrong: too few photographs, no overlap, no outline, nothing that agrees.
PhotoModel make_photo_model(const std::vector<Photograph>& photographs,
                            const PhotoModelOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::capture
