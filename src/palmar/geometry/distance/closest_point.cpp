// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/closest_point.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "palmar/geometry/mesh/triangle_partition.h"

// Vectors of eight are passed between inlined functions only.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace palmar::geometry {
namespace {

/// A triangle with what the test needs, side by side in memory.
struct Face {
  Vec3 a, b, c;
  Vec3 normal;  ///< unit; zero for a degenerate triangle
};

/// Unit normal, or zero if the triangle has no area worth dividing by.
Vec3 face_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const Vec3 n = ab.cross(ac);
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
  const double length = n.norm();
  // Height below 1e-10 of the longest edge: the direction of n is rounding.
  return length > 1e-10 * longest ? Vec3(n / length) : Vec3::Zero();
}

struct SegmentPoint {
  double share = 0.0;  ///< 0 at the start, 1 at the end
  double squared_distance = 0.0;
};

SegmentPoint closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const Vec3 ap = p - a;
  const double along = ap.dot(ab);
  const double length2 = ab.squaredNorm();
  if (along <= 0.0 || length2 == 0.0) return {0.0, ap.squaredNorm()};
  if (along >= length2) return {1.0, (p - b).squaredNorm()};
  const double share = along / length2;
  return {share, (ap - share * ab).squaredNorm()};
}

TrianglePoint closest_on_face(const Vec3& p, const Face& f) {
  const Vec3 pa = f.a - p, pb = f.b - p, pc = f.c - p;
  // Twice the signed areas that p, seen along the normal, spans with the edges.
  const double wa = f.normal.dot(pb.cross(pc));
  const double wb = f.normal.dot(pc.cross(pa));
  const double wc = f.normal.dot(pa.cross(pb));
  TrianglePoint result;
  const double sum = wa + wb + wc;
  if (wa > 0.0 && wb > 0.0 && wc > 0.0) {
    const double height = -f.normal.dot(pa);
    result.weights = {wa / sum, wb / sum, wc / sum};
    result.point = p - height * f.normal;
    result.squared_distance = height * height;
    return result;
  }
  const SegmentPoint ab = closest_on_segment(p, f.a, f.b);
  const SegmentPoint bc = closest_on_segment(p, f.b, f.c);
  const SegmentPoint ca = closest_on_segment(p, f.c, f.a);
  if (ab.squared_distance <= bc.squared_distance && ab.squared_distance <= ca.squared_distance) {
    result.weights = {1.0 - ab.share, ab.share, 0.0};
    result.squared_distance = ab.squared_distance;
  } else if (bc.squared_distance <= ca.squared_distance) {
    result.weights = {0.0, 1.0 - bc.share, bc.share};
    result.squared_distance = bc.squared_distance;
  } else {
    result.weights = {ca.share, 0.0, 1.0 - ca.share};
    result.squared_distance = ca.squared_distance;
  }
  result.point = result.weights[0] * f.a + result.weights[1] * f.b + result.weights[2] * f.c;
  return result;
}

constexpr int kSideBySide = 8;
// Up to this size the box of a group is fitted to its corners, above to the boxes of its parts.
constexpr int kFittedSize = 64;

/// Eight numbers side by side. The compiler makes one AVX register of them where a function allows
/// that and two SSE registers elsewhere; the results are the same to the bit.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int __attribute__((vector_size(32)));
using Point8 = std::array<Float8, 3>;

