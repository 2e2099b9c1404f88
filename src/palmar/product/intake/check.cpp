// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/check.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <string>

#include "palmar/core/text.h"
#include "palmar/geometry/mesh/boundary_loops.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/low_triangles.h"
#include "palmar/geometry/repair/orient.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/geometry/repair/weld.h"

namespace palmar::product {
namespace {

constexpr double kWidestGrip = 110.0;      // mm
constexpr double kThinnestHandle = 4.0;    // mm
constexpr double kShortestProduct = 20.0;  // mm
constexpr double kTinyShare = 0.01;        // of the diagonal of the whole
constexpr double kLowShare = 1e-6;         // of the diagonal: height of a triangle without area
constexpr double kFlattestShare = 1e-3;    // volume / (area * size) below which nothing is enclosed

/// Sides of the box along the principal directions of the surface, ascending.
Vec3 principal_extent(const geometry::TriangleMesh& mesh) {
  Vec3 mean = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double w = geometry::triangle_area(a, b, c);
    mean += w * (a + b + c) / 3.0;
    area += w;
  }
  if (!(area > 0.0)) return Vec3::Zero();
  mean /= area;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 x = (a + b + c) / 3.0 - mean;
    covariance += geometry::triangle_area(a, b, c) * x * x.transpose();
  }
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  Box3 box;
  for (const Vec3& x : mesh.vertices) box.extend(axes.transpose() * (x - mean));
  Vec3 extent = box.sizes();
  std::sort(extent.data(), extent.data() + 3);
  return extent;
}

int count_tiny_parts(const geometry::TriangleMesh& mesh, const std::vector<int>& component,
                     int parts, double diagonal) {
  std::vector<Box3> boxes(parts);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (component[t] < 0) continue;
    for (const int v : mesh.triangles[t]) boxes[component[t]].extend(mesh.vertices[v]);
  }
  return static_cast<int>(std::count_if(boxes.begin(), boxes.end(), [&](const Box3& box) {
    return box.diagonal().norm() < kTinyShare * diagonal;
  }));
}

void judge(ProductCheck& c, const geometry::OrientResult& oriented) {
  const auto add = [&](Severity severity, const std::string& text) {
    c.findings.push_back({severity, text});
  };
  if (c.is_closed) {
    add(Severity::kOk, "closed: every edge has two triangles");
  } else {
    add(Severity::kWarning, "open: " + counted(c.holes, "hole", "holes") + " with " +
                                counted(c.boundary_edges, "edge", "edges") +
                                "; inside is judged by the winding number");
  }
  if (c.non_manifold_edges > 0) {
    add(Severity::kNote,
        counted(c.non_manifold_edges, "edge has", "edges have") + " more than two triangles");
  }
  if (c.duplicate_triangles > 0) {
    add(Severity::kNote,
        counted(c.duplicate_triangles, "triangle is", "triangles are") + " there twice");
  }
  if (c.low_triangles > 0) {
    add(Severity::kNote,
        counted(c.low_triangles, "triangle has", "triangles have") + " no area to speak of");
  }
  if (c.is_inverted) add(Severity::kWarning, "inside out: its triangles face inwards");
  if (c.flipped_triangles > 0) {
    add(Severity::kWarning, counted(c.flipped_triangles, "triangle faces", "triangles face") +
                                " the wrong way, in " +
                                counted(c.flipped_patches, "patch", "patches") + " of " +
                                std::to_string(oriented.patches));
  } else {
    add(Severity::kOk, "oriented: every triangle faces outwards");
  }
  if (oriented.undecided_patches > 0) {
    add(Severity::kWarning, "for " + counted(oriented.undecided_patches, "patch", "patches") +
                                " it can't be determined which side is outside");
  }
  if (oriented.twisted_patches > 0) {
    add(Severity::kWarning, counted(oriented.twisted_patches, "patch is", "patches are") +
                                " one-sided like a Moebius band");
  }
  if (c.crossing_pairs > 0) {
    add(Severity::kNote,
        counted(c.crossing_pairs, "pair", "pairs") + " of triangles go through each other");
  }
  if (c.parts > 1) {
    add(Severity::kNote, std::to_string(c.parts) + " separate parts, " +
                             std::to_string(c.tiny_parts) + " of them tiny (below " +
                             significant(100.0 * kTinyShare, 4) + " % of the size)");
  }
  if (c.is_closed && std::abs(c.volume) < kFlattestShare * c.area * c.extent.z()) {
    add(Severity::kError, "encloses next to nothing: " + significant(c.volume, 4) + " mm^3 under " +
                              significant(c.area, 4) + " mm^2");
  }
  const std::string extent = significant(c.extent.x(), 4) + " x " + significant(c.extent.y(), 4) +
                             " x " + significant(c.extent.z(), 4) + " mm";
  if (c.is_too_big) {
    add(Severity::kWarning, "too big for a hand: its smallest side is " +
                                significant(c.extent.x(), 4) + " mm; a hand reaches round " +
                                significant(kWidestGrip, 4) + " mm");
  } else if (c.is_too_small) {
    add(Severity::kWarning, "too small for a power grip: " + extent + "; at least " +
                                significant(kShortestProduct, 4) + " mm long and " +
                                significant(kThinnestHandle, 4) + " mm thick is needed");
  } else {
    add(Severity::kOk, "fits a hand: " + extent);
  }
}

