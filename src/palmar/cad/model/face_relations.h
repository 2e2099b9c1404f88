// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <vector>

#include "palmar/cad/model/occt_model.h"

namespace palmar::cad {

/// How two faces of a model meet along an edge. Numbers are those of the model, from 1.
struct EdgeRelation {
  int edge = 0;
  std::array<int, 2> face{};  ///< 0: the edge is free, or a seam of one face
  bool is_seam = false;       ///< closes one face on itself, as along a cylinder
  bool is_smooth = false;     ///< normals differ by less than 1 degree
  bool is_convex = false;     ///< the material's angle is below 180 degrees
  double angle = 0.0;         ///< rad; between the outward normals at the middle
  double length = 0.0;        ///< mm
  gp_Pnt middle;
  gp_Dir along;  ///< from end to end; tangent at the middle of a closed edge
  bool is_closed = false;
  gp_Dir normal;  ///< outward, of the first face at the middle
  /// 1/mm; normal curvature of both faces across the edge, positive if the surface bends towards
  /// its outward normal (a groove).
  std::array<double, 2> curvature{};
};
std::vector<EdgeRelation> edge_relations(const CadModel::Impl& model);

/// A face that rounds an edge: over two or more of its edges it meets its neighbours without a
/// kink, bent more sharply across that edge than they are, all with one radius. A face between two
/// that lie back to back (the narrow side of a bar that is round there) is none: without it they
/// wouldn't meet.
struct Blend {
  int face = 0;
  double radius = 0.0;       ///< mm; across
  bool is_convex = true;     ///< rounds an outer edge; else a hollow one
  std::vector<int> sides;    ///< edges over which it rounds
  std::vector<int> support;  /// faces beyond them, ascending, each once
  gp_Pnt middle;             ///< a point on it
  gp_Dir along;              ///< of its longest side
  double length = 0.0;       ///< mm; of its longest side
};
std::vector<Blend> blends_of(const CadModel::Impl& model,
                             const std::vector<EdgeRelation>& relations);

/// The direction in which a model is longest, of its smallest box; along +x, +y or +z rather than
/// against it.
struct LongAxis {
  gp_Pnt middle;  ///< of the box
  gp_Dir direction;
  double length = 0.0;  ///< mm
};
LongAxis long_axis_of(const CadModel::Impl& model);

}  // namespace palmar::cad
