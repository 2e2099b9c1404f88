// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/find_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hands/capture/mri/bones/bone_chain.h"
#include "hands/capture/mri/bones/bone_names.h"
#include "hands/capture/mri/bones/bone_regions.h"
#include "hands/capture/mri/bones/fat_shift.h"
#include "hands/capture/mri/bones/shell_fit.h"
#include "hands/capture/mri/scan_image.h"
#include "hands/imaging/gaussian_filter.h"
#include "hands/imaging/noise_floor.h"
#include "hands/imaging/simple_body.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/remesh/remesh.h"
#include "palmar/geometry/remesh/smooth.h"

namespace palmar::capture {
namespace {

constexpr double kCoarsest = 2.5;  // mm; a distal phalanx is 5 mm wide
// Mean error of bones that are named rightly, in images of phantoms: 0.24 mm at 1 mm slices and a
// ratio of signal to noise of 25, up to 0.7 mm at 2 mm slices.
constexpr double kErrorPerVoxel = 0.27;
constexpr double kErrorPerNoise = 3.0;  // per share of the contrast
constexpr double kDoubtfulNames = 0.4;  // mm: from there on names may be wrong as well

geometry::TriangleMesh skin_surface(const ScanImage& scan, double edge_length,
                                    std::vector<std::string>& notes) {
  imaging::Volume field = imaging::gaussian_filtered(scan.image, 0.4);
  const std::vector<float> outside = imaging::distance_transform(field.grid, scan.body);
  const auto inside = static_cast<float>(scan.levels.bright);
  for (std::size_t v = 0; v < field.value.size(); ++v) {
    if (scan.depth[v] > 1.2F) field.value[v] = inside;
    if (outside[v] > 1.2F || scan.covered[v] != 0) field.value[v] = std::min(field.value[v], 0.0F);
  }
  imaging::SimpleSurface surface =
      imaging::simple_surface(std::move(field), scan.levels.air_threshold, scan.levels.skin);
  if (surface.handles > 0) {
    notes.push_back(fmt::format(
        "skin touches skin, or is too thin to be seen, in {} {}: it was separated there",
        surface.handles, surface.handles == 1 ? "place" : "places"));
  }
  const geometry::TriangleMesh mesh = geometry::smooth_taubin(surface.mesh, {.rounds = 8});
  return geometry::remesh(mesh, {.edge_length = edge_length, .rounds = 8}).mesh;
}

/// Where fat is shown off water, the skin is moved to the bones, and what is left of that makes
/// them less certain. `seen`: by the bones.
void move_skin_to_fat(const SurfaceOptions& options, const Vec3& seen, ScanSurfaces& surfaces) {
  constexpr double kNamed = 0.3;                      // mm
  constexpr double kLeft = 0.4, kUncorrected = 0.65;  // share of the shift in the bones' errors
  const Vec3& stated = options.fat_shift;
  surfaces.fat_shift = options.is_fat_side_known ? stated : signed_fat_shift(stated, seen);
  for (Vec3& v : surfaces.skin.vertices) v += surfaces.fat_shift;
  const bool is_corrected = surfaces.fat_shift != Vec3::Zero();
  const double shift = is_corrected ? surfaces.fat_shift.norm() : stated.norm();
  // Where the bones don't show what is stated, what they show counts.
  surfaces.bone_error_estimate = std::hypot(
      surfaces.bone_error_estimate, is_corrected ? kLeft * shift : kUncorrected * seen.norm());
  if (shift < kNamed) return;
  surfaces.notes.push_back(fmt::format(
      "fat, and with it the bones' marrow, is shown {}{:.1f} mm off: {}. A read-out of twice the "
      "bandwidth halves it",
      stated == Vec3::Zero() ? "about " : "", shift,
      is_corrected ? "the skin was moved to the bones by as much"
                   : "the bones don't show that, or to which side, and nothing was corrected"));
}

}  // namespace

ScanSurfaces find_surfaces(const imaging::Volume& image, const std::string& name,
                           const hand::Hand& model, const SurfaceOptions& options,
                           const Progress& progress) {
  options.check();
  const auto share = [&](double from, double to) {
    Progress part = progress;
    if (progress.report) {
      part.report = [&progress, from, to](double done, const std::string& what) {
        progress.report(from + (to - from) * done, what);
      };
    }
    return part;
  };
  const double coarsest = image.grid.spacing.maxCoeff();
  if (coarsest > kCoarsest) {
    throw InputError(fmt::format(
        "{}: voxels of {:.2f} x {:.2f} x {:.2f} mm are too coarse for bones; up to {:g} mm are "
        "allowed",
        name, image.grid.spacing.x(), image.grid.spacing.y(), image.grid.spacing.z(), kCoarsest));
  }
  const ScanImage scan = prepare_scan(image, name, options, share(0.0, 0.4));
  ScanSurfaces surfaces;
  surfaces.markers = scan.markers;
  surfaces.notes = scan.notes;
  surfaces.air_threshold = imaging::with_noise_floor(scan.levels.air_threshold, scan.levels.floor);
  surfaces.bone_threshold =
      imaging::with_noise_floor(scan.levels.bone_threshold, scan.levels.floor);
  surfaces.noise = scan.levels.noise;
  surfaces.voxel = image.grid.spacing;

  progress.update(0.4, "skin");
  surfaces.skin = skin_surface(scan, options.edge_length, surfaces.notes);

  progress.update(0.5, "marrow");
  imaging::VoxelMask inner(scan.body.size());
  for (std::size_t v = 0; v < inner.size(); ++v) inner[v] = scan.depth[v] > 1.0F ? 1 : 0;
  const double contrast = scan.levels.bright - scan.levels.dark;
  const MarrowRegions regions = marrow_regions(scan, inner);
  const BoneNames names = name_bones(regions.candidates, scan.levels, surfaces.skin, model,
                                     {options.side, options.doubted_below}, share(0.6, 0.75));
  surfaces.side = names.side;
  surfaces.bone_error_estimate =
      kErrorPerVoxel * coarsest * (1.0 + kErrorPerNoise * scan.levels.noise / contrast);
  if (surfaces.bone_error_estimate > kDoubtfulNames) {
    surfaces.notes.push_back(
        fmt::format("voxels of {:.2f} x {:.2f} x {:.2f} mm and noise of {:.0f} % of the contrast: "
                    "bones' surfaces are expected within {:.1f} mm only, and some bones may be "
                    "missed or have another one's name: look at the pictures",
                    image.grid.spacing.x(), image.grid.spacing.y(), image.grid.spacing.z(),
                    100.0 * scan.levels.noise / contrast, surfaces.bone_error_estimate));
  }
  surfaces.notes.insert(surfaces.notes.end(), names.notes.begin(), names.notes.end());

  progress.update(0.75, "bones");
  // Voxels of a bone's own region and of other bones' end and limit its profiles.
  std::vector<std::int32_t> bone_of(regions.count, -1);
  for (std::size_t b = 0; b < names.bones.size(); ++b) {
    for (const std::int32_t r : names.bones[b].regions) {
      bone_of[r] = static_cast<std::int32_t>(b);
    }
  }
  std::vector<std::int32_t> bone(regions.region.size());
  for (std::size_t v = 0; v < bone.size(); ++v) {
    bone[v] = regions.region[v] < 0 ? -1 : bone_of[regions.region[v]];
    if (scan.depth[v] < 0.7F) bone[v] = -2;
  }
  const ShellImage shell{scan.image, bone, scan.levels.dark, scan.levels.bright, scan.levels.floor};
  surfaces.bones.resize(names.bones.size());
  std::vector<LayerFit> shells(names.bones.size());
  parallel_for(static_cast<int>(names.bones.size()), [&](int b) {
    if (progress.is_cancelled()) return;
    ScannedBone& found = surfaces.bones[b];
    found.name = names.name[b];
    found.is_cut = names.bones[b].is_cut;
    geometry::TriangleMesh mesh = marrow_surface(scan, names.bones[b], options.edge_length);
    for (int round = 0; round < 2; ++round) {
      shells[b] = fit_shell(mesh, b, shell);
      mesh = shells[b].mesh;
      mesh = geometry::smooth_tangentially(geometry::smooth_taubin(mesh, {.rounds = 4}),
                                           {.rounds = 4});
    }
    found.mesh = std::move(mesh);
  });
  progress.throw_if_cancelled();
  std::vector<LayerFit> palm;
  for (std::size_t b = 0; b < shells.size(); ++b) {
    if (is_palm_bone(surfaces.bones[b].name)) palm.push_back(std::move(shells[b]));
  }
  move_skin_to_fat(options, fat_shift(palm), surfaces);
  return surfaces;
}

}  // namespace palmar::capture
