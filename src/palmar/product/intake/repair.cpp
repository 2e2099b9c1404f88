// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/repair/fill_holes.h"
#include "palmar/geometry/repair/low_triangles.h"
#include "palmar/geometry/repair/orient.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/geometry/repair/separate_sheets.h"
#include "palmar/geometry/repair/weld.h"

namespace palmar::product {
namespace {

constexpr double kWeldShare = 1e-6;  // of the diagonal; single-precision files round to about 1e-7
constexpr double kHoleShare = 0.2;
constexpr double kSpeckShare = 0.01;
constexpr double kMostWeldShare = 0.05;
constexpr double kGap = 4.0;      // times the weld's tolerance between solids that touched
constexpr double kCrack = 100.0;  // times the weld's tolerance: narrower holes are cracks
constexpr int kMaxPasses = 5;
constexpr std::size_t kMostPlaces = 20;

std::string place_text(const Vec3& x) {
  std::array<char, 96> text{};
  const auto rounded = [](double value) { return std::round(10.0 * value) / 10.0 + 0.0; };
  std::snprintf(text.data(), text.size(), "(%.1f, %.1f, %.1f) mm", rounded(x.x()), rounded(x.y()),
                rounded(x.z()));
  return text.data();
}

int size_of(const std::vector<Vec3>& places) { return static_cast<int>(places.size()); }

Vec3 centre_of(const geometry::TriangleMesh& mesh, int t) {
  const Triangle& k = mesh.triangles[t];
  return (mesh.vertices[k[0]] + mesh.vertices[k[1]] + mesh.vertices[k[2]]) / 3.0;
}

/// Box round what the triangles use.
Box3 used_box(const geometry::TriangleMesh& mesh) {
  Box3 box;
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[v]);
  }
  return box;
}

/// Triangles grouped by a number each (negative: none), with their boxes.
struct Groups {
  std::vector<Box3> box;
  std::vector<int> triangles;

  Groups(const geometry::TriangleMesh& mesh, const std::vector<int>& group) {
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      if (group[t] < 0) continue;
      box.resize(std::max<std::size_t>(box.size(), group[t] + 1));
      triangles.resize(box.size(), 0);
      ++triangles[group[t]];
      for (const int v : mesh.triangles[t]) box[group[t]].extend(mesh.vertices[v]);
    }
  }
};

/// Patch of each triangle: joined over edges of exactly two triangles.
std::vector<int> patches_of(const geometry::TriangleMesh& mesh,
                            const geometry::MeshTopology& topology) {
  std::vector<int> patch(mesh.triangles.size(), -1);
  int count = 0;
  std::vector<int> open;
  for (int seed = 0; seed < mesh.triangle_count(); ++seed) {
    if (patch[seed] >= 0) continue;
    patch[seed] = count;
    open = {seed};
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int other = topology.twin[h] < 0 ? -1 : topology.twin[h] / 3;
        if (other < 0 || patch[other] >= 0) continue;
        patch[other] = count;
        open.push_back(other);
      }
    }
    ++count;
  }
  return patch;
}

/// One run over a mesh; every step appends to what was done or is left.
class Repairer {
 public:
  Repairer(const geometry::TriangleMesh& mesh, const RepairOptions& options) {
    options.check();
    const Box3 box = used_box(mesh);
    const double diagonal = box.isEmpty() ? 0.0 : box.diagonal().norm();
    if (!(diagonal > 0.0)) throw InputError("repair: the mesh has no triangles with an area");
    result_.mesh = mesh;
    result_.limits = repair_limits(options, diagonal);
  }

  RepairResult run() && {
    // What one step mends may show the next one its work: until nothing changes.
    for (int pass = 0; pass < kMaxPasses; ++pass) {
      const std::size_t before = result_.done.size();
      holes_left_.clear();
      touching_left_.clear();
      join_vertices();
      drop_fins();
      drop_specks();
      turn_outwards();
      repair_low();
      if (close_holes()) {
        repair_low();
        turn_outwards();
      }
      part_solids();
      if (result_.done.size() == before) break;
    }
    report_what_is_left();
    return std::move(result_);
  }

