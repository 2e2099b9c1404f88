// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/anatomy.h"

#include <cstddef>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

constexpr std::array<std::string_view, kFingerCount> kFingerNames = {"thumb", "index", "middle",
                                                                     "ring", "little"};

constexpr std::array<std::string_view, kSegmentCount> kSegmentNames = {
    "palm",         "thumb_proximal",  "thumb_distal",    "index_proximal", "index_middle",
    "index_distal", "middle_proximal", "middle_middle",   "middle_distal",  "ring_proximal",
    "ring_middle",  "ring_distal",     "little_proximal", "little_middle",  "little_distal"};

constexpr std::array<std::string_view, kRegionCount> kRegionNames = {
    "dorsum",       "thumb_proximal",  "thumb_distal",    "index_proximal", "index_middle",
    "index_distal", "middle_proximal", "middle_middle",   "middle_distal",  "ring_proximal",
    "ring_middle",  "ring_distal",     "little_proximal", "little_middle",  "little_distal",
    "thenar",       "hypothenar",      "central_palm",    "radial_palm",    "ulnar_palm"};

constexpr std::array<std::string_view, kDofCount> kDofNames = {
    "wrist_flexion",        "wrist_deviation",    "wrist_pronation",    "thumb_cmc_flexion",
    "thumb_cmc_abduction",  "thumb_mp_flexion",   "thumb_ip_flexion",   "index_mcp_flexion",
    "index_mcp_abduction",  "index_pip_flexion",  "index_dip_flexion",  "middle_mcp_flexion",
    "middle_mcp_abduction", "middle_pip_flexion", "middle_dip_flexion", "ring_mcp_flexion",
    "ring_mcp_abduction",   "ring_pip_flexion",   "ring_dip_flexion",   "little_mcp_flexion",
    "little_mcp_abduction", "little_pip_flexion", "little_dip_flexion"};

constexpr std::array<std::string_view, kJointCount> kJointNames = {
    "wrist",     "thumb_cmc",  "thumb_mp",   "thumb_ip",   "index_mcp", "index_pip",
    "index_dip", "middle_mcp", "middle_pip", "middle_dip", "ring_mcp",  "ring_pip",
    "ring_dip",  "little_mcp", "little_pip", "little_dip"};

constexpr std::array<std::string_view, 2> kSideNames = {"right", "left"};

template <class Value, std::size_t N>
std::optional<Value> value_named(const std::array<std::string_view, N>& names,
                                 std::string_view name) {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == name) return static_cast<Value>(i);
  }
  return std::nullopt;
}

template <class Value, std::size_t N>
std::string_view name_in(const std::array<std::string_view, N>& names, Value value) {
  return names.at(index_of(value));
}

}  // namespace

std::string_view name_of(Finger finger) { return name_in(kFingerNames, finger); }
std::string_view name_of(Segment segment) { return name_in(kSegmentNames, segment); }
std::string_view name_of(Region region) { return name_in(kRegionNames, region); }
std::string_view name_of(Dof dof) { return name_in(kDofNames, dof); }
std::string_view name_of(JointId joint) { return name_in(kJointNames, joint); }
std::string_view name_of(Side side) { return name_in(kSideNames, side); }

std::optional<Finger> finger_named(std::string_view name) {
  return value_named<Finger>(kFingerNames, name);
}
std::optional<Segment> segment_named(std::string_view name) {
  return value_named<Segment>(kSegmentNames, name);
}
std::optional<Region> region_named(std::string_view name) {
  return value_named<Region>(kRegionNames, name);
}
std::optional<Dof> dof_named(std::string_view name) { return value_named<Dof>(kDofNames, name); }
std::optional<JointId> joint_named(std::string_view name) {
  return value_named<JointId>(kJointNames, name);
}

std::optional<Finger> finger_of(Segment segment) {
  const int i = static_cast<int>(segment);
  if (i == 0) return std::nullopt;
  return i <= 2 ? Finger::kThumb : static_cast<Finger>(1 + (i - 3) / 3);
}

std::optional<Region> region_of(Segment phalanx) {
  if (phalanx == Segment::kPalm) return std::nullopt;
  return static_cast<Region>(phalanx);  // the phalanges stand in the same order in both
}

std::optional<Segment> segment_of(Region region) {
  if (region == Region::kDorsum) return std::nullopt;
  if (region >= Region::kThenar) return Segment::kPalm;
  return static_cast<Segment>(region);
}

std::array<std::optional<Segment>, 3> segments_of(Finger finger) {
  if (finger == Finger::kThumb) {
    return {Segment::kThumbProximal, Segment::kThumbDistal, std::nullopt};
  }
  const int first = 3 * static_cast<int>(finger);
  return {static_cast<Segment>(first), static_cast<Segment>(first + 1),
          static_cast<Segment>(first + 2)};
}

JointId joint_of(Segment phalanx) {
  const int i = static_cast<int>(phalanx);
  // After the wrist and the thumb's CMC the joints stand in the order of the phalanges.
  return i == 0 ? JointId::kWrist : static_cast<JointId>(i + 1);
}

}  // namespace palmar::hand
