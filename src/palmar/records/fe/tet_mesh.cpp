// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/fe/tet_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <set>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::records {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdge = {
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<Triangle, 4> kSide = {{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

double jacobian(const std::vector<Vec3>& nodes, int a, int b, int c, int d) {
  const auto at = [&](int n) -> const Vec3& { return nodes[n]; };
  return (at(b) - at(a)).cross(at(c) - at(a)).dot(at(d) - at(a));
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Lines of numbers, '#' starts a comment.
class NumberLines {
 public:
  explicit NumberLines(const std::string& path) : path_(path), text_(formats::read_file(path)) {}

  /// The next line that holds anything.
  std::vector<double> next(std::size_t at_least) {
    std::vector<double> values;
    while (values.empty()) {
      if (begin_ >= text_.size()) {
        throw InputError(fmt::format("{}:{}: the file ends too early", path_, line_));
      }
      const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
      ++line_;
      parse(std::string_view(text_).substr(begin_, end - begin_), values);
      begin_ = end + 1;
    }
    if (values.size() < at_least) {
      throw InputError(
          fmt::format("{}:{}: {} numbers; {} are required", path_, line_, values.size(), at_least));
    }
    return values;
  }

  int index(double value, int first, int count) const {
    const double zero_based = value - first;
    if (!(zero_based >= 0.0 && zero_based < count)) {
      throw InputError(fmt::format("{}:{}: node {}; {} to {} is allowed", path_, line_, value,
                                   first, first + count - 1));
    }
    return static_cast<int>(zero_based);
  }

 private:
  void parse(std::string_view line, std::vector<double>& values) const {
    const char* at = line.data();
    const char* const end = at + line.size();
    while (true) {
      while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
      if (at == end || *at == '#') return;
      double value = 0.0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc()) {
        throw InputError(fmt::format("{}:{}: \"{}\" is no number", path_, line_,
                                     std::string(at, std::min(end, at + 20))));
      }
      values.push_back(value);
      at = stop;
    }
  }

  std::string path_, text_;
  std::size_t begin_ = 0;
  int line_ = 0;
};

}  // namespace

BlockMesh make_block_mesh(const std::vector<Vec3>& nodes,
                          const std::vector<std::array<int, 4>>& tets,
                          const std::vector<MarkedFace>& faces) {
  BlockMesh block;
  TetMesh& mesh = block.mesh;
  mesh.nodes = nodes;
  const int corners = static_cast<int>(nodes.size());
  std::map<std::pair<int, int>, int> middle;
  std::map<Triangle, TetSide> side_of;
  for (std::size_t e = 0; e < tets.size(); ++e) {
    std::array<int, 4> corner = tets[e];
    for (const int n : corner) {
      if (n < 0 || n >= corners) {
        throw InputError(
            fmt::format("tetrahedron {}: node {}; 0 to {} is allowed", e, n, corners - 1));
      }
    }
    const double six_volumes = jacobian(nodes, corner[0], corner[1], corner[2], corner[3]);
    if (six_volumes == 0.0) throw InputError(fmt::format("tetrahedron {} has no volume", e));
    if (six_volumes < 0.0) std::swap(corner[0], corner[1]);
    std::array<int, 10>& tet = mesh.tets.emplace_back();
    std::copy(corner.begin(), corner.end(), tet.begin());
    for (std::size_t k = 0; k < kEdge.size(); ++k) {
      const auto [a, b] = std::minmax(corner[kEdge[k][0]], corner[kEdge[k][1]]);
      const auto [entry, is_new] = middle.try_emplace({a, b}, static_cast<int>(mesh.nodes.size()));
      if (is_new) {
        mesh.nodes.emplace_back(0.5 * (nodes[a] + nodes[b]));
      }
      tet[4 + k] = entry->second;
    }
    for (int s = 0; s < 4; ++s) {
      const Triangle& local = kSide[s];
      side_of[sorted({corner[local[0]], corner[local[1]], corner[local[2]]})] = {
          static_cast<int>(e), s + 1};
    }
  }

  std::set<int> bone;
  std::set<int> cut;
  for (const MarkedFace& face : faces) {
    const Triangle key = sorted(face.corner);
    if (face.mark == static_cast<int>(hand::BlockFace::kRegion)) {
      const auto found = side_of.find(key);
      if (found == side_of.end()) {
        throw InputError(fmt::format("boundary face {} {} {} belongs to no tetrahedron", key[0],
                                     key[1], key[2]));
      }
      block.pressed.push_back(found->second);
      continue;
    }
    const bool is_bone = face.mark == static_cast<int>(hand::BlockFace::kBone);
    if (!is_bone && face.mark != static_cast<int>(hand::BlockFace::kCut)) continue;
    std::set<int>& held = is_bone ? bone : cut;
    held.insert(key.begin(), key.end());
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 2}}) {
      const auto found = middle.find({key[a], key[b]});
      if (found != middle.end()) held.insert(found->second);
    }
  }
  std::sort(block.pressed.begin(), block.pressed.end(), [](const TetSide& a, const TetSide& b) {
    return std::pair(a.tet, a.side) < std::pair(b.tet, b.side);
  });
  block.on_bone.assign(bone.begin(), bone.end());
  std::set_difference(cut.begin(), cut.end(), bone.begin(), bone.end(),
                      std::back_inserter(block.on_cut));
  return block;
}

