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
#include <Geom2d_BSplineCurve.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Precision.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "palmar/cad/edits/closed_spline.h"
#include "palmar/cad/edits/solid_edit.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOutlineNear = 0.1;  // mm; outlines themselves are known to about 1.5 mm

gp_Pnt point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }
gp_Dir direction(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Knots 0 to n, all simple: of a closed cubic B-spline of n poles.
std::pair<TColStd_Array1OfReal, TColStd_Array1OfInteger> even_knots(int n) {
  TColStd_Array1OfReal knots(1, n + 1);
  TColStd_Array1OfInteger multiplicities(1, n + 1);
  for (int i = 0; i <= n; ++i) {
    knots.SetValue(i + 1, i);
    multiplicities.SetValue(i + 1, 1);
  }
  return {knots, multiplicities};
}

Handle(Geom_BSplineCurve) curve_near(const std::vector<Vec3>& points) {
  Eigen::MatrixXd rows(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) rows.row(i) = points[i].transpose();
  const ClosedSpline spline = fit_closed_spline(rows, kOutlineNear);
  const auto n = static_cast<int>(spline.poles.rows());
  TColgp_Array1OfPnt poles(1, n);
  for (int i = 0; i < n; ++i) {
    poles.SetValue(i + 1, gp_Pnt(spline.poles(i, 0), spline.poles(i, 1), spline.poles(i, 2)));
  }
  const auto [knots, multiplicities] = even_knots(n);
  return new Geom_BSplineCurve(poles, knots, multiplicities, 3, Standard_True);
}

double deviation(const Handle(Geom_BSplineCurve) & curve, const std::vector<Vec3>& points) {
  double largest = 0.0;
  for (const Vec3& x : points) {
    const GeomAPI_ProjectPointOnCurve nearest(point(x), curve);
    if (nearest.NbPoints() > 0) largest = std::max(largest, nearest.LowerDistance());
  }
  return largest;
}

TopoDS_Wire make_wire(const records::NamedCurve& given, CurveReport& report) {
  const std::size_t least = 4;
  if (given.points.size() < least) {
    throw UsageError("curve \"" + given.name + "\": " + std::to_string(given.points.size()) +
                     " points; at least 4 are needed");
  }
  const Handle(Geom_BSplineCurve) curve = curve_near(given.points);
  report.poles = curve->NbPoles();
  report.length = GCPnts_AbscissaPoint::Length(GeomAdaptor_Curve(curve));
  report.deviation = deviation(curve, given.points);
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve).Edge()).Wire();
  report.is_closed = BRep_Tool::IsClosed(wire);
  return wire;
}

/// The surface with its seam on the side where the points aren't.
Handle(Geom_Surface) surface_of(const redesign::SimpleSurface& s, const std::vector<Vec3>& points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : points) middle += x / static_cast<double>(points.size());
  Vec3 out = middle - s.point;
  if (s.kind != product::FaceKind::kSphere) out -= out.dot(s.axis) * s.axis;
  if (out.norm() < 1e-6) out = s.axis.unitOrthogonal();
  const Vec3 axis = s.kind == product::FaceKind::kSphere ? out.unitOrthogonal() : s.axis;
  const gp_Ax3 frame(point(s.point), direction(axis), direction(-out));
  switch (s.kind) {
    case product::FaceKind::kPlane:
      return new Geom_Plane(frame);
    case product::FaceKind::kCylinder:
      return new Geom_CylindricalSurface(frame, s.radius);
    case product::FaceKind::kCone:
      return new Geom_ConicalSurface(frame, s.half_angle, s.radius);
    case product::FaceKind::kSphere:
      return new Geom_SphericalSurface(frame, s.radius);
    case product::FaceKind::kTorus:
      return new Geom_ToroidalSurface(frame, s.radius, s.tube_radius);
    case product::FaceKind::kFreeform:
      break;
  }
  throw UsageError("a freeform surface is no simple one");
}

