// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/region_model.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Precision.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/cad/edits/solid_edit.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEnough = 0.02;  // mm; a curve through every second point that is that near

gp_Pnt point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }
gp_Dir direction(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

Handle(Geom_BSplineCurve) curve_through(const std::vector<Vec3>& points, std::size_t step) {
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  const Handle(TColgp_HArray1OfPnt) array =
      new TColgp_HArray1OfPnt(1, static_cast<int>(some.size()));
  for (int i = 1; i <= array->Length(); ++i) {
    array->SetValue(i, point(some[i - 1]));
  }
  GeomAPI_Interpolate interpolate(array, Standard_True, 1e-6);
  interpolate.Perform();
  return interpolate.IsDone() ? interpolate.Curve() : Handle(Geom_BSplineCurve)();
}

double deviation(const Handle(Geom_BSplineCurve) & curve, const std::vector<Vec3>& points) {
  double largest = 0.0;
  for (const Vec3& x : points) {
    const GeomAPI_ProjectPointOnCurve nearest(point(x), curve);
    if (nearest.NbPoints() > 0) largest = std::max(largest, nearest.LowerDistance());
  }
  return largest;
}

TopoDS_Wire make_wire(const NamedCurve& given, CurveReport& report) {
  const std::size_t least = 4;
  if (given.points.size() < least) {
    throw UsageError("curve \"" + given.name + "\": " + std::to_string(given.points.size()) +
                     " points; at least 4 are needed");
  }
  Handle(Geom_BSplineCurve) curve;
  if (given.points.size() >= 4 * least) curve = curve_through(given.points, 2);
  if (curve.IsNull() || deviation(curve, given.points) > kEnough) {
    curve = curve_through(given.points, 1);
  }
  if (curve.IsNull()) {
    throw NumericalError("curve \"" + given.name + "\": no B-spline goes through its points");
  }
  report.poles = curve->NbPoles();
  report.length = GCPnts_AbscissaPoint::Length(GeomAdaptor_Curve(curve));
  report.deviation = deviation(curve, given.points);
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve).Edge()).Wire();
  report.is_closed = BRep_Tool::IsClosed(wire);
  return wire;
}

/// The surface with its seam on the side where the points aren't.
Handle(Geom_Surface) surface_of(const SimpleSurface& s, const std::vector<Vec3>& points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : points) middle += x / static_cast<double>(points.size());
  Vec3 out = middle - s.point;
  if (s.kind != FaceKind::kSphere) out -= out.dot(s.axis) * s.axis;
  if (out.norm() < 1e-6) out = s.axis.unitOrthogonal();
  const Vec3 axis = s.kind == FaceKind::kSphere ? out.unitOrthogonal() : s.axis;
  const gp_Ax3 frame(point(s.point), direction(axis), direction(-out));
  switch (s.kind) {
    case FaceKind::kPlane:
      return new Geom_Plane(frame);
    case FaceKind::kCylinder:
      return new Geom_CylindricalSurface(frame, s.radius);
    case FaceKind::kCone:
      return new Geom_ConicalSurface(frame, s.half_angle, s.radius);
    case FaceKind::kSphere:
      return new Geom_SphericalSurface(frame, s.radius);
    case FaceKind::kTorus:
      return new Geom_ToroidalSurface(frame, s.radius, s.tube_radius);
    case FaceKind::kFreeform:
      break;
  }
  throw UsageError("a freeform surface is no simple one");
}

/// Parameters of the nearest point; angles about where the points are.
gp_Pnt2d parameters(const Handle(Geom_Surface) & surface, FaceKind kind, const Vec3& x) {
  double u = 0.0, v = 0.0;
  const gp_Pnt p = point(x);
  switch (kind) {
    case FaceKind::kPlane:
      ElSLib::Parameters(Handle(Geom_Plane)::DownCast(surface)->Pln(), p, u, v);
      break;
    case FaceKind::kCylinder:
      ElSLib::Parameters(Handle(Geom_CylindricalSurface)::DownCast(surface)->Cylinder(), p, u, v);
      break;
    case FaceKind::kCone:
      ElSLib::Parameters(Handle(Geom_ConicalSurface)::DownCast(surface)->Cone(), p, u, v);
      break;
    case FaceKind::kSphere:
      ElSLib::Parameters(Handle(Geom_SphericalSurface)::DownCast(surface)->Sphere(), p, u, v);
      break;
    case FaceKind::kTorus:
      ElSLib::Parameters(Handle(Geom_ToroidalSurface)::DownCast(surface)->Torus(), p, u, v);
      break;
    case FaceKind::kFreeform:
      break;
  }
  return {u, v};
}

/// Angles within half a turn of `about`.
void unwrap(double& angle, double about) {
  while (angle > about + kPi) angle -= 2.0 * kPi;
  while (angle < about - kPi) angle += 2.0 * kPi;
}

double area_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  // With a tolerance: without, a face that ends at a free curve comes out some per cent small.
  BRepGProp::SurfaceProperties(face, properties, 1e-5);
  return properties.Mass();
}

