// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/tessellation.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/occt_progress.h"
#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar::cad {
namespace {

constexpr double kSizeShare = 2000.0;  // a 120 mm handle: 0.06 mm
constexpr double kRoundShare = 20.0;   // a 20th of the smallest rounding
constexpr double kFinest = 0.01;       // mm; a tenth of a skin ridge's height
constexpr double kCoarsest = 0.2;      // mm
constexpr double kSmallestAllowed = 1e-4, kLargestAllowed = 10.0;  // mm, given by the user

double size_of(const CadModel& model) {
  const Box3 box = box_of(model);
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

/// Chords over an arc of radius r [mm] and angle [rad].
double chords(double radius, double turn, double chordal_error, double angle) {
  double step = angle;
  if (radius > chordal_error) step = std::min(step, 2.0 * std::acos(1.0 - chordal_error / radius));
  return std::max(1.0, std::ceil(std::abs(turn) / step));
}

/// Triangles of a surface by the turns of its tangents on a coarse grid.
double estimate_freeform(const BRepAdaptor_Surface& surface, double chordal_error, double angle) {
  constexpr int kGrid = 8;
  const double u0 = surface.FirstUParameter(), u1 = surface.LastUParameter();
  const double v0 = surface.FirstVParameter(), v1 = surface.LastVParameter();
  // Turn of the tangent along grid lines says how many chords they need.
  const auto along = [&](bool is_u, double fixed) {
    double steps = 0.0;
    gp_Vec last;
    gp_Pnt last_point;
    for (int i = 0; i <= kGrid; ++i) {
      const double t = static_cast<double>(i) / kGrid;
      gp_Pnt point;
      gp_Vec du, dv;
      if (is_u) {
        surface.D1(u0 + t * (u1 - u0), fixed, point, du, dv);
      } else {
        surface.D1(fixed, v0 + t * (v1 - v0), point, du, dv);
      }
      const gp_Vec tangent = is_u ? du : dv;
      if (i > 0 && last.Magnitude() > 1e-12 && tangent.Magnitude() > 1e-12) {
        const double turn = last.Angle(tangent);
        if (turn > 1e-6) {
          steps += chords(last_point.Distance(point) / turn, turn, chordal_error, angle);
        }
      }
      last = tangent;
      last_point = point;
    }
    return std::max(1.0, steps);
  };
  double u_steps = 1.0, v_steps = 1.0;
  for (int i = 0; i <= 2; ++i) {
    u_steps = std::max(u_steps, along(true, v0 + 0.5 * i * (v1 - v0)));
    v_steps = std::max(v_steps, along(false, u0 + 0.5 * i * (u1 - u0)));
  }
  return 2.0 * u_steps * v_steps;
}

/// Triangles that a face will need, roughly.
double estimate(const TopoDS_Face& face, double chordal_error, double angle) {
  const BRepAdaptor_Surface surface(face, Standard_True);
  const double u = surface.LastUParameter() - surface.FirstUParameter();
  const double v = surface.LastVParameter() - surface.FirstVParameter();
  switch (surface.GetType()) {
    case GeomAbs_Plane: {
      double edges = 0.0;
      for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) ++edges;
      return std::max(2.0, edges);
    }
    case GeomAbs_Cylinder:
      return 2.0 * chords(surface.Cylinder().Radius(), u, chordal_error, angle);
    case GeomAbs_Cone:
      return 2.0 * chords(surface.Cone().RefRadius() + std::abs(v), u, chordal_error, angle);
    case GeomAbs_Sphere:
      return 2.0 * chords(surface.Sphere().Radius(), u, chordal_error, angle) *
             chords(surface.Sphere().Radius(), v, chordal_error, angle);
    case GeomAbs_Torus:
      return 2.0 *
             chords(surface.Torus().MajorRadius() + surface.Torus().MinorRadius(), u, chordal_error,
                    angle) *
             chords(surface.Torus().MinorRadius(), v, chordal_error, angle);
    default:
      return estimate_freeform(surface, chordal_error, angle);
  }
}

double estimate_all(const CadModel& model, double chordal_error, double angle) {
  double sum = 0.0;
  for (int f = 1; f <= model.face_count(); ++f) {
    sum += estimate(TopoDS::Face(model.impl().faces(f)), chordal_error, angle);
  }
  return sum;
}

struct Choice {
  double chordal_error = 0.0;
  std::string reason;
  double angle = 0.0;
};

bool can_be_coarser(const Choice& choice) { return choice.chordal_error < 0.5 * kLargestAllowed; }

void coarsen(Choice& choice, const TessellationOptions& options) {
  choice.chordal_error *= 2.0;
  choice.angle = std::min(1.0, 1.4 * choice.angle);
  choice.reason =
      "so that there are no more than " + std::to_string(options.max_triangles) + " triangles";
}

Choice choose(const CadModel& model, const product::ProductFaces& faces,
              const TessellationOptions& options) {
  if (options.chordal_error) return {*options.chordal_error, "as given", options.angle};
  const double size = size_of(model);
  double smallest = 0.0;
  for (const product::ProductFace& face : faces.face) {
    if (face.radius > 0.0 && (smallest == 0.0 || face.radius < smallest)) smallest = face.radius;
  }
  Choice choice{size / kSizeShare, "a 2000th of its size of " + significant(size, 3) + " mm",
                options.angle};
  if (smallest > 0.0 && smallest / kRoundShare < choice.chordal_error) {
    choice.chordal_error = smallest / kRoundShare;
    choice.reason = "a 20th of its smallest radius of " + significant(smallest, 3) + " mm";
  }
  if (choice.chordal_error < kFinest) {
    choice.chordal_error = kFinest;
    choice.reason = "the finest that is chosen automatically";
  }
  if (choice.chordal_error > kCoarsest) {
    choice.chordal_error = kCoarsest;
    choice.reason = "the coarsest that is chosen automatically";
  }
  // Half of the triangles are kept in reserve: it is an estimate.
  while (can_be_coarser(choice) &&
         2.0 * estimate_all(model, choice.chordal_error, choice.angle) > options.max_triangles) {
    coarsen(choice, options);
  }
  return choice;
}

[[noreturn]] void fail_too_many(double count, const Choice& choice,
                                const TessellationOptions& options, bool is_guess) {
  throw InputError(std::string("a chordal error of ") + significant(choice.chordal_error, 3) +
                   " mm needs " + (is_guess ? "about " : "") + significant(count, 3) +
                   " triangles; up to " + std::to_string(options.max_triangles) +
                   " are made. Give a larger setting \"chordal error\"");
}

void mesh_shape(const CadModel& model, const Choice& choice, IMeshTools_MeshAlgoType algorithm,
                const Progress& progress) {
  IMeshTools_Parameters parameters;
  parameters.MeshAlgo = algorithm;
  parameters.Deflection = choice.chordal_error;
  parameters.DeflectionInterior = choice.chordal_error;
  parameters.Angle = choice.angle;
  parameters.AngleInterior = 2.0 * choice.angle;
  parameters.InParallel = Standard_True;
  parameters.Relative = Standard_False;
  const Handle(OcctProgress) indicator = new OcctProgress(progress, 0.1, 0.8, "tessellating");
  BRepTools::Clean(model.impl().shape);
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(model.impl().shape);
  mesher.ChangeParameters() = parameters;
  mesher.Perform(indicator->Start());
  progress.throw_if_cancelled();
}

double area_of(const Poly_Triangulation& triangulation) {
  double area = 0.0;
  for (int t = 1; t <= triangulation.NbTriangles(); ++t) {
    int a = 0, b = 0, c = 0;
    triangulation.Triangle(t).Get(a, b, c);
    const gp_Pnt origin = triangulation.Node(a);
    area += 0.5 * gp_Vec(origin, triangulation.Node(b))
                      .Crossed(gp_Vec(origin, triangulation.Node(c)))
                      .Magnitude();
  }
  return area;
}

/// Faces (by number) whose triangles don't cover them.
std::vector<int> uncovered_faces(const CadModel& model, const product::ProductFaces& faces) {
  constexpr double kWrong = 0.05;       // of the area; chords of a rounding in 0.25 rad lose 0.3 %
  constexpr double kNegligible = 1e-6;  // mm^2
  std::vector<int> uncovered;
  for (int f = 1; f <= model.face_count(); ++f) {
    TopLoc_Location place;
    const Handle(Poly_Triangulation) triangulation =
        BRep_Tool::Triangulation(TopoDS::Face(model.impl().faces(f)), place);
    const double area = triangulation.IsNull() ? 0.0 : area_of(*triangulation);
    const double exact = faces.face[f - 1].area;
    if (std::abs(area - exact) > std::max(kNegligible, kWrong * exact)) uncovered.push_back(f);
  }
  return uncovered;
}

/// The fast algorithm; where it leaves faces uncovered, the thorough one, if that covers more.
std::vector<int> mesh_and_examine(const CadModel& model, const product::ProductFaces& faces,
                                  const Choice& choice, const Progress& progress) {
  mesh_shape(model, choice, IMeshTools_MeshAlgoType_Delabella, progress);
  std::vector<int> uncovered = uncovered_faces(model, faces);
  if (uncovered.empty()) return uncovered;
  mesh_shape(model, choice, IMeshTools_MeshAlgoType_Watson, progress);
  return uncovered_faces(model, faces);
}

/// Vertices that edges and corners of the model make one.
class Welder {
 public:
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }
  int find(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(int a, int b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }
  int size() const { return static_cast<int>(parent_.size()); }

 private:
  std::vector<int> parent_;
};

struct MeshBuilder {
  const CadModel& model;
  Tessellation& result;
  Welder welder;
  std::vector<Vec3> points;
  std::vector<std::vector<int>> nodes_of_edge;  ///< the first face's nodes along it
  std::vector<int> node_of_corner;              ///< per vertex of the model
  TopTools_IndexedMapOfShape corners;

