// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/pair_response.h"

#include <algorithm>

#include "palmar/contact/response/response.h"
#include "palmar/contact/response/skin_response.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

/// 1 up to two thirds of the reach, 0 beyond it.
double fade(double distance) {
  const double t = std::clamp(3.0 * (1.0 - distance / kResponseReach), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

PairResponse::PairResponse(const hand::Hand& hand, const SkinGeometry& skin,
                           const ContactModel& model, const std::vector<double>& thickness)
    : skin_(&skin), model_(model), thickness_(&thickness) {
  if (model.tissue != TissueModel::kLayered) return;
  for (const hand::Region region : hand.region) {
    kernel_.push_back(&layer_kernel(hand.tissue.region[index_of(region)].poisson_layered));
  }
}

float PairResponse::operator()(int i, int j, double r) const {
  const double a_i = skin_->radius[i];
  const double a_j = skin_->radius[j];
  const double weight = model_.coupling == RegionCoupling::kCoupled ? fade(r) : 1.0;
  if (model_.tissue != TissueModel::kLayered) {
    return static_cast<float>(weight * boussinesq_response(model_.kernel, r, a_i, a_j));
  }
  const double h = 0.5 * ((*thickness_)[i] + (*thickness_)[j]);
  return static_cast<float>(
      0.25 * weight *
      (layered_response(*kernel_[i], r, a_i, h) + layered_response(*kernel_[i], r, a_j, h) +
       layered_response(*kernel_[j], r, a_i, h) + layered_response(*kernel_[j], r, a_j, h)));
}

}  // namespace palmar::contact
