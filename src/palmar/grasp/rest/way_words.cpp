// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/way_words.h"

#include <array>
#include <cmath>

namespace palmar::grasp {

std::string way_words(const hand::Hand& hand, Vec3 way) {
  if (hand.side == hand::Side::kLeft) way.x() = -way.x();
  int most = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::abs(way[c]) > std::abs(way[most])) most = c;
  }
  static constexpr std::array<const char*, 6> kWords = {
      "the thumb's side", "the little finger's side",  "the fingertips",
      "the wrist",        "the open side of the palm", "the palm"};
  return kWords[static_cast<std::size_t>(2 * most + (way[most] < 0.0 ? 1 : 0))];
}

}  // namespace palmar::grasp
