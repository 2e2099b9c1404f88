// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <gp_Pnt.hxx>
#include <string>
#include <vector>

#include "palmar/cad/edits/feature_choice.h"
#include "palmar/cad/edits/solid_edit.h"
#include "palmar/cad/model/face_relations.h"

namespace palmar::cad {

/// The edge at which two faces meet, or would meet without the fillet between them.
struct RoundedEdge {
  std::array<int, 2> face{};  ///< numbers in the model
  gp_Pnt hint;                ///< on the edge or its fillet: distinguishes edges of the same faces
  double radius = 0.0;        ///< mm; 0: sharp
  int blend = 0;              ///< number of the face that rounded it; 0: it was sharp
  bool is_asked = false;      ///< by the user; else it was there and comes back as it was
};

/// What a change of fillets takes: all of `chosen` (faces that are blends), what is rounded onto
/// them and what they run into smoothly, down to corners; to be removed together and put back by
/// their radii. Ascending.
std::vector<int> blends_removed_with(const std::vector<int>& chosen,
                                     const std::vector<EdgeRelation>& relations,
                                     const std::vector<Blend>& blends);

/// Takes rounding faces away: their neighbours are extended until they meet. Throws NumericalError
/// naming the faces.
void remove_blends(SolidEdit& edit, const std::vector<int>& faces);

/// Rolls a ball of its radius along every edge: all in one if the kernel can, else one radius after
/// the other, the largest first. Edges that run smoothly into one another get one radius, that
/// which was asked for. Throws NumericalError naming `feature`.
void make_fillets(SolidEdit& edit, std::vector<RoundedEdge> edges, const std::string& feature);

}  // namespace palmar::cad
