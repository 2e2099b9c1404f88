// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::report {

/// One finished picture.
struct Picture {
  std::string name;   ///< "pressure_palm": file name without ending
  std::string title;  ///< "Pressure on the skin, palm side"
  std::string alt;    ///< what it shows, in a sentence, for those who can't see it
  Image image;
};

struct PictureOptions {
  int width = 1000;                        ///< pixels
  int height = 700;                        ///< pixels
  Language language = Language::kEnglish;  ///< of what is written in them
};

/// Colour scale for pressure [MPa] common to all products of a set: from 0 to the largest peak on
/// sensor cells of the products in the hand, rounded up; 0 to 0.1 MPa if nothing is touched. The
/// peak at a single vertex may lie far above and would darken every picture: such values take the
/// colour of the upper end, and the scale says so.
ColourScale pressure_scale(const study::AssessmentSet& set);

/// Pictures of one grasp; all in the same pressure scale:
///
///     map_open_hand           pressure drawn on the hand in its reference posture, palm side, with
///                             the thumb's pad beside it
///     pressure_palm ...       deformed skin coloured by pressure, product hidden
///     grasp_palm ...          the hand holding the product
///     friction_palm ...       skin coloured by the share of friction in use (0 to 1), if friction
///                             is on; also friction_open_hand
///     footprint_in_palm ...   the product coloured by pressure
///
/// pressure, friction and grasp from the palm side, the back, the thumb side and the little
/// finger's side (suffix palm, back, thumb, little); footprint from four sides about the grip axis
/// (in_palm, under_fingers, under_knuckles, under_fingertips). When cancelled, those that are
/// finished.
std::vector<Picture> assessment_pictures(const hand::Hand& hand,
                                         const study::AssessedProduct& assessed,
                                         const ColourScale& scale,
                                         const PictureOptions& options = {},
                                         const Progress& progress = {});

/// Deformed skin (product frame, mm), or the posed skin if no contact was solved.
geometry::TriangleMesh deformed_skin(const hand::Hand& hand, const study::Assessment& assessment);
/// The same before contact.
geometry::TriangleMesh undeformed_skin(const hand::Hand& hand, const study::Assessment& assessment);
/// Pressure per skin vertex, MPa; all 0 if no contact was solved.
std::vector<double> skin_pressure(const hand::Hand& hand, const study::Assessment& assessment);
/// From 0 to 1: friction over the coefficient times the pressure.
ColourScale friction_scale();
/// The product's surface with the pressure on it; plain if there was no contact.
contact::ProductFootprint footprint_of(const study::AssessedProduct& assessed);

}  // namespace palmar::report
