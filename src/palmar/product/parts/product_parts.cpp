// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/product_parts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/text.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/product/parts/loop_opening.h"
#include "palmar/product/parts/part_kind.h"
#include "palmar/product/parts/part_line.h"
#include "palmar/product/parts/part_outline.h"
#include "palmar/product/parts/rough_parts.h"
#include "palmar/product/parts/solid_grid.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar {
namespace {

// An offset of the middle of the product's surface from a part, as a share of the part's size,
// that is more than rounding and noise: below it the part counts as lying on that middle.
constexpr double kAside = 0.02;

double median_of(const std::vector<PartSection>& sections, double PartSection::*value) {
  std::vector<double> values;
  for (const PartSection& s : sections) values.push_back(s.*value);
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Vec3 surface_middle(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double A = triangle_area(a, b, c);
    area += A;
    sum += A / 3.0 * (a + b + c);
  }
  return area > 0.0 ? Vec3(sum / area) : Vec3(mesh.vertices[mesh.triangles[0][0]]);
}

// Labels of triangles: the nearest ball's part; islands within another part become its own.
std::vector<int> labels_of(const TriangleMesh& mesh, const SolidGrid& grid,
                           const RoughParts& rough) {
  std::vector<int> label(mesh.triangles.size(), 0);
  constexpr int kBlock = 512;
  const int count = mesh.triangle_count();
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    for (int t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t) {
      const Triangle& corner = mesh.triangles[t];
      const Vec3 middle =
          (mesh.vertices[corner[0]] + mesh.vertices[corner[1]] + mesh.vertices[corner[2]]) / 3.0;
      label[t] = std::max(0, nearest_part(rough.balls, grid.product_from_grid.to_grid(middle)));
    }
  });
  return label;
}

// Pieces of a part apart from its largest take the part that they border on most, if they are
// small: specks where two parts are equally near.
void absorb_islands(const TriangleMesh& mesh, const MeshTopology& topology,
                    std::vector<int>& label) {
  constexpr double kIsland = 0.2;  // share of the part's largest piece
  const int count = mesh.triangle_count();
  for (int round = 0; round < 4; ++round) {
    std::vector<int> piece(count, -1);
    std::vector<double> area;
    std::vector<int> part, stack;
    for (int start = 0; start < count; ++start) {
      if (piece[start] >= 0) continue;
      const int id = static_cast<int>(area.size());
      area.push_back(0.0);
      part.push_back(label[start]);
      stack.assign(1, start);
      piece[start] = id;
      while (!stack.empty()) {
        const int t = stack.back();
        stack.pop_back();
        const Triangle& c = mesh.triangles[t];
        area[id] += triangle_area(mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]);
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
          const int other = topology.twin[h] < 0 ? -1 : topology.twin[h] / 3;
          if (other < 0 || piece[other] >= 0 || label[other] != label[start]) continue;
          piece[other] = id;
          stack.push_back(other);
        }
      }
    }
    std::map<int, double> largest;
    for (std::size_t p = 0; p < area.size(); ++p) {
      largest[part[p]] = std::max(largest[part[p]], area[p]);
    }
    std::vector<std::map<int, double>> border(area.size());
    for (int t = 0; t < count; ++t) {
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int other = topology.twin[h] < 0 ? -1 : topology.twin[h] / 3;
        if (other < 0 || piece[other] == piece[t]) continue;
        const Triangle& c = mesh.triangles[t];
        border[piece[t]][label[other]] +=
            (mesh.vertices[c[(h + 1) % 3]] - mesh.vertices[c[h % 3]]).norm();
      }
    }
    bool has_changed = false;
    for (int t = 0; t < count; ++t) {
      const int p = piece[t];
      if (area[p] >= kIsland * largest[part[p]] || border[p].empty()) continue;
      int best = -1;
      double longest = 0.0;
      for (const auto& [other, length] : border[p]) {
        if (length > longest) {
          longest = length;
          best = other;
        }
      }
      if (best < 0 || best == label[t]) continue;
      label[t] = best;
      has_changed = true;
    }
    if (!has_changed) break;
  }
}

