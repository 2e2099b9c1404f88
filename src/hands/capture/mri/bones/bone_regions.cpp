// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_set>

#include "hands/imaging/bright_regions.h"
#include "hands/imaging/gaussian_filter.h"
#include "hands/imaging/iso_surface.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/remesh/remesh.h"
#include "palmar/geometry/remesh/smooth.h"

namespace palmar::capture {
namespace {

// Films that separate regions, from thin ones on: one bone may be separated by a film that is
// darker than another's leaky shell.
constexpr std::array<double, 2> kFilmDepths = {0.22, 0.35};
constexpr double kFloor = 0.15;         // share of the way from dark to bright
constexpr double kUsualShell = 0.8;     // mm
constexpr double kLeastMarrow = 8.0;    // mm^3
constexpr double kMostMarrow = 60.0e3;  // mm^3: that of the radius with much of its shaft
constexpr float kSkin = 1.0F;           // mm below the surface: too near for a bone's shell
constexpr double kLeastDepth = 1.4;     // mm below the skin
constexpr double kMostShallow = 0.2;    // share of voxels nearer to it
constexpr double kOpen = 0.8;           // the same, where nothing dark lies outside
// Shares of the way from dark to the region's own level, at a bone threshold half way; they move
// with that.
constexpr double kCore = 0.65;
constexpr double kDarkestShell = 0.62;
constexpr double kMostShell = 0.9;  // whatever the threshold: fat has no shell at all

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};

Nearest nearest_voxels(const MarrowRegion& a, const MarrowRegion& b) {
  Nearest nearest;
  double least = std::numeric_limits<double>::infinity();
  // Every third voxel is near enough.
  constexpr std::size_t kStep = 3;
  Box3 box;
  for (std::size_t j = 0; j < b.voxels.size(); j += kStep) box.extend(b.voxels[j]);
  for (std::size_t i = 0; i < a.voxels.size(); i += kStep) {
    const Vec3& p = a.voxels[i];
    if (box.squaredExteriorDistance(p) >= least) continue;
    for (std::size_t j = 0; j < b.voxels.size(); j += kStep) {
      const double d = (p - b.voxels[j]).squaredNorm();
      if (d >= least) continue;
      least = d;
      nearest = {std::sqrt(d), p, b.voxels[j]};
    }
  }
  return nearest;
}

/// Leaks through a shell are thinner than the bone.
imaging::VoxelMask without_leaks(const imaging::VolumeGrid& grid, const imaging::VoxelMask& mask) {
  const imaging::VoxelMask thick = imaging::opened(grid, mask, 2.0);
  const auto count = [](const imaging::VoxelMask& m) { return std::count(m.begin(), m.end(), 1); };
  if (count(thick) < 6 * count(mask) / 10) return mask;
  const std::vector<float> away = imaging::distance_transform(grid, thick);
  imaging::VoxelMask kept(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) kept[v] = mask[v] != 0 && away[v] < 2.5F ? 1 : 0;
  return kept;
}

}  // namespace

namespace {

double convexity_of(const imaging::VolumeGrid& grid, const std::vector<std::size_t>& voxels) {
  constexpr int kPairs = 400;
  const auto nx = static_cast<std::size_t>(grid.size[0]),
             ny = static_cast<std::size_t>(grid.size[1]);
  const std::unordered_set<std::size_t> inside(voxels.begin(), voxels.end());
  RandomStream random(1, 0);
  int count = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    const std::size_t a = voxels[random.below(voxels.size())],
                      b = voxels[random.below(voxels.size())];
    // Where the middle falls between voxels, either will do.
    const auto middle = [&](std::size_t up) {
      return (a % nx + b % nx + up) / 2 + nx * ((a / nx % ny + b / nx % ny + up) / 2) +
             nx * ny * ((a / nx / ny + b / nx / ny + up) / 2);
    };
    if (inside.contains(middle(0)) || inside.contains(middle(1))) ++count;
  }
  return static_cast<double>(count) / kPairs;
}

