// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/population.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/population/joint_moments.h"

namespace palmar::population {
namespace {

constexpr double kLargestLength = 400.0;      // mm; no hand is as long
constexpr double kLargestSpread = 0.2;        // SD over mean
constexpr double kShareTolerance = 1e-6;      // as shares written with six digits add up
constexpr double kSmallestEigenvalue = 1e-9;  // of a correlation matrix that counts as definite
constexpr double kOldest = 120.0;             // years

std::string fault_of_length(const std::string& what, double mean, double sd) {
  if (!(mean >= 1.0 && mean <= kLargestLength)) {
    return what + ": mean is " + significant(mean, 6) + " mm; 1 to " +
           significant(kLargestLength, 6) + " mm is allowed";
  }
  if (!(sd >= 0.0 && sd <= kLargestSpread * mean)) {
    return what + ": standard deviation is " + significant(sd, 6) +
           " mm; 0 to a fifth of the mean, " + significant(kLargestSpread * mean, 6) +
           " mm, is allowed";
  }
  return "";
}

std::string fault_of_correlation(const Stratum& stratum) {
  const auto n = static_cast<Eigen::Index>(stratum.driving.size());
  const Eigen::MatrixXd& r = stratum.correlation;
  if (r.rows() != n || r.cols() != n) {
    return "correlation matrix is " + std::to_string(r.rows()) + " x " + std::to_string(r.cols()) +
           "; " + std::to_string(n) + " x " + std::to_string(n) +
           " is required, a row for each driving dimension";
  }
  const auto name = [&](Eigen::Index i) { return name_of(stratum.driving[i].dimension); };
  for (Eigen::Index i = 0; i < n; ++i) {
    if (r(i, i) != 1.0) {
      return "correlation of " + name(i) + " with itself is " + significant(r(i, i), 6) +
             "; 1 is required";
    }
    for (Eigen::Index j = 0; j < i; ++j) {
      if (!(std::abs(r(i, j)) < 1.0)) {
        return "correlation of " + name(j) + " and " + name(i) + " is " + significant(r(i, j), 6) +
               "; between -1 and 1 is required";
      }
      if (r(i, j) != r(j, i)) {
        return "correlation of " + name(j) + " and " + name(i) + " is " + significant(r(j, i), 6) +
               " one way and " + significant(r(i, j), 6) +
               " the other; a symmetric matrix is required";
      }
    }
  }
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(r, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (!(smallest > kSmallestEigenvalue)) {
    return "correlations contradict each other: the smallest eigenvalue of their matrix is " +
           significant(smallest, 6) + "; a positive definite matrix is required";
  }
  return "";
}

std::optional<Eigen::Index> index_of(const std::vector<hand::HandDimension>& list,
                                     hand::HandDimension d) {
  const auto found = std::find(list.begin(), list.end(), d);
  if (found == list.end()) return std::nullopt;
  return found - list.begin();
}

std::string fault_of_regressions(const Stratum& stratum) {
  std::vector<hand::HandDimension> known;
  for (const DrivingDimension& one : stratum.driving) known.push_back(one.dimension);
  for (const DimensionRegression& regression : stratum.regressions) {
    const std::string what = "regression of " + name_of(regression.dimension);
    if (index_of(known, regression.dimension)) {
      return what + ": the dimension is there already; each may appear once";
    }
    if (!std::isfinite(regression.intercept)) {
      return what + ": intercept is no finite number";
    }
    if (!(regression.residual_sd >= 0.0)) {
      return what + ": residual deviation is " + significant(regression.residual_sd, 6) +
             " mm; 0 or more is allowed";
    }
    for (const DimensionRegression::Term& term : regression.terms) {
      if (!index_of(known, term.predictor)) {
        return what + ": predictor " + name_of(term.predictor) +
               " neither drives nor is regressed before; only such predict";
      }
      if (!std::isfinite(term.slope)) {
        return what + ": slope of " + name_of(term.predictor) + " is no finite number";
      }
    }
    known.push_back(regression.dimension);
  }
  const JointMoments m = joint_moments(stratum);
  for (std::size_t k = stratum.driving.size(); k < m.dimension.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const std::string fault =
        fault_of_length("regression of " + name_of(m.dimension[k]) + " at the mean hand", m.mean[i],
                        std::sqrt(std::max(0.0, m.covariance(i, i))));
    if (!fault.empty()) return fault;
  }
  return "";
}

}  // namespace

JointMoments joint_moments(const Stratum& stratum) {
  const auto drivers = static_cast<Eigen::Index>(stratum.driving.size());
  const auto all = drivers + static_cast<Eigen::Index>(stratum.regressions.size());
  JointMoments m{{}, Eigen::VectorXd::Zero(all), Eigen::MatrixXd::Zero(all, all)};
  for (Eigen::Index i = 0; i < drivers; ++i) {
    const DrivingDimension& one = stratum.driving[i];
    m.dimension.push_back(one.dimension);
    m.mean[i] = one.mean;
    for (Eigen::Index j = 0; j < drivers; ++j) {
      m.covariance(i, j) = one.sd * stratum.driving[j].sd * stratum.correlation(i, j);
    }
  }
  for (const DimensionRegression& regression : stratum.regressions) {
    const auto k = static_cast<Eigen::Index>(m.dimension.size());
    m.mean[k] = regression.intercept;
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(all);
    for (const DimensionRegression::Term& term : regression.terms) {
      slope[*index_of(m.dimension, term.predictor)] += term.slope;
    }
    m.mean[k] += slope.dot(m.mean) - slope[k] * m.mean[k];
    const Eigen::VectorXd with_others = m.covariance * slope;
    m.covariance.col(k) = with_others;
    m.covariance.row(k) = with_others.transpose();
    m.covariance(k, k) = slope.dot(with_others) + regression.residual_sd * regression.residual_sd;
    m.dimension.push_back(regression.dimension);
  }
  return m;
}

std::string name_of(Evidence evidence) {
  switch (evidence) {
    case Evidence::kMeasured:
      return "measured";
    case Evidence::kRegressed:
      return "regressed";
    case Evidence::kScaled:
      break;
  }
  return "scaled";
}

std::optional<Evidence> evidence_named(std::string_view name) {
  for (const Evidence one : {Evidence::kMeasured, Evidence::kRegressed, Evidence::kScaled}) {
    if (name_of(one) == name) return one;
  }
  return std::nullopt;
}

std::string fault_of(const Stratum& stratum) {
  if (stratum.name.empty()) return "name is empty; a word is required";
  if (!(stratum.share > 0.0 && stratum.share <= 1.0)) {
    return "share is " + significant(stratum.share, 6) + "; above 0 to 1 is allowed";
  }
  if (stratum.age && !(*stratum.age >= 0.0 && *stratum.age <= kOldest)) {
    return "age is " + significant(*stratum.age, 6) + " years; 0 to " + significant(kOldest, 6) +
           " is allowed";
  }
  if (stratum.driving.empty()) return "no driving dimension; at least one is required";
  for (std::size_t i = 0; i < stratum.driving.size(); ++i) {
    const DrivingDimension& one = stratum.driving[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (stratum.driving[j].dimension == one.dimension) {
        return "driving dimension " + name_of(one.dimension) + " is there twice";
      }
    }
    const std::string fault = fault_of_length(name_of(one.dimension), one.mean, one.sd);
    if (!fault.empty()) return fault;
  }
  const std::string fault = fault_of_correlation(stratum);
  return fault.empty() ? fault_of_regressions(stratum) : fault;
}

std::optional<DimensionMoments> moments_of(const Stratum& stratum, hand::HandDimension dimension) {
  const JointMoments m = joint_moments(stratum);
  const auto i = index_of(m.dimension, dimension);
  if (!i) return std::nullopt;
  return DimensionMoments{m.mean[*i], std::sqrt(std::max(0.0, m.covariance(*i, *i)))};
}

std::string fault_of(const Population& population) {
  if (population.name.empty()) return "name is empty; a word is required";
  if (population.strata.empty()) return "no stratum; at least one is required";
  double sum = 0.0;
  for (std::size_t i = 0; i < population.strata.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (population.strata[i].name == population.strata[j].name) {
        return "two strata are named \"" + population.strata[i].name + "\"";
      }
    }
    sum += population.strata[i].share;
  }
  if (!(std::abs(sum - 1.0) <= kShareTolerance)) {
    return "shares of the strata add up to " + significant(sum, 6) + "; 1 is required";
  }
  return "";
}

void Population::check() const {
  const std::string what = "population \"" + name + "\": ";
  for (const Stratum& stratum : strata) {
    const std::string fault = fault_of(stratum);
    if (!fault.empty()) throw UsageError(what + "stratum \"" + stratum.name + "\": " + fault);
  }
  const std::string fault = fault_of(*this);
  if (!fault.empty()) throw UsageError(what + fault);
}

}  // namespace palmar::population
