// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/capture/photo/photo_view.h"
#include "hands/capture/photo/skin_light.h"

namespace palmar::capture {

struct VertexColourOptions {
  int best = 3;               ///< photographs whose mean a colour is
  double least_cosine = 0.2;  ///< between normal and direction to a camera that counts as seeing
  void check() const;         ///< throws UsageError: field, value, allowed range
};

/// Colours of a mesh from photographs.
struct VertexColours {
  std::vector<Eigen::Vector3f> colour;  ///< per vertex: sRGB, 0 to 1; black where unseen
  std::vector<int> views;               ///< per vertex: photographs that see it
  std::vector<double> gain;             ///< per photograph: its values were multiplied by this
  SkinLight light;                      ///< what it did from photograph to photograph
};

/// Where a photograph shows the hand, by pixels of a view of it (photo_view.h).
struct PhotoOutline {
  PhotoCamera camera;  ///< of the view
  std::vector<std::uint8_t> inside;
  Eigen::Vector3f paper = Eigen::Vector3f::Constant(255.0F);  ///< colour of white there
  bool holds(const Vec3& world) const;
};

/// The colour of a vertex is the mean of the photographs that it faces best and that see it (a ray
/// to the camera meets no other skin, and ends inside of the photograph's outline, if there are
/// any: where the surface lies a little outside, photographs show what is behind the hand).
/// Photographs of different exposure are brought together first: gains that make what they say
/// about the same vertices equal, their geometric mean 1.
VertexColours colour_vertices(const geometry::TriangleMesh& mesh,
                              const std::vector<Photograph>& photographs,
                              const std::vector<PhotoOutline>& outlines = {},
                              const VertexColourOptions& options = {});

}  // namespace palmar::capture
