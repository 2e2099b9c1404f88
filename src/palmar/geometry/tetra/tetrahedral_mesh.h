// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Corner indices of a tetrahedron (a, b, c, d), (b - a) x (c - a) . (d - a) > 0.
using Tetrahedron = std::array<int, 4>;

/// Indexed tetrahedra, mm; a plain value as TriangleMesh.
struct TetrahedralMesh {
  std::vector<Vec3> vertices;
  std::vector<Tetrahedron> tetrahedra;

  int vertex_count() const { return static_cast<int>(vertices.size()); }
  int tetrahedron_count() const { return static_cast<int>(tetrahedra.size()); }
};

/// Volume of a tetrahedron, mm^3; negative if it is inside out.
double tetrahedron_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
double volume(const TetrahedralMesh& mesh);
/// Smallest of the six angles between the faces of each tetrahedron, rad.
std::vector<double> smallest_dihedral_angles(const TetrahedralMesh& mesh);
/// Faces that belong to one tetrahedron only, seen from outside, in the mesh's vertices; in the
/// order of their tetrahedra.
std::vector<Triangle> boundary_faces(const TetrahedralMesh& mesh);
/// Without the vertices that no tetrahedron uses; `kept` [out, if given] says which stayed.
TetrahedralMesh without_unused(const TetrahedralMesh& mesh, std::vector<int>* kept = nullptr);

/// The surface that clips a mesh: its signed value (mm, negative where tissue stays) and nearest
/// point, for many points at once.
struct ClipSample {
  double value = 0.0;
  Vec3 closest = Vec3::Zero();
};
using ClipSurface = std::function<std::vector<ClipSample>(const std::vector<Vec3>& points)>;

struct ClippedMesh {
  TetrahedralMesh mesh;
  std::vector<char> is_on_surface;  ///< per vertex
  std::vector<int> origin;          ///< per vertex: of the mesh that was clipped; -1: a new one
};

/// The part of a mesh where the surface's value is negative. Vertices nearer to the surface than
/// `snap` times their shortest edge are put on it unless `is_held` says that they stay; edges that
/// cross it further from their ends are cut there, tetrahedra in up to three, whose common faces
/// agree (quadrilaterals are split at their least vertex; Dompierre et al. 1999). What remains
/// between neighbouring tetrahedra is conforming. After the isosurface stuffing of Labelle,
/// Shewchuk 2007, with that simpler splitting rule.
ClippedMesh clip_tetrahedra(const TetrahedralMesh& mesh, const ClipSurface& surface, double snap,
                            const std::vector<char>& is_held = {});

}  // namespace palmar::geometry
