// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/tissue_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>

#include "hands/phantom/person/smooth_noise.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::phantom {
namespace {

// Rays are shifted by these shares of a sub-sample, so that none meets a corner of a mesh whose
// corners lie on the grid.
constexpr double kShiftJ = 1.0e-6, kShiftK = 0.6180339887e-6;

constexpr std::uint64_t kTextureStream = std::numeric_limits<std::uint64_t>::max() - 1;

// A ray along i passes through the surface of a part.
struct Crossing {
  int row = 0;     ///< sub-row of the slice
  int part = 0;    ///< in the list of parts
  int step = 0;    ///< +1 into the part, -1 out of it
  double i = 0.0;  ///< voxel coordinate
};

struct PartTriangles {
  std::vector<Vec3> vertex;  ///< voxel coordinates
  const std::vector<Triangle>* triangle = nullptr;
};

// Rays of one slice: sub-row r = sub-slice * rows + m crosses the slice at j_of(m), k_of(sub).
struct SliceRays {
  int slice = 0, rows = 0, subsamples = 1;

  double j_of(int m) const { return (m + 0.5 + kShiftJ) / subsamples - 0.5; }
  double k_of(int sub) const { return slice + (sub + 0.5 + kShiftK) / subsamples - 0.5; }
  int first_row(double j) const {
    return std::max(0, static_cast<int>(std::ceil((j + 0.5) * subsamples - 0.5 - kShiftJ)));
  }
  int last_row(double j) const {
    return std::min(rows - 1, static_cast<int>(std::floor((j + 0.5) * subsamples - 0.5 - kShiftJ)));
  }
};

// On which side of the edge a -> b the ray passes: twice the area of (a, b, ray) seen along i.
// Computed alike by both triangles at the edge and never 0, so that a closed surface has no gap.
double side(const std::vector<Vec3>& v, int a, int b, double j, double k) {
  const bool is_turned = a > b;
  const Vec3& p = v[is_turned ? b : a];
  const Vec3& q = v[is_turned ? a : b];
  double value = (q.y() - p.y()) * (k - p.z()) - (q.z() - p.z()) * (j - p.y());
  if (value == 0.0) value = std::numeric_limits<double>::min();
  return is_turned ? -value : value;
}

void cross_triangle(const PartTriangles& part, int part_index, const Triangle& t,
                    const SliceRays& rays, double handedness, std::vector<Crossing>& found) {
  const Vec3 &a = part.vertex[t[0]], &b = part.vertex[t[1]], &c = part.vertex[t[2]];
  const double j_low = std::min({a.y(), b.y(), c.y()}), j_high = std::max({a.y(), b.y(), c.y()});
  const double k_low = std::min({a.z(), b.z(), c.z()}), k_high = std::max({a.z(), b.z(), c.z()});
  const int first = rays.first_row(j_low), last = rays.last_row(j_high);
  if (first > last) return;
  for (int sub = 0; sub < rays.subsamples; ++sub) {
    const double k = rays.k_of(sub);
    if (k < k_low || k > k_high) continue;
    for (int m = first; m <= last; ++m) {
      const double j = rays.j_of(m);
      const double w_a = side(part.vertex, t[1], t[2], j, k);
      const double w_b = side(part.vertex, t[2], t[0], j, k);
      const double w_c = side(part.vertex, t[0], t[1], j, k);
      const bool is_front = w_a > 0.0 && w_b > 0.0 && w_c > 0.0;
      if (!is_front && !(w_a < 0.0 && w_b < 0.0 && w_c < 0.0)) continue;
      const double i = (w_a * a.x() + w_b * b.x() + w_c * c.x()) / (w_a + w_b + w_c);
      // The normal of a front triangle points to +i, so the ray leaves the part there.
      const bool leaves = is_front == (handedness > 0.0);
      found.push_back({sub * rays.rows + m, part_index, leaves ? -1 : 1, i});
    }
  }
}

// Adds `signal` times the share of each voxel of a row that [from, to] covers; times the texture
// there if it isn't empty.
void add_interval(double from, double to, double signal, std::size_t row_begin, int count,
                  const std::vector<double>& texture, std::vector<double>& sum) {
  const double begin = std::max(from + 0.5, 0.0), end = std::min(to + 0.5, double(count));
  if (begin >= end) return;
  const int first = static_cast<int>(begin), last = std::min(static_cast<int>(end), count - 1);
  for (int i = first; i <= last; ++i) {
    const double covered = std::min(end, i + 1.0) - std::max(begin, double(i));
    if (covered <= 0.0) continue;
    const std::size_t at = row_begin + static_cast<std::size_t>(i);
    sum[at] += signal * covered * (texture.empty() ? 1.0 : texture[at]);
  }
}

// Mean signal of every voxel of one slice, without field and noise.
std::vector<double> slice_signal(const std::vector<ImagedPart>& parts,
                                 const imaging::VolumeGrid& grid, const SliceRays& rays,
                                 double fat_shift, const std::vector<double>& marrow,
                                 std::vector<Crossing>& crossings) {
  const std::vector<double> even;
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) {
    if (p.row != q.row) return p.row < q.row;
    if (p.i != q.i) return p.i < q.i;
    return p.part != q.part ? p.part < q.part : p.step < q.step;
  });
  std::vector<double> sum(static_cast<std::size_t>(grid.size[0]) * grid.size[1], 0.0);
  const double share = 1.0 / (rays.subsamples * rays.subsamples);
  std::vector<int> inside(parts.size(), 0);  // winding number of the part
  for (auto begin = crossings.cbegin(); begin != crossings.cend();) {
    const auto end = std::find_if(begin, crossings.cend(),
                                  [&](const Crossing& c) { return c.row != begin->row; });
    std::fill(inside.begin(), inside.end(), 0);
    const std::size_t row_begin =
        static_cast<std::size_t>(begin->row % rays.rows / rays.subsamples) * grid.size[0];
    int top = -1;  // the last part that the ray is in
    for (; begin != end; ++begin) {
      if (top >= 0) {
        const ImagedTissue tissue = parts[top].tissue;
        const double shift = tissue == ImagedTissue::kWater ? 0.0 : fat_shift / grid.spacing[0];
        add_interval(std::prev(begin)->i + shift, begin->i + shift, share * parts[top].signal,
                     row_begin, grid.size[0], tissue == ImagedTissue::kMarrow ? marrow : even, sum);
      }
      inside[begin->part] += begin->step;
      if (inside[begin->part] > 0) {
        top = std::max(top, begin->part);
      } else if (top == begin->part) {
        while (top >= 0 && inside[top] <= 0) --top;
      }
    }
  }
  return sum;
}

