// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/ridge_relief.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/redesign/handle_section.h"

namespace palmar::redesign {
namespace {

constexpr double kShareOfDisc = 0.95;  // of the largest disc inside: flanks must stay to touch
constexpr double kRadiusStep = 0.5;    // mm; as tools are sold
constexpr double kBend = 0.15;         // mm; a ridge that bends more is no straight cut

/// A point in the frame of a relief.
struct Local {
  double s = 0.0, h = 0.0, w = 0.0, length = 0.0;
  Vec3 along, across;
};

Local local(const RidgeRelief& relief, const Vec3& x) {
  Local at;
  const Vec3 way = relief.end - relief.start;
  at.length = way.norm();
  at.along = way / at.length;
  at.across = at.along.cross(relief.outward);
  const Vec3 q = x - relief.start;
  at.s = q.dot(at.along);
  at.h = q.dot(relief.outward);
  at.w = q.dot(at.across);
  return at;
}

/// How far beyond the ends of the full length, 0 between them.
double beyond(const RidgeRelief& relief, const Local& at) {
  if (at.s < 0.0) return relief.is_open_start ? 0.0 : at.s;
  if (at.s > at.length) return relief.is_open_end ? 0.0 : at.s - at.length;
  return 0.0;
}

/// Height above the cylinder's axis as the cutter's path sees it.
double height(const RidgeRelief& relief, const Local& at) {
  const double ds = beyond(relief, at);
  if (ds == 0.0) return at.h;
  const double centre = relief.radius + relief.run_out;
  return at.h < centre ? centre - std::hypot(ds, at.h - centre)
                       : -std::numeric_limits<double>::infinity();
}

void check_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw UsageError(
      fmt::format("relief: {} is {:.6g}; {:.6g} to {:.6g} is allowed", name, value, low, high));
}

/// A place of the map that hands touch, across the handle.
struct Touched {
  Eigen::Vector2d at;
  double s = 0.0;       // along the axis
  double depth = 0.0;   // of the imprint, mm
  double weight = 0.0;  // mm^2; 0 where only the reach has it
};

/// A ridge with a disc in it, in one section.
struct SeatedDisc {
  Eigen::Vector2d centre, outward;
  double half_angle = 0.0;
};

double cut_depth(const SeatedDisc& disc, double radius, const Eigen::Vector2d& x) {
  const Eigen::Vector2d way = x - disc.centre;
  const double off = way.norm();
  if (off <= radius || way.dot(disc.outward) < off * std::cos(disc.half_angle)) return 0.0;
  return off - radius;
}

std::optional<SeatedDisc> seat(const HandleSection& section, const SectionRidge& ridge,
                               double radius) {
  const auto disc = section.disc_under(ridge, radius);
  if (!disc) return {};
  SeatedDisc seated;
  seated.centre = disc->centre;
  seated.outward = (disc->touch_first + disc->touch_second).normalized();
  seated.half_angle = std::acos(std::clamp(disc->touch_first.dot(seated.outward), -1.0, 1.0));
  return seated;
}

/// The radius that is nearest to the imprint, or nothing if none is allowed.
std::optional<double> best_radius(const HandleSection& section, const SectionRidge& ridge,
                                  double largest, const std::vector<Touched>& touched,
                                  const ReliefOptions& options) {
  std::optional<double> best;
  double least = std::numeric_limits<double>::infinity();
  const int steps = static_cast<int>(std::floor(largest / kRadiusStep));
  for (int k = static_cast<int>(std::ceil(options.smallest_radius / kRadiusStep)); k <= steps;
       ++k) {
    const double radius = k * kRadiusStep;
    const auto disc = seat(section, ridge, radius);
    if (!disc) continue;
    const double depth = cut_depth(*disc, radius, ridge.apex);
    if (depth < 0.02) continue;  // the ridge is as round already
    if (depth > options.largest_depth) break;
    double sum = 0.0;
    for (const Touched& one : touched) {
      const double missing = options.share * one.depth - cut_depth(*disc, radius, one.at);
      sum += one.weight * missing * missing;
    }
    if (sum < least) {
      least = sum;
      best = radius;
    }
  }
  return best;
}

}  // namespace

void ReliefOptions::check() const {
  check_range("share of the imprint", share, 0.0, 2.0);
  check_range("largest depth in mm", largest_depth, 0.05, 50.0);
  check_range("smallest radius in mm", smallest_radius, 0.5, 200.0);
  check_range("radius of the run-out in mm", run_out, 5.0, 2000.0);
  check_range("margin in mm", margin, 0.0, 100.0);
  if (axis && std::abs(axis->norm() - 1.0) > 1e-6) {
    throw UsageError("relief: the axis is not of unit length");
  }
}

