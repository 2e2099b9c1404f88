// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/cad/model/cad_model.h"

namespace palmar::cad {

/// What OpenCASCADE knows of a CadModel. Instances of assemblies are bodies of their own, moved to
/// where they are.
struct CadModel::Impl {
  /// One body: a solid, or a shell or loose faces of a file without solids.
  struct Body {
    TopoDS_Shape shape;
    std::string name;  ///< with the assembly's path: "drill / handle"
    std::optional<std::array<float, 3>> colour;
  };
  std::vector<Body> bodies;
  TopoDS_Shape shape;                ///< all bodies: one, or a compound
  TopTools_IndexedMapOfShape faces;  ///< of `shape`; face number n is faces(n)
  TopTools_IndexedMapOfShape edges;
  std::map<int, std::string> face_name;  ///< by number; those that have one
  std::map<int, std::array<float, 3>> face_colour;
};

/// Sorts out shape, faces and edges of the bodies.
CadModel make_cad_model(std::vector<CadModel::Impl::Body> bodies);
/// One body.
CadModel make_cad_model(const TopoDS_Shape& shape, const std::string& name);

}  // namespace palmar::cad
