// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/prepared_hand.h"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/hand_family.h"
#include "palmar/contact/response/layer_thickness.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::contact {
namespace {

constexpr int kBlockSize = 48;  // vertices; of the preconditioner
constexpr int kSpotSize = 6;    // vertices

void check_hand(const hand::Hand& hand) {
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
  if (model.tissue == TissueModel::kBone &&
      (model.kernel == Kernel::kPoint || model.coupling != RegionCoupling::kCoupled)) {
    throw UsageError(
        "tissue on bone is one body; kernel \"patch\" and coupled regions are required with it");
  }
}

void check_size(const hand::Hand& hand, const ContactModel& model) {
  if (model.tissue != TissueModel::kBone || hand.skin.vertex_count() <= kMostFullVertices) return;
  throw UsageError("hand \"" + hand.name + "\" has " + std::to_string(hand.skin.vertex_count()) +
                   " skin vertices; tissue on bone takes up to " +
                   std::to_string(kMostFullVertices));
}

std::shared_ptr<const SkinCompliance> compliance_of(const hand::Hand& hand,
                                                    const SkinGeometry& skin,
                                                    std::shared_ptr<const SkinCompliance> known) {
  if (known) return known;
  return std::make_shared<const SkinCompliance>(skin_compliance(hand, skin));
}

/// The skin without tissue elements: what alone has the response of a half-space on bone.
std::vector<int> vertices_off_bone(const SkinGeometry& skin, const SkinCompliance& compliance) {
  std::vector<int> result;
  auto next = compliance.vertex.begin();
  for (int v = 0; v < skin.vertex_count(); ++v) {
    if (next != compliance.vertex.end() && *next == v) {
      ++next;
    } else {
      result.push_back(v);
    }
  }
  return result;
}

/// How much longer a hand is than its family's base around each vertex: the root of the ratio of
/// the areas of its neighbourhoods.
std::vector<double> length_ratios(const SkinGeometry& base, const SkinGeometry& skin) {
  std::vector<double> result;
  result.reserve(skin.area.size());
  for (int v = 0; v < skin.vertex_count(); ++v) {
    double own = skin.area[v];
    double old = base.area[v];
    for (const int w : base.neighbours(v)) {
      own += skin.area[w];
      old += base.area[w];
    }
    result.push_back(std::sqrt(own / old));
  }
  return result;
}

/// Volumes of a hand's tissue from those of its family's base: as the cubes of the lengths.
std::array<double, hand::kRegionCount> scaled_volumes(
    const std::array<double, hand::kRegionCount>& volume, const hand::Hand& hand,
    const SkinGeometry& base, const SkinGeometry& skin) {
  std::array<double, hand::kRegionCount> own{}, old{};
  for (std::size_t v = 0; v < hand.region.size(); ++v) {
    own[index_of(hand.region[v])] += skin.area[v];
    old[index_of(hand.region[v])] += base.area[v];
  }
  std::array<double, hand::kRegionCount> result = volume;
  for (std::size_t r = 0; r < result.size(); ++r) {
    if (old[r] > 0.0) result[r] *= std::pow(own[r] / old[r], 1.5);
  }
  return result;
}

/// A flat picture of one region says nothing about the way to the next, and the thesis' procedure
/// knows nothing but regions of half-spaces.
ContactModel completed(ContactModel model) {
  const bool is_coupled = model.coupling == RegionCoupling::kCoupled;
  if (is_coupled) model.distance = SkinDistance::kSurface;
  if (is_coupled || model.tissue != TissueModel::kHalfSpace) model.bulge = BulgeLaw::kHeld;
  return model;
}

void check_alike(const hand::Hand& hand, const hand::Hand& base) {
  if (hand.skin.triangles != base.skin.triangles || hand.region != base.region) {
    throw UsageError("hand \"" + hand.name + "\" has not the mesh of hand \"" + base.name +
                     "\", as whose family it was to be prepared; the same triangles and regions "
                     "are required");
  }
}

}  // namespace

struct HandFamily::Impl {
  std::shared_ptr<const hand::Hand> base;
  ContactModel model;
  SkinGeometry skin;
  std::optional<SkinPairs> pairs;  ///< nothing for a skin that has a far part, or Isomap
  SkinPatches blocks, spots;
  std::shared_ptr<const SkinCompliance> compliance;  ///< with TissueModel::kBone
  std::shared_ptr<const CoarseSkin> coarse_skin;
};

