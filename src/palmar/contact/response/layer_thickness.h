// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// Thickness h [mm] of the flat layer on flat bone that holds the skin at a vertex as firmly as the
/// real bones do, from all the bone that the vertex sees:
///
///     1 / h^2 = 1/pi Int 1 / (L(w) cos t)^2  cos t dw
///
/// over the half sphere of directions w into the hand, t their angle from the inward normal, L the
/// way to the first bone; a direction that meets none adds nothing. On flat bone parallel to the
/// skin L cos t is the depth, and h the depth exactly. Over a bone that is narrow against its depth
/// tissue escapes sideways: h grows, for a bone that fills a third of the view to 1.7 times the
/// depth. The nearest distance makes a fingertip 2 to 4 times too stiff (finite elements, see
/// docs/developing/finite-elements.md).
///
/// 96 directions, the same at every vertex. Between kLeast and kMost; kMost without bones.
std::vector<double> effective_layer_thickness(const hand::Hand& hand, const SkinGeometry& skin);

inline constexpr double kLeastLayerThickness = 1.0;  ///< mm
inline constexpr double kMostLayerThickness = 40.0;  ///< mm; half-space for the sizes of contacts

}  // namespace palmar::contact
