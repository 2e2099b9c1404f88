// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/mesh_measures.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

const Vec3& point(std::span<const Vec3> vertices, int i) { return vertices[i]; }

// atan2 stays accurate for needle-like triangles, where acos of the dot product does not.
double angle_between(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double angle_at(std::span<const Vec3> vertices, const Triangle& t, size_t k) {
  const Vec3& p = point(vertices, t[k]);
  return angle_between(point(vertices, t[(k + 1) % 3]) - p, point(vertices, t[(k + 2) % 3]) - p);
}

Vec3 area_vector(std::span<const Vec3> vertices, const Triangle& t) {
  const Vec3& a = point(vertices, t[0]);
  return 0.5 * (point(vertices, t[1]) - a).cross(point(vertices, t[2]) - a);
}

Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

}  // namespace

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) sum += area_vector(mesh.vertices, t).norm();
  return sum;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // Taken about the mean vertex: far from the origin the terms would cancel badly.
  Vec3 centre = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) centre += v;
  centre /= static_cast<double>(mesh.vertices.size());
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = point(mesh.vertices, t[0]) - centre;
    const Vec3 b = point(mesh.vertices, t[1]) - centre;
    const Vec3 c = point(mesh.vertices, t[2]) - centre;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

Vec3 centre_of_volume(const TriangleMesh& mesh) {
  constexpr double kNone = 1e-6;  // of area^1.5; a cube has 0.07
  if (mesh.vertices.empty()) return Vec3::Zero();
  Vec3 about = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) about += v;
  about /= static_cast<double>(mesh.vertices.size());
  double volume = 0.0, area = 0.0;
  Vec3 volume_moment = Vec3::Zero(), area_moment = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = point(mesh.vertices, t[0]) - about;
    const Vec3 b = point(mesh.vertices, t[1]) - about;
    const Vec3 c = point(mesh.vertices, t[2]) - about;
    const double tetrahedron = a.dot(b.cross(c)) / 6.0;
    const double triangle = triangle_area(a, b, c);
    volume += tetrahedron;
    area += triangle;
    volume_moment += tetrahedron / 4.0 * (a + b + c);
    area_moment += triangle / 3.0 * (a + b + c);
  }
  if (volume > kNone * std::pow(area, 1.5)) return about + volume_moment / volume;
  return area > 0.0 ? Vec3(about + area_moment / area) : about;
}

Box3 bounding_box(const TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box;
}

std::vector<Vec3> triangle_normals(std::span<const Vec3> vertices,
                                   std::span<const Triangle> triangles) {
  std::vector<Vec3> normals;
  normals.reserve(triangles.size());
  for (const Triangle& t : triangles) normals.push_back(unit_or_zero(area_vector(vertices, t)));
  return normals;
}

std::vector<Vec3> triangle_normals(const TriangleMesh& mesh) {
  return triangle_normals(mesh.vertices, mesh.triangles);
}

std::vector<Vec3> vertex_normals(std::span<const Vec3> vertices,
                                 std::span<const Triangle> triangles) {
  std::vector<Vec3> normals(vertices.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 normal = unit_or_zero(area_vector(vertices, t));
    for (size_t k = 0; k < 3; ++k) {
      normals[t[k]] += angle_at(vertices, t, k) * normal;
    }
  }
  for (Vec3& n : normals) n = unit_or_zero(n);
  return normals;
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  return vertex_normals(mesh.vertices, mesh.triangles);
}

std::vector<Vec3> area_weighted_normals(std::span<const Vec3> vertices,
                                        std::span<const Triangle> triangles) {
  std::vector<Vec3> normals;
  area_weighted_normals(vertices, triangles, normals);
  return normals;
}

void area_weighted_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                           std::vector<Vec3>& normals) {
  normals.assign(vertices.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 n = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
    for (const int corner : t) normals[corner] += n;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    n = length > 0.0 ? Vec3(n / length) : Vec3::UnitZ();
  }
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const Triangle& t : mesh.triangles) {
    const double area = area_vector(mesh.vertices, t).norm();
    if (area <= 0.0) continue;
    std::array<double, 3> squared{}, dot{};  // edge opposite a corner; cosine times its two edges
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& p = point(mesh.vertices, t[k]);
      const Vec3 u = point(mesh.vertices, t[(k + 1) % 3]) - p;
      const Vec3 v = point(mesh.vertices, t[(k + 2) % 3]) - p;
      squared[k] = (u - v).squaredNorm();
      dot[k] = u.dot(v);
    }
    const auto obtuse = std::find_if(dot.begin(), dot.end(), [](double d) { return d < 0.0; });
    for (size_t k = 0; k < 3; ++k) {
      double part = 0.0;
      if (obtuse != dot.end()) {
        part = area * (obtuse - dot.begin() == static_cast<long>(k) ? 0.5 : 0.25);
      } else {
        // Meyer 2003: 1/8 (|PR|^2 cot Q + |PQ|^2 cot R), with cot = dot / (2 area).
        const size_t q = (k + 1) % 3, r = (k + 2) % 3;
        part = (squared[q] * dot[q] + squared[r] * dot[r]) / (16.0 * area);
      }
      areas[t[k]] += part;
    }
  }
  return areas;
}

std::vector<double> smallest_angles(const TriangleMesh& mesh) {
  std::vector<double> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    result.push_back(std::min({angle_at(mesh.vertices, t, 0), angle_at(mesh.vertices, t, 1),
                               angle_at(mesh.vertices, t, 2)}));
  }
  return result;
}

EdgeLengths edge_lengths(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  EdgeLengths result;
  result.count = static_cast<int>(topology.edge.size());
  if (result.count == 0) return result;
  std::vector<double> lengths;
  lengths.reserve(topology.edge.size());
  for (const auto& [a, b] : topology.edge) {
    lengths.push_back((point(mesh.vertices, a) - point(mesh.vertices, b)).norm());
    result.mean += lengths.back();
  }
  result.mean /= result.count;
  const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
  result.shortest = *shortest;
  result.longest = *longest;
  double squares = 0.0;
  for (const double l : lengths) squares += (l - result.mean) * (l - result.mean);
  result.standard_deviation = std::sqrt(squares / result.count);
  return result;
}

}  // namespace palmar::geometry
