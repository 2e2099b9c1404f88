// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/photo_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "hands/capture/photo/surface/flat_patches.h"
#include "hands/capture/photo/surface/outline_by_depth.h"
#include "hands/capture/photo/surface/over_views.h"
#include "hands/imaging/distance_transform.h"
#include "hands/imaging/iso_surface.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/plane_cut.h"
#include "palmar/geometry/repair/weld.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr std::size_t kFewest = 6;  // photographs

// One of every five photographs (rigs of six cameras take turns) is compared with its neighbours
// first: where patches correlate badly, larger ones are taken.
constexpr std::size_t kTriedOf = 5;
constexpr double kUnlike = 0.25;  // 1 - correlation, median
constexpr int kWideRadius = 5;    // pixels

/// Median of what patches of the hand cost that have one.
double usual_cost(const std::vector<DepthMap>& maps) {
  constexpr float kNoCost = 2.0F;
  std::vector<float> costs;
  for (const DepthMap& map : maps) {
    std::copy_if(map.cost.begin(), map.cost.end(), std::back_inserter(costs),
                 [](float cost) { return cost < kNoCost; });
  }
  return static_cast<double>(statistics::median(std::move(costs)));
}

/// Which of the parts that triangles belong to has the largest area.
int largest(const geometry::TriangleMesh& mesh, const std::vector<int>& part) {
  std::vector<double> area(1, 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto p = static_cast<std::size_t>(std::max(0, part[t]));
    if (p >= area.size()) area.resize(p + 1, 0.0);
    const auto& [a, b, c] = mesh.triangles[t];
    area[p] += geometry::triangle_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  }
  return static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
}

geometry::TriangleMesh largest_part(const geometry::TriangleMesh& mesh) {
  const std::vector<int> part = geometry::triangle_components(mesh, geometry::build_topology(mesh));
  if (std::all_of(part.begin(), part.end(), [](int p) { return p <= 0; })) return mesh;
  const int best = largest(mesh, part);
  geometry::TriangleMesh kept{mesh.vertices, {}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (part[t] == best) kept.triangles.push_back(mesh.triangles[t]);
  }
  return geometry::weld(kept, {.drops_duplicates = false}).mesh;
}

/// Leaves out what is a guess, and pieces that then hang loose: what is behind a hand makes
/// surfaces of its own where it isn't distinguished from the hand.
void keep_measured(PhotoModel& model) {
  geometry::TriangleMesh& mesh = model.skin.mesh;
  const auto is_measured = [&model](int v) { return model.measured[v] != 0; };
  std::erase_if(mesh.triangles,
                [&](const Triangle& t) { return !std::all_of(t.begin(), t.end(), is_measured); });
  const std::vector<int> part = geometry::triangle_components(mesh, geometry::build_topology(mesh));
  const int best = largest(mesh, part);
  std::vector<int> renumbered(mesh.vertices.size(), -1);
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (part[t] != best) continue;
    kept.push_back(mesh.triangles[t]);
    for (const int v : kept.back()) renumbered[v] = 0;
  }
  std::size_t used = 0;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] < 0) continue;
    renumbered[v] = static_cast<int>(used);
    mesh.vertices[used] = mesh.vertices[v];
    model.skin.colour[used] = model.skin.colour[v];
    model.views[used] = model.views[v];
    model.measured[used++] = model.measured[v];
  }
  mesh.vertices.resize(used);
  model.skin.colour.resize(used);
  model.views.resize(used);
  model.measured.resize(used);
  for (Triangle& t : kept) {
    for (int& v : t) v = renumbered[v];
  }
  mesh.triangles = std::move(kept);
}

/// What lies above a height; a little higher where the plane grazes the surface.
geometry::TriangleMesh cut_above(const geometry::TriangleMesh& mesh, double height) {
  constexpr int kTries = 12;
  constexpr double kShift = 0.23, kSnap = 0.05;  // mm
  for (int i = 0;; ++i) {
    try {
      return geometry::cut_by_plane(mesh, Vec3(0, 0, height + i * kShift), Vec3::UnitZ(), kSnap)
          .mesh;
    } catch (const InputError&) {
      if (i == kTries) throw;
    }
  }
}

