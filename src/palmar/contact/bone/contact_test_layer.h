// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// An elastic layer bonded to a flat base, and a skin on it, for the tests of this folder.

#include <cmath>
#include <map>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/tetra/tetrahedral_lattice.h"

namespace palmar::contact::contact_test {

struct BondedLayer {
  geometry::TriangleMesh skin_mesh;
  SkinGeometry skin;
  geometry::TetrahedralMesh mesh;
  std::vector<char> is_held;
  HatPoints points;
  std::vector<hand::SkinAttachment> attachment;
  double edge = 0.0;

  /// Elements of this edge between z = -thickness and 0, half_width to each side; a round patch of
  /// skin with edges of `spacing`. mm.
  BondedLayer(double element_edge, double thickness, double half_width, double spacing,
              double radius)
      : edge(element_edge) {
    // Off the planes of the lattice, so that elements are cut.
    const Vec3 shift(0.37 * edge, 0.61 * edge, 0.23 * edge);
    const Box3 box(Vec3(-half_width, -half_width, -thickness - 2.0 * edge) + shift,
                   Vec3(half_width, half_width, edge) + shift);
    const auto plane = [](double height, double sign) {
      return [=](const std::vector<Vec3>& at) {
        std::vector<geometry::ClipSample> result;
        for (const Vec3& x : at) {
          result.push_back({sign * (x.z() - height), Vec3(x.x(), x.y(), height)});
        }
        return result;
      };
    };
    const geometry::ClippedMesh below = geometry::clip_tetrahedra(
        geometry::make_tetrahedral_lattice(box, {.edge = edge}), plane(0.0, 1.0), 0.23);
    const geometry::ClippedMesh layer =
        geometry::clip_tetrahedra(below.mesh, plane(-thickness, -1.0), 0.23, below.is_on_surface);
    mesh = layer.mesh;
    is_held = layer.is_on_surface;
    geometry::TriangleMesh top;
    top.vertices = mesh.vertices;
    for (const Triangle& face : geometry::boundary_faces(mesh)) {
      double height = 0.0;
      for (const int v : face) height += std::abs(mesh.vertices[v].z());
      if (height < 1e-9) top.triangles.push_back(face);
    }
    const geometry::ClosestPointQuery query(top);
    skin_mesh = geometry::make_lattice_patch(radius, spacing);
    skin = skin_geometry(skin_mesh);
    points = hat_points(skin, skin_mesh.triangles, divisions_for(spacing, edge));
    for (const Vec3& x : points.point) {
      const auto found = query.closest(x);
      attachment.push_back({top.triangles[found->triangle], found->weights, found->distance, edge});
    }
  }

  /// A unit force downwards per vertex of the skin, spread as its hat.
  std::vector<SurfaceLoad> loads() const {
    std::vector<std::map<int, double>> share(skin.position.size());
    std::vector<double> area(share.size(), 0.0);
    for (std::size_t q = 0; q < points.point.size(); ++q) {
      const std::size_t t = q / points.share.size();
      for (int c = 0; c < 3; ++c) {
        const int v = skin_mesh.triangles[t][c];
        const double own = points.weight[t] * points.share[q % points.share.size()][c];
        area[v] += own;
        for (std::size_t a = 0; a < 3; ++a) {
          share[v][attachment[q].vertex[a]] += own * attachment[q].weight[a];
        }
      }
    }
    std::vector<SurfaceLoad> result(share.size());
    for (std::size_t v = 0; v < share.size(); ++v) {
      for (const auto& [vertex, value] : share[v]) {
        result[v].vertex.push_back(vertex);
        result[v].force.emplace_back(0.0, 0.0, -value / area[v]);
      }
    }
    return result;
  }

  /// As the elements have it.
  PatchMatrix elements(double poisson) const {
    PatchMatrix result(skin.vertex_count());
    surface_compliance(mesh, is_held, loads(), {.poisson = poisson}, result);
    return result;
  }

  SkinCompliance compliance() const {
    std::vector<int> vertex;
    std::vector<double> sigma;
    for (int v = 0; v < skin.vertex_count(); ++v) {
      vertex.push_back(v);
      sigma.push_back(smoothing_width(skin, v, 0.91 * edge));
    }
    const ElasticBody body{&mesh, &is_held, &points, attachment};
    return skin_compliance(skin, node_compliance(skin, skin_mesh.triangles, body, vertex, sigma),
                           1000.0);
  }
};

}  // namespace palmar::contact::contact_test
