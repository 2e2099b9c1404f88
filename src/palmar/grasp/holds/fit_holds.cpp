// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/fit_holds.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::grasp {
namespace {

constexpr double kSeen = 20.0;  // mm; s
constexpr double kRidge = 5.0;  // r
constexpr int kMostSteps = 40;
constexpr double kSettled = 1e-5;
constexpr double kNever = 1e-300;  // a likelihood that rounds to nothing
constexpr std::size_t kModes = 8;

using Shapes = Eigen::Matrix<double, Eigen::Dynamic, kShapeFeatureCount>;
using Tables = Eigen::Matrix<double, Eigen::Dynamic, kTableFeatureCount>;
using Square = Eigen::Matrix<double, kHoldFeatureCount, kHoldFeatureCount>;

/// A person's hold as the fit sees it.
struct SeenHold {
  Tables features;       ///< candidates x features, as the object had lain
  Eigen::VectorXd near;  ///< exp(-d^2 / 2 s^2) of the candidates' distances to it
};

/// An object as the fit sees it.
struct Seen {
  Shapes features;  ///< candidates x features, scaled
  std::vector<SeenHold> holds;
  Eigen::MatrixXd distance;  ///< people's holds x candidates, mm
};

Eigen::VectorXd chances_of(const Eigen::VectorXd& score) {
  const Eigen::VectorXd odds = (score.array() - score.maxCoeff()).exp();
  return odds / odds.sum();
}

Eigen::VectorXd chances_of(const Seen& object, const SeenHold& hold, const HoldFeatures& weight) {
  return chances_of(object.features * weight.head<kShapeFeatureCount>() +
                    hold.features * weight.tail<kTableFeatureCount>());
}

double likelihood_of(const Seen& object, const HoldFeatures& weight) {
  double sum = 0.0;
  for (const SeenHold& hold : object.holds) {
    sum += std::log(hold.near.dot(chances_of(object, hold, weight)) + kNever);
  }
  return sum / static_cast<double>(object.holds.size());
}

/// What one hold adds to the gradient and the curvature of the logarithm of the likelihood.
struct Slope {
  HoldFeatures gradient = HoldFeatures::Zero();
  Square curvature = Square::Zero();
};

Slope slope_of(const Seen& object, const SeenHold& hold, const HoldFeatures& weight) {
  const Eigen::VectorXd chance = chances_of(object, hold, weight);
  const Eigen::VectorXd share = chance.cwiseProduct(hold.near) / (chance.dot(hold.near) + kNever);
  const auto mean_of = [&](const Eigen::VectorXd& by) {
    HoldFeatures mean;
    mean << object.features.transpose() * by, hold.features.transpose() * by;
    return mean;
  };
  const HoldFeatures mean = mean_of(chance);
  Slope slope;
  slope.gradient = mean_of(share) - share.sum() * mean;
  const Shapes shapes = chance.asDiagonal() * object.features;
  constexpr int kShapes = kShapeFeatureCount, kTables = kTableFeatureCount;
  slope.curvature.topLeftCorner<kShapes, kShapes>() = object.features.transpose() * shapes;
  slope.curvature.topRightCorner<kShapes, kTables>() = shapes.transpose() * hold.features;
  slope.curvature.bottomRightCorner<kTables, kTables>() =
      hold.features.transpose() * (chance.asDiagonal() * hold.features);
  slope.curvature.bottomLeftCorner<kTables, kShapes>() =
      slope.curvature.topRightCorner<kShapes, kTables>().transpose();
  slope.curvature -= mean * mean.transpose();
  return slope;
}

HoldFeatures fitted(const std::vector<Seen>& objects, std::size_t without, HoldFeatures weight) {
  std::vector<std::pair<const Seen*, const SeenHold*>> holds;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    if (o == without) continue;
    for (const SeenHold& hold : objects[o].holds) holds.emplace_back(&objects[o], &hold);
  }
  std::vector<Slope> slopes(holds.size());
  for (int step = 0; step < kMostSteps; ++step) {
    parallel_for(static_cast<int>(holds.size()), [&](int i) {
      const auto [object, hold] = holds[static_cast<std::size_t>(i)];
      slopes[static_cast<std::size_t>(i)] = slope_of(*object, *hold, weight);
    });
    HoldFeatures gradient = -kRidge * weight;
    Square curvature = kRidge * Square::Identity();
    for (const Slope& slope : slopes) {
      gradient += slope.gradient;
      curvature += slope.curvature;
    }
    const HoldFeatures change = curvature.ldlt().solve(gradient);
    weight += change;
    if (change.cwiseAbs().maxCoeff() < kSettled) break;
  }
  return weight;
}

