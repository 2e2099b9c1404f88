// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/feature_edits.h"

#include <fmt/format.h>

#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "palmar/cad/edits/cut_groove.h"
#include "palmar/cad/edits/edit_fillet.h"
#include "palmar/cad/edits/feature_choice.h"
#include "palmar/cad/edits/offset_faces.h"
#include "palmar/cad/edits/solid_edit.h"
#include "palmar/cad/model/face_relations.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// What is to be changed, by numbers.
struct Resolved {
  std::map<int, double> sharp, rounded;  ///< radius by edge, by face
  std::map<int, double> offset;          ///< by face
  struct Taper {
    std::vector<int> faces;
    double angle = 0.0;
    gp_Ax1 neutral;
  };
  std::vector<Taper> tapers;
  std::string fillet_title, offset_title, taper_title;
};

void add_title(std::string& all, const std::string& one) { all += (all.empty() ? "" : "; ") + one; }

const Blend* find_blend(const std::vector<Blend>& blends, int face) {
  const auto at = std::find_if(blends.begin(), blends.end(),
                               [&](const Blend& blend) { return blend.face == face; });
  return at == blends.end() ? nullptr : &*at;
}

void require_no_blend(const std::vector<Blend>& blends, int face, const char* what) {
  if (const Blend* const blend = find_blend(blends, face)) {
    throw UsageError(
        fmt::format("face {} is a fillet (r {:.4g} mm) and can't be {}; change the "
                    "fillet's radius, or the faces beside it",
                    face, blend->radius, what));
  }
}

Resolved resolve(const CadModel& model, const FeatureEdits& edits,
                 const std::vector<Blend>& blends) {
  Resolved result;
  for (const FilletEdit& edit : edits.fillets) {
    if (!(edit.radius >= 0.0) || !std::isfinite(edit.radius)) {
      throw UsageError(
          fmt::format("fillet of edges \"{}\": a radius of {} mm; 0 or more is allowed", edit.edges,
                      edit.radius));
    }
    const EdgeChoice choice = choose_edges(model, edit.edges);
    for (const int edge : choice.sharp) result.sharp[edge] = edit.radius;
    for (const int face : choice.rounded) result.rounded[face] = edit.radius;
    add_title(result.fillet_title,
              fmt::format("fillet of {:.4g} mm on {}", edit.radius, words_of(choice)));
  }
  for (const OffsetEdit& edit : edits.offsets) {
    if (!std::isfinite(edit.distance)) {
      throw UsageError(fmt::format("offset of faces \"{}\": not a finite distance", edit.faces));
    }
    const std::vector<int> faces = choose_faces(model, edit.faces);
    for (const int face : faces) {
      require_no_blend(blends, face, "moved");
      result.offset[face] = edit.distance;
    }
    add_title(result.offset_title,
              fmt::format("offset of {:+.4g} mm of face{} {}", edit.distance,
                          faces.size() == 1 ? "" : "s", fmt::join(faces, ", ")));
  }
  for (const TaperEdit& edit : edits.tapers) {
    if (!(std::abs(edit.angle) < std::numbers::pi / 4)) {
      throw UsageError(fmt::format("taper of faces \"{}\": {:.4g} deg; below 45 deg is allowed",
                                   edit.faces, degrees(edit.angle)));
    }
    const LongAxis axis = long_axis_of(model.impl());
    const Vec3 point = edit.point.value_or(Vec3(axis.middle.X(), axis.middle.Y(), axis.middle.Z()));
    const Vec3 way =
        edit.direction.value_or(Vec3(axis.direction.X(), axis.direction.Y(), axis.direction.Z()));
    if (!(way.norm() > 0.0)) throw UsageError("taper: its direction has no length");
    const std::vector<int> faces = choose_faces(model, edit.faces);
    for (const int face : faces) require_no_blend(blends, face, "tilted");
    result.tapers.push_back(
        {faces, edit.angle,
         gp_Ax1(gp_Pnt(point.x(), point.y(), point.z()), gp_Dir(way.x(), way.y(), way.z()))});
    add_title(result.taper_title,
              fmt::format("taper of {:.4g} deg of face{} {}", degrees(edit.angle),
                          faces.size() == 1 ? "" : "s", fmt::join(faces, ", ")));
  }
  return result;
}