// Triangles of a bar beyond its joined ends belong to what it joins there.
void give_to_joined(const TriangleMesh& mesh, const RoughPart& rough, const std::vector<Vec3>& line,
                    int id, std::vector<int>& label) {
  for (std::size_t t = 0; t < label.size(); ++t) {
    if (label[t] != id) continue;
    const Triangle& c = mesh.triangles[t];
    const Vec3 x = (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3.0;
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      if ((line[i] - x).squaredNorm() < (line[nearest] - x).squaredNorm()) nearest = i;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t end = k == 0 ? 0 : line.size() - 1;
      if (nearest != end || rough.end_part[k] < 0) continue;
      const Vec3 out = k == 0 ? Vec3(line[0] - line[1]) : Vec3(line[end] - line[end - 1]);
      if (out.dot(x - line[end]) > 0.0) label[t] = rough.end_part[k];
    }
  }
}

TriangleMesh piece_of(const TriangleMesh& mesh, const std::vector<int>& label, int part) {
  TriangleMesh piece;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (label[t] != part) continue;
    Triangle triangle = mesh.triangles[t];
    for (int& i : triangle) {
      if (index[i] < 0) {
        index[i] = piece.vertex_count();
        piece.vertices.push_back(mesh.vertices[i]);
      }
      i = index[i];
    }
    piece.triangles.push_back(triangle);
  }
  return piece;
}

// Axes of a piece of surface, most spread first, with the spreads (standard deviations, mm).
struct Spread {
  Vec3 middle = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 size = Vec3::Zero();
};

Spread spread_of(const TriangleMesh& piece) {
  Spread s;
  s.middle = surface_middle(piece);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double area = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 a = piece.vertices[t[0]] - s.middle, b = piece.vertices[t[1]] - s.middle,
               c = piece.vertices[t[2]] - s.middle;
    const double A = triangle_area(a, b, c);
    const Vec3 sum = a + b + c;
    area += A;
    second += A / 12.0 *
              (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (!(area > 0.0)) return s;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / area);
  for (int k = 0; k < 3; ++k) {
    s.axes.col(k) = solver.eigenvectors().col(2 - k);
    s.size[k] = std::sqrt(std::max(0.0, solver.eigenvalues()[2 - k]));
  }
  return s;
}

Vec3 extents_of(const TriangleMesh& piece, const Eigen::Matrix3d& axes) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : piece.vertices) {
    const Vec3 q = axes.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  return piece.vertices.empty() ? Vec3(Vec3::Zero()) : Vec3(high - low);
}

// Principal directions that a piece of surface faces, most area first, with their shares.
Spread facing_of(const TriangleMesh& piece) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double area = 0.0;
  for (const Triangle& t : piece.triangles) {
    const Vec3 n = (piece.vertices[t[1]] - piece.vertices[t[0]])
                       .cross(piece.vertices[t[2]] - piece.vertices[t[0]]);
    const double length = n.norm();
    if (length > 0.0) sum += n * n.transpose() / length;
    area += length;
  }
  Spread s;
  if (!(area > 0.0)) return s;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum / area);
  for (int k = 0; k < 3; ++k) {
    s.axes.col(k) = solver.eigenvectors().col(2 - k);
    s.size[k] = std::sqrt(std::max(1e-12, solver.eigenvalues()[2 - k]));
  }
  return s;
}

// The direction that is unlike the other two, and how much so: of something round, its axis.
std::pair<Vec3, double> odd_axis(const Spread& s) {
  const double first = std::log(s.size[0] / s.size[1]), last = std::log(s.size[1] / s.size[2]);
  return first > last ? std::pair(Vec3(s.axes.col(0)), first - last)
                      : std::pair(Vec3(s.axes.col(2)), last - first);
}

double roundness_of(const TriangleMesh& piece, const Spread& spread) {
  double farthest = 0.0;
  for (const Vec3& p : piece.vertices) farthest = std::max(farthest, (p - spread.middle).norm());
  return spread.size.norm() > 0.0 ? farthest / spread.size.norm() : 2.0;
}

