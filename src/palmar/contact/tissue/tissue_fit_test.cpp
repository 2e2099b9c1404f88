// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/tissue_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

using ::testing::HasSubstr;

constexpr double kIndenterRadius = 10.0;  // mm, of the sphere in every test

/// Hertz: force at a modulus of 1 MPa, and area (VALIDATION.md, closed form 1).
double hertz_force(double depth) {
  return 16.0 / 3.0 * std::sqrt(kIndenterRadius) * std::pow(depth, 1.5);
}
double hertz_area(double depth) { return std::numbers::pi * kIndenterRadius * depth; }

SpecimenResponse hertz_response(const std::vector<double>& depths) {
  SpecimenResponse response;
  response.depth = depths;
  const auto n = static_cast<Eigen::Index>(depths.size());
  response.force.resize(n, 1);
  response.area.resize(n, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    response.force(i, 0) = hertz_force(depths[i]);
    response.area(i, 0) = hertz_area(depths[i]);
  }
  return response;
}

double law(const hand::StiffeningLaw& l, double depth) {
  return l.g0 + (l.g_limit - l.g0) * std::min(1.0, depth / l.limit_depth);
}

std::vector<double> row(double first, double step, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first + step * i);
  return values;
}

/// Standard normal numbers, the same on every machine (Box and Muller 1958).
class Noise {
 public:
  explicit Noise(unsigned seed) : bits_(seed) {}
  double next() {
    const double u = (static_cast<double>(bits_()) + 1.0) / 4294967297.0;
    const double v = static_cast<double>(bits_()) / 4294967296.0;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::mt19937 bits_;
};

/// Readings of a sphere on a half-space whose modulus is G(depth); noise relative to the force.
std::vector<MeasuredPoint> readings(const std::vector<double>& depths,
                                    const std::function<double(double)>& modulus,
                                    double noise = 0.0, unsigned seed = 1,
                                    const std::string& subject = "S1") {
  Noise random(seed);
  std::vector<MeasuredPoint> points;
  for (const double depth : depths) {
    MeasuredPoint point;
    point.subject = subject;
    point.depth = depth;
    point.force = modulus(depth) * hertz_force(depth) * (1.0 + noise * random.next());
    point.line = static_cast<int>(points.size()) + 2;
    points.push_back(point);
  }
  return points;
}

const FittedParameter& parameter(const TissueFit& fit, const std::string& name) {
  for (const FittedParameter& one : fit.parameters) {
    if (one.name == name) return one;
  }
  throw std::runtime_error("no parameter " + name);
}

bool covers(const FittedParameter& p, double truth) {
  return p.lower && *p.lower <= truth && truth <= *p.upper;
}

std::string remarks(const TissueFit& fit) {
  std::string all;
  for (const std::string& one : fit.remarks) all += one + "\n";
  return all;
}

constexpr hand::StiffeningLaw kTruth = {0.008, 0.060, 3.0};  // MPa, MPa, mm
const std::vector<double> kDepths = row(0.3, 0.3, 18);

TEST(TissueFit, FindsTheLawBehindHertzForcesExactly) {
  const TissueFit fit = fit_tissue(readings(kDepths, [](double d) { return law(kTruth, d); }),
                                   hertz_response(kDepths));
  EXPECT_NEAR(fit.stiffness.nominal.g0, kTruth.g0, 1e-6 * kTruth.g0);
  EXPECT_NEAR(fit.stiffness.nominal.g_limit, kTruth.g_limit, 1e-6 * kTruth.g_limit);
  EXPECT_NEAR(fit.stiffness.nominal.limit_depth, kTruth.limit_depth, 1e-6);
  EXPECT_NEAR(fit.r_squared, 1.0, 1e-12);
  EXPECT_EQ(fit.degrees_of_freedom, 15);
  EXPECT_TRUE(fit.remarks.empty()) << remarks(fit);
  EXPECT_EQ(fit.points.size(), 18U);
}

TEST(TissueFit, ItsConfidenceIntervalsHoldTheTruthAsOftenAsTheySay) {
  // 95 % intervals, 200 sets of noise: 190 expected, standard deviation 3.
  constexpr int kSets = 200;
  const SpecimenResponse response = hertz_response(kDepths);
  TissueFitOptions options;
  options.is_relative = true;
  std::array<int, 3> held{};
  for (int seed = 0; seed < kSets; ++seed) {
    const TissueFit fit =
        fit_tissue(readings(
                       kDepths, [](double d) { return law(kTruth, d); }, 0.03, 100U + seed),
                   response, options);
    held[0] += covers(parameter(fit, "G0"), 1000.0 * kTruth.g0) ? 1 : 0;
    held[1] += covers(parameter(fit, "G_lim"), 1000.0 * kTruth.g_limit) ? 1 : 0;
    held[2] += covers(parameter(fit, "d_lim"), kTruth.limit_depth) ? 1 : 0;
  }
  for (const int count : held) {
    EXPECT_GE(count, 178);
    EXPECT_LE(count, 200);
  }
}

TEST(TissueFit, RecoversHertzTruthThroughTheNumericalTest) {
  // The truth is a closed form, the model presses a lattice.
  const std::vector<double> depths = row(0.5, 0.5, 10);
  PressOptions test;
  test.indenter = {PressIndenter::Kind::kSphere, kIndenterRadius};
  test.spacing = 2.5;  // mm
  const SpecimenResponse response = specimen_response(test, depths);
  TissueFitOptions options;
  options.is_relative = true;
  const TissueFit fit = fit_tissue(readings(
                                       depths, [](double d) { return law(kTruth, d); }, 0.02, 7),
                                   response, options);
  EXPECT_TRUE(covers(parameter(fit, "G0"), 8.0)) << parameter(fit, "G0").value;
  EXPECT_TRUE(covers(parameter(fit, "G_lim"), 60.0)) << parameter(fit, "G_lim").value;
  EXPECT_TRUE(covers(parameter(fit, "d_lim"), 3.0)) << parameter(fit, "d_lim").value;
  EXPECT_LT(fit.force_rms_relative, 0.03);  // the noise is 2 %
}

TEST(TissueFit, ReachesTheSameLawFromBadStarts) {
  const std::vector<MeasuredPoint> points = readings(
      kDepths, [](double d) { return law(kTruth, d); }, 0.02, 3);
  const SpecimenResponse response = hertz_response(kDepths);
  const TissueFit best = fit_tissue(points, response);
  for (const hand::StiffeningLaw start :
       {hand::StiffeningLaw{1e-4, 2e-4, 0.7}, hand::StiffeningLaw{0.5, 5.0, 2.0},
        hand::StiffeningLaw{5.0, 9.0, 5.0}, hand::StiffeningLaw{1e-5, 9e-3, 4.0},
        hand::StiffeningLaw{0.03, 0.031, 1.0}}) {
    TissueFitOptions options;
    options.start = start;
    const TissueFit fit = fit_tissue(points, response, options);
    EXPECT_NE(fit.status, geometry::LeastSquaresStatus::kIterationLimit);
    EXPECT_NEAR(fit.stiffness.nominal.g0, best.stiffness.nominal.g0, 1e-4 * 0.008) << start.g0;
    EXPECT_NEAR(fit.stiffness.nominal.limit_depth, best.stiffness.nominal.limit_depth, 1e-3);
  }
}

TEST(TissueFit, TwiceTheForceIsTwiceTheModulus) {
  const SpecimenResponse response = hertz_response(kDepths);
  const auto single = readings(
      kDepths, [](double d) { return law(kTruth, d); }, 0.05, 5);
  auto twice = single;
  for (MeasuredPoint& point : twice) point.force *= 2.0;
  const TissueFit a = fit_tissue(single, response);
  const TissueFit b = fit_tissue(twice, response);
  EXPECT_NEAR(b.stiffness.nominal.g0, 2.0 * a.stiffness.nominal.g0, 1e-7);
  EXPECT_NEAR(b.stiffness.nominal.g_limit, 2.0 * a.stiffness.nominal.g_limit, 1e-7);
  EXPECT_NEAR(b.stiffness.nominal.limit_depth, a.stiffness.nominal.limit_depth, 1e-5);
  EXPECT_NEAR(b.force_rms, 2.0 * a.force_rms, 1e-7);
}

TEST(TissueFit, ExponentialStiffeningShowsNoLimitDepth) {
  // Pawluk and Howe 1999: stiffness grows exponentially; no limit depth within the readings.
  const auto exponential = [](double d) { return 0.006 * std::exp(0.6 * d); };
  const std::vector<double> depths = row(0.25, 0.25, 12);  // to 3 mm
  const TissueFit fit = fit_tissue(readings(depths, exponential, 0.01, 2), hertz_response(depths));
  EXPECT_EQ(parameter(fit, "d_lim").status, ParameterStatus::kNotIdentifiable);
  EXPECT_NEAR(fit.stiffness.nominal.limit_depth, 3.0, 1e-12);
  EXPECT_THAT(remarks(fit), HasSubstr("d_lim is not identifiable: the readings still stiffen at "
                                      "their deepest point, 3 mm"));
  EXPECT_GT(fit.r_squared, 0.99);
  // At the deepest reading the line can't be far from the curve.
  EXPECT_NEAR(fit.stiffness.nominal.g_limit, exponential(3.0), 0.1 * exponential(3.0));
}

TEST(TissueFit, AConstantModulusIsReportedAsOne) {
  const TissueFit fit =
      fit_tissue(readings(kDepths, [](double) { return 0.02; }), hertz_response(kDepths));
  EXPECT_NEAR(fit.stiffness.nominal.g0, 0.02, 1e-8);
  EXPECT_EQ(fit.stiffness.nominal.g_limit, fit.stiffness.nominal.g0);
  EXPECT_EQ(parameter(fit, "d_lim").status, ParameterStatus::kNotIdentifiable);
  EXPECT_THAT(remarks(fit),
              HasSubstr("G_lim is not identifiable: the readings show no stiffening"));
}

TEST(TissueFit, WhatIsHeldStaysAndIsSaid) {
  TissueFitOptions options;
  options.limit_depth = 4.0;
  const auto points = readings(kDepths, [](double d) { return law(kTruth, d); });
  const TissueFit fit = fit_tissue(points, hertz_response(kDepths), options);
  EXPECT_EQ(fit.stiffness.nominal.limit_depth, 4.0);
  EXPECT_EQ(parameter(fit, "d_lim").status, ParameterStatus::kHeld);
  options = {};
  options.is_constant = true;
  const TissueFit constant = fit_tissue(points, hertz_response(kDepths), options);
  EXPECT_EQ(constant.fitted, std::vector<std::string>{"G0"});
  EXPECT_EQ(constant.stiffness.nominal.g_limit, constant.stiffness.nominal.g0);
  EXPECT_EQ(parameter(constant, "G_lim").status, ParameterStatus::kHeld);
}

TEST(TissueFit, SubjectsGiveTheRange) {
  auto points = readings(
      kDepths,
      [](double d) {
        return law({0.006, 0.045, 3.0}, d);
      },
      0, 1, "A");
  for (const auto& [subject, more] : {std::pair("B", hand::StiffeningLaw{0.008, 0.060, 3.0}),
                                      std::pair("C", hand::StiffeningLaw{0.012, 0.072, 3.0})}) {
    const auto theirs = readings(
        kDepths, [l = more](double d) { return law(l, d); }, 0, 1, subject);
    points.insert(points.end(), theirs.begin(), theirs.end());
  }
  const TissueFit fit = fit_tissue(points, hertz_response(kDepths));
  ASSERT_EQ(fit.subjects.size(), 3U);
  EXPECT_EQ(fit.subjects[1].subject, "B");
  EXPECT_NEAR(fit.stiffness.nominal.limit_depth, 3.0, 1e-3);
  EXPECT_NEAR(fit.stiffness.low.g0, 0.006, 1e-5);
  EXPECT_NEAR(fit.stiffness.high.g0, 0.012, 1e-5);
  EXPECT_NEAR(fit.stiffness.low.g_limit, 0.045, 1e-4);
  EXPECT_NEAR(fit.stiffness.high.g_limit, 0.072, 1e-4);
  EXPECT_GT(fit.stiffness.nominal.g_limit, 0.045);
  EXPECT_LT(fit.stiffness.nominal.g_limit, 0.072);
}

/// Sphere on an incompressible layer of 6 mm bonded to bone: F / F_Hertz and a / sqrt(R d) at
/// sqrt(R d) / h (numerical solution; VALIDATION.md, closed form 5).
struct LayerRow {
  double chi, force, radius;
};
constexpr std::array<LayerRow, 8> kLayer = {{{0.2, 1.2979, 1.088},
                                             {0.3, 1.5182, 1.138},
                                             {0.4, 1.8014, 1.190},
                                             {0.5, 2.1562, 1.239},
                                             {0.6, 2.5878, 1.283},
                                             {0.8, 3.6884, 1.355},
                                             {1.0, 5.1154, 1.411},
                                             {1.25, 7.3972, 1.465}}};

std::vector<MeasuredPoint> layer_readings(double thickness, double modulus, double noise) {
  Noise random(11);
  std::vector<MeasuredPoint> points;
  for (const LayerRow& one : kLayer) {
    MeasuredPoint point;
    point.depth = std::pow(one.chi * thickness, 2) / kIndenterRadius;
    point.force = modulus * hertz_force(point.depth) * one.force * (1.0 + noise * random.next());
    point.area = hertz_area(point.depth) * one.radius * one.radius * (1.0 + noise * random.next());
    points.push_back(point);
  }
  return points;
}

TEST(TissueFit, FindsModulusAndThicknessOfALayerFromForceAndArea) {
  const std::vector<MeasuredPoint> points = layer_readings(6.0, 0.012, 0.01);
  std::vector<double> depths;
  for (const MeasuredPoint& point : points) depths.push_back(point.depth);
  PressOptions test;
  test.indenter = {PressIndenter::Kind::kSphere, kIndenterRadius};
  test.spacing = 2.5;  // mm
  const SpecimenResponse response = specimen_response(test, depths, {4.5, 5.2, 6.1, 7.0, 9.0});
  TissueFitOptions options;
  options.is_constant = true;
  options.is_relative = true;
  const TissueFit fit = fit_tissue(points, response, options);
  ASSERT_TRUE(fit.layer_thickness);
  EXPECT_NEAR(*fit.layer_thickness, 6.0, 0.03 * 6.0);
  EXPECT_NEAR(fit.stiffness.nominal.g0, 0.012, 0.05 * 0.012);
  EXPECT_LT(fit.force_rms_relative, 0.03);
  EXPECT_NEAR(*fit.area_ratio, 1.0, 0.02);
}

TEST(TissueFit, ALayerThatIsNotThereIsNotIdentifiable) {
  // Forces and areas of a half-space; a layer's response made of the table's factors.
  const std::vector<double> depths = row(0.3, 0.3, 8);
  auto points = readings(
      depths, [](double) { return 0.02; }, 0.01, 4);
  for (MeasuredPoint& point : points) point.area = hertz_area(point.depth);
  SpecimenResponse response;
  response.depth = depths;
  response.thickness = {5.0, 10.0, 20.0, 50.0, 100.0};
  response.force.resize(8, 5);
  response.area.resize(8, 5);
  for (Eigen::Index i = 0; i < 8; ++i) {
    for (Eigen::Index j = 0; j < 5; ++j) {
      const double depth = depths[i];
      const double chi = std::sqrt(kIndenterRadius * depth) / response.thickness[j];
      // First terms of the table: 1.129 and 1.041 at chi = 0.1.
      response.force(i, j) = hertz_force(depth) * (1.0 + 1.29 * chi);
      response.area(i, j) = hertz_area(depth) * std::pow(1.0 + 0.41 * chi, 2);
    }
  }
  TissueFitOptions options;
  options.is_constant = true;
  const TissueFit fit = fit_tissue(points, response, options);
  EXPECT_EQ(parameter(fit, "h").status, ParameterStatus::kNotIdentifiable);
  EXPECT_THAT(remarks(fit), HasSubstr("the readings see no bone"));
}

TEST(TissueFit, AreasThatDoNotFitTheTestAreReportedEvenIfForcesDo) {
  auto points = readings(kDepths, [](double d) { return law(kTruth, d); });
  for (MeasuredPoint& point : points) point.area = 1.5 * hertz_area(point.depth);
  const TissueFit fit = fit_tissue(points, hertz_response(kDepths));
  EXPECT_NEAR(*fit.area_ratio, 1.5, 1e-9);
  EXPECT_THAT(remarks(fit), HasSubstr("Measured areas are 1.5 times those of the model"));
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(TissueFit, RefusesWhatItCannotFit) {
  const SpecimenResponse response = hertz_response(kDepths);
  const auto modulus = [](double d) { return law(kTruth, d); };
  EXPECT_THROW(fit_tissue({}, response), InputError);
  EXPECT_THAT(message_of([&] {
                fit_tissue(readings({0.3, 0.6, 0.9}, modulus), response);
              }),
              HasSubstr("3 readings; at least 4 are required for 3 unknowns"));
  EXPECT_THAT(message_of([&] {
                fit_tissue(readings({0.3, 0.3, 0.6, 0.6, 0.6}, modulus), response);
              }),
              HasSubstr("2 different depths; at least 3"));
  EXPECT_THAT(message_of([&] { fit_tissue(readings(row(1.0, 1.0, 9), modulus), response); }),
              HasSubstr("readings from 1 to 9 mm; the specimen's response is known from 0.3 to"));
  EXPECT_THAT(
      message_of([&] { fit_tissue(readings(kDepths, [](double) { return 0.0; }), response); }),
      HasSubstr("every force is 0 N"));
  TissueFitOptions options;
  options.limit_depth = -1.0;
  EXPECT_THROW(fit_tissue(readings(kDepths, modulus), response, options), UsageError);
  options = {};
  options.confidence = 1.0;
  EXPECT_THROW(options.check(), UsageError);
  SpecimenResponse broken = response;
  broken.force(3, 0) = 0.0;
  EXPECT_THAT(message_of([&] { broken.check(); }),
              HasSubstr("at a depth of 1.2 mm the force is 0"));
}

TEST(PowerCurve, IsExactForPowersAndGivesItsOwnSlope) {
  const std::vector<double> x = {0.5, 1.0, 3.0, 10.0};
  Eigen::VectorXd power(4), other(4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double at = x[i];
    power[i] = 3.0 * std::pow(at, 1.5);
    other[i] = std::exp(0.1 * at) + at;
  }
  const PowerCurve exact(x, power);
  const PowerCurve curve(x, other);
  for (const double at : {0.5, 0.7, 1.0, 2.2, 9.9, 10.0}) {
    EXPECT_NEAR(exact.at(at).y, 3.0 * std::pow(at, 1.5), 1e-12 * std::pow(at, 1.5));
    EXPECT_NEAR(exact.at(at).slope, 1.5, 1e-12);
  }
  for (const double at : {0.7, 2.2, 9.0}) {
    constexpr double kStep = 1e-5;
    const double slope =
        std::log(curve.at(at * (1 + kStep)).y / curve.at(at * (1 - kStep)).y) / (2 * kStep);
    EXPECT_NEAR(curve.at(at).slope, slope, 1e-6);
  }
}

}  // namespace
}  // namespace palmar::contact
