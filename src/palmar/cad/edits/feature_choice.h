// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/cad/model/cad_model.h"

namespace palmar::cad {

/// Edges that a fillet is asked for: sharp ones by their number, rounded ones by the face that
/// rounds them. Numbers are those of the model, ascending.
struct EdgeChoice {
  std::vector<int> sharp;    ///< edges
  std::vector<int> rounded;  ///< faces
  bool is_empty() const { return sharp.empty() && rounded.empty(); }
};

/// Edges in words, joined by "+":
///
///   long       convex edges, sharp or rounded, along the model's longest direction (within 15
///              degrees of it, at least a third of its length)
///   convex     all convex edges, sharp or rounded
///   concave    all concave ones
///   edge=3+5   by number; a smooth edge at the side of a fillet stands for it
///   face=7     the fillet that is face 7, or all sharp edges of another face
///   name=grip  the same of all faces with that name
///
/// Throws UsageError naming the word, the number or the name, and what there is.
EdgeChoice choose_edges(const CadModel& model, const std::string& words);

/// mm; radius of the chosen fillets, the mean; 0 if all edges are sharp.
double mean_radius(const CadModel& model, const EdgeChoice& choice);

/// Faces in words, joined by "+": "face=3+5", "name=grip", "sides" (all along the longest direction
/// but fillets), "ends" (planes across it), "all" (but fillets). Ascending. Throws UsageError.
std::vector<int> choose_faces(const CadModel& model, const std::string& words);

/// "edges 1, 3 and fillets 7, 8"; for messages.
std::string words_of(const EdgeChoice& choice);

}  // namespace palmar::cad
