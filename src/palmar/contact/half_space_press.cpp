// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/half_space_press.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "palmar/contact/lcp.h"
#include "palmar/contact/lemke.h"
#include "palmar/contact/response.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kRow = 0.86602540378443865;  // sqrt(3) / 2: rows of a lattice of spacing 1
constexpr int kFewestCells = 40;              // penetrating; else the lattice is split
/// Cell size at the contact's edge / contact radius. Pressure ends like sqrt(x) at a smooth contact
/// but is singular under the edge of a punch, which needs smaller cells for the same error.
constexpr double kRimShare = 1.0 / 10.0;
constexpr double kPunchRimShare = 1.0 / 20.0;
constexpr int kMaxRounds = 7;
constexpr int kMostCells = 4000;
constexpr int kCutSamples = 12;  // per side of a cell that the punch's edge cuts

/// Cell of the lattice: a rhombus of side `size` with its sides along the lattice's rows; split, it
/// gives four of half the size whose centres form a lattice again.
struct Cell {
  Vec2 middle = Vec2::Zero();  ///< mm
  double size = 1.0;           ///< mm
  Vec2 centre = Vec2::Zero();  ///< of the part under the indenter, mm
  double area = 0.0;           ///< of that part, mm^2
};

Vec2 in_lattice(double u, double v) { return {u + 0.5 * v, kRow * v}; }

/// The gap before contact, and the part of the plane that the indenter covers.
struct Gap {
  double curvature_x = 0.0, curvature_y = 0.0;  ///< 1/mm
  double slope_x = 0.0;
  double depth = 0.0;         ///< mm
  double punch_radius = 0.0;  ///< mm; 0 = covers all

  double at(const Vec2& q) const {
    return 0.5 * (curvature_x * q.x() * q.x() + curvature_y * q.y() * q.y()) + slope_x * q.x() -
           depth;
  }
  /// Penetrating points are no farther than this from the origin, mm.
  double reach() const {
    if (punch_radius > 0.0) return punch_radius;
    return std::sqrt(2.0 * depth / std::min(curvature_x, curvature_y));
  }
};

Gap gap_of(const PressOptions& options, double depth) {
  Gap gap;
  gap.depth = depth;
  const PressSpecimen& specimen = options.specimen;
  if (specimen.kind == PressSpecimen::Kind::kEllipsoid) {
    const double c = std::sqrt(specimen.radius_x * specimen.radius_y);
    const double a2 = specimen.radius_x * c;
    const double b2 = specimen.radius_y * c;
    // A punch stays centred on the apex.
    const double tilt = options.indenter.kind == PressIndenter::Kind::kPunch ? 0.0 : options.tilt;
    const double h2 = a2 * std::pow(std::sin(tilt), 2) + c * c * std::pow(std::cos(tilt), 2);
    gap.curvature_x = h2 * std::sqrt(h2) / (a2 * c * c);
    gap.curvature_y = std::sqrt(h2) / b2;
  }
  switch (options.indenter.kind) {
    case PressIndenter::Kind::kSphere:
      gap.curvature_x += 1.0 / options.indenter.radius;
      gap.curvature_y += 1.0 / options.indenter.radius;
      break;
    case PressIndenter::Kind::kCylinder:
      gap.curvature_x += 1.0 / options.indenter.radius;
      break;
    case PressIndenter::Kind::kPunch:
      gap.punch_radius = options.indenter.radius;
      gap.slope_x = std::tan(options.tilt);
      break;
    case PressIndenter::Kind::kPlane:
      break;
  }
  return gap;
}

/// Area and centre of the part of a cell that the indenter covers.
void cut(const Gap& gap, Cell& cell) {
  const double whole = cell.size * cell.size * kRow;
  cell.centre = cell.middle;
  cell.area = whole;
  if (gap.punch_radius <= 0.0) return;
  const double from_axis = cell.middle.norm();
  if (from_axis + 0.9 * cell.size < gap.punch_radius) return;
  Vec2 sum = Vec2::Zero();
  int inside = 0;
  for (int i = 0; i < kCutSamples; ++i) {
    for (int j = 0; j < kCutSamples; ++j) {
      const Vec2 q = cell.middle + cell.size * in_lattice((i + 0.5) / kCutSamples - 0.5,
                                                          (j + 0.5) / kCutSamples - 0.5);
      if (q.norm() >= gap.punch_radius) continue;
      ++inside;
      sum += q;
    }
  }
  cell.area = whole * inside / (kCutSamples * kCutSamples);
  if (inside > 0) cell.centre = sum / inside;
}

std::vector<Cell> split(const Gap& gap, const std::vector<Cell>& cells,
                        const std::vector<char>& which) {
  std::vector<Cell> result;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!which[i]) {
      result.push_back(cells[i]);
      continue;
    }
    for (const double u : {-0.25, 0.25}) {
      for (const double v : {-0.25, 0.25}) {
        Cell child;
        child.size = 0.5 * cells[i].size;
        child.middle = cells[i].middle + cells[i].size * in_lattice(u, v);
        cut(gap, child);
        result.push_back(child);
      }
    }
  }
  return result;
}

/// Cells that can carry force: only penetrating ones, as no response is negative.
void keep_penetrating(const Gap& gap, std::vector<Cell>& cells) {
  std::erase_if(cells, [&](const Cell& c) { return c.area <= 0.0 || gap.at(c.centre) >= 0.0; });
}

std::vector<Cell> first_cells(const Gap& gap, double spacing) {
  const double reach = gap.reach() + spacing;
  const int rows = static_cast<int>(reach / (spacing * kRow)) + 1;
  std::vector<Cell> cells;
  for (int v = -rows; v <= rows; ++v) {
    const int columns = static_cast<int>(reach / spacing + 0.5 * rows) + 1;
    for (int u = -columns; u <= columns; ++u) {
      Cell cell;
      cell.size = spacing;
      cell.middle = spacing * in_lattice(u, v);
      cut(gap, cell);
      cells.push_back(cell);
    }
  }
  keep_penetrating(gap, cells);
  return cells;
}