double smallest_jacobian(const TetMesh& mesh) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.tets) {
    smallest = std::min(smallest, jacobian(mesh.nodes, t[0], t[1], t[2], t[3]));
  }
  return smallest;
}

double volume(const TetMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.tets) sum += jacobian(mesh.nodes, t[0], t[1], t[2], t[3]) / 6.0;
  return sum;
}

std::string tetgen_poly(const hand::TissueBlock& block) {
  std::string text = fmt::format("# nodes, mm\n{} 3 0 0\n", block.vertices.size());
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    const Vec3& p = block.vertices[v];
    text += fmt::format("{} {:.12g} {:.12g} {:.12g}\n", v, p.x(), p.y(), p.z());
  }
  text += fmt::format("# facets: 1 skin, 2 skin of the region, 3 bone, 4 cut\n{} 1\n",
                      block.facets.size());
  for (const hand::BlockFacet& facet : block.facets) {
    text += fmt::format("{} {} {}\n", facet.loop.size(), facet.hole.size(),
                        static_cast<int>(facet.face));
    for (const std::vector<int>& loop : facet.loop) {
      text += fmt::format("{}", loop.size());
      for (const int v : loop) text += fmt::format(" {}", v);
      text += '\n';
    }
    for (std::size_t h = 0; h < facet.hole.size(); ++h) {
      const Vec3& p = facet.hole[h];
      text += fmt::format("{} {:.12g} {:.12g} {:.12g}\n", h + 1, p.x(), p.y(), p.z());
    }
  }
  text += fmt::format("# bones\n{}\n", block.hole.size());
  for (std::size_t h = 0; h < block.hole.size(); ++h) {
    const Vec3& p = block.hole[h];
    text += fmt::format("{} {:.12g} {:.12g} {:.12g}\n", h + 1, p.x(), p.y(), p.z());
  }
  return text + "# regions\n0\n";
}

BlockMesh read_tetgen(const std::string& stem) {
  NumberLines node_lines(stem + ".node");
  const int node_count = static_cast<int>(node_lines.next(4)[0]);
  std::vector<Vec3> nodes;
  int first = 0;
  for (int n = 0; n < node_count; ++n) {
    const std::vector<double> row = node_lines.next(4);
    if (n == 0) first = static_cast<int>(row[0]);
    nodes.emplace_back(row[1], row[2], row[3]);
  }
  NumberLines tet_lines(stem + ".ele");
  const int tet_count = static_cast<int>(tet_lines.next(3)[0]);
  std::vector<std::array<int, 4>> tets;
  for (int e = 0; e < tet_count; ++e) {
    const std::vector<double> row = tet_lines.next(5);
    std::array<int, 4>& tet = tets.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) tet[k] = tet_lines.index(row[k + 1], first, node_count);
  }
  NumberLines face_lines(stem + ".face");
  const int face_count = static_cast<int>(face_lines.next(2)[0]);
  std::vector<MarkedFace> faces;
  for (int f = 0; f < face_count; ++f) {
    const std::vector<double> row = face_lines.next(5);
    MarkedFace& face = faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      face.corner[k] = face_lines.index(row[k + 1], first, node_count);
    }
    face.mark = static_cast<int>(row[4]);
  }
  return make_block_mesh(nodes, tets, faces);
}

}  // namespace palmar::records
