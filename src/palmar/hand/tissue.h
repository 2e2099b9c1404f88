// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/hand.h"

namespace palmar {

/// The two mechanical classes of palmar skin. Each phalangeal region is `finger`; thenar,
/// hypothenar, central palm and the two pads below the fingers are `palm`.
///
/// From Xie 2014 as restated in METHOD.md section 2. A figure given there as a range is taken at
/// its middle:
///
///     d_lim            4 mm (finger), 7 mm (palm)
///     G0               5 kPa (finger), 5-50 kPa (palm: 27.5)
///     G_lim            70-120 kPa (finger: 95), 40-80 kPa (palm: 60)
///     swelling a0, b   2, 8 mm (finger), 3, 15 mm (palm)            Table 3-2
///     swelling c       3 mm (palm, fig. 3-9); the finger's is lost: 2 mm is our choice
///     neighbourhood    12.5 mm (finger), 17.5 mm (palm)             5 and 7 rings of 2.5 mm
RegionTissue finger_tissue();
RegionTissue palm_tissue();

/// The dorsum, which the thesis leaves out: `finger`, because like there a thin layer lies on bone
/// or tendon, so that it stiffens within a few millimetres. No measurement stands behind it.
RegionTissue dorsum_tissue();

}  // namespace palmar
