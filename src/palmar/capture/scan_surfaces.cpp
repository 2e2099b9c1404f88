// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/scan_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/capture/bone_names.h"
#include "palmar/capture/scan_image.h"
#include "palmar/capture/shell_fit.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh_measures.h"
#include "palmar/geometry/mesh_topology.h"
#include "palmar/geometry/remesh.h"
#include "palmar/geometry/smooth.h"
#include "palmar/imaging/bright_regions.h"
#include "palmar/imaging/gaussian_filter.h"
#include "palmar/imaging/iso_surface.h"

namespace palmar {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The largest piece of a surface, by volume.
TriangleMesh largest_piece(const TriangleMesh& mesh) {
  const std::vector<int> piece = triangle_components(mesh, build_topology(mesh));
  const int pieces = piece.empty() ? 0 : 1 + *std::max_element(piece.begin(), piece.end());
  if (pieces <= 1) return mesh;
  std::vector<double> volume(at(pieces), 0.0);
  for (std::size_t t = 0; t < piece.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    volume[at(piece[t])] +=
        mesh.vertices[at(c[0])].dot(mesh.vertices[at(c[1])].cross(mesh.vertices[at(c[2])]));
  }
  const int largest =
      static_cast<int>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  TriangleMesh kept;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < piece.size(); ++t) {
    if (piece[t] != largest) continue;
    Triangle corners = mesh.triangles[t];
    for (int& c : corners) {
      int& n = number[at(c)];
      if (n < 0) {
        n = kept.vertex_count();
        kept.vertices.push_back(mesh.vertices[at(c)]);
      }
      c = n;
    }
    kept.triangles.push_back(corners);
  }
  return kept;
}

TriangleMesh skin_surface(const ScanImage& scan, double edge_length) {
  Volume field = gaussian_filtered(scan.image, 0.4);
  const std::vector<float> outside = distance_transform(field.grid, scan.body);
  const auto air = static_cast<float>(scan.levels.air);
  const auto inside = static_cast<float>(scan.levels.bright);
  for (std::size_t v = 0; v < field.value.size(); ++v) {
    if (scan.depth[v] > 1.5F) field.value[v] = inside;
    if (outside[v] > 1.5F) field.value[v] = std::min(field.value[v], air);
  }
  TriangleMesh mesh = largest_piece(iso_surface(field, scan.levels.air_threshold));
  mesh = smooth_taubin(mesh, {.rounds = 8});
  return remesh(mesh, {.edge_length = edge_length, .rounds = 8}).mesh;
}

struct Candidate {
  std::int32_t region = -1;
  double volume = 0.0;  ///< mm^3
};

/// Bright regions inside the body that look like marrow: deep below the skin and with a dark shell.
std::vector<Candidate> marrow_candidates(const ScanImage& scan, const BrightRegions& regions) {
  const VolumeGrid& grid = scan.image.grid;
  std::vector<double> shallow(at(regions.count()), 0.0), sum(at(regions.count()), 0.0),
      pairs(at(regions.count()), 0.0);
  const std::array<std::size_t, 3> stride = {1, at(grid.size[0]),
                                             at(grid.size[0]) * at(grid.size[1])};
  for (int k = 1; k + 1 < grid.size[2]; ++k) {
    for (int j = 1; j + 1 < grid.size[1]; ++j) {
      for (int i = 1; i + 1 < grid.size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        const std::int32_t r = regions.region[v];
        if (r < 0) continue;
        if (scan.depth[v] < 2.2F) shallow[at(r)] += 1.0;
        for (const std::size_t step : stride) {
          for (const std::size_t w : {v + step, v - step}) {
            if (regions.region[w] == r) continue;
            // The darkest of the next two voxels outwards: the shell, if there is one.
            const std::size_t next = w > v ? w + step : w - step;
            float least = scan.smooth.value[w];
            if (next < scan.smooth.value.size()) {
              least = std::min(least, scan.smooth.value[next]);
            }
            sum[at(r)] += static_cast<double>(least);
            pairs[at(r)] += 1.0;
          }
        }
      }
    }
  }
  std::vector<Candidate> found;
  const double contrast = scan.levels.bright - scan.levels.dark;
  for (std::int32_t r = 0; r < regions.count(); ++r) {
    const double voxels = static_cast<double>(regions.voxels[at(r)]);
    const double volume = voxels * grid.spacing.prod();
    if (volume < 25.0 || shallow[at(r)] > 0.02 * voxels || pairs[at(r)] == 0.0) continue;
    if (sum[at(r)] / pairs[at(r)] > scan.levels.dark + 0.32 * contrast) continue;
    found.push_back({r, volume});
  }
  return found;
}

