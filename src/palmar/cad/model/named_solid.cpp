// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/named_solid.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepTools.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax1.hxx>
#include <gp_Pln.hxx>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kShortest = 1e-6;  // mm; edges below the CAD kernel's own tolerance are left out

SectionPoint operator+(const SectionPoint& a, const SectionPoint& b) {
  return {a[0] + b[0], a[1] + b[1]};
}
SectionPoint operator-(const SectionPoint& a, const SectionPoint& b) {
  return {a[0] - b[0], a[1] - b[1]};
}
SectionPoint operator*(double s, const SectionPoint& a) { return {s * a[0], s * a[1]}; }
double length_of(const SectionPoint& a) { return std::hypot(a[0], a[1]); }
SectionPoint unit(const SectionPoint& a) { return (1.0 / length_of(a)) * a; }

/// A corner cut by its fillet: where the arc begins, its middle, where it ends.
struct Rounded {
  SectionPoint begin, middle, end;
};

Rounded rounded(const SectionPoint& before, const SectionCorner& corner,
                const SectionPoint& after) {
  if (!(corner.fillet > 0.0)) return {corner.at, corner.at, corner.at};
  const SectionPoint back = unit(before - corner.at);
  const SectionPoint on = unit(after - corner.at);
  const double half = 0.5 * std::acos(back[0] * on[0] + back[1] * on[1]);  // of the corner's angle
  const SectionPoint inwards = unit(back + on);
  const double reach = corner.fillet / std::tan(half);
  const double gap = corner.fillet / std::sin(half) - corner.fillet;  // from the corner to the arc
  return {corner.at + reach * back, corner.at + gap * inwards, corner.at + reach * on};
}

struct NamedEdge {
  TopoDS_Edge edge;
  std::string name;
};

struct Section {
  TopoDS_Face face;
  std::vector<NamedEdge> edges;
};

/// `place`: where a point of the section is in space.
Section make_section(const std::vector<SectionCorner>& corners,
                     const std::function<gp_Pnt(const SectionPoint&)>& place) {
  const std::size_t n = corners.size();
  std::vector<Rounded> cut;
  for (std::size_t i = 0; i < n; ++i) {
    cut.push_back(rounded(corners[(i + n - 1) % n].at, corners[i], corners[(i + 1) % n].at));
  }
  Section section;
  const auto line = [&](const SectionPoint& a, const SectionPoint& b, const std::string& name) {
    if (length_of(b - a) < kShortest) return;
    section.edges.push_back({BRepBuilderAPI_MakeEdge(place(a), place(b)).Edge(), name});
  };
  const auto arc = [&](const SectionPoint& a, const SectionPoint& via, const SectionPoint& b,
                       const std::string& name) {
    const GC_MakeArcOfCircle curve(place(a), place(via), place(b));
    section.edges.push_back({BRepBuilderAPI_MakeEdge(curve.Value()).Edge(), name});
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Rounded& here = cut[i];
    const Rounded& next = cut[(i + 1) % n];
    if (corners[i].fillet > 0.0) arc(here.begin, here.middle, here.end, corners[i].fillet_name);
    if (corners[i].via) {
      arc(here.end, *corners[i].via, next.begin, corners[i].edge_name);
    } else {
      line(here.end, next.begin, corners[i].edge_name);
    }
  }
  BRepBuilderAPI_MakeWire wire;
  for (NamedEdge& one : section.edges) {
    wire.Add(one.edge);
    one.edge = wire.Edge();  // as the wire has it, with shared vertices
  }
  section.face = BRepBuilderAPI_MakeFace(wire.Wire(), true).Face();
  return section;
}

void add_name(NamedSolid& solid, const TopTools_ListOfShape& shapes, const std::string& name) {
  for (const TopoDS_Shape& shape : shapes) {
    if (shape.ShapeType() == TopAbs_FACE) solid.names.push_back({TopoDS::Face(shape), name});
  }
}

}  // namespace

TopoDS_Face face_named(const NamedSolid& solid, const std::string& name) {
  for (const NamedSolid::Name& one : solid.names) {
    if (one.text == name) return one.face;
  }
  throw NumericalError("the solid has no face \"" + name + "\"");
}

std::string name_of_face(const NamedSolid& solid, const TopoDS_Face& face) {
  for (const NamedSolid::Name& one : solid.names) {
    if (one.face.IsSame(face)) return one.text;
  }
  return "";
}

NamedSolid put_first(NamedSolid solid, const std::vector<std::string>& names) {
  std::stable_sort(solid.names.begin(), solid.names.end(),
                   [&](const NamedSolid::Name& a, const NamedSolid::Name& b) {
                     return std::find(names.begin(), names.end(), a.text) <
                            std::find(names.begin(), names.end(), b.text);
                   });
  return solid;
}

