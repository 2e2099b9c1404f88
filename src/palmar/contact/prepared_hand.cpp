// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared_hand.h"

#include <string>
#include <utility>

#include "palmar/contact/layer_thickness.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

constexpr int kBlockSize = 48;  // vertices; of the preconditioner

void check_hand(const Hand& hand) {
  if (hand.skin.vertices.empty()) {
    throw UsageError("hand \"" + hand.name + "\": the skin has no vertices");
  }
  if (hand.region.size() != hand.skin.vertices.size()) {
    throw UsageError("hand \"" + hand.name + "\": " + std::to_string(hand.region.size()) +
                     " region labels for " + std::to_string(hand.skin.vertices.size()) +
                     " skin vertices; the numbers must be equal");
  }
}

}  // namespace

PreparedHand::PreparedHand(std::shared_ptr<const Hand> hand, const ContactModel& model) {
  if (!hand) throw UsageError("prepare hand: no hand was given");
  check_hand(*hand);
  if (model.tissue == TissueModel::kLayered && model.kernel == Kernel::kPoint) {
    throw UsageError(
        "kernel \"point\" knows no layer over bone; kernel \"patch\" is required with layered "
        "tissue");
  }
  auto impl = std::make_unique<Impl>();
  impl->model = model;
  // A flat picture of one region says nothing about the way to the next.
  if (model.coupling == RegionCoupling::kCoupled) impl->model.distance = SkinDistance::kSurface;
  impl->skin = skin_geometry(hand->skin);
  impl->hand = std::move(hand);
  if (impl->model.tissue == TissueModel::kLayered) {
    impl->layer_thickness = effective_layer_thickness(*impl->hand, impl->skin);
  }
  impl->response = skin_response(*impl->hand, impl->skin, impl->model, impl->layer_thickness);
  impl->blocks = skin_patches(impl->skin, kBlockSize);
  impl->stiffness =
      skin_stiffness(*impl->hand, impl->skin, impl->response, impl->blocks, impl->model);
  impl_ = std::move(impl);
}

PreparedHand::~PreparedHand() = default;
PreparedHand::PreparedHand(PreparedHand&&) noexcept = default;
PreparedHand& PreparedHand::operator=(PreparedHand&&) noexcept = default;

const Hand& PreparedHand::hand() const { return *impl_->hand; }
const ContactModel& PreparedHand::model() const { return impl_->model; }

}  // namespace palmar