[[gnu::always_inline]] inline Float8 larger(const Float8& a, const Float8& b) {
  return a > b ? a : b;
}
[[gnu::always_inline]] inline Float8 smaller(const Float8& a, const Float8& b) {
  return a < b ? a : b;
}
[[gnu::always_inline]] inline Float8 magnitude(const Float8& a) {
  // Casts between vectors of one size keep the bits (std::bit_cast trips UBSan of GCC 12 here).
  return Float8(Int8(a) & 0x7FFFFFFF);
}
[[gnu::always_inline]] inline Float8 within_01(const Float8& a) {
  return smaller(larger(a, Float8{}), Float8{} + 1.0f);
}
[[gnu::always_inline]] inline float smallest(const Float8& a) {
  const Float8 b = smaller(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3));
  const Float8 c = smaller(b, __builtin_shufflevector(b, b, 2, 3, 0, 1, 6, 7, 4, 5));
  return std::min(c[0], c[1]);
}
[[gnu::always_inline]] inline Float8 dot(const Point8& a, const Point8& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// p - s a
[[gnu::always_inline]] inline Point8 rest(const Point8& p, const Float8& s, const Point8& a) {
  return {p[0] - s * a[0], p[1] - s * a[1], p[2] - s * a[2]};
}

/// Boxes, each turned along its own triangles, of eight groups side by side. A group on a smooth
/// surface gets a flat box, so that few groups near the foot of the point must be opened; upright
/// boxes would be as thick as the group is wide.
struct alignas(64) BoxNode {
  Point8 centre;                       ///< mm
  std::array<Point8, 3> axis;          ///< axis[i][k]: component k of unit axis i
  Point8 half;                         ///< half length along axis i, mm
  std::array<int, kSideBySide> child;  ///< node if >= 0, else leaf -1 - child
};

/// Squared distances of a point to the nearest and to the farthest point of eight boxes, mm^2.
struct BoxDistances {
  Float8 nearest = {};
  Float8 farthest = {};
};

[[gnu::always_inline]] inline BoxDistances box_distances(const BoxNode& node,
                                                         const Eigen::Vector3f& p) {
  const Point8 x = {p.x() - node.centre[0], p.y() - node.centre[1], p.z() - node.centre[2]};
  BoxDistances d;
  for (int i = 0; i < 3; ++i) {
    const Float8 along = magnitude(dot(node.axis[i], x));
    const Float8 beyond = larger(along - node.half[i], Float8{});
    const Float8 across = along + node.half[i];
    d.nearest += beyond * beyond;
    d.farthest += across * across;
  }
  return d;
}

/// Up to eight triangles a, a + u, a + v side by side in float, to find out which of them deserve
/// the test in double.
struct alignas(64) TriangleLeaf {
  Point8 a, u, v;                             ///< mm
  Float8 inverse_uu, inverse_vv, inverse_ww;  ///< 1 / squared length of u, v and w = v - u; 0 if 0
  Float8 vv, uv, uu;                          ///< dot products / (uu vv - uv^2)
  Float8 trust;                               ///< 0 for needles, which float can't judge, else 1
  int first = 0;                              ///< face of the first triangle
  int count = 0;
  bool is_trusted = true;  ///< no needles
};

/// Squared distances of a point to eight triangles, mm^2; 0 for needles.
[[gnu::always_inline]] inline Float8 triangle_distances(const TriangleLeaf& f,
                                                        const Eigen::Vector3f& q) {
  const Point8 p = {q.x() - f.a[0], q.y() - f.a[1], q.z() - f.a[2]};
  const Point8 w = {f.v[0] - f.u[0], f.v[1] - f.u[1], f.v[2] - f.u[2]};
  const Point8 pu = {p[0] - f.u[0], p[1] - f.u[1], p[2] - f.u[2]};
  const Float8 along_u = dot(p, f.u), along_v = dot(p, f.v);
  const Point8 ru = rest(p, within_01(along_u * f.inverse_uu), f.u);
  const Point8 rv = rest(p, within_01(along_v * f.inverse_vv), f.v);
  const Point8 rw = rest(pu, within_01(dot(pu, w) * f.inverse_ww), w);
  const Float8 edges = smaller(smaller(dot(ru, ru), dot(rv, rv)), dot(rw, rw));
  const Float8 s = f.vv * along_u - f.uv * along_v;
  const Float8 t = f.uu * along_v - f.uv * along_u;
  const Point8 rf = rest(rest(p, s, f.u), t, f.v);
  const Int8 is_over_face = (s >= 0.0f) & (t >= 0.0f) & (s + t <= 1.0f);
  return f.trust * (is_over_face ? dot(rf, rf) : edges);
}

/// What the box of a group is fitted to.
struct Spread {
  Vec3 normal = Vec3::Zero();  ///< sum of area times normal
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  double count = 0.0;

  void add(const Spread& other) {
    normal += other.normal;
    sum += other.sum;
    square += other.square;
    count += other.count;
  }
};

Spread spread_of(const Face& f) {
  Spread s;
  s.normal = (f.b - f.a).cross(f.c - f.a);
  for (const Vec3& x : {f.a, f.b, f.c}) {
    s.sum += x;
    s.square += x * x.transpose();
  }
  s.count = 3.0;
  return s;
}

/// Frame whose rows are: the longest direction in the plane of the group, the other one, its
/// normal.
Eigen::Matrix3f frame_of(const Spread& s) {
  const Vec3 n = s.normal.squaredNorm() > 0.0 ? s.normal.stableNormalized() : Vec3::UnitZ();
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  const Vec3 mean = s.sum / s.count;
  const Eigen::Matrix3d covariance = s.square / s.count - mean * mean.transpose();
  const double uu = u.dot(covariance * u), vv = v.dot(covariance * v), uv = u.dot(covariance * v);
  const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv);
  Eigen::Matrix3f frame;
  frame.row(0) = (std::cos(angle) * u + std::sin(angle) * v).cast<float>();
  frame.row(1) = (std::cos(angle) * v - std::sin(angle) * u).cast<float>();
  frame.row(2) = n.cast<float>();
  return frame;
}