/// How many pixels of a photograph are hand, have a depth, and have one that others agree with.
PhotoUse use_of(const PhotoMask& mask, const DepthMap& map) {
  PhotoUse use;
  use.mask_share = mask.box_share;
  use.around_share = mask.around_share;
  const auto inside = static_cast<double>(
      std::count_if(map.cost.begin(), map.cost.end(), [](float cost) { return cost < 2.0F; }));
  const auto deep = static_cast<double>(
      std::count_if(map.depth.begin(), map.depth.end(), [](float d) { return d > 0.0F; }));
  use.depth_share = inside == 0.0 ? 0.0 : deep / inside;
  return use;
}

/// Masks without what was added round the hand, and a little less: what lies on the very edge is
/// mixed with what is behind.
std::vector<PhotoOutline> outlines_of(const std::vector<PhotoView>& views,
                                      const std::vector<PhotoMask>& masks,
                                      const PhotoMaskOptions& options) {
  constexpr double kMixed = 0.5;  // mm
  std::vector<PhotoOutline> outlines(views.size());
  parallel_for(static_cast<int>(views.size()), [&](int i) {
    imaging::VolumeGrid grid;
    grid.size = {views[i].width(), views[i].height(), 1};
    outlines[i] = {
        views[i].camera,
        imaging::eroded(grid, masks[i].inside, (options.grow + kMixed) / masks[i].pixel_size),
        masks[i].paper};
  });
  return outlines;
}

/// Share of the hand's pixels that show a lamp's mirror image, or are overexposed.
double glare_share(const PhotoView& view, const PhotoOutline& outline) {
  constexpr float kWhite = 247.0F;
  double inside = 0.0, bright = 0.0;
  for (std::size_t p = 0; p < outline.inside.size(); ++p) {
    inside += outline.inside[p];
    bright += outline.inside[p] != 0 && view.grey[p] > kWhite ? 1.0 : 0.0;
  }
  return inside > 0.0 ? bright / inside : 0.0;
}

/// What a user should know of the light.
void note_light(PhotoModel& model) {
  // Matt skin has less than 0.02, noise of 16 steps and moved lamps included.
  constexpr double kShines = 0.025, kMoves = 0.13;
  if (model.light.gloss > kShines) {
    model.warnings.push_back(fmt::format(
        "the skin shines: in 2 % of what the photographs show of it mirrored lamps make it {:.0f} "
        "% or more brighter, and they wander over it from photograph to photograph; dry or "
        "powdered skin and soft light help",
        100.0 * model.light.gloss));
  }
  if (model.light.change > kMoves) {
    model.warnings.push_back(fmt::format(
        "the light on the hand changes by {:.0f} % from photograph to photograph: lamps must stand "
        "still beside the hand, none on the cameras, no flash",
        100.0 * model.light.change));
  }
}

}  // namespace

void PhotoModelOptions::check() const {
  if (box.isEmpty() || box.sizes().minCoeff() < 20.0 || box.sizes().maxCoeff() > 1000.0) {
    throw UsageError("the box of the hand: edges of 20 to 1000 mm are allowed");
  }
  if (!(pixel >= 0.1 && pixel <= 5.0)) {
    throw UsageError(fmt::format("pixel {:g} mm; 0.1 to 5 mm is allowed", pixel));
  }
  if (!(cut >= 0.0 && cut <= 200.0)) {
    throw UsageError(fmt::format("cut {:g} mm; 0 to 200 mm is allowed", cut));
  }
  mask.check();
  hull.check();
  stereo.check();
  fusion.check();
  surface.check();
  colours.check();
}

