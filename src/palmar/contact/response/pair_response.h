// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/response/layered_response.h"
#include "palmar/contact/response/skin_geometry.h"

namespace palmar::contact {

/// Normal displacement times shear modulus at vertex i of a skin under a unit force at vertex j,
/// r [mm] away on the skin, 1/mm; symmetric in i and j. All arguments must outlive it.
class PairResponse {
 public:
  PairResponse(const hand::Hand& hand, const SkinGeometry& skin, const ContactModel& model,
               const std::vector<double>& thickness);
  float operator()(int i, int j, double r) const;

 private:
  const SkinGeometry* skin_;
  ContactModel model_;
  const std::vector<double>* thickness_;
  std::vector<const LayerKernel*> kernel_;  // per vertex
};

}  // namespace palmar::contact