/// State of one search.
struct Search {
  Vec3 point;
  double best2;  ///< squared distance, mm^2
  int triangle = -1;
  TrianglePoint nearest = {};
  double margin = 0.0;  ///< mm; bound of the rounding of a distance in float
  float slack2 = 0.0f;  ///< 5001 margin^2, mm^2
  /// Squared distance from which a box or triangle is skipped, mm^2.
  /// Finite, so that empty boxes, infinitely far, are always skipped.
  float limit2 = std::numeric_limits<float>::max();

  /// Boxes are in float: look a little beyond the best distance, so that no nearer and no equally
  /// near triangle is lost.
  void set_limit() {
    const double limit = std::sqrt(best2) * (1.0 + 1e-6) + margin;
    limit2 = std::min(limit2, static_cast<float>(limit * limit));
  }
  /// There is a triangle not farther than this [mm^2, in float]. (d + m)^2 is at most
  /// 1.0002 d^2 + 5001 m^2: cheaper than a root.
  void lower_limit(float squared_distance) {
    limit2 = std::min(limit2, 1.0002f * squared_distance + slack2);
  }

  void test(const Face& face, int index) {
    const double height = face.normal.dot(point - face.a);
    if (height * height > best2 * (1.0 + 1e-9)) return;
    const TrianglePoint found = closest_on_face(point, face);
    const bool is_nearer = found.squared_distance < best2;
    if (!is_nearer && !(found.squared_distance == best2 && (triangle < 0 || index < triangle))) {
      return;
    }
    best2 = found.squared_distance;
    nearest = found;
    triangle = index;
    set_limit();
  }
};

}  // namespace

TrianglePoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                        const Vec3& c) {
  return closest_on_face(point, {a, b, c, face_normal(a, b, c)});
}

struct ClosestPointQuery::Impl {
  Vec3 origin = Vec3::Zero();  ///< middle of the mesh; everything below is relative to it
  double reach = 0.0;          ///< largest coordinate relative to it, mm
  std::vector<Face> faces;     ///< in the order of the tree
  std::vector<int> triangle;   ///< of each face
  std::vector<int> face;       ///< of each triangle
  std::vector<BoxNode> nodes;
  std::vector<TriangleLeaf> leaves;

