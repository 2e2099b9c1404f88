// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace palmar::hand {

enum class Finger : std::uint8_t { kThumb, kIndex, kMiddle, kRing, kLittle };
inline constexpr int kFingerCount = 5;

/// The 15 segments whose size varies (Xie 2014, fig. 5-5): the palm (with wrist and thumb
/// metacarpal) and 14 phalanges.
enum class Segment : std::uint8_t {
  kPalm,
  kThumbProximal,
  kThumbDistal,
  kIndexProximal,
  kIndexMiddle,
  kIndexDistal,
  kMiddleProximal,
  kMiddleMiddle,
  kMiddleDistal,
  kRingProximal,
  kRingMiddle,
  kRingDistal,
  kLittleProximal,
  kLittleMiddle,
  kLittleDistal,
};
inline constexpr int kSegmentCount = 15;

/// The 19 contact regions, bounded by the main creases, after the dorsum (region 0).
/// kThumbProximal ... kLittleDistal stand in the same order as in Segment.
enum class Region : std::uint8_t {
  kDorsum,
  kThumbProximal,
  kThumbDistal,
  kIndexProximal,
  kIndexMiddle,
  kIndexDistal,
  kMiddleProximal,
  kMiddleMiddle,
  kMiddleDistal,
  kRingProximal,
  kRingMiddle,
  kRingDistal,
  kLittleProximal,
  kLittleMiddle,
  kLittleDistal,
  kThenar,
  kHypothenar,
  kCentralPalm,
  kRadialPalm,  ///< pad below index and middle finger
  kUlnarPalm,   ///< pad below ring and little finger
};
inline constexpr int kRegionCount = 20;  ///< dorsum included

/// The 23 degrees of freedom. Angles are anatomical, rad: 0 = straight finger in line with its
/// metacarpal; flexion and abduction positive; finger abduction positive towards the thumb side
/// (radial deviation). Wrist: flexion, radial deviation, pronation of the hand against the forearm.
enum class Dof : std::uint8_t {
  kWristFlexion,
  kWristDeviation,
  kWristPronation,
  kThumbCmcFlexion,
  kThumbCmcAbduction,
  kThumbMpFlexion,
  kThumbIpFlexion,
  kIndexMcpFlexion,
  kIndexMcpAbduction,
  kIndexPipFlexion,
  kIndexDipFlexion,
  kMiddleMcpFlexion,
  kMiddleMcpAbduction,
  kMiddlePipFlexion,
  kMiddleDipFlexion,
  kRingMcpFlexion,
  kRingMcpAbduction,
  kRingPipFlexion,
  kRingDipFlexion,
  kLittleMcpFlexion,
  kLittleMcpAbduction,
  kLittlePipFlexion,
  kLittleDipFlexion,
};
inline constexpr int kDofCount = 23;

/// The 16 joints: wrist; thumb CMC, MP, IP; MCP, PIP, DIP of each finger.
enum class JointId : std::uint8_t {
  kWrist,
  kThumbCmc,
  kThumbMp,
  kThumbIp,
  kIndexMcp,
  kIndexPip,
  kIndexDip,
  kMiddleMcp,
  kMiddlePip,
  kMiddleDip,
  kRingMcp,
  kRingPip,
  kRingDip,
  kLittleMcp,
  kLittlePip,
  kLittleDip,
};
inline constexpr int kJointCount = 16;

enum class Side : std::uint8_t { kRight, kLeft };

/// Names as in files and tables: "thumb", "index_distal", "central_palm", "index_pip_flexion",
/// "thumb_cmc", "right".
std::string_view name_of(Finger finger);
std::string_view name_of(Segment segment);
std::string_view name_of(Region region);
std::string_view name_of(Dof dof);
std::string_view name_of(JointId joint);
std::string_view name_of(Side side);

/// The value with that name, or nothing.
std::optional<Finger> finger_named(std::string_view name);
std::optional<Segment> segment_named(std::string_view name);
std::optional<Region> region_named(std::string_view name);
std::optional<Dof> dof_named(std::string_view name);
std::optional<JointId> joint_named(std::string_view name);

/// Finger of a phalanx; nothing for the palm.
std::optional<Finger> finger_of(Segment segment);
/// Region of the palmar skin of a phalanx; nothing for the palm.
std::optional<Region> region_of(Segment phalanx);
/// Segment that a region lies on; the palm for thenar ... ulnar palm, nothing for the dorsum.
std::optional<Segment> segment_of(Region region);
/// The segments of one finger from proximal to distal (2 for the thumb, else 3).
std::array<std::optional<Segment>, 3> segments_of(Finger finger);
/// The joint that moves a phalanx against the next more proximal one (index_proximal -> index_mcp,
/// thumb_proximal -> thumb_mp).
JointId joint_of(Segment phalanx);

}  // namespace palmar::hand
