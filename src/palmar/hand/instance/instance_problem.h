// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/instance/segment_scaling.h"

namespace palmar::hand {

/// The dimensions asked of an instance, held to what a hand that measures `base` can become.
class InstanceTargets {
 public:
  /// Throws UsageError: no dimension of a hand, half to twice its own size exceeded, given twice.
  InstanceTargets(const std::vector<SizedDimension>& targets, const HandDimensions& base);

  std::optional<double> get(HandDimension dimension) const;  ///< mm
  bool has(HandDimension dimension) const { return get(dimension).has_value(); }
  double base(HandDimension dimension) const { return value_of(base_, dimension); }
  /// Asked over base's own; 1 if it isn't driven.
  double ratio(HandDimension dimension) const;
  /// For the provenance; the same in whatever order they were asked.
  std::string summary() const;

 private:
  HandDimensions base_;
  std::vector<SizedDimension> sized_;
};

/// The factors of 15 segments and the bow as functions of as many unknowns as dimensions drive them
/// (docs/method/instances.md). Unknowns are logarithms of factors, and the bow itself.
struct InstanceProblem {
  static constexpr int kBow = 3 * kSegmentCount;  ///< its place in `rule`; before it 3 per segment
  struct Factor {
    double constant = 0.0;
    int unknown = -1;  ///< which one; -1: the constant
  };
  std::array<Factor, kBow + 1> rule;
  std::vector<SizedDimension> equation;  ///< one per unknown
  Eigen::VectorXd start;
  bool meets_length = true;  ///< unless hand length is driven and nothing is free to meet it

  SegmentScales scales(const Eigen::VectorXd& unknowns) const;
};

/// A hand measured and laid out for instances. Keeps a pointer to it.
class InstanceShape {
 public:
  explicit InstanceShape(const Hand& base);

  const Hand& hand() const { return *hand_; }
  const SegmentScaling& scaling() const { return scaling_; }
  const HandDimensions& dimensions() const { return dimensions_; }
  HandDimensions measured(const SegmentScales& scales) const;

  /// What drives what. Throws UsageError for dimensions that contradict each other.
  InstanceProblem pose(const InstanceTargets& targets) const;

  /// d log(dimension) / d unknown at the start (equations x unknowns), from what is known of the
  /// shape: a segment is made of parts of links, its width and thickness follow their factors, and
  /// the girth is that of the stretched section. Leaves out webs and slanted creases.
  Eigen::MatrixXd sensitivity(const InstanceProblem& problem) const;

 private:
  /// Tape round the knuckles of the palm stretched by these factors.
  double girth(const SegmentScales& scales) const;
  void check_girth(const InstanceProblem& problem, const InstanceTargets& targets) const;

  const Hand* hand_;
  SegmentScaling scaling_;
  HandDimensions dimensions_;
  std::vector<Vec3> knuckles_;  ///< section through the heads of metacarpals II and V
};

}  // namespace palmar::hand
