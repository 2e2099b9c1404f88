// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/tetra/tetrahedral_mesh.h"
#include "palmar/hand/hand.h"

namespace palmar::hand {

/// Where a point near the skin hangs on the surface of the tetrahedra.
struct SkinAttachment {
  std::array<int, 3> vertex{};     ///< of the tetrahedral mesh
  std::array<double, 3> weight{};  ///< sum 1
  double distance = 0.0;           ///< from the point to the surface, mm
  double edge = 0.0;               ///< mean edge of the tetrahedra there, mm
};

/// Tetrahedra of the soft tissue between the skin and the bones of a hand; hand frame, reference
/// posture, mm.
struct TissueMesh {
  geometry::TetrahedralMesh mesh;
  std::vector<char> is_on_bone;  ///< per vertex: held there
  std::vector<char> is_on_skin;  ///< per vertex
  std::vector<Region> region;    ///< per tetrahedron: of the skin nearest to its middle

  /// Nearest places on the outer surface. Throws NumericalError if there is none.
  std::vector<SkinAttachment> attach(const std::vector<Vec3>& points) const;
  /// Volume of the tissue below each region, mm^3.
  std::array<double, kRegionCount> volume_by_region() const;
};

struct TissueMeshOptions {
  double finger_edge = 2.0;  ///< of the lattice's cubes in the fingers, mm; half of the palm's
  void check() const;        ///< throws UsageError outside 0.5 to 5 mm
};

/// A body-centred cubic lattice, twice as fine in the fingers as in the palm and wrist, clipped by
/// the skin, then by the bones (clip_tetrahedra()). Tissue thinner than about an edge between skin
/// and bone may be lost; the skin over it hangs on the nearest surface that is left. What no bone
/// holds is dropped. Throws UsageError if the hand has no bones.
TissueMesh make_tissue_mesh(const Hand& hand, const TissueMeshOptions& options = {});

}  // namespace palmar::hand