PhotoModel make_photo_model(const std::vector<Photograph>& photographs,
                            const PhotoModelOptions& options, const Progress& progress) {
  options.check();
  const std::size_t count = photographs.size();
  if (count < kFewest) {
    throw InputError(fmt::format(
        "{} photographs with a known camera; at least {} are needed, 36 in two rings are advised",
        count, kFewest));
  }
  const Vec3 middle = options.box.center();
  PhotoModel model;
  model.reduction = reduction_for(photographs, middle, options.pixel);

  std::vector<PhotoView> views(count);
  std::vector<PackedView> packs(count);
  std::vector<PhotoMask> masks(count);
  over_views(count, part_of(progress, 0.0, 0.08), "finding the outlines", [&](std::size_t v) {
    views[v] = make_view(photographs[v], model.reduction);
    packs[v] = packed(views[v]);
    masks[v] = mask_hand(views[v], options.box, options.board_half, options.mask);
  });
  std::vector<double> shares, around;
  for (const PhotoMask& mask : masks) {
    shares.push_back(mask.box_share);
    around.push_back(mask.around_share);
  }
  // A narrow box may be full of hand before a plain backdrop, which shows beside it.
  constexpr double kShowsLittle = 0.5, kLittleAround = 0.15;
  model.has_background =
      statistics::median(shares) > kShowsLittle && statistics::median(around) > kLittleAround;
  double begin = 0.12;  // of the fine stereo
  if (model.has_background) {
    begin = 0.4;
    narrow_by_depth(photographs, views, options, masks, part_of(progress, 0.08, begin));
    model.warnings.push_back(
        "the hand's colour doesn't distinguish it from what is behind it; its outline was found by "
        "comparing photographs, which takes longer and is less certain: a plain blue or grey "
        "backdrop helps");
  }
  progress.update(model.has_background ? begin : 0.09, "carving the outline");
  const VisualHull hull = make_visual_hull(views, masks, options.box, options.hull);
  model.hull_volume = geometry::signed_volume(hull.surface);
  const Box3 filled = geometry::bounding_box(hull.surface);
  const double edge = 1.5 * options.hull.spacing;
  if (filled.max().z() > options.box.max().z() - edge ||
      (filled.min().head<2>().array() < options.box.min().head<2>().array() + edge).any() ||
      (filled.max().head<2>().array() > options.box.max().head<2>().array() - edge).any()) {
    model.warnings.push_back(
        "something reaches the border of the space that is searched, which cuts it off there; a "
        "larger one may be needed (setting \"box\"), or a plain backdrop");
  }
  const Vec3 centre = geometry::bounding_box(hull.surface).center();
  const std::vector<std::vector<int>> sources = choose_sources(views, centre, options.stereo);
  const auto lonely = static_cast<std::size_t>(std::count_if(
      sources.begin(), sources.end(), [](const std::vector<int>& s) { return s.size() < 2; }));
  if (2 * lonely > count) {
    throw InputError(fmt::format(
        "{} of {} photographs have no two others taken from a direction 4 to 50 degrees away: "
        "their views of the hand don't overlap",
        lonely, count));
  }
  std::vector<Vec3> centres;
  for (const Photograph& photograph : photographs) centres.push_back(photograph.camera.centre());
  model.heights = camera_heights(centres, centre);
  if (model.heights.are_one) {
    model.warnings.push_back(fmt::format(
        "one height only: the cameras all look from {:.0f} degrees or so above the board; what "
        "faces them badly is less certain, and less of the surface counts as measured; take as "
        "many photographs again from 15 to 25 degrees {}",
        model.heights.usual, model.heights.usual < 35.0 ? "higher" : "lower"));
  }
  const geometry::RayQuery bound(hull.surface);
  std::vector<DepthMap> maps(count);
  PatchMatchOptions stereo = options.stereo;
  const auto match = [&](std::size_t v) {
    maps[v] = match_patches(views, packs, static_cast<int>(v), masks[v], sources[v], bound,
                            hull.surface, stereo);
  };
  const std::size_t tried = (count + kTriedOf - 1) / kTriedOf;
  const double compared = begin + (0.75 - begin) / kTriedOf;
  over_views(tried, part_of(progress, begin, compared), "comparing photographs",
             [&](std::size_t k) { match(k * kTriedOf); });
  if (usual_cost(maps) > kUnlike) {
    stereo.radius = std::max(stereo.radius, kWideRadius);
    maps.assign(count, {});
    model.warnings.emplace_back(
        "the photographs hardly show the skin's texture (dark or shining skin, noise, strong "
        "compression): they were compared in larger patches, which takes longer and smooths what "
        "is small; more light helps");
  }
  over_views(count, part_of(progress, compared, 0.75), "comparing photographs", [&](std::size_t v) {
    if (maps[v].cost.empty()) match(v);
  });
  progress.update(0.75, "keeping what agrees");
  DepthFusionOptions fusion = options.fusion;
  fusion.patch_radius = stereo.radius;
  constexpr std::size_t kSparse = 18;
  if (count <= kSparse) fusion.least_views = std::min(fusion.least_views, 2);
  FusedDepths fused = fuse_depths(views, maps, centre, fusion);
  const std::vector<PhotoOutline> outlines = outlines_of(views, masks, options.mask);
  for (std::size_t v = 0; v < count; ++v) {
    PhotoUse use = use_of(masks[v], maps[v]);
    use.glare_share = glare_share(views[v], outlines[v]);
    const auto deep = static_cast<double>(std::count_if(maps[v].depth.begin(), maps[v].depth.end(),
                                                        [](float d) { return d > 0.0F; }));
    use.kept_share = deep == 0.0 ? 0.0 : static_cast<double>(fused.kept[v]) / deep;
    model.photographs.push_back(use);
  }
  model.points = fused.points.size();
  std::vector<double> glare;
  for (const PhotoUse& use : model.photographs) glare.push_back(use.glare_share);
  const double usual_glare = statistics::median(glare);
  constexpr double kMuchGlare = 0.003;
  if (usual_glare > kMuchGlare) {
    model.warnings.push_back(fmt::format(
        "the hand mirrors lamps or is overexposed ({:.1f} % of its pixels are white): shapes and "
        "marks are uncertain there; dry or powdered skin and soft light help",
        100.0 * usual_glare));
  }
  constexpr std::size_t kFewPoints = 5000;
  if (model.points < kFewPoints) {
    throw InputError(fmt::format(
        "the photographs agree about {} points of the hand only: they are blurred, the hand moved "
        "between them, or its skin shows nothing but gloss",
        model.points));
  }
  views = {};
  packs = {};
  maps = {};
  masks = {};

  const PoissonField field = fit_poisson_field(fused.points, hull.occupancy, options.surface,
                                               part_of(progress, 0.8, 0.93));
  if (!field.has_converged) {
    throw NumericalError(
        fmt::format("the surface through {} points: residual {:.2g} after {} steps", model.points,
                    field.residual, field.iterations));
  }
  progress.update(0.93, "covering it with triangles");
  const PointCells cells(fused.points);
  fused = {};
  geometry::TriangleMesh mesh =
      without_flat_patches(largest_part(imaging::iso_surface(field.field, 0.0)), cells);
  mesh = largest_part(cut_above(mesh, options.cut));
  progress.update(0.95, "colouring it");
  VertexColours colours = colour_vertices(mesh, photographs, outlines, options.colours);
  for (std::size_t v = 0; v < count; ++v) model.photographs[v].gain = colours.gain[v];
  model.light = colours.light;
  note_light(model);

  std::vector<float> density(mesh.vertices.size());
  for (std::size_t i = 0; i < density.size(); ++i) {
    density[i] = imaging::value_at(field.density, field.density.grid.to_voxel(mesh.vertices[i]));
  }
  model.measured = measured_vertices(mesh, cells, density, colours.views, model.heights.are_one);
  const std::vector<double> areas = geometry::vertex_areas(mesh);
  double area = 0.0, measured = 0.0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    area += areas[i];
    measured += model.measured[i] != 0 ? areas[i] : 0.0;
  }
  model.measured_share = area > 0.0 ? measured / area : 0.0;
  model.views = std::move(colours.views);
  model.skin = {std::move(mesh), std::move(colours.colour)};
  if (model.has_background && measured < area) {
    keep_measured(model);
    model.warnings.push_back(
        fmt::format("{:.0f} % of the surface was a guess and is left out: the mesh has holes there",
                    100.0 * (1.0 - model.measured_share)));
    model.measured_share = 1.0;
  }
  progress.update(1.0, "done");
  return model;
}

}  // namespace palmar::capture
