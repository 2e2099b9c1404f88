// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <BRepBuilderAPI_GTransform.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <gp_Ax1.hxx>
#include <gp_Elips.hxx>
#include <gp_GTrsf.hxx>
#include <gp_Trsf.hxx>
#include <numbers>

#include "palmar/cad/solids/kind_makers.h"

namespace palmar::cad {
namespace {

/// Width along x, height along y; sides "right", `top`, "left", `bottom`.
std::vector<SectionCorner> rounded_rectangle(double width, double height, double fillet,
                                             const std::string& corner, const std::string& top,
                                             const std::string& bottom) {
  const double x = 0.5 * width;
  const double y = 0.5 * height;
  const auto at = [&](double px, double py, int number, const std::string& edge) {
    return SectionCorner{.at = {px, py},
                         .fillet = fillet,
                         .fillet_name = corner + " " + std::to_string(number),
                         .edge_name = edge};
  };
  return {at(x, y, 1, top), at(-x, y, 2, "left"), at(-x, -y, 3, bottom), at(x, -y, 4, "right")};
}

NamedSolid one_face(const TopoDS_Shape& shape) {
  NamedSolid solid{shape, {}};
  solid.names.push_back({TopoDS::Face(TopExp_Explorer(shape, TopAbs_FACE).Current()), "surface"});
  return solid;
}

}  // namespace

NamedSolid make_prism(const product::KindValues& v) {
  NamedSolid solid =
      extrude_section(rounded_rectangle(v.at("width_mm"), v.at("depth_mm"), v.at("fillet_mm"),
                                        "fillet", "back", "front"),
                      v.at("length_mm"));
  solid = round_face(solid, "bottom", v.at("end_fillet_mm"), "bottom fillet");
  solid = round_face(solid, "top", v.at("end_fillet_mm"), "top fillet");
  return put_first(solid, {"right", "back", "left", "front", "fillet 1", "fillet 2", "fillet 3",
                           "fillet 4", "bottom", "top"});
}

NamedSolid make_phone(const product::KindValues& v) {
  NamedSolid flat =
      extrude_section(rounded_rectangle(v.at("width_mm"), v.at("height_mm"), v.at("corner_mm"),
                                        "corner", "top side", "bottom side"),
                      v.at("thickness_mm"));
  for (NamedSolid::Name& one : flat.names) {
    if (one.text == "bottom") one.text = "back";
    if (one.text == "top") one.text = "screen";
  }
  flat = round_face(flat, "back", v.at("fillet_mm"), "back fillet");
  flat = round_face(flat, "screen", v.at("fillet_mm"), "screen fillet");
  gp_Trsf upright;
  upright.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), 0.5 * std::numbers::pi);
  // The screen, made upwards, faces the front, -y.
  BRepBuilderAPI_Transform turned(flat.shape, upright, true);
  NamedSolid solid{turned.Shape(), {}};
  for (const NamedSolid::Name& one : flat.names) {
    solid.names.push_back({TopoDS::Face(turned.ModifiedShape(one.face)), one.text});
  }
  return solid;
}

NamedSolid make_elliptic_handle(const product::KindValues& v) {
  const double x = 0.5 * v.at("width_mm");
  const double y = 0.5 * v.at("depth_mm");
  const double length = v.at("length_mm");
  const gp_Ax2 axes(gp_Pnt(0, 0, -0.5 * length), gp_Dir(0, 0, 1),
                    x >= y ? gp_Dir(1, 0, 0) : gp_Dir(0, 1, 0));
  BRepBuilderAPI_MakeWire wire(
      BRepBuilderAPI_MakeEdge(gp_Elips(axes, std::max(x, y), std::min(x, y))).Edge());
  const TopoDS_Edge edge = wire.Edge();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(wire.Wire(), true).Face();
  BRepPrimAPI_MakePrism prism(face, gp_Vec(0, 0, length));
  NamedSolid solid{prism.Shape(), {}};
  solid.names.push_back({TopoDS::Face(prism.Generated(edge).First()), "side"});
  solid.names.push_back({TopoDS::Face(prism.FirstShape()), "bottom"});
  solid.names.push_back({TopoDS::Face(prism.LastShape()), "top"});
  solid = round_face(solid, "bottom", v.at("end_fillet_mm"), "bottom fillet");
  return round_face(solid, "top", v.at("end_fillet_mm"), "top fillet");
}

NamedSolid make_sphere(const product::KindValues& v) {
  return one_face(BRepPrimAPI_MakeSphere(0.5 * v.at("diameter_mm")).Shape());
}

NamedSolid make_ellipsoid(const product::KindValues& v) {
  gp_GTrsf stretch;
  stretch.SetValue(1, 1, 0.5 * v.at("x_mm"));
  stretch.SetValue(2, 2, 0.5 * v.at("y_mm"));
  stretch.SetValue(3, 3, 0.5 * v.at("z_mm"));
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(1.0).Shape();
  return one_face(BRepBuilderAPI_GTransform(ball, stretch, true).Shape());
}

}  // namespace palmar::cad
