// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/redesign/contact_region.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

/// Colours of the parts of the hand, in pictures and CAD files alike: fingers red, thumb orange,
/// palm blue (Xie 2014, fig. 5-16: red and blue); the whole hand violet.
Rgb colour_of(std::optional<redesign::HandPart> part);

struct RegionPictureOptions {
  int width = 1500;  ///< pixels
  int height = 900;  ///< pixels
};

/// The product's surface in those colours, where no region is in that of the pictures: for a view
/// that can be turned. Where regions overlap, the first of `regions` is shown.
geometry::ColouredMesh region_surface(const geometry::TriangleMesh& map,
                                      const std::vector<redesign::ContactRegion>& regions);

/// A product with the regions of the parts of the hand on it, from four sides about its axis, side
/// by side: first from the palm's. Where regions overlap, the first of `regions` is shown. `map` is
/// the mesh that the regions' fields belong to; `axis` is upwards.
Image region_picture(const geometry::TriangleMesh& map,
                     const std::vector<redesign::ContactRegion>& regions, const Vec3& axis,
                     const std::string& title, const RegionPictureOptions& options = {},
                     const Progress& progress = {});

}  // namespace palmar::report
