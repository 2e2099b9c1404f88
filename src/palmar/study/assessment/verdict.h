// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/grasp/indices/comfort.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::study {

// What an assessment comes to, in figures; report/words says it.

/// How strong one has to be for a grip: what its muscles say (Balance::strength_use), the one model
/// of strength. What people reach on a dynamometer (Steiber 2016), in pinches what they reach in
/// them (Mathiowetz et al. 1985), stands beside it for comparison only.
struct StrengthUse {
  double grip_force = 0.0;  ///< N
  /// Of the strength of the muscles of these people; nothing where no strength holds it, and for
  /// pinches, which the muscles don't judge.
  std::optional<double> share;
  bool is_judged = false;    ///< by muscles
  bool is_by_wrist = false;  ///< the wrist's muscles need it; else the digits'
  double reached = 0.0;      ///< N, on a dynamometer or in such a pinch
  bool is_pinch = false;     ///< what is reached is that of a pinch
  std::string whose;         ///< "women and men of 45 years (mean; Steiber 2016)"; may be empty
  double compared() const { return reached > 0.0 ? grip_force / reached : 0.0; }
};

/// Where the skin presses hardest, and on what.
struct HardestPlace {
  hand::Region region{};
  double pressure = 0.0;           ///< MPa, on a sensor cell
  std::optional<Vec3> on_product;  ///< mm, product frame: the footprint's peak
  std::optional<int> face;         ///< index into Product::faces of the face with that peak
};

enum class HeldVerdict {
  kHeld,      ///< at rest, with all that its grip needs; or as it was closed, if nothing was asked
  kRests,     ///< as well, but the hand only lies on it: it couldn't be carried so
  kPushes,    ///< as well, but a finger only presses on it
  kDoubtful,  ///< in the hand, but doubts_of() has something against it
  kNotHeld
};
std::string_view name_of(HeldVerdict verdict);  ///< "held", "rests", "pushes", "doubtful", ...
/// Whether it is in the hand as its grip has it, with nothing against it.
bool is_sound(HeldVerdict verdict);

struct ProductVerdict {
  HeldVerdict held = HeldVerdict::kNotHeld;
  double grip_force = 0.0;       ///< N
  std::optional<double> asked;   ///< N, that was asked for
  grasp::ComfortResult comfort;  ///< empty if it isn't in the hand
  std::optional<StrengthUse> strength;
  std::optional<HardestPlace> hardest;
};

/// Whether one of two products presses less.
enum class PairVerdict {
  kLower,          ///< the second presses less at its hardest place, and that can be told apart
  kSame,           ///< the difference is below kToldApart, or below what the figures leave open
  kDependsOnSkin,  ///< with soft or stiff skin the order is another one
  kDependsOnRest,  ///< a hand that rests in its second way reverses the order
  kUnequalForce,   ///< they aren't held equally firmly: no answer
  kOnlyOneHeld,    ///< the second alone is held
  kNoneHeld        ///< neither is held
};
std::string_view name_of(PairVerdict verdict);  ///< "lower", "same", ...

/// Two products of one set at the same task.
struct ProductComparison {
  int worse = 0, better = 0;  ///< indices into the set; by the peak on sensor cells
  PairVerdict verdict = PairVerdict::kNoneHeld;
  bool are_of_task = false;  ///< each gripped with what its load or the torque asks for
  double peak_change = 0.0;  ///< peak on sensor cells, better over worse, less 1
  double area_change = 0.0;  ///< contact area, likewise
  /// The peak's change with soft and with stiff tissue; nothing without an error band.
  std::optional<double> peak_change_soft, peak_change_stiff;
  /// What hands and forces known to 1 % leave open of the peak's change (Certainty::peak_unsure()
  /// of both); nothing where the rests weren't looked beside.
  std::optional<double> peak_unsure;
  /// The peak's change at the second rest of one of the two that speaks most against the order;
  /// nothing without one.
  std::optional<double> peak_change_second;
  /// How far the hand lies otherwise on the second, in the frame that both files share: its angle,
  /// rad, and the way of the grip's middle, mm. Nothing unless both are held.
  std::optional<double> hand_turned, hand_shifted;
  /// Within 10 degrees and 5 mm: what differs is the products, not how they are held.
  bool are_held_alike() const;
};

struct SetVerdict {
  std::vector<ProductVerdict> products;
  /// Of each other product with the one that presses least among those held; in their order.
  std::vector<ProductComparison> comparisons;
  /// Which product is best, if one is: it is better than every other that can be held.
  std::optional<int> best;
};

/// Whether two grip forces are so near that pressures can be compared: within kToldApart.
bool are_equally_firm(double first, double second);

/// Whether the product is in the hand and presses on the skin.
bool presses_on_skin(const Assessment& assessment);

SetVerdict verdict_of(const AssessmentSet& set);

}  // namespace palmar::study
