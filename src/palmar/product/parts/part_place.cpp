// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"

namespace palmar::product {
namespace {

void require_line(const ProductPart& part) {
  if (part.line.size() < 2) {
    throw UsageError("part " + std::to_string(part.number) + ": its centre line has " +
                     std::to_string(part.line.size()) + " points; at least 2 are required");
  }
}

// Station between two of the line; outside of it straight on.
PartStation station_at(const ProductPart& part, double along) {
  require_line(part);
  if (part.is_ring) along -= std::floor(along);
  const std::vector<PartStation>& line = part.line;
  std::size_t k = 1;
  while (k + 1 < line.size() && line[k].along < along) ++k;
  const PartStation &a = line[k - 1], &b = line[k];
  const double share = (along - a.along) / (b.along - a.along);
  PartStation s;
  s.along = along;
  s.centre = (1.0 - share) * a.centre + share * b.centre;
  const double turn = std::clamp(share, 0.0, 1.0);
  s.axis = ((1.0 - turn) * a.axis + turn * b.axis).normalized();
  const Vec3 zero = (1.0 - turn) * a.zero + turn * b.zero;
  s.zero = (zero - s.axis * s.axis.dot(zero)).normalized();
  return s;
}

}  // namespace

geometry::Rigid3 part_frame(const ProductPart& part, double along, double turn) {
  const PartStation s = station_at(part, along);
  const Vec3 out = std::cos(turn) * s.zero + std::sin(turn) * s.axis.cross(s.zero);
  Eigen::Matrix3d axes;
  axes.col(0) = s.axis;
  axes.col(1) = out.cross(s.axis);
  axes.col(2) = out;
  return {Quat(axes).normalized(), s.centre};
}

Vec3 point_at(const ProductPart& part, const PartPlace& place) {
  return part_frame(part, place.along, place.turn) * Vec3(0.0, 0.0, place.height);
}

PartPlace place_of(const ProductPart& part, const Vec3& point) {
  require_line(part);
  // Where the plane across the axis at a station holds the point: s - centre is across the axis.
  // Axes are interpolated along a piece, so that is a root on the piece; by bisection, where the
  // sign changes.
  const auto beyond = [&](double along) {
    const PartStation s = station_at(part, along);
    return s.axis.dot(point - s.centre);
  };
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double along) {
    const double d = (point - station_at(part, along).centre).norm();
    if (d < least) {
      least = d;
      best = along;
    }
  };
  const std::vector<PartStation>& line = part.line;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    double low = line[k].along, high = line[k + 1].along;
    const double reach = part.is_ring ? 1e-9 : 0.0;  // along 1 of a ring is along 0
    if (!(beyond(low) >= 0.0 && beyond(high - reach) <= 0.0)) continue;
    for (int round = 0; round < 50; ++round) {
      const double middle = 0.5 * (low + high);
      (beyond(middle) >= 0.0 ? low : high) = middle;
    }
    consider(low);
  }
  if (!part.is_ring) {  // on the lengthened ends, where the axis stays
    const PartStation &first = line.front(), &last = line.back();
    const double before = first.axis.dot(point - first.centre);
    const double after = last.axis.dot(point - last.centre);
    const auto rate = [&](std::size_t a, std::size_t b, const Vec3& axis) {
      return axis.dot(line[b].centre - line[a].centre) / (line[b].along - line[a].along);
    };
    if (before < 0.0) consider(before / rate(0, 1, first.axis));
    if (after > 0.0) consider(1.0 + after / rate(line.size() - 2, line.size() - 1, last.axis));
  }
  if (least == std::numeric_limits<double>::infinity()) {
    for (const PartStation& s : line) consider(s.along);
  }
  const PartStation s = station_at(part, best);
  const Vec3 out = point - s.centre;
  PartPlace place;
  place.along = best;
  place.height = (out - s.axis * s.axis.dot(out)).norm();
  place.turn = std::atan2(s.axis.cross(s.zero).dot(out), s.zero.dot(out));
  return place;
}

}  // namespace palmar::product
