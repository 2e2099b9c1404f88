// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Case G1 and the bonded layer: the press against closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>

#include "palmar/contact/press/press.h"
#include "palmar/validation/validation_cases.h"

namespace palmar::validation {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kShear = 0.05;   // MPa
constexpr double kRadius = 20.0;  // mm

contact::PressOptions sphere_press(double spacing, std::vector<double> depths) {
  contact::PressOptions options;
  options.indenter.kind = contact::PressIndenter::Kind::kSphere;
  options.indenter.radius = kRadius;
  options.shear_modulus = kShear;
  options.poisson = 0.5;
  options.spacing = spacing;
  options.depths = std::move(depths);
  return options;
}

/// Keeps the value that is farthest from 1.
void keep_worst(double ratio, double& worst) {
  if (std::isnan(ratio) || std::abs(ratio - 1.0) > std::abs(worst - 1.0)) worst = ratio;
}

/// F = (16/3) G sqrt(R) depth^1.5 (Hertz, Poisson's ratio 0.5).
double hertz_force(double radius, double depth) {
  return 16.0 / 3.0 * kShear * std::sqrt(radius) * std::pow(depth, 1.5);
}

/// Mean of p0 sqrt(1 - r^2 / a^2) over a disc in the middle, over p0.
double mean_over_cell(double cell_area, double contact_area) {
  const double x = std::min(1.0, cell_area / contact_area);
  return 2.0 / 3.0 * (1.0 - std::pow(1.0 - x, 1.5)) / x;
}

void add_sphere(ValidationRows& rows) {
  constexpr std::array<double, 3> depths = {0.5, 1.0, 2.0};  // mm
  std::array<double, 3> force = {1, 1, 1}, area = {1, 1, 1}, peak = {1, 1, 1};
  double cells = 1.0, residual = 0.0;
  for (const double spacing : {0.4, 0.5, 0.8, 1.25, 2.5, 5.0}) {
    const auto steps = contact::press(sphere_press(spacing, {depths.begin(), depths.end()}));
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const double f = hertz_force(kRadius, depths[i]), a = kPi * kRadius * depths[i];
      keep_worst(steps[i].force / f, force[i]);
      keep_worst(steps[i].area / a, area[i]);
      keep_worst(steps[i].peak_pressure / (1.5 * f / a), peak[i]);
      residual = std::max(residual, steps[i].relative_residual);
      if (i == 2) {
        keep_worst(steps[i].peak_pressure_cells / (1.5 * f / a * mean_over_cell(24.0, a)), cells);
      }
    }
  }
  const std::string where = " mm, worst of spacings 0.4 to 5 mm";
  const std::array<std::string, 3> at = {"0.5", "1", "2"};
  const std::string hertz = "Hertz; R = 20 mm, G = 50 kPa";
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double f = hertz_force(kRadius, depths[i]), a = kPi * kRadius * depths[i];
    rows.push_back(
        judge("sphere, force at " + at[i] + where, "N", force[i] * f, near_value(f, 0.02, hertz)));
    rows.push_back(
        judge("sphere, area at " + at[i] + where, "mm2", area[i] * a, near_value(a, 0.10, hertz)));
    rows.push_back(judge("sphere, peak pressure at " + at[i] + where, "kPa",
                         peak[i] * 1.5e3 * f / a, near_value(1.5e3 * f / a, 0.05, hertz)));
  }
  const double a = kPi * kRadius * 2.0;
  const double mean = 1.5e3 * hertz_force(kRadius, 2.0) / a * mean_over_cell(24.0, a);
  rows.push_back(judge("sphere, peak on cells of 24 mm2 at 2" + where, "kPa", cells * mean,
                       near_value(mean, 0.05, hertz)));
  rows.push_back(judge("sphere, largest min(s, p) / scale, all of these", "", residual,
                       at_most(1e-9, "definition of the problem")));
}

void add_thesis_kernel(ValidationRows& rows) {
  // reference/validation/halfspace_kernel_study.csv, hexagonal lattice, depth 2 mm.
  for (const auto& [spacing, ratio] : {std::pair{2.5, 0.954}, {1.25, 1.048}, {0.8, 1.046}}) {
    contact::PressOptions options = sphere_press(spacing, {2.0});
    options.kernel = contact::Kernel::kPoint;
    rows.push_back(judge("sphere, point kernel of the thesis, force / Hertz at spacing " +
                             std::to_string(spacing).substr(0, 4) + " mm",
                         "", contact::press(options).front().force / hertz_force(kRadius, 2.0),
                         information(ratio, "kernel study, own lattice")));
  }
}

