// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/effort/tendon.h"
#include "palmar/effort/tendon_path.h"
#include "palmar/hand/hand.h"

namespace palmar {

/// What share of a muscle's force the extensor hood hands on to the central slip (ES) and to the
/// radial and ulnar lateral bands (RB, UB); the rest pulls at the proximal phalanx.
struct HoodShare {
  double central = 0.0, radial = 0.0, ulnar = 0.0;
};

/// Distribution of the extensor hood: ES = sum of the central shares, RB, UB likewise, and the
/// terminal tendon TE = RB + UB (An et al. 1979). Default: the coefficients of Chao et al. 1989
/// (Biomechanics of the hand, World Scientific), ES = 0.133 RI + 0.313 UI + 0.167 EDC + 0.333 LU,
/// RB = 0.133 RI + 0.167 EDC + 0.667 LU, UB = 0.313 UI + 0.167 EDC. Measured in cadavers the
/// terminal slip gets 1.7 times what the central one gets of the EDC (Lee et al. 2008, J Biomech
/// Eng 130:051014); here twice.
struct ExtensorHood {
  HoodShare edc{0.167, 0.167, 0.167};
  HoodShare lumbrical{0.333, 0.667, 0.0};
  HoodShare radial_interosseous{0.133, 0.133, 0.0};
  HoodShare ulnar_interosseous{0.313, 0.0, 0.313};
  void check() const;  ///< throws UsageError: each share 0 to 1, each muscle's sum at most 1
};

/// The tendons of one digit on the joints of one hand, in the order of tendons_of(finger).
struct DigitTendons {
  Finger finger = Finger::kIndex;
  std::vector<TendonPath> path;
};

/// Fingers: points of An et al. 1979 (J Biomech 12:775-788; middle finger, as tabulated by Synek et
/// al. 2019, PeerJ 7:e7470), scaled by the hand's own distance of DIP and PIP of the middle finger,
/// and from finger to finger by the width of the phalanges. Flexors and extensors lie on a cylinder
/// about the flexion axis where a straight line would come nearer to it than in the straight finger
/// (Landsmeer's first model); lateral bands, lumbrical and interossei run straight.
///
/// Thumb: points of Mirakhorlo et al. 2016 (Int Biomech 3:40-49; one hand), in frames of its bones
/// scaled to the hand's own bones; long extensors and the long flexor on the cylinders fitted there
/// to the MP and IP joints. Points on the forearm are held to the palm: the wrist's posture changes
/// nothing.
DigitTendons route_tendons(const Hand& hand, Finger finger, const ExtensorHood& hood = {});

/// Row t, column k: moment arm of the t-th tendon about the k-th angle of the digit, mm.
std::vector<std::array<double, kDigitDofs>> moment_arms(const DigitTendons& tendons,
                                                        const PosedDigit& digit);

}  // namespace palmar
