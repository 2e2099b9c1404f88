// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/person_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/population/joint_moments.h"

namespace palmar::population {
namespace {

constexpr hand::HandDimension kMiddleProximal{hand::DimensionKind::kSegmentLength,
                                              hand::Segment::kMiddleProximal};
constexpr hand::HandDimension kMiddleMiddle{hand::DimensionKind::kSegmentLength,
                                            hand::Segment::kMiddleMiddle};
constexpr hand::HandDimension kMiddleDistal{hand::DimensionKind::kSegmentLength,
                                            hand::Segment::kMiddleDistal};
constexpr double kRare = 3.3;  // deviations: one in a thousand

bool has(const JointMoments& m, hand::HandDimension dimension) {
  return std::find(m.dimension.begin(), m.dimension.end(), dimension) != m.dimension.end();
}

Eigen::Index place_of(const JointMoments& m, hand::HandDimension dimension,
                      const std::string& whose) {
  const auto found = std::find(m.dimension.begin(), m.dimension.end(), dimension);
  if (found == m.dimension.end()) {
    throw UsageError(whose + ": " + name_of(dimension) +
                     " isn't among the population's dimensions");
  }
  return found - m.dimension.begin();
}

/// Moments of a stratum with a scatter of what is in proportion, and the middle finger's proximal
/// length at the end where the others leave it.
JointMoments complete(const Stratum& stratum) {
  JointMoments m = joint_moments(stratum);
  for (const DimensionRegression& one : stratum.regressions) {
    if (one.evidence != Evidence::kScaled) continue;
    const Eigen::Index i = place_of(m, one.dimension, stratum.name);
    m.covariance(i, i) += std::pow(kProportionScatter * m.mean[i], 2);
  }
  if (has(m, kMiddleProximal) || !has(m, hand::kHandLengthDimension) ||
      !has(m, hand::kPalmLengthDimension) || !has(m, kMiddleMiddle) || !has(m, kMiddleDistal)) {
    return m;
  }
  const Eigen::Index n = m.mean.size();
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(n + 1, n);
  map.topRows(n).setIdentity();
  map(n, place_of(m, hand::kHandLengthDimension, "")) = 1.0;
  for (const hand::HandDimension part :
       {hand::kPalmLengthDimension, kMiddleMiddle, kMiddleDistal}) {
    map(n, place_of(m, part, "")) = -1.0;
  }
  m.mean = (map * m.mean).eval();
  m.covariance = (map * m.covariance * map.transpose()).eval();
  m.dimension.push_back(kMiddleProximal);
  return m;
}

/// A stratum's people who have the measures.
struct Given {
  JointMoments all;
  Eigen::VectorXd score;    ///< of each measure by itself, deviations
  double log_weight = 0.0;  ///< of the stratum
};

Given given(const Stratum& stratum, const std::vector<KnownMeasure>& measures) {
  Given result{complete(stratum), {}, 0.0};
  JointMoments& m = result.all;
  const auto count = static_cast<Eigen::Index>(measures.size());
  Eigen::MatrixXd pick = Eigen::MatrixXd::Zero(count, m.mean.size());
  Eigen::VectorXd value(count), error(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const KnownMeasure& one = measures[k];
    for (const auto& [dimension, factor] : one.terms) {
      pick(k, place_of(m, dimension, one.name)) += factor;
    }
    value[k] = one.value;
    error[k] = one.sd;
  }
  const Eigen::VectorXd off = value - pick * m.mean;
  Eigen::MatrixXd spread = pick * m.covariance * pick.transpose();
  spread.diagonal() += error.cwiseAbs2();
  result.score = off.cwiseQuotient(spread.diagonal().cwiseSqrt().cwiseMax(1e-9));
  spread.diagonal().array() += 1e-9;  // measures that say the same twice
  const Eigen::LLT<Eigen::MatrixXd> factor(spread);
  const Eigen::MatrixXd gain = factor.solve(pick * m.covariance).transpose();
  const Eigen::VectorXd whitened = factor.matrixL().solve(off);
  const Eigen::MatrixXd lower = factor.matrixL();
  result.log_weight =
      std::log(stratum.share) - 0.5 * whitened.squaredNorm() - lower.diagonal().array().log().sum();
  m.mean += gain * off;
  m.covariance -= (gain * pick * m.covariance).eval();
  return result;
}

void check(const std::vector<KnownMeasure>& measures) {
  if (measures.empty()) throw UsageError("no measurement of the person is given; one is needed");
  for (const KnownMeasure& one : measures) {
    if (!(one.value >= 1.0 && one.value <= 400.0)) {
      throw UsageError(one.name + " is " + significant(one.value, 4) +
                       " mm; 1 to 400 mm is allowed");
    }
    if (!(one.sd >= 0.0 && one.sd <= 50.0)) {
      throw UsageError(one.name + ": deviation is " + significant(one.sd, 4) +
                       " mm; 0 to 50 mm is allowed");
    }
  }
}

bool is_measured(hand::HandDimension dimension, const std::vector<KnownMeasure>& measures) {
  return std::any_of(measures.begin(), measures.end(), [&](const KnownMeasure& one) {
    return one.terms.size() == 1 && one.terms.front().first == dimension;
  });
}

}  // namespace

KnownMeasure KnownMeasure::of(hand::HandDimension dimension, double value, double sd) {
  return {{{dimension, 1.0}}, value, sd, name_of(dimension)};
}

PersonEstimate estimate_person(const Population& population,
                               const std::vector<KnownMeasure>& measures) {
  check(measures);
  population.check();
  std::vector<Given> strata;
  for (const Stratum& stratum : population.strata) strata.push_back(given(stratum, measures));
  PersonEstimate result;
  double largest = strata.front().log_weight, sum = 0.0;
  for (const Given& one : strata) largest = std::max(largest, one.log_weight);
  for (const Given& one : strata) {
    result.stratum_share.push_back(std::exp(one.log_weight - largest));
    sum += result.stratum_share.back();
  }
  for (double& share : result.stratum_share) share /= sum;

  const std::vector<hand::HandDimension>& dimensions = strata.front().all.dimension;
  for (const hand::HandDimension dimension : dimensions) {
    EstimatedDimension one{.dimension = dimension, .is_measured = is_measured(dimension, measures)};
    double square = 0.0;
    for (std::size_t s = 0; s < strata.size(); ++s) {
      const JointMoments& m = strata[s].all;
      const Eigen::Index i = place_of(m, dimension, population.strata[s].name);
      const double share = result.stratum_share[s];
      one.value += share * m.mean[i];
      square += share * (std::max(0.0, m.covariance(i, i)) + m.mean[i] * m.mean[i]);
    }
    one.sd = std::sqrt(std::max(0.0, square - one.value * one.value));
    for (const DimensionRegression& regression : population.strata.front().regressions) {
      if (regression.dimension == dimension) one.evidence = regression.evidence;
    }
    result.dimensions.push_back(one);
  }
  for (std::size_t k = 0; k < measures.size(); ++k) {
    double least = 1e9;
    for (const Given& one : strata) {
      least = std::min(least, std::abs(one.score[static_cast<Eigen::Index>(k)]));
    }
    if (least > kRare) {
      result.notes.push_back(measures[k].name + ", " + significant(measures[k].value, 4) +
                             " mm, is " + significant(least, 4) +
                             " standard deviations from the mean of " + population.name +
                             ": was it measured as the documents show?");
    }
  }
  return result;
}

std::vector<hand::SizedDimension> sizes_of(const PersonEstimate& estimate) {
  std::vector<hand::SizedDimension> sizes;
  for (const EstimatedDimension& one : estimate.dimensions) {
    if (one.dimension != kMiddleProximal) sizes.push_back({one.dimension, one.value});
  }
  return sizes;
}

}  // namespace palmar::population
