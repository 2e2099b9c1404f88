// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "palmar/contact/footprint/footprint.h"
#include "palmar/product/product.h"

namespace palmar::study {

/// What a hand does to one face of the product. Pressures count per area of the product (see
/// map_to_product()), so they are those that the surface feels.
struct FaceContact {
  int face = 0;                ///< index into ProductFaces::face
  double force = 0.0;          ///< N; integral of the pressure over the face
  double area = 0.0;           ///< mm^2 of the face under pressure
  double peak_pressure = 0.0;  ///< MPa, largest of the map's vertices on the face, its rim included
  double mean_pressure = 0.0;  ///< MPa; force over area
  /// Whether the product's highest pressure is on this face; of at most one. A vertex on the rim
  /// belongs to that of its faces which bears the higher pressure round it.
  bool has_peak = false;
};

/// How much of a map's area belongs to each of its vertices on each face: what per-face results of
/// many fields on the same map need. A pressure between vertices is linear over a triangle, so its
/// integral is the sum of a third of the triangle's area times the pressure of each corner.
class FaceAreas {
 public:
  /// `face_of_triangle` per triangle of the map. Throws UsageError if it doesn't fit.
  FaceAreas(const geometry::TriangleMesh& map, const std::vector<int>& face_of_triangle);
  /// Faces under pressure, ascending; their forces sum up to that of the map, their areas to its
  /// area under pressure. `pressure` in MPa, per vertex of the map; throws UsageError if it isn't.
  std::vector<FaceContact> contacts(const std::vector<double>& pressure) const;
  /// The same where only the vertices `loaded` may have any.
  std::vector<FaceContact> contacts(const std::vector<double>& pressure,
                                    std::span<const int> loaded) const;
  std::size_t vertex_count() const { return start_.size() - 1; }

 private:
  int peak_face(const std::vector<double>& pressure, int vertex) const;

  struct Corner {
    int triangle = 0, face = 0;
    double third = 0.0;  ///< of the triangle's area, mm^2
  };
  std::vector<std::size_t> start_;  ///< per vertex: its first corner
  std::vector<Corner> corner_;      ///< by vertex
  std::vector<Triangle> triangle_;
  std::vector<double> third_;  ///< of each triangle's area, mm^2
  std::vector<int> face_;      ///< per triangle
  int faces_ = 0;
};

/// Of one grasp's footprint; empty if the product has no faces.
std::vector<FaceContact> face_contacts(const contact::ProductFootprint& footprint,
                                       const product::Product& product);

}  // namespace palmar::study
