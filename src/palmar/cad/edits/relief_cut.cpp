// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/relief_cut.h"

#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GProp_GProps.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <utility>

#include "palmar/cad/edits/solid_edit.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kCutterReach = 3.0;  // mm; the cutter's body reaches that far beyond the material
constexpr double kThrough = 60.0;     // mm; beyond an end that is gone through
constexpr double kRoundingShare = 0.01;  // of area and volume; rounding a junction changes less
constexpr double kLeast = 0.01;          // mm^3; a cut of less takes nothing away

/// A relief's own frame: s along it, w across, h outwards, from the start of its axis.
struct ToolFrame {
  explicit ToolFrame(const redesign::RidgeRelief& relief)
      : origin(relief.start),
        along((relief.end - relief.start).normalized()),
        outward(relief.outward),
        across(along.cross(outward)),
        length((relief.end - relief.start).norm()) {}
  gp_Pnt at(double s, double w, double h) const {
    const Vec3 x = origin + s * along + w * across + h * outward;
    return {x.x(), x.y(), x.z()};
  }
  Vec3 origin, along, outward, across;
  double length;
};

/// Corners of a roof over the ridge, from the right flank to the left one: parallel to both flanks,
/// or with a flat top where they are steep.
std::vector<gp_Pnt> cutter_roof(const redesign::RidgeRelief& relief, const ToolFrame& frame,
                                double s) {
  const double sine = std::sin(relief.half_angle), cosine = std::cos(relief.half_angle);
  const double far = relief.radius + kCutterReach;
  const double flat = relief.radius + relief.depth + kCutterReach;
  std::vector<gp_Pnt> roof = {frame.at(s, far * sine, far * cosine)};
  if (far / std::max(cosine, 1e-9) <= flat + 4.0 * kCutterReach) {
    roof.push_back(frame.at(s, 0.0, far / cosine));
  } else {
    roof.push_back(frame.at(s, far * sine, flat));
    roof.push_back(frame.at(s, -far * sine, flat));
  }
  roof.push_back(frame.at(s, -far * sine, far * cosine));
  return roof;
}

TopoDS_Face cutter_face(BRepBuilderAPI_MakeWire& wire, const std::vector<gp_Pnt>& corners) {
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    wire.Add(BRepBuilderAPI_MakeEdge(corners[i], corners[i + 1]).Edge());
  }
  return BRepBuilderAPI_MakeFace(wire.Wire(), Standard_True).Face();
}

/// What the cutter takes away where it stands at s: between its circle and the roof.
TopoDS_Face cutter_section(const redesign::RidgeRelief& relief, const ToolFrame& frame, double s) {
  const double sine = std::sin(relief.half_angle), cosine = std::cos(relief.half_angle);
  const double r = relief.radius;
  const gp_Pnt left = frame.at(s, -r * sine, r * cosine), right = frame.at(s, r * sine, r * cosine);
  BRepBuilderAPI_MakeWire wire;
  wire.Add(
      BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(left, frame.at(s, 0.0, r), right).Value()).Edge());
  std::vector<gp_Pnt> corners = cutter_roof(relief, frame, s);
  corners.insert(corners.begin(), right);
  corners.push_back(left);
  return cutter_face(wire, corners);
}

/// The run-out at s: the space over the ridge turned about the centre of the cutter's path, less
/// the ring that the cutter leaves standing, so that its face is a torus and nothing else.
TopoDS_Shape run_out_body(const redesign::RidgeRelief& relief, const ToolFrame& frame, double s,
                          const gp_Dir& turn, double angle) {
  const double sine = std::sin(relief.half_angle), cosine = std::cos(relief.half_angle);
  const double deep = relief.radius - std::min(2.0, 0.5 * relief.radius);
  std::vector<gp_Pnt> corners = cutter_roof(relief, frame, s);
  corners.insert(corners.begin(), frame.at(s, deep * sine, deep * cosine));
  corners.push_back(frame.at(s, -deep * sine, deep * cosine));
  corners.push_back(corners.front());
  BRepBuilderAPI_MakeWire wire;
  const gp_Pnt centre = frame.at(s, 0.0, relief.radius + relief.run_out);
  const TopoDS_Shape space =
      BRepPrimAPI_MakeRevol(cutter_face(wire, corners), gp_Ax1(centre, turn), angle).Shape();
  // Where the ring's seam meets the edges of the space the kernel may find nothing left: another
  // seam.
  const gp_Dir outward(frame.outward.x(), frame.outward.y(), frame.outward.z());
  TopoDS_Shape left;
  for (const double beside : {0.0, 2.0, -2.0}) {  // rad
    const gp_Dir seam = outward.Rotated(gp_Ax1(centre, turn), beside);
    const TopoDS_Shape ring = BRepPrimAPI_MakeTorus(gp_Ax2(centre, turn, seam),
                                                    relief.radius + relief.run_out, relief.radius)
                                  .Shape();
    left = BRepAlgoAPI_Cut(space, ring).Shape();
    TopTools_IndexedMapOfShape solids;
    if (!left.IsNull()) TopExp::MapShapes(left, TopAbs_SOLID, solids);
    if (solids.Extent() == 1) break;
  }
  return checked_solid(left, relief.name);
}