// Which way along the part runs: from its free end, else towards the middle of the product, else
// towards its thicker half. True if it has to be turned round.
bool runs_backwards(const ProductPart& part, const std::vector<Vec3>& line, const Vec3& middle) {
  if (part.is_ring) return false;
  const bool is_free0 = !part.ends[0].joined, is_free1 = !part.ends[1].joined;
  if (is_free0 != is_free1) return is_free1;
  const Vec3 across = line.back() - line.front();
  const double aside = across.dot(middle - 0.5 * (line.front() + line.back())) /
                       std::max(1e-9, across.squaredNorm());
  if (std::abs(aside) > kAside) return aside < 0.0;
  double moment = 0.0, sum = 0.0;
  for (const PartSection& s : part.sections) {
    moment += s.girth * (s.along - 0.5);
    sum += s.girth;
  }
  return moment < -1e-3 * sum;
}

// Stations of a line with frames that turn as little as they can from the middle one on (Wang et
// al. 2008, double reflection); `zero` is what turn 0 points to at the middle.
std::vector<PartStation> stations_of(const std::vector<Vec3>& line, bool is_ring,
                                     const Vec3& zero) {
  const int n = static_cast<int>(line.size());
  const int count = is_ring ? n + 1 : n;
  std::vector<PartStation> stations(count);
  for (int i = 0; i < count; ++i) {
    PartStation& s = stations[i];
    s.along = static_cast<double>(i) / (count - 1);
    s.centre = line[i % n];
    const int a = is_ring ? (i + n - 1) % n : std::max(0, i - 1);
    const int b = is_ring ? (i + 1) % n : std::min(n - 1, i + 1);
    s.axis = (line[b] - line[a]).normalized();
  }
  const auto across = [](const Vec3& v, const Vec3& axis) {
    const Vec3 out = v - axis * axis.dot(v);
    return out.norm() > 1e-9 ? Vec3(out.normalized()) : Vec3(axis.unitOrthogonal());
  };
  const int middle = is_ring ? 0 : count / 2;
  stations[middle].zero = across(zero, stations[middle].axis);
  const auto carry = [&](int from, int to) {
    const PartStation& a = stations[from];
    PartStation& b = stations[to];
    const Vec3 v = b.centre - a.centre;
    const double c = v.squaredNorm();
    if (c == 0.0) {
      b.zero = across(a.zero, b.axis);
      return;
    }
    const Vec3 r = a.zero - 2.0 / c * v.dot(a.zero) * v;
    const Vec3 t = a.axis - 2.0 / c * v.dot(a.axis) * v;
    const Vec3 w = b.axis - t;
    const double d = w.squaredNorm();
    b.zero = across(d > 1e-18 ? Vec3(r - 2.0 / d * w.dot(r) * w) : r, b.axis);
  };
  for (int i = middle; i + 1 < count; ++i) carry(i, i + 1);
  for (int i = middle; i > 0; --i) carry(i, i - 1);
  return stations;
}

// What turn 0 points to.
Vec3 zero_of(const ProductPart& part, const std::vector<Vec3>& line, const Vec3& middle) {
  const std::size_t at = part.is_ring ? 0 : line.size() / 2;
  const Vec3 axis =
      (line[(at + 1) % line.size()] - line[(at + line.size() - 1) % line.size()]).normalized();
  const auto across = [&](const Vec3& v) { return Vec3(v - axis * axis.dot(v)); };
  if (part.opening) return across(part.opening->centre - line[at]);
  const Vec3 aside = across(middle - line[at]);
  if (aside.norm() > kAside * part.diameter()) return aside;
  const PartSection& section = part.sections[part.sections.size() / 2];
  return across(section.wide);
}