/// Parameters of the nearest point; angles about where the points are.
gp_Pnt2d parameters(const Handle(Geom_Surface) & surface, product::FaceKind kind, const Vec3& x) {
  double u = 0.0, v = 0.0;
  const gp_Pnt p = point(x);
  switch (kind) {
    case product::FaceKind::kPlane:
      ElSLib::Parameters(Handle(Geom_Plane)::DownCast(surface)->Pln(), p, u, v);
      break;
    case product::FaceKind::kCylinder:
      ElSLib::Parameters(Handle(Geom_CylindricalSurface)::DownCast(surface)->Cylinder(), p, u, v);
      break;
    case product::FaceKind::kCone:
      ElSLib::Parameters(Handle(Geom_ConicalSurface)::DownCast(surface)->Cone(), p, u, v);
      break;
    case product::FaceKind::kSphere:
      ElSLib::Parameters(Handle(Geom_SphericalSurface)::DownCast(surface)->Sphere(), p, u, v);
      break;
    case product::FaceKind::kTorus:
      ElSLib::Parameters(Handle(Geom_ToroidalSurface)::DownCast(surface)->Torus(), p, u, v);
      break;
    case product::FaceKind::kFreeform:
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

/// Millimetres on the surface per unit of its parameters.
void lengths_at(const Handle(Geom_Surface) & surface, const gp_Pnt2d& at, double& along_u,
                double& along_v) {
  gp_Pnt p;
  gp_Vec by_u, by_v;
  surface->D1(at.X(), at.Y(), p, by_u, by_v);
  along_u = std::max(by_u.Magnitude(), 1e-6);
  along_v = std::max(by_v.Magnitude(), 1e-6);
}

/// The part inside of an outline, or nothing if the outline can't be projected onto the surface.
TopoDS_Face inside_of(const Handle(Geom_Surface) & surface, const std::vector<gp_Pnt2d>& outline,
                      double largest_area) {
  if (outline.size() < 8) return {};
  // Fitted where lengths are those on the surface, about: parameters may be angles.
  double along_u = 0.0, along_v = 0.0;
  lengths_at(surface, outline.front(), along_u, along_v);
  Eigen::MatrixXd rows(outline.size(), 2);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    rows.row(i) << outline[i].X() * along_u, outline[i].Y() * along_v;
  }
  const ClosedSpline spline = fit_closed_spline(rows, kOutlineNear);
  const auto n = static_cast<int>(spline.poles.rows());
  TColgp_Array1OfPnt2d poles(1, n);
  for (int i = 0; i < n; ++i) {
    poles.SetValue(i + 1, gp_Pnt2d(spline.poles(i, 0) / along_u, spline.poles(i, 1) / along_v));
  }
  const auto [knots, multiplicities] = even_knots(n);
  const Handle(Geom2d_BSplineCurve) curve =
      new Geom2d_BSplineCurve(poles, knots, multiplicities, 3, Standard_True);
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(curve, surface).Edge();
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

TopoDS_Face make_face(const records::NamedSurface& given, SurfaceReport& report) {
  if (given.points.empty()) {
    throw UsageError("surface \"" + given.name + "\": no points that it covers");
  }
  const redesign::SimpleSurface& s = given.surface;
  const Handle(Geom_Surface) surface = surface_of(s, given.points);
  const bool is_round_u = s.kind != product::FaceKind::kPlane;
  const bool is_round_v = s.kind == product::FaceKind::kTorus;
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

RegionModel make_region_model(const CadModel& product,
                              const std::vector<records::NamedCurve>& curves,
                              const std::vector<records::NamedSurface>& surfaces) {
  RegionModel region;
  std::vector<CadModel::Impl::Body> bodies = product.impl().bodies;
  for (const records::NamedCurve& one : curves) {
    try_feature("curve \"" + one.name + "\"", [&] {
      CurveReport report;
      const TopoDS_Wire wire = make_wire(one, report);
      bodies.push_back({wire, one.name, one.colour});
      region.curves.push_back(report);
    });
  }
  for (const records::NamedSurface& one : surfaces) {
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

}  // namespace palmar::cad
