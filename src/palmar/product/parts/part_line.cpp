// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "palmar/core/parallel.h"
#include "palmar/product/parts/part_outline.h"

namespace palmar::product {
namespace {

constexpr double kStep = 3.0;          // mm between sections: a fifth of a finger's breadth
constexpr double kGirthOfJoint = 1.4;  // of the bar's own: as kJump of the rough parts
constexpr double kFlare = 3.0;         // girth that a bar's free end may grow to (a bat's)
constexpr int kRounds = 3;

double length_of(const std::vector<Vec3>& line, bool is_ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i + (is_ring ? 0 : 1) < line.size(); ++i) {
    sum += (line[(i + 1) % line.size()] - line[i]).norm();
  }
  return sum;
}

// Points evenly along a line: `count` of them, ends included; round a ring.
std::vector<Vec3> evenly(const std::vector<Vec3>& line, bool is_ring, int count) {
  const double length = length_of(line, is_ring);
  const double step = length / (is_ring ? count : count - 1);
  std::vector<Vec3> result;
  std::size_t k = 0;
  double begin = 0.0;
  for (int i = 0; i < count; ++i) {
    const double way = i * step;
    while (true) {
      const Vec3 &a = line[k % line.size()], &b = line[(k + 1) % line.size()];
      const double d = (b - a).norm();
      const bool is_last = k + (is_ring ? 1 : 2) >= line.size();
      if (way <= begin + d || is_last) {
        result.push_back(d > 0.0 ? Vec3(a + (b - a) * std::min(1.0, (way - begin) / d)) : a);
        break;
      }
      begin += d;
      ++k;
    }
  }
  return result;
}

// Directions of a line by differences over `window` points on either side.
std::vector<Vec3> axes_of(const std::vector<Vec3>& line, bool is_ring, int window) {
  const int n = static_cast<int>(line.size());
  std::vector<Vec3> axes(n);
  for (int i = 0; i < n; ++i) {
    const int a = is_ring ? (i - window + n) % n : std::max(0, i - window);
    const int b = is_ring ? (i + window) % n : std::min(n - 1, i + window);
    axes[i] = (line[b] - line[a]).normalized();
  }
  return axes;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void smooth(std::vector<Vec3>& line, bool is_ring) {
  const std::vector<Vec3> old = line;
  const std::size_t n = line.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_ring && (i == 0 || i + 1 == n)) continue;
    line[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
  }
}

using Outlines = std::vector<std::optional<OutlineMeasures>>;

Outlines outlines_along(const geometry::TriangleMesh& mesh, const std::vector<Vec3>& line,
                        const std::vector<Vec3>& axes, const OutlineReach& reach) {
  Outlines outlines(line.size());
  parallel_for(static_cast<int>(line.size()),
               [&](int i) { outlines[i] = outline_at(mesh, line[i], axes[i], reach); });
  return outlines;
}

double median_girth(const Outlines& outlines) {
  std::vector<double> girths;
  for (const auto& o : outlines) {
    if (o) girths.push_back(o->girth);
  }
  return median(std::move(girths));
}

// Share of the median girth up to which a section shows the bar alone.
double largest_share(bool is_free) { return is_free ? kFlare : kGirthOfJoint; }

// The longest run of sections that show the bar alone, as [begin, end). What it joins is at its
// ends: a grip between thinner legs is the bar's own.
std::array<std::size_t, 2> own_run(const Outlines& outlines, double girth,
                                   const LineRequest& request) {
  const std::array<bool, 2>& is_free = request.is_free;
  const std::size_t n = outlines.size();
  std::vector<char> is_own(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double share = largest_share(is_free[2 * i < n ? 0 : 1]);
    is_own[i] = outlines[i] && outlines[i]->girth <= girth * share ? 1 : 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (is_own[i] != 0) continue;
    const std::size_t begin = i;
    bool is_grip = true;
    for (; i < n && is_own[i] == 0; ++i) {
      is_grip = is_grip && outlines[i] && outlines[i]->girth <= girth * kFlare;
    }
    // The legs of a loop may be short. Of another bar there has to be as much on either side: else
    // the thin bit may be a notch in what the bar joins.
    constexpr std::size_t kLeg = 3;  // sections
    const std::size_t leg = request.is_in_loop ? kLeg : i - begin;
    if (is_grip && begin >= leg && n - i >= leg) {
      std::fill(is_own.begin() + static_cast<std::ptrdiff_t>(begin),
                is_own.begin() + static_cast<std::ptrdiff_t>(i), 1);
    }
  }
  std::array<std::size_t, 2> best = {0, 0};
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    if (i < n && is_own[i] != 0) continue;
    if (i - begin > best[1] - best[0]) best = {begin, i};
    begin = i + 1;
  }
  return best;
}