/// The part inside of an outline, or nothing if the outline can't be projected onto the surface.
TopoDS_Face inside_of(const Handle(Geom_Surface) & surface, const std::vector<gp_Pnt2d>& outline,
                      double largest_area) {
  if (outline.size() < 8) return {};
  const std::size_t step = outline.size() >= 32 ? 2 : 1;
  std::vector<gp_Pnt2d> some;
  for (std::size_t i = 0; i < outline.size(); i += step) some.push_back(outline[i]);
  const Handle(TColgp_HArray1OfPnt2d) array =
      new TColgp_HArray1OfPnt2d(1, static_cast<int>(some.size()));
  for (int i = 1; i <= array->Length(); ++i) {
    array->SetValue(i, some[i - 1]);
  }
  Geom2dAPI_Interpolate interpolate(array, Standard_True, 1e-9);
  interpolate.Perform();
  if (!interpolate.IsDone()) return {};
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(interpolate.Curve(), surface).Edge();
  if (!BRepLib::BuildCurve3d(edge, 1e-4)) return {};
  for (const bool is_reversed : {false, true}) {
    BRepBuilderAPI_MakeWire wire(is_reversed ? TopoDS::Edge(edge.Reversed()) : edge);
    BRepBuilderAPI_MakeFace made(surface, wire.Wire(), Standard_True);
    if (!made.IsDone()) continue;
    const TopoDS_Face face = made.Face();
    BRepLib::SameParameter(face, 1e-4);
    const double area = area_of(face);
    if (BRepCheck_Analyzer(face).IsValid() && area > 0.0 && area < 1.01 * largest_area) return face;
  }
  return {};
}

TopoDS_Face make_face(const NamedSurface& given, SurfaceReport& report) {
  if (given.points.empty()) {
    throw UsageError("surface \"" + given.name + "\": no points that it covers");
  }
  const SimpleSurface& s = given.surface;
  const Handle(Geom_Surface) surface = surface_of(s, given.points);
  const bool is_round_u = s.kind != FaceKind::kPlane;
  const bool is_round_v = s.kind == FaceKind::kTorus;
  double about_v = 0.0;
  if (is_round_v) {
    double sine = 0.0, cosine = 0.0;
    for (const Vec3& x : given.points) {
      const double v = parameters(surface, s.kind, x).Y();
      sine += std::sin(v);
      cosine += std::cos(v);
    }
    about_v = std::atan2(sine, cosine);
  }
  const auto place = [&](const Vec3& x) {
    const gp_Pnt2d p = parameters(surface, s.kind, x);
    double u = p.X(), v = p.Y();
    if (is_round_u) unwrap(u, kPi);
    if (is_round_v) unwrap(v, about_v);
    return gp_Pnt2d(u, v);
  };
  double u1 = Precision::Infinite(), u2 = -u1, v1 = u1, v2 = -u1;
  for (const Vec3& x : given.points) {
    const gp_Pnt2d p = place(x);
    u1 = std::min(u1, p.X());
    u2 = std::max(u2, p.X());
    v1 = std::min(v1, p.Y());
    v2 = std::max(v2, p.Y());
  }
  if (u2 - u1 < 1e-6) u2 = u1 + 1e-6;
  if (v2 - v1 < 1e-6) v2 = v1 + 1e-6;
  const bool wraps_around = is_round_u && u2 - u1 > 1.9 * kPi;
  if (wraps_around) {
    u1 = 0.0;
    u2 = 2.0 * kPi;
  }
  const TopoDS_Face whole = BRepBuilderAPI_MakeFace(surface, u1, u2, v1, v2, 1e-6).Face();
  TopoDS_Face face;
  if (!given.outline.empty() && !wraps_around) {
    std::vector<gp_Pnt2d> outline;
    for (const Vec3& x : given.outline) outline.push_back(place(x));
    // The outline runs a little outside of the points: a region's border crosses triangles.
    face = inside_of(surface, outline, 2.0 * area_of(whole));
  }
  report.ends_at_outline = !face.IsNull();
  if (face.IsNull()) face = whole;
  report.area = area_of(face);
  return face;
}

}  // namespace

RegionModel make_region_model(const CadModel& product, const std::vector<NamedCurve>& curves,
                              const std::vector<NamedSurface>& surfaces) {
  RegionModel region;
  std::vector<CadModel::Impl::Body> bodies = product.impl().bodies;
  for (const NamedCurve& one : curves) {
    try_feature("curve \"" + one.name + "\"", [&] {
      CurveReport report;
      const TopoDS_Wire wire = make_wire(one, report);
      bodies.push_back({wire, one.name, one.colour});
      region.curves.push_back(report);
    });
  }
  for (const NamedSurface& one : surfaces) {
    try_feature("surface \"" + one.name + "\"", [&] {
      SurfaceReport report;
      const TopoDS_Face face = make_face(one, report);
      bodies.push_back({face, one.name, one.colour});
      region.surfaces.push_back(report);
    });
  }
  // The product's bodies come first, so its faces keep their numbers.
  auto impl = std::make_shared<CadModel::Impl>(make_cad_model(std::move(bodies)).impl());
  impl->face_name = product.impl().face_name;
  impl->face_colour = product.impl().face_colour;
  region.model = CadModel(std::move(impl));
  return region;
}

}  // namespace palmar