void add_punch(ValidationRows& rows) {
  contact::PressOptions options = sphere_press(0.5, {1.0});
  options.indenter.kind = contact::PressIndenter::Kind::kPunch;
  options.indenter.radius = 5.0;
  rows.push_back(judge("flat punch of 5 mm, force per mm, spacing 0.5 mm", "N",
                       contact::press(options).front().force,
                       near_value(8.0 * kShear * 5.0, 0.005, "F = 8 G a depth")));
  options.indenter.kind = contact::PressIndenter::Kind::kTwoPunches;
  for (const double radii : {3.0, 6.0}) {
    options.indenter.distance = radii * options.indenter.radius;
    // Each punch rests in the other's field, (2/pi) asin(a / r) of its depth.
    const double alone = 2.0 * 8.0 * kShear * options.indenter.radius;
    const double expected = 1.0 / (1.0 + 2.0 / kPi * std::asin(1.0 / radii));
    rows.push_back(judge(
        "two punches, " + std::string(radii == 3.0 ? "3" : "6") + " radii apart, force / two alone",
        "", contact::press(options).front().force / alone,
        near_value(expected, 0.02, "field of one punch at the other's centre")));
  }
}

void add_ellipse(ValidationRows& rows) {
  // Johnson 1985, section 4.2, from a chosen ellipse a = 4, b = 2 mm, p0 = 30 kPa.
  constexpr double a = 4.0, b = 2.0, p0 = 0.03, ratio = p0 / (4.0 * kShear);
  const double e2 = 1.0 - b * b / (a * a);
  const double K = std::comp_ellint_1(std::sqrt(e2)), E = std::comp_ellint_2(std::sqrt(e2));
  contact::PressOptions options = sphere_press(0.8, {ratio * b * K});
  options.specimen.kind = contact::PressSpecimen::Kind::kEllipsoid;
  options.specimen.radius_x = e2 * a * a / (2.0 * ratio * b * (K - E));
  options.specimen.radius_y = e2 * a * a / (2.0 * ratio * b * (a * a / (b * b) * E - K));
  options.indenter.kind = contact::PressIndenter::Kind::kPlane;
  const contact::PressStep step = contact::press(options).front();
  const std::string source = "Hertz; semi-axes 4 and 2 mm, spacing 0.8 mm";
  const double force = 2.0 / 3.0 * kPi * a * b * p0;
  rows.push_back(judge("ellipse, force", "N", step.force, near_value(force, 0.02, source)));
  rows.push_back(judge("ellipse, area", "mm2", step.area, near_value(kPi * a * b, 0.10, source)));
  rows.push_back(judge("ellipse, peak pressure", "kPa", 1e3 * step.peak_pressure,
                       near_value(1e3 * p0, 0.05, source)));
}

void add_scaling(ValidationRows& rows) {
  contact::PressOptions options = sphere_press(1.25, {2.0});
  const contact::PressStep one = contact::press(options).front();
  options.indenter.radius = 2.0 * kRadius;
  options.spacing = 2.5;
  options.depths = {4.0};
  const contact::PressStep two = contact::press(options).front();
  const std::string law = "forces grow with the square of all lengths, pressures stay";
  rows.push_back(judge("all lengths doubled, force ratio", "", two.force / one.force,
                       near_value(4.0, 1e-6, law)));
  rows.push_back(judge("all lengths doubled, peak ratio", "", two.peak_pressure / one.peak_pressure,
                       near_value(1.0, 1e-6, law)));
}

struct LayerSphere {
  double chi, force, radius, peak_over_mean;
};
// reference/validation/layer_sphere_incompressible.csv: chi = sqrt(R depth) / h; F / F_Hertz;
// a / sqrt(R depth); p0 / mean. Numerical solution of the bonded incompressible layer.
constexpr LayerSphere kLayerSphere[] = {
    {0.05, 1.0602, 1.02, 1.502},  {0.1, 1.1291, 1.041, 1.499},  {0.15, 1.2078, 1.063, 1.499},
    {0.2, 1.2979, 1.088, 1.501},  {0.3, 1.5182, 1.138, 1.5},    {0.4, 1.8014, 1.19, 1.507},
    {0.5, 2.1562, 1.239, 1.521},  {0.6, 2.5878, 1.283, 1.544},  {0.8, 3.6884, 1.355, 1.613},
    {1.0, 5.1154, 1.411, 1.7},    {1.25, 7.3972, 1.465, 1.796}, {1.5, 10.3045, 1.508, 1.873},
    {2.0, 18.3687, 1.577, 1.995}, {2.5, 30.1054, 1.629, 2.087}, {3.0, 46.3531, 1.671, 2.167}};

