// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/posture_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"
#include "palmar/geometry/rotation.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/statistics/median.h"

namespace palmar::hand {

/// Where the hand is and how it is posed.
struct PostureFitter::Place {
  Posture posture;
  geometry::Rigid3 measured_from_hand;
  double scale = 1.0;
};

struct PostureFitter::Solved {
  Place place;
  double cost = 0.0;
  int iterations = 0;
  std::array<double, kDofCount> sd{};
  double placement_sd = 0.0;  ///< rad
  std::vector<Dof> at_limit;
};

namespace {

using Measured = std::vector<std::optional<Vec3>>;

constexpr double kWeakPriorSd = 10.0;   // rad; decides only what nothing else does
constexpr double kPlaceSd = 1e5;        // mm; likewise
constexpr double kJacobianStep = 1e-5;  // rad; of the numeric Jacobian, error 1e-10 of a lever arm
constexpr int kFewestPoints = 4;        // three give a place and no angle
constexpr double kLostPlacement = 0.5;  // rad; the hand's orientation is not determined
constexpr double kMedianOfChi3 = 1.5382;  // median length of a 3-vector of unit normal errors

int count_of(const Measured& measured) {
  return static_cast<int>(std::count_if(measured.begin(), measured.end(),
                                        [](const auto& one) { return one.has_value(); }));
}

Vec3 centroid(const std::vector<Vec3>& points, const Measured& measured) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (measured[i]) sum += points[i];
  }
  return sum / count_of(measured);
}

Vec3 centroid(const Measured& measured) {
  Vec3 sum = Vec3::Zero();
  for (const auto& one : measured) {
    if (one) sum += *one;
  }
  return sum / count_of(measured);
}

/// Root mean square distance of points from their centroid.
double extent(const std::vector<Vec3>& points, const Measured& measured) {
  const Vec3 centre = centroid(points, measured);
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (measured[i]) sum += (points[i] - centre).squaredNorm();
  }
  return std::sqrt(sum / count_of(measured));
}

double extent(const Measured& measured) {
  std::vector<Vec3> points;
  for (const auto& one : measured) points.push_back(one.value_or(Vec3::Zero()));
  return extent(points, measured);
}

Measured mirrored(Measured measured) {
  for (auto& one : measured) {
    if (one) one->x() = -one->x();
  }
  return measured;
}

std::string percent(double scale) { return fmt::format("{:.0f} %", 100.0 * scale); }

}  // namespace

std::string name_of(PostureFitStatus status) {
  switch (status) {
    case PostureFitStatus::kFitted:
      return "fitted";
    case PostureFitStatus::kPoor:
      return "poor";
    case PostureFitStatus::kMirrored:
      return "mirrored";
    case PostureFitStatus::kWrongUnit:
      return "wrong_unit";
    case PostureFitStatus::kTooFew:
      return "too_few";
  }
  return "unknown";
}

void PostureFitOptions::check() const {
  const auto require = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
      throw UsageError(
          fmt::format("posture fit: {} is {:g}; {:g} to {:g} is allowed", name, value, low, high));
    }
  };
  require("point_sd (mm)", point_sd, 1e-3, 50.0);
  require("largest_sd (rad)", largest_sd, 1e-3, 3.0);
  require("poor_rms (mm)", poor_rms, 1e-3, 1000.0);
  require("max_iterations", max_iterations, 1, 10000);
}

PostureFitter::PostureFitter(const Hand& hand, const std::vector<HandPoint>& points,
                             const PostureFitOptions& options)
    : skeleton_(hand.skeleton),
      points_(hand, points),
      options_(options),
      reference_(reference_posture(hand.skeleton)) {
  options.check();
  if (points.empty()) throw UsageError("posture fit: there are no points on the hand");
  starts_.push_back(reference_);
  for (const std::string& name : posture_names()) {
    starts_.push_back(*named_posture(hand.skeleton, name));
  }
}

/// Rotation and translation that bring model points onto measured ones in the least-squares sense
/// (Kabsch 1976); the scale stays 1.
PostureFitter::Place PostureFitter::place_for(const std::vector<Vec3>& model,
                                              const Measured& measured) const {
  const Vec3 from = centroid(model, measured);
  const Vec3 to = centroid(measured);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (measured[i]) cross += (*measured[i] - to) * (model[i] - from).transpose();
  }
  Place place;
  place.measured_from_hand.rotation = Quat(geometry::fit_rotation(cross)).normalized();
  place.measured_from_hand.translation = to - place.measured_from_hand.rotation * from;
  return place;
}

