// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/instance/hand_instance.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/hand/instance/instance_problem.h"

namespace palmar::hand {
namespace {

constexpr double kAllowedMiss = 0.1;  // mm
constexpr double kSolvedMiss = 0.01;  // mm; a tenth of it, for what the search doesn't see
constexpr int kMostIterations = 25;
constexpr double kRoomyWidth = 1.15;  // of a finger against the palm; less never crossed itself

}  // namespace

struct HandInstanceMaker::Impl {
  explicit Impl(const Hand& base) : shape(base) {}

  struct Found;
  Found search(const InstanceProblem& problem) const;
  /// What is too wide beside the palm, or nothing.
  static std::string crowding(const SegmentScales& scales);

  InstanceShape shape;
};

HandInstanceMaker::HandInstanceMaker(const Hand& base) : impl_(std::make_unique<Impl>(base)) {}
HandInstanceMaker::~HandInstanceMaker() = default;
HandInstanceMaker::HandInstanceMaker(HandInstanceMaker&&) noexcept = default;
HandInstanceMaker& HandInstanceMaker::operator=(HandInstanceMaker&&) noexcept = default;

struct HandInstanceMaker::Impl::Found {
  SegmentScales scales;
  HandDimensions measured;
  int iterations = 0;
};

HandInstanceMaker::Impl::Found HandInstanceMaker::Impl::search(
    const InstanceProblem& problem) const {
  const auto n = static_cast<Eigen::Index>(problem.equation.size());
  Eigen::VectorXd u = problem.start;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual(n), last_residual, last_step;
  Found found;
  while (true) {
    found.scales = problem.scales(u);
    found.measured = shape.measured(found.scales);
    double miss = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const SizedDimension& d = problem.equation[i];
      const double value = value_of(found.measured, d.dimension);
      if (!(value > 0.0)) {
        throw NumericalError(fmt::format("{} comes out as {:.1f} mm", name_of(d.dimension), value));
      }
      residual[i] = std::log(value / d.value);
      miss = std::max(miss, std::abs(value - d.value));
    }
    // Where a crease jumps from one web to the other, the last hundredth may stay out of reach.
    const bool is_patient = found.iterations < 6;
    if (miss <= (is_patient ? kSolvedMiss : 0.5 * kAllowedMiss)) return found;
    if (found.iterations == kMostIterations) return found;
    if (found.iterations == 0) {
      jacobian = shape.sensitivity(problem);
    } else {
      // Broyden (1965): the least change that explains the last step.
      jacobian += (residual - last_residual - jacobian * last_step) * last_step.transpose() /
                  last_step.squaredNorm();
    }
    last_residual = residual;
    constexpr double kLongestStep = 0.3;  // of a logarithm
    last_step = -jacobian.partialPivLu().solve(residual);
    last_step = last_step.cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
    u += last_step;
    ++found.iterations;
  }
}

// Fingers that grow beside a palm that doesn't run out of room.
std::string HandInstanceMaker::Impl::crowding(const SegmentScales& scales) {
  double most = kRoomyWidth;
  std::string text;
  for (const Finger f : {Finger::kIndex, Finger::kMiddle, Finger::kRing, Finger::kLittle}) {
    for (const auto& segment : segments_of(f)) {
      const double ratio = scales.segment[index_of(*segment)].across /
                           scales.segment[index_of(Segment::kPalm)].across;
      if (!(ratio > most)) continue;
      most = ratio;
      text = fmt::format(
          "{} gets {:.2f} times as wide, against the palm, as in the hand that is scaled; where "
          "fingers need more room than there is, about {:.2f} is allowed",
          name_of(*segment), ratio, kRoomyWidth);
    }
  }
  return text;
}

HandInstance HandInstanceMaker::make(const std::vector<SizedDimension>& targets) const {
  const InstanceShape& shape = impl_->shape;
  const InstanceTargets asked(targets, shape.dimensions());
  const InstanceProblem problem = shape.pose(asked);
  const std::string crowded = Impl::crowding(problem.scales(problem.start));
  const std::string object = "hand \"" + shape.hand().name + "\": ";
  Impl::Found found;
  try {
    found = impl_->search(problem);
  } catch (const Error& error) {  // a finger too thick to have a crease, say
    if (!crowded.empty()) throw UsageError(object + crowded);
    throw NumericalError(object + "no hand of these dimensions was found: " + error.what());
  }
  HandInstance instance;
  instance.iterations = found.iterations;
  std::string worst;
  for (const SizedDimension& t : targets) {
    const double value = value_of(found.measured, t.dimension);
    instance.driven.push_back({t.dimension, t.value, value});
    const double miss = std::abs(value - t.value);
    if (miss <= instance.largest_miss) continue;
    instance.largest_miss = miss;
    worst =
        fmt::format("{} of {:.1f} mm comes out as {:.2f} mm", name_of(t.dimension), t.value, value);
  }
  if (instance.largest_miss > kAllowedMiss) {
    if (!problem.meets_length && worst.starts_with("hand_length")) {
      throw UsageError(
          "dimensions contradict each other: palm_length and the three lengths of the middle "
          "finger are all given, and with them " +
          worst + "; 0.1 mm is allowed");
    }
    if (!crowded.empty()) throw UsageError(object + crowded);
    throw NumericalError(object + worst + " beside the other dimensions; 0.1 mm is allowed");
  }
  instance.hand = shape.scaling().hand(found.scales);
  instance.hand.dimensions = found.measured;
  if (!crowded.empty() && !geometry::find_self_crossings(instance.hand.skin).empty()) {
    throw UsageError(object + "the skin crosses itself: " + crowded);
  }
  if (!targets.empty()) instance.hand.provenance += "; " + asked.summary();
  return instance;
}

HandInstance make_hand_instance(const Hand& base, const std::vector<SizedDimension>& targets) {
  return HandInstanceMaker(base).make(targets);
}

}  // namespace palmar::hand
