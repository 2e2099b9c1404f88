// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAbs_SurfaceType.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListIteratorOfListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>

#include "palmar/cad/model/face_relations.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/geometry/degrees.h"

namespace palmar::cad {
namespace {

constexpr double kSmooth = geometry::kDegree;  // rad; a kink below 1 degree can't be felt

product::FaceKind kind_of(const BRepAdaptor_Surface& surface) {
  switch (surface.GetType()) {
    case GeomAbs_Plane:
      return product::FaceKind::kPlane;
    case GeomAbs_Cylinder:
      return product::FaceKind::kCylinder;
    case GeomAbs_Cone:
      return product::FaceKind::kCone;
    case GeomAbs_Sphere:
      return product::FaceKind::kSphere;
    case GeomAbs_Torus:
      return product::FaceKind::kTorus;
    default:
      return product::FaceKind::kFreeform;
  }
}

double radius_of(const BRepAdaptor_Surface& surface) {
  switch (surface.GetType()) {
    case GeomAbs_Cylinder:
      return surface.Cylinder().Radius();
    case GeomAbs_Sphere:
      return surface.Sphere().Radius();
    case GeomAbs_Torus:
      return surface.Torus().MinorRadius();
    default:
      return 0.0;
  }
}

/// Outward normal of a face (out of the material) at surface parameters; null where there is none.
gp_Vec normal_at(const TopoDS_Face& face, const BRepAdaptor_Surface& surface, double u, double v) {
  gp_Pnt point;
  gp_Vec du, dv;
  surface.D1(u, v, point, du, dv);
  gp_Vec normal = du.Crossed(dv);
  if (normal.Magnitude() < 1e-12) return {0.0, 0.0, 0.0};
  normal.Normalize();
  if (face.Orientation() == TopAbs_REVERSED) normal.Reverse();
  return normal;
}

/// A round face is concave where its centre of curvature lies outside of the material, on the side
/// that the normal points to.
bool is_concave(const TopoDS_Face& face, const BRepAdaptor_Surface& surface) {
  const double u = 0.5 * (surface.FirstUParameter() + surface.LastUParameter());
  const double v = 0.5 * (surface.FirstVParameter() + surface.LastVParameter());
  const gp_Pnt at = surface.Value(u, v);
  gp_Pnt centre;
  switch (surface.GetType()) {
    case GeomAbs_Cylinder:
    case GeomAbs_Cone: {
      const gp_Ax1 axis =
          surface.GetType() == GeomAbs_Cylinder ? surface.Cylinder().Axis() : surface.Cone().Axis();
      const gp_Vec from(axis.Location(), at);
      centre =
          axis.Location().Translated(gp_Vec(axis.Direction()) * from.Dot(gp_Vec(axis.Direction())));
      break;
    }
    case GeomAbs_Sphere:
      centre = surface.Sphere().Location();
      break;
    case GeomAbs_Torus: {
      const gp_Torus torus = surface.Torus();
      const gp_Vec axis(torus.Axis().Direction());
      gp_Vec out(torus.Location(), at);
      out -= axis * out.Dot(axis);
      if (out.Magnitude() < 1e-12) return false;
      centre = torus.Location().Translated(out.Normalized() * torus.MajorRadius());
      break;
    }
    default:
      return false;
  }
  return gp_Vec(at, centre).Dot(normal_at(face, surface, u, v)) > 0.0;
}

struct Describer {
  const CadModel::Impl& impl;
  std::vector<BRepAdaptor_Surface> surfaces;
  product::ProductFaces result;

  explicit Describer(const CadModel::Impl& model) : impl(model) {
    for (int f = 1; f <= impl.faces.Extent(); ++f) {
      surfaces.emplace_back(TopoDS::Face(impl.faces(f)), Standard_True);
    }
  }

  const TopoDS_Face& face(int index) const { return TopoDS::Face(impl.faces(index + 1)); }

  void describe_faces() {
    for (int f = 0; f < impl.faces.Extent(); ++f) {
      product::ProductFace one;
      one.number = f + 1;
      if (const auto name = impl.face_name.find(f + 1); name != impl.face_name.end()) {
        one.name = name->second;
      }
      if (const auto colour = impl.face_colour.find(f + 1); colour != impl.face_colour.end()) {
        one.colour = colour->second;
      }
      one.kind = kind_of(surfaces[f]);
      one.radius = radius_of(surfaces[f]);
      one.is_concave = is_concave(face(f), surfaces[f]);
      GProp_GProps properties;
      BRepGProp::SurfaceProperties(face(f), properties);
      one.area = std::abs(properties.Mass());
      result.face.push_back(std::move(one));
    }
    for (const CadModel::Impl::Body& body : impl.bodies) {
      for (TopExp_Explorer it(body.shape, TopAbs_FACE); it.More(); it.Next()) {
        product::ProductFace& one = result.face[impl.faces.FindIndex(it.Current()) - 1];
        if (!one.part.empty()) continue;  // a face between two solids belongs to the first
        one.part = body.name;
        if (!one.colour) one.colour = body.colour;
      }
    }
  }

