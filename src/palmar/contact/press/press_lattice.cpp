// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press/press_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palmar::contact {
namespace {

constexpr double kRow = 0.86602540378443865;  // sqrt(3) / 2: rows of a lattice of spacing 1
constexpr int kCutSamples = 12;               // per side of a cell that the punch's edge cuts

Vec2 in_lattice(double u, double v) { return {u + 0.5 * v, kRow * v}; }

/// Area and centre of the part of a cell that the indenter covers.
void cut(const PressGap& gap, PressCell& cell) {
  cell.centre = cell.middle;
  cell.area = cell.whole_area();
  if (!gap.is_punch() || gap.inside_edge(cell.middle) > 0.9 * cell.size) return;
  Vec2 sum = Vec2::Zero();
  int inside = 0;
  for (int i = 0; i < kCutSamples; ++i) {
    for (int j = 0; j < kCutSamples; ++j) {
      const Vec2 q = cell.middle + cell.size * in_lattice((i + 0.5) / kCutSamples - 0.5,
                                                          (j + 0.5) / kCutSamples - 0.5);
      if (!gap.covers(q)) continue;
      ++inside;
      sum += q;
    }
  }
  cell.area *= static_cast<double>(inside) / (kCutSamples * kCutSamples);
  if (inside > 0) cell.centre = sum / inside;
}

bool may_touch(const PressGap& gap, const PressCell& cell, double limit) {
  return cell.area > 0.0 && gap.at(cell.centre) < limit;
}

}  // namespace

PressGap::PressGap(const PressOptions& options, double depth, double margin) : depth_(depth) {
  const PressSpecimen& specimen = options.specimen;
  const bool is_punch = options.indenter.kind == PressIndenter::Kind::kPunch ||
                        options.indenter.kind == PressIndenter::Kind::kTwoPunches;
  if (specimen.kind == PressSpecimen::Kind::kEllipsoid) {
    const double c = std::sqrt(specimen.radius_x * specimen.radius_y);
    const double a2 = specimen.radius_x * c;
    const double b2 = specimen.radius_y * c;
    // A punch stays centred on the apex.
    const double tilt = is_punch ? 0.0 : options.tilt;
    const double h2 = a2 * std::pow(std::sin(tilt), 2) + c * c * std::pow(std::cos(tilt), 2);
    curvature_x_ = h2 * std::sqrt(h2) / (a2 * c * c);
    curvature_y_ = std::sqrt(h2) / b2;
  }
  switch (options.indenter.kind) {
    case PressIndenter::Kind::kSphere:
      curvature_x_ += 1.0 / options.indenter.radius;
      curvature_y_ += 1.0 / options.indenter.radius;
      break;
    case PressIndenter::Kind::kCylinder:
      curvature_x_ += 1.0 / options.indenter.radius;
      break;
    case PressIndenter::Kind::kTwoPunches:
      punch_offset_ = 0.5 * options.indenter.distance;
      [[fallthrough]];
    case PressIndenter::Kind::kPunch:
      punch_radius_ = options.indenter.radius + margin;
      slope_x_ = std::tan(options.tilt);
      break;
    case PressIndenter::Kind::kPlane:
      break;
  }
  if (slope_x_ == 0.0) return;
  // A tilted punch touches first at its lowest point: on a flat specimen its edge.
  const double outer = punch_offset_ + punch_radius_;
  const double inner = std::max(punch_offset_ - punch_radius_, 0.0);
  const double steepest = curvature_x_ > 0.0 ? std::abs(slope_x_) / curvature_x_ : outer;
  const double x = std::clamp(steepest, inner, outer);
  touch_ = 0.5 * curvature_x_ * x * x - std::abs(slope_x_) * x;
}

double PressGap::at(const Vec2& q) const {
  return 0.5 * (curvature_x_ * q.x() * q.x() + curvature_y_ * q.y() * q.y()) + slope_x_ * q.x() -
         touch_ - depth_;
}

Vec2 PressGap::reach(double limit) const {
  if (is_punch()) return {punch_offset_ + punch_radius_, punch_radius_};
  const double height = 2.0 * (depth_ + limit);
  return {std::sqrt(height / curvature_x_), std::sqrt(height / curvature_y_)};
}

double PressGap::area(double limit) const {
  if (is_punch()) {
    const int count = punch_offset_ > 0.0 ? 2 : 1;
    return count * std::numbers::pi * punch_radius_ * punch_radius_;
  }
  return std::numbers::pi * reach(limit).prod();
}

double PressGap::inside_edge(const Vec2& q) const {
  return punch_radius_ - std::hypot(std::abs(q.x()) - punch_offset_, q.y());
}

bool PressGap::covers(const Vec2& q) const { return !is_punch() || inside_edge(q) > 0.0; }

double PressCell::whole_area() const { return size * size * kRow; }

double PressCell::disc_radius() const { return std::sqrt(area / std::numbers::pi); }

std::vector<PressCell> press_lattice(const PressGap& gap, double spacing, double limit) {
  const Vec2 reach = gap.reach(limit);
  const int rows = static_cast<int>(reach.y() / (spacing * kRow)) + 1;
  std::vector<PressCell> cells;
  for (int v = -rows; v <= rows; ++v) {
    const double shift = 0.5 * v;
    const int first = static_cast<int>(std::floor(-reach.x() / spacing - shift)) - 1;
    const int last = static_cast<int>(std::ceil(reach.x() / spacing - shift)) + 1;
    for (int u = first; u <= last; ++u) {
      PressCell cell;
      cell.size = spacing;
      cell.middle = spacing * in_lattice(u, v);
      cut(gap, cell);
      if (may_touch(gap, cell, limit)) cells.push_back(cell);
    }
  }
  return cells;
}

std::vector<PressCell> split_cells(const PressGap& gap, const std::vector<PressCell>& cells,
                                   const std::vector<char>& which, double limit) {
  std::vector<PressCell> result;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!which[i]) {
      result.push_back(cells[i]);
      continue;
    }
    for (const double u : {-0.25, 0.25}) {
      for (const double v : {-0.25, 0.25}) {
        PressCell child;
        child.size = 0.5 * cells[i].size;
        child.middle = cells[i].middle + cells[i].size * in_lattice(u, v);
        cut(gap, child);
        if (may_touch(gap, child, limit)) result.push_back(child);
      }
    }
  }
  return result;
}

}  // namespace palmar::contact