/// A face that runs smoothly into one that stays can't move without it: the kernel would move both.
void require_whole_moves(const Resolved& wanted, const std::vector<EdgeRelation>& relations,
                         const std::vector<Blend>& blends) {
  const auto distance = [&](int face) {
    const auto at = wanted.offset.find(face);
    return at == wanted.offset.end() ? 0.0 : at->second;
  };
  for (const EdgeRelation& edge : relations) {
    if (!edge.is_smooth || edge.face[0] == 0 || edge.face[1] == 0) continue;
    if (find_blend(blends, edge.face[0]) || find_blend(blends, edge.face[1])) continue;
    if (distance(edge.face[0]) != distance(edge.face[1])) {
      throw NumericalError(fmt::format(
          "{}: can't be made (faces {} and {} run smoothly into one another: they move together or "
          "not at all)",
          wanted.offset_title, edge.face[0], edge.face[1]));
    }
  }
}

/// Fillets that must come off first: those whose radius changes and those on faces that move.
std::vector<int> blends_in_the_way(const Resolved& wanted,
                                   const std::vector<EdgeRelation>& relations,
                                   const std::vector<Blend>& blends, const std::set<int>& own) {
  std::set<int> moving;
  for (const auto& [face, distance] : wanted.offset) moving.insert(face);
  for (const Resolved::Taper& taper : wanted.tapers) {
    moving.insert(taper.faces.begin(), taper.faces.end());
  }
  std::vector<int> chosen;
  for (const Blend& blend : blends) {
    const bool rests_on_moving = std::any_of(blend.support.begin(), blend.support.end(),
                                             [&](int face) { return moving.count(face) > 0; });
    if (own.count(blend.face) > 0 && (rests_on_moving || wanted.rounded.count(blend.face) > 0)) {
      chosen.push_back(blend.face);
    }
  }
  // A sharp edge that ends at a fillet is rounded together with it: corners come out right.
  return blends_removed_with(chosen, relations, blends);
}

std::vector<RoundedEdge> edges_to_round(const Resolved& wanted,
                                        const std::vector<EdgeRelation>& relations,
                                        const std::vector<Blend>& blends,
                                        const std::vector<int>& removed, const std::set<int>& own) {
  const auto is_removed = [&](int face) {
    return std::find(removed.begin(), removed.end(), face) != removed.end();
  };
  std::vector<RoundedEdge> edges;
  for (const auto& [number, radius] : wanted.sharp) {
    const EdgeRelation& edge = relations[number - 1];
    if (own.count(edge.face[0]) == 0 || is_removed(edge.face[0]) || is_removed(edge.face[1])) {
      continue;  // the end of a fillet that is rolled again: a corner comes out there
    }
    edges.push_back({edge.face, edge.middle, radius, 0, true});
  }
  for (const int face : removed) {
    const Blend& blend = *find_blend(blends, face);
    if (blend.support.size() != 2 || is_removed(blend.support[0]) || is_removed(blend.support[1])) {
      continue;  // a corner: comes back by itself
    }
    const auto asked = wanted.rounded.find(face);
    const bool is_asked = asked != wanted.rounded.end();
    edges.push_back({{blend.support[0], blend.support[1]},
                     blend.middle,
                     is_asked ? asked->second : blend.radius,
                     face,
                     is_asked});
  }
  return edges;
}

