// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/scan_surface.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/mesh/coloured_mesh_file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/orient.h"
#include "palmar/geometry/repair/weld.h"

namespace palmar::person_workflow {
namespace {

constexpr double kShortest = 140.0, kLongest = 480.0;  // mm; hand, hand with forearm
constexpr double kShortestBent = 70.0;                 // mm; a small fist, where the unit is known

double extent_of(const geometry::TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box.sizes().maxCoeff();
}

geometry::LengthUnit unit_of(const std::string& path, double extent,
                             std::optional<geometry::LengthUnit> stated) {
  const auto fits = [&](geometry::LengthUnit unit) {
    const double size = extent * geometry::millimetres_per(unit);
    return size >= kShortest && size <= kLongest;
  };
  if (stated) {
    const double size = extent * geometry::millimetres_per(*stated);
    if (!(size >= kShortestBent && size <= kLongest)) {
      throw InputError(fmt::format(
          "{}: is {:.4g} {} long; a hand with or without a forearm has {:g} (bent) to "
          "{:g} mm. setting \"unit\" says what the numbers mean, or the scan holds more than a "
          "hand",
          path, extent, name_of(*stated), kShortestBent, kLongest));
    }
    return *stated;
  }
  std::vector<geometry::LengthUnit> possible;
  std::string names;
  for (const geometry::LengthUnit unit :
       {geometry::LengthUnit::kMillimetre, geometry::LengthUnit::kCentimetre,
        geometry::LengthUnit::kMetre, geometry::LengthUnit::kInch}) {
    if (!fits(unit)) continue;
    possible.push_back(unit);
    names += (names.empty() ? "" : " or ") + name_of(unit);
  }
  if (possible.size() == 1) return possible.front();
  if (possible.empty()) {
    throw InputError(fmt::format(
        "{}: is {:.4g} long, in no unit as long as a hand ({:g} to {:g} mm): the scan's scale is "
        "arbitrary, or it holds more than a hand",
        path, extent, kShortest, kLongest));
  }
  throw InputError(fmt::format("{}: is {:.4g} long, which may be {}; setting \"unit\" says which",
                               path, extent, names));
}

void drop_unused_vertices(geometry::TriangleMesh& mesh, geometry::SurfaceColours& colours) {
  constexpr int kUnused = -1;
  std::vector<int> renumbered(mesh.vertices.size(), kUnused);
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) renumbered[static_cast<std::size_t>(v)] = 0;
  }
  std::size_t used = 0;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] == kUnused) continue;
    renumbered[v] = static_cast<int>(used);
    mesh.vertices[used] = mesh.vertices[v];
    colours.copy_vertex(v, used);
    ++used;
  }
  mesh.vertices.resize(used);
  colours.keep_vertices(used);
  for (Triangle& t : mesh.triangles) {
    for (int& v : t) v = renumbered[static_cast<std::size_t>(v)];
  }
}

/// The piece with the largest area that isn't flat, as a table is: whose least extent (root of the
/// least moment of its area) is a twentieth of its largest one or more. All flat: the largest.
int largest_solid(const geometry::TriangleMesh& mesh, const std::vector<int>& piece, int pieces) {
  struct Moments {
    double area = 0.0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  };
  std::vector<Moments> all(static_cast<std::size_t>(pieces));
  for (std::size_t t = 0; t < piece.size(); ++t) {
    if (piece[t] < 0) continue;
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    }
    Moments& m = all[static_cast<std::size_t>(piece[t])];
    const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    m.area += area;
    for (const Vec3& v : p) {
      m.first += area / 3.0 * v;
      m.second += area / 3.0 * v * v.transpose();
    }
  }
  int best = 0, best_solid = -1;
  for (int k = 0; k < pieces; ++k) {
    const Moments& m = all[static_cast<std::size_t>(k)];
    if (m.area > all[static_cast<std::size_t>(best)].area) best = k;
    if (!(m.area > 0.0)) continue;
    const Vec3 centre = m.first / m.area;
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m.second / m.area -
                                                                        centre * centre.transpose())
                             .eigenvalues();
    constexpr double kFlat = 0.05;
    const bool is_flat = !(moments[0] > kFlat * kFlat * moments[2]);
    if (is_flat) continue;
    if (best_solid < 0 || m.area > all[static_cast<std::size_t>(best_solid)].area) best_solid = k;
  }
  return best_solid < 0 ? best : best_solid;
}

