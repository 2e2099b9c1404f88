// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/pressure_thresholds.h"

namespace palmar {

std::string_view name_of(PressureFamily family) {
  switch (family) {
    case PressureFamily::kFilm:
      return "film_peak";
    case PressureFamily::kAlgometer:
      return "algometer_mean";
    case PressureFamily::kBloodFlow:
      return "blood_flow";
  }
  return "film_peak";
}

double pain_onset_film(Region region) {
  switch (region) {
    case Region::kThenar:
    case Region::kDorsum:
      return 2.0;
    case Region::kHypothenar:
    case Region::kCentralPalm:
    case Region::kRadialPalm:
    case Region::kUlnarPalm:
      return 2.6;
    default:
      return 3.0;
  }
}

double discomfort_over_pain(Region region) {
  switch (region) {
    case Region::kThenar:
      return 0.22;
    case Region::kDorsum:
    case Region::kHypothenar:
    case Region::kCentralPalm:
    case Region::kRadialPalm:
    case Region::kUlnarPalm:
      return 0.40;
    default:
      return 0.38;
  }
}

}  // namespace palmar
