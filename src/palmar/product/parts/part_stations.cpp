// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_stations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palmar::product {
namespace {

// An offset of the middle of the product's surface from a part, as a share of the part's size,
// that is more than rounding and noise: below it the part counts as lying on that middle.
constexpr double kAside = 0.02;

}  // namespace

bool runs_backwards(const ProductPart& part, const std::vector<Vec3>& line, const Vec3& middle) {
  if (part.is_ring) return false;
  const bool is_free0 = !part.ends[0].joined, is_free1 = !part.ends[1].joined;
  if (is_free0 != is_free1) return is_free1;
  const Vec3 across = line.back() - line.front();
  const double aside = across.dot(middle - 0.5 * (line.front() + line.back())) /
                       std::max(1e-9, across.squaredNorm());
  if (std::abs(aside) > kAside) return aside < 0.0;
  double moment = 0.0, sum = 0.0;
  for (const PartSection& s : part.sections) {
    moment += s.girth * (s.along - 0.5);
    sum += s.girth;
  }
  return moment < -1e-3 * sum;
}

std::vector<PartStation> stations_of(const std::vector<Vec3>& line, bool is_ring,
                                     const Vec3& zero) {
  const int n = static_cast<int>(line.size());
  const int count = is_ring ? n + 1 : n;
  std::vector<PartStation> stations(count);
  for (int i = 0; i < count; ++i) {
    PartStation& s = stations[i];
    s.along = static_cast<double>(i) / (count - 1);
    s.centre = line[i % n];
    const int a = is_ring ? (i + n - 1) % n : std::max(0, i - 1);
    const int b = is_ring ? (i + 1) % n : std::min(n - 1, i + 1);
    s.axis = (line[b] - line[a]).normalized();
  }
  const auto across = [](const Vec3& v, const Vec3& axis) {
    const Vec3 out = v - axis * axis.dot(v);
    return out.norm() > 1e-9 ? Vec3(out.normalized()) : Vec3(axis.unitOrthogonal());
  };
  const int middle = is_ring ? 0 : count / 2;
  stations[middle].zero = across(zero, stations[middle].axis);
  const auto carry = [&](int from, int to) {
    const PartStation& a = stations[from];
    PartStation& b = stations[to];
    const Vec3 v = b.centre - a.centre;
    const double c = v.squaredNorm();
    if (c == 0.0) {
      b.zero = across(a.zero, b.axis);
      return;
    }
    const Vec3 r = a.zero - 2.0 / c * v.dot(a.zero) * v;
    const Vec3 t = a.axis - 2.0 / c * v.dot(a.axis) * v;
    const Vec3 w = b.axis - t;
    const double d = w.squaredNorm();
    b.zero = across(d > 1e-18 ? Vec3(r - 2.0 / d * w.dot(r) * w) : r, b.axis);
  };
  for (int i = middle; i + 1 < count; ++i) carry(i, i + 1);
  for (int i = middle; i > 0; --i) carry(i, i - 1);
  return stations;
}

Vec3 zero_of(const ProductPart& part, const std::vector<Vec3>& line, const Vec3& middle) {
  const std::size_t at = part.is_ring ? 0 : line.size() / 2;
  const Vec3 axis =
      (line[(at + 1) % line.size()] - line[(at + line.size() - 1) % line.size()]).normalized();
  const auto across = [&](const Vec3& v) { return Vec3(v - axis * axis.dot(v)); };
  if (part.opening) return across(part.opening->centre - line[at]);
  const Vec3 aside = across(middle - line[at]);
  if (aside.norm() > kAside * part.diameter()) return aside;
  const PartSection& section = part.sections[part.sections.size() / 2];
  return across(section.wide);
}

std::vector<PartWaist> waists_of(const std::vector<PartSection>& sections) {
  constexpr double kLess = 0.96;  // of the girth on both sides: 4 % is 3 mm of a bottle's diameter
  constexpr double kNeck = 0.6;   // of the largest girth
  std::vector<PartWaist> waists;
  const int n = static_cast<int>(sections.size());
  double largest = 0.0;
  for (const PartSection& s : sections) largest = std::max(largest, s.girth);
  for (int i = 1; i + 1 < n; ++i) {
    const double g = sections[i].girth;
    double before = 0.0, after = 0.0;
    bool is_least = true;
    // The highest on either side before it gets lower than here.
    for (int k = i - 1; k >= 0 && sections[k].girth >= g; --k) {
      before = std::max(before, sections[k].girth);
    }
    for (int k = i + 1; k < n && sections[k].girth > g; ++k) {
      after = std::max(after, sections[k].girth);
    }
    is_least = g <= kLess * before && g <= kLess * after;
    if (!is_least) continue;
    // Between the stations: top of the parabola through three of them.
    const double a = sections[i - 1].girth, c = sections[i + 1].girth;
    const double bend = a - 2.0 * g + c;
    const double shift = bend > 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
    PartWaist w;
    w.along = sections[i].along + shift / n;
    w.girth = g - 0.25 * (a - c) * shift;
    w.is_neck = g < kNeck * largest;
    waists.push_back(w);
  }
  // A neck that doesn't widen again: the thin rest at an end, if a finger goes round it.
  for (const bool is_last : {false, true}) {
    int run = 0;
    while (run < n && sections[is_last ? n - 1 - run : run].girth < kNeck * largest) ++run;
    if (run < 3 || run >= n) continue;
    const int first = is_last ? n - run : 0;
    bool is_known = false;
    for (const PartWaist& w : waists) {
      is_known = is_known ||
                 (w.along >= sections[first].along && w.along <= sections[first + run - 1].along);
    }
    if (is_known) continue;
    const int middle = first + run / 2;
    waists.push_back({sections[middle].along, sections[middle].girth, true});
  }
  std::sort(waists.begin(), waists.end(),
            [](const PartWaist& a, const PartWaist& b) { return a.along < b.along; });
  return waists;
}

}  // namespace palmar::product
