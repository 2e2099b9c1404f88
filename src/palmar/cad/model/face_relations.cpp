// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/face_relations.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Bnd_OBB.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax1.hxx>
#include <gp_Ax3.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>
#include <numbers>
#include <optional>

namespace palmar::cad {
namespace {

constexpr double kSmoothAngle =
    std::numbers::pi / 180;  // rad; CAD systems' own G1 limit is near it
// A blend is bent at least this much more sharply than what it rounds, so that two patches of one
// surface don't count as rounding each other.
constexpr double kSharper = 1.05;
constexpr double kFlat = 1e-4;  // 1/mm; radii above 10 m are flat
constexpr double kSameRadius = 0.02;
constexpr double kBackToBack = 175 * std::numbers::pi / 180;  // rad
constexpr double kOblique = 10 * std::numbers::pi / 180;      // rad

/// A face at one point of its rim.
struct FaceAtEdge {
  gp_Vec normal;           ///< outward
  gp_Vec inward;           ///< in the face, away from the edge
  double curvature = 0.0;  ///< across the edge, see EdgeRelation
};

std::optional<FaceAtEdge> face_at(const TopoDS_Edge& edge, const TopoDS_Face& face, double t,
                                  const gp_Vec& tangent) {
  double first = 0.0, last = 0.0;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull()) return std::nullopt;
  const gp_Pnt2d uv = curve->Value(std::clamp(t, first, last));
  BRepLProp_SLProps at(BRepAdaptor_Surface(face), uv.X(), uv.Y(), 2, 1e-7);
  if (!at.IsNormalDefined()) return std::nullopt;
  const double side = face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
  FaceAtEdge result;
  result.normal = gp_Vec(at.Normal()) * side;
  const double way = edge.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
  result.inward = result.normal.Crossed(tangent * way);
  if (at.IsCurvatureDefined()) {
    if (at.IsUmbilic()) {
      result.curvature = at.MaxCurvature() * side;
    } else {
      gp_Dir largest, smallest;
      at.CurvatureDirections(largest, smallest);
      const double cosine = gp_Vec(largest).Dot(result.inward);  // Euler's theorem
      const double share = std::min(1.0, cosine * cosine);
      result.curvature = (at.MaxCurvature() * share + at.MinCurvature() * (1.0 - share)) * side;
    }
  }
  return result;
}

/// The edge as the face runs through it, the face oriented as in its solid.
TopoDS_Edge in_face(const TopoDS_Shape& edge, const TopoDS_Shape& face) {
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    if (it.Current().IsSame(edge)) return TopoDS::Edge(it.Current());
  }
  return TopoDS::Edge(edge);
}

EdgeRelation relation_of(const CadModel::Impl& model, int number,
                         const TopTools_ListOfShape& faces) {
  EdgeRelation result;
  result.edge = number;
  const TopoDS_Edge edge = TopoDS::Edge(model.edges(number));
  if (BRep_Tool::Degenerated(edge)) return result;
  const BRepAdaptor_Curve curve(edge);
  const double t = 0.5 * (curve.FirstParameter() + curve.LastParameter());
  gp_Vec tangent;
  curve.D1(t, result.middle, tangent);
  result.length = GCPnts_AbscissaPoint::Length(curve);
  if (tangent.Magnitude() < 1e-12) return result;
  tangent.Normalize();
  const gp_Vec chord(curve.Value(curve.FirstParameter()), curve.Value(curve.LastParameter()));
  result.is_closed = chord.Magnitude() < 1e-6 * std::max(1.0, result.length);
  result.along = gp_Dir(result.is_closed ? tangent : chord);

  std::vector<TopoDS_Face> met;
  for (const TopoDS_Shape& face : faces) {
    if (std::none_of(met.begin(), met.end(), [&](const auto& m) { return m.IsSame(face); })) {
      met.push_back(TopoDS::Face(face));
    }
  }
  for (size_t i = 0; i < std::min<size_t>(2, met.size()); ++i) {
    result.face[i] = model.faces.FindIndex(met[i]);
  }
  result.is_seam = met.size() == 1 && BRep_Tool::IsClosed(edge, met.front());
  if (met.size() != 2) return result;
  const auto one = face_at(in_face(edge, met[0]), met[0], t, tangent);
  const auto other = face_at(in_face(edge, met[1]), met[1], t, tangent);
  if (!one || !other) return result;
  result.normal = gp_Dir(one->normal);
  result.angle = one->normal.Angle(other->normal);
  result.is_smooth = result.angle < kSmoothAngle;
  result.is_convex = one->inward.Dot(other->normal) < 0.0;
  result.curvature = {one->curvature, other->curvature};
  return result;
}

/// One edge of a face over which it rounds.
struct RoundingEdge {
  int edge = 0, neighbour = 0;
  double curvature = 0.0;
};

bool lies_between_backs(const std::vector<RoundingEdge>& sides,
                        const std::vector<EdgeRelation>& relations) {
  if (sides.size() != 2) return false;
  const gp_Dir& one = relations[sides[0].edge - 1].normal;
  const gp_Dir& other = relations[sides[1].edge - 1].normal;
  return one.Angle(other) > kBackToBack;
}

}  // namespace

std::vector<EdgeRelation> edge_relations(const CadModel::Impl& model) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndAncestors(model.shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  std::vector<EdgeRelation> result;
  for (int number = 1; number <= model.edges.Extent(); ++number) {
    const TopTools_ListOfShape* const faces = faces_of_edge.Seek(model.edges(number));
    result.push_back(
        relation_of(model, number, faces == nullptr ? TopTools_ListOfShape() : *faces));
  }
  return result;
}

