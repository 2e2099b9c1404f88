// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/skin_bed.h"

#include <cmath>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::grasp {
namespace {

constexpr double kBedRange = 15.0;  // mm; deeper skin counts as that deep

constexpr double kHard = 4.0;  // power with which it hardens towards the bone

struct Spring {
  double linear = 0.0, square = 0.0;  // MPa/mm, MPa/mm^2
  double depth = 0.0;                 // mm, at which the flesh over the bone is twice as hard
};
constexpr Spring kDistal{0.013, 0.013, 5.0}, kProximal{0.008, 0.003, 7.0},
    kPadSpring{0.011, 0.0, 10.0}, kPalm{0.0065, 0.0, 12.0}, kDorsum{0.02, 0.01, 3.0};

const Spring& spring_of(hand::Region region) {
  using hand::Region;
  switch (region) {
    case Region::kDorsum:
      return kDorsum;
    case Region::kThumbProximal:
    case Region::kIndexProximal:
    case Region::kMiddleProximal:
    case Region::kRingProximal:
    case Region::kLittleProximal:
      return kProximal;
    case Region::kRadialPalm:
    case Region::kUlnarPalm:
      return kPadSpring;
    case Region::kThenar:
    case Region::kHypothenar:
    case Region::kCentralPalm:
      return kPalm;
    default:
      return kDistal;
  }
}

}  // namespace

SkinBed::SkinBed(const hand::Hand& hand, const geometry::DistanceField& product)
    : hand_(&hand), product_(&product), area_(geometry::vertex_areas(hand.skin)) {}

const std::vector<SkinBed::Load>& SkinBed::look(const std::vector<Vec3>& skin) {
  if (sample_.empty()) {
    sample_.resize(skin.size());
    product_->sample(skin, kBedRange, sample_);
  } else {
    product_->resample(skin, kBedRange, sample_);
  }
  load_.clear();
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const double depth = -sample_[v].distance;
    if (!(depth > 0.0)) continue;
    const Spring& spring = spring_of(hand_->region[v]);
    const double soft = depth * (spring.linear + spring.square * depth);
    const double hard = std::pow(depth / spring.depth, kHard);
    load_.push_back(
        {.vertex = static_cast<int>(v),
         .depth = depth,
         .force = area_[v] * soft * (1.0 + hard),
         .stiffness = area_[v] * ((spring.linear + 2.0 * spring.square * depth) * (1.0 + hard) +
                                  soft * kHard * hard / depth),
         .normal = sample_[v].normal});
  }
  return load_;
}

}  // namespace palmar::grasp