bool is_cut(const RidgeRelief& relief, const Vec3& x) {
  const Local at = local(relief, x);
  const double h = height(relief, at);
  const double off = std::hypot(at.w, h);
  return h > 0.0 && off > relief.radius && h >= off * std::cos(relief.half_angle);
}

Vec3 onto_relief(const RidgeRelief& relief, const Vec3& x) {
  const Local at = local(relief, x);
  const double h = height(relief, at);
  const double ratio = relief.radius / std::hypot(at.w, h);
  Vec3 result = relief.start + ratio * at.w * at.across;
  const double ds = beyond(relief, at);
  if (ds == 0.0) return result + at.s * at.along + ratio * h * relief.outward;
  const double centre = relief.radius + relief.run_out;
  const double stretch = (centre - ratio * h) / (centre - h);
  return result + (at.s - ds + stretch * ds) * at.along +
         (centre + stretch * (at.h - centre)) * relief.outward;
}

ReliefPlan plan_reliefs(const geometry::TriangleMesh& map, const ContactRegion& region,
                        const ContactRegion& reach, const std::vector<double>& imprint,
                        const ReliefOptions& options) {
  options.check();
  if (region.field.size() != map.vertices.size() || reach.field.size() != map.vertices.size() ||
      imprint.size() != map.vertices.size()) {
    throw UsageError("relief: region, imprint and map don't belong together");
  }
  if (region.patches.empty()) {
    throw UsageError("relief: the region \"" + region.title +
                     "\" is empty; a smaller share of the "
                     "hands has one");
  }
  ReliefPlan plan;
  plan.axis = options.axis ? *options.axis : Vec3(grasp::principal_frame(map).axes.col(0));
  // The same sign always: the largest component is positive.
  Eigen::Index largest_component = 0;
  plan.axis.cwiseAbs().maxCoeff(&largest_component);
  if (plan.axis[largest_component] < 0.0) plan.axis = -plan.axis;
  const Vec3 e1 = plan.axis.unitOrthogonal(), e2 = plan.axis.cross(e1);
  const auto flat = [&](const Vec3& x) { return Eigen::Vector2d(x.dot(e1), x.dot(e2)); };
  const auto solid = [&](const Eigen::Vector2d& p, double s) -> Vec3 {
    return p.x() * e1 + p.y() * e2 + s * plan.axis;
  };
  const std::vector<double> areas = geometry::vertex_areas(map);
  std::vector<Touched> touched;
  double low = std::numeric_limits<double>::infinity(), high = -low, bottom = low, top = -low;
  for (std::size_t v = 0; v < map.vertices.size(); ++v) {
    const double s = map.vertices[v].dot(plan.axis);
    bottom = std::min(bottom, s);
    top = std::max(top, s);
    const bool is_inside = region.field[v] >= 0.0;
    if (!is_inside && reach.field[v] < 0.0) continue;
    touched.push_back({flat(map.vertices[v]), s, imprint[v], is_inside ? areas[v] : 0.0});
    if (!is_inside) continue;
    low = std::min(low, s);
    high = std::max(high, s);
  }
  const auto section_at = [&](double s) {
    return HandleSection(map, solid(Eigen::Vector2d::Zero(), s), plan.axis, e1, e2);
  };
  const HandleSection middle = section_at(0.5 * (low + high));
  const double largest = kShareOfDisc * middle.largest_disc();
  const std::vector<SectionRidge> ridges = middle.ridges(largest);
  if (ridges.empty()) {
    throw UsageError(fmt::format(
        "relief: the section in the middle of the region has no ridge that is narrower than a disc "
        "of {:.3g} mm radius; there is nothing to round (`palmar redesign press` presses any "
        "shape)",
        largest));
  }
  for (const SectionRidge& ridge : ridges) {
    const std::string name = fmt::format(
        "ridge at ({:.1f}, {:.1f}, {:.1f}) mm", solid(ridge.apex, 0.5 * (low + high)).x(),
        solid(ridge.apex, 0.5 * (low + high)).y(), solid(ridge.apex, 0.5 * (low + high)).z());
    const auto widest = seat(middle, ridge, largest);
    if (!widest) {
      plan.notes.push_back(name + ": no disc touches both of its flanks; left as it is");
      continue;
    }
    std::vector<Touched> here;
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const Touched& one : touched) {
      if (cut_depth(*widest, largest, one.at) <= 0.0) continue;
      here.push_back(one);
      first = std::min(first, one.s);
      last = std::max(last, one.s);
    }
    const bool is_touched =
        std::any_of(here.begin(), here.end(), [](const Touched& one) { return one.weight > 0.0; });
    if (!is_touched) {
      plan.notes.push_back(name + ": not in the region; left as it is");
      continue;
    }
    const auto radius = best_radius(middle, ridge, largest, here, options);
    if (!radius) {
      plan.notes.push_back(fmt::format(
          "{}: no radius from {:.3g} to {:.3g} mm rounds it by at most {:.3g} mm; left as it is",
          name, options.smallest_radius, largest, options.largest_depth));
      continue;
    }
    RidgeRelief relief;
    relief.radius = *radius;
    relief.run_out = options.run_out;
    first = std::max(bottom, first - options.margin);
    last = std::min(top, last + options.margin);
    const auto centre = seat(middle, ridge, *radius);
    relief.depth = cut_depth(*centre, *radius, ridge.apex);
    // The cutter needs that much length to leave; where the product ends before, it goes through.
    const double leaving =
        std::sqrt(relief.depth * (2.0 * options.run_out - relief.depth)) + options.margin;
    relief.is_open_start = first - leaving < bottom;
    relief.is_open_end = last + leaving > top;
    // Sections a little inside of the ends of the product: in an end face there is none.
    const double inset = 1e-3 * (top - bottom) + 0.2;
    const double at_first = std::max(first, bottom + inset), at_last = std::min(last, top - inset);
    const HandleSection start = section_at(at_first), end = section_at(at_last);
    const auto near = [&](const HandleSection& section) -> std::optional<SeatedDisc> {
      const std::optional<SectionRidge> same = section.ridge_near(ridge.apex, *radius);
      return same ? seat(section, *same, *radius) : std::nullopt;
    };
    const auto at_start = near(start), at_end = near(end);
    if (!at_start || !at_end) {
      plan.notes.push_back(name +
                           ": doesn't extend over the length that hands touch; left as it is");
      continue;
    }
    const double share = (0.5 * (low + high) - at_first) / std::max(1e-9, at_last - at_first);
    const Eigen::Vector2d straight = at_start->centre + share * (at_end->centre - at_start->centre);
    const double bend = (straight - centre->centre).norm();
    if (bend > kBend) {
      plan.notes.push_back(fmt::format(
          "{}: bends by {:.2f} mm over the length that hands touch; a straight cut of a round tool "
          "doesn't follow it, left as it is",
          name, bend));
      continue;
    }
    const Vec3 a = solid(at_start->centre, at_first), b = solid(at_end->centre, at_last);
    const Vec3 along = (b - a) / (at_last - at_first);  // per mm of the axis
    relief.start = a + (first - at_first) * along;
    relief.end = b + (last - at_last) * along;
    const Vec3 direction = along.normalized();
    const Vec3 outward = solid(centre->outward, 0.0);
    relief.outward = (outward - outward.dot(direction) * direction).normalized();
    relief.half_angle = std::min({centre->half_angle, at_start->half_angle, at_end->half_angle});
    relief.radius_before = ridge.radius;
    relief.name = fmt::format("relief {}", plan.reliefs.size() + 1);
    plan.reliefs.push_back(std::move(relief));
  }
  if (plan.reliefs.empty()) {
    constexpr std::size_t kNamed = 4;
    std::string why = fmt::format(
        "{}", fmt::join(plan.notes.begin(),
                        plan.notes.begin() +
                            static_cast<std::ptrdiff_t>(std::min(kNamed, plan.notes.size())),
                        "; "));
    if (plan.notes.size() > kNamed) {
      why += fmt::format("; and {} more", plan.notes.size() - kNamed);
    }
    throw UsageError("relief: none of the handle's ridges can be rounded (" + why + ")");
  }
  return plan;
}

geometry::TriangleMesh relieved_mesh(const geometry::TriangleMesh& mesh,
                                     std::span<const RidgeRelief> reliefs, double edge_length) {
  const auto is_touched = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    // A triangle that straddles a relief may have no corner in it: its middles are asked as well.
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const Vec3 middle = (a + b + c) / 3.0;
    return std::any_of(reliefs.begin(), reliefs.end(), [&](const RidgeRelief& relief) {
      return is_cut(relief, a) || is_cut(relief, b) || is_cut(relief, c) || is_cut(relief, ab) ||
             is_cut(relief, bc) || is_cut(relief, ca) || is_cut(relief, middle);
    });
  };
  geometry::TriangleMesh result = geometry::split_long_edges(mesh, edge_length, is_touched);
  for (Vec3& x : result.vertices) {
    for (const RidgeRelief& relief : reliefs) {
      if (!is_cut(relief, x)) continue;
      // Not quite onto it: points that lie over each other (of an end that is cut through) must not
      // fall together, or the mesh would tear where they are welded.
      const Vec3 on = onto_relief(relief, x);
      x = on + 1e-3 * (x - on);
    }
  }
  return result;
}

}  // namespace palmar::redesign
