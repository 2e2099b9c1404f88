// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/layer_fit.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr float kForbidden = 1e6F;
constexpr double kLevelTie = 0.02;  // samples that the expected signals count for
constexpr double kNeighbourWeight = 0.6;

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Misfit of a profile over the grid of candidates.
std::vector<float> misfits(const LayerProfile& profile, const LayerSearch& search) {
  std::vector<float> cost(search.outers * search.thicknesses, 0.0F);
  const std::size_t samples = profile.value.size();
  const double inside = search.bright - profile.known, other = search.usual - profile.known;
  const auto place = [&](std::size_t s) {
    return profile.first + profile.step * static_cast<double>(s);
  };
  std::vector<double> beyond(samples);
  for (int o = 0; o < search.outers; ++o) {
    const double b = search.outer_first + search.outer_step * o;
    for (std::size_t s = 0; s < samples; ++s) {
      beyond[s] = normal_distribution((place(s) - b) / profile.blur);
    }
    for (int w = 0; w < search.thicknesses; ++w) {
      float& here = cost[o * search.thicknesses + w];
      const double a = b - (search.thickness_first + search.thickness_step * w);
      if (a > search.farthest_inner) {
        here = kForbidden;
        continue;
      }
      // Least squares for the two unknown signals above the known one.
      double mm = kLevelTie, mo = 0.0, oo = kLevelTie, mr = kLevelTie * inside,
             orr = kLevelTie * other, rr = kLevelTie * (inside * inside + other * other);
      for (std::size_t s = 0; s < samples; ++s) {
        const double past_inner = normal_distribution((place(s) - a) / profile.blur);
        const double m = 1.0 - past_inner;
        const double x = beyond[s];
        const double r = profile.value[s] - profile.known;
        mm += m * m;
        mo += m * x;
        oo += x * x;
        mr += m * r;
        orr += x * r;
        rr += r * r;
      }
      const double determinant = std::max(mm * oo - mo * mo, 1e-9);
      double first = (mr * oo - orr * mo) / determinant;
      double second = (orr * mm - mr * mo) / determinant;
      if (second < 0.0) {
        second = 0.0;
        first = mr / mm;
      }
      const double misfit = rr - 2.0 * (first * mr + second * orr) + first * first * mm +
                            2.0 * first * second * mo + second * second * oo;
      here = static_cast<float>(misfit / (search.scale * search.scale));
    }
  }
  return cost;
}

/// Median and then means over the neighbours: a layer is smooth.
std::vector<double> evened(std::vector<double> shift,
                           const std::vector<std::vector<int>>& neighbours) {
  std::vector<double> even(shift.size());
  for (int round = 0; round < 3; ++round) {
    for (std::size_t v = 0; v < shift.size(); ++v) {
      std::vector<double> around = {shift[v]};
      for (const int u : neighbours[v]) around.push_back(shift[u]);
      if (round == 0) {
        even[v] = statistics::median(std::move(around));
      } else {
        double sum = 0.0;
        for (const double s : around) sum += s;
        even[v] = 0.5 * shift[v] + 0.5 * sum / static_cast<double>(around.size());
      }
    }
    shift = even;
  }
  return shift;
}

}  // namespace

LayerFit fit_layers(const geometry::TriangleMesh& near, const LayerSearch& search,
                    const std::function<LayerProfile(int, const Vec3&)>& profile_at) {
  const std::vector<Vec3> normals = geometry::vertex_normals(near);
  const std::vector<std::vector<int>> neighbours =
      geometry::vertex_neighbours(geometry::build_topology(near));
  const int count = near.vertex_count();
  std::vector<std::vector<float>> cost(count);
  std::vector<double> samples(count);
  parallel_for(count, [&](int v) {
    const LayerProfile profile = profile_at(v, normals[v]);
    cost[v] = misfits(profile, search);
    samples[v] = static_cast<double>(profile.value.size());
  });

  LayerFit fit;
  fit.mesh = near;
  fit.thickness.assign(count, search.usual_thickness);
  std::vector<double> shift(count), misfit(count), usual = fit.thickness;
  const int stride = search.thicknesses;
  for (int pass = 0; pass < 2; ++pass) {
    const double tie = pass == 0 ? search.loose_tie : search.tight_tie;
    parallel_for(count, [&](int v) {
      std::vector<double> sum(cost[v].begin(), cost[v].end());
      for (const int u : neighbours[v]) {
        for (std::size_t c = 0; c < sum.size(); ++c) {
          sum[c] += kNeighbourWeight * static_cast<double>(cost[u][c]);
        }
      }
      for (int o = 0; o < search.outers; ++o) {
        for (int w = 0; w < stride; ++w) {
          const double off = (search.thickness_first + search.thickness_step * w - usual[v]) / tie;
          sum[o * stride + w] += off * off;
        }
      }
      const auto best = static_cast<int>(std::min_element(sum.begin(), sum.end()) - sum.begin());
      const int o = best / stride, w = best % stride;
      const auto refine = [&](int position, int size, int step) {
        if (position == 0 || position + 1 == size) return 0.0;
        const double before = sum[best - step], middle = sum[best], after = sum[best + step];
        const double bend = before - 2.0 * middle + after;
        return bend > 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
      };
      shift[v] = search.outer_first + search.outer_step * (o + refine(o, search.outers, stride));
      fit.thickness[v] =
          search.thickness_first + search.thickness_step * (w + refine(w, stride, 1));
      misfit[v] = static_cast<double>(cost[v][best]);
    });
    if (pass > 0) break;
    parallel_for(count, [&](int v) {
      std::vector<double> around;
      for (std::size_t u = 0; u < near.vertices.size(); ++u) {
        if ((near.vertices[u] - near.vertices[v]).squaredNorm() <
            search.surroundings * search.surroundings) {
          around.push_back(fit.thickness[u]);
        }
      }
      usual[v] = statistics::median(std::move(around));
    });
  }
  shift = evened(std::move(shift), neighbours);
  double squares = 0.0, all = 0.0;
  for (int v = 0; v < count; ++v) {
    fit.mesh.vertices[v] += shift[v] * normals[v];
    squares += misfit[v];
    all += samples[v];
  }
  fit.residual = all > 0.0 ? std::sqrt(squares / all) : 0.0;
  return fit;
}

}  // namespace palmar::capture
