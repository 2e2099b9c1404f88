// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/bone/patch_matrix.h"
#include "palmar/contact/bone/surface_compliance.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/hand/tissue_mesh.h"

namespace palmar::contact {

/// What elements say of a skin's compliance: R = S C_e S^T at nodes, three rows each (x, y, z of
/// the body's frame), and how it is interpolated to the vertices. C_e: the elements' own. S
/// averages over the width sigma of the elements and leaves what varies little over it, to sixth
/// order: S = 3 W - 3 W T W + W T W T W = 1 - (1 - W)^3, W means with Gaussian weights, T half-way
/// to the mean over a vertex' hat function, by which forces are spread over the elements.
struct NodeCompliance {
  std::vector<int> vertex;                 ///< skin vertices that have it, ascending
  std::vector<double> sigma;               ///< per entry of `vertex`, mm
  std::vector<int> node;                   ///< skin vertices that are nodes
  std::vector<std::size_t> support_begin;  ///< per entry of `vertex`, one more at the end
  std::vector<int> support;                ///< index into `node`
  std::vector<double> weight;
  PatchMatrix smooth{0};  ///< R, 1/mm
};

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
  const geometry::TetrahedralMesh* mesh = nullptr;
  const std::vector<char>* is_held = nullptr;  ///< per vertex of the mesh
  const HatPoints* points = nullptr;
  std::vector<hand::SkinAttachment> attachment;  ///< of the points
};

/// `sigma` [mm] per entry of `vertex`. Throws as surface_compliance().
NodeCompliance node_compliance(const SkinGeometry& skin, const std::vector<Triangle>& triangles,
                               const ElasticBody& body, const std::vector<int>& vertex,
                               const std::vector<double>& sigma);

/// Width sigma for elements of this mean edge [mm] under a vertex, mm.
double smoothing_width(const SkinGeometry& skin, int vertex, double edge);

/// Patches of up to `size` points, by halving along the longest axis; `count` patches.
std::vector<int> compact_patches(const std::vector<Vec3>& points, int size, int& count);

}  // namespace palmar::contact
