// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/product_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/product/parts/loop_opening.h"
#include "palmar/product/parts/part_kind.h"
#include "palmar/product/parts/part_labels.h"
#include "palmar/product/parts/part_line.h"
#include "palmar/product/parts/part_outline.h"
#include "palmar/product/parts/part_spread.h"
#include "palmar/product/parts/part_stations.h"
#include "palmar/product/parts/part_triggers.h"
#include "palmar/product/parts/ring_parts.h"
#include "palmar/product/parts/rough_parts.h"
#include "palmar/product/parts/solid_grid.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar::product {
namespace {

double median_of(const std::vector<PartSection>& sections, double PartSection::*value) {
  std::vector<double> values;
  for (const PartSection& s : sections) values.push_back(s.*value);
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A part along its own centre line, if it has one that is measured well.
bool measure_as_bar(const geometry::TriangleMesh& mesh, const geometry::TriangleMesh& piece,
                    const SolidGrid& grid, const std::vector<SolidBall>& balls,
                    const RoughPart& rough, int id, double gap, ProductPart& part,
                    std::vector<Vec3>& line) {
  if (rough.line.size() < 4) return false;
  LineRequest request;
  for (const Vec3& p : rough.line) request.line.push_back(grid.product_from_grid * p);
  request.radius = rough.radius;
  request.is_ring = rough.is_ring;
  request.is_free = {rough.end_part[0] < 0, rough.end_part[1] < 0};
  request.points = piece.vertices;
  request.gap = gap;
  request.is_in_loop = rough.is_in_loop;
  MeasuredLine measured = measure_line(mesh, request);
  if (measured.sections.empty()) return false;
  // A line that left the part (through a head into its handle) has other sections than the part.
  constexpr double kOwnVolume = 0.25;  // share that the line's sections make up at least
  constexpr double kOwnPoints = 0.7;   // share of its points in the part at least
  double area = 0.0;
  for (const PartSection& s : measured.sections) area += s.area;
  area /= static_cast<double>(measured.sections.size());
  if (area * measured.length < kOwnVolume * rough.volume) return false;
  int own = 0;
  for (const Vec3& p : measured.line) {
    if (nearest_part(balls, grid.product_from_grid.to_grid(p)) == id) ++own;
  }
  if (own < kOwnPoints * static_cast<double>(measured.line.size())) return false;
  part.is_ring = rough.is_ring;
  part.sections = std::move(measured.sections);
  part.length = measured.length;
  line = std::move(measured.line);
  part.straightness = part.is_ring ? 0.0 : (line.back() - line.front()).norm() / part.length;
  return true;
}

void measure_as_body(const geometry::TriangleMesh& piece, const Spread& spread,
                     const Spread& facing, bool is_plate, ProductPart& part,
                     std::vector<Vec3>& line) {
  const Vec3 axis =
      is_plate ? plate_axis(piece, spread, facing.axes.col(0)) : body_axis(piece, spread, facing);
  MeasuredLine measured = measure_axis(piece, spread.middle, axis);
  part.sections = std::move(measured.sections);
  part.length = measured.length;
  part.straightness = 1.0;
  part.is_ring = false;
  part.ends = {};
  line = std::move(measured.line);
}

void summarise(ProductPart& part) {
  part.girth = median_of(part.sections, &PartSection::girth);
  part.width = median_of(part.sections, &PartSection::width);
  part.thickness = median_of(part.sections, &PartSection::thickness);
}

}  // namespace

std::string name_of(PartKind kind) {
  switch (kind) {
    case PartKind::kBar:
      return "bar";
    case PartKind::kPen:
      return "pen";
    case PartKind::kLoop:
      return "loop";
    case PartKind::kBody:
      return "body";
    case PartKind::kBall:
      return "ball";
    case PartKind::kPlate:
      return "plate";
  }
  return "body";
}

double ProductPart::diameter() const { return girth / std::numbers::pi; }

void PartOptions::check() const {
  if (!(finger >= 2.0 && finger <= 50.0)) {
    throw UsageError("setting \"finger\" is " + significant(finger, 3) +
                     " mm; 2 to 50 are allowed");
  }
  if (voxels < 10000 || voxels > 4000000) {
    throw UsageError("setting \"voxels\" is " + std::to_string(voxels) +
                     "; 10000 to 4000000 are allowed");
  }
}

ProductParts find_parts(const Product& product, const PartOptions& options) {
  options.check();
  const geometry::TriangleMesh& mesh = product.mesh;
  ProductParts result;
  if (mesh.triangles.empty()) return result;
  SolidGridOptions solid;
  solid.closing = 0.5 * options.finger;
  solid.voxels = options.voxels;
  const SolidGrid grid = make_solid_grid(mesh, solid);
  const SkeletonGraph graph = skeleton_of(grid);
  const GirthAt girth_at = [&](const Vec3& point, const Vec3& direction) {
    const auto outline =
        outline_at(mesh, grid.product_from_grid * point, grid.product_from_grid.axes * direction,
                   {grid.depth_at(point) + grid.spacing, options.finger});
    return outline ? outline->girth : 0.0;
  };
  RoughParts rough = rough_parts(grid, graph, girth_at);
  complete_rings(mesh, grid, graph, options.finger, rough);
  std::vector<int> label = labels_of(mesh, grid, rough);
  const geometry::MeshTopology topology = geometry::build_topology(mesh);
  absorb_islands(mesh, topology, label);
  const Vec3 middle = surface_middle(mesh);
  const int count = static_cast<int>(rough.parts.size());
  std::vector<std::vector<int>> touching(count);
  for (const auto& [a, b] : rough.joints) {
    touching[a].push_back(b);
    touching[b].push_back(a);
  }
  struct Found {
    ProductPart part;
    int rough = 0;
  };
  std::vector<Found> found;
  // Lines first: where they end says which triangles are theirs.
  std::vector<ProductPart> bars(count);
  std::vector<std::vector<Vec3>> lines(count);
  std::vector<char> has_line(count, 0);
  for (int id = 0; id < count; ++id) {
    const geometry::TriangleMesh piece = piece_of(mesh, label, id);
    has_line[id] = measure_as_bar(mesh, piece, grid, rough.balls, rough.parts[id], id,
                                  options.finger, bars[id], lines[id])
                       ? 1
                       : 0;
  }
  for (int id = 0; id < count; ++id) {
    if (has_line[id] != 0 && !bars[id].is_ring) {
      give_to_joined(mesh, rough.parts[id], lines[id], id, label);
    }
  }
  absorb_islands(mesh, topology, label);
  for (int id = 0; id < count; ++id) {
    const geometry::TriangleMesh piece = piece_of(mesh, label, id);
    if (piece.triangles.empty()) continue;
    Found f;
    f.part = std::move(bars[id]);
    f.rough = id;
    ProductPart& part = f.part;
    part.volume = rough.parts[id].volume;
    part.area = geometry::surface_area(piece);
    const Spread spread = spread_of(piece);
    const Spread facing = facing_of(piece);
    const Vec3 face = facing.axes.col(0);
    std::vector<Vec3> line = std::move(lines[id]);
    PartShape shape;
    shape.is_in_loop = rough.parts[id].is_in_loop;
    shape.joints = static_cast<int>(touching[id].size());
    shape.has_line = has_line[id] != 0;
    shape.extent = extents_of(piece, spread.axes);
    shape.across_faces = extents_of(piece, Eigen::Matrix3d(face.replicate<1, 3>())).x();
    shape.roundness = roundness_of(piece, spread);
    if (shape.has_line) {
      summarise(part);
      if (part.is_ring || shape.is_in_loop) {
        part.opening = loop_opening(mesh, line);
        if (part.opening && part.opening->disc < options.finger) part.opening.reset();
      }
    }
    part.kind = kind_of(part, shape);
    if (part.kind != PartKind::kLoop) part.opening.reset();
    if (part.kind != PartKind::kLoop && part.kind != PartKind::kBar &&
        part.kind != PartKind::kPen) {
      measure_as_body(piece, spread, facing, part.kind == PartKind::kPlate, part, line);
      if (part.sections.empty()) continue;
      summarise(part);
      if (part.kind == PartKind::kBody && is_bar_by_size(part)) part.kind = PartKind::kBar;
      if (part.kind == PartKind::kPlate) part.face_normal = face;
      if (part.kind == PartKind::kBody) part.waists = waists_of(part.sections);
    } else if (!part.is_ring) {
      for (std::size_t k = 0; k < 2; ++k) {
        if (rough.parts[id].end_part[k] >= 0) part.ends[k].joined = rough.parts[id].end_part[k];
      }
    }
    if (runs_backwards(part, line, middle)) {
      std::reverse(line.begin(), line.end());
      std::reverse(part.sections.begin(), part.sections.end());
      std::swap(part.ends[0], part.ends[1]);
      for (PartSection& s : part.sections) {
        s.along = 1.0 - s.along;
        s.axis = -s.axis;
      }
      std::reverse(part.waists.begin(), part.waists.end());
      for (PartWaist& w : part.waists) w.along = 1.0 - w.along;
    }
    part.line = stations_of(line, part.is_ring, zero_of(part, line, middle));
    if (!part.is_ring) {
      part.ends[0].point = line.front();
      part.ends[1].point = line.back();
    }
    found.push_back(std::move(f));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.part.volume > b.part.volume; });
  std::vector<int> number(count, 0);
  for (std::size_t i = 0; i < found.size(); ++i) number[found[i].rough] = static_cast<int>(i) + 1;
  for (Found& f : found) {
    ProductPart& part = f.part;
    part.number = number[f.rough];
    for (PartEnd& end : part.ends) {
      if (end.joined)
        end.joined = number[*end.joined] > 0 ? std::optional(number[*end.joined]) : std::nullopt;
    }
    for (const int other : touching[f.rough]) {
      if (number[other] > 0) part.joined.push_back(number[other]);
    }
    std::sort(part.joined.begin(), part.joined.end());
    result.parts.push_back(std::move(part));
  }
  name_parts(result.parts);
  result.part_of_triangle.resize(label.size());
  for (std::size_t t = 0; t < label.size(); ++t) {
    result.part_of_triangle[t] = std::max(0, number[label[t]] - 1);
  }
  result.triggers = triggers_of(product, result.parts);
  result.buttons = buttons_of(mesh, result.part_of_triangle);
  const geometry::TopologyReport report = geometry::examine_topology(mesh, topology);
  if (report.is_closed && report.is_two_manifold) {
    int loops = 0;
    for (const ProductPart& part : result.parts) loops += part.kind == PartKind::kLoop ? 1 : 0;
    result.narrow_tunnels = std::max(0, report.components - report.euler_number / 2 - loops);
  }
  return result;
}

int ProductParts::nearest(const Product& product, const Vec3& point) const {
  if (parts.empty()) throw UsageError("product \"" + product.name + "\" has no parts");
  const geometry::DistanceSample sample = product.distance->at(point);
  if (sample.triangle >= 0 && sample.triangle < static_cast<int>(part_of_triangle.size())) {
    return part_of_triangle[sample.triangle];
  }
  int best = 0;  // of a field without triangles: the part with the nearest triangle
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < part_of_triangle.size(); ++t) {
    const Triangle& corner = product.mesh.triangles[t];
    const Vec3 middle = (product.mesh.vertices[corner[0]] + product.mesh.vertices[corner[1]] +
                         product.mesh.vertices[corner[2]]) /
                        3.0;
    const double d = (middle - point).squaredNorm();
    if (d < least) {
      least = d;
      best = part_of_triangle[t];
    }
  }
  return best;
}

}  // namespace palmar::product