std::vector<double> PostureFitter::residuals(const Measured& measured, const Place& place) const {
  const std::vector<Vec3> model = points_.pose(place.posture);
  std::vector<double> lengths(model.size(), 0.0);
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (measured[i]) {
      lengths[i] = (place.measured_from_hand * (place.scale * model[i]) - *measured[i]).norm();
    }
  }
  return lengths;
}

PostureFitter::Solved PostureFitter::solve(const Measured& measured,
                                           const std::vector<double>& weight,
                                           const std::vector<char>& is_held, const Place& start,
                                           int max_iterations) const {
  std::vector<Dof> free;
  for (int d = 0; d < kDofCount; ++d) {
    const JointDof& dof = skeleton_.dof(static_cast<Dof>(d));
    if (!is_held[d] && dof.upper - dof.lower > 1e-9) {
      free.push_back(static_cast<Dof>(d));
    }
  }
  const int first = options_.fits_scale ? 7 : 6;
  const auto n = first + static_cast<Eigen::Index>(free.size());
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (measured[i] && weight[i] > 0.0) rows.push_back(i);
  }
  const auto m = 3 * static_cast<Eigen::Index>(rows.size());
  const Quat turn0 = start.measured_from_hand.rotation;
  const Vec3 pivot = centroid(points_.pose(start.posture), measured);  // hand frame
  const Vec3 pivot_in_measured = start.measured_from_hand * (start.scale * pivot);

  const auto place_at = [&](const Eigen::VectorXd& x) {
    Place place = start;
    for (std::size_t k = 0; k < free.size(); ++k) {
      place.posture[free[k]] = x[first + static_cast<Eigen::Index>(k)];
    }
    const Vec3 turn = x.head<3>();
    const double angle = turn.norm();
    const Quat q = angle > 0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity();
    if (options_.fits_scale) place.scale = std::exp(x[6]);
    place.measured_from_hand.rotation = (q * turn0).normalized();
    place.measured_from_hand.translation =
        pivot_in_measured + x.segment<3>(3) -
        place.scale * (place.measured_from_hand.rotation * pivot);
    return place;
  };
  const auto points_at = [&](const Place& place) {
    const std::vector<Vec3> model = points_.pose(place.posture);
    Eigen::VectorXd z(m);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      z.segment<3>(3 * static_cast<Eigen::Index>(r)) =
          std::sqrt(weight[rows[r]]) / options_.point_sd *
          (place.measured_from_hand * (place.scale * model[rows[r]]));
    }
    return z;
  };
  Eigen::VectorXd wanted(m);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    wanted.segment<3>(3 * static_cast<Eigen::Index>(r)) =
        std::sqrt(weight[rows[r]]) / options_.point_sd * *measured[rows[r]];
  }

  geometry::LeastSquaresProblem problem;
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    r.resize(m + n);
    r.head(m) = points_at(place_at(x)) - wanted;
    Eigen::VectorXd prior = Eigen::VectorXd::Constant(n, 1.0 / kWeakPriorSd);
    prior.segment<3>(3).setConstant(1.0 / kPlaceSd);
    Eigen::VectorXd middle = Eigen::VectorXd::Zero(n);
    for (std::size_t k = 0; k < free.size(); ++k) {
      middle[first + static_cast<Eigen::Index>(k)] = reference_[free[k]];
    }
    r.tail(n) = prior.cwiseProduct(x - middle);
  };
  problem.evaluate = geometry::with_numeric_jacobian(residual, [](Eigen::Index j, double) {
    return j >= 3 && j < 6 ? 1e-2 : kJacobianStep;  // mm: linear, any step will do
  });
  problem.lower = Eigen::VectorXd::Constant(n, -4.0);  // rad
  problem.upper = Eigen::VectorXd::Constant(n, 4.0);
  problem.lower.segment<3>(3).setConstant(-1e6);  // mm
  problem.upper.segment<3>(3).setConstant(1e6);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  if (options_.fits_scale) {
    problem.lower[6] = std::log(0.5);
    problem.upper[6] = std::log(2.0);
    x[6] = std::log(start.scale);
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Eigen::Index j = first + static_cast<Eigen::Index>(k);
    const JointDof& dof = skeleton_.dof(free[k]);
    problem.lower[j] = dof.lower;
    problem.upper[j] = dof.upper;
    x[j] = start.posture[free[k]];
  }
  const geometry::LeastSquaresSolution found = geometry::solve_least_squares(
      problem, x,
      {.max_iterations = max_iterations, .gradient_tolerance = 1e-7, .step_tolerance = 1e-9});

  Solved solved;
  solved.place = place_at(found.x);
  solved.cost = found.sum_of_squares;
  solved.iterations = found.iterations;
  const Eigen::MatrixXd covariance =
      (found.jacobian.transpose() * found.jacobian).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  const auto sd_of = [&](Eigen::Index j) {
    const double variance = covariance(j, j);
    return std::isfinite(variance) && variance >= 0.0 ? std::sqrt(variance) : kWeakPriorSd;
  };
  for (Eigen::Index j = 0; j < 3; ++j) {
    solved.placement_sd = std::max(solved.placement_sd, sd_of(j));
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Eigen::Index j = first + static_cast<Eigen::Index>(k);
    solved.sd[index_of(free[k])] = sd_of(j);
    if (found.at_bound[j]) solved.at_limit.push_back(free[k]);
  }
  return solved;
}

