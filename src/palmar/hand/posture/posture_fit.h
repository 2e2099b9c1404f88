// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skin/hand_points.h"

namespace palmar::hand {

struct PostureFitOptions {
  /// Expected error of a measured point, mm (one standard deviation per axis): skin slides over
  /// bone by 1 to 3 mm and markers aren't placed better. Scales `sd` and the search for outliers.
  double point_sd = 2.0;
  /// Degrees of freedom whose angle the points leave more uncertain than this stay at the reference
  /// posture and count as not observed, rad.
  double largest_sd = 0.35;
  bool fits_scale = false;   ///< also one overall size of the hand
  bool is_robust = true;     ///< points that don't fit lose their weight and are named
  double poor_rms = 10.0;    ///< mm; a worse fit is called poor, and looked at in the mirror
  int max_iterations = 100;  ///< of each least-squares problem
  void check() const;        ///< throws UsageError: field, value, allowed range
};

enum class PostureFitStatus {
  kFitted,
  kPoor,       ///< residuals above poor_rms; the posture is not to be trusted
  kMirrored,   ///< the points are those of the other hand
  kWrongUnit,  ///< the points' extent can't be that of a hand of this size
  kTooFew,     ///< too few points to determine where the hand is
};
std::string name_of(PostureFitStatus status);  ///< "fitted", "poor", ...

struct PostureFit {
  PostureFitStatus status = PostureFitStatus::kTooFew;
  std::string message;  ///< one sentence: how well, or why not and what to try
  Posture posture;
  geometry::Rigid3 measured_from_hand;  ///< of the hand frame; mm
  double scale = 1.0;                   ///< measured size over this hand's; 1 unless asked for
  std::vector<std::optional<double>> residual;  ///< per point, mm; nothing for a missing one
  double rms = 0.0;                             ///< of the points that count, mm
  int points = 0;                               ///< that count
  std::vector<int> outliers;                    ///< points left out because they don't fit
  std::vector<std::pair<int, int>> swapped;     ///< of these: pairs that fit each other's place
  std::vector<Dof> not_observed;                ///< the points alone don't show these angles
  std::vector<Dof> at_limit;                    ///< angles that the range of motion holds back
  /// Standard deviation of each angle if points err by point_sd, rad.
  std::array<double, kDofCount> sd{};
  int iterations = 0;
};

/// Finds the posture (23 angles within the range of motion) and the place of a hand from measured
/// positions of points on it, any of which may be missing:
///
///     min over theta, R, t of  sum_i w_i |z_i - (s R m_i(theta) + t)|^2 / point_sd^2
///                              + sum_k ((theta_k - reference_k) / 10 rad)^2 ,
///
/// m_i the points of the posed hand (hand frame), z_i the measured ones. The second sum only
/// decides where the first says nothing. Least squares in a box (least_squares.h) with numeric
/// Jacobian, started from the named postures; then weights w = (1 + (r/c)^2)^-2 (Geman, McClure
/// 1985) with c = 4 standard deviations by the median residual, and at last without outliers. The
/// angles' standard deviations are those of the linearised problem, (J^T J)^-1.
///
/// Not finding a posture is a status, never an exception. Deterministic.
class PostureFitter {
 public:
  /// Throws UsageError on bad options or without points.
  PostureFitter(const Hand& hand, const std::vector<HandPoint>& points,
                const PostureFitOptions& options = {});

  /// `measured`: per point, mm; `before`: the fit of the frame before, from which to start. Throws
  /// UsageError for another number of points and for coordinates that aren't finite.
  PostureFit fit(const std::vector<std::optional<Vec3>>& measured,
                 const PostureFit* before = nullptr) const;

 private:
  struct Place;
  struct Solved;
  PostureFit fit_checked(const std::vector<std::optional<Vec3>>& measured,
                         const PostureFit* before) const;
  Place place_for(const std::vector<Vec3>& model,
                  const std::vector<std::optional<Vec3>>& measured) const;
  Solved solve(const std::vector<std::optional<Vec3>>& measured, const std::vector<double>& weight,
               const std::vector<char>& is_held, const Place& start, int max_iterations) const;
  std::vector<double> residuals(const std::vector<std::optional<Vec3>>& measured,
                                const Place& place) const;

  Skeleton skeleton_;
  PosablePoints points_;
  PostureFitOptions options_;
  Posture reference_;
  std::vector<Posture> starts_;
};

}  // namespace palmar::hand