  explicit Impl(const TriangleMesh& mesh);
  void walk(Search& search) const;
  void walk_plainly(Search& search) const;
#if defined(__x86_64__)
  __attribute__((target("avx2"))) void walk_avx2(Search& search) const;
#endif
  [[gnu::always_inline]] inline void walk_inline(Search& search) const;
  void fit(BoxNode& node, int k, const Spread& spread, std::span<const Vec3> corners) const;
  int add_leaf(int begin, int end);
  void fit_nodes(const WideTrianglePartition<kSideBySide>& partition);
  /// Asks the processor to load what the search needs next; most of its time is waiting for memory.
  void prefetch(int child) const {
    const char* start = child >= 0 ? reinterpret_cast<const char*>(&nodes[child])
                                   : reinterpret_cast<const char*>(&leaves[-1 - child]);
    for (int line = 0; line < 4; ++line) __builtin_prefetch(start + 64 * line);
  }
  std::array<Vec3, 8> box_corners(const BoxNode& node, int k) const;
};

ClosestPointQuery::Impl::Impl(const TriangleMesh& mesh) {
  check_finite_and_indexed(mesh);
  Box3 box;
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[v]);
  }
  if (box.isEmpty()) return;
  origin = box.center();
  reach = 0.5 * box.sizes().maxCoeff();

  const WideTrianglePartition<kSideBySide> partition =
      partition_triangles<kSideBySide>(mesh, kSideBySide);
  faces.reserve(mesh.triangles.size());
  face.resize(mesh.triangles.size());
  triangle = partition.order;
  for (const int t : partition.order) {
    const Triangle& corners = mesh.triangles[t];
    const Vec3 a = mesh.vertices[corners[0]] - origin, b = mesh.vertices[corners[1]] - origin,
               c = mesh.vertices[corners[2]] - origin;
    face[t] = static_cast<int>(faces.size());
    faces.push_back({a, b, c, face_normal(a, b, c)});
  }
  fit_nodes(partition);
}

/// Smallest box in the frame of the group, rounded outwards, that holds the corners.
void ClosestPointQuery::Impl::fit(BoxNode& node, int k, const Spread& spread,
                                  std::span<const Vec3> corners) const {
  const Eigen::Matrix3f frame = frame_of(spread);
  const Eigen::Matrix3d exact = frame.cast<double>();
  Box3 box;
  for (const Vec3& x : corners) box.extend(exact * x);
  const Eigen::Vector3f centre = (exact.transpose() * box.center()).cast<float>();
  const Vec3 middle = exact * centre.cast<double>();
  for (int i = 0; i < 3; ++i) {
    node.centre[i][k] = centre[i];
    for (int j = 0; j < 3; ++j) node.axis[i][j][k] = frame(i, j);
    const double half = std::max(box.max()[i] - middle[i], middle[i] - box.min()[i]);
    node.half[i][k] = static_cast<float>(half * (1.0 + 1e-6));
  }
}

std::array<Vec3, 8> ClosestPointQuery::Impl::box_corners(const BoxNode& node, int k) const {
  std::array<Vec3, 8> corners;
  for (int c = 0; c < 8; ++c) {
    for (int j = 0; j < 3; ++j) {
      double x = node.centre[j][k];
      for (int i = 0; i < 3; ++i) {
        const double half = node.half[i][k];
        x += ((c >> i) & 1 ? half : -half) * static_cast<double>(node.axis[i][j][k]);
      }
      corners[c][j] = x;
    }
  }
  return corners;
}

