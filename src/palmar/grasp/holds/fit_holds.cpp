// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/fit_holds.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

constexpr double kSeen = 20.0;  // mm; s
constexpr double kRidge = 5.0;  // r
constexpr int kMostSteps = 40;
constexpr double kSettled = 1e-5;
constexpr double kNever = 1e-300;  // a likelihood that rounds to nothing
constexpr std::size_t kModes = 8;

using Features = Eigen::Matrix<double, Eigen::Dynamic, kHoldFeatureCount>;

/// An object as the fit sees it.
struct Seen {
  Features features;         ///< candidates x features, scaled
  Eigen::MatrixXd distance;  ///< people's holds x candidates, mm
  Eigen::MatrixXd near;      ///< exp(-d^2 / 2 s^2) of these
};

Eigen::VectorXd chances_of(const Features& features, const HoldFeatures& weight) {
  Eigen::VectorXd chance = features * weight;
  chance = (chance.array() - chance.maxCoeff()).exp();
  return chance / chance.sum();
}

double likelihood_of(const Seen& object, const Eigen::VectorXd& chance) {
  return ((object.near * chance).array() + kNever).log().mean();
}

HoldFeatures fitted(const std::vector<Seen>& objects, std::size_t without, HoldFeatures weight) {
  using Square = Eigen::Matrix<double, kHoldFeatureCount, kHoldFeatureCount>;
  for (int step = 0; step < kMostSteps; ++step) {
    HoldFeatures gradient = -kRidge * weight;
    Square curvature = kRidge * Square::Identity();
    for (std::size_t o = 0; o < objects.size(); ++o) {
      if (o == without) continue;
      const Seen& object = objects[o];
      const Eigen::VectorXd chance = chances_of(object.features, weight);
      const Eigen::RowVectorXd mean = chance.transpose() * object.features;
      const Features centred = object.features.rowwise() - mean;
      const Eigen::VectorXd whole = (object.near * chance).array() + kNever;
      const Eigen::VectorXd share =
          chance.cwiseProduct(object.near.transpose() * whole.cwiseInverse());
      gradient += centred.transpose() * share;
      curvature += static_cast<double>(object.near.rows()) *
                   (centred.transpose() * chance.asDiagonal() * centred);
    }
    const HoldFeatures change = curvature.ldlt().solve(gradient);
    weight += change;
    if (change.cwiseAbs().maxCoeff() < kSettled) break;
  }
  return weight;
}

LeftOut judged(const ObservedObject& observed, const Seen& object, const HoldFeatures& weight) {
  LeftOut result;
  result.name = observed.name;
  result.seen = static_cast<int>(observed.seen.size());
  Eigen::VectorXd nearest = object.distance.rowwise().minCoeff();
  std::sort(nearest.begin(), nearest.end());
  result.nearest = nearest[nearest.size() / 2];
  const Eigen::VectorXd chance = chances_of(object.features, weight);
  result.likelihood = likelihood_of(object, chance);
  const auto count = chance.size();
  result.even =
      likelihood_of(object, Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count)));
  const std::vector<HoldMode> modes = modes_of(observed.candidates, chance, kModes);
  const auto away = [&](const HoldMode& mode) {
    return object.distance.col(static_cast<Eigen::Index>(mode.hold)).minCoeff();
  };
  result.first = result.best_of_eight = away(modes.front());
  for (const HoldMode& mode : modes) {
    result.best_of_eight = std::min(result.best_of_eight, away(mode));
  }
  return result;
}

}  // namespace

HoldFit fit_holds(const std::vector<ObservedObject>& objects) {
  if (objects.size() < 2) throw UsageError("fitting holds: at least two objects are required");
  HoldFit fit;
  HoldFeatures sum = HoldFeatures::Zero(), squares = HoldFeatures::Zero();
  double count = 0.0;
  for (const ObservedObject& object : objects) {
    if (object.candidates.empty() || object.seen.empty()) {
      throw UsageError("fitting holds: " + object.name +
                       (object.seen.empty() ? " has no holds of people"
                                            : " has no two opposite places that a hand spans"));
    }
    for (const OpposedHold& hold : object.candidates) {
      sum += hold.features;
      squares += hold.features.cwiseAbs2();
    }
    count += static_cast<double>(object.candidates.size());
  }
  HoldWeights& weights = fit.weights;
  weights.mean = sum / count;
  weights.spread = (squares / count - weights.mean.cwiseAbs2()).cwiseMax(1e-12).cwiseSqrt();
  std::vector<Seen> seen(objects.size());
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const ObservedObject& object = objects[o];
    const auto candidates = static_cast<Eigen::Index>(object.candidates.size());
    const auto people = static_cast<Eigen::Index>(object.seen.size());
    seen[o].features.resize(candidates, kHoldFeatureCount);
    seen[o].distance.resize(people, candidates);
    for (Eigen::Index c = 0; c < candidates; ++c) {
      const OpposedHold& hold = object.candidates[static_cast<std::size_t>(c)];
      seen[o].features.row(c) =
          (hold.features - weights.mean).cwiseQuotient(weights.spread).transpose();
      for (Eigen::Index i = 0; i < people; ++i) {
        seen[o].distance(i, c) = hold.points.distance_to(object.seen[static_cast<std::size_t>(i)]);
      }
    }
    seen[o].near = (-0.5 * seen[o].distance.array().square() / (kSeen * kSeen)).exp();
  }
  const std::size_t none = objects.size();
  weights.weight = fitted(seen, none, HoldFeatures::Zero());
  double total = 0.0;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const auto people = static_cast<double>(seen[o].near.rows());
    fit.likelihood += people * likelihood_of(seen[o], chances_of(seen[o].features, weights.weight));
    total += people;
    fit.left_out.push_back(judged(objects[o], seen[o], fitted(seen, o, weights.weight)));
  }
  fit.likelihood /= total;
  return fit;
}

}  // namespace palmar::grasp