HandFamily::HandFamily(std::shared_ptr<const hand::Hand> base, const ContactModel& model,
                       std::shared_ptr<const SkinCompliance> compliance) {
  if (!base) throw UsageError("family of hands: no hand was given");
  check_hand(*base);
  check_model(model);
  check_size(*base, model);
  auto impl = std::make_unique<Impl>();
  impl->model = completed(model);
  impl->skin = skin_geometry(base->skin);
  const bool has_far = impl->model.coupling == RegionCoupling::kCoupled &&
                       impl->skin.vertex_count() > kMostFullVertices;
  // Stretched distances of a flat picture fit in no plane any more, and the point kernel, near its
  // limit on fine skin, would lose its definiteness.
  const bool is_flat = impl->model.distance == SkinDistance::kIsomap;
  if (impl->model.tissue == TissueModel::kBone) {
    impl->compliance = compliance_of(*base, impl->skin, std::move(compliance));
    const std::vector<int> off_bone = vertices_off_bone(impl->skin, *impl->compliance);
    impl->pairs = skin_pairs(*base, impl->skin, impl->model, &off_bone);
  } else if (!has_far && !is_flat) {
    impl->pairs = skin_pairs(*base, impl->skin, impl->model);
  }
  impl->blocks = skin_patches(impl->skin, kBlockSize);
  impl->spots = skin_patches(impl->skin, kSpotSize);
  impl->coarse_skin =
      std::make_shared<const CoarseSkin>(coarse_skin(*base, impl->skin, impl->compliance.get()));
  impl->base = std::move(base);
  impl_ = std::move(impl);
}

HandFamily::~HandFamily() = default;
HandFamily::HandFamily(HandFamily&&) noexcept = default;
HandFamily& HandFamily::operator=(HandFamily&&) noexcept = default;

const hand::Hand& HandFamily::base() const { return *impl_->base; }
const ContactModel& HandFamily::model() const { return impl_->model; }

PreparedHand::PreparedHand(std::shared_ptr<const hand::Hand> hand, const ContactModel& model,
                           std::shared_ptr<const SkinCompliance> compliance,
                           const std::shared_ptr<const hand::Hand>& base) {
  if (!hand) throw UsageError("prepare hand: no hand was given");
  check_hand(*hand);
  check_model(model);
  check_size(*hand, model);
  auto impl = std::make_unique<Impl>();
  impl->model = completed(model);
  impl->skin = skin_geometry(hand->skin);
  impl->hand = std::move(hand);
  if (impl->model.tissue == TissueModel::kLayered) {
    impl->layer_thickness = effective_layer_thickness(*impl->hand, impl->skin);
  }
  if (impl->is_on_bone()) {
    impl->compliance = compliance_of(*impl->hand, impl->skin, std::move(compliance));
    auto volume = impl->compliance->volume;
    if (base && base != impl->hand) {
      check_alike(*impl->hand, *base);
      const SkinGeometry original = skin_geometry(base->skin);
      volume = scaled_volumes(volume, *impl->hand, original, impl->skin);
      impl->scale = length_ratios(original, impl->skin);
    }
    impl->bone = bone_tissue_blocks(*impl->hand, impl->skin, volume);
    impl->meetings.emplace(*impl->hand);
    const std::vector<int> off_bone = vertices_off_bone(impl->skin, *impl->compliance);
    impl->response =
        skin_response(*impl->hand, impl->skin, impl->model, impl->layer_thickness, &off_bone);
  } else {
    impl->response = skin_response(*impl->hand, impl->skin, impl->model, impl->layer_thickness);
  }
  impl->set_patches();
  impl_ = std::move(impl);
}

PreparedHand::PreparedHand(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}

void PreparedHand::Impl::set_patches() {
  blocks = skin_patches(skin, kBlockSize);
  stiffness = skin_stiffness(*hand, skin, response, skin_patches(skin, kSpotSize), blocks, model);
}

PreparedHand::PreparedHand(std::shared_ptr<const hand::Hand> hand, const HandFamily& family) {
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
  if (impl->is_on_bone()) {
    impl->compliance = shared.compliance;
    impl->bone = bone_tissue_blocks(
        *impl->hand, impl->skin,
        scaled_volumes(shared.compliance->volume, *impl->hand, shared.skin, impl->skin));
    impl->scale = length_ratios(shared.skin, impl->skin);
    impl->meetings.emplace(*impl->hand);
  }
  impl->response = shared.pairs
                       ? stretched_response(*impl->hand, impl->skin, impl->model,
                                            impl->layer_thickness, *shared.pairs)
                       : skin_response(*impl->hand, impl->skin, impl->model, impl->layer_thickness);
  impl->coarse_skin = shared.coarse_skin;
  impl->blocks = shared.blocks;
  impl->stiffness = skin_stiffness(*impl->hand, impl->skin, impl->response, shared.spots,
                                   impl->blocks, impl->model);
  impl_ = std::move(impl);
}

PreparedHand::~PreparedHand() = default;
PreparedHand::PreparedHand(PreparedHand&&) noexcept = default;
PreparedHand& PreparedHand::operator=(PreparedHand&&) noexcept = default;

const hand::Hand& PreparedHand::hand() const { return *impl_->hand; }
const ContactModel& PreparedHand::model() const { return impl_->model; }

const CoarseHand& PreparedHand::coarse() const {
  const Impl& impl = *impl_;
  std::call_once(impl.coarse->once, [&] {
    // Nothing else begins meanwhile on this thread, which might ask for it, too.
    run_isolated([&] {
      const CoarseSkin own = impl.coarse_skin
                                 ? CoarseSkin{}
                                 : coarse_skin(*impl.hand, impl.skin, impl.compliance.get());
      impl.coarse->hand = std::make_unique<const CoarseHand>(
          coarse_hand(impl, impl.coarse_skin ? *impl.coarse_skin : own));
    });
  });
  return *impl.coarse->hand;
}

}  // namespace palmar::contact