std::vector<MarrowRegion> enclosed_regions(const ScanImage& scan,
                                           const imaging::BrightRegions& regions) {
  const imaging::VolumeGrid& grid = scan.image.grid;
  struct Sums {
    double bright = 0.0, voxels = 0.0, shell = 0.0, faces = 0.0, border = 0.0, open = 0.0,
           shallow = 0.0, core = 0.0;
    bool is_cut = false;
  };
  std::vector<Sums> sums(regions.count());
  const double dark = scan.levels.dark;
  const double moved = 2.0 * scan.levels.bone_share();  // 1 at a threshold half way
  const double darkest_shell = std::min(kMostShell, kDarkestShell * moved);
  const double core = std::min(kMostShell, kCore * moved);
  for (std::size_t v = 0; v < regions.region.size(); ++v) {
    const std::int32_t r = regions.region[v];
    const auto value = static_cast<double>(scan.smooth.value[v]);
    if (r < 0 || value < scan.levels.bone_threshold) continue;
    sums[r].bright += value;
    sums[r].voxels += 1.0;
  }
  const auto limit_of = [&](std::int32_t r) {
    const Sums& s = sums[r];
    return s.voxels > 0.0 ? dark + core * (s.bright / s.voxels - dark)
                          : std::numeric_limits<double>::infinity();
  };
  const auto is_core = [&](std::size_t v, std::int32_t r) {
    return regions.region[v] == r && static_cast<double>(scan.smooth.value[v]) > limit_of(r);
  };
  const std::array<int, 3> size = grid.size;
  const std::array<std::size_t, 3> stride = {1, static_cast<std::size_t>(size[0]),
                                             static_cast<std::size_t>(size[0]) * size[1]};
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        const std::int32_t r = regions.region[v];
        if (r < 0 || !is_core(v, r)) continue;
        Sums& s = sums[r];
        s.core += 1.0;
        if (static_cast<double>(scan.depth[v]) < kLeastDepth) s.shallow += 1.0;
        const std::array<int, 3> here = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int way : {-1, 1}) {
            const int room = way > 0 ? size[axis] - 1 - here[axis] : here[axis];
            if (room == 0) {
              s.is_cut = true;
              continue;
            }
            std::size_t w = way > 0 ? v + stride[axis] : v - stride[axis];
            if (is_core(w, r)) continue;
            s.border += 1.0;
            // Air behind the skin is no shell.
            float least = std::numeric_limits<float>::max();
            for (int step = 0; step < std::min(room, 3) && scan.depth[w] > kSkin; ++step) {
              least = std::min(least, scan.smooth.value[w]);
              w = way > 0 ? w + stride[axis] : w - stride[axis];
            }
            const double level = dark + (limit_of(r) - dark) / core;
            if (static_cast<double>(least) > dark + kOpen * (level - dark)) s.open += 1.0;
            if (least == std::numeric_limits<float>::max()) continue;
            s.shell += static_cast<double>(least);
            s.faces += 1.0;
          }
        }
      }
    }
  }
  std::vector<MarrowRegion> found;
  std::vector<int> number(sums.size(), -1);
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const Sums& s = sums[r];
    const double volume = s.core * grid.spacing.prod();
    if (volume < kLeastMarrow || volume > kMostMarrow || s.faces == 0.0) continue;
    const double level = s.bright / s.voxels;
    if (s.shallow > kMostShallow * s.core) continue;
    if (s.shell / s.faces > dark + darkest_shell * (level - dark)) continue;
    number[r] = static_cast<int>(found.size());
    MarrowRegion region;
    region.regions = {static_cast<std::int32_t>(r)};
    region.level = level;
    region.shell = s.shell / s.faces;
    region.open = s.open / s.border;
    region.volume = volume;
    region.is_cut = s.is_cut;
    found.push_back(region);
  }
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        const std::int32_t r = regions.region[v];
        if (r < 0 || number[r] < 0 || !is_core(v, r)) continue;
        found[number[r]].voxels.push_back(grid.to_patient(Vec3(i, j, k)));
        found[number[r]].index.push_back(v);
      }
    }
  }
  for (MarrowRegion& region : found) region.convexity = convexity_of(grid, region.index);
  return found;
}

}  // namespace

