// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "palmar/hand/anatomy.h"

namespace palmar::hand {

/// The muscles of a digit by their usual abbreviations; one tendon each.
enum class Tendon : std::uint8_t {
  kFdp,  ///< flexor digitorum profundus
  kFds,  ///< flexor digitorum superficialis
  kEdc,  ///< extensor digitorum; of the index with extensor indicis, of the little finger with
         ///< extensor digiti minimi
  kLum,  ///< lumbrical
  kRi,   ///< interosseous of the radial side
  kUi,   ///< of the ulnar side; of the little finger the abductor digiti minimi
  kFpl,  ///< flexor pollicis longus
  kFpb,  ///< flexor pollicis brevis
  kApb,  ///< abductor pollicis brevis
  kOpp,  ///< opponens pollicis
  kAdp,  ///< adductor pollicis
  kEpl,  ///< extensor pollicis longus
  kEpb,  ///< extensor pollicis brevis
  kApl,  ///< abductor pollicis longus
};

/// The six of a finger or the eight of the thumb, in the order above.
std::span<const Tendon> tendons_of(Finger finger);

std::string_view name_of(Tendon tendon);             ///< "fdp", as on the command line
std::string_view anatomical_name_of(Tendon tendon);  ///< "flexor digitorum profundus"
std::optional<Tendon> tendon_named(std::string_view name);

/// Physiological cross-section, mm^2: Lieber et al. 1992 (J Hand Surg 17A:787-798; extrinsic
/// muscles of the fingers, EPL, FPL) and Jacobson et al. 1992 (J Hand Surg 17A:804-809; intrinsic
/// muscles, APL, EPB); cadavers of adults. Throws Error for a tendon that is not of that digit.
double cross_section_of(Finger finger, Tendon tendon);

/// Largest force per cross-section of a muscle, MPa: 45 N/cm^2 (Holzbaur et al. 2005); 22 to 45
/// N/cm^2 are in use.
constexpr double kSpecificTension = 0.45;

}  // namespace palmar::hand