PartSection section_of(const OutlineMeasures& o, double along, const Vec3& axis) {
  PartSection s;
  s.along = along;
  s.centre = o.centre;
  s.axis = axis;
  s.wide = o.wide;
  s.area = o.area;
  s.girth = o.girth;
  s.width = o.width;
  s.thickness = o.thickness;
  return s;
}

// Where a joined end lies beyond `from` along `axis` (out of the part): where the girth has grown.
Vec3 joined_end(const geometry::TriangleMesh& mesh, const Vec3& from, const Vec3& axis,
                double girth, double radius, const OutlineReach& reach) {
  double before = girth, way_before = 0.0;
  const double farthest = 3.0 * radius + 10.0;
  for (double way = 1.0; way <= farthest; way += 1.0) {
    const auto o = outline_at(mesh, from + way * axis, axis, reach);
    const double now = o ? o->girth : std::numeric_limits<double>::infinity();
    if (now > kGirthOfJoint * girth) {
      const double share =
          std::isfinite(now)
              ? std::clamp((kGirthOfJoint * girth - before) / (now - before), 0.0, 1.0)
              : 0.0;
      return from + (way_before + share * (way - way_before)) * axis;
    }
    before = now;
    way_before = way;
  }
  return from;
}

// At a joined end a line turns into what it joins: the turned bit isn't the bar's. `reach`: its
// radius, mm.
void drop_bent_ends(double reach, const std::array<bool, 2>& is_free, std::vector<Vec3>& line) {
  constexpr double kBent = 0.87;    // cosine (30 deg) against the direction further in
  constexpr double kLongest = 3.0;  // radii that a bend takes at most
  for (int end = 0; end < 2; ++end) {
    std::reverse(line.begin(), line.end());
    if (is_free[end]) continue;
    const auto direction = [&](std::size_t from) {  // over one radius, from there inwards
      std::size_t to = from;
      double way = 0.0;
      while (to > 0 && way < reach) {
        way += (line[to] - line[to - 1]).norm();
        --to;
      }
      return std::pair(Vec3((line[from] - line[to]).normalized()), to);
    };
    const std::size_t n = line.size();
    std::size_t inner = n - 1;
    double way = 0.0;
    while (inner > 0 && way < kLongest * reach) {
      way += (line[inner] - line[inner - 1]).norm();
      --inner;
    }
    if (inner < 4) continue;
    const Vec3 own = direction(inner).first;
    std::size_t keep = n;
    while (keep > inner + 1 && direction(keep - 1).first.dot(own) < kBent) --keep;
    line.resize(keep);
  }
}

}  // namespace

