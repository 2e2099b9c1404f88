// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/workflow/redesign/hold_offsets.h"
#include "palmar/workflow/redesign/redesign_comparison.h"

namespace palmar::workflow {

/// Mean change of a quantity from the original to a redesign, both held at the same place by the
/// same hands: shares of the original's mean, with the 95 % interval of the paired differences.
struct HoldGain {
  double change = 0.0, low = 0.0, high = 0.0;
  int hands = 0;  ///< that hold both; with fewer than 2 there is no interval
};

/// Gains where hands lie elsewhere than the hold says, and by the size of hands.
struct HoldGains {
  std::vector<study::StudyQuantity> quantities;
  struct AtOffset {
    double along = 0.0;           ///< mm towards the thumb's side
    std::vector<HoldGain> gains;  ///< by quantity
  };
  std::vector<AtOffset> offsets;  ///< ascending
  struct OfSize {
    double shortest = 0.0, longest = 0.0;  ///< hands, mm; 0 where lengths aren't known
    std::vector<HoldGain> gains;           ///< by quantity
  };
  std::vector<OfSize> sizes;  ///< thirds of the hands by their length, shortest first
};

/// The change over the hands in both of two lists of records, numbered in `plan` with products 0
/// and 1.
HoldGain gain_of(const study::StudyResults& results, const std::string& key,
                 const std::vector<int>& hands);

/// The offset along the handle at which the gain of a quantity is gone, in one direction (+1
/// towards the thumb, -1 away), between the offsets looked at; nothing if it is still there at the
/// last one, 0 if there is none at all.
std::optional<double> gone_at(const HoldGains& gains, std::size_t quantity, int direction);

/// Of the first redesign of a comparison, at offsets of up to 12 mm; there every second hand or
/// fewer, 15 at most, of those that judged. Throws Cancelled.
HoldGains hold_gains(const JudgingHands& judges, const product::Product& redesign,
                     const RedesignComparison& comparison, const Progress& progress);

std::string gains_text(const HoldGains& gains);
std::string gains_csv(const HoldGains& gains);
std::string gains_json(const HoldGains& gains);  ///< one JSON object
std::string gains_svg(const HoldGains& gains);

}  // namespace palmar::workflow