NamedSolid extrude_section(const std::vector<SectionCorner>& corners, double length) {
  const Section section = make_section(
      corners, [&](const SectionPoint& p) { return gp_Pnt(p[0], p[1], -0.5 * length); });
  BRepPrimAPI_MakePrism prism(section.face, gp_Vec(0.0, 0.0, length));
  NamedSolid solid{prism.Shape(), {}};
  for (const NamedEdge& one : section.edges) add_name(solid, prism.Generated(one.edge), one.name);
  solid.names.push_back({TopoDS::Face(prism.FirstShape()), "bottom"});
  solid.names.push_back({TopoDS::Face(prism.LastShape()), "top"});
  return solid;
}

NamedSolid revolve_section(const std::vector<SectionCorner>& corners) {
  const Section section =
      make_section(corners, [](const SectionPoint& p) { return gp_Pnt(p[0], 0.0, p[1]); });
  BRepPrimAPI_MakeRevol turned(section.face, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
  NamedSolid solid{turned.Shape(), {}};
  // MakeRevol doesn't show what became of edges perpendicular to the axis: the face through the
  // edge's middle is the one.
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(solid.shape, TopAbs_FACE, faces);
  for (const NamedEdge& one : section.edges) {
    const BRepAdaptor_Curve curve(one.edge);
    const gp_Pnt middle = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
    const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(middle).Vertex();
    for (int f = 1; f <= faces.Extent(); ++f) {
      if (BRepExtrema_DistShapeShape(vertex, faces(f)).Value() > kShortest) continue;
      solid.names.push_back({TopoDS::Face(faces(f)), one.name});
      break;
    }
  }
  return solid;
}

std::vector<SectionCorner> s_curve(const SectionPoint& from, const SectionPoint& to,
                                   const std::string& first_name, const std::string& second_name) {
  const double side = to[0] - from[0];
  const double along = to[1] - from[1];
  if (std::abs(side) < kShortest) return {{.at = from, .edge_name = first_name}};
  // Each arc turns by `turn` and moves half of the way: tan(turn / 2) = |side / along|.
  const double half_turn = std::atan(std::abs(side / along));
  const double radius = 0.5 * std::abs(along) / std::sin(2.0 * half_turn);
  // Halfway on an arc: its turn is half_turn there.
  const double off = radius * (1.0 - std::cos(half_turn)) * (side > 0.0 ? 1.0 : -1.0);
  const double on = radius * std::sin(half_turn) * (along > 0.0 ? 1.0 : -1.0);
  const SectionPoint middle = 0.5 * (from + to);
  const SectionPoint step = {off, on};
  return {{.at = from, .edge_name = first_name, .via = from + step},
          {.at = middle, .edge_name = second_name, .via = to - step}};
}

NamedSolid round_face(const NamedSolid& solid, const std::string& face, double radius,
                      const std::string& name) {
  if (!(radius > 0.0)) return solid;
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndAncestors(solid.shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  const TopoDS_Face rounded_face = face_named(solid, face);
  BRepFilletAPI_MakeFillet fillet(solid.shape);
  struct Source {
    TopoDS_Edge edge;
    std::string neighbour;
  };
  std::vector<Source> sources;
  for (TopExp_Explorer it(BRepTools::OuterWire(rounded_face), TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current());
    if (fillet.Contour(edge) == 0) fillet.Add(radius, edge);
    Source source{edge, ""};
    for (const TopoDS_Shape& one : faces_of_edge.FindFromKey(edge)) {
      if (!one.IsSame(rounded_face)) source.neighbour = name_of_face(solid, TopoDS::Face(one));
    }
    sources.push_back(source);
  }
  fillet.Build();
  if (!fillet.IsDone()) {
    throw NumericalError("the edges of \"" + face + "\" can't be rounded with " +
                         std::to_string(radius) + " mm");
  }
  NamedSolid result{fillet.Shape(), {}};
  for (const NamedSolid::Name& one : solid.names) {
    if (fillet.IsDeleted(one.face)) continue;
    const TopTools_ListOfShape& changed = fillet.Modified(one.face);
    if (changed.IsEmpty()) {
      result.names.push_back(one);
    } else {
      add_name(result, changed, one.text);
    }
  }
  for (const Source& one : sources) {
    add_name(result, fillet.Generated(one.edge),
             sources.size() > 1 ? name + ", " + one.neighbour : name);
  }
  return result;
}

}  // namespace palmar::cad
