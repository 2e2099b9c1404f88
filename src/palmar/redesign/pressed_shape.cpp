// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/pressed_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/smooth_step.h"
#include "palmar/redesign/align_imprints.h"
#include "palmar/redesign/press_limits.h"
#include "palmar/redesign/press_region.h"
#include "palmar/redesign/surface_diffusion.h"

namespace palmar::redesign {

void KeepOut::add_face(const std::string& word) {
  constexpr std::size_t kMostDigits = 8;
  const bool is_number =
      !word.empty() && word.size() <= kMostDigits &&
      std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (is_number) {
    faces.push_back(std::stoi(word));
  } else {
    names.push_back(word);
  }
}
namespace {

// Over which the direction of pressing turns at an edge. Vertices beside a sharp one meet at about
// 0.9 of it under the surface; half of that folded at depths hands reach.
constexpr double kTurnLength = 6.0;   // mm
constexpr double kTurnMargin = 10.0;  // mm; the surface that is seen for that, round the imprint
constexpr double kTouched = 0.05;     // mm of overlap from which the surface counts as imprinted
constexpr double kPressed = 0.1;      // mm; what the eye and the hand notice
// Cosine between direction and normal of every triangle at a vertex: below the first the direction
// turns towards the vertex' own normal (thin blades), at the second it has.
constexpr double kEnoughInward = 0.5, kLeastInward = 0.15;

void require(bool holds, const char* field, double value, const std::string& allowed) {
  if (holds) return;
  throw UsageError(fmt::format("pressed shape: setting \"{}\" is {}{}; {} is allowed", field, value,
                               allowed.ends_with(" mm") ? " mm" : "", allowed));
}

/// Outward directions of pressing, per vertex of the region. Zero where no direction goes inwards
/// for all triangles at the vertex: it doesn't move.
std::vector<Vec3> press_directions(const geometry::TriangleMesh& part) {
  const std::vector<Vec3> plain = geometry::vertex_normals(part);
  std::vector<Vec3> smooth = SurfaceDiffusion(part, kTurnLength).smooth(plain);
  for (Vec3& m : smooth) m = m.norm() > 1e-6 ? m.normalized() : Vec3::Zero();
  std::vector<double> least(part.vertices.size(), 1.0), least_plain(part.vertices.size(), 1.0);
  for (const Triangle& t : part.triangles) {
    const auto at = [&](int v) { return part.vertices[v]; };
    const Vec3 cross = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    if (!(cross.norm() > 1e-9)) continue;
    for (const int corner : t) {
      least[corner] = std::min(least[corner], smooth[corner].dot(cross.normalized()));
      least_plain[corner] = std::min(least_plain[corner], plain[corner].dot(cross.normalized()));
    }
  }
  for (std::size_t v = 0; v < smooth.size(); ++v) {
    const double own =
        geometry::smooth_step((kEnoughInward - least[v]) / (kEnoughInward - kLeastInward));
    if (own <= 0.0) continue;
    const Vec3 between = (1.0 - own) * smooth[v] + own * plain[v];
    smooth[v] = least_plain[v] >= kLeastInward && between.norm() > 1e-6 ? between.normalized()
                                                                        : Vec3::Zero();
  }
  return smooth;
}

std::vector<Imprint> measure_all(const ImprintGauge& gauge,
                                 std::span<const geometry::TriangleMesh> skins,
                                 const std::vector<double>& shift, const Vec3& axis,
                                 const Progress& progress) {
  std::vector<Imprint> imprints;
  for (std::size_t h = 0; h < skins.size(); ++h) {
    progress.update(static_cast<double>(h) / static_cast<double>(skins.size()), "imprints");
    if (shift.empty() || shift[h] == 0.0) {
      imprints.push_back(gauge.measure(skins[h]));
      continue;
    }
    geometry::TriangleMesh moved = skins[h];
    for (Vec3& x : moved.vertices) x += shift[h] * axis;
    imprints.push_back(gauge.measure(moved));
  }
  return imprints;
}

/// Triangles any of whose corners `chosen` says yes to.
geometry::TriangleMesh triangles_where(const geometry::TriangleMesh& mesh,
                                       const std::vector<unsigned char>& chosen) {
  geometry::TriangleMesh result{mesh.vertices, {}};
  for (const Triangle& t : mesh.triangles) {
    if (chosen[t[0]] || chosen[t[1]] || chosen[t[2]]) {
      result.triangles.push_back(t);
    }
  }
  return result;
}

/// What a field of depths goes through, with the area that each limit took something from.
class Depths {
 public:
  Depths(std::vector<double> depth, const std::vector<double>& areas)
      : depth_(std::move(depth)), areas_(areas) {}

