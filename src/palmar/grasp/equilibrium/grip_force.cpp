// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/grip_force.h"

#include <array>
#include <cmath>

#include "palmar/contact/contact_normals.h"

namespace palmar::grasp {

namespace {

constexpr int kLanes = 4;  // directions that are tried side by side
constexpr int kRings = 5, kRingDirections = 12, kFirstDirections = kRings * kRingDirections + 1;
constexpr int kMostSteps = 100;

/// Start k: a half sphere of directions in rings, the pole last.
Vec3 start_direction(int k) {
  const double rise = std::acos(-1.0) / 2.0 * (k / kRingDirections) / kRings;
  const double angle = 2.0 * std::acos(-1.0) * (k % kRingDirections) / kRingDirections;
  return {std::cos(rise) * std::cos(angle), std::cos(rise) * std::sin(angle), std::sin(rise)};
}

using Lanes = double[3][kLanes];

/// Sum of the forces, each counted to the side of `across` on which it lies; for all lanes. No
/// branches: the sides change from force to force as they like.
[[gnu::always_inline]] inline void sum_each(const std::vector<Vec3>& forces, const Lanes& across,
                                            Lanes& sum) {
  double x[kLanes] = {}, y[kLanes] = {}, z[kLanes] = {};
  for (const Vec3& f : forces) {
    for (int l = 0; l < kLanes; ++l) {
      const double along = f.x() * across[0][l] + (f.y() * across[1][l] + f.z() * across[2][l]);
      const double side = std::copysign(1.0, along + 0.0);  // of -0: that of 0
      x[l] += side * f.x();
      y[l] += side * f.y();
      z[l] += side * f.z();
    }
  }
  for (int l = 0; l < kLanes; ++l) {
    sum[0][l] = x[l];
    sum[1][l] = y[l];
    sum[2][l] = z[l];
  }
}

// The same operations in the same order with and without vector instructions, so the answer doesn't
// depend on the processor.
#if defined(__x86_64__) && defined(__GNUC__)
__attribute__((target("avx2"))) void sum_avx2(const std::vector<Vec3>& forces, const Lanes& across,
                                              Lanes& sum) {
  sum_each(forces, across, sum);
}
void sum_to_sides(const std::vector<Vec3>& forces, const Lanes& across, Lanes& sum) {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  has_avx2 ? sum_avx2(forces, across, sum) : sum_each(forces, across, sum);
}
#else
void sum_to_sides(const std::vector<Vec3>& forces, const Lanes& across, Lanes& sum) {
  sum_each(forces, across, sum);
}
#endif

}  // namespace

Squeeze grip_force(const std::vector<Vec3>& forces) {
  // sum |f . e| is convex in e: from any start, e along the sum of the forces, each counted to the
  // side on which it lies, squeezes at least as much.
  struct Climb {
    double force = -1.0;
    Vec3 across;
    int steps = 0;
  };
  std::array<Climb, kFirstDirections> climb;
  for (int k = 0; k < kFirstDirections; ++k) {
    climb[k].across = start_direction(k);
  }
  std::array<int, kLanes> at;  // start that a lane climbs from; -1: idle
  Lanes across = {}, sum;
  int next = 0, busy = 0;
  const auto take = [&](int lane) {
    const bool is_left = next < kFirstDirections;
    at[lane] = is_left ? next : -1;
    if (!is_left) return;
    for (int c = 0; c < 3; ++c) across[c][lane] = climb[next].across[c];
    ++next;
    ++busy;
  };
  for (int l = 0; l < kLanes; ++l) take(l);
  while (busy > 0) {
    sum_to_sides(forces, across, sum);
    for (int l = 0; l < kLanes; ++l) {
      if (at[l] < 0) continue;
      Climb& one = climb[at[l]];
      const Vec3 whole(sum[0][l], sum[1][l], sum[2][l]);
      const double now = 0.5 * whole.norm();
      if (!(now > one.force * (1.0 + 1e-12))) {
        --busy;
        take(l);
        continue;
      }
      one.force = now;
      one.across = whole.normalized();
      for (int c = 0; c < 3; ++c) across[c][l] = one.across[c];
      if (++one.steps == kMostSteps) {
        --busy;
        take(l);
      }
    }
  }
  Squeeze best;
  for (const Vec3& f : forces) best.sum_of_normals += f.norm();
  for (const Climb& one : climb) {
    if (one.force > best.force * (1.0 + 1e-9)) {
      best.force = one.force;
      best.across = one.across;
    }
  }
  return best;
}

Squeeze grip_force(const contact::ContactResult& contact, const geometry::DistanceField& product) {
  const std::vector<int> loaded = contact::loaded_vertices(contact);
  std::vector<Vec3> forces = contact::contact_normals(contact, product, loaded);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    forces[k] *= -contact.force[loaded[k]];
  }
  return grip_force(forces);
}

}  // namespace palmar::grasp
