// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared_hand.h"

#include <optional>
#include <string>
#include <utility>

#include "palmar/contact/hand_family.h"
#include "palmar/contact/response/layer_thickness.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

constexpr int kBlockSize = 48;  // vertices; of the preconditioner
constexpr int kSpotSize = 6;    // vertices

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

void check_model(const ContactModel& model) {
  if (model.tissue == TissueModel::kLayered && model.kernel == Kernel::kPoint) {
    throw UsageError(
        "kernel \"point\" knows no layer over bone; kernel \"patch\" is required with layered "
        "tissue");
  }
}

/// A flat picture of one region says nothing about the way to the next.
ContactModel completed(ContactModel model) {
  if (model.coupling == RegionCoupling::kCoupled) model.distance = SkinDistance::kSurface;
  return model;
}

void check_alike(const Hand& hand, const Hand& base) {
  if (hand.skin.triangles != base.skin.triangles || hand.region != base.region) {
    throw UsageError("hand \"" + hand.name + "\" has not the mesh of hand \"" + base.name +
                     "\", as whose family it was to be prepared; the same triangles and regions "
                     "are required");
  }
}

}  // namespace

struct HandFamily::Impl {
  std::shared_ptr<const Hand> base;
  ContactModel model;
  SkinGeometry skin;
  std::optional<SkinPairs> pairs;  ///< nothing for a skin that has a far part, or Isomap
  SkinPatches blocks, spots;
};

HandFamily::HandFamily(std::shared_ptr<const Hand> base, const ContactModel& model) {
  if (!base) throw UsageError("family of hands: no hand was given");
  check_hand(*base);
  check_model(model);
  auto impl = std::make_unique<Impl>();
  impl->model = completed(model);
  impl->skin = skin_geometry(base->skin);
  const bool has_far = impl->model.coupling == RegionCoupling::kCoupled &&
                       impl->skin.vertex_count() > kMostFullVertices;
  // Stretched distances of a flat picture fit in no plane any more, and the point kernel, near its
  // limit on fine skin, would lose its definiteness.
  const bool is_flat = impl->model.distance == SkinDistance::kIsomap;
  if (!has_far && !is_flat) impl->pairs = skin_pairs(*base, impl->skin, impl->model);
  impl->blocks = skin_patches(impl->skin, kBlockSize);
  impl->spots = skin_patches(impl->skin, kSpotSize);
  impl->base = std::move(base);
  impl_ = std::move(impl);
}

HandFamily::~HandFamily() = default;
HandFamily::HandFamily(HandFamily&&) noexcept = default;
HandFamily& HandFamily::operator=(HandFamily&&) noexcept = default;

const Hand& HandFamily::base() const { return *impl_->base; }
const ContactModel& HandFamily::model() const { return impl_->model; }

PreparedHand::PreparedHand(std::shared_ptr<const Hand> hand, const ContactModel& model) {
  if (!hand) throw UsageError("prepare hand: no hand was given");
  check_hand(*hand);
  check_model(model);
  auto impl = std::make_unique<Impl>();
  impl->model = completed(model);
  impl->skin = skin_geometry(hand->skin);
  impl->hand = std::move(hand);
  if (impl->model.tissue == TissueModel::kLayered) {
    impl->layer_thickness = effective_layer_thickness(*impl->hand, impl->skin);
  }
  impl->response = skin_response(*impl->hand, impl->skin, impl->model, impl->layer_thickness);
  impl->blocks = skin_patches(impl->skin, kBlockSize);
  impl->stiffness = skin_stiffness(*impl->hand, impl->skin, impl->response,
                                   skin_patches(impl->skin, kSpotSize), impl->blocks, impl->model);
  impl_ = std::move(impl);
}

PreparedHand::PreparedHand(std::shared_ptr<const Hand> hand, const HandFamily& family) {
  if (!hand) throw UsageError("prepare hand: no hand was given");
  check_hand(*hand);
  const HandFamily::Impl& shared = family.impl();
  check_alike(*hand, *shared.base);
  auto impl = std::make_unique<Impl>();
  impl->model = shared.model;
  impl->skin = skin_geometry_like(hand->skin, shared.skin);
  impl->hand = std::move(hand);
  if (impl->model.tissue == TissueModel::kLayered) {
    impl->layer_thickness = effective_layer_thickness(*impl->hand, impl->skin);
  }
  impl->response = shared.pairs
                       ? stretched_response(*impl->hand, impl->skin, impl->model,
                                            impl->layer_thickness, *shared.pairs)
                       : skin_response(*impl->hand, impl->skin, impl->model, impl->layer_thickness);
  impl->blocks = shared.blocks;
  impl->stiffness = skin_stiffness(*impl->hand, impl->skin, impl->response, shared.spots,
                                   impl->blocks, impl->model);
  impl_ = std::move(impl);
}

PreparedHand::~PreparedHand() = default;
PreparedHand::PreparedHand(PreparedHand&&) noexcept = default;
PreparedHand& PreparedHand::operator=(PreparedHand&&) noexcept = default;

const Hand& PreparedHand::hand() const { return *impl_->hand; }
const ContactModel& PreparedHand::model() const { return impl_->model; }

}  // namespace palmar
