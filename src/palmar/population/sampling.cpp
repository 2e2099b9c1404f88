// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/core/text.h"
#include "palmar/population/hand_sample.h"

namespace palmar::population {
namespace {

constexpr int kMostHands = 1000000;
// Streams of a seed: hand k has stream k; what concerns a whole stratum lies far beyond.
constexpr std::uint64_t kStratumStreams = std::uint64_t{1} << 62U;

Eigen::MatrixXd factor(const Stratum& stratum) {
  return Eigen::LLT<Eigen::MatrixXd>(stratum.correlation).matrixL();
}

// Predictors of a regression as places in the list of values: driving dimensions, then regressed
// ones.
struct Predictors {
  struct Term {
    std::size_t at;
    double slope;
  };
  std::vector<std::vector<Term>> of;  // per regression
};

Predictors find_predictors(const Stratum& stratum) {
  std::vector<hand::HandDimension> known;
  for (const DrivingDimension& one : stratum.driving) known.push_back(one.dimension);
  Predictors predictors;
  for (const DimensionRegression& regression : stratum.regressions) {
    std::vector<Predictors::Term> terms;
    for (const DimensionRegression::Term& term : regression.terms) {
      const auto at = std::find(known.begin(), known.end(), term.predictor) - known.begin();
      terms.push_back({static_cast<std::size_t>(at), term.slope});
    }
    predictors.of.push_back(std::move(terms));
    known.push_back(regression.dimension);
  }
  return predictors;
}

// Standard normal without what lies beyond three deviations, spread so that its deviation is 1: no
// segment is drawn that no hand has.
double residual(RandomStream& random) {
  constexpr double kBeyond = 0.0013498980316301;  // P(Z < -3)
  constexpr double kDeviation = 0.9865784;        // of what lies between: 1 - 6 phi(3) / P, root
  const double p = kBeyond + (1.0 - 2.0 * kBeyond) * random.uniform();
  return standard_normal_quantile(p) / kDeviation;
}

/// A stratum made ready for drawing people.
class Drawer {
 public:
  explicit Drawer(const Stratum& stratum)
      : stratum_(stratum), factor_(factor(stratum)), predictors_(find_predictors(stratum)) {}

  const Stratum& stratum() const { return stratum_; }
  Eigen::Index drivers() const { return factor_.rows(); }

  /// Independent standard normal numbers with the stratum's correlation given to them; the first
  /// one stays.
  Eigen::VectorXd with_correlation(const Eigen::VectorXd& factors) const {
    return factor_ * factors;
  }
  Eigen::VectorXd correlated(RandomStream& random) const {
    Eigen::VectorXd z(drivers());
    for (double& one : z) one = random.normal();
    return with_correlation(z);
  }

  /// The person whose driving dimensions stand at these scores (deviations from the mean). Without
  /// a stream: residuals of 0, mean grip strength.
  HandSample person(const Eigen::VectorXd& score, RandomStream* random) const {
    HandSample sample;
    sample.stratum = stratum_.name;
    sample.sex = stratum_.sex;
    sample.age = stratum_.age;
    sample.dimensions.reserve(stratum_.driving.size() + stratum_.regressions.size());
    for (Eigen::Index i = 0; i < drivers(); ++i) {
      const DrivingDimension& one = stratum_.driving[i];
      sample.dimensions.push_back({one.dimension, one.mean + one.sd * score[i]});
    }
    sample.grip_strength = grip(random);
    for (std::size_t k = 0; k < stratum_.regressions.size(); ++k) {
      const DimensionRegression& regression = stratum_.regressions[k];
      double value = regression.intercept;
      for (const auto& [at, slope] : predictors_.of[k])
        value += slope * sample.dimensions[at].value;
      if (random != nullptr && regression.residual_sd > 0.0) {
        value += regression.residual_sd * residual(*random);
      }
      sample.dimensions.push_back({regression.dimension, value});
    }
    return sample;
  }

 private:
  double grip(RandomStream* random) const {
    if (!stratum_.sex || !stratum_.age) return 0.0;
    const double mean = grasp::grip_strength(*stratum_.sex, *stratum_.age).value_or(0.0);
    if (random == nullptr) return mean;
    const double sd = grasp::grip_strength_sd(*stratum_.sex, *stratum_.age).value_or(0.0);
    // A tenth of the mean is left to the weakest; four in a million are cut.
    return std::max(0.1 * mean, mean + sd * random->normal());
  }

