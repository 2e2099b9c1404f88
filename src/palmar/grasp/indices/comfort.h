// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/grasp/pressure_thresholds.h"

namespace palmar {

/// One region's pressure against the thresholds of one family. MPa.
struct RegionComfort {
  Region region{};
  // Film family: the largest mean over a sensor cell, which is what a film resolves.
  double peak_pressure = 0.0;
  double film_discomfort = 0.0, film_pain = 0.0;
  // Algometer family: the mean over the region's contact.
  double mean_pressure = 0.0;
  double algometer_discomfort = 0.0, algometer_pain = 0.0;  ///< of the lower pain onset, 0.1 MPa
  double area = 0.0;                                        ///< in contact, mm^2
  double sustained_area = 0.0;                              ///< of it above kBloodFlowStop, mm^2
  double film_share() const { return film_pain > 0.0 ? peak_pressure / film_pain : 0.0; }
  double algometer_share() const {
    return algometer_pain > 0.0 ? mean_pressure / algometer_pain : 0.0;
  }
};

/// Pressure on the skin against what people bear, one family of thresholds at a time; nothing here
/// adds families up or compares them.
struct ComfortResult {
  std::vector<RegionComfort> regions;  ///< in contact, ascending
  double area = 0.0;                   ///< in contact, mm^2
  double sustained_area = 0.0;         ///< above kBloodFlowStop, mm^2
  // Shares of the contact area, 0 to 1.
  double sustained_share = 0.0;
  double film_discomfort_share = 0.0;  ///< vertex pressure above the film family's discomfort
  double film_pain_share = 0.0;
  double algometer_discomfort_share = 0.0;  ///< in regions whose mean is above discomfort
  double algometer_pain_share = 0.0;
  /// Places in `regions`; nothing without contact.
  std::optional<std::size_t> most_at_risk_film, most_at_risk_algometer;
};

ComfortResult assess_comfort(const Hand& hand, const ContactResult& contact);

/// Rows of the group "comfort"; the family stands in key and name.
GraspIndices to_indices(const ComfortResult& result);

}  // namespace palmar