/// Keeps the hand's piece, without what else was scanned.
void keep_largest_piece(const std::string& path, geometry::TriangleMesh& mesh,
                        geometry::SurfaceColours& colours, std::vector<std::string>& notes) {
  // Scanning programs leave vertices double along seams.
  geometry::WeldOptions options;
  options.drops_duplicates = false;
  options.drops_unused_vertices = false;
  const geometry::WeldResult joined = geometry::weld(mesh, options);
  const std::vector<int> piece_of_joined =
      geometry::triangle_components(joined.mesh, geometry::build_topology(joined.mesh));
  std::vector<int> piece(mesh.triangles.size(), -1);  // -1: collapses
  int pieces = 0;
  for (std::size_t t = 0; t < piece_of_joined.size(); ++t) {
    piece[static_cast<std::size_t>(joined.old_triangle_of_new[t])] = piece_of_joined[t];
    pieces = std::max(pieces, piece_of_joined[t] + 1);
  }
  if (pieces < 2) return;
  const int largest = largest_solid(mesh, piece, pieces);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < piece.size(); ++t) {
    if (piece[t] != largest) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    if (!colours.texture.empty()) {
      colours.texture[kept] = colours.texture[t];
      colours.place[kept] = colours.place[t];
    }
    ++kept;
  }
  notes.push_back(fmt::format("{}: {} loose pieces left out ({} triangles)", path, pieces - 1,
                              mesh.triangles.size() - kept));
  mesh.triangles.resize(kept);
  if (!colours.texture.empty()) {
    colours.texture.resize(kept);
    colours.place.resize(kept);
  }
  drop_unused_vertices(mesh, colours);
}

double mean_edge(const geometry::TriangleMesh& mesh) {
  // Of equilateral triangles.
  return std::sqrt(geometry::surface_area(mesh) / mesh.triangle_count() / 0.433);
}

}  // namespace

ReadSurface read_scan_surface(const std::string& path, std::optional<geometry::LengthUnit> unit) {
  formats::ColouredMeshFile file = formats::read_coloured_mesh(path);
  ReadSurface result;
  for (const std::string& text : file.shape.notes) result.notes.push_back(path + ": " + text);
  geometry::TriangleMesh& mesh = file.shape.mesh;
  keep_largest_piece(path, mesh, file.colours, result.notes);
  const double extent = extent_of(mesh);
  result.unit = unit_of(path, extent, unit ? unit : file.shape.unit);
  if (!unit && !file.shape.unit) {
    result.notes.push_back(
        fmt::format("{}: taken for {}, as it is {:.4g} long", path, name_of(result.unit), extent));
  }
  for (Vec3& v : mesh.vertices) v *= geometry::millimetres_per(result.unit);
  constexpr double kFine = 0.7;  // mm: dots of 3 mm need four edges across
  if (file.colours.empty()) {
    result.surface.mesh = std::move(mesh);
    result.notes.push_back(path + ": has no colours; drawn creases and dots can't be seen");
  } else if (!file.colours.textures.empty()) {
    result.surface = geometry::coloured_mesh(mesh, file.colours, kFine);
  } else {
    constexpr double kCoarse = 1.3;  // mm
    if (mean_edge(mesh) > kCoarse) {
      result.notes.push_back(
          fmt::format("{}: its colours are {:.1f} mm apart, too coarse for dots of 3 mm; export it "
                      "with a texture, or with more triangles",
                      path, mean_edge(mesh)));
    }
    result.surface = {std::move(mesh), std::move(file.colours.vertex),
                      std::move(file.colours.is_guess)};
  }
  const geometry::OrientResult oriented = geometry::orient_outwards(result.surface.mesh);
  if (!oriented.flipped_triangles.empty()) {
    result.notes.push_back(
        path + ": " +
        counted(static_cast<int>(oriented.flipped_triangles.size()), "triangle", "triangles") +
        " turned outwards");
  }
  result.surface.mesh = oriented.mesh;
  return result;
}

geometry::Srgb colour_near(const ReadSurface& scan, const std::string& setting, const Vec3& point) {
  const Vec3 at = geometry::millimetres_per(scan.unit) * point;
  if (scan.surface.colour.empty()) {
    throw InputError("setting \"" + setting + "\": the scan has no colours");
  }
  geometry::Srgb sum = geometry::Srgb::Zero();
  float count = 0.0F;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < scan.surface.colour.size(); ++v) {
    const double distance = (scan.surface.mesh.vertices[v] - at).norm();
    nearest = std::min(nearest, distance);
    if (distance > 1.0) continue;
    sum += scan.surface.colour[v];
    count += 1.0F;
  }
  if (count < 1.0F) {
    throw UsageError(fmt::format(
        "setting \"{}\": {:g},{:g},{:g} is {:.1f} mm off the scan; a point on it is required",
        setting, point.x(), point.y(), point.z(), nearest));
  }
  return sum / count;
}

}  // namespace palmar::person_workflow
