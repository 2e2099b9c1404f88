// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Red, green, blue as sRGB (IEC 61966-2-1) codes them, 0 to 1.
using Srgb = Eigen::Vector3f;

/// A surface with a colour at every vertex.
struct ColouredMesh {
  TriangleMesh mesh;
  std::vector<Srgb> colour;  ///< per vertex
  /// Per vertex: nothing saw it, its place and colour are guesses; empty: all were seen.
  std::vector<char> is_guess = {};
};

/// Rows from the top, three bytes a pixel, sRGB.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Colours of a mesh's surface as scanning programs write them: images placed on its triangles,
/// colours at its vertices, or both.
struct SurfaceColours {
  std::vector<Srgb> vertex;    ///< per vertex; empty: none
  std::vector<char> is_guess;  ///< per vertex, see ColouredMesh; empty: none
  /// Per triangle and corner: place in the texture, from 0 to 1 to the right and down, going round
  /// beyond; empty: none.
  std::vector<std::array<Eigen::Vector2f, 3>> place;
  std::vector<int> texture;        ///< per triangle: which of the images, -1 for none
  std::vector<RgbImage> textures;  ///< an image without pixels gives no colour

  bool empty() const { return vertex.empty() && textures.empty(); }
  /// Gives vertex `to` what vertex `from` has, where vertices have anything.
  void copy_vertex(std::size_t from, std::size_t to);
  /// Forgets all vertices behind the first `count`.
  void keep_vertices(std::size_t count);
};

/// Colour of an image at a place, bilinear between the centres of its pixels.
Srgb colour_at(const RgbImage& image, const Eigen::Vector2f& place);

/// The same surface with edges of at most `edge_length` (in the mesh's unit) and the colours at its
/// vertices: edges are split at their middles, so a surface stays closed. The colour of a vertex is
/// the mean of what its triangles' images show there, else that of the vertices. The first vertices
/// are those of the mesh. Throws UsageError without any colour, InputError if more than
/// `kMaxColouredTriangles` would be needed.
ColouredMesh coloured_mesh(const TriangleMesh& mesh, const SurfaceColours& colours,
                           double edge_length);
inline constexpr int kMaxColouredTriangles = 8'000'000;

}  // namespace palmar::geometry
