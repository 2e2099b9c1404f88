// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/deformed_skin.h"

#include <algorithm>
#include <cmath>

namespace palmar::contact {
namespace {

constexpr int kDirectionRounds = 8;   // the direction turns within as many rings (20 mm)
constexpr int kRelaxationRounds = 3;  // levels out what is narrower than about three edges
constexpr int kPushRounds = 3;        // two are enough on smooth products; sharp inner corners: 3

/// Replaces the values of `vertices` by the mean of their neighbours' and, by `own_share`, their
/// own; all at once.
void average_once(const SkinGeometry& geometry, const std::vector<int>& vertices, double own_share,
                  std::vector<Vec3>& values, std::vector<Vec3>& scratch) {
  scratch.resize(vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    Vec3 sum = Vec3::Zero();
    for (const int w : geometry.neighbours(vertices[k])) sum += values[w];
    const auto count = static_cast<double>(geometry.neighbours(vertices[k]).size());
    scratch[k] = own_share * values[vertices[k]] + (1.0 - own_share) / count * sum;
  }
  for (std::size_t k = 0; k < vertices.size(); ++k) values[vertices[k]] = scratch[k];
}

/// Puts vertices that lie inside the product on its surface. Returns the deepest that stays, mm.
double push_out(const SkinOnProduct& skin, const geometry::DistanceField& product,
                const std::vector<int>& vertices, ContactResult& result,
                std::vector<geometry::DistanceSample>& after) {
  std::vector<int> inside;
  for (const int v : vertices) {
    // Skin cannot have come nearer than by what it moved.
    const double moved = (result.deformed[v] - result.undeformed[v]).norm();
    if (skin.sample[v].distance <= moved) inside.push_back(v);
  }
  for (int round = 0;; ++round) {
    resample_vertices(product, result.deformed, inside, kNearRange, after);
    std::erase_if(inside, [&](int v) {
      // Deeper than the range: left out, nowhere to go.
      return after[v].distance >= 0.0 || after[v].distance <= -kNearRange;
    });
    if (inside.empty() || round == kPushRounds) break;
    for (const int v : inside) result.deformed[v] = after[v].closest;
  }
  double deepest = 0.0;
  for (const int v : inside) deepest = std::max(deepest, -after[v].distance);
  return deepest;
}

}  // namespace

void deform_skin(const SkinGeometry& geometry, const SkinOnProduct& skin,
                 const geometry::DistanceField& product, const std::vector<char>& is_active,
                 const SkinMotion& by_skin, ContactResult& result) {
  const std::size_t n = result.undeformed.size();
  result.deformed = result.undeformed;
  std::vector<int> loaded;
  std::vector<int> free;
  for (std::size_t v = 0; v < n; ++v) {
    if (result.force[v] > 0.0) {
      loaded.push_back(static_cast<int>(v));
    } else if (is_active[v]) {
      free.push_back(static_cast<int>(v));
    }
  }
  std::vector<Vec3> scratch;

  std::vector<Vec3> direction(n);
  for (std::size_t v = 0; v < n; ++v) direction[v] = -skin.normal[v];
  for (const int v : skin.collision) direction[v] = skin.sample[v].normal;
  for (int round = 0; round < kDirectionRounds; ++round) {
    average_once(geometry, free, 0.0, direction, scratch);
  }
  for (const int v : free) {
    const double length = direction[v].norm();
    direction[v] = length > 0.1 ? Vec3(direction[v] / length) : Vec3(-skin.normal[v]);
  }

  std::vector<Vec3> motion(n, Vec3::Zero());
  for (const int v : loaded) motion[v] = skin.sample[v].closest - result.undeformed[v];
  for (const int v : free) {
    motion[v] = result.displacement[v] * direction[v];
    // Out of the product, as far as its tangent plane shows; the rest is left to push_out().
    const geometry::DistanceSample& sample = skin.sample[v];
    if (sample.distance >= kNearRange) continue;
    motion[v] += std::max(0.0, -sample.distance - motion[v].dot(sample.normal)) * sample.normal;
  }
  for (int round = 0; round < kRelaxationRounds; ++round) {
    average_once(geometry, free, 0.3, motion, scratch);
  }
  for (const int v : loaded) result.deformed[v] = skin.sample[v].closest;
  for (const int v : free) {
    result.deformed[v] += motion[v];
    if (!by_skin.besides.empty()) result.deformed[v] += by_skin.besides[v];
  }
  for (std::size_t k = 0; k < by_skin.vertex.size(); ++k) {
    const int v = by_skin.vertex[k];
    if (!(result.force[v] > 0.0)) result.deformed[v] = result.undeformed[v] + by_skin.whole[k];
  }
  std::vector<geometry::DistanceSample> after = skin.sample;
  for (const int v : skin.traced) after[v] = {};
  result.residual_penetration_other = push_out(skin, product, free, result, after);
  for (const int v : free) {
    result.displacement[v] = (result.deformed[v] - result.undeformed[v]).dot(direction[v]);
  }
  resample_vertices(product, result.deformed, loaded, kNearRange, after);
  for (const int v : loaded) {
    result.residual_penetration_contact =
        std::max(result.residual_penetration_contact, std::abs(after[v].distance));
  }
}

}  // namespace palmar::contact