// Stations of a body where the girth is least between larger ones, and its neck.
std::vector<PartWaist> waists_of(const std::vector<PartSection>& sections) {
  constexpr double kLess = 0.96;  // of the girth on both sides: 4 % is 3 mm of a bottle's diameter
  constexpr double kNeck = 0.6;   // of the largest girth
  std::vector<PartWaist> waists;
  const int n = static_cast<int>(sections.size());
  double largest = 0.0;
  for (const PartSection& s : sections) largest = std::max(largest, s.girth);
  for (int i = 1; i + 1 < n; ++i) {
    const double g = sections[i].girth;
    double before = 0.0, after = 0.0;
    bool is_least = true;
    // The highest on either side before it gets lower than here.
    for (int k = i - 1; k >= 0 && sections[k].girth >= g; --k) {
      before = std::max(before, sections[k].girth);
    }
    for (int k = i + 1; k < n && sections[k].girth > g; ++k) {
      after = std::max(after, sections[k].girth);
    }
    is_least = g <= kLess * before && g <= kLess * after;
    if (!is_least) continue;
    // Between the stations: top of the parabola through three of them.
    const double a = sections[i - 1].girth, c = sections[i + 1].girth;
    const double bend = a - 2.0 * g + c;
    const double shift = bend > 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
    PartWaist w;
    w.along = sections[i].along + shift / n;
    w.girth = g - 0.25 * (a - c) * shift;
    w.is_neck = g < kNeck * largest;
    waists.push_back(w);
  }
  // A neck that doesn't widen again: the thin rest at an end, if a finger goes round it.
  for (const bool is_last : {false, true}) {
    int run = 0;
    while (run < n && sections[is_last ? n - 1 - run : run].girth < kNeck * largest) ++run;
    if (run < 3 || run >= n) continue;
    const int first = is_last ? n - run : 0;
    bool is_known = false;
    for (const PartWaist& w : waists) {
      is_known = is_known ||
                 (w.along >= sections[first].along && w.along <= sections[first + run - 1].along);
    }
    if (is_known) continue;
    const int middle = first + run / 2;
    waists.push_back({sections[middle].along, sections[middle].girth, true});
  }
  std::sort(waists.begin(), waists.end(),
            [](const PartWaist& a, const PartWaist& b) { return a.along < b.along; });
  return waists;
}

// A part along its own centre line, if it has one that is measured well.
bool measure_as_bar(const TriangleMesh& mesh, const TriangleMesh& piece, const SolidGrid& grid,
                    const std::vector<SolidBall>& balls, const RoughPart& rough, int id, double gap,
                    ProductPart& part, std::vector<Vec3>& line) {
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

// The axis of a long body is its longest; of one as long as wide the one that it is round about:
// it shows in where the surface lies or in where it faces.
Vec3 body_axis(const Spread& spread, const Spread& facing) {
  constexpr double kLong = 1.4;  // ratio of spreads
  if (spread.size[0] > kLong * spread.size[1]) return spread.axes.col(0);
  const auto [by_place, place] = odd_axis(spread);
  const auto [by_normal, normal] = odd_axis(facing);
  return place >= normal ? by_place : by_normal;
}

void measure_as_body(const TriangleMesh& piece, const Spread& spread, const Spread& facing,
                     bool is_plate, ProductPart& part, std::vector<Vec3>& line) {
  Vec3 axis = body_axis(spread, facing);
  if (is_plate) {
    const Vec3 n = facing.axes.col(0);
    axis = spread.axes.col(0);
    axis = (axis - n * n.dot(axis)).normalized();
  }
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
  const TriangleMesh& mesh = product.mesh;
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
  const RoughParts rough = rough_parts(grid, graph, girth_at);
  std::vector<int> label = labels_of(mesh, grid, rough);
  const MeshTopology topology = build_topology(mesh);
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
    const TriangleMesh piece = piece_of(mesh, label, id);
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
    const TriangleMesh piece = piece_of(mesh, label, id);
    if (piece.triangles.empty()) continue;
    Found f;
    f.part = std::move(bars[id]);
    f.rough = id;
    ProductPart& part = f.part;
    part.volume = rough.parts[id].volume;
    part.area = surface_area(piece);
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
  const TopologyReport report = examine_topology(mesh, topology);
  if (report.is_closed && report.is_two_manifold) {
    int loops = 0;
    for (const ProductPart& part : result.parts) loops += part.kind == PartKind::kLoop ? 1 : 0;
    result.narrow_tunnels = std::max(0, report.components - report.euler_number / 2 - loops);
  }
  return result;
}

int ProductParts::nearest(const Product& product, const Vec3& point) const {
  if (parts.empty()) throw UsageError("product \"" + product.name + "\" has no parts");
  const DistanceSample sample = product.distance->at(point);
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

}  // namespace palmar
