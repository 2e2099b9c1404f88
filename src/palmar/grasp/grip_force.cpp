// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grip_force.h"

#include <cmath>

#include "palmar/contact/contact_normals.h"

namespace palmar {

Squeeze grip_force(const std::vector<Vec3>& forces) {
  Squeeze best;
  for (const Vec3& f : forces) best.sum_of_normals += f.norm();
  // sum |f . e| is convex in e: from any start, e along the sum of the forces, each counted to the
  // side on which it lies, squeezes at least as much. Starts: a half sphere of directions.
  constexpr int kRings = 5, kTurns = 12, kMostSteps = 100;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double rise = std::acos(-1.0) / 2.0 * ring / kRings;
    for (int turn = 0; turn < (ring == kRings ? 1 : kTurns); ++turn) {
      const double angle = 2.0 * std::acos(-1.0) * turn / kTurns;
      Vec3 across(std::cos(rise) * std::cos(angle), std::cos(rise) * std::sin(angle),
                  std::sin(rise));
      double force = -1.0;
      for (int step = 0; step < kMostSteps; ++step) {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& f : forces) sum += f.dot(across) < 0.0 ? Vec3(-f) : f;
        const double now = 0.5 * sum.norm();
        if (!(now > force * (1.0 + 1e-12))) break;
        force = now;
        across = sum.normalized();
      }
      if (force > best.force * (1.0 + 1e-9)) {
        best.force = force;
        best.across = across;
      }
    }
  }
  return best;
}

Squeeze grip_force(const ContactResult& contact, const DistanceField& product) {
  const std::vector<int> loaded = loaded_vertices(contact);
  std::vector<Vec3> forces = contact_normals(contact, product, loaded);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    forces[k] *= -contact.force[static_cast<std::size_t>(loaded[k])];
  }
  return grip_force(forces);
}

}  // namespace palmar
