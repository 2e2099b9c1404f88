// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/tetra/tetrahedral_lattice.h"

namespace palmar::hand {
namespace {

constexpr double kSurfaceSnap = 0.23;  // edges; nearer vertices are put on a surface: our choice

constexpr double kTissueEnd = -12.0;  // mm from the wrist's centre; no tissue beyond: our choice

/// All bones as one surface.
geometry::TriangleMesh all_bones(const Hand& hand) {
  geometry::TriangleMesh all;
  for (const Bone& bone : hand.bones) {
    const int first = all.vertex_count();
    all.vertices.insert(all.vertices.end(), bone.mesh.vertices.begin(), bone.mesh.vertices.end());
    for (const Triangle& t : bone.mesh.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

geometry::ClipSurface surface_of(const geometry::DistanceField& field, double sign, double range) {
  return [&field, sign, range](const std::vector<Vec3>& points) {
    std::vector<geometry::DistanceSample> found(points.size());
    field.sample(points, range, found);
    std::vector<geometry::ClipSample> result;
    result.reserve(points.size());
    for (const geometry::DistanceSample& s : found)
      result.push_back({sign * s.distance, s.closest});
    return result;
  };
}

/// Tetrahedra that hang together with a held vertex over their corners.
void drop_loose(geometry::TetrahedralMesh& mesh, const std::vector<char>& is_held) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    for (const int v : t) parent[root(v)] = root(t[0]);
  }
  // One vertex holds a point, three hold a body.
  std::vector<int> held(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < parent.size(); ++v) {
    if (is_held[v]) ++held[root(static_cast<int>(v))];
  }
  std::erase_if(mesh.tetrahedra,
                [&](const geometry::Tetrahedron& t) { return held[root(t[0])] < 3; });
}

/// Mean edge of the tetrahedra around each vertex.
std::vector<double> mean_edges(const geometry::TetrahedralMesh& mesh) {
  std::vector<double> sum(mesh.vertices.size(), 0.0), count(mesh.vertices.size(), 0.0);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    double mean = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        mean += (mesh.vertices[t[a]] - mesh.vertices[t[b]]).norm() / 6.0;
      }
    }
    for (const int v : t) {
      sum[v] += mean;
      count[v] += 1.0;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(count[v], 1.0);
  return sum;
}

}  // namespace

std::vector<SkinAttachment> TissueMesh::attach(const std::vector<Vec3>& points) const {
  geometry::TriangleMesh surface;
  surface.vertices = mesh.vertices;
  for (const Triangle& face : geometry::boundary_faces(mesh)) {
    const bool is_skin =
        std::all_of(face.begin(), face.end(), [&](int v) { return is_on_skin[v] != 0; });
    if (is_skin) surface.triangles.push_back(face);
  }
  const geometry::ClosestPointQuery query(surface);
  const std::vector<double> edge = mean_edges(mesh);
  std::vector<SkinAttachment> result;
  result.reserve(points.size());
  std::optional<int> hint;
  for (const Vec3& x : points) {
    const auto found = query.closest(x, std::numeric_limits<double>::infinity(), hint);
    if (!found) throw NumericalError("tissue mesh: no tissue is left under the skin");
    hint = found->triangle;
    SkinAttachment& at = result.emplace_back();
    at.vertex = surface.triangles[found->triangle];
    at.weight = found->weights;
    at.distance = found->distance;
    for (std::size_t k = 0; k < 3; ++k) at.edge += at.weight[k] * edge[at.vertex[k]];
  }
  return result;
}

std::array<double, kRegionCount> TissueMesh::volume_by_region() const {
  std::array<double, kRegionCount> result{};
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const geometry::Tetrahedron& c = mesh.tetrahedra[t];
    result[index_of(region[t])] += geometry::tetrahedron_volume(
        mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]], mesh.vertices[c[3]]);
  }
  return result;
}

void TissueMeshOptions::check() const {
  if (!(finger_edge >= 0.5 && finger_edge <= 5.0)) {
    throw UsageError("tissue mesh: finger_edge is " + std::to_string(finger_edge) +
                     " mm; 0.5 to 5 mm is required");
  }
}

TissueMesh make_tissue_mesh(const Hand& hand, const TissueMeshOptions& options) {
  options.check();
  if (hand.bones.empty()) {
    throw UsageError("tissue mesh: hand \"" + hand.name +
                     "\" has no bones; tissue without them is not held anywhere");
  }
  const geometry::MeshDistance skin(hand.skin);
  const geometry::MeshDistance bone(all_bones(hand));
  const geometry::ClosestPointQuery nearest(hand.skin);
  geometry::LatticeOptions lattice_options;
  lattice_options.edge = 2.0 * options.finger_edge;
  lattice_options.levels = 2;
  lattice_options.is_wanted = [&](const geometry::LatticeCube& cube) {
    if (cube.centre.y() < kTissueEnd) return false;
    // The corners of its tetrahedra are within one edge of its middle.
    return skin.at(cube.centre).distance < 1.1 * cube.edge;
  };
  lattice_options.is_split = [&](const geometry::LatticeCube& cube) {
    const auto found = nearest.closest(cube.centre);
    const bool is_finger = hand.segment[hand.skin.triangles[found->triangle][0]] != Segment::kPalm;
    return is_finger && lattice_options.is_wanted(cube);
  };
  Box3 box = geometry::bounding_box(hand.skin);
  box.min().array() -= lattice_options.edge;
  box.max().array() += lattice_options.edge;
  const geometry::TetrahedralMesh lattice =
      geometry::make_tetrahedral_lattice(box, lattice_options);

  const double range = 2.0 * lattice_options.edge;
  const geometry::ClippedMesh inside =
      geometry::clip_tetrahedra(lattice, surface_of(skin, 1.0, range), kSurfaceSnap);
  geometry::ClippedMesh between = geometry::clip_tetrahedra(
      inside.mesh, surface_of(bone, -1.0, range), kSurfaceSnap, inside.is_on_surface);
  drop_loose(between.mesh, between.is_on_surface);
  std::vector<int> kept;
  TissueMesh tissue;
  tissue.mesh = geometry::without_unused(between.mesh, &kept);
  for (const int v : kept) {
    tissue.is_on_bone.push_back(between.is_on_surface[v]);
    const int origin = between.origin[v];
    tissue.is_on_skin.push_back(origin >= 0 ? inside.is_on_surface[origin] : 0);
  }

  std::optional<int> hint;
  for (const geometry::Tetrahedron& t : tissue.mesh.tetrahedra) {
    const auto& x = tissue.mesh.vertices;
    const auto found = nearest.closest(0.25 * (x[t[0]] + x[t[1]] + x[t[2]] + x[t[3]]),
                                       std::numeric_limits<double>::infinity(), hint);
    hint = found->triangle;
    const std::size_t corner =
        std::max_element(found->weights.begin(), found->weights.end()) - found->weights.begin();
    tissue.region.push_back(hand.region[hand.skin.triangles[found->triangle][corner]]);
  }
  return tissue;
}

}  // namespace palmar::hand
