// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press/half_space_press.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "palmar/contact/press/press_compliance.h"
#include "palmar/contact/press/press_lattice.h"
#include "palmar/contact/response/response.h"
#include "palmar/contact/solve/lcp.h"
#include "palmar/contact/solve/lemke.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

constexpr int kFewestCells = 40;     // penetrating; else the lattice is split
constexpr int kUsualCells = 1200;    // penetrating; beyond, a coarser lattice is as good
constexpr int kRefinedCells = 2400;  // with the split rim and all candidates
constexpr int kMostCells = 4000;
/// Cell size at the contact's edge / its smaller half-width. Pressure ends like sqrt(x) at a smooth
/// contact but is singular under the edge of a punch, which needs smaller cells for the same error.
constexpr double kRimShare = 1.0 / 10.0;
constexpr double kPunchRimShare = 1.0 / 20.0;
constexpr int kMaxRounds = 7;
constexpr double kLayerShare = 0.5;  // largest cell / thickness of a layer, if so many serve
constexpr double kCoarsestLayerShare = 1.0;  // with coarser cells the force is several per cent off
/// A rim of cells of uniform pressure carries the force of a punch smaller by this share of such a
/// cell, as splitting it further shows; so the lattice is placed over a punch that much wider.
constexpr double kLostRim = 0.125;
/// A layer lifts skin outside the indenter, which then may touch. Candidates are cells with a gap
/// below these shares of the depth, tried one after the other until no other skin would enter. A
/// sphere on a thin incompressible layer, where contact spreads farthest, needs 1.
constexpr double kCandidates[] = {0.0, 0.5, 1.1, 3.0, 10.0};
constexpr double kTouching = 1e-6;  // of the depth; a cell nearer than that doesn't enter

struct Solved {
  std::vector<PressCell> cells;
  ContactSolution solution;

  double force(std::size_t i) const { return solution.force[static_cast<Eigen::Index>(i)]; }
};

ContactSolution solve_cells(const PressGap& gap, const std::vector<PressCell>& cells,
                            const PressCompliance& compliance) {
  const auto m = static_cast<Eigen::Index>(cells.size());
  if (m > kMostCells) {
    throw UsageError("press: the contact needs " + std::to_string(m) + " vertices, more than " +
                     std::to_string(kMostCells) + "; a larger spacing is required");
  }
  ContactProblem problem;
  problem.response = compliance.matrix(cells);
  problem.distance.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) problem.distance[i] = gap.at(cells[i].centre);
  LcpOptions options;
  options.max_pivots = 200;
  ContactSolution solution = solve_contact(problem, options);
  if (solution.status != LcpStatus::kSolved) solution = solve_contact_lemke(problem);
  if (solution.status != LcpStatus::kSolved) {
    throw NumericalError("press: the contact of " + std::to_string(m) +
                         " vertices has no solution; the response matrix is not positive definite");
  }
  return solution;
}

/// True if skin that was no candidate would enter the indenter.
bool skin_enters_elsewhere(const PressGap& gap, const PressCompliance& compliance,
                           const Solved& solved, double spacing, double limit, double next_limit) {
  std::vector<Vec2> outside;
  for (const PressCell& cell : press_lattice(gap, spacing, next_limit)) {
    if (gap.at(cell.centre) >= limit) outside.push_back(cell.centre);
  }
  const std::vector<double> u =
      compliance.displacement(outside, solved.cells, solved.solution.force);
  for (std::size_t i = 0; i < outside.size(); ++i) {
    if (gap.at(outside[i]) + u[i] < -kTouching * gap.depth()) return true;
  }
  return false;
}

/// True if a loaded cell lacks a neighbour that could touch.
bool reaches_last_candidates(const PressGap& gap, const Solved& solved, double limit) {
  for (std::size_t i = 0; i < solved.cells.size(); ++i) {
    if (!(solved.force(i) > 0.0)) continue;
    const PressCell& cell = solved.cells[i];
    const Vec2 outwards(std::copysign(cell.size, cell.centre.x()),
                        std::copysign(cell.size, cell.centre.y()));
    if (gap.at(cell.centre + outwards) >= limit) return true;
  }
  return false;
}

/// Half the width of the loaded cells across their longest axis, as of an ellipse.
double half_width(const Solved& solved) {
  double area = 0.0;
  Vec2 middle = Vec2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < solved.cells.size(); ++i) {
    if (!(solved.force(i) > 0.0)) continue;
    const PressCell& cell = solved.cells[i];
    area += cell.area;
    middle += cell.area * cell.centre;
    second += cell.area * (cell.centre * cell.centre.transpose() +
                           cell.size * cell.size / 12.0 * Eigen::Matrix2d::Identity());
  }
  middle /= area;
  const Eigen::Matrix2d variance = second / area - middle * middle.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(variance, Eigen::EigenvaluesOnly);
  return 2.0 * std::sqrt(axes.eigenvalues()[0]);
}