 private:
  geometry::TriangleMesh& mesh() { return result_.mesh; }
  const RepairLimits& limits() const { return result_.limits; }

  void add(std::vector<RepairAction>& list, const std::string& name, int count,
           const std::string& text, std::vector<Vec3> places) {
    if (count == 0) return;
    std::string sentence = text;
    if (!places.empty()) {
      sentence += places.size() == 1 ? ", at " : ", first at ";
      sentence += place_text(places.front());
    }
    places.resize(std::min(places.size(), kMostPlaces));
    list.push_back({name, count, sentence, std::move(places)});
  }

  void join_vertices() {
    geometry::WeldResult welded = geometry::weld(mesh(), {.tolerance = limits().weld});
    std::vector<Vec3> places;
    for (int v = 0; v < mesh().vertex_count(); ++v) {
      const int to = welded.new_of_old[v];
      if (to >= 0 && welded.old_of_new[to] != v) places.push_back(mesh().vertices[v]);
    }
    add(result_.done, "weld", welded.merged_vertices,
        "joined " + counted(welded.merged_vertices, "vertex", "vertices") + " to others within " +
            significant(limits().weld, 4) + " mm",
        std::move(places));
    add(result_.done, "low triangles", welded.dropped_degenerate,
        "dropped " + counted(welded.dropped_degenerate, "triangle", "triangles") +
            " of which two corners became one",
        {});
    add(result_.done, "duplicates", welded.dropped_duplicate,
        "dropped " + counted(welded.dropped_duplicate, "triangle", "triangles") +
            " that stood there twice",
        {});
    if (welded.mesh.triangles.empty() || !(geometry::surface_area(welded.mesh) > 0.0)) {
      throw InputError("repair: the mesh has no triangles with an area");
    }
    mesh() = std::move(welded.mesh);
  }

  void repair_low() {
    geometry::LowTrianglesResult repaired = geometry::repair_low_triangles(mesh(), limits().weld);
    if (repaired.mesh.triangles.empty()) return;
    const int count = size_of(repaired.places);
    add(result_.done, "low triangles", count,
        "repaired " + counted(count, "triangle", "triangles") + " without area",
        std::move(repaired.places));
    low_left_ = std::move(repaired.left);
    mesh() = std::move(repaired.mesh);
    forget_unused();
  }

  /// Vertices that no triangle uses any more.
  void forget_unused() {
    geometry::WeldResult kept =
        geometry::weld(mesh(), {.tolerance = 0.0, .drops_duplicates = false});
    if (kept.dropped_unused > 0) mesh() = std::move(kept.mesh);
  }

  template <typename IsKept>
  void keep_triangles(const IsKept& is_kept) {
    std::vector<Triangle> kept;
    for (int t = 0; t < mesh().triangle_count(); ++t) {
      if (is_kept(t)) kept.push_back(mesh().triangles[t]);
    }
    mesh().triangles = std::move(kept);
    forget_unused();
  }

  void drop_fins() {
    const geometry::MeshTopology topology = geometry::build_topology(mesh());
    if (geometry::non_manifold_edges(topology).empty()) return;
    const std::vector<int> patch = patches_of(mesh(), topology);
    const Groups groups(mesh(), patch);
    std::vector<bool> hangs(groups.box.size(), false), is_free(groups.box.size(), false);
    for (int h = 0; h < static_cast<int>(topology.edge_of.size()); ++h) {
      if (topology.edge_of[h] < 0) continue;
      const int use = topology.edge_use[topology.edge_of[h]];
      if (use > 2) hangs[patch[h / 3]] = true;
      if (use == 1) is_free[patch[h / 3]] = true;
    }
    const auto is_fin = [&](std::size_t p) {
      return hangs[p] && is_free[p] && groups.box[p].diagonal().norm() < limits().speck;
    };
    drop_groups(groups, patch, is_fin, "fins", "fin", "fins", "that hung on an edge");
  }