/// Names and colours of the faces that remain.
CadModel with_names(const CadModel::Impl& before, std::vector<CadModel::Impl::Body> bodies,
                    const std::vector<SolidEdit>& edits) {
  const CadModel made = make_cad_model(std::move(bodies));
  auto impl = std::make_shared<CadModel::Impl>(made.impl());
  for (const SolidEdit& edit : edits) {
    for (const auto& [number, images] : edit.image) {
      const auto name = before.face_name.find(number);
      const auto colour = before.face_colour.find(number);
      for (const TopoDS_Face& face : images) {
        const int now = impl->faces.FindIndex(face);
        if (now == 0) continue;
        if (name != before.face_name.end()) impl->face_name[now] = name->second;
        if (colour != before.face_colour.end()) impl->face_colour[now] = colour->second;
      }
    }
  }
  return CadModel(std::move(impl));
}

}  // namespace

EditedModel edit_features(const CadModel& model, const FeatureEdits& edits) {
  const CadModel::Impl& impl = model.impl();
  if (model.is_empty())
    throw UsageError("the product has no faces, so no feature of it can change");
  const std::vector<EdgeRelation> relations = edge_relations(impl);
  const std::vector<Blend> blends = blends_of(impl, relations);
  const Resolved wanted = resolve(model, edits, blends);
  require_whole_moves(wanted, relations, blends);
  const LongAxis axis = long_axis_of(impl);
  const gp_Ax1 long_line(axis.middle, axis.direction);

  EditedModel result;
  std::vector<CadModel::Impl::Body> bodies;
  std::vector<SolidEdit> done;
  for (const CadModel::Impl::Body& body : impl.bodies) {
    SolidEdit edit;
    edit.solid = body.shape;
    std::set<int> own;
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(body.shape, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) {
      const int number = impl.faces.FindIndex(faces(i));
      own.insert(number);
      edit.image[number] = {TopoDS::Face(faces(i))};
    }
    const std::vector<int> removed = blends_in_the_way(wanted, relations, blends, own);
    const std::vector<RoundedEdge> edges = edges_to_round(wanted, relations, blends, removed, own);
    Resolved here = wanted;
    std::erase_if(here.offset, [&](const auto& one) { return own.count(one.first) == 0; });
    for (Resolved::Taper& taper : here.tapers) {
      std::erase_if(taper.faces, [&](int face) { return own.count(face) == 0; });
    }
    std::erase_if(here.tapers, [](const Resolved::Taper& taper) { return taper.faces.empty(); });
    const bool changes = !edges.empty() || !here.offset.empty() || !here.tapers.empty() ||
                         (!edits.grooves.empty() && impl.bodies.size() == 1);
    if (changes) {
      const std::string whose =
          body.name.empty() ? "the product" : fmt::format("body \"{}\"", body.name);
      edit.solid = checked_solid(body.shape, whose + ", as it is");
      if (!removed.empty()) remove_blends(edit, removed);
      for (const Resolved::Taper& taper : here.tapers) {
        taper_faces(edit, taper.faces, taper.angle, taper.neutral, wanted.taper_title);
      }
      if (!here.offset.empty()) offset_faces(edit, here.offset, wanted.offset_title);
      make_fillets(edit, edges,
                   wanted.fillet_title.empty()
                       ? fmt::format("putting back fillets {}", fmt::join(removed, ", "))
                       : wanted.fillet_title);
      for (const GrooveEdit& groove : edits.grooves) cut_groove(edit, groove, long_line);
      if (removed.size() > wanted.rounded.size()) {
        result.notes.push_back(fmt::format(
            "{} fillets are connected with what was changed and were rolled again with their radii",
            removed.size() - wanted.rounded.size()));
      }
    }
    for (const std::string& note : edit.notes) result.notes.push_back(note);
    CadModel::Impl::Body after = body;
    after.shape = edit.solid;
    result.volume_before += volume_of(body.shape);
    result.volume += volume_of(edit.solid);
    bodies.push_back(std::move(after));
    done.push_back(std::move(edit));
  }
  if (!edits.grooves.empty() && impl.bodies.size() > 1) {
    throw UsageError(
        fmt::format("groove: the product has {} bodies; one is needed", impl.bodies.size()));
  }
  result.model = with_names(impl, std::move(bodies), done);
  return result;
}

}  // namespace palmar::cad
