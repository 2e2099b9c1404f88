// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::phantom {

/// What scanning programs do to a surface.
struct ScanDefects {
  std::uint64_t seed = 1;
  double noise = 0.15;      ///< mm, standard deviation along the normals; waves of 3 to 8 mm
  double roughness = 0.04;  ///< mm, of every vertex by itself
  double hidden = 0.06;   ///< share of all directions in which surface must see the open, or it is
                          ///< not scanned: 0 to 0.5; holes between fingers that lie close
  double forearm = 45.0;  ///< mm of it that are left from the wrist; cut open
  double colour_noise = 0.012;  ///< of every channel, of 1
  void check() const;           ///< throws UsageError: field, value, allowed range
};

/// A hand's surface as a scan has it: cut at the forearm (perpendicular to y), without what was
/// hidden, rough, and placed anywhere in space. `wrist_y`: where the forearm begins, in the
/// surface's frame.
struct ScannedSurface {
  geometry::ColouredMesh surface;
  geometry::Rigid3 scan_from_hand;
};
ScannedSurface scanned_surface(const geometry::ColouredMesh& hand, double wrist_y,
                               const ScanDefects& defects = {});

/// The same surface with its colours in an image of side x side pixels: every two triangles of it
/// share a square. Triangles must be large enough to get three pixels each way. Throws UsageError
/// otherwise, and for a side of less than 64.
struct TexturedSurface {
  geometry::TriangleMesh mesh;
  geometry::SurfaceColours colours;
};
TexturedSurface textured_surface(const geometry::TriangleMesh& coarse,
                                 const geometry::ColouredMesh& fine, int side);

}  // namespace palmar::phantom