void rank(ProductCheck& c) {
  std::stable_sort(c.findings.begin(), c.findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) > static_cast<int>(b.severity);
  });
  if (!c.findings.empty()) c.verdict = c.findings.front().severity;
}

}  // namespace

std::string name_of(Severity severity) {
  switch (severity) {
    case Severity::kOk:
      return "ok";
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "error";
  }
  return "";
}

std::vector<int> bodies_of_triangles(const ProductFaces& faces) {
  std::map<std::string, int> number;
  std::vector<int> of_face;
  for (const ProductFace& face : faces.face) {
    of_face.push_back(number.try_emplace(face.part, static_cast<int>(number.size())).first->second);
  }
  std::vector<int> bodies;
  bodies.reserve(faces.face_of_triangle.size());
  for (const int face : faces.face_of_triangle) bodies.push_back(of_face[face]);
  return bodies;
}

ProductCheck check_mesh(const geometry::TriangleMesh& mesh, bool looks_for_crossings,
                        const std::vector<int>& bodies) {
  ProductCheck c;
  const geometry::TriangleMesh welded =
      geometry::weld(mesh, {.drops_duplicates = false, .groups = bodies}).mesh;
  c.duplicate_triangles = geometry::weld(mesh, {.groups = bodies}).dropped_duplicate;
  c.triangles = welded.triangle_count();
  c.vertices = welded.vertex_count();
  c.area = geometry::surface_area(welded);
  if (welded.triangles.empty() || !(c.area > 0.0)) {
    c.findings.push_back({Severity::kError, "no triangles with an area"});
    c.verdict = Severity::kError;
    return c;
  }
  const geometry::MeshTopology topology = geometry::build_topology(welded);
  const geometry::TopologyReport report = geometry::examine_topology(welded, topology);
  c.parts = report.components;
  c.boundary_edges = report.boundary_edges;
  c.holes = report.boundary_loops;
  for (const geometry::BoundaryLoop& loop : geometry::find_boundary_loops(welded, topology).loops) {
    c.hole_perimeters.push_back(loop.perimeter);
  }
  c.non_manifold_edges = report.non_manifold_edges;
  c.euler_number = report.euler_number;
  c.is_closed = report.is_closed;
  c.volume = geometry::signed_volume(welded);
  c.is_inverted = c.is_closed && c.volume < 0.0;
  c.size = geometry::bounding_box(welded).sizes();
  c.extent = principal_extent(welded);
  c.is_too_big = c.extent.x() > kWidestGrip;
  c.is_too_small = c.extent.z() < kShortestProduct || c.extent.y() < kThinnestHandle;
  c.low_triangles = static_cast<int>(
      std::count_if(welded.triangles.begin(), welded.triangles.end(), [&](const Triangle& t) {
        return geometry::least_height(welded.vertices[t[0]], welded.vertices[t[1]],
                                      welded.vertices[t[2]]) <= kLowShare * c.size.norm();
      }));
  c.tiny_parts = count_tiny_parts(welded, geometry::triangle_components(welded, topology), c.parts,
                                  c.size.norm());
  if (looks_for_crossings) {
    c.crossing_pairs = static_cast<int>(geometry::find_self_crossings(welded).size());
  }
  const geometry::OrientResult oriented = geometry::orient_outwards(welded);
  c.flipped_patches = oriented.flipped_patches + oriented.repaired_patches;
  c.flipped_triangles = static_cast<int>(oriented.flipped_triangles.size());
  c.undecided_patches = oriented.undecided_patches;
  c.twisted_patches = oriented.twisted_patches;
  judge(c, oriented);
  rank(c);
  return c;
}

ProductCheck check_product(const Product& product) {
  ProductCheck c = check_mesh(
      product.mesh, true, product.faces ? bodies_of_triangles(*product.faces) : std::vector<int>());
  for (const std::string& text : product.notes) c.findings.push_back({Severity::kNote, text});
  rank(c);
  return c;
}

}  // namespace palmar::product
