// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/instance/instance_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/dimensions/dimensions.h"

namespace palmar::hand {
namespace {

// What driven parts of the hand length leave for the others, over what it is in the base; wider
// than half to twice, because everybody's scatter comes together in it.
constexpr double kLeastRest = 0.4, kMostRest = 2.5;
// Beyond it the borders of the palm, about a third of that thinner or thicker than in the base, no
// longer look like a hand's.
constexpr double kLeastBow = -0.5, kMostBow = 1.0;

constexpr HandDimension kHandLength{DimensionKind::kHandLength};
constexpr HandDimension kGirth{DimensionKind::kHandCircumference};
constexpr HandDimension kWidth{DimensionKind::kHandWidth};
constexpr HandDimension kThickness{DimensionKind::kHandThickness};
constexpr HandDimension kPalmLength{DimensionKind::kSegmentLength, Segment::kPalm};

// Place of a segment's factor among those of a problem.
constexpr int factor_of(DimensionKind kind, Segment segment) {
  const int s = 3 * static_cast<int>(segment);
  if (kind == DimensionKind::kSegmentLength) return s;
  return kind == DimensionKind::kSegmentWidth ? s + 1 : s + 2;
}
constexpr int kAcross = factor_of(DimensionKind::kSegmentWidth, Segment::kPalm);
constexpr int kThick = factor_of(DimensionKind::kSegmentThickness, Segment::kPalm);

// Points of the section that measure_hand() places the tape round.
std::vector<Vec3> section_at_heads(const geometry::TriangleMesh& skin, const Skeleton& skeleton) {
  const Vec3& head2 = skeleton.joint(JointId::kIndexMcp).centre;
  const Vec3& head5 = skeleton.joint(JointId::kLittleMcp).centre;
  const Vec3 radial = (head2 - head5).normalized();
  const Vec3 palmar = (Vec3::UnitZ() - radial.z() * radial).normalized();
  const Vec3 between = 0.5 * (head2 + head5);
  std::vector<Vec3> points;
  double nearest = std::numeric_limits<double>::max();
  for (const geometry::SectionCurve& curve :
       geometry::plane_section(skin, between, palmar.cross(radial).normalized())) {
    const double d = (geometry::curve_centre(curve) - between).norm();
    if (d >= nearest) continue;
    nearest = d;
    points = curve.point;
  }
  return points;
}

// Determines which factor is driven by what, and which follow.
class ProblemBuilder {
 public:
  explicit ProblemBuilder(const InstanceTargets& targets) : t_(targets) {
    const bool has_girth = t_.has(kGirth) || t_.has(kWidth) || t_.has(kThickness);
    for (const HandDimension d : {kThickness, kWidth, kGirth}) {
      if (t_.has(d)) girth_ = std::log(t_.ratio(d));
    }
    length_ = t_.has(kHandLength) ? std::log(t_.ratio(kHandLength)) : girth_;
    if (!has_girth) girth_ = length_;
  }

  InstanceProblem build() {
    palm_across();
    lengths();
    for (int i = 1; i < kSegmentCount; ++i) {
      const auto s = static_cast<Segment>(i);
      for (const HandDimension d : {HandDimension{DimensionKind::kSegmentWidth, s},
                                    HandDimension{DimensionKind::kSegmentThickness, s}}) {
        if (t_.has(d)) {
          drive(factor_of(d.kind, s), d, std::log(t_.ratio(d)));
        } else {
          follow(factor_of(d.kind, s), girth_);
        }
      }
    }
    problem_.start = Eigen::Map<const Eigen::VectorXd>(start_.data(), std::ssize(start_));
    return problem_;
  }

 private:
  void drive(int factor, HandDimension dimension, double start) {
    problem_.rule[factor].unknown = static_cast<int>(start_.size());
    problem_.equation.push_back({dimension, *t_.get(dimension)});
    start_.push_back(start);
  }
  void follow(int factor, double constant) { problem_.rule[factor] = {constant, -1}; }