// Relative signal of marrow in the voxels of a slice; empty: even.
std::vector<double> marrow_texture(const imaging::VolumeGrid& grid, int slice,
                                   const SmoothNoise& noise, double deviation) {
  std::vector<double> texture;
  if (deviation <= 0.0) return texture;
  for (int j = 0; j < grid.size[1]; ++j) {
    for (int i = 0; i < grid.size[0]; ++i) {
      texture.push_back(1.0 + deviation * noise.at(grid.to_patient(Vec3(i, j, slice))));
    }
  }
  return texture;
}

// What a scanner makes of a slice that acquires only a share of its frequencies along rows and
// columns: the ideal low pass share sinc(share n).
void limit_resolution(std::vector<double>& slice, int columns, int rows, double share) {
  if (share >= 1.0) return;
  constexpr int kReach = 24;  // voxels; its terms are below 2 %
  std::array<double, kReach + 1> weight{};
  double whole = 0.0;
  for (int n = 0; n <= kReach; ++n) {
    const double x = std::numbers::pi * share * n;
    weight[n] = n == 0 ? share : share * std::sin(x) / x;
    whole += (n == 0 ? 1.0 : 2.0) * weight[n];
  }
  const auto pass = [&](int count, int lines, std::size_t step, std::size_t line_step) {
    std::vector<double> line(count);
    for (int l = 0; l < lines; ++l) {
      double* const first = slice.data() + static_cast<std::size_t>(l) * line_step;
      for (int i = 0; i < count; ++i) line[i] = first[static_cast<std::size_t>(i) * step];
      for (int i = 0; i < count; ++i) {
        double sum = 0.0;
        for (int n = std::max(-kReach, -i); n <= std::min(kReach, count - 1 - i); ++n) {
          sum += weight[std::abs(n)] * line[i + n];
        }
        first[static_cast<std::size_t>(i) * step] = sum / whole;
      }
    }
  };
  const auto width = static_cast<std::size_t>(columns);
  pass(columns, rows, 1, width);
  pass(rows, columns, width, 1);
}

// Share by which the receive field is weaker at a place of the image, 0 to 1: a ramp with a slow
// wave on it, in directions that follow from the seed.
class ReceiveField {
 public:
  ReceiveField(const imaging::VolumeGrid& grid, double bias, std::uint64_t seed) : bias_(bias) {
    RandomStream random(seed, std::numeric_limits<std::uint64_t>::max());
    for (Vec3* direction : {&ramp_, &wave_}) {
      for (int d = 0; d < 3; ++d) (*direction)[d] = random.normal();
      *direction /= direction->lpNorm<1>();  // from -1 to 1 between opposite corners
    }
    for (int d = 0; d < 3; ++d) half_[d] = std::max(0.5 * (grid.size[d] - 1), 0.5);
  }

