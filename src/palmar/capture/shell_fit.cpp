// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/shell_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh_measures.h"
#include "palmar/geometry/mesh_topology.h"

namespace palmar {
namespace {

// Profiles: samples along the normal, mm.
constexpr double kFirst = -3.6, kStep = 0.3;
constexpr int kSamples = 26;  // to +3.9
// Candidates: outer side b, thickness w = b - a, mm.
constexpr double kOuterFirst = -1.6, kOuterStep = 0.2;
constexpr int kOuters = 19;  // to +2.0
constexpr double kThicknessFirst = 0.3, kThicknessStep = 0.25;
constexpr int kThicknesses = 11;                    // to 2.8
constexpr double kUsualThickness = 0.9;             // mm
constexpr double kLooseTie = 1.0, kTightTie = 0.3;  // mm
constexpr double kSurroundings = 6.0;               // mm
constexpr double kFarthestInner = 0.5;  // mm outwards: the next dark thing is another one
constexpr float kForbidden = 1e6F;
constexpr int kCosts = kOuters * kThicknesses;

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

double outer_at(int o) { return kOuterFirst + kOuterStep * o; }
double thickness_at(int w) { return kThicknessFirst + kThicknessStep * w; }

struct Profile {
  std::array<double, kSamples> value{};
  int first = 0, last = -1;  ///< samples that belong to this bone and its neighbourhood
};

Profile profile_at(const Vec3& vertex, const Vec3& normal, std::int32_t own,
                   const ShellImage& shell) {
  const VolumeGrid& grid = shell.image.grid;
  Profile profile;
  const auto sample = [&](int s) {
    const Vec3 voxel = grid.to_voxel(vertex + (kFirst + kStep * s) * normal);
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = static_cast<int>(std::lround(voxel[static_cast<Eigen::Index>(a)]));
      if (at[a] < 0 || at[a] >= grid.size[a]) return false;
    }
    profile.value[static_cast<std::size_t>(s)] = static_cast<double>(value_at(shell.image, voxel));
    const std::int32_t region = shell.region[grid.at(at[0], at[1], at[2])];
    return region == -1 || region == own;
  };
  // Outwards and inwards from the vertex, to where another region or the image's border stops it.
  const int middle = static_cast<int>(std::lround(-kFirst / kStep));
  profile.first = middle;
  profile.last = middle - 1;
  while (profile.last + 1 < kSamples && sample(profile.last + 1)) ++profile.last;
  while (profile.first > 0 && sample(profile.first - 1)) --profile.first;
  return profile;
}

}  // namespace