  MeshBuilder(const CadModel& cad, Tessellation& tessellation)
      : model(cad), result(tessellation), nodes_of_edge(cad.edge_count()) {
    TopExp::MapShapes(model.impl().shape, TopAbs_VERTEX, corners);
    node_of_corner.assign(corners.Extent(), -1);
  }

  static Vec3 point_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

  void join_corner(const TopoDS_Vertex& corner, int node) {
    const int index = corners.FindIndex(corner) - 1;
    if (index < 0) return;
    if (node_of_corner[index] < 0) {
      node_of_corner[index] = node;
    } else {
      welder.join(node_of_corner[index], node);
    }
  }

  /// Joins nodes of a face along one of its edges with those of the faces before.
  void join_edge(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & triangulation,
                 const TopLoc_Location& place, int first_node) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangulation, place);
    if (polygon.IsNull() || polygon->NbNodes() < 2) return;
    std::vector<int> nodes;
    for (int i = 1; i <= polygon->NbNodes(); ++i)
      nodes.push_back(first_node + polygon->Node(i) - 1);
    if (BRep_Tool::Degenerated(edge)) {
      const TopoDS_Vertex corner = TopExp::FirstVertex(edge);
      for (const int node : nodes) join_corner(corner, node);
      return;
    }
    // Polygons follow the edge's own curve, whatever the orientation of its use.
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    join_corner(TopExp::FirstVertex(forward), nodes.front());
    join_corner(TopExp::LastVertex(forward), nodes.back());
    const int index = model.impl().edges.FindIndex(edge) - 1;
    if (index < 0) return;
    std::vector<int>& known = nodes_of_edge[index];
    if (known.empty()) {
      known = nodes;
    } else if (known.size() == nodes.size()) {
      for (std::size_t i = 0; i < nodes.size(); ++i) welder.join(known[i], nodes[i]);
    }
  }

  void add_face(int f) {
    const TopoDS_Face& face = TopoDS::Face(model.impl().faces(f + 1));
    TopLoc_Location place;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, place);
    if (triangulation.IsNull()) return;
    const gp_Trsf move = place.Transformation();
    const int first_node = welder.size();
    for (int n = 1; n <= triangulation->NbNodes(); ++n) {
      welder.add();
      points.push_back(point_of(triangulation->Node(n).Transformed(move)));
    }
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      // A seam comes twice, once per orientation, with a polygon for each.
      join_edge(TopoDS::Edge(it.Current()), triangulation, place, first_node);
    }
    const bool is_flipped = (face.Orientation() == TopAbs_REVERSED) != move.IsNegative();
    for (int t = 1; t <= triangulation->NbTriangles(); ++t) {
      int a = 0, b = 0, c = 0;
      triangulation->Triangle(t).Get(a, b, c);
      if (is_flipped) std::swap(b, c);
      result.mesh.triangles.push_back({first_node + a - 1, first_node + b - 1, first_node + c - 1});
      result.faces.face_of_triangle.push_back(f);
    }
  }

  /// Numbers of joined nodes, triangles without collapsed ones, edges' points.
  void finish() {
    for (std::size_t e = 0; e < nodes_of_edge.size(); ++e) {
      for (const int node : nodes_of_edge[e]) {
        result.faces.edge[e].points.push_back(points[welder.find(node)]);
      }
    }
    std::vector<int> vertex_of(points.size(), -1);
    std::vector<Triangle> kept;
    std::vector<int> face_of_kept;
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
      Triangle corner = result.mesh.triangles[t];
      for (int& v : corner) v = welder.find(v);
      if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
      for (int& v : corner) {
        if (vertex_of[v] < 0) {
          vertex_of[v] = result.mesh.vertex_count();
          result.mesh.vertices.push_back(points[v]);
        }
        v = vertex_of[v];
      }
      kept.push_back(corner);
      face_of_kept.push_back(result.faces.face_of_triangle[t]);
    }
    result.mesh.triangles = std::move(kept);
    result.faces.face_of_triangle = std::move(face_of_kept);
  }
};

