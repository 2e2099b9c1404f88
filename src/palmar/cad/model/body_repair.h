// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

namespace palmar::cad {

/// A body of a file, looked after.
struct RepairedBody {
  TopoDS_Shape shape;
  /// Per face of `shape` in the kernel's order: the face of the file that it was, null if new.
  std::vector<TopoDS_Shape> original_faces;
  bool is_solid = false;
  bool was_invalid = false;
  bool is_healed = false;  ///< was invalid, is valid now
  bool is_turned = false;  ///< was inside out
  bool was_sewn = false;
};

/// A solid as it stands in a file: healed if the kernel finds it invalid and healing makes it valid
/// without changing the number of faces; turned if it is inside out.
RepairedBody repaired(const TopoDS_Shape& solid);

/// Loose faces joined along common edges; shells that close become solids.
std::vector<RepairedBody> sew(const std::vector<TopoDS_Face>& faces);

/// The shape moved, then scaled. Keeps the order of faces.
TopoDS_Shape placed(const TopoDS_Shape& shape, const TopLoc_Location& place, double scale);

}  // namespace palmar::cad
