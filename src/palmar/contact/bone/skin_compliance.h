// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "palmar/contact/bone/patch_matrix.h"
#include "palmar/contact/bone/surface_compliance.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/tissue_mesh.h"

namespace palmar {

/// How the skin of a hand gives way as the elasticity of the incompressible tissue between it and
/// the bones has it. Times the shear modulus, forces [N] in any direction move the skin by
///
///     C = H + P R P^T   [1/mm],   R = S (C_e - H) S^T
///
/// H: half-space (half_space_tensor.h), which has what is narrower than an element; R: what the
/// bones change, smooth, from the elements' C_e, at nodes, three rows each (x, y, z of the hand
/// frame); P: interpolation from the nodes to the vertices of the skin, exact for what varies
/// linearly. S averages over the width sigma of the elements and leaves what varies little over it,
/// to sixth order: S = 3 W - 3 W T W + W T W T W = 1 - (1 - W)^3, W means with Gaussian weights, T
/// half-way to the mean over a vertex' hat function, by which forces are spread over the elements.
struct SkinCompliance {
  std::vector<int> vertex;                 ///< skin vertices that have it, ascending
  std::vector<int> node;                   ///< skin vertices that are nodes
  std::vector<std::size_t> support_begin;  ///< per entry of `vertex`, one more at the end
  std::vector<int> support;                ///< index into `node`
  std::vector<double> weight;
  PatchMatrix smooth{0};  ///< R, 1/mm
  /// Tissue nearest to the skin of each region, mm^3.
  std::array<double, kRegionCount> volume{};
};

struct SkinComplianceOptions {
  TissueMeshOptions mesh;
};

/// The skin of fingers and palm, up to kBackOfHand beyond the border of the palm's regions. The
/// back of the hand and the forearm have none. Throws as make_tissue_mesh(), surface_compliance().
SkinCompliance skin_compliance(const Hand& hand, const SkinGeometry& skin,
                               const SkinComplianceOptions& options = {});

inline constexpr double kBackOfHand = 12.0;  ///< mm; our choice

/// Points that stand for the skin where forces are spread over it: the middles of equal parts of
/// each triangle.
struct HatPoints {
  std::vector<Vec3> share;     ///< barycentric, the same in every triangle
  std::vector<Vec3> point;     ///< triangle by triangle, mm
  std::vector<double> weight;  ///< per triangle: area that each of its points stands for, mm^2
};
/// `divisions`^2 points per triangle. Their spacing should be half that of the elements or less, or
/// single points are felt.
HatPoints hat_points(const SkinGeometry& skin, const std::vector<Triangle>& triangles,
                     int divisions);
/// Divisions for edges of this length [mm] of skin and elements.
int divisions_for(double skin_edge, double element_edge);

/// What lies under a skin.
struct ElasticBody {
  const TetrahedralMesh* mesh = nullptr;
  const std::vector<char>* is_held = nullptr;  ///< per vertex of the mesh
  const HatPoints* points = nullptr;
  std::vector<SkinAttachment> attachment;  ///< of the points
};

/// The same for any skin on any body; `sigma` [mm] per entry of `vertex`. Without volumes.
SkinCompliance skin_compliance(const SkinGeometry& skin, const std::vector<Triangle>& triangles,
                               const ElasticBody& body, const std::vector<int>& vertex,
                               const std::vector<double>& sigma);

/// Width sigma for elements of this mean edge [mm] under a vertex, mm.
double smoothing_width(const SkinGeometry& skin, int vertex, double edge);

/// Patches of up to `size` points, by halving along the longest axis; `count` patches.
std::vector<int> compact_patches(const std::vector<Vec3>& points, int size, int& count);

}  // namespace palmar
