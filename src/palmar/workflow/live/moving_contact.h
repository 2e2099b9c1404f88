// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "palmar/contact/contact.h"

namespace palmar::workflow {

/// The product's distance as a grid, for MovingContact: at sharp edges and far from the surface the
/// product's own answers. Where that would take more than some 300 000 nodes, the distance itself.
std::shared_ptr<const geometry::DistanceField> distance_for_moving(
    const geometry::TriangleMesh& mesh,
    const std::shared_ptr<const geometry::DistanceField>& distance);

/// The contact of what is dragged and watched, along a motion: from the last call's solution, with
/// moduli of the tissue, and so forces, settled to 1 %. Loaded skin is put on the product; the rest
/// stays where the posture has it, and what would bulge until it touches isn't counted: areas come
/// out some per cent too small. Two thirds of the time of ContactSolver, or less.
class MovingContact {
 public:
  explicit MovingContact(const contact::PreparedHand& prepared);
  ~MovingContact();
  MovingContact(MovingContact&&) noexcept;
  MovingContact& operator=(MovingContact&&) noexcept;

  /// Arguments as ContactSolver::solve(); `result` is overwritten, its memory reused.
  void solve(const std::vector<Vec3>& posed_skin, const geometry::Rigid3& product_from_hand,
             const geometry::DistanceField& product, contact::ContactResult& result);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palmar::workflow