/// Height of the cutter's roof above its axis.
double roof_height(const redesign::RidgeRelief& relief) {
  const double far = (relief.radius + kCutterReach) / std::max(std::cos(relief.half_angle), 1e-9);
  return std::min(far, relief.radius + relief.depth + 5.0 * kCutterReach);
}

TopTools_ListOfShape cutter_bodies(const redesign::RidgeRelief& relief) {
  const ToolFrame frame(relief);
  const double needed = roof_height(relief) - relief.radius + 1.0;
  if (relief.run_out < needed && !(relief.is_open_start && relief.is_open_end)) {
    throw NumericalError(
        fmt::format("{}: the run-out's radius is {:.4g} mm; the cutter needs at least {:.4g} mm to "
                    "leave a ridge of that height",
                    relief.name, relief.run_out, needed));
  }
  const double first = relief.is_open_start ? -kThrough : 0.0;
  const double last = frame.length + (relief.is_open_end ? kThrough : 0.0);
  const auto vector = [](const Vec3& x) { return gp_Vec(x.x(), x.y(), x.z()); };
  TopTools_ListOfShape bodies;
  bodies.Append(BRepPrimAPI_MakePrism(cutter_section(relief, frame, first),
                                      vector(frame.along) * (last - first))
                    .Shape());
  const double lift = std::min(1.0, (relief.depth + 1.0) / relief.run_out);
  const double angle = std::acos(1.0 - lift);
  for (const bool is_end : {false, true}) {
    if (is_end ? relief.is_open_end : relief.is_open_start) continue;
    const double s = is_end ? frame.length : 0.0;
    gp_Vec turn = vector(frame.across);
    if (!is_end) turn.Reverse();
    bodies.Append(run_out_body(relief, frame, s, gp_Dir(turn), angle));
  }
  return bodies;
}

double area_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return properties.Mass();
}

/// Rounds the edges between new run-outs (tori) and old faces, those that can be.
int round_junctions(SolidEdit& edit, const std::string& name, double radius, int& failed) {
  int rounded = 0;
  // Each rounding renumbers edges: one at a time, until none is left that can be.
  std::vector<gp_Pnt> given_up;
  for (int round = 0; round < 40; ++round) {
    TopTools_IndexedMapOfShape old_faces;
    for (const auto& [number, images] : edit.image) {
      if (number <= 0) continue;
      for (const TopoDS_Face& face : images) old_faces.Add(face);
    }
    TopTools_IndexedDataMapOfShapeListOfShape faces_of;
    TopExp::MapShapesAndAncestors(edit.solid, TopAbs_EDGE, TopAbs_FACE, faces_of);
    bool has_tried = false;
    for (int i = 1; i <= faces_of.Extent() && !has_tried; ++i) {
      const TopTools_ListOfShape& both = faces_of(i);
      if (both.Extent() != 2) continue;
      const TopoDS_Face a = TopoDS::Face(both.First()), b = TopoDS::Face(both.Last());
      const bool a_old = old_faces.Contains(a), b_old = old_faces.Contains(b);
      if (a_old == b_old) continue;
      if (BRepAdaptor_Surface(a_old ? b : a).GetType() != GeomAbs_Torus) continue;
      const TopoDS_Edge edge = TopoDS::Edge(faces_of.FindKey(i));
      if (BRep_Tool::Continuity(edge, a, b) >= GeomAbs_G1) continue;
      double begin = 0.0, end = 0.0;
      const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, begin, end);
      if (curve.IsNull()) continue;
      const gp_Pnt middle = curve->Value(0.5 * (begin + end));
      const auto is_same = [&](const gp_Pnt& p) { return p.Distance(middle) < 1e-3; };
      if (std::any_of(given_up.begin(), given_up.end(), is_same)) continue;
      has_tried = true;
      given_up.push_back(middle);
      try {
        BRepFilletAPI_MakeFillet fillet(edit.solid);
        fillet.Add(radius, edge);
        fillet.Build();
        if (!fillet.IsDone()) throw NumericalError("");
        const TopoDS_Shape solid = checked_solid(fillet.Shape(), name);
        // The kernel's check lets surfaces through that run away and come back.
        if (std::abs(area_of(solid) / area_of(edit.solid) - 1.0) > kRoundingShare ||
            std::abs(volume_of(solid) / volume_of(edit.solid) - 1.0) > kRoundingShare) {
          throw NumericalError("");
        }
        edit.follow(solid, [&](const TopoDS_Face& face) { return fillet.Modified(face); });
        ++rounded;
      } catch (const Standard_Failure&) {
        ++failed;
      } catch (const NumericalError&) {
        ++failed;
      }
    }
    if (!has_tried) break;
  }
  return rounded;
}

}  // namespace