  void drop_specks() {
    const std::vector<int> piece =
        geometry::triangle_components(mesh(), geometry::build_topology(mesh()));
    const Groups groups(mesh(), piece);
    std::size_t largest = 0;
    for (std::size_t p = 1; p < groups.box.size(); ++p) {
      if (groups.box[p].diagonal().norm() > groups.box[largest].diagonal().norm()) largest = p;
    }
    const auto is_speck = [&](std::size_t p) {
      return p != largest && groups.box[p].diagonal().norm() < limits().speck;
    };
    drop_groups(groups, piece, is_speck, "specks", "speck", "specks",
                "below " + significant(limits().speck, 4) + " mm");
  }

  template <typename IsGone>
  void drop_groups(const Groups& groups, const std::vector<int>& group, const IsGone& is_gone,
                   const std::string& name, const std::string& one, const std::string& many,
                   const std::string& what) {
    std::vector<Vec3> places;
    int triangles = 0;
    for (std::size_t p = 0; p < groups.box.size(); ++p) {
      if (!is_gone(p)) continue;
      places.push_back(groups.box[p].center());
      triangles += groups.triangles[p];
    }
    if (places.empty() || triangles == mesh().triangle_count()) return;
    keep_triangles([&](int t) { return group[t] < 0 || !is_gone(group[t]); });
    const int count = size_of(places);
    add(result_.done, name, count,
        "dropped " + counted(count, one, many) + " " + what + " (" +
            counted(triangles, "triangle", "triangles") + ")",
        std::move(places));
  }

  void turn_outwards() {
    geometry::OrientResult oriented = geometry::orient_outwards(mesh());
    twisted_ = oriented.twisted_patches;
    undecided_ = oriented.undecided_patches;
    doubtful_ = 0;
    if (oriented.flipped_triangles.empty()) return;
    // Small open patches may be turned to and fro: what isn't settled by turning stays as it was.
    const std::vector<int> back = geometry::orient_outwards(oriented.mesh).flipped_triangles;
    std::vector<int> turned;
    for (const int t : oriented.flipped_triangles) {
      if (std::binary_search(back.begin(), back.end(), t)) {
        oriented.mesh.triangles[t] = mesh().triangles[t];
        ++doubtful_;
      } else {
        turned.push_back(t);
      }
    }
    const int count = static_cast<int>(turned.size());
    std::vector<Vec3> places;
    for (const int t : turned) {
      if (places.size() < kMostPlaces) places.push_back(centre_of(mesh(), t));
    }
    add(result_.done, "orientation", count,
        "turned " + counted(count, "triangle", "triangles") + " outwards (of " +
            std::to_string(mesh().triangle_count()) + ")",
        std::move(places));
    mesh() = std::move(oriented.mesh);
  }

  bool close_holes() {
    geometry::FillHolesResult filled = geometry::fill_holes(
        mesh(), {.longest_perimeter = limits().hole, .crack_width = kCrack * limits().weld});
    std::vector<Vec3> places;
    int triangles = 0;
    double area = 0.0, longest = 0.0;
    for (std::size_t i = 0; i < filled.holes.size(); ++i) {
      const geometry::HoleOutcome& hole = filled.holes[i];
      if (!hole.is_filled) {
        const std::string name = "hole " + std::to_string(i + 1) + " of " +
                                 std::to_string(filled.holes.size()) + " (" +
                                 std::to_string(hole.loop.size()) + " edges, " +
                                 significant(hole.loop.perimeter, 4) + " mm round) ";
        holes_left_.push_back({"holes", 1, name + hole.reason, {hole.loop.centre}});
        continue;
      }
      places.push_back(hole.loop.centre);
      triangles += hole.triangles;
      area += hole.area;
      longest = std::max(longest, hole.loop.perimeter);
    }
    const int count = filled.filled;
    add(result_.done, "holes", count,
        "filled " + counted(count, "hole", "holes") + " with " +
            counted(triangles, "triangle", "triangles") + ", " + significant(area, 4) +
            " mm^2; the longest rim is " + significant(longest, 4) + " mm",
        std::move(places));
    mesh() = std::move(filled.mesh);
    return count > 0;
  }