struct LayerPunch {
  double ratio, force;
};
// reference/validation/layer_punch_incompressible.csv: a / h; F / (2 a E* depth).
constexpr LayerPunch kLayerPunch[] = {
    {0.1, 1.126},  {0.2, 1.2806},   {0.3, 1.4662},   {0.4, 1.6837},  {0.5, 1.9329},
    {0.6, 2.2129}, {0.8, 2.8602},   {1.0, 3.6187},   {1.25, 4.7216}, {1.5, 6.003},
    {2.0, 9.1494}, {2.5, 13.1639},  {3.0, 18.1573},  {4.0, 31.5249}, {5.0, 50.1395},
    {6.0, 74.887}, {8.0, 146.3197}, {10.0, 252.8968}};

}  // namespace

ValidationRows validate_half_space(ValidationBench& bench) {
  ValidationRows rows;
  add_sphere(rows);
  bench.update(0.6, "case G1, other shapes");
  add_thesis_kernel(rows);
  add_punch(rows);
  add_ellipse(rows);
  add_scaling(rows);
  set_history(rows, "dc20bd8");
  return rows;
}

ValidationRows validate_layer(ValidationBench& bench) {
  ValidationRows rows;
  const std::string table = "numerical solution, bonded, Poisson's ratio 0.5";
  double force = 1.0, radius = 1.0, shape = 1.0;
  for (const LayerSphere& t : kLayerSphere) {
    constexpr double depth = 0.2;  // mm; the root of R depth is 2 mm
    contact::PressOptions options = sphere_press(0.5, {depth});
    options.layer_thickness = std::sqrt(kRadius * depth) / t.chi;
    const contact::PressStep step = contact::press(options).front();
    const double ratio = step.force / hertz_force(kRadius, depth);
    const double peak_over_mean = step.peak_pressure / step.mean_pressure;
    keep_worst(ratio / t.force, force);
    keep_worst(std::sqrt(step.area / (kPi * kRadius * depth)) / t.radius, radius);
    keep_worst(peak_over_mean / t.peak_over_mean, shape);
    for (const double shown : {0.1, 0.3, 0.5, 1.0, 2.0}) {
      if (t.chi != shown) continue;
      const std::string at = std::to_string(shown).substr(0, 3);
      rows.push_back(judge("sphere, sqrt(R depth) / h = " + at + ", force / Hertz", "", ratio,
                           near_value(t.force, 0.02, table)));
      rows.push_back(judge("sphere, sqrt(R depth) / h = " + at + ", peak / mean", "",
                           peak_over_mean, near_value(t.peak_over_mean, 0.05, table)));
    }
  }
  rows.push_back(judge("sphere, force / table, worst of 15 from 0.05 to 3", "", force,
                       near_value(1.0, 0.02, table)));
  rows.push_back(judge("sphere, radius of contact / table, worst of 15", "", radius,
                       near_value(1.0, 0.02, table)));
  rows.push_back(judge("sphere, peak / mean over table, worst of 15", "", shape,
                       near_value(1.0, 0.05, table)));
  set_history(rows, "dc20bd8");
  bench.update(0.5, "case layer, punch");
  force = 1.0;
  for (const LayerPunch& t : kLayerPunch) {
    contact::PressOptions options = sphere_press(0.5, {0.1});
    options.indenter.kind = contact::PressIndenter::Kind::kPunch;
    options.indenter.radius = 5.0;
    options.layer_thickness = 5.0 / t.ratio;
    const double ratio = contact::press(options).front().force / (8.0 * kShear * 5.0 * 0.1);
    if (t.ratio <= 6.0) keep_worst(ratio / t.force, force);
    for (const double shown : {0.2, 1.0, 3.0, 8.0, 10.0}) {
      if (t.ratio != shown) continue;
      const std::string at = shown == 10.0 ? "10" : std::to_string(shown).substr(0, 3);
      rows.push_back(judge("punch, a / h = " + at + ", force / half-space", "", ratio,
                           near_value(t.force, 0.02, table)));
    }
  }
  rows.push_back(judge("punch, force / table, worst of 16 from 0.1 to 6", "", force,
                       near_value(1.0, 0.02, table)));
  // How fine the cells of a punch on a thin layer are was chosen on the punches.
  set_history(rows, "10fca44", "fd93a7d");
  return rows;
}

}  // namespace palmar::validation