MarrowRegions marrow_regions(const ScanImage& scan, const imaging::VoxelMask& inner) {
  const double dark = scan.levels.dark, contrast = scan.levels.bright - dark;
  const auto regions_at = [&](double depth) {
    return imaging::bright_regions(scan.smooth, inner,
                                   {.dark = dark,
                                    .floor = dark + kFloor * contrast,
                                    .core = dark + 0.5 * contrast,
                                    .depth = depth});
  };
  std::array<imaging::BrightRegions, kFilmDepths.size()> at_depth;
  std::array<std::vector<MarrowRegion>, kFilmDepths.size()> enclosed;
  parallel_for(static_cast<int>(at_depth.size()), [&](int d) {
    at_depth[d] = regions_at(kFilmDepths[d]);
    enclosed[d] = enclosed_regions(scan, at_depth[d]);
  });
  MarrowRegions found;
  found.candidates = std::move(enclosed.front());
  imaging::BrightRegions& fine = at_depth.front();
  for (std::size_t d = 1; d < at_depth.size(); ++d) {
    // Each fine region lies in a coarser one, but for some that merged with another neighbour.
    std::vector<std::map<std::int32_t, std::size_t>> share(fine.voxels.size());
    for (std::size_t v = 0; v < fine.region.size(); ++v) {
      if (fine.region[v] >= 0) ++share[fine.region[v]][at_depth[d].region[v]];
    }
    for (MarrowRegion& candidate : enclosed[d]) {
      const std::int32_t coarse = candidate.regions.front();
      candidate.regions.clear();
      for (std::size_t r = 0; r < share.size(); ++r) {
        const auto inside = share[r].find(coarse);
        if (inside != share[r].end() && 2 * inside->second > fine.voxels[r]) {
          candidate.regions.push_back(static_cast<std::int32_t>(r));
        }
      }
      const bool is_known = std::any_of(
          found.candidates.begin(), found.candidates.end(),
          [&](const MarrowRegion& other) { return other.regions == candidate.regions; });
      if (!is_known && !candidate.regions.empty()) found.candidates.push_back(std::move(candidate));
    }
  }
  found.region = std::move(fine.region);
  found.count = static_cast<int>(fine.voxels.size());
  return found;
}

bool overlap(const MarrowRegion& a, const MarrowRegion& b) {
  return std::any_of(a.regions.begin(), a.regions.end(), [&](std::int32_t r) {
    return std::find(b.regions.begin(), b.regions.end(), r) != b.regions.end();
  });
}

MarrowRegion joined(const MarrowRegion& a, const MarrowRegion& b) {
  const Nearest nearest = nearest_voxels(a, b);
  MarrowRegion both = a;
  both.regions.insert(both.regions.end(), b.regions.begin(), b.regions.end());
  both.bridges.insert(both.bridges.end(), b.bridges.begin(), b.bridges.end());
  both.bridges.push_back({nearest.a, nearest.b});
  both.voxels.insert(both.voxels.end(), b.voxels.begin(), b.voxels.end());
  both.index.insert(both.index.end(), b.index.begin(), b.index.end());
  both.level = (a.level * a.volume + b.level * b.volume) / (a.volume + b.volume);
  both.shell = (a.shell * a.volume + b.shell * b.volume) / (a.volume + b.volume);
  both.open = (a.open * a.volume + b.open * b.volume) / (a.volume + b.volume);
  both.convexity = (a.convexity * a.volume + b.convexity * b.volume) / (a.volume + b.volume);
  both.volume += b.volume;
  both.is_cut = a.is_cut || b.is_cut;
  return both;
}