  void palm_across() {
    follow(kAcross, girth_);
    follow(kThick, girth_);
    if (t_.has(kWidth)) drive(kAcross, kWidth, std::log(t_.ratio(kWidth)));
    if (t_.has(kThickness)) drive(kThick, kThickness, std::log(t_.ratio(kThickness)));
    if (t_.has(kGirth)) {
      if (t_.has(kWidth) && t_.has(kThickness)) {
        drive(InstanceProblem::kBow, kGirth, 0.0);
      } else {
        drive(t_.has(kWidth) ? kThick : kAcross, kGirth, girth_);
      }
    }
    // What is driven by one number keeps its shape.
    if (t_.has(kWidth) == t_.has(kThickness)) {
      if (!t_.has(kWidth)) problem_.rule[kThick] = problem_.rule[kAcross];
    } else if (!t_.has(kGirth)) {
      const bool has_width = t_.has(kWidth);
      problem_.rule[has_width ? kThick : kAcross] = problem_.rule[has_width ? kAcross : kThick];
    }
  }

  void lengths() {
    double rest_asked = t_.get(kHandLength).value_or(0.0), rest_own = t_.base(kHandLength);
    int free_parts = 0;
    for (const Segment s : kParts) {
      const HandDimension d{DimensionKind::kSegmentLength, s};
      if (!t_.has(d)) {
        ++free_parts;
        continue;
      }
      rest_asked -= *t_.get(d);
      rest_own -= t_.base(d);
    }
    problem_.meets_length = !t_.has(kHandLength) || free_parts > 0;
    const bool shares = t_.has(kHandLength) && free_parts > 0;
    const double rest = shares ? rest_asked / rest_own : 1.0;
    if (!(rest >= kLeastRest && rest <= kMostRest)) {
      throw UsageError(fmt::format(
          "hand_length is {:.1f} mm, which leaves {:.1f} mm for the parts of it that are not given "
          "(palm, segments of the middle finger); {:.1f} to {:.1f} mm is allowed ({:.1f} mm in the "
          "hand that is scaled)",
          *t_.get(kHandLength), rest_asked, kLeastRest * rest_own, kMostRest * rest_own, rest_own));
    }
    // With the palm alone driven, the whole finger is the rest, and the other fingers grow as it.
    const bool is_of_fingers = t_.has(kPalmLength) && free_parts == 3;
    int of_rest = -1;
    for (int i = 0; i < kSegmentCount; ++i) {
      const auto s = static_cast<Segment>(i);
      const HandDimension d{DimensionKind::kSegmentLength, s};
      const int factor = factor_of(d.kind, s);
      const bool is_of_rest = std::find(kParts.begin(), kParts.end(), s) != kParts.end() ||
                              (is_of_fingers && finger_of(s) != Finger::kThumb);
      if (t_.has(d)) {
        drive(factor, d, std::log(t_.ratio(d)));
      } else if (!shares || !is_of_rest) {
        follow(factor, length_);
      } else if (of_rest < 0) {
        drive(factor, kHandLength, std::log(rest));
        of_rest = problem_.rule[factor].unknown;
      } else {
        problem_.rule[factor].unknown = of_rest;
      }
    }
  }

