// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "tried_products.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <random>

#include "made_products.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/remesh.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/records/product/product_file.h"
#include "peoples_holds.h"

namespace palmar::tests {
namespace {

const std::filesystem::path& scan_folder() {
  static const std::filesystem::path folder = std::filesystem::path(PALMAR_SHARED_DIR) / "products";
  return folder;
}

bool is_made(const std::string& name) {
  return std::any_of(made_shapes().begin(), made_shapes().end(),
                     [&](const MadeShape& shape) { return shape.name == name; });
}

product::Product product_of(const std::string& name, const geometry::TriangleMesh& mesh) {
  return product::make_product(name, mesh, product::UnitDecision{}, "made for a test");
}

// Mean length of an edge of triangles of this number and area, were they equilateral, mm.
double mean_edge(const geometry::TriangleMesh& mesh) {
  return std::sqrt(geometry::surface_area(mesh) / mesh.triangle_count() * 4.0 / std::sqrt(3.0));
}

geometry::TriangleMesh cut_in_four(const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::array<int, 2>, int> middle;
  const auto between = [&](int a, int b) {
    const auto [entry, is_new] =
        middle.try_emplace({std::min(a, b), std::max(a, b)}, fine.vertex_count());
    if (is_new) fine.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return entry->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
    for (const Triangle& t :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      fine.triangles.push_back(t);
    }
  }
  return fine;
}

}  // namespace

bool has_scans() { return std::filesystem::exists(scan_folder()); }

std::vector<std::string> tried_products() {
  std::vector<std::string> names;
  const std::filesystem::path lists = std::filesystem::path(PALMAR_SOURCE_DIR) / "tests" / "holds";
  for (const char* list : {"people.toml", "made.toml", "moved.toml"}) {
    if (std::string(list) == "people.toml" && !has_scans()) continue;
    for (const PeoplesHold& hold : read_peoples_holds(lists / list)) {
      if (std::find(names.begin(), names.end(), hold.product) == names.end()) {
        names.push_back(hold.product);
      }
    }
  }
  return names;
}

product::Product tried_product(const std::string& name) {
  if (is_made(name)) {
    const MadeShape& shape = made_shape(name);
    return product_of(name, net_mesh_of(shape.solid, shape.lattice));
  }
  const std::filesystem::path file = scan_folder() / (name + ".obj");
  if (!std::filesystem::exists(file)) throw UsageError("product \"" + name + "\" doesn't exist");
  return records::load_product(file, {.unit = geometry::LengthUnit::kMillimetre});
}

product::Product moved(const product::Product& product, const geometry::Rigid3& motion) {
  geometry::TriangleMesh mesh = product.mesh;
  for (Vec3& p : mesh.vertices) p = motion * p;
  return product_of(product.name, mesh);
}

product::Product mirrored(const product::Product& product) {
  geometry::TriangleMesh mesh = product.mesh;
  for (Vec3& p : mesh.vertices) p.x() = -p.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return product_of(product.name, mesh);
}

product::Product shuffled(const product::Product& product) {
  std::mt19937 random(20);  // NOLINT: the same order every time
  // Not std::shuffle, whose result the standard leaves open.
  const auto order = [&](int count) {
    std::vector<int> places(count);
    std::iota(places.begin(), places.end(), 0);
    for (int i = count - 1; i > 0; --i) {
      std::swap(places[i], places[random() % static_cast<unsigned>(i + 1)]);
    }
    return places;
  };
  geometry::TriangleMesh mesh;
  const std::vector<int> place = order(product.mesh.vertex_count());
  mesh.vertices.resize(place.size());
  for (std::size_t v = 0; v < place.size(); ++v) {
    mesh.vertices[place[v]] = product.mesh.vertices[v];
  }
  for (const int t : order(product.mesh.triangle_count())) {
    const Triangle& old = product.mesh.triangles[t];
    mesh.triangles.push_back({place[old[1]], place[old[2]], place[old[0]]});
  }
  return product_of(product.name, mesh);
}

product::Product with_finer_mesh(const std::string& name) {
  if (!is_made(name)) return product_of(name, cut_in_four(tried_product(name).mesh));
  const MadeShape& shape = made_shape(name);
  return product_of(name, net_mesh_of(shape.solid, shape.lattice, 2.0));
}

product::Product with_coarser_mesh(const std::string& name) {
  const product::Product product = tried_product(name);
  return product_of(
      name, geometry::remesh(product.mesh, {.edge_length = 2.0 * mean_edge(product.mesh)}).mesh);
}

}  // namespace palmar::tests