long long triangles_of(const CadModel& model) {
  long long count = 0;
  for (int f = 1; f <= model.face_count(); ++f) {
    TopLoc_Location place;
    const Handle(Poly_Triangulation) triangulation =
        BRep_Tool::Triangulation(TopoDS::Face(model.impl().faces(f)), place);
    if (!triangulation.IsNull()) count += triangulation->NbTriangles();
  }
  return count;
}

}  // namespace

void TessellationOptions::check() const {
  if (chordal_error && !(*chordal_error >= kSmallestAllowed && *chordal_error <= kLargestAllowed)) {
    throw UsageError("chordal error " + significant(*chordal_error, 3) + " mm; " +
                     significant(kSmallestAllowed, 3) + " to " + significant(kLargestAllowed, 3) +
                     " mm is allowed");
  }
  if (!(angle >= 0.01 && angle <= 1.0)) {
    throw UsageError("angle between chords " + significant(angle, 3) +
                     " rad; 0.01 to 1 rad is allowed");
  }
  if (max_triangles < 100 || max_triangles > 50'000'000) {
    throw UsageError("at most " + std::to_string(max_triangles) +
                     " triangles; 100 to 50000000 is allowed");
  }
}

Tessellation tessellate(const CadModel& model, const TessellationOptions& options,
                        const Progress& progress) {
  options.check();
  if (model.is_empty()) throw InputError("the model has no shape");
  progress.update(0.0, "looking at faces");
  Tessellation result;
  result.faces = describe_faces(model);
  Choice choice = choose(model, result.faces, options);
  constexpr double kDoubt = 4.0;  // an estimate so many times too large is believed
  const double guess = estimate_all(model, choice.chordal_error, choice.angle);
  if (guess > kDoubt * options.max_triangles) fail_too_many(guess, choice, options, true);
  progress.update(0.1, "tessellating");
  std::vector<int> uncovered = mesh_and_examine(model, result.faces, choice, progress);
  long long count = triangles_of(model);
  while (count > options.max_triangles && !options.chordal_error && can_be_coarser(choice)) {
    coarsen(choice, options);
    uncovered = mesh_and_examine(model, result.faces, choice, progress);
    count = triangles_of(model);
  }
  if (count > options.max_triangles) {
    fail_too_many(static_cast<double>(count), choice, options, false);
  }
  progress.update(0.8, "joining triangles");
  MeshBuilder builder(model, result);
  for (int f = 0; f < model.face_count(); ++f) builder.add_face(f);
  builder.finish();
  if (result.mesh.triangles.empty()) {
    throw InputError("none of its " + std::to_string(model.face_count()) +
                     " faces can be turned into triangles");
  }
  if (!uncovered.empty()) {
    std::string text;
    constexpr std::size_t kMostNamed = 10;
    for (std::size_t i = 0; i < std::min(kMostNamed, uncovered.size()); ++i) {
      text += (i > 0 ? ", " : "") + std::to_string(uncovered[i]);
    }
    if (uncovered.size() > kMostNamed) text += ", ...";
    result.notes.push_back(
        (uncovered.size() == 1 ? "1 face is" : std::to_string(uncovered.size()) + " faces are") +
        " not covered by triangles as they should be (face " + text + ")");
  }
  result.chordal_error = choice.chordal_error;
  result.chordal_reason = choice.reason;
  progress.update(1.0, "tessellated");
  return result;
}

}  // namespace palmar::cad