PostureFit PostureFitter::fit(const Measured& measured, const PostureFit* before) const {
  if (static_cast<int>(measured.size()) != points_.count()) {
    throw UsageError(fmt::format("posture fit: {} measured points for {} points of the hand",
                                 measured.size(), points_.count()));
  }
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (measured[i] && !measured[i]->allFinite()) {
      throw UsageError(fmt::format("posture fit: point {} is not finite", i));
    }
  }
  PostureFit result;
  result.posture = reference_;
  result.residual.resize(measured.size());
  const int visible = count_of(measured);
  if (visible < kFewestPoints) {
    result.message = fmt::format("{} of {} points are there; at least {} are needed", visible,
                                 measured.size(), kFewestPoints);
    return result;
  }
  const double seen = extent(measured);
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const Posture& start : starts_) {
    const double size = extent(points_.pose(start), measured);
    smallest = std::min(smallest, size);
    largest = std::max(largest, size);
  }
  if (seen < smallest / 3.0 || seen > 3.0 * largest) {
    result.status = PostureFitStatus::kWrongUnit;
    result.message = fmt::format(
        "the points are {:.3g} mm from their middle (root mean square), those of the hand {:.3g} "
        "to {:.3g} mm: is the unit right?",
        seen, smallest, largest);
    return result;
  }
  result = fit_checked(measured, before);
  if (result.status != PostureFitStatus::kPoor) return result;
  // A sequence may have lost its way: look everywhere before giving up.
  if (before != nullptr) {
    const PostureFit refitted = fit_checked(measured, nullptr);
    if (refitted.rms < result.rms) result = refitted;
    if (result.status != PostureFitStatus::kPoor) return result;
  }
  const PostureFit other = fit_checked(mirrored(measured), nullptr);
  if (other.rms < 0.5 * result.rms && other.outliers.size() <= result.outliers.size()) {
    result.status = PostureFitStatus::kMirrored;
    result.message = fmt::format(
        "the points fit the mirrored hand within {:.1f} mm (root mean square), this one only "
        "within "
        "{:.1f} mm: are they of the other hand? `palmar hand mirror` makes it",
        other.rms, result.rms);
  }
  return result;
}