double disc_radius(const Cell& cell) { return std::sqrt(cell.area / std::numbers::pi); }

ContactSolution solve_cells(const Gap& gap, const std::vector<Cell>& cells, Kernel kernel,
                            double shear_modulus) {
  const auto m = static_cast<Eigen::Index>(cells.size());
  if (m > kMostCells) {
    throw UsageError("press: the contact needs " + std::to_string(m) + " vertices, more than " +
                     std::to_string(kMostCells) + "; a larger spacing is required");
  }
  ContactProblem problem;
  problem.response.resize(m, m);
  problem.distance.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Cell& a = cells[i];
    problem.distance[i] = gap.at(a.centre);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Cell& b = cells[j];
      const double r = (a.centre - b.centre).norm();
      const double response =
          boussinesq_response(kernel, r, disc_radius(a), disc_radius(b)) / shear_modulus;
      problem.response(i, j) = response;
      problem.response(j, i) = response;
    }
  }
  LcpOptions options;
  options.max_pivots = 200;
  ContactSolution solution = solve_contact(problem, options);
  if (solution.status != LcpStatus::kSolved) solution = solve_contact_lemke(problem);
  if (solution.status != LcpStatus::kSolved) {
    throw NumericalError("press: the contact of " + std::to_string(m) +
                         " vertices has no solution; the response matrix is not positive definite "
                         "(kernel \"point\" needs a spacing above 0.8 mm)");
  }
  return solution;
}

/// Cells at the edge of the contact that are larger than `size`.
std::vector<char> coarse_rim(const Gap& gap, const std::vector<Cell>& cells,
                             const Eigen::VectorXd& force, double size) {
  std::vector<char> is_rim(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& a = cells[i];
    if (a.size <= size) continue;
    const bool is_loaded = force[static_cast<Eigen::Index>(i)] > 0.0;
    if (gap.punch_radius > 0.0 && a.middle.norm() + 1.5 * a.size > gap.punch_radius) is_rim[i] = 1;
    for (std::size_t j = 0; j < cells.size() && !is_rim[i]; ++j) {
      if ((force[static_cast<Eigen::Index>(j)] > 0.0) == is_loaded) continue;
      const double near = 0.75 * (a.size + cells[j].size);
      is_rim[i] = (a.middle - cells[j].middle).squaredNorm() < near * near;
    }
  }
  return is_rim;
}

/// Largest mean pressure over a disc of the sensor cell's area; see peak_over_cells().
double peak_mean(const std::vector<Cell>& cells, const Eigen::VectorXd& force, double cell_area) {
  const double cell_radius = std::sqrt(cell_area / std::numbers::pi);
  double peak = 0.0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (force[static_cast<Eigen::Index>(c)] <= 0.0) continue;
    double sum = 0.0;
    double area = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double r = (cells[i].centre - cells[c].centre).norm();
      const double shared = disc_overlap(r, cell_radius, disc_radius(cells[i]));
      area += shared;
      sum += force[static_cast<Eigen::Index>(i)] * shared / cells[i].area;
    }
    peak = std::max(peak, sum / std::max(area, cell_area));
  }
  return peak;
}

}  // namespace

PressStep press_half_space(const PressOptions& options, double depth) {
  const Gap gap = gap_of(options, depth);
  const double shear_modulus =
      options.shear_modulus.value_or(shear_modulus_at(options.tissue.half_space.nominal, depth));
  std::vector<Cell> cells = first_cells(gap, options.spacing);
  const bool may_split = options.kernel == Kernel::kPatch;
  if (cells.empty() && !may_split) return {.depth = depth, .shear_modulus = shear_modulus};
  if (may_split && cells.size() < kFewestCells) {
    double spacing = options.spacing;
    while (cells.size() < kFewestCells) {
      spacing *= 0.5;
      cells = first_cells(gap, spacing);
    }
  }
  ContactSolution solution = solve_cells(gap, cells, options.kernel, shear_modulus);
  for (int round = 0; may_split && round < kMaxRounds; ++round) {
    double area = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (solution.force[static_cast<Eigen::Index>(i)] > 0.0) area += cells[i].area;
    }
    const double radius = std::sqrt(area / std::numbers::pi);
    const double share = gap.punch_radius > 0.0 ? kPunchRimShare : kRimShare;
    const std::vector<char> rim = coarse_rim(gap, cells, solution.force, share * radius);
    if (std::find(rim.begin(), rim.end(), 1) == rim.end()) break;
    cells = split(gap, cells, rim);
    keep_penetrating(gap, cells);
    solution = solve_cells(gap, cells, options.kernel, shear_modulus);
  }

  PressStep step{.depth = depth, .shear_modulus = shear_modulus};
  step.force = solution.force.sum();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double p = solution.force[static_cast<Eigen::Index>(i)];
    if (p <= 0.0) continue;
    step.area += cells[i].area;
    // The sliver that a punch's edge leaves of a cell says little: pressure is singular there.
    if (cells[i].area < 0.5 * kRow * cells[i].size * cells[i].size) continue;
    step.peak_pressure = std::max(step.peak_pressure, p / cells[i].area);
  }
  step.peak_pressure_cells = peak_mean(cells, solution.force, options.cell_area);
  step.mean_pressure = step.area > 0.0 ? step.force / step.area : 0.0;
  step.complementarity_error = solution.complementarity_error;
  step.relative_residual = solution.relative_residual;
  return step;
}

}  // namespace palmar
