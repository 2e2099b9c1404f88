// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/skin_division.h"

#include <algorithm>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::contact {
namespace {

constexpr double kLeastCosine = 0.5;  // of the normals at an edge's ends; below, a crease

std::uint64_t edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32U) | static_cast<std::uint64_t>(high);
}

Vec3 between(const std::vector<Vec3>& position, const std::vector<Vec3>& normal, int a, int b) {
  const Vec3 chord = position[b] - position[a];
  Vec3 result = 0.5 * (position[a] + position[b]);
  if (normal[a].dot(normal[b]) < kLeastCosine) return result;
  return result + 0.125 * (chord.dot(normal[b]) * normal[b] - chord.dot(normal[a]) * normal[a]);
}

}  // namespace

SkinDivision::SkinDivision(std::vector<Triangle> triangles, std::vector<Vec3> at_rest,
                           std::vector<Vec3> posed, std::vector<char> may_divide)
    : original_(at_rest.size()), may_divide_(std::move(may_divide)), leaves_(std::move(triangles)) {
  shape_[0].position = std::move(at_rest);
  shape_[1].position = std::move(posed);
  close();
}

int SkinDivision::known_middle(int a, int b) const {
  const auto found = middle_.find(edge_key(a, b));
  return found == middle_.end() ? -1 : found->second;
}

int SkinDivision::middle(int a, int b) {
  const auto [at, is_new] =
      middle_.try_emplace(edge_key(a, b), static_cast<int>(may_divide_.size()));
  if (!is_new) return at->second;
  if (a > b) std::swap(a, b);
  for (Shape& shape : shape_) {
    shape.position.push_back(between(shape.position, shape.normal, a, b));
    const Vec3 sum = shape.normal[a] + shape.normal[b];
    shape.normal.push_back(sum.norm() > 0.0 ? Vec3(sum.normalized()) : shape.normal[a]);
  }
  may_divide_.push_back(1);
  ends_.push_back({a, b});
  return at->second;
}

bool SkinDivision::is_divisible(const Triangle& t) const {
  return may_divide_[t[0]] != 0 && may_divide_[t[1]] != 0 && may_divide_[t[2]] != 0;
}

/// Two halved edges, or one whose half is halved again.
bool SkinDivision::must_divide(const Triangle& t) const {
  int halved = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int a = t[k];
    const int b = t[(k + 1) % 3];
    const int m = known_middle(a, b);
    if (m < 0) continue;
    if (++halved == 2 || known_middle(a, m) >= 0 || known_middle(m, b) >= 0) return true;
  }
  return false;
}

/// Puts the triangle in the middle in the leaf's place and the other three behind.
void SkinDivision::split(std::size_t leaf) {
  const auto [a, b, c] = leaves_[leaf];
  const int ab = middle(a, b);
  const int bc = middle(b, c);
  const int ca = middle(c, a);
  leaves_[leaf] = {ab, bc, ca};
  leaves_.push_back({a, ab, ca});
  leaves_.push_back({ab, b, bc});
  leaves_.push_back({ca, bc, c});
}

void SkinDivision::divide(const std::vector<char>& is_chosen) {
  const std::size_t count = leaves_.size();
  for (std::size_t leaf = 0; leaf < count; ++leaf) {
    const Triangle& t = leaves_[leaf];
    const bool touches = is_chosen[t[0]] != 0 || is_chosen[t[1]] != 0 || is_chosen[t[2]] != 0;
    if (touches && is_divisible(t)) split(leaf);
  }
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
      if (!is_divisible(leaves_[leaf]) || !must_divide(leaves_[leaf])) continue;
      split(leaf);
      is_changed = true;
    }
  }
  close();
}

/// The leaves with those cut that have halved edges: fans from the corner across them.
void SkinDivision::close() {
  triangles_.clear();
  for (const Triangle& t : leaves_) {
    std::size_t across = 3;  // corner opposite the halved edge
    for (std::size_t k = 0; k < 3; ++k) {
      if (known_middle(t[k], t[(k + 1) % 3]) >= 0) across = (k + 2) % 3;
    }
    if (across == 3) {
      triangles_.push_back(t);
      continue;
    }
    // An edge of a triangle that may not be divided can have been halved more than once.
    std::vector<int> edge = {t[(across + 1) % 3], t[(across + 2) % 3]};
    for (std::size_t k = 0; k + 1 < edge.size();) {
      const int m = known_middle(edge[k], edge[k + 1]);
      if (m < 0) {
        ++k;
      } else {
        edge.insert(edge.begin() + static_cast<std::ptrdiff_t>(k) + 1, m);
      }
    }
    for (std::size_t k = 0; k + 1 < edge.size(); ++k) {
      triangles_.push_back({t[across], edge[k], edge[k + 1]});
    }
  }
  for (Shape& shape : shape_)
    geometry::area_weighted_normals(shape.position, triangles_, shape.normal);
}

std::vector<std::vector<std::pair<int, double>>> SkinDivision::shares() const {
  std::vector<std::vector<std::pair<int, double>>> result(may_divide_.size());
  for (std::size_t v = 0; v < original_; ++v) result[v] = {{static_cast<int>(v), 1.0}};
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    auto& own = result[original_ + k];
    for (const int end : ends_[k]) {
      for (const auto& [v, share] : result[end]) {
        const auto same = std::find_if(own.begin(), own.end(),
                                       [v = v](const auto& one) { return one.first == v; });
        if (same == own.end()) {
          own.emplace_back(v, 0.5 * share);
        } else {
          same->second += 0.5 * share;
        }
      }
    }
  }
  return result;
}

}  // namespace palmar::contact
