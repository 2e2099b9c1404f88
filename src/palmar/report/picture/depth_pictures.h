// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/report/picture/assessment_pictures.h"

namespace palmar::report {

/// A shape whose surface was moved, in pictures.
struct DepthScene {
  geometry::TriangleMesh mesh;  ///< mm
  std::vector<double> depth;    ///< per vertex, mm, >= 0
  std::string title;            ///< "pressed shape of prism"
  std::string subtitle;         ///< "share 0.5 of the mean over 30 hands"
  Vec3 axis = Vec3::UnitZ();    ///< of the handle, unit; stands upright in the pictures
  Vec3 palm = Vec3::UnitX();    ///< unit: from the palm's side into the product
};

/// The shape from four sides about its axis, each twice in one picture: as it looks, and with its
/// depth in colours. Names "shape_in_palm", "shape_under_fingers", "shape_left", "shape_right".
/// When cancelled, those that are finished.
std::vector<Picture> depth_pictures(const DepthScene& scene, const PictureOptions& options = {},
                                    const Progress& progress = {});

}  // namespace palmar::report
