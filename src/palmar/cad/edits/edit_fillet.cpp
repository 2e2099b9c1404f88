// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/edit_fillet.h"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Defeaturing.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <optional>
#include <set>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

bool has(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

const Blend* blend_of(const std::vector<Blend>& blends, int face) {
  const auto at = std::find_if(blends.begin(), blends.end(),
                               [&](const Blend& blend) { return blend.face == face; });
  return at == blends.end() ? nullptr : &*at;
}

double distance(const gp_Pnt& point, const TopoDS_Shape& shape) {
  return BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(point).Vertex(), shape).Value();
}

/// The edge between what became of two faces, the nearest one to the hint.
std::optional<TopoDS_Edge> edge_between(const SolidEdit& edit, const RoundedEdge& wanted) {
  TopTools_IndexedMapOfShape one, other;
  for (const TopoDS_Face& face : edit.image.at(wanted.face[0])) {
    TopExp::MapShapes(face, TopAbs_EDGE, one);
  }
  for (const TopoDS_Face& face : edit.image.at(wanted.face[1])) {
    TopExp::MapShapes(face, TopAbs_EDGE, other);
  }
  TopTools_IndexedMapOfShape shared;
  for (int i = 1; i <= one.Extent(); ++i) {
    if (other.Contains(one(i))) shared.Add(one(i));
  }
  std::optional<TopoDS_Edge> nearest;
  double least = 0.0;
  for (int i = 1; i <= shared.Extent(); ++i) {
    const double away = shared.Extent() == 1 ? 0.0 : distance(wanted.hint, shared(i));
    if (!nearest || away < least) {
      nearest = TopoDS::Edge(shared(i));
      least = away;
    }
  }
  return nearest;
}

void round(SolidEdit& edit, const std::vector<RoundedEdge>& edges, const std::string& feature) {
  try_feature(feature, [&] {
    BRepFilletAPI_MakeFillet fillet(edit.solid);
    std::vector<std::pair<int, TopoDS_Edge>> made;  // which face becomes what the edge generates
    for (const RoundedEdge& wanted : edges) {
      const std::optional<TopoDS_Edge> edge = edge_between(edit, wanted);
      if (!edge) {
        if (!wanted.is_asked) {
          edit.notes.push_back(
              fmt::format("the fillet of {:.4g} mm that was face {} is gone: the faces beside it "
                          "no longer meet",
                          wanted.radius, wanted.blend));
          continue;
        }
        throw NumericalError(fmt::format("{}: can't be made (faces {} and {} no longer meet)",
                                         feature, wanted.face[0], wanted.face[1]));
      }
      if (fillet.Contour(*edge) == 0) fillet.Add(wanted.radius, *edge);
      if (wanted.blend != 0) made.emplace_back(wanted.blend, *edge);
    }
    if (fillet.NbContours() == 0) return;
    fillet.Build();
    if (!fillet.IsDone()) {
      throw NumericalError(feature + ": can't be made (the faces beside leave no room for it)");
    }
    const TopoDS_Shape solid = checked_solid(fillet.Shape(), feature);
    edit.follow(solid, [&](const TopoDS_Face& face) { return fillet.Modified(face); });
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(solid, TopAbs_FACE, faces);
    for (const auto& [number, edge] : made) {
      for (const TopoDS_Shape& face : fillet.Generated(edge)) {
        if (const int at = faces.FindIndex(face); at > 0) {
          edit.image[number].push_back(TopoDS::Face(faces(at)));
        }
      }
    }
  });
}

}  // namespace

std::vector<int> blends_removed_with(const std::vector<int>& chosen,
                                     const std::vector<EdgeRelation>& relations,
                                     const std::vector<Blend>& blends) {
  std::vector<int> taken = chosen;
  for (size_t i = 0; i < taken.size(); ++i) {
    const Blend* const own = blend_of(blends, taken[i]);
    if (own == nullptr) continue;
    const auto take = [&](int face) {
      if (blend_of(blends, face) != nullptr && !has(taken, face)) taken.push_back(face);
    };
    for (const Blend& blend : blends) {
      if (has(blend.support, own->face)) take(blend.face);
    }
    if (own->support.size() > 2) {
      for (const int face : own->support) take(face);
    }
    for (const EdgeRelation& edge : relations) {
      if (!edge.is_smooth || (edge.face[0] != own->face && edge.face[1] != own->face)) continue;
      const int beyond = edge.face[0] == own->face ? edge.face[1] : edge.face[0];
      const Blend* const next = blend_of(blends, beyond);
      if (next != nullptr && !has(own->sides, edge.edge) && !has(next->sides, edge.edge)) {
        take(beyond);
      }
    }
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

void remove_blends(SolidEdit& edit, const std::vector<int>& faces) {
  const std::string feature =
      fmt::format("removing fillet{} {}", faces.size() == 1 ? "" : "s", fmt::join(faces, ", "));
  try_feature(feature, [&] {
    BRepAlgoAPI_Defeaturing removal;
    removal.SetShape(edit.solid);
    for (const int number : faces) {
      for (const TopoDS_Face& face : edit.image.at(number)) removal.AddFaceToRemove(face);
    }
    removal.Build();
    if (!removal.IsDone() || removal.HasErrors()) {
      throw NumericalError(feature + ": the faces beside don't meet when they are extended");
    }
    const TopoDS_Shape solid = checked_solid(removal.Shape(), feature);
    edit.follow(solid, [&](const TopoDS_Face& face) { return removal.Modified(face); });
  });
  for (const int number : faces) {
    if (!edit.image.at(number).empty()) {
      throw NumericalError(fmt::format(
          "{}: the faces beside fillet {} don't meet when they are extended", feature, number));
    }
    edit.image.erase(number);
  }
}

void make_fillets(SolidEdit& edit, std::vector<RoundedEdge> edges, const std::string& feature) {
  std::erase_if(edges, [](const RoundedEdge& edge) { return edge.radius <= 0.0; });
  if (edges.empty()) return;
  // Those that were asked for first: in a run of smooth edges the first one's radius counts.
  std::stable_sort(edges.begin(), edges.end(), [](const RoundedEdge& a, const RoundedEdge& b) {
    return a.is_asked != b.is_asked ? a.is_asked : a.radius > b.radius;
  });
  std::set<double, std::greater<>> radii;
  for (const RoundedEdge& edge : edges) radii.insert(edge.radius);
  const SolidEdit before = edit;
  try {
    round(edit, edges, feature);
    return;
  } catch (const NumericalError&) {
    if (radii.size() == 1) throw;
    edit = before;
  }
  for (const double radius : radii) {
    std::vector<RoundedEdge> now;
    for (const RoundedEdge& edge : edges) {
      if (edge.radius == radius) now.push_back(edge);
    }
    round(edit, now, feature);
  }
}

}  // namespace palmar::cad