  double at_voxel(int i, int j, int k) const {
    const Vec3 u = (Vec3(i, j, k) - half_).cwiseQuotient(half_);
    const double weaker =
        0.5 + 0.4 * ramp_.dot(u) + 0.1 * std::sin(std::numbers::pi * wave_.dot(u));
    return 1.0 - bias_ * weaker;
  }

 private:
  double bias_;
  Vec3 ramp_, wave_, half_;
};

void check_grid(const imaging::VolumeGrid& grid) {
  for (std::size_t d = 0; d < 3; ++d) {
    if (grid.size[d] < 1 || !(grid.spacing[static_cast<int>(d)] > 0.0)) {
      throw UsageError(
          fmt::format("grid: {} voxels of {} mm along axis {}; allowed is at least 1 "
                      "voxel of more than 0 mm",
                      grid.size[d], grid.spacing[static_cast<int>(d)], d));
    }
  }
}

}  // namespace

imaging::Volume image_of(const std::vector<ImagedPart>& parts, const imaging::VolumeGrid& grid,
                         const ScannerOptions& options, const Progress& progress) {
  options.check();
  check_grid(grid);
  const int slices = grid.size[2];
  const double handedness = grid.axes.determinant();

  double brightest = 0.0;
  std::vector<PartTriangles> placed(parts.size());
  // Triangles that each slice meets, part by part.
  std::vector<std::vector<std::array<int, 2>>> in_slice(slices);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const geometry::TriangleMesh& mesh = parts[p].mesh;
    const std::string name = fmt::format("part {} of {} of the image", p + 1, parts.size());
    if (!geometry::examine_topology(mesh).is_closed) {
      throw InputError(name + ": the surface isn't closed; a closed one is required");
    }
    if (geometry::signed_volume(mesh) < 0.0) {
      throw InputError(name + ": the surface is turned inside out");
    }
    brightest = std::max(brightest, parts[p].signal);
    placed[p].triangle = &mesh.triangles;
    placed[p].vertex.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) placed[p].vertex.push_back(grid.to_voxel(v));
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      double low = std::numeric_limits<double>::max(), high = -low;
      for (const int v : mesh.triangles[t]) {
        low = std::min(low, placed[p].vertex[v].z());
        high = std::max(high, placed[p].vertex[v].z());
      }
      const int first = static_cast<int>(std::floor(std::clamp(low + 0.5, 0.0, double(slices))));
      const int last = static_cast<int>(std::floor(std::clamp(high + 0.5, -1.0, slices - 1.0)));
      for (int k = first; k <= last; ++k) in_slice[k].push_back({static_cast<int>(p), t});
    }
    progress.throw_if_cancelled();
  }

  const ReceiveField field(grid, options.bias, options.seed);
  constexpr double kTextureWave = 2.5;  // mm
  const SmoothNoise trabeculae(options.seed, kTextureStream, kTextureWave);
  // Half of the field's fall is lost on average.
  const double noise =
      options.snr > 0.0 ? brightest * (1.0 - 0.5 * options.bias) / options.snr : 0.0;
  imaging::Volume image{.grid = grid, .value = std::vector<float>(grid.count())};
  parallel_for(slices, [&](int k) {
    progress.throw_if_cancelled();
    const SliceRays rays{k, grid.size[1] * options.subsamples, options.subsamples};
    std::vector<Crossing> crossings;
    for (const auto& [p, t] : in_slice[k]) {
      const PartTriangles& part = placed[p];
      cross_triangle(part, p, (*part.triangle)[t], rays, handedness, crossings);
    }
    std::vector<double> signal =
        slice_signal(parts, grid, rays, options.fat_shift,
                     marrow_texture(grid, k, trabeculae, options.marrow_texture), crossings);
    limit_resolution(signal, grid.size[0], grid.size[1], options.acquired);
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t voxel = grid.at(i, j, k);
        double value =
            signal[static_cast<std::size_t>(j) * grid.size[0] + i] * field.at_voxel(i, j, k);
        if (noise > 0.0) {
          // Normal deviates of both channels (Box, Muller 1958); the phase of the signal is 0.
          RandomStream random(options.seed, voxel);
          const double length = noise * std::sqrt(-2.0 * std::log(random.uniform()));
          const double angle = 2.0 * std::numbers::pi * random.uniform();
          value = std::hypot(value + length * std::cos(angle), length * std::sin(angle));
          if (value < options.mask * noise) value = 0.0;
        }
        image.value[voxel] = static_cast<float>(std::abs(value));  // of a magnitude image
      }
    }
  });
  progress.update(1.0, "image of the tissues");
  return image;
}

}  // namespace palmar::phantom
