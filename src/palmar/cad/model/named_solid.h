// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BRepFilletAPI_MakeFillet.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palmar::cad {

/// A solid while it is made, and what its faces are called, in the order in which they are numbered
/// at the end (those without a name come last). For the sources of module cad only.
struct NamedSolid {
  struct Name {
    TopoDS_Face face;
    std::string text;
  };
  TopoDS_Shape shape;
  std::vector<Name> names;
};
/// Face of that name. Throws NumericalError if there is none.
TopoDS_Face face_named(const NamedSolid& solid, const std::string& name);
/// "" if the face has none.
std::string name_of_face(const NamedSolid& solid, const TopoDS_Face& face);

/// The same, its faces of these names before all others, in this order.
NamedSolid put_first(NamedSolid solid, const std::vector<std::string>& names);

/// Point of a plane section: (x, y) of an extrusion along z, (radius, z) of a revolution about z.
using SectionPoint = std::array<double, 2>;

/// Corner of a section, and the edge that follows it.
struct SectionCorner {
  SectionPoint at;
  double fillet = 0.0;           ///< radius, between straight edges only
  std::string fillet_name = {};  ///< of the face that the fillet makes
  std::string edge_name = {};    ///< of the face that the edge after the corner makes
  std::optional<SectionPoint> via = std::nullopt;  ///< the edge is an arc through this point
};

/// Closed section, counter-clockwise, swept along z over |z| <= length / 2; the ends are called
/// "bottom" and "top".
NamedSolid extrude_section(const std::vector<SectionCorner>& corners, double length);
/// Closed section of radius >= 0, turned around z.
NamedSolid revolve_section(const std::vector<SectionCorner>& corners);
/// Two arcs of the same radius from `from` to `to`, along the second coordinate at both ends. They
/// turn by less than a right angle if the points are farther apart along it than across. The corner
/// at `to` itself is not among them.
std::vector<SectionCorner> s_curve(const SectionPoint& from, const SectionPoint& to,
                                   const std::string& first_name, const std::string& second_name);

/// The edges around a face (its outer wire) rounded; a new face is called `name`, or "name, front"
/// where several meet neighbours of different names. Nothing happens for a radius of 0. Throws
/// Standard_Failure or NumericalError if OpenCASCADE can't.
NamedSolid round_face(const NamedSolid& solid, const std::string& face, double radius,
                      const std::string& name);

}  // namespace palmar::cad