/// Cells at the edge of the contact that are larger than `size`.
std::vector<char> coarse_rim(const PressGap& gap, const Solved& solved, double size) {
  const std::vector<PressCell>& cells = solved.cells;
  std::vector<char> is_rim(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PressCell& a = cells[i];
    if (a.size <= size) continue;
    const bool is_loaded = solved.force(i) > 0.0;
    if (gap.is_punch() && gap.inside_edge(a.middle) < 1.5 * a.size) is_rim[i] = 1;
    for (std::size_t j = 0; j < cells.size() && !is_rim[i]; ++j) {
      if ((solved.force(j) > 0.0) == is_loaded) continue;
      const double near = 0.75 * (a.size + cells[j].size);
      is_rim[i] = (a.middle - cells[j].middle).squaredNorm() < near * near;
    }
  }
  return is_rim;
}

/// Largest mean pressure over a disc of the sensor cell's area; see peak_over_cells().
double peak_mean(const Solved& solved, double cell_area) {
  const double cell_radius = std::sqrt(cell_area / std::numbers::pi);
  double peak = 0.0;
  for (std::size_t c = 0; c < solved.cells.size(); ++c) {
    if (solved.force(c) <= 0.0) continue;
    double sum = 0.0;
    double area = 0.0;
    for (std::size_t i = 0; i < solved.cells.size(); ++i) {
      const PressCell& cell = solved.cells[i];
      const double r = (cell.centre - solved.cells[c].centre).norm();
      const double shared = disc_overlap(r, cell_radius, cell.disc_radius());
      area += shared;
      sum += solved.force(i) * shared / cell.area;
    }
    peak = std::max(peak, sum / std::max(area, cell_area));
  }
  return peak;
}

/// Doubles the spacing while it gives more cells than serve the result.
double at_most(int cells, const PressGap& gap, double limit, double spacing) {
  const double cell = std::sqrt(0.75);
  while (gap.area(limit) > cells * cell * spacing * spacing) spacing *= 2.0;
  return spacing;
}

/// The spacing that runs: fine enough for a small contact and a thin layer, coarse enough for a
/// large one.
double lattice_spacing(const PressGap& gap, const PressCompliance& compliance, double spacing) {
  spacing = at_most(kUsualCells, gap, 0.0, spacing);
  while (spacing > kLayerShare * compliance.thinnest() &&
         at_most(kRefinedCells, gap, 0.0, 0.5 * spacing) < spacing) {
    spacing *= 0.5;
  }
  while (press_lattice(gap, spacing, 0.0).size() < kFewestCells) spacing *= 0.5;
  return spacing;
}

/// The gap, with a punch as wide as the lattice needs it.
PressGap lattice_gap(const PressOptions& options, double depth, double spacing) {
  const PressGap gap(options, depth);
  if (!gap.is_punch()) return gap;
  double rim = spacing;
  while (rim > kPunchRimShare * gap.punch_radius()) rim *= 0.5;
  return {options, depth, kLostRim * rim};
}

/// Share of the way from a loaded to a lifted cell, l apart, at which the contact ends: there the
/// pressure p = K sqrt(x) and the gap g = (4 K / 3 E*) (l - x)^1.5 meet (see contact_area()).
double contact_end(double p, double g, double l, double contact_modulus) {
  const double c = std::pow(0.75 * contact_modulus * g, 2.0 / 3.0);
  // l = p^2 y^3 + c y with y = K^(-2/3) grows with y.
  double y = std::min(l / c, std::cbrt(l / (p * p)));
  for (int i = 0; i < 30; ++i) {
    const double step = (p * p * y * y * y + c * y - l) / (3.0 * p * p * y * y + c);
    y -= step;
    if (std::abs(step) <= 1e-12 * y) break;
  }
  return std::clamp(p * p * y * y * y / l, 0.0, 1.0);
}

