// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/mri/bones/layer_fit.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar {
namespace {

constexpr float kForbidden = 1e6F;
constexpr double kLevelTie = 0.02;  // samples that the expected signals count for
constexpr double kNeighbourWeight = 0.6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Misfit of a profile over the grid of candidates.
std::vector<float> misfits(const LayerProfile& profile, const LayerSearch& search) {
  std::vector<float> cost(at(search.outers * search.thicknesses), 0.0F);
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
      float& here = cost[at(o * search.thicknesses + w)];
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
      for (const int u : neighbours[v]) around.push_back(shift[at(u)]);
      if (round == 0) {
        const auto middle = around.begin() + static_cast<long>(around.size() / 2);
        std::nth_element(around.begin(), middle, around.end());
        even[v] = *middle;
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

LayerFit fit_layers(const TriangleMesh& near, const LayerSearch& search,
                    const std::function<LayerProfile(int, const Vec3&)>& profile_at) {
  const std::vector<Vec3> normals = vertex_normals(near);
  const std::vector<std::vector<int>> neighbours = vertex_neighbours(build_topology(near));
  const int count = near.vertex_count();
  std::vector<std::vector<float>> cost(at(count));
  std::vector<double> samples(at(count));
  parallel_for(count, [&](int v) {
    const LayerProfile profile = profile_at(v, normals[at(v)]);
    cost[at(v)] = misfits(profile, search);
    samples[at(v)] = static_cast<double>(profile.value.size());
  });

  LayerFit fit;
  fit.mesh = near;
  fit.thickness.assign(at(count), search.usual_thickness);
  std::vector<double> shift(at(count)), misfit(at(count)), usual = fit.thickness;
  const int stride = search.thicknesses;
  for (int pass = 0; pass < 2; ++pass) {
    const double tie = pass == 0 ? search.loose_tie : search.tight_tie;
    parallel_for(count, [&](int v) {
      std::vector<double> sum(cost[at(v)].begin(), cost[at(v)].end());
      for (const int u : neighbours[at(v)]) {
        for (std::size_t c = 0; c < sum.size(); ++c) {
          sum[c] += kNeighbourWeight * static_cast<double>(cost[at(u)][c]);
        }
      }
      for (int o = 0; o < search.outers; ++o) {
        for (int w = 0; w < stride; ++w) {
          const double off =
              (search.thickness_first + search.thickness_step * w - usual[at(v)]) / tie;
          sum[at(o * stride + w)] += off * off;
        }
      }
      const auto best = static_cast<int>(std::min_element(sum.begin(), sum.end()) - sum.begin());
      const int o = best / stride, w = best % stride;
      const auto refine = [&](int position, int size, int step) {
        if (position == 0 || position + 1 == size) return 0.0;
        const double before = sum[at(best - step)], middle = sum[at(best)],
                     after = sum[at(best + step)];
        const double bend = before - 2.0 * middle + after;
        return bend > 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
      };
      shift[at(v)] =
          search.outer_first + search.outer_step * (o + refine(o, search.outers, stride));
      fit.thickness[at(v)] =
          search.thickness_first + search.thickness_step * (w + refine(w, stride, 1));
      misfit[at(v)] = static_cast<double>(cost[at(v)][at(best)]);
    });
    if (pass > 0) break;
    parallel_for(count, [&](int v) {
      std::vector<double> around;
      for (std::size_t u = 0; u < near.vertices.size(); ++u) {
        if ((near.vertices[u] - near.vertices[at(v)]).squaredNorm() <
            search.surroundings * search.surroundings) {
          around.push_back(fit.thickness[u]);
        }
      }
      const auto middle = around.begin() + static_cast<long>(around.size() / 2);
      std::nth_element(around.begin(), middle, around.end());
      usual[at(v)] = *middle;
    });
  }
  shift = evened(std::move(shift), neighbours);
  double squares = 0.0, all = 0.0;
  for (int v = 0; v < count; ++v) {
    fit.mesh.vertices[at(v)] += shift[at(v)] * normals[at(v)];
    squares += misfit[at(v)];
    all += samples[at(v)];
  }
  fit.residual = all > 0.0 ? std::sqrt(squares / all) : 0.0;
  return fit;
}

}  // namespace palmar