TriangleMesh marrow_surface(const ScanImage& scan, const BrightRegions& regions,
                            std::int32_t region, double edge_length) {
  const VolumeGrid& grid = scan.image.grid;
  std::array<int, 3> low = grid.size, high = {-1, -1, -1};
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (regions.region[grid.at(i, j, k)] != region) continue;
        const std::array<int, 3> here = {i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], here[a]);
          high[a] = std::max(high[a], here[a]);
        }
      }
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::max(0, low[a] - 3);
    high[a] = std::min(grid.size[a] - 1, high[a] + 3);
  }
  Volume part;
  part.grid = grid;
  part.grid.size = {high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1};
  part.grid.origin = grid.to_patient(Vec3(low[0], low[1], low[2]));
  part.value.resize(part.grid.count());
  VoxelMask own(part.grid.count());
  for (int k = 0; k < part.grid.size[2]; ++k) {
    for (int j = 0; j < part.grid.size[1]; ++j) {
      for (int i = 0; i < part.grid.size[0]; ++i) {
        const std::size_t from = grid.at(low[0] + i, low[1] + j, low[2] + k);
        own[part.grid.at(i, j, k)] = regions.region[from] == region ? 1 : 0;
      }
    }
  }
  // A smooth surface half way between the region's voxels and the others.
  own = closed(part.grid, own, 1.3);
  for (std::size_t v = 0; v < own.size(); ++v) part.value[v] = own[v] != 0 ? 1.0F : 0.0F;
  part = gaussian_filtered(part, 0.6);
  TriangleMesh mesh = largest_piece(iso_surface(part, 0.5));
  mesh = smooth_taubin(mesh, {.rounds = 10});
  return remesh(mesh, {.edge_length = edge_length, .rounds = 6}).mesh;
}

}  // namespace

void SurfaceOptions::check() const {
  const auto require = [](double value, double low, double high, const char* field,
                          const char* unit) {
    if (!(value >= low && value <= high)) {
      throw UsageError(fmt::format("SurfaceOptions: {} is {}; {} to {} {} are allowed", field,
                                   value, low, high, unit));
    }
  };
  require(air_threshold, 0.0, 1e9, "air_threshold", "(intensity of the file)");
  require(bone_threshold, 0.0, 1e9, "bone_threshold", "(intensity of the file)");
  require(edge_length, 0.4, 5.0, "edge_length", "mm");
  require(marker_diameter, 0.0, 20.0, "marker_diameter", "mm");
}

ScanSurfaces find_surfaces(const Volume& image, const std::string& name, const Hand& model,
                           const SurfaceOptions& options, const Progress& progress) {
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
  const ScanImage scan = prepare_scan(image, name, options, share(0.0, 0.4));
  ScanSurfaces surfaces;
  surfaces.markers = scan.markers;
  surfaces.notes = scan.notes;
  surfaces.air_threshold = scan.levels.air_threshold;
  surfaces.bone_threshold = scan.levels.bone_threshold;
  surfaces.noise = scan.levels.noise;

  progress.update(0.4, "skin");
  surfaces.skin = skin_surface(scan, 2.0 * options.edge_length);

  progress.update(0.5, "marrow");
  VoxelMask inner(scan.body.size());
  for (std::size_t v = 0; v < inner.size(); ++v) inner[v] = scan.depth[v] > 1.0F ? 1 : 0;
  const double contrast = scan.levels.bright - scan.levels.dark;
  const BrightRegions regions = bright_regions(
      scan.smooth, inner, {.floor = scan.levels.bone_threshold, .depth = 0.2 * contrast});
  const std::vector<Candidate> candidates = marrow_candidates(scan, regions);

  progress.update(0.6, "bones");
  const ShellImage shell{scan.image, regions.region, scan.levels.dark, scan.levels.bright,
                         scan.levels.noise};
  surfaces.bones.resize(candidates.size());
  parallel_for(static_cast<int>(candidates.size()), [&](int c) {
    const std::int32_t region = candidates[at(c)].region;
    TriangleMesh mesh = marrow_surface(scan, regions, region, options.edge_length);
    for (int round = 0; round < 2; ++round) {
      mesh = fit_shell(mesh, region, shell).mesh;
      mesh = smooth_taubin(mesh, {.rounds = 4});
      mesh = remesh(mesh, {.edge_length = options.edge_length, .rounds = 4}).mesh;
    }
    surfaces.bones[at(c)].mesh = std::move(mesh);
  });

  const BoneNames names = name_bones(surfaces.bones, surfaces.skin, model, share(0.8, 1.0));
  for (std::size_t b = 0; b < surfaces.bones.size(); ++b) surfaces.bones[b].name = names.name[b];
  surfaces.side = names.side;
  surfaces.notes.insert(surfaces.notes.end(), names.notes.begin(), names.notes.end());
  return surfaces;
}

}  // namespace palmar
