// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::formats {

/// Splits polygons into triangles: fans where they are convex, ear clipping where not (in the plane
/// of Newell's normal). The effort over all polygons of one file is bounded, so that no file can
/// hold the reader up; polygons beyond it become fans and are counted.
class PolygonSplitter {
 public:
  /// Appends corners.size() - 2 triangles to `triangles`; all indices must be valid. Nothing is
  /// appended for fewer than 3 corners.
  void split(const std::vector<Vec3>& vertices, const std::vector<int>& corners,
             std::vector<Triangle>& triangles);
  /// Concave polygons that had to be split as fans (self-crossing, or effort used up).
  int doubtful_count() const { return doubtful_; }

 private:
  bool clip_ears(const std::vector<Vec3>& vertices, const std::vector<int>& corners,
                 std::vector<Triangle>& triangles);

  std::int64_t effort_left_ = 200'000'000;  ///< corner tests; about a second
  int doubtful_ = 0;
};

/// Merges corners with bit-identical coordinates, in order of first appearance: STL stores every
/// corner by itself. +0 and -0 are the same.
class ExactWelder {
 public:
  explicit ExactWelder(std::size_t expected_vertices) { index_.reserve(expected_vertices); }
  /// Index of the vertex in `vertices`, appended if new.
  int add(const Vec3& position, std::vector<Vec3>& vertices);

 private:
  struct Hash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& key) const;
  };
  std::unordered_map<std::array<std::uint64_t, 3>, int, Hash> index_;
};

/// Throws InputError if a coordinate isn't finite or exceeds 1e12: "`where`: x is nan; ...".
void check_position(const Vec3& position, const std::string& where);

/// Throws InputError "`name`: holds `count` triangles; up to 50000000 are read".
void check_triangle_count(const std::string& name, std::uint64_t count);

/// Makes the promises of MeshFile true: drops triangles that name a vertex twice and vertices
/// without triangle, with notes; `colours`, if there are any, are kept. Throws InputError
/// "`name`: ..." if no triangle is left.
void finish_mesh(MeshFile& file, const std::string& name,
                 geometry::SurfaceColours* colours = nullptr);

}  // namespace palmar::formats
