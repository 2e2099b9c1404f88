// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/hand/hand.h"
#include "palmar/hand/tendons/tendon.h"
#include "palmar/hand/tendons/tendon_path.h"

namespace palmar::hand {

/// What share of a muscle's force the extensor hood hands on to the central slip (ES) and to the
/// radial and ulnar lateral bands (RB, UB); the rest pulls at the proximal phalanx.
struct HoodShare {
  double central = 0.0, radial = 0.0, ulnar = 0.0;
};

/// Distribution of the extensor hood: ES is the sum of the central shares, RB and UB likewise, and
/// the terminal tendon TE = RB + UB (An et al. 1979). Default: identified by Synek et al. 2019
/// (PeerJ 7:e7470) from forces at the tips of three middle fingers of cadavers; half of the radial
/// interosseous ends at the bone. The shares are the same in every posture; in cadavers the slips
/// get less of the extensor's force the more the finger is bent (Lee et al. 2008, J Biomech Eng
/// 130:051014).
struct ExtensorHood {
  HoodShare edc{0.4945, 0.25275, 0.25275};
  HoodShare lumbrical{0.3795, 0.6205, 0.0};
  HoodShare radial_interosseous{0.1814, 0.3186, 0.0};
  HoodShare ulnar_interosseous{0.3812, 0.0, 0.6188};
  void check() const;  ///< throws UsageError: each share 0 to 1, each muscle's sum at most 1
};

/// The coefficients of Chao et al. 1989 (Biomechanics of the hand): ES = 0.133 RI + 0.313 UI +
/// 0.167 EDC + 0.333 LU, RB = 0.133 RI + 0.167 EDC + 0.667 LU, UB = 0.313 UI + 0.167 EDC.
ExtensorHood chao1989_hood();

/// Where the tendons of a finger are held beside its joints.
enum class FingerPoints {
  kSynek2019,  ///< An et al. 1979, calibrated by forces at the fingertips of three cadavers
  kAn1979      ///< as measured by An et al. 1979
};

struct TendonModel {
  FingerPoints points = FingerPoints::kSynek2019;
  ExtensorHood hood{};
};

/// The tendons of one digit on the joints of one hand, in the order of tendons_of(finger).
struct DigitTendons {
  Finger finger = Finger::kIndex;
  std::vector<TendonPath> path;
};

/// Fingers: points of the middle finger (An et al. 1979, J Biomech 12:775-788; calibrated by Synek
/// et al. 2019), scaled by the hand's own distance of DIP and PIP of the middle finger, and from
/// finger to finger by the width of the phalanges. Flexors and extensors lie on a cylinder about
/// the flexion axis where a straight line would come nearer to it than in the straight finger
/// (Landsmeer's first model); lateral bands, lumbrical and interossei run straight.
///
/// Thumb: points of Mirakhorlo et al. 2016 (Int Biomech 3:40-49; one hand), in frames of its bones
/// scaled to the hand's own bones; long extensors and the long flexor on the cylinders fitted there
/// to the MP and IP joints. Points on the forearm are held to the palm: the wrist's posture changes
/// nothing.
DigitTendons route_tendons(const Hand& hand, Finger finger, const TendonModel& model = {});

/// Row t, column k: moment arm of the t-th tendon about the k-th angle of the digit, mm.
std::vector<std::array<double, kDigitDofs>> moment_arms(const DigitTendons& tendons,
                                                        const PosedDigit& digit);

}  // namespace palmar::hand
