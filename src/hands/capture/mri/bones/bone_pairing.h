// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/mri/bones/bone_outline.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// What may be a bone of the model: a region of bright tissue, or two or three in a row, as a shaft
/// leaves whose marrow is too thin to be seen.
struct BoneHypotheses {
  std::vector<MarrowRegion> regions;
  std::vector<BoneOutline> outlines;
  std::vector<double> cost;  ///< what speaks against marrow: no dark shell, or one that is open;
                             ///< bent round something, as fat is
  int single = 0;            ///< the first of them are one region each
};
/// `longest`: no bone is longer, mm.
BoneHypotheses bone_hypotheses(const std::vector<MarrowRegion>& candidates,
                               const ScanLevels& levels, double longest);

struct BonePairing {
  std::vector<MarrowRegion> regions;  ///< hypotheses, then what was joined beyond them
  std::vector<char> is_used;          ///< of single regions: wholly or in part
  std::vector<int> found;             ///< per bone of the model: one of `regions`, or -1
  std::vector<BoneOutline> expected;  ///< the same
  double cost = 0.0;                  ///< of pairs and neighbours, over the model's bones
};

/// Pairs the model's bones with hypotheses, at least cost in all. A pair costs what the region's
/// marrow does and the squares of: the distance of centres over 5 mm, the angle between the axes of
/// long bones over 0.35 rad, the logarithms of the ratios of lengths and of widths over 0.3; for a
/// last phalanx also of the tissue beyond it over 2.5 mm from the usual 4.6 mm. A bone that isn't
/// found costs 16 (4 standard deviations), one of the forearm 4, as images often end before it.
/// `expected`: where
/// the model's bones roughly are, one or more guesses; the one that costs least is taken.
///
/// 1. Least-cost pairs, no region used twice (Kuhn 1955).
/// 2. Along each finger, with what lies between neighbours: marrow of two bones is about 4 mm
///    apart; parts of one shaft are nearer, and something is missing between bones farther apart.
///    Best chain by dynamic programming (Viterbi 1967).
/// 3. Bones know better than the skin where their neighbours are: those expected are moved by what
///    the pairs and those of their neighbours were off; 1 and 2 are repeated.
/// 4. Regions without a name are joined to a bone in the same row if that lowers its cost by 1.
BonePairing pair_bones(const BoneHypotheses& hypotheses, const ScanLevels& levels,
                       const geometry::TriangleMesh& skin, const hand::Hand& model,
                       const std::vector<std::vector<BoneOutline>>& expected);

}  // namespace palmar::capture