PostureFit PostureFitter::fit_checked(const Measured& measured, const PostureFit* before) const {
  std::vector<char> is_held(kDofCount, 0);
  std::vector<double> weight(measured.size(), 1.0);
  PostureFit result;

  /// Scale of the residuals: by the median, as outliers don't move it.
  const auto scale_of = [&](const std::vector<double>& lengths) {
    std::vector<double> seen;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (measured[i]) seen.push_back(lengths[i]);
    }
    return std::max(0.5 * options_.point_sd, statistics::median(std::move(seen)) / kMedianOfChi3);
  };
  const auto robust_weight = [](double length, double c) {
    return std::pow(1.0 + (length / c) * (length / c), -2);
  };
  /// What a posture costs when far points count no more than a little.
  const auto robust_cost = [&](const Place& place) {
    const double c = 4.0 * options_.point_sd;
    double sum = 0.0;
    for (const double length : residuals(measured, place)) {
      sum += length * length / (1.0 + (length / c) * (length / c));
    }
    return sum;
  };

  Place best;
  if (before != nullptr && before->status != PostureFitStatus::kTooFew &&
      before->status != PostureFitStatus::kWrongUnit) {
    best = {before->posture, before->measured_from_hand, before->scale};
  } else {
    constexpr int kTries = 25;  // iterations: enough to distinguish the starts
    double least = std::numeric_limits<double>::infinity();
    for (const Posture& start : starts_) {
      Place place = place_for(points_.pose(start), measured);
      place.posture = start;
      const Solved solved = solve(measured, weight, is_held, place, kTries);
      result.iterations += solved.iterations;
      const double cost = options_.is_robust ? robust_cost(solved.place) : solved.cost;
      if (cost < least * (1.0 - 1e-9)) {
        least = cost;
        best = solved.place;
      }
    }
  }

  Solved solved;
  const auto refine = [&] {
    solved = solve(measured, weight, is_held, best, options_.max_iterations);
    result.iterations += solved.iterations;
    best = solved.place;
  };
  if (options_.is_robust) {
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<double> lengths = residuals(measured, best);
      const double c = 4.0 * scale_of(lengths);
      for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = robust_weight(lengths[i], c);
      refine();
    }
    const std::vector<double> lengths = residuals(measured, best);
    const double limit = std::max(3.0 * options_.point_sd, 5.0 * scale_of(lengths));
    for (std::size_t i = 0; i < weight.size(); ++i) {
      weight[i] = lengths[i] > limit ? 0.0 : 1.0;
      if (measured[i] && weight[i] == 0.0) result.outliers.push_back(static_cast<int>(i));
    }
  }
  refine();

  // The most uncertain angle first: with it held the others may become certain.
  for (int d = 0; d < kDofCount; ++d) {
    if (solved.sd[d] > options_.largest_sd) {
      result.not_observed.push_back(static_cast<Dof>(d));
    }
  }
  result.sd = solved.sd;
  while (true) {
    const auto worst = std::max_element(solved.sd.begin(), solved.sd.end());
    if (*worst <= options_.largest_sd) break;
    const auto d = static_cast<std::size_t>(worst - solved.sd.begin());
    is_held[d] = 1;
    best.posture[static_cast<Dof>(d)] = reference_[static_cast<Dof>(d)];
    refine();
  }

  result.posture = best.posture;
  result.measured_from_hand = best.measured_from_hand;
  result.scale = best.scale;
  result.at_limit = solved.at_limit;
  result.residual.resize(measured.size());
  const std::vector<double> lengths = residuals(measured, best);
  double sum = 0.0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!measured[i]) continue;
    result.residual[i] = lengths[i];
    if (weight[i] == 0.0) continue;
    sum += lengths[i] * lengths[i];
    ++result.points;
  }
  result.rms = result.points > 0 ? std::sqrt(sum / result.points) : 0.0;

  // Two left-out points that each lie where the other one belongs.
  const std::vector<Vec3> model = points_.pose(best.posture);
  for (std::size_t a = 0; a < result.outliers.size(); ++a) {
    for (std::size_t b = a + 1; b < result.outliers.size(); ++b) {
      const auto i = static_cast<std::size_t>(result.outliers[a]);
      const auto j = static_cast<std::size_t>(result.outliers[b]);
      const auto to = [&](std::size_t k) {
        return best.measured_from_hand * (best.scale * model[k]);
      };
      const double crossed = std::max((*measured[i] - to(j)).norm(), (*measured[j] - to(i)).norm());
      if (crossed < 0.5 * std::min(lengths[i], lengths[j])) {
        result.swapped.emplace_back(static_cast<int>(i), static_cast<int>(j));
      }
    }
  }

  if (solved.placement_sd > kLostPlacement || result.points < kFewestPoints) {
    result.status = PostureFitStatus::kTooFew;
    result.message = fmt::format(
        "{} points don't show how the palm is turned; at least three on palm and back of the hand, "
        "not on one line, are needed",
        result.points);
  } else if (result.rms > options_.poor_rms) {
    result.status = PostureFitStatus::kPoor;
    result.message = fmt::format(
        "the points fit only within {:.1f} mm (root mean square): are they named rightly, and is "
        "the hand's size right?",
        result.rms);
  } else {
    result.status = PostureFitStatus::kFitted;
    result.message =
        fmt::format("{} points fit within {:.1f} mm (root mean square)", result.points, result.rms);
    if (options_.fits_scale) {
      result.message += "; the hand is " + percent(result.scale) + " of this one's size";
    }
  }
  return result;
}

}  // namespace palmar::hand