  void describe_edges() {
    TopTools_IndexedDataMapOfShapeListOfShape faces_of;
    TopExp::MapShapesAndAncestors(impl.shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
    for (int e = 1; e <= impl.edges.Extent(); ++e) {
      const TopoDS_Edge& edge = TopoDS::Edge(impl.edges(e));
      product::ProductEdge one;
      one.number = e;
      if (const int found = faces_of.FindIndex(edge); found > 0) {
        int side = 0;
        for (TopTools_ListIteratorOfListOfShape it(faces_of(found)); it.More() && side < 2;
             it.Next()) {
          one.faces[side++] = impl.faces.FindIndex(it.Value()) - 1;
        }
      }
      if (!BRep_Tool::Degenerated(edge)) measure(edge, one);
      result.edge.push_back(std::move(one));
    }
  }

  /// Leaves `one` as it is where the geometry gives no finite numbers.
  void measure(const TopoDS_Edge& edge, product::ProductEdge& one) const {
    BRepAdaptor_Curve curve;
    try {
      curve.Initialize(edge);
      one.length = GCPnts_AbscissaPoint::Length(curve);
    } catch (const Standard_Failure&) {
      return;  // without a curve in space; its faces' triangles show where it runs
    }
    if (!std::isfinite(one.length)) one.length = 0.0;
    if (one.faces[0] < 0 || one.faces[1] < 0) return;
    const double middle = 0.5 * (curve.FirstParameter() + curve.LastParameter());
    gp_Pnt point;
    gp_Vec tangent;
    curve.D1(middle, point, tangent);
    const auto normal = [&](int f, bool second) {
      // A seam has two curves in the parameters of its face: one per orientation.
      const TopoDS_Edge used = second ? TopoDS::Edge(edge.Reversed()) : edge;
      double first = 0, last = 0;
      const Handle(Geom2d_Curve) flat = BRep_Tool::CurveOnSurface(used, face(f), first, last);
      if (flat.IsNull()) return gp_Vec(0, 0, 0);
      const gp_Pnt2d uv = flat->Value(middle);
      return normal_at(face(f), surfaces[f], uv.X(), uv.Y());
    };
    const bool is_seam = one.faces[0] == one.faces[1];
    const gp_Vec a = normal(one.faces[0], false);
    const gp_Vec b = normal(one.faces[1], is_seam);
    if (a.Magnitude() < 0.5 || b.Magnitude() < 0.5) return;
    one.angle = a.Angle(b);
    if (!std::isfinite(one.angle)) one.angle = 0.0;
    one.is_smooth = one.angle < kSmooth;
    // Seen from outside, material of face 0 lies left of the edge as that face runs along it.
    if (orientation_in(edge, one.faces[0]) == TopAbs_REVERSED) tangent.Reverse();
    one.is_convex = !one.is_smooth && a.Crossed(b).Dot(tangent) > 0.0;
  }

  /// Which way the outline of a face runs along an edge.
  TopAbs_Orientation orientation_in(const TopoDS_Edge& edge, int f) const {
    for (TopExp_Explorer it(face(f), TopAbs_EDGE); it.More(); it.Next()) {
      if (it.Current().IsSame(edge)) {
        // Relative to the curve's own direction, which the adaptor follows.
        return it.Current().Orientation();
      }
    }
    return TopAbs_FORWARD;
  }

  /// Faces that round an edge, as changes of features know them.
  void find_fillets() {
    for (const Blend& blend : blends_of(impl, edge_relations(impl))) {
      result.face[static_cast<std::size_t>(blend.face) - 1].is_fillet = true;
    }
  }
};

}  // namespace

product::ProductFaces describe_faces(const CadModel& model) {
  if (model.is_empty()) return {};
  Describer describer(model.impl());
  describer.describe_faces();
  describer.describe_edges();
  describer.find_fillets();
  return std::move(describer.result);
}

}  // namespace palmar::cad