int ClosestPointQuery::Impl::add_leaf(int begin, int end) {
  TriangleLeaf leaf;
  leaf.first = begin;
  leaf.count = end - begin;
  for (int k = 0; k < kSideBySide; ++k) {
    const Face& f = faces[std::min(begin + k, end - 1)];  // the last one fills what is left
    const Vec3 u = f.b - f.a, v = f.c - f.a, w = f.c - f.b;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = w.squaredNorm(), uv = u.dot(v);
    const double determinant = u.cross(v).squaredNorm();
    const double longest = std::max({uu, vv, ww});
    // Height below a hundredth of the longest side.
    const bool is_needle = !(determinant > 1e-4 * longest * longest);
    const auto inverse = [](double x) { return static_cast<float>(x > 1e-30 ? 1.0 / x : 0.0); };
    for (int i = 0; i < 3; ++i) {
      leaf.a[i][k] = static_cast<float>(f.a[i]);
      leaf.u[i][k] = static_cast<float>(u[i]);
      leaf.v[i][k] = static_cast<float>(v[i]);
    }
    leaf.inverse_uu[k] = inverse(uu);
    leaf.inverse_vv[k] = inverse(vv);
    leaf.inverse_ww[k] = inverse(ww);
    leaf.uu[k] = is_needle ? 0.0f : static_cast<float>(uu / determinant);
    leaf.vv[k] = is_needle ? 0.0f : static_cast<float>(vv / determinant);
    leaf.uv[k] = is_needle ? 0.0f : static_cast<float>(uv / determinant);
    leaf.trust[k] = is_needle ? 0.0f : 1.0f;
    leaf.is_trusted = leaf.is_trusted && !is_needle;
  }
  leaves.push_back(leaf);
  return static_cast<int>(leaves.size()) - 1;
}

void ClosestPointQuery::Impl::fit_nodes(const WideTrianglePartition<kSideBySide>& partition) {
  nodes.resize(partition.nodes.size());
  std::vector<std::array<Spread, kSideBySide>> spreads(partition.nodes.size());
  std::vector<Vec3> corners;
  // Children stand behind their parents: from the back, parts are ready before the whole.
  for (int n = static_cast<int>(nodes.size()) - 1; n >= 0; --n) {
    const WideTrianglePartition<kSideBySide>::Node& parts = partition.nodes[n];
    for (int k = 0; k < kSideBySide; ++k) {
      BoxNode& node = nodes[n];
      if (parts.size(k) == 0) {
        // Farther than any limit from everywhere.
        for (int i = 0; i < 3; ++i) {
          node.centre[i][k] = std::numeric_limits<float>::max();
          for (int j = 0; j < 3; ++j) node.axis[i][j][k] = i == j ? 1.0f : 0.0f;
          node.half[i][k] = 0.0f;
        }
        node.child[k] = -1;
        continue;
      }
      const int child = parts.child[k];
      Spread& spread = spreads[n][k];
      corners.clear();
      if (child < 0) {
        for (int f = parts.begin[k]; f < parts.end[k]; ++f) spread.add(spread_of(faces[f]));
      } else {
        for (const Spread& part : spreads[child]) spread.add(part);
      }
      if (parts.size(k) <= kFittedSize) {
        for (int f = parts.begin[k]; f < parts.end[k]; ++f) {
          corners.insert(corners.end(), {faces[f].a, faces[f].b, faces[f].c});
        }
      } else {
        for (int part = 0; part < kSideBySide; ++part) {
          const std::array<Vec3, 8> box = box_corners(nodes[child], part);
          corners.insert(corners.end(), box.begin(), box.end());
        }
      }
      fit(node, k, spread, corners);
      node.child[k] = child >= 0 ? child : -1 - add_leaf(parts.begin[k], parts.end[k]);
    }
  }
}

ClosestPointQuery::ClosestPointQuery(const TriangleMesh& mesh)
    : impl_(std::make_unique<const Impl>(mesh)) {}
