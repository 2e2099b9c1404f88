// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/closest_point.h"

#include <cmath>
#include <vector>

#include "palmar/geometry/embree_mesh.h"

namespace palmar {
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

/// State of one search; Embree hands it back to the callback.
struct Search {
  const std::vector<Face>* faces;
  Vec3 point;
  double best2;  ///< squared distance, mm^2
  int triangle = -1;
  TrianglePoint nearest;
  double margin;  ///< mm; see radius()

  /// Embree culls in float: a little more than the best distance, so that no nearer and no equally
  /// near triangle is lost.
  float radius() const { return static_cast<float>(std::sqrt(best2) * (1.0 + 1e-6) + margin); }

  bool test(int index) {
    const Face& face = (*faces)[index];
    const double height = face.normal.dot(point - face.a);
    if (height * height > best2 * (1.0 + 1e-9)) return false;
    const TrianglePoint found = closest_on_face(point, face);
    const bool is_nearer = found.squared_distance < best2;
    if (!is_nearer && !(found.squared_distance == best2 && (triangle < 0 || index < triangle))) {
      return false;
    }
    best2 = found.squared_distance;
    nearest = found;
    triangle = index;
    return is_nearer;
  }
};

bool test_primitive(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  if (!search.test(static_cast<int>(arguments->primID))) return false;
  arguments->query->radius = search.radius();
  return true;
}

}  // namespace

TrianglePoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                        const Vec3& c) {
  return closest_on_face(point, {a, b, c, face_normal(a, b, c)});
}

struct ClosestPointQuery::Impl {
  EmbreeMesh scene;
  std::vector<Face> faces;
  explicit Impl(const TriangleMesh& mesh) : scene(mesh) {
    faces.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      faces.push_back({a, b, c, face_normal(a, b, c)});
    }
  }
};

ClosestPointQuery::ClosestPointQuery(const TriangleMesh& mesh)
    : impl_(std::make_unique<const Impl>(mesh)) {}
ClosestPointQuery::~ClosestPointQuery() = default;
ClosestPointQuery::ClosestPointQuery(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery& ClosestPointQuery::operator=(ClosestPointQuery&&) noexcept = default;

std::optional<ClosestPoint> ClosestPointQuery::closest(const Vec3& point, double range,
                                                       std::optional<int> hint) const {
  if (impl_->faces.empty() || !point.allFinite()) return {};
  Search search{&impl_->faces, point, range * range, -1, {}, 0.0};
  const Vec3 shifted = point - impl_->scene.origin();
  search.margin = 4.0 * (impl_->scene.float_error() +
                         shifted.cwiseAbs().maxCoeff() * std::numeric_limits<float>::epsilon());
  if (hint) search.test(*hint);

  RTCPointQuery query;
  query.x = static_cast<float>(shifted.x());
  query.y = static_cast<float>(shifted.y());
  query.z = static_cast<float>(shifted.z());
  query.time = 0.0f;
  query.radius = search.radius();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene.scene(), &query, &context, test_primitive, &search);

  if (search.triangle < 0) return {};
  return ClosestPoint{search.triangle, search.nearest.point, search.nearest.weights,
                      std::sqrt(search.best2)};
}

}  // namespace palmar
