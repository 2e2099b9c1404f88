// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue.h"

namespace palmar {

RegionTissue finger_tissue() {
  return {.half_space = {.nominal = {0.005, 0.095, 4.0},
                         .low = {0.005, 0.070, 4.0},
                         .high = {0.005, 0.120, 4.0}},
          .layered = {.nominal = {0.010, 0.010, 4.0},
                      .low = {0.007, 0.007, 4.0},
                      .high = {0.014, 0.014, 4.0}},
          .swelling_height = 2.0,
          .swelling_radius = 8.0,
          .swelling_width = 2.0,
          .neighbourhood = 12.5};
}

RegionTissue palm_tissue() {
  return {.half_space = {.nominal = {0.0275, 0.060, 7.0},
                         .low = {0.005, 0.040, 7.0},
                         .high = {0.050, 0.080, 7.0}},
          .layered = {.nominal = {0.010, 0.010, 7.0},
                      .low = {0.007, 0.007, 7.0},
                      .high = {0.014, 0.014, 7.0}},
          .swelling_height = 3.0,
          .swelling_radius = 15.0,
          .swelling_width = 3.0,
          .neighbourhood = 17.5};
}

RegionTissue dorsum_tissue() { return finger_tissue(); }

Tissue default_tissue() {
  Tissue tissue;
  tissue.region.fill(finger_tissue());
  tissue.region[static_cast<std::size_t>(Region::kDorsum)] = dorsum_tissue();
  for (const Region palmar : {Region::kThenar, Region::kHypothenar, Region::kCentralPalm,
                              Region::kRadialPalm, Region::kUlnarPalm}) {
    tissue.region[static_cast<std::size_t>(palmar)] = palm_tissue();
  }
  tissue.source =
      "Xie 2014, eq. 3-3, Table 3-2, fig. 3-9; middle of the ranges given for G0 and G_lim; "
      "swelling width of the fingers (2 mm) and the dorsum (as the fingers) assumed";
  return tissue;
}

}  // namespace palmar
