// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "palmar/grasp/grasp.h"
#include "palmar/grasp/holds/hold.h"

namespace palmar::records {

/// Where the thumb's side of a hand points, in the product's frame; unit.
Vec3 thumb_direction(const grasp::Grasp& grasp, hand::Side side);

/// A direction in short: "+z" within 20 degrees of an axis, else "(0.7, 0, 0.7)".
std::string direction_words(const Vec3& direction);

/// The hold that a grasp takes: {"part", "part_name", "kind", "grip", "along", "edge", "toward",
/// "turn_deg", "over_end", "words", "score", "terms": [{"name", "value", "unit", "score",
/// "words"}]}; score and terms only where it was ranked. null for a grasp without a hold.
nlohmann::ordered_json hold_object(const grasp::Grasp& grasp);

/// Ways to hold a product: {"product", "parts": [{"number", "kind", "name", "length_mm",
/// "girth_mm"}], "considered", "closed", "holds": [...]}; each hold as hold_object() with "number"
/// (its rank), "thumb_towards" (unit vector, product frame), "against" and
/// "product_from_hand" (as the hand was closed coarsely).
std::string ranked_holds_json(const grasp::RankedHolds& ranked, const std::string& product,
                              hand::Side side);

}  // namespace palmar::records
