// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/other_grip.h"

#include <algorithm>
#include <array>
#include <vector>

#include "palmar/core/parallel.h"
#include "palmar/grasp/precision/precision_shape.h"

namespace palmar::grasp {
namespace {

/// In the order in which they are tried among those with as many fingers.
constexpr std::array kOtherGrips = {
    Grip::kWritingTripod, Grip::kPalmarPinch,     Grip::kLateral,       Grip::kTipPinch,
    Grip::kTripod,        Grip::kPrecisionSphere, Grip::kPrecisionDisk, Grip::kPrismatic};

bool holds(const contact::PreparedHand& hand, const product::Product& product,
           const GraspOptions& options, const BalanceOptions& balance,
           const contact::ContactOptions& contact, const Progress& progress) {
  Grasp grasp = find_grasp(hand.hand(), product, options, progress);
  if (grasp.status != GraspStatus::kHeld) return false;
  if (!balance.is_on) return true;
  // One other place for each grip: what takes long to find is no advice.
  if (grasp.runners_up.size() > 1) grasp.runners_up.resize(1);
  return balance_grasp(hand, product, grasp, balance, contact, progress).status ==
         BalanceStatus::kBalanced;
}

}  // namespace

std::optional<Grip> other_grip_that_holds(const contact::PreparedHand& hand,
                                          const product::Product& product,
                                          const GraspOptions& asked, const BalanceOptions& balance,
                                          const contact::ContactOptions& contact,
                                          const Progress& progress) {
  const auto fingers = [&](Grip grip) {
    return static_cast<int>(fingertips_of(hand.hand(), grip).size());
  };
  const Grip first = asked.grip.value_or(Grip::kMediumWrap);
  std::vector<std::optional<Grip>> grips(kOtherGrips.begin(), kOtherGrips.end());
  std::stable_sort(grips.begin(), grips.end(), [&](const auto& a, const auto& b) {
    return std::abs(fingers(*a) - fingers(first)) < std::abs(fingers(*b) - fingers(first));
  });
  std::erase(grips, std::optional<Grip>(first));
  grips.emplace_back();  // the power grip that suits the shape
  Progress silent = progress;
  silent.report = nullptr;
  // As many at a time as there are threads; what comes first in the order counts.
  const auto wave = static_cast<std::size_t>(std::max(1, thread_count()));
  for (std::size_t begin = 0; begin < grips.size(); begin += wave) {
    const std::size_t count = std::min(wave, grips.size() - begin);
    std::vector<char> is_held(count, 0);
    parallel_for(count, [&](std::size_t i) {
      GraspOptions options = asked;
      options.grip = grips[begin + i];
      options.precision.targets.clear();
      options.power.placement = {};
      is_held[i] = holds(hand, product, options, balance, contact, silent) ? 1 : 0;
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (is_held[i] == 0) continue;
      if (grips[begin + i]) return grips[begin + i];
      GraspOptions options = asked;
      options.grip.reset();
      options.power.placement = {};
      return find_grasp(hand.hand(), product, options, silent).grip;
    }
  }
  return std::nullopt;
}

}  // namespace palmar::grasp
