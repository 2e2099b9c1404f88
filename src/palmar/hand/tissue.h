// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// The mechanical classes of skin. Each phalangeal region is `finger`; thenar, hypothenar, central
/// palm and the two pads below the fingers are `palm`.
enum class TissueClass { kFinger, kPalm, kDorsum };
inline constexpr int kTissueClassCount = 3;

TissueClass tissue_class_of(Region region);
std::string_view name_of(TissueClass tissue);  ///< "finger", "palm", "dorsum"
std::optional<TissueClass> tissue_class_named(std::string_view name);

/// Half-space: Xie 2014, section 3.4 (docs/method/contact.md). A figure given there as a range is
/// nominal at its middle, low and high at its ends:
///
///     d_lim            4 mm (finger), 7 mm (palm)
///     G0               5 kPa (finger), 5-50 kPa (palm: 27.5)
///     G_lim            70-120 kPa (finger: 95), 40-80 kPa (palm: 60)
///     swelling a0, b   2, 8 mm (finger), 3, 15 mm (palm)            Table 3-2
///     swelling c       3 mm (palm, fig. 3-9); the finger's is lost: 2 mm is our choice
///     neighbourhood    12.5 mm (finger), 17.5 mm (palm)             5 and 7 rings of 2.5 mm
///
/// Layered: fitted to the forces that those half-spaces give, with bone under the skin
/// (docs/using/tissue.md says how).
RegionTissue finger_tissue();
RegionTissue palm_tissue();

/// The dorsum, which the thesis leaves out: `finger`, because like there a thin layer lies on bone
/// or tendon, so that it stiffens within a few millimetres. No measurement stands behind it.
RegionTissue dorsum_tissue();

RegionTissue tissue_of(TissueClass tissue);

/// Allowed: moduli in MPa, lengths in mm.
inline constexpr double kMinShearModulus = 1e-6, kMaxShearModulus = 10.0;
inline constexpr double kMaxTissueLength = 100.0;
inline constexpr double kMostBoneStiffening = 1000.0;

/// What is wrong with a set, naming the value with its unit and what is allowed; empty if nothing
/// is: finite numbers within the limits above, G_lim not below G0, low not above nominal and
/// nominal not above high (G0 and G_lim), Poisson's ratio 0 to 0.5.
std::string fault_of(const RegionTissue& tissue);

}  // namespace palmar::hand
