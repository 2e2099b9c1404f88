// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/make_product.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/orient.h"
#include "palmar/geometry/repair/weld.h"
#include "palmar/product/intake/check.h"
#include "palmar/product/intake/contact_body.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::product {
namespace {

constexpr double kFileRounding = 1e-6;  // of the size; single-precision files round to about 1e-7

std::string tenths(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

void check_raw(const geometry::TriangleMesh& raw, const std::string& source) {
  for (int v = 0; v < raw.vertex_count(); ++v) {
    const Vec3& x = raw.vertices[v];
    if (x.allFinite()) continue;
    throw InputError(source + ": vertex " + std::to_string(v) + " is (" + significant(x.x(), 6) +
                     ", " + significant(x.y(), 6) + ", " + significant(x.z(), 6) +
                     "); finite numbers are required");
  }
  for (int t = 0; t < raw.triangle_count(); ++t) {
    for (const int v : raw.triangles[t]) {
      if (v >= 0 && v < raw.vertex_count()) continue;
      throw InputError(source + ": triangle " + std::to_string(t) + " names vertex " +
                       std::to_string(v) + "; " + std::to_string(raw.vertex_count()) +
                       " vertices exist");
    }
  }
  if (raw.triangles.empty()) throw InputError(source + ": no triangles");
  if (raw.triangles.size() == 1) {
    throw InputError(source + ": only one triangle; a surface that can be held needs more");
  }
}

void note_repairs(const geometry::WeldResult& welded, const geometry::OrientResult& oriented,
                  std::vector<std::string>& notes) {
  if (welded.dropped_degenerate > 0) {
    notes.push_back("dropped " + counted(welded.dropped_degenerate, "triangle", "triangles") +
                    " without area");
  }
  if (welded.dropped_duplicate > 0) {
    notes.push_back("dropped " + counted(welded.dropped_duplicate, "triangle", "triangles") +
                    " that stood there twice");
  }
  if (oriented.flipped_patches > 0) {
    notes.push_back("turned " + counted(oriented.flipped_patches, "patch", "patches") +
                    " that faced inwards (of " + std::to_string(oriented.patches) + ")");
  }
  if (oriented.repaired_patches > 0) {
    notes.push_back("made neighbouring triangles agree about outside in " +
                    counted(oriented.repaired_patches, "patch", "patches"));
  }
  if (!oriented.flipped_triangles.empty()) {
    notes.push_back(
        counted(static_cast<int>(oriented.flipped_triangles.size()), "triangle", "triangles") +
        " flipped in all, of " + std::to_string(oriented.mesh.triangle_count()));
  }
  if (oriented.twisted_patches > 0) {
    notes.push_back(counted(oriented.twisted_patches, "patch is", "patches are") +
                    " one-sided like a Moebius band; inside and outside are doubtful there");
  }
  if (oriented.undecided_patches > 0) {
    notes.push_back("for " + counted(oriented.undecided_patches, "patch", "patches") +
                    " it can't be determined which side is outside; left as in the file");
  }
}

/// The same faces for the triangles that are left; orienting keeps their order.
std::shared_ptr<const ProductFaces> faces_after_weld(ProductFaces faces,
                                                     const geometry::WeldResult& welded,
                                                     std::vector<std::string>& notes) {
  std::vector<int> face_of_triangle;
  face_of_triangle.reserve(welded.old_triangle_of_new.size());
  std::vector<bool> is_left(faces.face.size(), false), was_there(faces.face.size(), false);
  for (const int face : faces.face_of_triangle) was_there[face] = true;
  for (const int old : welded.old_triangle_of_new) {
    face_of_triangle.push_back(faces.face_of_triangle[old]);
    is_left[face_of_triangle.back()] = true;
  }
  for (std::size_t f = 0; f < faces.face.size(); ++f) {
    if (is_left[f] || !was_there[f]) continue;
    constexpr double kSmall = 0.01;  // mm^2
    notes.push_back(title_of(faces.face[f]) +
                    (faces.face[f].area < kSmall
                         ? " is too small to be kept: no triangle of it is left"
                         : " lies on another face: the body is there twice, or is folded onto "
                           "itself; one of both is left"));
  }
  faces.face_of_triangle = std::move(face_of_triangle);
  return std::make_shared<const ProductFaces>(std::move(faces));
}

/// The surface that skin meets: cavities behind thin walls are filled (contact_body.h). An open
/// surface stays as it is; its inside is judged by the winding number.
geometry::TriangleMesh body_in_contact(const geometry::TriangleMesh& mesh,
                                       const geometry::TopologyReport& topology,
                                       std::vector<std::string>& notes) {
  if (!topology.is_closed) return mesh;
  ContactBody body = contact_body(mesh);
  if (body.dropped > 0 && body.width < PartOptions{}.finger) {
    notes.push_back("holes or slots of about " + tenths(body.width) +
                    " mm, which no finger enters, count as solid for contact where walls beside "
                    "them are thin (the thinnest " +
                    tenths(body.thinnest_wall) + " mm)");
  } else if (body.dropped > 0) {
    notes.push_back("walls (the thinnest " + tenths(body.thinnest_wall) +
                    " mm) part a cavity from the outside: for contact it counts as solid, as no "
                    "skin of a hand round the product reaches into it");
  }
  return std::move(body.mesh);
}

}  // namespace

Product make_product(const std::string& name, const geometry::TriangleMesh& raw,
                     const UnitDecision& unit, const std::string& source,
                     const ProductFaces* faces) {
  check_raw(raw, source);
  if (faces != nullptr) check_faces(*faces, raw.triangle_count(), source);
  geometry::TriangleMesh in_mm = raw;
  const double scale = geometry::millimetres_per(unit.unit);
  if (scale != 1.0) {
    for (Vec3& x : in_mm.vertices) x *= scale;
  }
  Box3 box;
  for (const Triangle& t : in_mm.triangles) {
    for (const int v : t) box.extend(in_mm.vertices[v]);
  }
  const geometry::WeldResult welded = geometry::weld(
      in_mm, {.tolerance = kFileRounding * box.sizes().maxCoeff(),
              .groups = faces != nullptr ? bodies_of_triangles(*faces) : std::vector<int>()});
  if (welded.mesh.triangle_count() < 2 || !(geometry::surface_area(welded.mesh) > 0.0)) {
    throw InputError(source + ": its triangles have no area (size " +
                     significant(box.sizes().x(), 6) + " x " + significant(box.sizes().y(), 6) +
                     " x " + significant(box.sizes().z(), 6) + " mm)");
  }
  geometry::OrientResult oriented = geometry::orient_outwards(welded.mesh);

  Product product;
  product.name = name;
  product.unit = unit.unit;
  product.unit_source = unit.source;
  product.source = source;
  if (!unit.explanation.empty()) product.notes.push_back(unit.explanation);
  note_repairs(welded, oriented, product.notes);
  const geometry::TopologyReport topology = geometry::examine_topology(oriented.mesh);
  if (!topology.is_closed) {
    product.notes.push_back(
        "the surface is open: " + counted(topology.boundary_loops, "hole", "holes") + " with " +
        counted(topology.boundary_edges, "edge", "edges") +
        "; inside is judged by the winding number");
  }
  product.mesh = std::move(oriented.mesh);
  if (faces != nullptr) {
    product.faces = faces_after_weld(scaled(*faces, scale), welded, product.notes);
  }
  product.distance = std::make_shared<const geometry::MeshDistance>(
      body_in_contact(product.mesh, topology, product.notes));
  return product;
}

}  // namespace palmar::product
