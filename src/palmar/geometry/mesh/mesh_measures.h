// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

// Measures of a triangle mesh. Lengths in mm, areas in mm^2, volumes in mm^3, angles in rad. All
// expect triangle corners within the vertex list (build_topology() checks that). A function that
// takes `vertices` and `triangles` apart serves posed skins, which share one triangle list.

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Sum of the triangle areas.
double surface_area(const TriangleMesh& mesh);

/// Volume enclosed, by the divergence theorem: the sum of a . (b x c) / 6. Positive if the
/// triangles are counter-clockwise seen from outside. For an open mesh it is the volume of the cone
/// over it from the mean of its vertices; so it is independent of position for closed meshes only.
double signed_volume(const TriangleMesh& mesh);

/// Centre of the enclosed volume: the centre of mass of a solid of uniform density. For a mesh that
/// encloses none to speak of (open, or inside out) the centre of its area, else of its vertices.
Vec3 centre_of_volume(const TriangleMesh& mesh);

/// Box round all vertices; empty for no vertices.
Box3 bounding_box(const TriangleMesh& mesh);

/// Unit normal of each triangle; zero for a degenerate one.
std::vector<Vec3> triangle_normals(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles);
std::vector<Vec3> triangle_normals(const TriangleMesh& mesh);

/// Unit normal of each vertex: mean of the triangles' normals weighted by their angle there, so
/// that it doesn't depend on how the surface is cut. Zero where no triangle has an area.
/// Source: Thuermer, Wuethrich 1998, "Computing vertex normals from polygonal facets".
std::vector<Vec3> vertex_normals(std::span<const Vec3> vertices,
                                 std::span<const Triangle> triangles);
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

/// Unit normal of each vertex: mean of the triangles' normals weighted by their area; without the
/// angles of vertex_normals(), for meshes of even triangles whose vertices move. Unit z where no
/// triangle has an area.
std::vector<Vec3> area_weighted_normals(std::span<const Vec3> vertices,
                                        std::span<const Triangle> triangles);
/// The same into `normals`, whose memory is reused.
void area_weighted_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                           std::vector<Vec3>& normals);

/// Area that belongs to each vertex: of every triangle the part nearer to it than to the other two
/// (Voronoi), for obtuse triangles half of the triangle at the obtuse corner and a quarter at each
/// other. The areas sum to the surface area.
/// Source: Meyer, Desbrun, Schroeder, Barr 2003, section 3.3, A_mixed.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

/// Smallest angle of each triangle; 0 if degenerate.
std::vector<double> smallest_angles(const TriangleMesh& mesh);

struct EdgeLengths {
  int count = 0;
  double mean = 0.0, shortest = 0.0, longest = 0.0, standard_deviation = 0.0;  ///< mm
};

/// Statistics over the edges, each counted once. All zero for a mesh without edges.
EdgeLengths edge_lengths(const TriangleMesh& mesh);

}  // namespace palmar::geometry
