// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::contact {

/// Which skin a pressure sensor's cell, a disc on the skin centred on a vertex, covers.
struct SensorCells {
  std::vector<int> begin;  ///< one more than cells: where a cell's vertices begin in `vertex`
  std::vector<int> vertex;
  std::vector<double> shared;  ///< area of the vertex' Voronoi disc that lies in the cell, mm^2
};

/// What the contact model needs to know about a skin, in its reference posture or as it is pressed.
struct SkinGeometry {
  std::vector<Vec3> position;       ///< mm
  std::vector<Vec3> normal;         ///< unit, outward
  std::vector<double> area;         ///< Voronoi area of a vertex, mm^2; sums to the surface
  std::vector<double> radius;       ///< of the disc of that area, mm
  std::vector<int> ring_begin;      ///< vertex count + 1: where the neighbours begin in `ring`
  std::vector<int> ring;            ///< neighbours over one edge, ascending
  std::vector<double> edge_length;  ///< of each entry of `ring`, mm

  int vertex_count() const { return static_cast<int>(position.size()); }
  std::span<const int> neighbours(int vertex) const {
    return std::span(ring).subspan(ring_begin[vertex], ring_begin[vertex + 1] - ring_begin[vertex]);
  }
};

/// Cell of the sensors used by Xie 2014 (4.2 per cm^2).
constexpr double kUsualCellArea = 24.0;  // mm^2

SkinGeometry skin_geometry(const geometry::TriangleMesh& skin);
/// The same for a skin with the triangles of `other`, from its neighbours.
SkinGeometry skin_geometry_like(const geometry::TriangleMesh& skin, const SkinGeometry& other);

/// The cells of `cell_area` [mm^2, one each] centred on `centres`, in their order; distances by
/// arc_distance().
SensorCells sensor_cells(const SkinGeometry& skin, std::span<const int> centres,
                         std::span<const double> cell_area);

/// Distance on the skin between two vertices, from their positions and normals alone:
///
///     r^2 = |c|^2 + (c . t)^2 ((phi/2)^2 / sin^2(phi/2) - 1)
///
/// with the chord c, the angle phi between the normals and t the direction in which the normal
/// turns. Exact on planes, spheres and (along every helix) cylinders; elsewhere good where the
/// curvature changes little between the two. mm.
double arc_distance(const SkinGeometry& skin, int i, int j);

/// Vertices within `distance` [mm] of the sources along the mesh's edges, ascending, with that
/// distance.
struct GrownVertex {
  int vertex = 0;
  double distance = 0.0;  ///< mm; 0 for a source
};
std::vector<GrownVertex> grow(const SkinGeometry& skin, std::span<const int> sources,
                              double distance);

/// Connected parts of a set of vertices (ascending in, ascending out), in the order of their first
/// vertex.
std::vector<std::vector<int>> connected_parts(const SkinGeometry& skin,
                                              const std::vector<int>& vertices);

}  // namespace palmar::contact
