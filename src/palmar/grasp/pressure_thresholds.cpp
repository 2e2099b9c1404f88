// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/pressure_thresholds.h"

namespace palmar {

namespace {

/// Where the hand was measured: finger, palm, ball of the thumb.
enum class Place { kFinger, kPalm, kThenar };

Place place_of(Region region) {
  switch (region) {
    case Region::kThenar:
      return Place::kThenar;
    case Region::kDorsum:
    case Region::kHypothenar:
    case Region::kCentralPalm:
    case Region::kRadialPalm:
    case Region::kUlnarPalm:
      return Place::kPalm;
    default:
      return Place::kFinger;
  }
}

}  // namespace

std::string_view name_of(PressureFamily family) {
  switch (family) {
    case PressureFamily::kProbe:
      return "probe";
    case PressureFamily::kBloodFlow:
      return "blood_flow";
    case PressureFamily::kFilm:
      break;
  }
  return "film_peak";
}

double pain_onset_film(Region region) {
  if (region == Region::kDorsum) return 2.0;
  switch (place_of(region)) {
    case Place::kThenar:
      return 2.0;
    case Place::kPalm:
      return 2.6;
    case Place::kFinger:
      break;
  }
  return 3.0;
}

double pain_onset_probe(Region region) {
  switch (place_of(region)) {
    case Place::kThenar:
      return 0.447;
    case Place::kPalm:
      return 0.494;
    case Place::kFinger:
      break;
  }
  return 0.496;
}

double discomfort_onset_probe(Region region) {
  switch (place_of(region)) {
    case Place::kThenar:
      return 0.100;
    case Place::kPalm:
      return 0.200;
    case Place::kFinger:
      break;
  }
  return 0.188;
}

}  // namespace palmar