  void part_solids() {
    geometry::SeparatedSheets separated =
        geometry::separate_touching_sheets(mesh(), kGap * limits().weld);
    if (separated.doubled.empty()) return;
    const int count = size_of(separated.doubled);
    if (geometry::find_self_crossings(separated.mesh).size() >
        geometry::find_self_crossings(mesh()).size()) {
      add(touching_left_, "touching", count,
          "what touches in " + counted(count, "corner", "corners") +
              " would go through itself if taken apart",
          std::move(separated.doubled));
      return;
    }
    add(result_.done, "touching", count,
        "took apart what touched in " + counted(count, "corner", "corners") +
            (separated.separated_edges.empty()
                 ? std::string()
                 : " and " + counted(size_of(separated.separated_edges), "edge", "edges")) +
            ", by " + significant(kGap * limits().weld, 4) + " mm",
        std::move(separated.doubled));
    mesh() = std::move(separated.mesh);
  }

  void report_what_is_left() {
    auto& left = result_.left;
    for (RepairAction& hole : holes_left_) {
      add(left, hole.name, 1, hole.text, std::move(hole.places));
    }
    left.insert(left.end(), touching_left_.begin(), touching_left_.end());
    const geometry::MeshTopology topology = geometry::build_topology(mesh());
    const geometry::BoundaryLoops loops = geometry::find_boundary_loops(mesh(), topology);
    add(left, "holes", loops.loose_edges,
        counted(loops.loose_edges, "free edge is", "free edges are") +
            " round no hole: the triangles there disagree about outside",
        {});
    std::vector<Vec3> places;
    for (const auto& edge : geometry::non_manifold_edges(topology)) {
      places.push_back((mesh().vertices[edge[0]] + mesh().vertices[edge[1]]) / 2.0);
    }
    int count = size_of(places);
    add(left, "edges", count,
        counted(count, "edge has", "edges have") +
            " more than two triangles that bound no solids apart: a wall inside, or a fin",
        std::move(places));
    const auto crossings = geometry::find_self_crossings(mesh());
    places.clear();
    for (const auto& pair : crossings) {
      if (places.size() < kMostPlaces) places.push_back(centre_of(mesh(), pair[0]));
    }
    count = static_cast<int>(crossings.size());
    add(left, "crossings", count,
        counted(count, "pair", "pairs") +
            " of triangles go through each other: where solids do, unite them in the program they "
            "come "
            "from",
        std::move(places));
    count = size_of(low_left_);
    add(left, "low triangles", count,
        counted(count, "triangle has", "triangles have") +
            " no area, and no neighbour to join with",
        std::move(low_left_));
    add(left, "sides", twisted_,
        counted(twisted_, "patch is", "patches are") + " one-sided like a Moebius band", {});
    add(left, "sides", undecided_,
        "of " + counted(undecided_, "patch", "patches") +
            " it can't be determined which side is outside",
        {});
  }

  RepairResult result_;
  std::vector<Vec3> low_left_;
  std::vector<RepairAction> holes_left_, touching_left_;
  int twisted_ = 0, undecided_ = 0, doubtful_ = 0;
};

void require_length(const char* name, const std::optional<double>& value) {
  if (!value || (std::isfinite(*value) && *value >= 0.0)) return;
  throw UsageError(std::string("repair: ") + name + " is " + significant(*value, 4) +
                   " mm; a finite length of at least 0 is required");
}

}  // namespace

void RepairOptions::check() const {
  require_length("the weld's tolerance", weld);
  require_length("the longest hole", hole);
  require_length("the largest speck", speck);
}

