// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/cad/model/cad_model.h"
#include "palmar/geometry/types.h"

namespace palmar::cad {

/// What the CAD kernel says of a model.
struct CadCheck {
  bool is_valid = false;   ///< geometry and topology agree everywhere (BRepCheck)
  bool is_closed = false;  ///< only solids, and no solid has a free edge
  int bodies = 0, solids = 0, faces = 0, edges = 0;
  int free_edges = 0;                 ///< with one face only
  double volume = 0.0;                ///< mm^3; of the solids
  double area = 0.0;                  ///< mm^2
  std::vector<std::string> findings;  ///< what is wrong, by face and edge number; at most 20

  /// A solid that can be made: valid, closed, positive volume.
  bool is_good() const { return is_valid && is_closed && volume > 0.0; }
};

CadCheck check_cad(const CadModel& model);

/// Why the model can't be the surface of a thing, if that is for certain: a face on a torus that
/// passes through itself on its axis (its tube is thicker than its ring is wide, ISO 10303-42
/// allows of such a torus only the outer or the inner part); "" if nothing is found. Names the
/// face.
std::string self_crossing(const CadModel& model);

/// Of the triangles if there are any, else of the surfaces; empty if there is nothing.
Box3 box_of(const CadModel& model);

/// mm^3; of the solids, by the surface integral over the exact surfaces.
double volume_of(const CadModel& model);

/// Poles of the B-spline surface that has most of them; 0 if there is none.
int most_poles(const CadModel& model);

}  // namespace palmar::cad