double gap_between(const MarrowRegion& a, const MarrowRegion& b) {
  return nearest_voxels(a, b).distance;
}

geometry::TriangleMesh marrow_surface(const ScanImage& scan, const MarrowRegion& marrow,
                                      double edge_length) {
  const imaging::VolumeGrid& grid = scan.image.grid;
  std::array<int, 3> low = grid.size, high = {-1, -1, -1};
  const auto voxel_of = [&](std::size_t v) {
    const auto nx = static_cast<std::size_t>(grid.size[0]),
               ny = static_cast<std::size_t>(grid.size[1]);
    return std::array<int, 3>{static_cast<int>(v % nx), static_cast<int>(v / nx % ny),
                              static_cast<int>(v / nx / ny)};
  };
  for (const std::size_t v : marrow.index) {
    const std::array<int, 3> here = voxel_of(v);
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], here[a]);
      high[a] = std::max(high[a], here[a]);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::max(0, low[a] - 4);
    high[a] = std::min(grid.size[a] - 1, high[a] + 4);
  }
  imaging::Volume part;
  part.grid = grid;
  part.grid.size = {high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1};
  part.grid.origin = grid.to_patient(Vec3(low[0], low[1], low[2]));
  imaging::VoxelMask own(part.grid.count(), 0);
  for (const std::size_t v : marrow.index) {
    const std::array<int, 3> here = voxel_of(v);
    own[part.grid.at(here[0] - low[0], here[1] - low[1], here[2] - low[2])] = 1;
  }
  if (marrow.is_leaky) own = without_leaks(part.grid, own);
  for (const auto& [from, to] : marrow.bridges) {
    for (int k = 0; k < part.grid.size[2]; ++k) {
      for (int j = 0; j < part.grid.size[1]; ++j) {
        for (int i = 0; i < part.grid.size[0]; ++i) {
          const Vec3 place = part.grid.to_patient(Vec3(i, j, k));
          const Vec3 way = to - from;
          const double share =
              std::clamp((place - from).dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
          if ((place - from - share * way).norm() < 1.3) own[part.grid.at(i, j, k)] = 1;
        }
      }
    }
  }
  // Out to where the shell's outside may be expected.
  own = imaging::dilated(part.grid, imaging::closed(part.grid, own, 1.6), kUsualShell);
  part.value.resize(own.size());
  for (std::size_t v = 0; v < own.size(); ++v) part.value[v] = own[v] != 0 ? 1.0F : 0.0F;
  part = imaging::gaussian_filtered(part, 0.6);
  geometry::TriangleMesh mesh = largest_piece(imaging::iso_surface(part, 0.45));
  if (mesh.triangles.empty()) return mesh;
  mesh = geometry::smooth_taubin(mesh, {.rounds = 10});
  return geometry::remesh(mesh, {.edge_length = edge_length, .rounds = 6}).mesh;
}

geometry::TriangleMesh largest_piece(const geometry::TriangleMesh& mesh) {
  const std::vector<int> piece =
      geometry::triangle_components(mesh, geometry::build_topology(mesh));
  const int pieces = piece.empty() ? 0 : 1 + *std::max_element(piece.begin(), piece.end());
  if (pieces <= 1) return mesh;
  std::vector<double> volume(pieces, 0.0);
  for (std::size_t t = 0; t < piece.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    volume[piece[t]] += mesh.vertices[c[0]].dot(mesh.vertices[c[1]].cross(mesh.vertices[c[2]]));
  }
  const int largest =
      static_cast<int>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  geometry::TriangleMesh kept;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < piece.size(); ++t) {
    if (piece[t] != largest) continue;
    Triangle corners = mesh.triangles[t];
    for (int& c : corners) {
      int& n = number[c];
      if (n < 0) {
        n = kept.vertex_count();
        kept.vertices.push_back(mesh.vertices[c]);
      }
      c = n;
    }
    kept.triangles.push_back(corners);
  }
  return kept;
}

}  // namespace palmar::capture
