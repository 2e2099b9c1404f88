// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace palmar::cad {

/// A solid while it is changed, and what has become of the faces that it had.
struct SolidEdit {
  TopoDS_Shape solid;
  std::map<int, std::vector<TopoDS_Face>> image{};  ///< by the number of the face in the model
  std::vector<std::string> notes{};                 ///< what a user should know of what was made
  /// Takes the next state: `images_of` gives what became of a face, nothing if it stays as it is.
  /// Faces that aren't part of the new solid are forgotten.
  void follow(const TopoDS_Shape& next,
              const std::function<TopTools_ListOfShape(const TopoDS_Face&)>& images_of);
};

double volume_of(const TopoDS_Shape& shape);  ///< mm^3

/// The one solid in a shape: itself, or that of a compound. Throws NumericalError naming `feature`
/// if there is none or more than one, if the kernel's check finds a fault in it, if its shell is
/// open or its volume isn't positive.
TopoDS_Shape checked_solid(const TopoDS_Shape& shape, const std::string& feature);

/// Runs a step of the CAD kernel; whatever it throws becomes NumericalError: "FEATURE: can't be
/// made (what the kernel calls it)".
void try_feature(const std::string& feature, const std::function<void()>& step);

}  // namespace palmar::cad
