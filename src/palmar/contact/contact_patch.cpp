// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/contact_patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/contact/response.h"

namespace palmar {
namespace {

/// Share x / l of an edge that is in contact; see contact_area(). With k = 1 / K the two laws add
/// up to p^2 k^2 + (3 E* g / 4)^(2/3) k^(2/3) = l, which grows with k.
double share_in_contact(double pressure, double gap, double shear_modulus, double length) {
  if (gap <= 0.0) return 1.0;
  const double a = pressure * pressure;
  const double b = std::cbrt(std::pow(3.0 * shear_modulus * gap, 2));
  double lower = 0.0;
  double upper = std::min(std::sqrt(length / a), std::pow(length / b, 1.5));
  for (int i = 0; i < 40; ++i) {
    const double k = 0.5 * (lower + upper);
    (a * k * k + b * std::cbrt(k * k) < length ? lower : upper) = k;
  }
  return std::clamp(a * upper * upper / length, 0.0, 1.0);
}

}  // namespace

std::vector<double> contact_area(const std::vector<Vec3>& positions,
                                 const std::vector<Triangle>& triangles,
                                 const std::vector<double>& pressure,
                                 const std::vector<double>& gap,
                                 const std::vector<double>& shear_modulus) {
  std::vector<double> area(positions.size(), 0.0);
  for (const Triangle& t : triangles) {
    int loaded = 0;
    for (const int v : t) loaded += pressure[v] > 0.0;
    if (loaded == 0) continue;
    const double whole =
        0.5 * (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm();
    if (loaded == 3) {
      for (const int v : t) area[v] += whole / 3.0;
      continue;
    }
    const auto share = [&](int from, int to) {
      return share_in_contact(pressure[from], gap[to], shear_modulus[from],
                              (positions[to] - positions[from]).norm());
    };
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const int c = t[(k + 2) % 3];
      if (loaded == 1 && pressure[a] > 0.0) area[a] += whole * share(a, b) * share(a, c);
      if (loaded == 2 && !(pressure[a] > 0.0)) {
        const double part = whole * (1.0 - (1.0 - share(b, a)) * (1.0 - share(c, a)));
        area[b] += 0.5 * part;
        area[c] += 0.5 * part;
      }
    }
  }
  return area;
}

double peak_over_cells(const SkinGeometry& skin, const std::vector<int>& vertices,
                       const std::vector<double>& pressure, double cell_area) {
  const double cell_radius = std::sqrt(cell_area / std::numbers::pi);
  double peak = 0.0;
  std::vector<int> near;
  std::vector<int> mark(skin.position.size(), -1);
  for (const int centre : vertices) {
    near.assign(1, centre);
    mark[centre] = centre;
    double force = 0.0;
    double area = 0.0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      const int v = near[k];
      const double shared =
          disc_overlap(arc_distance(skin, centre, v), cell_radius, skin.radius[v]);
      if (shared <= 0.0) continue;
      force += pressure[v] * shared;
      area += shared;
      for (const int w : skin.neighbours(v)) {
        if (mark[w] == centre) continue;
        mark[w] = centre;
        near.push_back(w);
      }
    }
    if (area > 0.0) peak = std::max(peak, force / area);
  }
  return peak;
}

}  // namespace palmar
