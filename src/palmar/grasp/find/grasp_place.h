// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "palmar/core/progress.h"
#include "palmar/grasp/find/find_grasp.h"

namespace palmar::grasp {

/// A hand made ready for closing round one product after the other. Immutable, shareable between
/// threads.
class GraspingHand {
 public:
  explicit GraspingHand(std::shared_ptr<const hand::Hand> hand);
  ~GraspingHand();
  GraspingHand(GraspingHand&&) noexcept;
  GraspingHand& operator=(GraspingHand&&) noexcept;

  const hand::Hand& hand() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

/// Where and how hands of different size hold one product: the place is searched once, on a
/// reference hand, and kept. Power grips: the same side of the product, the same pose in the hand
/// (lengths in hand lengths); each hand presses the product into its own palm and closes its own
/// fingers. Precision grips: fingertips go to the same points of the product. What is known about
/// the product (distances near the place) is shared. Immutable, shareable between threads; product
/// and reference hand must outlive it.
class GraspPlace {
 public:
  /// find_grasp() of the reference hand. Throws UsageError, Cancelled.
  GraspPlace(const hand::Hand& reference, const product::Product& product,
             const GraspOptions& options = {}, const Progress& progress = {});
  ~GraspPlace();
  GraspPlace(GraspPlace&&) noexcept;
  GraspPlace& operator=(GraspPlace&&) noexcept;

  /// As the reference hand holds the product.
  const Grasp& reference_grasp() const;

  /// The holds among which it was chosen; without holds where coordinates or a hold were given.
  const RankedHolds& ranked() const;

  /// Another of ranked(), by its number from 1; `why` becomes RankedHolds::why_taken. Throws
  /// UsageError, Cancelled.
  GraspPlace with_hold(int number, const std::string& why, const Progress& progress = {}) const;

  /// How `hand` holds it there. A hand that can't hold it that way, while the reference hand can,
  /// is a result like others: where holds were ranked its message names the first of the next ones
  /// that it can take, which stands first among the runners-up. On a product that the reference
  /// hand found no place on, each hand searches by itself. The reference hand gets
  /// reference_grasp(). Throws Cancelled.
  Grasp hold(const GraspingHand& hand, const Progress& progress = {}) const;

  struct Impl;

 private:
  explicit GraspPlace(std::unique_ptr<const Impl> impl);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::grasp