MeasuredLine measure_line(const geometry::TriangleMesh& mesh, const LineRequest& request) {
  MeasuredLine result;
  std::vector<Vec3> line = request.line;
  std::vector<double> radius = request.radius;
  if (line.size() < 2) return result;
  const double thick = std::max(1.0, median(radius));
  const OutlineReach reach = {2.0 * thick, request.gap};
  if (!request.is_ring) {
    // A line turns to a corner of a flat end within about a radius.
    for (int end = 0; end < 2; ++end) {
      std::reverse(line.begin(), line.end());
      std::reverse(radius.begin(), radius.end());
      if (!request.is_free[end]) continue;
      double way = 0.0;
      while (line.size() > 6 && way < thick) {
        way += (line.back() - line[line.size() - 2]).norm();
        line.pop_back();
        radius.pop_back();
      }
    }
  }
  if (!request.is_ring && !request.is_in_loop) drop_bent_ends(thick, request.is_free, line);
  double length = length_of(line, request.is_ring);
  if (!(length > 0.0)) return result;
  const auto count_for = [](double l) {
    return std::clamp(static_cast<int>(std::lround(l / kStep)) + 1, 8, 80);
  };
  line = evenly(line, request.is_ring, count_for(length));
  const auto window_for = [&](const std::vector<Vec3>& l) {
    const double step = length_of(l, request.is_ring) / static_cast<double>(l.size());
    return std::clamp(static_cast<int>(std::lround(thick / step)), 1,
                      std::max(1, static_cast<int>(l.size()) / 4));
  };
  double girth = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Vec3> axes = axes_of(line, request.is_ring, window_for(line));
    const Outlines outlines = outlines_along(mesh, line, axes, reach);
    girth = median_girth(outlines);
    if (!(girth > 0.0)) return result;
    if (request.is_ring) {
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (outlines[i] && outlines[i]->girth <= kFlare * girth) line[i] = outlines[i]->centre;
      }
    } else {
      const auto [begin, end] = own_run(outlines, girth, request);
      if (end - begin < 3) return result;
      std::vector<Vec3> next;
      for (std::size_t i = begin; i < end; ++i) next.push_back(outlines[i]->centre);
      line = std::move(next);
    }
    smooth(line, request.is_ring);
    smooth(line, request.is_ring);
    line = evenly(line, request.is_ring, count_for(length_of(line, request.is_ring)));
  }
  if (!request.is_ring) {
    std::vector<Vec3> axes = axes_of(line, false, window_for(line));
    Outlines outlines = outlines_along(mesh, line, axes, reach);
    const auto [begin, end] = own_run(outlines, girth, request);
    if (end - begin < 3) return result;
    const auto keep = [begin = begin, end = end](auto& values) {
      values.erase(values.begin() + static_cast<std::ptrdiff_t>(end), values.end());
      values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(begin));
    };
    keep(line);
    keep(axes);
    keep(outlines);
    const auto n = line.size();
    std::array<Vec3, 2> ends = {line.front(), line.back()};
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t at = k == 0 ? 0 : n - 1;
      const Vec3 out = k == 0 ? Vec3(-axes[at]) : axes[at];
      std::vector<double> last;  // girths of the last quarter, without the last
      for (std::size_t i = 1; i <= std::max<std::size_t>(2, n / 4) && i < n; ++i) {
        const auto& o = outlines[k == 0 ? i : n - 1 - i];
        if (o) last.push_back(o->girth);
      }
      if (request.is_free[k]) {
        double farthest = 0.0;
        for (const Vec3& p : request.points) {
          const double d = out.dot(p - line[at]);
          // Not the other leg of a crook; half a girth is at least the width.
          if ((p - line[at] - d * out).norm() <= 0.5 * girth) farthest = std::max(farthest, d);
        }
        ends[k] = line[at] + farthest * out;
      } else {
        ends[k] = joined_end(mesh, line[at], out, std::max(median(last), 1e-3), thick, reach);
      }
    }
    if ((ends[0] - line.front()).norm() > 1e-6) line.insert(line.begin(), ends[0]);
    if ((ends[1] - line.back()).norm() > 1e-6) line.push_back(ends[1]);
  }
  length = length_of(line, request.is_ring);
  const int count = count_for(length);
  line = evenly(line, request.is_ring, count);
  result.line = line;
  result.length = length;
  // Sections between the points of the line: those at the very ends show the rounding there.
  std::vector<Vec3> middles, axes;
  const std::vector<Vec3> at_points = axes_of(line, request.is_ring, window_for(line));
  const int pieces = request.is_ring ? count : count - 1;
  for (int i = 0; i < pieces; ++i) {
    middles.push_back(0.5 * (line[i] + line[(i + 1) % count]));
    axes.push_back((at_points[i] + at_points[(i + 1) % count]).normalized());
  }
  const Outlines outlines = outlines_along(mesh, middles, axes, reach);
  for (int i = 0; i < pieces; ++i) {
    if (!outlines[i] || outlines[i]->girth > kFlare * girth) continue;
    result.sections.push_back(section_of(*outlines[i], (i + 0.5) / pieces, axes[i]));
  }
  if (result.sections.empty()) return {};
  return result;
}

MeasuredLine measure_axis(const geometry::TriangleMesh& piece, const Vec3& point,
                          const Vec3& axis) {
  MeasuredLine result;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Triangle& t : piece.triangles) {
    for (const int i : t) {
      const double d = axis.dot(piece.vertices[i] - point);
      low = std::min(low, d);
      high = std::max(high, d);
    }
  }
  if (!(high > low)) return result;
  result.length = high - low;
  const int pieces = std::clamp(static_cast<int>(std::lround(result.length / kStep)), 8, 80);
  std::vector<std::optional<OutlineMeasures>> hulls(pieces);
  const auto at = [&](double share) { return Vec3(point + (low + share * (high - low)) * axis); };
  parallel_for(pieces, [&](int i) { hulls[i] = hull_at(piece, at((i + 0.5) / pieces), axis); });
  for (int i = 0; i < pieces; ++i) {
    if (hulls[i]) result.sections.push_back(section_of(*hulls[i], (i + 0.5) / pieces, axis));
  }
  if (result.sections.empty()) return {};
  // The axis through the middle of the sections.
  std::vector<double> x, y;
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  for (const PartSection& s : result.sections) {
    x.push_back(u.dot(s.centre - point));
    y.push_back(v.dot(s.centre - point));
  }
  const Vec3 shift = median(x) * u + median(y) * v;
  for (int i = 0; i <= pieces; ++i) {
    result.line.push_back(at(static_cast<double>(i) / pieces) + shift);
  }
  return result;
}

}  // namespace palmar::product