RepairLimits repair_limits(const RepairOptions& options, double diagonal) {
  options.check();
  const RepairLimits limits = {options.weld.value_or(kWeldShare * diagonal),
                               options.hole.value_or(kHoleShare * diagonal),
                               options.speck.value_or(kSpeckShare * diagonal)};
  const auto require = [&](const char* name, double value, double most) {
    if (value <= most) return;
    throw UsageError(std::string("repair: ") + name + " is " + significant(value, 4) +
                     " mm; for a product with a diagonal of " + significant(diagonal, 4) +
                     " mm up to " + significant(most, 4) + " mm is allowed");
  };
  require("the weld's tolerance", limits.weld, kMostWeldShare * diagonal);
  require("the largest speck", limits.speck, diagonal / 2.0);
  return limits;
}

RepairResult repair_mesh(const geometry::TriangleMesh& mesh, const RepairOptions& options) {
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.vertices[v].allFinite()) continue;
    throw InputError("repair: vertex " + std::to_string(v) +
                     " is not finite; finite coordinates are required");
  }
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && v < mesh.vertex_count()) continue;
      throw InputError("repair: triangle " + std::to_string(t) + " names vertex " +
                       std::to_string(v) + "; there are " + std::to_string(mesh.vertex_count()) +
                       " vertices");
    }
  }
  return Repairer(mesh, options).run();
}

std::vector<std::string> fix_list(const ProductCheck& check, const RepairLimits& limits) {
  std::vector<std::string> fixes;
  if (check.boundary_edges > 0) {
    const int small =
        static_cast<int>(std::count_if(check.hole_perimeters.begin(), check.hole_perimeters.end(),
                                       [&](double length) { return length <= limits.hole; }));
    const int large = static_cast<int>(check.hole_perimeters.size()) - small;
    if (small > 0) {
      fixes.push_back("holes: `palmar product repair` fills those up to " +
                      significant(limits.hole, 4) + " mm round (" + std::to_string(small) +
                      ") where a patch fits");
    }
    if (large > 0) {
      const double longest =
          *std::max_element(check.hole_perimeters.begin(), check.hole_perimeters.end());
      fixes.push_back("openings: " + std::to_string(large) + " of more than " +
                      significant(limits.hole, 4) +
                      " mm round stay; close them in the program they come "
                      "from, or all up to the longest with `palmar product repair --hole-mm " +
                      significant(std::ceil(longest), 4) + "`");
    }
    if (small + large == 0) {
      fixes.push_back(
          "free edges: `palmar product repair` joins vertices and turns triangles; if "
          "edges stay free, export the surface as one solid");
    }
  }
  if (check.duplicate_triangles > 0) {
    fixes.push_back("duplicate triangles: `palmar product repair` drops them");
  }
  if (check.low_triangles > 0) {
    fixes.push_back("triangles without area: `palmar product repair` joins them with neighbours");
  }
  if (check.non_manifold_edges > 0) {
    fixes.push_back(
        "edges with more than two triangles: `palmar product repair` takes apart solids "
        "that touch and drops small fins; walls inside a solid are removed in CAD");
  }
  if (check.is_inverted || check.flipped_triangles > 0) {
    fixes.push_back("orientation: `palmar product repair` turns triangles outwards");
  }
  if (check.tiny_parts > 0) {
    fixes.push_back("specks: `palmar product repair` drops pieces below " +
                    significant(limits.speck, 4) + " mm");
  }
  if (check.undecided_patches > 0 || check.twisted_patches > 0) {
    fixes.push_back(
        "patches without an outside: close or remove them in the program they come from");
  }
  if (check.crossing_pairs > 0) {
    fixes.push_back(
        check.parts - check.tiny_parts > 1
            ? "crossing triangles: unite the solids in the program they come from; they are "
              "assessed all the same, inside is where the winding number says so"
            : "crossing triangles of one body: finer ones if it comes from CAD "
              "(`--chordal-error-mm`), "
              "else remove the fold; it is assessed all the same, inside is where the winding "
              "number says so");
  }
  if (check.parts - check.tiny_parts > 1) {
    fixes.push_back("separate parts: none if the product has several bodies; otherwise keep one");
  }
  if (check.is_too_big || check.is_too_small) {
    fixes.push_back("size: check the unit, or scale the product by hand");
  }
  return fixes;
}

}  // namespace palmar::product