  /// Of the hand length.
  static constexpr std::array<Segment, 4> kParts = {Segment::kPalm, Segment::kMiddleProximal,
                                                    Segment::kMiddleMiddle, Segment::kMiddleDistal};
  const InstanceTargets& t_;
  double length_ = 0.0, girth_ = 0.0;  ///< logarithms of what lengths and widths follow
  InstanceProblem problem_;
  std::vector<double> start_;
};

}  // namespace

InstanceTargets::InstanceTargets(const std::vector<SizedDimension>& targets,
                                 const HandDimensions& base)
    : base_(base) {
  const auto& all = all_hand_dimensions();
  for (const SizedDimension& t : targets) {
    const std::string name = name_of(t.dimension);
    if (std::find(all.begin(), all.end(), t.dimension) == all.end()) {
      throw UsageError("\"" + name + "\" is not one of the 47 dimensions of a hand");
    }
    const double own = value_of(base, t.dimension);
    if (!(t.value >= 0.5 * own && t.value <= 2.0 * own)) {
      throw UsageError(
          fmt::format("{} is {:.1f} mm; {:.1f} to {:.1f} mm is allowed (half to "
                      "twice the {:.1f} mm of the hand that is scaled)",
                      name, t.value, 0.5 * own, 2.0 * own, own));
    }
    if (get(t.dimension)) {
      throw UsageError(fmt::format("{} is given twice ({:.1f} and {:.1f} mm)", name,
                                   *get(t.dimension), t.value));
    }
    sized_.push_back(t);
  }
}

std::optional<double> InstanceTargets::get(HandDimension dimension) const {
  for (const SizedDimension& t : sized_) {
    if (t.dimension == dimension) return t.value;
  }
  return std::nullopt;
}

double InstanceTargets::ratio(HandDimension dimension) const {
  const auto value = get(dimension);
  return value ? *value / base(dimension) : 1.0;
}

std::string InstanceTargets::summary() const {
  std::string text;
  int of_segments = 0;
  for (const HandDimension dimension : all_hand_dimensions()) {
    if (!has(dimension)) continue;
    if (dimension.kind >= DimensionKind::kSegmentLength) {
      ++of_segments;
      continue;
    }
    std::string name(name_of(dimension));
    std::replace(name.begin(), name.end(), '_', ' ');
    text += fmt::format("{}{} {:.1f} mm", text.empty() ? "" : ", ", name, *get(dimension));
  }
  if (of_segments > 0) {
    text += text.empty() ? "" : " and ";
    text += of_segments == 1 ? "1 dimension of its segments"
                             : fmt::format("{} dimensions of its segments", of_segments);
  }
  return "scaled segment by segment to " + text;
}

SegmentScales InstanceProblem::scales(const Eigen::VectorXd& unknowns) const {
  SegmentScales result;
  const auto value = [&](int factor) {
    const Factor& of = rule[factor];
    return of.unknown >= 0 ? unknowns[of.unknown] : of.constant;
  };
  for (int s = 0; s < kSegmentCount; ++s) {
    result.segment[s] = {std::exp(value(3 * s)), std::exp(value(3 * s + 1)),
                         std::exp(value(3 * s + 2))};
  }
  result.bow = value(kBow);
  return result;
}

InstanceShape::InstanceShape(const Hand& base)
    : hand_(&base),
      scaling_(base),
      dimensions_(measure_hand(base)),
      knuckles_(section_at_heads(base.skin, base.skeleton)) {}

HandDimensions InstanceShape::measured(const SegmentScales& scales) const {
  return measure_hand({scaling_.skin(scales), hand_->skin.triangles}, scaling_.skeleton(scales));
}

InstanceProblem InstanceShape::pose(const InstanceTargets& targets) const {
  InstanceProblem problem = ProblemBuilder(targets).build();
  check_girth(problem, targets);
  return problem;
}

double InstanceShape::girth(const SegmentScales& scales) const {
  const auto& joints = hand_->skeleton;
  const auto moved = [&](const Vec3& p) { return scaling_.in_palm(p, scales); };
  const Vec3 radial = moved(joints.joint(JointId::kIndexMcp).centre) -
                      moved(joints.joint(JointId::kLittleMcp).centre);
  std::vector<Vec3> points;
  points.reserve(knuckles_.size());
  for (const Vec3& p : knuckles_) points.push_back(moved(p));
  const Vec3 palmar = Vec3::UnitZ() - radial.z() / radial.squaredNorm() * radial;
  return geometry::girth(points, palmar.cross(radial).normalized());
}

Eigen::MatrixXd InstanceShape::sensitivity(const InstanceProblem& problem) const {
  const auto n = static_cast<Eigen::Index>(problem.equation.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  const SegmentScales start = problem.scales(problem.start);
  // Lengths of the parts of a segment of a finger after the start's scaling, mm.
  const auto parts = [&](Finger finger, std::size_t segment) {
    std::array<double, 3> length{};
    const auto chain = segments_of(finger);
    for (std::size_t k = 0; k < 3 && chain[k]; ++k) {
      length[k] = scaling_.parts(finger)[segment][k] * start.segment[index_of(*chain[k])].along;
    }
    return length;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto add = [&](int factor, double slope) {
      const int unknown = problem.rule[factor].unknown;
      if (unknown >= 0) result(i, unknown) += slope;
    };
    const auto& [d, value] = problem.equation[i];
    if (d == kHandLength) {
      double fingers = 0.0;
      const auto chain = segments_of(Finger::kMiddle);
      for (std::size_t s = 0; s < 3; ++s) {
        const std::array<double, 3> part = parts(Finger::kMiddle, s);
        for (std::size_t k = 0; k < 3; ++k) {
          add(factor_of(DimensionKind::kSegmentLength, *chain[k]), part[k] / value);
          fingers += part[k];
        }
      }
      add(factor_of(DimensionKind::kSegmentLength, Segment::kPalm),
          std::max(0.1, 1.0 - fingers / value));
    } else if (d == kGirth) {
      constexpr double kStep = 1e-4;
      SegmentScales wider = start, thicker = start, bowed = start;
      wider.segment[index_of(Segment::kPalm)].across *= std::exp(kStep);
      thicker.segment[index_of(Segment::kPalm)].thickness *= std::exp(kStep);
      bowed.bow += kStep;
      const double before = girth(start);
      add(kAcross, std::log(girth(wider) / before) / kStep);
      add(kThick, std::log(girth(thicker) / before) / kStep);
      add(InstanceProblem::kBow, std::log(girth(bowed) / before) / kStep);
    } else if (d == kWidth || d == kThickness) {
      add(d == kWidth ? kAcross : kThick, 1.0);
    } else if (d.kind != DimensionKind::kSegmentLength || d == kPalmLength) {
      add(factor_of(d.kind, d.segment), 1.0);
    } else {
      const Finger finger = *finger_of(d.segment);
      const auto chain = segments_of(finger);
      const auto place = std::find(chain.begin(), chain.end(), d.segment) - chain.begin();
      const std::array<double, 3> part = parts(finger, place);
      const double whole = part[0] + part[1] + part[2];
      for (std::size_t k = 0; k < 3 && chain[k]; ++k) {
        add(factor_of(d.kind, *chain[k]), part[k] / whole);
      }
    }
  }
  return result;
}

// Beside a given breadth, how far a tape can reach is a matter of thickness, and the other way
// round; beside both, of the borders of the palm.
void InstanceShape::check_girth(const InstanceProblem& problem,
                                const InstanceTargets& targets) const {
  if (!targets.has(kGirth) || (!targets.has(kWidth) && !targets.has(kThickness))) return;
  SegmentScales least = problem.scales(problem.start), most = least;
  auto& thin = least.segment[index_of(Segment::kPalm)];
  auto& thick = most.segment[index_of(Segment::kPalm)];
  std::string beside;
  if (targets.has(kWidth) && targets.has(kThickness)) {
    least.bow = kLeastBow;
    most.bow = kMostBow;
    beside = fmt::format("hand_width {:.1f} mm and hand_thickness {:.1f} mm", *targets.get(kWidth),
                         *targets.get(kThickness));
  } else if (targets.has(kWidth)) {
    thin.thickness = 0.5 * thin.across;
    thick.thickness = 2.0 * thick.across;
    beside = fmt::format("hand_width {:.1f} mm", *targets.get(kWidth));
  } else {
    thin.across = 0.5 * thin.thickness;
    thick.across = 2.0 * thick.thickness;
    beside = fmt::format("hand_thickness {:.1f} mm", *targets.get(kThickness));
  }
  const double lowest = girth(least), highest = girth(most);
  const double asked = *targets.get(kGirth);
  if (asked >= lowest && asked <= highest) return;
  throw UsageError(fmt::format(
      "hand_circumference is {:.1f} mm; beside {} {:.1f} to {:.1f} mm is allowed (for a hand of "
      "that section)",
      asked, beside, lowest, highest));
}

}  // namespace palmar::hand
