// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/pressure_thresholds.h"

namespace palmar::grasp {

namespace {

/// Where the hand was measured: finger, palm, ball of the thumb.
enum class MeasuredSite { kFinger, kPalm, kThenar };

MeasuredSite place_of(hand::Region region) {
  switch (region) {
    case hand::Region::kThenar:
      return MeasuredSite::kThenar;
    case hand::Region::kDorsum:
    case hand::Region::kHypothenar:
    case hand::Region::kCentralPalm:
    case hand::Region::kRadialPalm:
    case hand::Region::kUlnarPalm:
      return MeasuredSite::kPalm;
    default:
      return MeasuredSite::kFinger;
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

double pain_onset_film(hand::Region region) {
  if (region == hand::Region::kDorsum) return 2.0;
  switch (place_of(region)) {
    case MeasuredSite::kThenar:
      return 2.0;
    case MeasuredSite::kPalm:
      return 2.6;
    case MeasuredSite::kFinger:
      break;
  }
  return 3.0;
}

double pain_onset_probe(hand::Region region) {
  switch (place_of(region)) {
    case MeasuredSite::kThenar:
      return 0.447;
    case MeasuredSite::kPalm:
      return 0.494;
    case MeasuredSite::kFinger:
      break;
  }
  return 0.496;
}

double discomfort_onset_probe(hand::Region region) {
  switch (place_of(region)) {
    case MeasuredSite::kThenar:
      return 0.100;
    case MeasuredSite::kPalm:
      return 0.200;
    case MeasuredSite::kFinger:
      break;
  }
  return 0.188;
}

}  // namespace palmar::grasp
