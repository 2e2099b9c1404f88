// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>

#include "palmar/geometry/types.h"

namespace palmar::formats {

/// A folder for one test, removed with all that is in it.
class TestFolder {
 public:
  TestFolder() {
    static std::atomic<int> counter{0};
    path_ = std::filesystem::temp_directory_path() /
            ("palmar-io-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Path of a file in a folder that this process has for itself, removed when it ends: two tests
/// that run at a time in processes of their own don't meet there.
inline std::string own_file(const std::string& name) {
  static const TestFolder folder;
  return (folder / name).string();
}

/// Message of the error of type E that `body` throws; "" if it throws none.
template <typename E, typename Body>
std::string message_of(const Body& body) {
  try {
    body();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

/// Box from (0, 0, 0) to `size`: 8 vertices, 12 triangles, counter-clockwise outside.
inline geometry::TriangleMesh box_mesh(const Vec3& size) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? size.x() : 0.0, (i & 2) != 0 ? size.y() : 0.0,
                               (i & 4) != 0 ? size.z() : 0.0);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Volume inside a closed mesh, positive if triangles are counter-clockwise outside.
inline double signed_volume(const geometry::TriangleMesh& mesh) {
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](int k) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6.0;
  }
  return volume;
}

inline double surface_area(const geometry::TriangleMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    area += 0.5 * (mesh.vertices[static_cast<std::size_t>(t[1])] - a)
                      .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a)
                      .norm();
  }
  return area;
}

}  // namespace palmar::formats