ClosestPointQuery::~ClosestPointQuery() = default;
ClosestPointQuery::ClosestPointQuery(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery& ClosestPointQuery::operator=(ClosestPointQuery&&) noexcept = default;

void ClosestPointQuery::Impl::walk_inline(Search& search) const {
  struct Entry {
    float squared_distance;
    int child;
  };
  // Each level leaves at most seven siblings; depth is log8 of an int.
  std::array<Entry, 7 * 11 + kSideBySide> stack;
  int size = 0;
  stack[size++] = {0.0f, 0};
  // Triangles that may be the nearest; tested in double when no box is left.
  std::array<Entry, 7 * 11 + kSideBySide> candidates;
  int candidate_count = 0;
  const auto test_candidates = [&] {
    for (int i = 0; i < candidate_count; ++i) {
      if (candidates[i].squared_distance > search.limit2) continue;
      const int f = candidates[i].child;
      search.test(faces[f], triangle[f]);
    }
    candidate_count = 0;
  };
  const Eigen::Vector3f p = search.point.cast<float>();
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared_distance > search.limit2) continue;
    if (entry.child < 0) {
      const TriangleLeaf& leaf = leaves[-1 - entry.child];
      const Float8 distance2 = triangle_distances(leaf, p);
      if (leaf.is_trusted) search.lower_limit(smallest(distance2));
      if (candidate_count + kSideBySide > static_cast<int>(candidates.size())) test_candidates();
      for (int k = 0; k < kSideBySide; ++k) {
        candidates[candidate_count] = {distance2[k], leaf.first + k};
        candidate_count += ((distance2[k] <= search.limit2) & (k < leaf.count)) ? 1 : 0;
      }
      continue;
    }
    const BoxNode& node = nodes[entry.child];
    const BoxDistances distances = box_distances(node, p);
    search.lower_limit(smallest(distances.farthest));
    // Without branches, as which boxes are near enough can't be predicted. Only the nearest is sure
    // to be the next; it goes on top.
    const int start = size;
    for (int k = 0; k < kSideBySide; ++k) {
      stack[size] = {distances.nearest[k], node.child[k]};
      size += distances.nearest[k] <= search.limit2 ? 1 : 0;
    }
    if (size == start) continue;
    int nearest = size - 1;
    for (int i = start; i < size - 1; ++i) {
      nearest = stack[i].squared_distance < stack[nearest].squared_distance ? i : nearest;
    }
    std::swap(stack[nearest], stack[size - 1]);
    prefetch(stack[size - 1].child);
  }
  test_candidates();
}

void ClosestPointQuery::Impl::walk_plainly(Search& search) const { walk_inline(search); }

#if defined(__x86_64__)
void ClosestPointQuery::Impl::walk_avx2(Search& search) const { walk_inline(search); }

void ClosestPointQuery::Impl::walk(Search& search) const {
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  has_avx2 ? walk_avx2(search) : walk_plainly(search);
}
#else
void ClosestPointQuery::Impl::walk(Search& search) const { walk_plainly(search); }
#endif

std::optional<ClosestPoint> ClosestPointQuery::closest(const Vec3& point, double range,
                                                       std::optional<int> hint) const {
  const Impl& m = *impl_;
  if (m.faces.empty() || !point.allFinite()) return {};
  Search search{
      point - m.origin, range * range, -1, {}, 0.0, 0.0f, std::numeric_limits<float>::infinity()};
  // A distance in float is a sum of some ten products of coordinates of this size.
  search.margin =
      8.0 * std::numeric_limits<float>::epsilon() * (m.reach + search.point.cwiseAbs().maxCoeff());
  search.slack2 = static_cast<float>(5001.0 * search.margin * search.margin);
  search.set_limit();
  if (hint) search.test(m.faces[m.face[*hint]], *hint);

  m.walk(search);

  if (search.triangle < 0) return {};
  return ClosestPoint{search.triangle, search.nearest.point + m.origin, search.nearest.weights,
                      std::sqrt(search.best2)};
}

}  // namespace palmar::geometry
