// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/contact_reduction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::grasp {
namespace {

/// Vertices with less than this share of the largest vertex force hold nothing worth reporting.
constexpr double kLeastForce = 1e-6;

struct LoadedVertex {
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< into the product
  double force = 0.0;           ///< N
};

std::array<std::vector<LoadedVertex>, hand::kRegionCount> loaded_by_region(
    const hand::Hand& hand, const contact::ContactResult& contact) {
  constexpr double kClear = 0.05;  // mm; a direction over less than this is unsure
  std::array<std::vector<LoadedVertex>, hand::kRegionCount> loaded;
  if (contact.force.empty()) return loaded;
  const double least = kLeastForce * *std::max_element(contact.force.begin(), contact.force.end());
  std::vector<Vec3> skin_normal;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (!(contact.force[v] > 0.0 && contact.force[v] >= least)) continue;
    const Vec3 way = contact.deformed[v] - contact.undeformed[v];
    LoadedVertex one{contact.deformed[v], Vec3::Zero(), contact.force[v]};
    if (way.norm() > kClear) {
      one.normal = -way.normalized();
    } else {
      if (skin_normal.empty()) {
        skin_normal = geometry::area_weighted_normals(contact.deformed, hand.skin.triangles);
      }
      one.normal = skin_normal[v];
    }
    loaded[index_of(hand.region[v])].push_back(one);
  }
  return loaded;
}

/// Group of each vertex, 0 to count - 1.
std::vector<int> grouped(const std::vector<LoadedVertex>& loaded, int count) {
  std::vector<int> group(loaded.size(), 0);
  if (count < 2) return group;
  std::vector<Vec3> centre;
  std::size_t next = 0;
  for (std::size_t i = 1; i < loaded.size(); ++i) {
    if (loaded[i].force > loaded[next].force) next = i;
  }
  while (static_cast<int>(centre.size()) < count) {
    centre.push_back(loaded[next].position);
    double farthest = 0.0;
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      double nearest = (loaded[i].position - centre[0]).squaredNorm();
      for (const Vec3& c : centre) {
        nearest = std::min(nearest, (loaded[i].position - c).squaredNorm());
      }
      if (nearest > farthest) {
        farthest = nearest;
        next = i;
      }
    }
    if (!(farthest > 0.0)) break;
  }
  constexpr int kMostRounds = 50;
  for (int round = 0; round < kMostRounds; ++round) {
    bool has_changed = round == 0;
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      int best = 0;
      for (int k = 1; k < static_cast<int>(centre.size()); ++k) {
        if ((loaded[i].position - centre[k]).squaredNorm() <
            (loaded[i].position - centre[best]).squaredNorm()) {
          best = k;
        }
      }
      has_changed = has_changed || best != group[i];
      group[i] = best;
    }
    if (!has_changed) break;
    std::vector<Vec3> sum(centre.size(), Vec3::Zero());
    std::vector<double> weight(centre.size(), 0.0);
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      sum[group[i]] += loaded[i].force * loaded[i].position;
      weight[group[i]] += loaded[i].force;
    }
    for (std::size_t k = 0; k < centre.size(); ++k) {
      if (weight[k] > 0.0) centre[k] = sum[k] / weight[k];
    }
  }
  return group;
}

/// How many contacts each region gets: one each as long as there are any, then a second to those
/// with the largest force, and so on.
std::array<int, hand::kRegionCount> shares(
    const std::array<double, hand::kRegionCount>& force,
    const std::array<std::size_t, hand::kRegionCount>& vertices, const ReductionOptions& options) {
  std::array<int, hand::kRegionCount> order{}, count{};
  for (int r = 0; r < hand::kRegionCount; ++r) order[r] = r;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return force[a] > force[b]; });
  int left = options.max_contacts;
  for (int pass = 0; pass < options.per_region; ++pass) {
    for (const int r : order) {
      if (left == 0 || vertices[r] <= static_cast<std::size_t>(pass)) continue;
      ++count[r];
      --left;
    }
  }
  return count;
}

void add_contacts(const std::vector<LoadedVertex>& loaded, int count, hand::Region region,
                  const ReductionOptions& options, std::vector<GraspContact>& contacts) {
  const std::vector<int> group = grouped(loaded, count);
  for (int k = 0; k < count; ++k) {
    double sum = 0.0;
    Vec3 position = Vec3::Zero(), force = Vec3::Zero();
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      if (group[i] != k) continue;
      sum += loaded[i].force;
      position += loaded[i].force * loaded[i].position;
      force += loaded[i].force * loaded[i].normal;
    }
    if (!(sum > 0.0 && force.norm() > 1e-9 * sum)) continue;
    GraspContact one;
    one.position = position / sum;
    one.normal = force.normalized();
    one.friction = options.friction;
    one.normal_force = force.norm();
    one.region = region;
    double arm = 0.0;
    for (std::size_t i = 0; i < loaded.size() && options.soft_finger; ++i) {
      if (group[i] != k) continue;
      const Vec3 away = loaded[i].position - one.position;
      arm += loaded[i].force * (away - one.normal * one.normal.dot(away)).norm();
    }
    one.torsion = options.friction * arm / sum;
    contacts.push_back(one);
  }
}

}  // namespace

void ReductionOptions::check() const {
  const auto require = [](bool is_good, const std::string& what) {
    if (!is_good) throw UsageError("stability: " + what);
  };
  require(per_region >= 1 && per_region <= 16,
          "contacts per region are " + std::to_string(per_region) + "; 1 to 16 are allowed");
  require(max_contacts >= 4 && max_contacts <= 64,
          "contacts in all are " + std::to_string(max_contacts) + "; 4 to 64 are allowed");
  require(friction >= 0.0 && friction <= 5.0,
          "friction coefficient is " + std::to_string(friction) + "; 0 to 5 is allowed");
}

std::vector<GraspContact> reduce_contact(const hand::Hand& hand,
                                         const contact::ContactResult& contact,
                                         const ReductionOptions& options) {
  options.check();
  if (!contact.force.empty() && contact.force.size() != hand.region.size()) {
    throw UsageError("stability: contact of " + std::to_string(contact.force.size()) +
                     " vertices for a hand of " + std::to_string(hand.region.size()));
  }
  const auto loaded = loaded_by_region(hand, contact);
  std::array<double, hand::kRegionCount> force{};
  std::array<std::size_t, hand::kRegionCount> vertices{};
  for (std::size_t r = 0; r < loaded.size(); ++r) {
    vertices[r] = loaded[r].size();
    for (const LoadedVertex& one : loaded[r]) force[r] += one.force;
  }
  const std::array<int, hand::kRegionCount> count = shares(force, vertices, options);
  std::vector<GraspContact> contacts;
  for (std::size_t r = 0; r < loaded.size(); ++r) {
    if (count[r] > 0) {
      add_contacts(loaded[r], count[r], static_cast<hand::Region>(r), options, contacts);
    }
  }
  return contacts;
}

}  // namespace palmar::grasp
