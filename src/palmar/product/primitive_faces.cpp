// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/primitive_faces.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace palmar::product {
namespace {

/// A run of segments on the same side.
struct Run {
  int face = 0;
  int start = 0;  ///< its first segment
  int count = 0;
};

std::vector<Run> runs_of(const std::vector<int>& face_of_segment) {
  const auto n = static_cast<int>(face_of_segment.size());
  const auto face_at = [&](int i) { return face_of_segment[(i + n) % n]; };
  int first = 0;
  while (first < n && face_at(first) == face_at(first - 1)) ++first;
  if (first == n) return {{face_at(0), 0, n}};
  std::vector<Run> runs;
  for (int i = first; i < first + n; ++i) {
    if (i == first || face_at(i) != face_at(i - 1)) runs.push_back({face_at(i), i % n, 0});
    ++runs.back().count;
  }
  return runs;
}

class EdgeList {
 public:
  EdgeList(const BarSection& section, const BarRings& rings, ProductFaces& faces)
      : section_(section), half_(0.5 * rings.length), faces_(faces) {}

  /// Along the bar, where the run `after` begins.
  void add_along(const Run& before, const Run& after) {
    const Eigen::Vector2d& p = at(after.start);
    const Eigen::Vector2d in = p - at(after.start - 1);
    const Eigen::Vector2d out = at(after.start + 1) - p;
    const auto is_round = [&](const Run& run) { return radius(run.face) > 0.0; };
    // The flanks of a blend follow it without a kink; its chords alone would show one.
    const bool is_smooth = is_round(before) || is_round(after);
    const double kink = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    ProductEdge edge;
    edge.faces = {before.face, after.face};
    edge.is_smooth = is_smooth;
    edge.is_convex = !is_smooth;
    edge.angle = is_smooth ? 0.0 : kink;
    edge.points = {{p.x(), p.y(), -half_}, {p.x(), p.y(), half_}};
    edge.length = 2.0 * half_;
    add(std::move(edge));
  }

  void add_round_end(const Run& run, int end, double z, double length) {
    ProductEdge edge;
    edge.faces = {run.face, end};
    edge.is_convex = true;
    edge.angle = 0.5 * std::numbers::pi;
    for (int i = 0; i <= run.count; ++i) {
      const Eigen::Vector2d& p = at(run.start + i);
      edge.points.emplace_back(p.x(), p.y(), z);
    }
    edge.length = length;
    add(std::move(edge));
  }

 private:
  const Eigen::Vector2d& at(int i) const {
    const auto n = static_cast<int>(section_.points.size());
    return section_.points[(i + n) % n];
  }
  double radius(int face) const { return faces_.face[face].radius; }
  void add(ProductEdge edge) {
    edge.number = static_cast<int>(faces_.edge.size()) + 1;
    faces_.edge.push_back(std::move(edge));
  }

  const BarSection& section_;
  double half_;
  ProductFaces& faces_;
};

}  // namespace

std::shared_ptr<const ProductFaces> bar_faces(const BarSection& section,
                                              const std::vector<BarSide>& sides,
                                              const BarRings& rings) {
  ProductFaces faces;
  const auto add_face = [&](ProductFace face) {
    face.number = static_cast<int>(faces.face.size()) + 1;
    faces.face.push_back(std::move(face));
    return face.number - 1;
  };
  std::vector<int> face_of_side(sides.size(), -1);
  std::vector<double> width;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    bool is_there = false;
    for (const int side : section.side) is_there = is_there || side == static_cast<int>(s);
    if (!is_there) continue;
    ProductFace face;
    face.name = sides[s].name;
    face.kind = sides[s].radius > 0.0 ? FaceKind::kCylinder : FaceKind::kPlane;
    face.radius = sides[s].radius;
    face.is_fillet = sides[s].is_fillet;
    face.area = sides[s].width * rings.length;
    width.push_back(sides[s].width);
    face_of_side[s] = add_face(std::move(face));
  }
  ProductFace end;
  end.kind = FaceKind::kPlane;
  end.area = rings.end_area;
  end.name = "bottom";
  const int bottom = add_face(end);
  end.name = "top";
  const int top = add_face(end);

  std::vector<int> face_of_segment;
  for (const int side : section.side) {
    face_of_segment.push_back(face_of_side[side]);
  }
  const std::size_t n = section.points.size();
  const auto rows = static_cast<std::size_t>(2 * rings.on_ends - 1);  // a fan has half of a row
  faces.face_of_triangle.assign(rows * n, bottom);
  for (int row = 0; row < rings.along; ++row) {
    for (const int face : face_of_segment)
      faces.face_of_triangle.insert(faces.face_of_triangle.end(), 2, face);
  }
  faces.face_of_triangle.insert(faces.face_of_triangle.end(), rows * n, top);

  const std::vector<Run> runs = runs_of(face_of_segment);
  EdgeList edges(section, rings, faces);
  if (runs.size() > 1) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      edges.add_along(runs[(r + runs.size() - 1) % runs.size()], runs[r]);
    }
  }
  for (const auto& [face, z] : {std::pair(bottom, -0.5), std::pair(top, 0.5)}) {
    for (const Run& run : runs) {
      edges.add_round_end(run, face, z * rings.length, width[run.face]);
    }
  }
  return std::make_shared<const ProductFaces>(std::move(faces));
}

}  // namespace palmar::product
