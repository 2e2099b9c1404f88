// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/capture/sheet/hand_outline.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// A hand placed on the sheet as a photographed one lies there.
struct PlacedModel {
  hand::Posture posture;
  double turn = 0.0;                                ///< about the sheet's normal, rad
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< where the middle of its wrist crease is, mm
};

/// Proportions of a hand that an outline doesn't show.
OutlineProportions outline_proportions(const hand::HandDimensions& dimensions);

/// Dimensions with the fingers straight, as surveys measure, the thumb as in the reference; those
/// that a hand carries are of its reference posture, in which they are bent by some degrees.
hand::HandDimensions straight_dimensions(const hand::Hand& hand);

/// Straight fingers, the thumb beside the palm.
PlacedModel flat_model(const hand::Hand& hand, const HandOutline& like, bool palm_up);

/// The skin of a hand in that posture, palm (or back) down, the fingers' pads (or nails) on the
/// sheet; what would be lower is flattened on it.
geometry::TriangleMesh place_model(const hand::Hand& hand, const PlacedModel& model, bool palm_up);

/// Where a hand was photographed, to photograph another in its place.
struct OutlineScene {
  SheetGrid grid;
  SheetView sheet;
  OutlineProportions proportions;
  HandOutlineOptions options;
};

/// What the measures of a hand's outline miss of it, and how the hand lies.
struct ModelOutline {
  PlacedModel model;
  HandOutline outline;  ///< measured on the model's silhouette just as on a photograph
  double direction_error =
      0.0;  ///< largest angle between its fingers and those of the photograph, rad
};

/// Places `hand`, of the photographed side, as the photographed hand lies: turns it and spreads
/// fingers and thumb, `rounds` times, until their middle lines have the directions of those in
/// `seen`; and measures its silhouette. Starts from `start`. Throws InputError if its outline can't
/// be measured (fingers that touch).
ModelOutline match_model(const hand::Hand& hand, const HandOutline& seen, const OutlineScene& scene,
                         const PlacedModel& start, int rounds);

}  // namespace palmar::capture
