// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/marker_set.h"

#include "palmar/hand/skin/landmarks.h"

namespace palmar::hand {

const std::vector<DorsalMarker>& dorsal_markers() {
  static const std::vector<DorsalMarker> kMarkers = {
      {"radial_styloid", "forearm, thumb side"},
      {"ulnar_styloid", "forearm, little finger's side"},
      {"third_metacarpal_base", "back of the hand, near the wrist"},
      {"fifth_metacarpal_base", "back of the hand, near the wrist"},
      {"first_metacarpal_base", "over the thumb's CMC joint"},
      {"first_metacarpal_middle", "back of the thumb's metacarpal"},
      {"thumb_mp_dorsal", "over the joint"},
      {"thumb_ip_dorsal", "over the joint"},
      {"thumb_nail", "on the nail"},
      {"index_mcp_dorsal", "knuckle"},
      {"index_pip_dorsal", "over the joint"},
      {"index_dip_dorsal", "over the joint"},
      {"index_nail", "on the nail"},
      {"middle_mcp_dorsal", "knuckle"},
      {"middle_pip_dorsal", "over the joint"},
      {"middle_dip_dorsal", "over the joint"},
      {"middle_nail", "on the nail"},
      {"ring_mcp_dorsal", "knuckle"},
      {"ring_pip_dorsal", "over the joint"},
      {"ring_dip_dorsal", "over the joint"},
      {"ring_nail", "on the nail"},
      {"little_mcp_dorsal", "knuckle"},
      {"little_pip_dorsal", "over the joint"},
      {"little_dip_dorsal", "over the joint"},
      {"little_nail", "on the nail"},
  };
  return kMarkers;
}

MarkerSet dorsal_marker_set(const Hand& hand, double height) {
  const Landmarks landmarks(hand);
  MarkerSet set;
  set.name = "dorsal";
  for (const DorsalMarker& marker : dorsal_markers()) {
    set.label.emplace_back(marker.label);
    set.point.push_back(landmarks.at(marker.label, height));
  }
  return set;
}

}  // namespace palmar::hand