std::vector<Blend> blends_of(const CadModel::Impl& model,
                             const std::vector<EdgeRelation>& relations) {
  std::vector<std::vector<RoundingEdge>> sides(static_cast<std::size_t>(model.faces.Extent()) + 1);
  for (const EdgeRelation& edge : relations) {
    if (!edge.is_smooth || edge.face[0] == 0 || edge.face[1] == 0) continue;
    for (size_t i = 0; i < 2; ++i) {
      const double own = edge.curvature[i], beyond = edge.curvature[1 - i];
      if (std::abs(own) > kFlat && std::abs(own) > kSharper * std::abs(beyond)) {
        sides[edge.face[i]].push_back({edge.edge, edge.face[1 - i], own});
      }
    }
  }
  std::vector<Blend> result;
  for (int face = 1; face <= model.faces.Extent(); ++face) {
    std::vector<RoundingEdge>& own = sides[face];
    if (own.size() < 2) continue;
    const double sharpest =
        std::max_element(own.begin(), own.end(), [](const RoundingEdge& a, const RoundingEdge& b) {
          return std::abs(a.curvature) < std::abs(b.curvature);
        })->curvature;
    std::erase_if(own, [&](const RoundingEdge& side) {
      return std::abs(side.curvature - sharpest) > kSameRadius * std::abs(sharpest);
    });
    Blend blend;
    blend.face = face;
    blend.radius = 1.0 / std::abs(sharpest);
    blend.is_convex = sharpest < 0.0;
    for (const RoundingEdge& side : own) {
      blend.sides.push_back(side.edge);
      blend.support.push_back(side.neighbour);
      const EdgeRelation& edge = relations[side.edge - 1];
      if (edge.length > blend.length) {
        blend.length = edge.length;
        blend.along = edge.along;
      }
    }
    std::sort(blend.support.begin(), blend.support.end());
    blend.support.erase(std::unique(blend.support.begin(), blend.support.end()),
                        blend.support.end());
    if (blend.support.size() < 2 || lies_between_backs(own, relations)) continue;
    const BRepAdaptor_Surface surface(TopoDS::Face(model.faces(face)));
    blend.middle = surface.Value(0.5 * (surface.FirstUParameter() + surface.LastUParameter()),
                                 0.5 * (surface.FirstVParameter() + surface.LastVParameter()));
    result.push_back(std::move(blend));
  }
  return result;
}

namespace {

/// A box of a turned body may be oblique; the axis of its largest face that goes all round is
/// exact.
void settle_on_turned_face(const CadModel::Impl& model, LongAxis& axis) {
  double largest = 0.0;
  std::optional<gp_Ax1> turned;
  for (int i = 1; i <= model.faces.Extent(); ++i) {
    const BRepAdaptor_Surface surface(TopoDS::Face(model.faces(i)));
    const double turn = surface.LastUParameter() - surface.FirstUParameter();
    std::optional<gp_Ax1> own;
    if (surface.GetType() == GeomAbs_Cylinder) own = surface.Cylinder().Axis();
    if (surface.GetType() == GeomAbs_Cone) own = surface.Cone().Axis();
    if (surface.GetType() == GeomAbs_Torus) own = surface.Torus().Axis();
    if (!own || turn < 2 * std::numbers::pi - 1e-6) continue;
    const double angle = own->Direction().Angle(axis.direction);
    if (std::min(angle, std::numbers::pi - angle) > kOblique) continue;
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(model.faces(i), properties);
    if (properties.Mass() <= largest) continue;
    largest = properties.Mass();
    turned = angle > std::numbers::pi / 2 ? own->Reversed() : *own;
  }
  if (!turned) return;
  axis.direction = turned->Direction();
  const gp_Vec from(turned->Location(), axis.middle);
  axis.middle =
      turned->Location().Translated(gp_Vec(axis.direction) * from.Dot(gp_Vec(axis.direction)));
}

}  // namespace

LongAxis long_axis_of(const CadModel::Impl& model) {
  Bnd_OBB box;
  BRepBndLib::AddOBB(model.shape, box, Standard_False, Standard_True, Standard_False);
  LongAxis axis;
  axis.middle = gp_Pnt(box.Center());
  // Strictly longer: of equal sides the first one counts, whatever the last bit says.
  gp_XYZ direction = box.XDirection();
  axis.length = 2 * box.XHSize();
  for (const auto& [other, half] :
       {std::pair(box.YDirection(), box.YHSize()), std::pair(box.ZDirection(), box.ZHSize())}) {
    if (2 * half > axis.length * (1 + 1e-9)) {
      axis.length = 2 * half;
      direction = other;
    }
  }
  const double largest =
      std::abs(direction.X()) >= std::abs(direction.Y()) &&
              std::abs(direction.X()) >= std::abs(direction.Z())
          ? direction.X()
          : (std::abs(direction.Y()) >= std::abs(direction.Z()) ? direction.Y() : direction.Z());
  axis.direction = gp_Dir(largest < 0.0 ? direction.Reversed() : direction);
  settle_on_turned_face(model, axis);

  // Middle and length along it: of the box in the axis' own frame.
  gp_Trsf into;
  into.SetTransformation(gp_Ax3(axis.middle, axis.direction));
  Bnd_Box along;
  BRepBndLib::AddOptimal(model.shape.Moved(TopLoc_Location(into)), along, Standard_False,
                         Standard_False);
  double x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
  along.Get(x0, y0, z0, x1, y1, z1);
  axis.length = z1 - z0;
  axis.middle.Translate(gp_Vec(axis.direction) * (0.5 * (z0 + z1)));
  return axis;
}

}  // namespace palmar::cad
