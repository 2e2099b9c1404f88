// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// What the hands of one mesh (make_hand_instance()) have in common, so that each of them is
/// prepared in a sixth of the time: neighbours, patches, which vertices act on each other, and how
/// much longer the way on the skin between two of them is than the arc between them. That ratio is
/// taken from the base; the arc (arc_distance()) is the hand's own:
///
///     r_ij = r_ij,base arc_ij / arc_ij,base
///
/// Exact for a hand that is scaled as a whole. Forces of hands up to three standard deviations from
/// the mean differ from those of the full preparation by less than 0.5 % (docs/method/contact.md).
/// Skins too fine for pairs of vertices (kMostFullVertices), and those with Isomap distances, are
/// prepared in full. Immutable, shareable between threads.
class HandFamily {
 public:
  /// Throws UsageError as PreparedHand. Cost: that of a PreparedHand and a half.
  /// `compliance`: of the base, as for PreparedHand. Hands of the family get the base's, scaled
  /// (loaded_skin.h).
  explicit HandFamily(std::shared_ptr<const hand::Hand> base, const ContactModel& model = {},
                      std::shared_ptr<const SkinCompliance> compliance = nullptr);
  ~HandFamily();
  HandFamily(HandFamily&&) noexcept;
  HandFamily& operator=(HandFamily&&) noexcept;

  const hand::Hand& base() const;
  const ContactModel& model() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::contact
