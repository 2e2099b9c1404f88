// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grasp_place.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/grasp/power/power_place.h"
#include "palmar/grasp/precision/precision_grip.h"

namespace palmar {
namespace {

bool is_held(const Grasp& grasp) { return grasp.status == GraspStatus::kHeld; }

}  // namespace

struct GraspingHand::Impl {
  explicit Impl(std::shared_ptr<const Hand> shared)
      : hand(std::move(shared)), coarse(*hand, kSearchSpacing), fine(*hand, 0.0) {}
  std::shared_ptr<const Hand> hand;
  HandCloser coarse, fine;
};

GraspingHand::GraspingHand(std::shared_ptr<const Hand> hand) {
  if (!hand) throw UsageError("grasping hand: no hand was given");
  impl_ = std::make_unique<Impl>(std::move(hand));
}

GraspingHand::~GraspingHand() = default;
GraspingHand::GraspingHand(GraspingHand&&) noexcept = default;
GraspingHand& GraspingHand::operator=(GraspingHand&&) noexcept = default;

const Hand& GraspingHand::hand() const { return *impl_->hand; }

struct GraspPlace::Impl {
  const Hand* reference;
  const Product* product;
  GraspOptions options;
  PowerGraspOptions power;  ///< of `options`, with the grip
  std::optional<PowerPlace> place;
  Grasp grasp;

  Grasp hold_power(const GraspingHand& hand, const Progress& progress) const;
  Grasp hold_precisely(const Hand& hand, const Progress& progress) const;
};

Grasp GraspPlace::Impl::hold_power(const GraspingHand& hand, const Progress& progress) const {
  const HandCloser& coarse = hand.impl().coarse;
  const HandCloser& fine = hand.impl().fine;
  const PowerPlace carried = carried_over(*place, *reference, coarse, power, progress);
  return close_at(carried, coarse, fine, *product, power, progress);
}

Grasp GraspPlace::Impl::hold_precisely(const Hand& hand, const Progress& progress) const {
  PrecisionGripOptions same = options.precision;
  same.grip = *options.grip;
  same.targets.clear();
  for (const FingertipContact& tip : grasp.fingertips) {
    same.targets.push_back({tip.finger, tip.target});
  }
  same.placement = {};
  return close_precision_grip(hand, *product, same, progress);
}

GraspPlace::GraspPlace(const Hand& reference, const Product& product, const GraspOptions& options,
                       const Progress& progress) {
  options.check();
  auto impl = std::make_unique<Impl>();
  impl->reference = &reference;
  impl->product = &product;
  impl->options = options;
  if (!options.grip || is_power(*options.grip)) {
    impl->power = options.power;
    impl->power.grip = options.grip;
    impl->place = find_power_place(reference, product, impl->power, progress);
    impl->grasp = impl->place->grasp;
    if (impl->place->is_found) {
      const HandCloser coarse(reference, kSearchSpacing), fine(reference, 0.0);
      impl->grasp = close_at(*impl->place, coarse, fine, product, impl->power, progress);
    }
  } else {
    impl->grasp = find_grasp(reference, product, options, progress);
  }
  impl_ = std::move(impl);
}

GraspPlace::~GraspPlace() = default;
GraspPlace::GraspPlace(GraspPlace&&) noexcept = default;
GraspPlace& GraspPlace::operator=(GraspPlace&&) noexcept = default;

const Grasp& GraspPlace::reference_grasp() const { return impl_->grasp; }

Grasp GraspPlace::hold(const GraspingHand& hand, const Progress& progress) const {
  if (hand.hand().skin.vertices == impl_->reference->skin.vertices) return impl_->grasp;
  const bool has_place = impl_->place ? impl_->place->is_found : !impl_->grasp.fingertips.empty();
  if (!has_place) return find_grasp(hand.hand(), *impl_->product, impl_->options, progress);
  Grasp grasp = impl_->place ? impl_->hold_power(hand, progress)
                             : impl_->hold_precisely(hand.hand(), progress);
  if (is_held(grasp) || !is_held(impl_->grasp)) return grasp;
  // Never silently another way of holding: it is told, and stands first among the runners-up.
  const Grasp own = find_grasp(hand.hand(), *impl_->product, impl_->options, progress);
  grasp.message = "cannot hold it where the reference hand does: " + grasp.message;
  if (!is_held(own)) {
    grasp.message += "; nor did it find another place";
    return grasp;
  }
  grasp.message += fmt::format("; {:.0f} mm from there it would hold it ({})",
                               (own.grip_point - grasp.grip_point).norm(), own.message);
  grasp.runners_up = own.runners_up;
  grasp.runners_up.insert(grasp.runners_up.begin(),
                          {own.grip, own.posture, own.product_from_hand, own.score});
  return grasp;
}

}  // namespace palmar