RelievedModel cut_reliefs(const CadModel& model, const std::vector<redesign::RidgeRelief>& reliefs,
                          double junction_radius) {
  const CadModel::Impl& before = model.impl();
  const auto is_solid = [](const CadModel::Impl::Body& body) {
    return body.shape.ShapeType() == TopAbs_SOLID;
  };
  const auto body = std::find_if(before.bodies.begin(), before.bodies.end(), is_solid);
  if (model.solid_count() != 1 || body == before.bodies.end()) {
    throw InputError(
        fmt::format("relief: the model has {} solids; it must be one", model.solid_count()));
  }
  RelievedModel result;
  SolidEdit edit{.solid = body->shape, .image = {}};
  for (int n = 1; n <= before.faces.Extent(); ++n) {
    edit.image[n] = {TopoDS::Face(before.faces(n))};
  }
  result.volume_before = result.volume_after = volume_of(body->shape);
  for (const redesign::RidgeRelief& relief : reliefs) {
    try_feature(relief.name, [&] {
      TopTools_ListOfShape arguments;
      arguments.Append(edit.solid);
      BRepAlgoAPI_Cut cut;
      cut.SetArguments(arguments);
      cut.SetTools(cutter_bodies(relief));
      cut.SetRunParallel(Standard_False);
      cut.Build();
      if (!cut.IsDone() || cut.HasErrors()) {
        throw NumericalError(relief.name + ": can't be cut (the kernel gives no result)");
      }
      const TopoDS_Shape solid = checked_solid(cut.Shape(), relief.name);
      edit.follow(solid, [&](const TopoDS_Face& face) { return cut.Modified(face); });
      // Faces that come from nowhere are the relief's.
      TopTools_IndexedMapOfShape known, all;
      for (const auto& [number, images] : edit.image) {
        for (const TopoDS_Face& face : images) known.Add(face);
      }
      TopExp::MapShapes(solid, TopAbs_FACE, all);
      const int key = -static_cast<int>(&relief - reliefs.data()) - 1;
      for (int i = 1; i <= all.Extent(); ++i) {
        if (!known.Contains(all(i))) edit.image[key].push_back(TopoDS::Face(all(i)));
      }
      const double volume = volume_of(solid);
      if (result.volume_after - volume < kLeast) {
        throw NumericalError(relief.name + ": takes nothing away");
      }
      result.volume_after = volume;
    });
  }
  if (junction_radius > 0.0) {
    int failed = 0;
    result.rounded_junctions = round_junctions(edit, "junction", junction_radius, failed);
    result.volume_after = volume_of(edit.solid);
    if (failed > 0) {
      result.notes.push_back(fmt::format(
          "{} edges in which a relief leaves the surface were left as they are: no rounding of "
          "{:.3g} mm fits",
          failed, junction_radius));
    }
  }
  const CadModel made =
      make_cad_model({{.shape = edit.solid, .name = body->name, .colour = body->colour}});
  auto impl = std::make_shared<CadModel::Impl>(made.impl());
  for (const auto& [number, images] : edit.image) {
    for (const TopoDS_Face& face : images) {
      const int now = impl->faces.FindIndex(face);
      if (now == 0) continue;
      if (number < 0) {
        impl->face_name[now] = reliefs[-number - 1].name;
        continue;
      }
      if (const auto name = before.face_name.find(number); name != before.face_name.end()) {
        impl->face_name[now] = name->second;
      }
      if (const auto c = before.face_colour.find(number); c != before.face_colour.end()) {
        impl->face_colour[now] = c->second;
      }
    }
  }
  result.model = CadModel(std::move(impl));
  return result;
}

}  // namespace palmar::cad