  const Stratum& stratum_;
  Eigen::MatrixXd factor_;
  Predictors predictors_;
};

std::vector<Drawer> drawers_of(const Population& population) {
  return {population.strata.begin(), population.strata.end()};
}

// The stratum in whose share u lies.
const Drawer& drawer_at(const std::vector<Drawer>& drawers, double u) {
  double sum = 0.0;
  for (const Drawer& drawer : drawers) {
    sum += drawer.stratum().share;
    if (u < sum) return drawer;
  }
  return drawers.back();
}

// Hands per stratum: shares of the whole, remainders to the largest; the first one wins a tie.
std::vector<int> allotment(const Population& population, int hands) {
  std::vector<int> count;
  std::vector<double> rest;
  for (const Stratum& stratum : population.strata) {
    const double exact = stratum.share * hands;
    count.push_back(static_cast<int>(exact));
    rest.push_back(exact - count.back());
  }
  while (std::accumulate(count.begin(), count.end(), 0) < hands) {
    const auto largest =
        static_cast<std::size_t>(std::max_element(rest.begin(), rest.end()) - rest.begin());
    ++count[largest];
    rest[largest] = -1.0;
  }
  return count;
}

std::vector<HandSample> random_hands(const Population& population, const SamplingOptions& options) {
  const std::vector<Drawer> drawers = drawers_of(population);
  std::vector<HandSample> hands;
  hands.reserve(options.hands);
  for (int k = 0; k < options.hands; ++k) {
    RandomStream random(options.seed, static_cast<std::uint64_t>(k));
    const Drawer& drawer = drawer_at(drawers, random.uniform());
    const Eigen::VectorXd score = drawer.correlated(random);
    hands.push_back(drawer.person(score, options.residuals ? &random : nullptr));
  }
  return hands;
}

// Puts the values of every column in an order that leaves the columns hardly correlated; each keeps
// its values, so its layers (Iman & Conover 1982, Commun Stat B 11:311-334). Chance alone leaves
// correlations of 1 / sqrt(n) between columns: 30 hands of a population with 0.36 could have none.
void uncorrelate(Eigen::MatrixXd& factors) {
  const Eigen::Index n = factors.rows(), d = factors.cols();
  if (n < d + 2) return;
  std::vector<Eigen::Index> order(n);
  for (int round = 0; round < 3; ++round) {
    Eigen::MatrixXd centred = factors.rowwise() - factors.colwise().mean();
    centred.array().rowwise() /= centred.colwise().norm().array().eval();
    const Eigen::LLT<Eigen::MatrixXd> found(centred.transpose() * centred);
    if (found.info() != Eigen::Success) return;
    const Eigen::MatrixXd wanted = found.matrixL().solve(centred.transpose()).transpose();
    for (Eigen::Index i = 0; i < d; ++i) {
      std::iota(order.begin(), order.end(), Eigen::Index{0});
      std::stable_sort(order.begin(), order.end(),
                       [&](Eigen::Index a, Eigen::Index b) { return wanted(a, i) < wanted(b, i); });
      Eigen::VectorXd sorted = factors.col(i);
      std::sort(sorted.begin(), sorted.end());
      for (Eigen::Index k = 0; k < n; ++k) factors(order[k], i) = sorted[k];
    }
  }
}

// Scores of n people: independent factors, each with one person in each of n layers of equal
// probability (McKay, Beckman, Conover 1979), then given their correlation. Layers of the
// correlated dimensions themselves would loosen how they hang together in one person: hands too
// broad for their girth.
std::vector<Eigen::VectorXd> layered_scores(const Drawer& drawer, int n, RandomStream& random) {
  Eigen::MatrixXd factors(n, drawer.drivers());
  std::vector<std::size_t> layer(n);
  for (Eigen::Index i = 0; i < drawer.drivers(); ++i) {
    std::iota(layer.begin(), layer.end(), std::size_t{0});
    for (std::size_t left = layer.size(); left > 1; --left) {
      std::swap(layer[left - 1], layer[random.below(left)]);
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto in = static_cast<double>(layer[k]);
      factors(k, i) = standard_normal_quantile((in + random.uniform()) / n);
    }
  }
  uncorrelate(factors);
  std::vector<Eigen::VectorXd> scores;
  for (Eigen::Index k = 0; k < n; ++k) {
    scores.push_back(drawer.with_correlation(factors.row(k).transpose()));
  }
  return scores;
}

std::vector<HandSample> layered_hands(const Population& population,
                                      const SamplingOptions& options) {
  const std::vector<Drawer> drawers = drawers_of(population);
  const std::vector<int> count = allotment(population, options.hands);
  std::vector<HandSample> hands;
  for (std::size_t s = 0; s < drawers.size(); ++s) {
    RandomStream layers(options.seed, kStratumStreams + s);
    for (const Eigen::VectorXd& score : layered_scores(drawers[s], count[s], layers)) {
      RandomStream random(options.seed, hands.size());
      hands.push_back(drawers[s].person(score, options.residuals ? &random : nullptr));
    }
  }
  return hands;
}

std::vector<HandSample> boundary_hands(const Population& population,
                                       const SamplingOptions& options) {
  constexpr double kFullTurn = 360.0;  // deg
  // Quantile of chi-square with 2 degrees of freedom.
  const double radius = std::sqrt(-2.0 * std::log1p(-options.boundary));
  std::vector<HandSample> hands;
  for (const Drawer& drawer : drawers_of(population)) {
    const Stratum& stratum = drawer.stratum();
    if (drawer.drivers() < 2) {
      throw UsageError("boundary hands of stratum \"" + stratum.name +
                       "\": it has one driving dimension; two are required");
    }
    const std::string of = population.strata.size() > 1 ? " of " + stratum.name : "";
    const Eigen::MatrixXd& r = stratum.correlation;
    const double along = std::sqrt(1.0 + r(0, 1)), across = std::sqrt(1.0 - r(0, 1));
    for (int k = 0; k <= options.boundary_points; ++k) {
      const double angle = kFullTurn * (k - 1) / options.boundary_points;
      const double t = angle * std::numbers::pi / 180.0;
      const double a = k == 0 ? 0.0 : radius * along * std::cos(t) / std::numbers::sqrt2;
      const double b = k == 0 ? 0.0 : radius * across * std::sin(t) / std::numbers::sqrt2;
      Eigen::VectorXd score(drawer.drivers());
      const Eigen::Vector2d both(a - b, a + b);
      score.head<2>() = both;
      // What else drives stands at its mean given the two.
      const Eigen::Vector2d weight = r.topLeftCorner<2, 2>().llt().solve(both);
      for (Eigen::Index i = 2; i < drawer.drivers(); ++i) score[i] = r.row(i).head<2>() * weight;
      HandSample sample = drawer.person(score, nullptr);
      sample.label = k == 0 ? "mean" + of
                            : significant(100.0 * options.boundary, 6) + " % ellipse" + of + ", " +
                                  significant(angle, 6) + " deg";
      hands.push_back(std::move(sample));
    }
  }
  return hands;
}

std::string person_word(const Stratum& stratum) {
  if (!stratum.sex) return stratum.name;
  return *stratum.sex == grasp::Sex::kMale ? "man" : "woman";
}

std::vector<HandSample> percentile_hands(const Population& population,
                                         const SamplingOptions& options) {
  std::vector<HandSample> hands;
  for (const Drawer& drawer : drawers_of(population)) {
    for (const double percentile : options.percentiles) {
      const double score = standard_normal_quantile(percentile / 100.0);
      HandSample sample =
          drawer.person(Eigen::VectorXd::Constant(drawer.drivers(), score), nullptr);
      sample.label = "P" + significant(percentile, 6) + " " + person_word(drawer.stratum());
      hands.push_back(std::move(sample));
    }
  }
  return hands;
}

}  // namespace

std::string name_of(SamplingDesign design) {
  switch (design) {
    case SamplingDesign::kRandom:
      return "random";
    case SamplingDesign::kLatinHypercube:
      return "latin_hypercube";
    case SamplingDesign::kBoundary:
      return "boundary";
    case SamplingDesign::kPercentiles:
      break;
  }
  return "percentiles";
}

std::optional<SamplingDesign> sampling_design_named(std::string_view name) {
  if (name == "lhs") return SamplingDesign::kLatinHypercube;
  for (const SamplingDesign one : kSamplingDesigns) {
    if (name_of(one) == name) return one;
  }
  return std::nullopt;
}

void SamplingOptions::check() const {
  const auto fail = [](const std::string& what, double value, const std::string& allowed) {
    throw UsageError("sampling: " + what + " is " + significant(value, 6) + "; " + allowed +
                     " is allowed");
  };
  if (hands < 1 || hands > kMostHands) {
    fail("number of hands", hands, "1 to " + std::to_string(kMostHands));
  }
  if (!(boundary > 0.0 && boundary < 1.0)) fail("share inside the boundary", boundary, "0 to 1");
  if (boundary_points < 4 || boundary_points > 360) {
    fail("number of boundary hands", boundary_points, "4 to 360");
  }
  if (design == SamplingDesign::kPercentiles && percentiles.empty()) {
    throw UsageError("sampling: no percentiles; at least one is required");
  }
  for (const double one : percentiles) {
    if (!(one >= 0.1 && one <= 99.9)) fail("percentile", one, "0.1 to 99.9");
  }
}

std::vector<HandSample> sample_hands(const Population& population, const SamplingOptions& options) {
  population.check();
  options.check();
  switch (options.design) {
    case SamplingDesign::kBoundary:
      return boundary_hands(population, options);
    case SamplingDesign::kPercentiles:
      return percentile_hands(population, options);
    case SamplingDesign::kRandom:
    case SamplingDesign::kLatinHypercube:
      break;
  }
  std::vector<HandSample> hands = options.design == SamplingDesign::kRandom
                                      ? random_hands(population, options)
                                      : layered_hands(population, options);
  for (std::size_t k = 0; k < hands.size(); ++k) hands[k].label = std::to_string(k + 1);
  return hands;
}

}  // namespace palmar::population