  /// Replaces every depth by change(vertex, depth); returns the area where it lost 0.05 mm or more.
  template <typename Change>
  double apply(const Change& change) {
    double area = 0.0;
    for (std::size_t v = 0; v < depth_.size(); ++v) {
      const double changed = change(v, depth_[v]);
      if (depth_[v] - changed >= kTouched) area += areas_[v];
      depth_[v] = changed;
    }
    return area;
  }
  const std::vector<double>& value() const { return depth_; }

 private:
  std::vector<double> depth_;
  const std::vector<double>& areas_;
};

/// The volume between two states of a part whose border stays: difference of the cones over it.
double volume_between(const geometry::TriangleMesh& part, const std::vector<Vec3>& moved) {
  const Vec3 origin = part.vertices.empty() ? Vec3::Zero() : part.vertices.front();
  double volume = 0.0;
  for (const Triangle& t : part.triangles) {
    const auto cone = [&](const std::vector<Vec3>& at) {
      const Vec3 a = at[t[0]] - origin;
      const Vec3 b = at[t[1]] - origin;
      const Vec3 c = at[t[2]] - origin;
      return a.dot(b.cross(c)) / 6.0;
    };
    volume += cone(part.vertices) - cone(moved);
  }
  return volume;
}

void measure_shape(PressedShape& shape, const PressRegion& region, const std::vector<double>& depth,
                   const std::vector<double>& areas, const std::vector<Vec3>& moved) {
  shape.removed_volume = volume_between(region.part, moved);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] > kPressed) shape.pressed_area += areas[i];
    if (depth[i] <= shape.deepest) continue;
    shape.deepest = depth[i];
    shape.deepest_at = region.part.vertices[i];
  }
}

}  // namespace

void PressedShapeOptions::check() const {
  require(share >= 0.0 && share <= 1.0, "share", share, "0 to 1");
  combine.check();
  require(depth_limit >= 0.1 && depth_limit <= 50.0, "depth limit", depth_limit, "0.1 to 50 mm");
  require(wall >= 0.0 && wall <= 50.0, "wall", wall, "0 to 50 mm");
  require(smoothing >= 0.0 && smoothing <= 20.0, "smoothing", smoothing, "0 to 20 mm");
  require(rim_width >= 0.5 && rim_width <= 50.0, "rim width", rim_width, "0.5 to 50 mm");
  require(edge_length >= 0.3 && edge_length <= 10.0, "edge length", edge_length, "0.3 to 10 mm");
  require(keep_out.blend >= 0.0 && keep_out.blend <= 100.0, "keep blend", keep_out.blend,
          "0 to 100 mm");
  require(align_limit >= 0.0 && align_limit <= 50.0, "align limit", align_limit, "0 to 50 mm");
  if (align_along && !(std::abs(align_along->norm() - 1.0) < 1e-6)) {
    throw UsageError(fmt::format(
        "pressed shape: the axis to align along has length {}; 1 is allowed", align_along->norm()));
  }
}

