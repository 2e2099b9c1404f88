// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/skin_touch.h"

#include <algorithm>
#include <map>
#include <utility>

namespace palmar::contact {

std::vector<SkinOnSkin> skin_on_skin(const std::vector<SkinTouch>& touches,
                                     const std::vector<hand::Region>& skin_region,
                                     const std::vector<double>& area) {
  std::map<std::pair<hand::Region, hand::Region>, SkinOnSkin> by_pair;
  for (const SkinTouch& touch : touches) {
    const SkinMeeting& at = touch.meeting;
    const auto corner = std::max_element(at.weight.begin(), at.weight.end()) - at.weight.begin();
    const hand::Region region = skin_region[at.vertex];
    const hand::Region other = skin_region[at.on[static_cast<std::size_t>(corner)]];
    SkinOnSkin& both = by_pair[{region, other}];
    both.region = region;
    both.other = other;
    both.force += touch.force;
    both.force_vector += touch.force * at.normal;
    both.area += area[at.vertex];
    both.peak_pressure = std::max(both.peak_pressure, touch.force / area[at.vertex]);
    both.deepest = std::max(both.deepest, -at.distance);
  }
  std::vector<SkinOnSkin> result;
  for (const auto& [pair, both] : by_pair) result.push_back(both);
  return result;
}

}  // namespace palmar::contact
