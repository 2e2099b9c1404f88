// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/contact_patch.h"

#include <algorithm>
#include <cmath>

namespace palmar::contact {
namespace {

/// Discs overlap and leave gaps, so that a cell on smooth skin is covered within 10 % of its area.
/// More or less than that is skin that lies in folds or crowds on an edge, and no area of the cell.
constexpr double kLeastCover = 0.9, kMostCover = 1.1;

/// Share x / l of an edge that is in contact; see contact_area(). With k = 1 / K the two laws add
/// up to p^2 k^2 + (3 E* g / 4)^(2/3) k^(2/3) = l. In y = 1 - x / l, which is proportional to
/// k^(2/3), that is c y^3 + y = 1 with c = (p l / (3 G g))^2.
double share_in_contact(double pressure, double gap, double shear_modulus, double length) {
  if (gap <= 0.0) return 1.0;
  const double ratio = pressure * length / (3.0 * shear_modulus * gap);
  const double c = ratio * ratio;
  if (!(c < 1e150)) return 1.0;
  // Newton's method on a convex function, from a bound above the root: falls to it and stays.
  double y = c > 1.0 ? 1.0 / std::cbrt(c) : 1.0;
  constexpr int kMaxSteps = 12;  // 5 to 6 are needed
  for (int i = 0; i < kMaxSteps; ++i) {
    const double next = y - (y * (c * y * y + 1.0) - 1.0) / (3.0 * c * y * y + 1.0);
    if (!(next < y)) break;
    y = next;
  }
  return std::clamp(c * y * y * y, 0.0, 1.0);
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

CellPeaks peak_over_cells(const SkinGeometry& skin, std::span<const int> centres,
                          const std::vector<double>& force, const std::vector<hand::Region>& region,
                          double cell_area) {
  const SensorCells cells =
      sensor_cells(skin, centres, std::vector<double>(centres.size(), cell_area));
  CellPeaks peaks;
  for (std::size_t c = 0; c < centres.size(); ++c) {
    const hand::Region home = region[centres[c]];
    double own = 0.0;
    double all = 0.0;
    double area = 0.0;
    for (int k = cells.begin[c]; k < cells.begin[c + 1]; ++k) {
      const int v = cells.vertex[k];
      const double part = force[v] * cells.shared[k] / skin.area[v];
      all += part;
      if (region[v] == home) own += part;
      area += cells.shared[k];
    }
    if (!(area > 0.0)) continue;
    area = std::clamp(area, kLeastCover * cell_area, kMostCover * cell_area);
    peaks.own = std::max(peaks.own, own / area);
    peaks.all = std::max(peaks.all, all / area);
  }
  return peaks;
}

}  // namespace palmar::contact