/// Area of a contact without holes: the polygon through the points where it ends between
/// neighbouring cells, in the order of their direction from its middle. 0 if there are too few.
double area_inside_edge(const Solved& solved, double contact_modulus) {
  const std::vector<PressCell>& cells = solved.cells;
  Vec2 middle = Vec2::Zero();
  double force = 0.0;
  std::vector<Vec2> edge;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!(solved.force(i) > 0.0)) continue;
    middle += solved.force(i) * cells[i].centre;
    force += solved.force(i);
    for (std::size_t j = 0; j < cells.size(); ++j) {
      if (solved.force(j) > 0.0) continue;
      const Vec2 way = cells[j].middle - cells[i].middle;
      const double length = way.norm();
      if (length > 0.75 * (cells[i].size + cells[j].size)) continue;
      const double share =
          contact_end(solved.force(i) / cells[i].area,
                      std::max(solved.solution.gap[static_cast<Eigen::Index>(j)], 0.0), length,
                      contact_modulus);
      edge.push_back(cells[i].middle + share * way);
    }
  }
  if (edge.size() < 6) return 0.0;
  middle /= force;
  const auto angle = [&](const Vec2& q) {
    return std::atan2(q.y() - middle.y(), q.x() - middle.x());
  };
  std::sort(edge.begin(), edge.end(),
            [&](const Vec2& a, const Vec2& b) { return angle(a) < angle(b); });
  double area = 0.0;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const Vec2 a = edge[i] - middle;
    const Vec2 b = edge[(i + 1) % edge.size()] - middle;
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Solves on the lattice, with as many candidates as it takes that no other skin enters; `spacing`
/// and `limit` become those that ran. Empty cells: nothing touches.
Solved solve_lattice(const PressGap& gap, const PressCompliance& compliance, double& spacing,
                     double& limit) {
  Solved solved;
  for (std::size_t i = 0; i < std::size(kCandidates); ++i) {
    limit = kCandidates[i] * gap.depth();
    // Under a punch all skin is a candidate, beside it none.
    if (gap.is_punch() && compliance.may_lift()) limit = std::numeric_limits<double>::infinity();
    if (compliance.may_lift()) spacing = at_most(kRefinedCells, gap, limit, spacing);
    solved.cells = press_lattice(gap, spacing, limit);
    if (solved.cells.empty()) return solved;
    solved.solution = solve_cells(gap, solved.cells, compliance);
    if (!compliance.may_lift() || gap.is_punch() || i + 1 == std::size(kCandidates)) break;
    if (reaches_last_candidates(gap, solved, limit)) continue;
    const double next_limit = std::max(1.0, 2.0 * kCandidates[i + 1]) * gap.depth();
    if (!skin_enters_elsewhere(gap, compliance, solved, spacing, limit, next_limit)) break;
  }
  return solved;
}

/// Splits the rim of the contact until it is fine enough.
void refine_rim(const PressGap& gap, const PressCompliance& compliance, double limit,
                Solved& solved) {
  for (int round = 0; round < kMaxRounds; ++round) {
    const double size =
        gap.is_punch() ? kPunchRimShare * gap.punch_radius() : kRimShare * half_width(solved);
    const std::vector<char> rim = coarse_rim(gap, solved, size);
    const auto split = std::count(rim.begin(), rim.end(), 1);
    if (split == 0 || solved.cells.size() + 3 * static_cast<std::size_t>(split) > kRefinedCells) {
      return;
    }
    solved.cells = split_cells(gap, solved.cells, rim, limit);
    solved.solution = solve_cells(gap, solved.cells, compliance);
  }
}

}  // namespace

PressStep press_half_space(const PressOptions& options, double depth) {
  const hand::TissueStiffness& stiffness =
      options.layer_thickness ? options.tissue.layered : options.tissue.half_space;
  const double shear_modulus = options.shear_modulus.value_or(
      shear_modulus_at(hand::law_at(stiffness, options.tissue_level), depth));
  const PressCompliance compliance(options, shear_modulus);
  const bool may_split = options.kernel == Kernel::kPatch;
  PressStep step{.depth = depth, .shear_modulus = shear_modulus};
  step.spacing = options.spacing;
  PressGap gap(options, depth);
  if (may_split) {
    step.spacing = lattice_spacing(gap, compliance, step.spacing);
    gap = lattice_gap(options, depth, step.spacing);
  }

  double limit = 0.0;
  Solved solved = solve_lattice(gap, compliance, step.spacing, limit);
  if (solved.cells.empty()) return step;
  double coarsest = 0.0;
  for (const PressCell& cell : solved.cells) coarsest = std::max(coarsest, cell.size);
  if (coarsest > kCoarsestLayerShare * compliance.thinnest()) {
    std::ostringstream message;
    message << "press: a layer of " << compliance.thinnest()
            << " mm needs vertices no farther apart "
            << "than that; the contact at a depth of " << depth
            << " mm is so wide that they would be " << coarsest << " mm apart (at most "
            << kRefinedCells << " of them); a smaller contact or a thicker layer is required";
    throw NumericalError(message.str());
  }
  if (may_split) refine_rim(gap, compliance, limit, solved);

  step.vertices = static_cast<int>(solved.cells.size());
  step.force = solved.solution.force.sum();
  for (std::size_t i = 0; i < solved.cells.size(); ++i) {
    const double p = solved.force(i);
    const PressCell& cell = solved.cells[i];
    if (p <= 0.0) continue;
    step.area += cell.area;
    // The sliver that a punch's edge leaves of a cell says little: pressure is singular there.
    if (cell.area < 0.5 * cell.whole_area()) continue;
    step.peak_pressure = std::max(step.peak_pressure, p / cell.area);
  }
  if (gap.is_punch()) {
    step.area *= std::pow(options.indenter.radius / gap.punch_radius(), 2);
  } else if (may_split) {
    const double area = area_inside_edge(solved, compliance.contact_modulus());
    if (area > 0.0) step.area = area;
  }
  // Vertices farther apart than a sensor cell is wide say nothing finer than themselves.
  step.peak_pressure_cells =
      std::min(peak_mean(solved, options.cell_area), std::max(step.peak_pressure, 0.0));
  step.mean_pressure = step.area > 0.0 ? step.force / step.area : 0.0;
  step.complementarity_error = solved.solution.complementarity_error;
  step.relative_residual = solved.solution.relative_residual;
  return step;
}

}  // namespace palmar::contact