ShellFit fit_shell(const TriangleMesh& near, std::int32_t own, const ShellImage& shell) {
  const VolumeGrid& grid = shell.image.grid;
  const std::vector<Vec3> normals = vertex_normals(near);
  const MeshTopology topology = build_topology(near);
  const std::vector<std::vector<int>> neighbours = vertex_neighbours(topology);
  const auto count = static_cast<std::size_t>(near.vertex_count());

  std::vector<std::array<float, kCosts>> cost(count);
  const double contrast = shell.bright - shell.dark;
  // Misfit counts against the noise; a share of the contrast stands for what the model leaves out.
  const double scale = std::sqrt(shell.noise * shell.noise + 0.0025 * contrast * contrast);
  parallel_for(static_cast<int>(count), [&](int index) {
    const auto v = static_cast<std::size_t>(index);
    const Vec3 n = normals[v];
    const Vec3 in_voxels = grid.axes.transpose() * n;
    const double blur = 0.5 * in_voxels.cwiseProduct(grid.spacing).norm();
    const Profile profile = profile_at(near.vertices[v], n, own, shell);
    for (int o = 0; o < kOuters; ++o) {
      const double b = outer_at(o);
      std::array<double, kSamples> beyond{};
      for (int s = profile.first; s <= profile.last; ++s) {
        beyond[static_cast<std::size_t>(s)] = normal_distribution((kFirst + kStep * s - b) / blur);
      }
      for (int w = 0; w < kThicknesses; ++w) {
        const double a = b - thickness_at(w);
        if (a > kFarthestInner) {
          cost[v][static_cast<std::size_t>(o * kThicknesses + w)] = kForbidden;
          continue;
        }
        // Least squares for I_m and I_o above I_c; weak ties to the global levels keep both known
        // where the profile is short.
        double mm = 0.02, mo = 0.0, oo = 0.02, mr = 0.02 * contrast, orr = 0.02 * 0.5 * contrast,
               rr = 0.02 * contrast * contrast + 0.02 * 0.25 * contrast * contrast;
        for (int s = profile.first; s <= profile.last; ++s) {
          const double m = 1.0 - normal_distribution((kFirst + kStep * s - a) / blur);
          const double out = beyond[static_cast<std::size_t>(s)];
          const double r = profile.value[static_cast<std::size_t>(s)] - shell.dark;
          mm += m * m;
          mo += m * out;
          oo += out * out;
          mr += m * r;
          orr += out * r;
          rr += r * r;
        }
        const double determinant = std::max(mm * oo - mo * mo, 1e-9);
        double marrow = (mr * oo - orr * mo) / determinant;
        double outside = (orr * mm - mr * mo) / determinant;
        if (outside < 0.0) {
          outside = 0.0;
          marrow = mr / mm;
        }
        const double misfit = rr - 2.0 * (marrow * mr + outside * orr) + marrow * marrow * mm +
                              2.0 * marrow * outside * mo + outside * outside * oo;
        cost[v][static_cast<std::size_t>(o * kThicknesses + w)] =
            static_cast<float>(misfit / (scale * scale));
      }
    }
  });

  // Where a tendon lies on the bone, or another bone close by, the outer side can't be seen. So the
  // thickness is found twice: first nearly free, then near that of the surroundings' median.
  ShellFit fit;
  fit.mesh = near;
  fit.thickness.assign(count, kUsualThickness);
  std::vector<double> shift(count), misfit(count), usual(count, kUsualThickness);
  for (int pass = 0; pass < 2; ++pass) {
    const double tie = pass == 0 ? kLooseTie : kTightTie;
    parallel_for(static_cast<int>(count), [&](int index) {
      const auto v = static_cast<std::size_t>(index);
      std::array<double, kCosts> sum{};
      const auto add = [&](std::size_t u, double weight) {
        for (std::size_t c = 0; c < kCosts; ++c) sum[c] += weight * static_cast<double>(cost[u][c]);
      };
      add(v, 1.0);
      for (const int u : neighbours[v]) add(static_cast<std::size_t>(u), 0.6);
      for (int o = 0; o < kOuters; ++o) {
        for (int w = 0; w < kThicknesses; ++w) {
          const double off = (thickness_at(w) - usual[v]) / tie;
          sum[static_cast<std::size_t>(o * kThicknesses + w)] += off * off;
        }
      }
      const auto best = static_cast<int>(std::min_element(sum.begin(), sum.end()) - sum.begin());
      const int o = best / kThicknesses, w = best % kThicknesses;
      const auto refine = [&](int position, int size, int stride) {
        if (position == 0 || position + 1 == size) return 0.0;
        const double before = sum[static_cast<std::size_t>(best - stride)],
                     middle = sum[static_cast<std::size_t>(best)],
                     after = sum[static_cast<std::size_t>(best + stride)];
        const double bend = before - 2.0 * middle + after;
        return bend > 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
      };
      shift[v] = outer_at(o) + kOuterStep * refine(o, kOuters, kThicknesses);
      fit.thickness[v] = thickness_at(w) + kThicknessStep * refine(w, kThicknesses, 1);
      misfit[v] = static_cast<double>(cost[v][static_cast<std::size_t>(best)]);
    });
    if (pass > 0) break;
    parallel_for(static_cast<int>(count), [&](int index) {
      const auto v = static_cast<std::size_t>(index);
      std::vector<double> around;
      for (std::size_t u = 0; u < count; ++u) {
        if ((near.vertices[u] - near.vertices[v]).squaredNorm() < kSurroundings * kSurroundings) {
          around.push_back(fit.thickness[u]);
        }
      }
      const auto lower =
          around.begin() + static_cast<long>(0.5 * static_cast<double>(around.size()));
      std::nth_element(around.begin(), lower, around.end());
      usual[v] = *lower;
    });
  }
  // A shell is smooth: the shift is a median of the neighbours' and then a mean.
  std::vector<double> even(count);
  for (int round = 0; round < 3; ++round) {
    for (std::size_t v = 0; v < count; ++v) {
      std::vector<double> around = {shift[v]};
      for (const int u : neighbours[v]) around.push_back(shift[static_cast<std::size_t>(u)]);
      if (round == 0) {
        std::nth_element(around.begin(), around.begin() + static_cast<long>(around.size() / 2),
                         around.end());
        even[v] = around[around.size() / 2];
      } else {
        double sum = 0.0;
        for (const double s : around) sum += s;
        even[v] = 0.5 * shift[v] + 0.5 * sum / static_cast<double>(around.size());
      }
    }
    shift = even;
  }
  double squares = 0.0;
  for (std::size_t v = 0; v < count; ++v) {
    fit.mesh.vertices[v] += shift[v] * normals[v];
    squares += misfit[v];
  }
  fit.residual = count > 0
                     ? std::sqrt(squares / static_cast<double>(count) / kSamples) * scale / contrast
                     : 0.0;
  return fit;
}

}  // namespace palmar