LeftOut judged(const ObservedObject& observed, const Seen& object, const HoldWeights& weights) {
  LeftOut result;
  result.name = observed.name;
  result.seen = static_cast<int>(observed.seen.size());
  Eigen::VectorXd nearest = object.distance.rowwise().minCoeff();
  std::sort(nearest.begin(), nearest.end());
  result.nearest = nearest[nearest.size() / 2];
  const Eigen::VectorXd chance = chances(weights, observed.candidates);
  for (const SeenHold& hold : object.holds) {
    result.unseen += std::log(hold.near.dot(chance) + kNever);
    result.even += std::log(hold.near.mean() + kNever);
  }
  result.unseen /= result.seen;
  result.even /= result.seen;
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

Seen seen_of(const ObservedObject& object, const HoldWeights& scale) {
  const auto candidates = static_cast<Eigen::Index>(object.candidates.size());
  const auto people = static_cast<Eigen::Index>(object.seen.size());
  Seen seen;
  seen.features.resize(candidates, kShapeFeatureCount);
  seen.distance.resize(people, candidates);
  seen.holds.resize(object.seen.size());
  for (SeenHold& hold : seen.holds) hold.features.resize(candidates, kTableFeatureCount);
  for (Eigen::Index c = 0; c < candidates; ++c) {
    const OpposedHold& candidate = object.candidates[static_cast<std::size_t>(c)];
    seen.features.row(c) = (candidate.features - scale.mean.head<kShapeFeatureCount>())
                               .cwiseQuotient(scale.spread.head<kShapeFeatureCount>())
                               .transpose();
    for (Eigen::Index i = 0; i < people; ++i) {
      const ObservedHold& hold = object.seen[static_cast<std::size_t>(i)];
      seen.distance(i, c) = candidate.points.distance_to(hold.points);
      seen.holds[static_cast<std::size_t>(i)].features.row(c) =
          table_features(candidate.palm, hold.lay).transpose();
    }
  }
  for (Eigen::Index i = 0; i < people; ++i) {
    seen.holds[static_cast<std::size_t>(i)].near =
        (-0.5 * seen.distance.row(i).array().square() / (kSeen * kSeen)).exp();
  }
  return seen;
}

}  // namespace

HoldFit fit_holds(const std::vector<ObservedObject>& objects) {
  if (objects.size() < 2) throw UsageError("fitting holds: at least two objects are required");
  HoldFit fit;
  ShapeFeatures sum = ShapeFeatures::Zero(), squares = ShapeFeatures::Zero();
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
  const ShapeFeatures mean = sum / count;
  weights.mean.head<kShapeFeatureCount>() = mean;
  weights.spread.head<kShapeFeatureCount>() =
      (squares / count - mean.cwiseAbs2()).cwiseMax(1e-12).cwiseSqrt();
  std::vector<Seen> seen;
  for (const ObservedObject& object : objects) seen.push_back(seen_of(object, weights));
  weights.weight = fitted(seen, seen.size(), HoldFeatures::Zero());
  double total = 0.0;
  std::vector<double> knowing;  // likelihood of each object, left out
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const auto people = static_cast<double>(seen[o].holds.size());
    fit.likelihood += people * likelihood_of(seen[o], weights.weight);
    total += people;
    knowing.push_back(likelihood_of(seen[o], fitted(seen, o, weights.weight)));
  }
  // Not knowing how they had lain; the weights of features that are all alike stay 0.
  for (Seen& object : seen) {
    for (SeenHold& hold : object.holds) hold.features.setZero();
  }
  weights.unseen = fitted(seen, seen.size(), HoldFeatures::Zero());
  for (std::size_t o = 0; o < objects.size(); ++o) {
    HoldWeights without = weights;
    without.unseen = fitted(seen, o, weights.unseen);
    fit.left_out.push_back(judged(objects[o], seen[o], without));
    fit.left_out.back().likelihood = knowing[o];
  }
  fit.likelihood /= total;
  return fit;
}

}  // namespace palmar::grasp
