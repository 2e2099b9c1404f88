// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace palmar::hand {

/// What a person's hand does in one scan (Xie 2014, fig. 2-6).
enum class ScanPosture {
  kReference,       ///< relaxed
  kThumbFlexion,    ///< the four limit postures of the thumb's CMC joint; MP and IP bend as well in
  kThumbExtension,  ///< flexion and stretch in extension
  kThumbAbduction,
  kThumbAdduction,
  kFingerFlexion,    ///< fingers II to V bent as far as they go
  kFingerAbduction,  ///< fingers II to V spread
  kGrasp,            ///< of a product
};
inline constexpr int kScanPostureCount = 8;

/// "reference", "thumb_flexion", ..., "finger_abduction", "grasp".
std::string_view name_of(ScanPosture posture);
/// The posture that a series' description names: upper case, blanks, hyphens don't matter.
std::optional<ScanPosture> scan_posture_in(std::string_view description);

}  // namespace palmar::hand
