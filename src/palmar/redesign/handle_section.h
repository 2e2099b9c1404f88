// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::redesign {

/// Where an outline is narrower than a disc.
struct SectionRidge {
  Eigen::Vector2d apex = Eigen::Vector2d::Zero();  ///< its tip, mm
  double way = 0.0;                                ///< of the tip along the outline, mm
  double radius = 0.0;                             ///< of its tip, mm, about
};

/// A disc inside that touches both flanks of a ridge.
struct TouchingDisc {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d touch_first, touch_second;  ///< unit, from the centre to where it touches
};

/// The outline of a handle across its axis: the largest closed curve of the section with a plane.
class HandleSection {
 public:
  /// `first` and `second` are unit vectors of the plane; the outline's coordinates are along them.
  /// Throws UsageError if the plane cuts no closed curve.
  HandleSection(const geometry::TriangleMesh& mesh, const Vec3& point, const Vec3& axis,
                const Vec3& first, const Vec3& second);

  /// Radius of the largest disc inside, mm; to 0.1 %.
  double largest_disc() const { return largest_disc_; }
  /// Ridges that a disc of `radius` doesn't reach into, as the outline runs.
  std::vector<SectionRidge> ridges(double radius) const;
  /// The one nearest to a point, within 10 mm.
  std::optional<SectionRidge> ridge_near(const Eigen::Vector2d& point, double radius) const;
  /// The disc of `radius` that touches both flanks of a ridge; nothing if there is none inside.
  std::optional<TouchingDisc> disc_under(const SectionRidge& ridge, double radius) const;

  const std::vector<Eigen::Vector2d>& outline() const { return outline_; }  ///< counter-clockwise

 private:
  struct Sample {
    Eigen::Vector2d at, inward;
    double way = 0.0;
  };
  /// Nearest point of the outline's part from `from` over `length` mm.
  Eigen::Vector2d nearest(const Eigen::Vector2d& x, double from, double length) const;
  double distance(const Eigen::Vector2d& x) const;
  double tip_radius(double way) const;
  bool is_inside(const Eigen::Vector2d& x) const;

  std::vector<Eigen::Vector2d> outline_;
  std::vector<double> way_;  // of each corner, and the whole length at the end
  std::vector<Sample> samples_;
  double largest_disc_ = 0.0;
};

}  // namespace palmar::redesign
