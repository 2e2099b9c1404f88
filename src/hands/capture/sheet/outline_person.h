// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/capture/sheet/outline_model.h"
#include "palmar/population/person_estimate.h"

namespace palmar::capture {

/// Standard errors of measures from an outline, mm: docs/method/outline.md says on whom they were
/// found.
struct OutlineErrors {
  double length = 2.0;  ///< hand length
  double width = 1.2;   ///< breadth over the metacarpal heads
  double finger = 2.5;  ///< fingers II to V
  /// Widths of phalanges, proximal to distal.
  std::array<double, 3> breadth{1.0, 0.5, 0.5};
};

/// Measures of a person as an outline has them; not the thumb's length, which an outline shows no
/// better than the rest of the hand does. `scale_error`: of all lengths, as a share.
std::vector<population::KnownMeasure> measures_of(const HandOutline& outline,
                                                  const OutlineErrors& errors,
                                                  double scale_error = 0.0);

/// What the user measured replaces what the photograph says of the same.
std::vector<population::KnownMeasure> measures_together(
    std::vector<population::KnownMeasure> own, const std::vector<population::KnownMeasure>& photo);

/// Shares by which a hand may differ from the surveys' people of the same length and breadth, as
/// standard deviations. The regressions' residuals are those of soldiers measured with one tape,
/// and their means are in the template's proportions; both are too sure of other hands.
inline constexpr double kFullness = 0.045;  ///< girth, breadth, widths that weren't measured: as
                                            ///< breadths at the finger joints vary about the girth
                                            ///< (Greiner 1991). Of a hand from elsewhere these were
                                            ///< 5 to 11 mm too large
/// Thicknesses of phalanges that weren't measured. Nobody's survey has them; ellipses with
/// Greiner's (1991) breadths and circumferences of the PIP joints of index and middle finger are
/// 0.89 (men) and 0.96 (women), 0.97 and 1.02 times as deep as broad, the template's segments
/// beside these joints 1.01 and 1.05 times: the root mean square of what is between.
inline constexpr double kDepth = 0.075;
/// Lengths of phalanges: rulers of surveys differ by 10 to 20 % from the template's segments (the
/// middle finger's last one 28.7 mm in Greiner 1991, 35 here, in hands of 194 mm), and free persons
/// of the phantom (docs/method/outline.md) by 16 % in the root mean square. A first segment of a
/// finger is what the others leave of its length, and errs by both.
inline constexpr double kSegmentShare = 0.15;
inline constexpr double kPalmShare = 0.02;  ///< palm, likewise: 3 mm
inline constexpr double kOwnWidth = 0.03;   ///< a measured width, which the regression thinks to be
                                            ///< in proportion to the others; of the middle finger's
                                            ///< first segment kProportionScatter, as it has none of
                                            ///< its own

/// A measured breadth over the knuckles: 1.8 mm in all, the root mean square of free persons for
/// development (docs/method/outline.md). Not among OutlineErrors: counted less, it would follow the
/// fingers' widths, and err more.
inline constexpr double kOwnBreadth = 0.016;

/// Widens what is said of an outline's person by these.
void allow_for_build(population::PersonEstimate& estimate);

struct OutlinePerson {
  HandOutline outline;  ///< with what its measures missed on the model taken off
  population::PersonEstimate estimate;
  hand::Hand hand;  ///< in the person's size, of the photographed side
  int measures = 0;
  std::optional<ModelOutline> model;  ///< nothing: none could be placed as the hand lies
  std::vector<std::string> notes;
};

/// The person of an outline, by analysis and synthesis: a hand in the size that the measures give
/// is placed as the photographed one lies, its silhouette measured in the same way, and what the
/// measures miss of that hand's true dimensions taken off those of the photograph; `rounds` times.
/// That takes care of height over the paper, of the slant of view and of where base creases lie
/// beside webs, as far as hands are alike. `template_hand`: a right one; `seen`: measured in
/// `scene`.
OutlinePerson person_of_outline(const hand::Hand& template_hand,
                                const population::Population& population,
                                const std::vector<population::KnownMeasure>& own,
                                const HandOutline& seen, const OutlineScene& scene, int rounds = 3);

}  // namespace palmar::capture