PressedShape press_shape(const product::Product& product,
                         std::span<const geometry::TriangleMesh> skins,
                         const PressedShapeOptions& options, const Progress& progress) {
  options.check();
  if (skins.empty()) throw UsageError("pressed shape: no hands; at least one is needed");
  const std::vector<unsigned char> kept_faces = kept_face_triangles(product, options.keep_out);

  progress.update(0.0, "where hands reach into the product");
  const double slack = options.align_along ? options.align_limit : 0.0;
  const PressRegion region = refine_under(product, skins, options.edge_length,
                                          std::max(options.rim_width + 2.0, kTurnMargin) + slack);
  PressedShape shape;
  shape.hands = static_cast<int>(skins.size());
  shape.mesh = region.mesh;
  shape.before = region.mesh.vertices;
  shape.triangle_of = region.triangle_of;
  shape.overlap.assign(shape.before.size(), 0.0);
  shape.depth.assign(shape.before.size(), 0.0);
  shape.thinnest_wall = std::numeric_limits<double>::infinity();
  const int points = region.part.vertex_count();
  if (points == 0) return shape;

  const std::vector<double> areas = geometry::vertex_areas(region.part);
  const std::vector<Vec3> outward = press_directions(region.part);
  const ImprintGauge gauge(product.mesh, region.part.vertices, outward);
  std::vector<Imprint> imprints = measure_all(gauge, skins, {}, Vec3::Zero(), progress);
  if (options.align_along) {
    shape.shift = align_imprints(imprints, region.part.vertices, areas, *options.align_along,
                                 options.align_limit);
    imprints = measure_all(gauge, skins, shape.shift, *options.align_along, progress);
  }
  const std::vector<double> overlap = combine_imprints(imprints, points, options.combine);

  progress.update(1.0, "shape");
  std::vector<unsigned char> touched(overlap.size());
  std::vector<double> wanted(overlap.size());
  for (std::size_t i = 0; i < overlap.size(); ++i) {
    touched[i] = overlap[i] > kTouched ? 1 : 0;
    wanted[i] = options.share * overlap[i];
  }
  const SurfaceDiffusion smoothing(region.part, options.smoothing);
  Depths depth(smoothing.smooth(wanted), areas);
  const std::vector<double> from_imprint =
      distance_to(triangles_where(region.part, touched), region.part.vertices, options.rim_width);
  depth.apply([&](std::size_t i, double d) {
    return outward[i].isZero()
               ? 0.0
               : d * (1.0 - geometry::smooth_step(from_imprint[i] / options.rim_width));
  });
  const PressedSurface surface(region, outward);
  const std::vector<double> even = surface.without_creases(depth.value(), options.smoothing);
  depth.apply([&](std::size_t i, double) { return even[i]; });
  const geometry::TriangleMesh kept = kept_part(region, kept_faces, options.keep_out);
  if (!kept.triangles.empty()) {
    const double blend = std::max(options.keep_out.blend, 1e-6);
    const std::vector<double> from_kept = distance_to(kept, region.part.vertices, blend);
    shape.limited_by_keep_out = depth.apply(
        [&](std::size_t i, double d) { return d * geometry::smooth_step(from_kept[i] / blend); });
  }
  shape.limited_by_depth =
      depth.apply([&](std::size_t, double d) { return held_below(d, options.depth_limit); });
  shape.limited_by_wall = depth.apply([&](std::size_t i, double d) {
    return held_below(d, std::max(0.0, 0.5 * (gauge.wall()[i] - options.wall)));
  });

  const std::vector<double> scale =
      surface.sound_share(depth.value(), gauge.wall(), options.wall, progress);
  shape.limited_by_crossing = depth.apply([&](std::size_t i, double d) { return scale[i] * d; });

  const std::vector<Vec3> moved = surface.moved(depth.value());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const int v = region.part_vertex[i];
    shape.mesh.vertices[v] = moved[i];
    shape.overlap[v] = overlap[i];
    shape.depth[v] = depth.value()[i];
  }
  measure_shape(shape, region, depth.value(), areas, moved);
  shape.thinnest_wall = surface.thinnest_wall(depth.value(), kPressed);
  return shape;
}

product::Product pressed_product(const product::Product& original, const PressedShape& shape,
                                 const std::string& name) {
  product::Product product;
  product.name = name;
  product.mesh = shape.mesh;
  product.unit_source = product::UnitSource::kMade;
  product.source = original.source + ", pressed";
  product.distance = std::make_shared<const geometry::MeshDistance>(product.mesh);
  if (original.faces) {
    auto faces = std::make_shared<product::ProductFaces>(*original.faces);
    faces->face_of_triangle.clear();
    for (product::ProductFace& face : faces->face) face.area = 0.0;
    for (int t = 0; t < shape.mesh.triangle_count(); ++t) {
      const Triangle& c = shape.mesh.triangles[t];
      const int below = shape.triangle_of[t];
      const int face = original.faces->face_of_triangle[below];
      faces->face_of_triangle.push_back(face);
      if (face < 0) continue;
      faces->face[face].area += geometry::triangle_area(
          shape.mesh.vertices[c[0]], shape.mesh.vertices[c[1]], shape.mesh.vertices[c[2]]);
    }
    product.faces = std::move(faces);
  }
  return product;
}

}  // namespace palmar::redesign
