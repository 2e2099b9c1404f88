// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/hand_instance.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/section.h"
#include "palmar/geometry/self_intersection.h"
#include "palmar/hand/dimensions.h"
#include "palmar/hand/segment_scaling.h"

namespace palmar {
namespace {

constexpr double kAllowedMiss = 0.1;  // mm
constexpr double kSolvedMiss = 0.01;  // mm; a tenth of it, for what the search doesn't see
constexpr int kMostIterations = 25;
// What driven parts of the hand length leave for the others, over what it is in the base; wider
// than half to twice, because everybody's scatter comes together in it.
constexpr double kLeastRest = 0.4, kMostRest = 2.5;
constexpr double kRoomyWidth = 1.15;  // of a finger against the palm; less never crossed itself
// Beyond it the borders of the palm, about a third of that thinner or thicker than in the base, no
// longer look like a hand's.
constexpr double kLeastBow = -0.5, kMostBow = 1.0;

constexpr HandDimension kLength{DimensionKind::kHandLength};
constexpr HandDimension kGirth{DimensionKind::kHandCircumference};
constexpr HandDimension kWidth{DimensionKind::kHandWidth};
constexpr HandDimension kThickness{DimensionKind::kHandThickness};
constexpr HandDimension kPalmLength{DimensionKind::kSegmentLength, Segment::kPalm};

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_middle_finger(Segment s) { return finger_of(s) == Finger::kMiddle; }

// The 46 numbers that make an instance: factors of 15 segments, and the bow of the palm.
constexpr int kBow = 3 * kSegmentCount;
constexpr int kFactorCount = kBow + 1;
int factor_of(DimensionKind kind, Segment segment) {
  const int s = 3 * static_cast<int>(segment);
  if (kind == DimensionKind::kSegmentLength) return s;
  return kind == DimensionKind::kSegmentWidth ? s + 1 : s + 2;
}

// The logarithm of a factor (the bow itself): a constant, or one of the unknowns.
struct Factor {
  double constant = 0.0;
  int unknown = -1;
};
using FactorRules = std::array<Factor, kFactorCount>;

struct Problem {
  FactorRules rule;
  std::vector<SizedDimension> equation;  ///< one per unknown
  Eigen::VectorXd start;
  bool solves_length = true;  ///< hand length is driven, and something is free to meet it
};

// Points of the section that measure_hand() lays the tape round.
std::vector<Vec3> section_at_heads(const TriangleMesh& skin, const Skeleton& skeleton) {
  const Vec3& head2 = skeleton.joint(JointId::kIndexMcp).centre;
  const Vec3& head5 = skeleton.joint(JointId::kLittleMcp).centre;
  const Vec3 radial = (head2 - head5).normalized();
  const Vec3 palmar = (Vec3::UnitZ() - radial.z() * radial).normalized();
  const Vec3 between = 0.5 * (head2 + head5);
  std::vector<Vec3> points;
  double nearest = std::numeric_limits<double>::max();
  for (const SectionCurve& curve :
       plane_section(skin, between, palmar.cross(radial).normalized())) {
    const double d = (curve_centre(curve) - between).norm();
    if (d >= nearest) continue;
    nearest = d;
    points = curve.point;
  }
  return points;
}

class Targets {
 public:
  Targets(const std::vector<SizedDimension>& targets, const HandDimensions& base) : base_(base) {
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

  std::optional<double> get(HandDimension dimension) const {
    for (const SizedDimension& t : sized_) {
      if (t.dimension == dimension) return t.value;
    }
    return std::nullopt;
  }
  bool has(HandDimension dimension) const { return get(dimension).has_value(); }
  double base(HandDimension dimension) const { return value_of(base_, dimension); }
  /// Asked over base's own; 1 if it isn't driven.
  double ratio(HandDimension dimension) const {
    const auto value = get(dimension);
    return value ? *value / base(dimension) : 1.0;
  }
  /// For the provenance; the same in whatever order they were asked.
  std::string told() const {
    constexpr int kMostTold = 6;
    std::string text;
    int told = 0;
    for (const HandDimension dimension : all_hand_dimensions()) {
      if (!has(dimension) || ++told > kMostTold) continue;
      text += fmt::format("{} {} {:.2f} mm", text.empty() ? "" : ",", name_of(dimension),
                          *get(dimension));
    }
    if (told > kMostTold) text += fmt::format(" and {} other dimensions", told - kMostTold);
    return "scaled segment by segment to" + text;
  }

 private:
  HandDimensions base_;
  std::vector<SizedDimension> sized_;
};

}  // namespace

struct HandInstanceMaker::Impl {
  explicit Impl(const Hand& base)
      : hand(&base),
        scaling(base),
        dimensions(measure_hand(base)),
        knuckles(section_at_heads(base.skin, base.skeleton)) {}

  Problem pose(const Targets& targets) const;
  Eigen::MatrixXd sensitivity(const Problem& problem) const;
  static SegmentScales scales(const Problem& problem, const Eigen::VectorXd& u);
  HandDimensions measured(const SegmentScales& scales) const {
    return measure_hand({scaling.skin(scales), hand->skin.triangles}, scaling.skeleton(scales));
  }

  /// Tape round the knuckles of the palm stretched by these factors.
  double girth(const SegmentScales& scales) const;
  void check_girth(const Problem& problem, const Targets& targets) const;
  struct Found;
  Found search(const Problem& problem) const;
  /// What is too wide beside the palm, or nothing.
  static std::string crowding(const SegmentScales& scales);

  const Hand* hand;
  SegmentScaling scaling;
  HandDimensions dimensions;
  std::vector<Vec3> knuckles;  ///< section through the heads of metacarpals II and V
};

Problem HandInstanceMaker::Impl::pose(const Targets& t) const {
  Problem problem;
  std::vector<double> start;
  const auto drive = [&](int factor, HandDimension dimension, double value) {
    problem.rule[at(factor)].unknown = static_cast<int>(start.size());
    problem.equation.push_back({dimension, *t.get(dimension)});
    start.push_back(value);
  };
  const auto follow = [&](int factor, double constant) {
    problem.rule[at(factor)] = {constant, -1};
  };
  const bool has_length = t.has(kLength);
  const bool has_girth = t.has(kGirth) || t.has(kWidth) || t.has(kThickness);
  double girth = 0.0;
  for (const HandDimension d : {kThickness, kWidth, kGirth}) {
    if (t.has(d)) girth = std::log(t.ratio(d));
  }
  double length = std::log(t.ratio(kLength));
  if (!has_length) length = girth;
  if (!has_girth) girth = length;

  // Across the palm.
  const int across = factor_of(DimensionKind::kSegmentWidth, Segment::kPalm);
  const int thick = factor_of(DimensionKind::kSegmentThickness, Segment::kPalm);
  follow(across, girth);
  follow(thick, girth);
  if (t.has(kWidth)) drive(across, kWidth, std::log(t.ratio(kWidth)));
  if (t.has(kThickness)) drive(thick, kThickness, std::log(t.ratio(kThickness)));
  if (t.has(kGirth)) {
    if (t.has(kWidth) && t.has(kThickness)) {
      drive(kBow, kGirth, 0.0);
    } else if (t.has(kWidth)) {
      drive(thick, kGirth, girth);
    } else {
      drive(across, kGirth, girth);
      if (!t.has(kThickness)) problem.rule[at(thick)] = problem.rule[at(across)];
    }
  } else if (t.has(kWidth) && !t.has(kThickness)) {
    problem.rule[at(thick)] = problem.rule[at(across)];
  } else if (t.has(kThickness) && !t.has(kWidth)) {
    problem.rule[at(across)] = problem.rule[at(thick)];
  }

  // Along: what shares the rest of the hand length first.
  double rest_asked = t.get(kLength).value_or(0.0), rest_own = t.base(kLength);
  bool is_shared = false;
  for (const Segment s :
       {Segment::kPalm, Segment::kMiddleProximal, Segment::kMiddleMiddle, Segment::kMiddleDistal}) {
    const HandDimension d{DimensionKind::kSegmentLength, s};
    if (!t.has(d)) {
      is_shared = true;
      continue;
    }
    rest_asked -= *t.get(d);
    rest_own -= t.base(d);
  }
  const bool solves_length = has_length && is_shared;
  problem.solves_length = solves_length || !has_length;
  const double rest = solves_length ? rest_asked / rest_own : 1.0;
  if (!(rest >= kLeastRest && rest <= kMostRest)) {
    throw UsageError(fmt::format(
        "hand_length is {:.1f} mm, which leaves {:.1f} mm for the parts of it that are not given "
        "(palm, segments of the middle finger); {:.1f} to {:.1f} mm is allowed ({:.1f} mm in the "
        "hand "
        "that is scaled)",
        *t.get(kLength), rest_asked, kLeastRest * rest_own, kMostRest * rest_own, rest_own));
  }
  int of_rest = -1;
  for (int i = 0; i < kSegmentCount; ++i) {
    const auto s = static_cast<Segment>(i);
    const HandDimension d{DimensionKind::kSegmentLength, s};
    const int factor = factor_of(DimensionKind::kSegmentLength, s);
    const bool is_part = s == Segment::kPalm || is_middle_finger(s);
    const bool is_of_rest = is_part || (t.has(kPalmLength) && finger_of(s) != Finger::kThumb);
    if (t.has(d)) {
      drive(factor, d, std::log(t.ratio(d)));
    } else if (solves_length && is_of_rest) {
      if (of_rest < 0) {
        drive(factor, kLength, std::log(rest));
        of_rest = problem.rule[at(factor)].unknown;
      }
      problem.rule[at(factor)].unknown = of_rest;
    } else {
      follow(factor, length);
    }
    if (s == Segment::kPalm) continue;
    for (const DimensionKind kind :
         {DimensionKind::kSegmentWidth, DimensionKind::kSegmentThickness}) {
      if (t.has({kind, s})) {
        drive(factor_of(kind, s), {kind, s}, std::log(t.ratio({kind, s})));
      } else {
        follow(factor_of(kind, s), girth);
      }
    }
  }
  problem.start = Eigen::Map<const Eigen::VectorXd>(start.data(), std::ssize(start));
  return problem;
}

SegmentScales HandInstanceMaker::Impl::scales(const Problem& problem, const Eigen::VectorXd& u) {
  SegmentScales result;
  const auto value = [&](int factor) {
    const Factor& rule = problem.rule[at(factor)];
    return rule.unknown >= 0 ? u[rule.unknown] : rule.constant;
  };
  for (int s = 0; s < kSegmentCount; ++s) {
    result.segment[at(s)] = {std::exp(value(3 * s)), std::exp(value(3 * s + 1)),
                             std::exp(value(3 * s + 2))};
  }
  result.bow = value(kBow);
  return result;
}

double HandInstanceMaker::Impl::girth(const SegmentScales& scales) const {
  const auto& joints = hand->skeleton;
  const auto moved = [&](const Vec3& p) { return scaling.in_palm(p, scales); };
  const Vec3 radial = moved(joints.joint(JointId::kIndexMcp).centre) -
                      moved(joints.joint(JointId::kLittleMcp).centre);
  std::vector<Vec3> points;
  points.reserve(knuckles.size());
  for (const Vec3& p : knuckles) points.push_back(moved(p));
  const Vec3 palmar = Vec3::UnitZ() - radial.z() / radial.squaredNorm() * radial;
  return palmar::girth(points, palmar.cross(radial).normalized());
}

// d log(dimension) / d unknown at the start, from what is known of the shape: a segment is made of
// parts of links, its width and thickness follow their factors, and the girth is that of the
// stretched section. What this leaves out (webs, slanted creases) Broyden's updates find.
Eigen::MatrixXd HandInstanceMaker::Impl::sensitivity(const Problem& problem) const {
  const auto n = static_cast<Eigen::Index>(problem.equation.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  const SegmentScales start = scales(problem, problem.start);
  const auto along = [&](Segment s) { return start.segment[static_cast<std::size_t>(s)].along; };
  const auto add = [&](Eigen::Index i, int factor, double slope) {
    const int unknown = problem.rule[at(factor)].unknown;
    if (unknown >= 0) result(i, unknown) += slope;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const HandDimension d = problem.equation[static_cast<std::size_t>(i)].dimension;
    const double value = problem.equation[static_cast<std::size_t>(i)].value;
    switch (d.kind) {
      case DimensionKind::kHandLength: {
        double fingers = 0.0;
        const auto chain = segments_of(Finger::kMiddle);
        const auto& parts = scaling.parts(Finger::kMiddle);
        for (std::size_t k = 0; k < 3; ++k) {
          double link = 0.0;
          for (std::size_t s = 0; s < 3; ++s) link += parts[s][k] * along(*chain[k]);
          add(i, factor_of(DimensionKind::kSegmentLength, *chain[k]), link / value);
          fingers += link;
        }
        add(i, factor_of(DimensionKind::kSegmentLength, Segment::kPalm),
            std::max(0.1, 1.0 - fingers / value));
        break;
      }
      case DimensionKind::kHandCircumference: {
        constexpr double kStep = 1e-4;
        const double before = girth(start);
        for (const int factor :
             {factor_of(DimensionKind::kSegmentWidth, Segment::kPalm),
              factor_of(DimensionKind::kSegmentThickness, Segment::kPalm), kBow}) {
          SegmentScales moved = start;
          auto& palm = moved.segment[static_cast<std::size_t>(Segment::kPalm)];
          if (factor == kBow)
            moved.bow += kStep;
          else if (factor == factor_of(DimensionKind::kSegmentWidth, Segment::kPalm))
            palm.across *= std::exp(kStep);
          else
            palm.thickness *= std::exp(kStep);
          add(i, factor, std::log(girth(moved) / before) / kStep);
        }
        break;
      }
      case DimensionKind::kHandWidth:
        add(i, factor_of(DimensionKind::kSegmentWidth, Segment::kPalm), 1.0);
        break;
      case DimensionKind::kHandThickness:
        add(i, factor_of(DimensionKind::kSegmentThickness, Segment::kPalm), 1.0);
        break;
      case DimensionKind::kSegmentLength: {
        if (d.segment == Segment::kPalm) {
          add(i, factor_of(d.kind, d.segment), 1.0);
          break;
        }
        const Finger finger = *finger_of(d.segment);
        const auto chain = segments_of(finger);
        const auto& parts = scaling.parts(finger);
        for (std::size_t s = 0; s < 3; ++s) {
          if (chain[s] != d.segment) continue;
          double whole = 0.0;
          for (std::size_t k = 0; k < 3 && chain[k]; ++k) whole += parts[s][k] * along(*chain[k]);
          for (std::size_t k = 0; k < 3 && chain[k]; ++k) {
            add(i, factor_of(d.kind, *chain[k]), parts[s][k] * along(*chain[k]) / whole);
          }
        }
        break;
      }
      case DimensionKind::kSegmentWidth:
      case DimensionKind::kSegmentThickness:
        add(i, factor_of(d.kind, d.segment), 1.0);
        break;
    }
  }
  return result;
}

// Beside a given breadth, how far a tape can reach is a matter of thickness, and the other way
// round; beside both, of the borders of the palm.
void HandInstanceMaker::Impl::check_girth(const Problem& problem, const Targets& targets) const {
  if (!targets.has(kGirth) || (!targets.has(kWidth) && !targets.has(kThickness))) return;
  SegmentScales least = scales(problem, problem.start), most = least;
  auto& thin = least.segment[static_cast<std::size_t>(Segment::kPalm)];
  auto& thick = most.segment[static_cast<std::size_t>(Segment::kPalm)];
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

HandInstanceMaker::HandInstanceMaker(const Hand& base) : impl_(std::make_unique<Impl>(base)) {}
HandInstanceMaker::~HandInstanceMaker() = default;
HandInstanceMaker::HandInstanceMaker(HandInstanceMaker&&) noexcept = default;
HandInstanceMaker& HandInstanceMaker::operator=(HandInstanceMaker&&) noexcept = default;

struct HandInstanceMaker::Impl::Found {
  SegmentScales scales;
  HandDimensions measured;
  int iterations = 0;
};

HandInstanceMaker::Impl::Found HandInstanceMaker::Impl::search(const Problem& problem) const {
  const auto n = static_cast<Eigen::Index>(problem.equation.size());
  Eigen::VectorXd u = problem.start;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual(n), last_residual, last_step;
  Found found;
  while (true) {
    found.scales = scales(problem, u);
    found.measured = measured(found.scales);
    double miss = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const SizedDimension& d = problem.equation[static_cast<std::size_t>(i)];
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
      jacobian = sensitivity(problem);
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
      const double ratio = scales.segment[static_cast<std::size_t>(*segment)].across /
                           scales.segment[static_cast<std::size_t>(Segment::kPalm)].across;
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
  const Targets asked(targets, impl_->dimensions);
  const Problem problem = impl_->pose(asked);
  impl_->check_girth(problem, asked);
  const std::string crowded = Impl::crowding(Impl::scales(problem, problem.start));
  const std::string object = "hand \"" + impl_->hand->name + "\": ";
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
    if (!problem.solves_length && worst.starts_with("hand_length")) {
      throw UsageError(
          "dimensions contradict each other: palm_length and the three lengths of the middle "
          "finger are all given, and with them " +
          worst + "; 0.1 mm is allowed");
    }
    if (!crowded.empty()) throw UsageError(object + crowded);
    throw NumericalError(object + worst + " beside the other dimensions; 0.1 mm is allowed");
  }
  instance.hand = impl_->scaling.hand(found.scales);
  instance.hand.dimensions = found.measured;
  if (!crowded.empty() && !find_self_crossings(instance.hand.skin).empty()) {
    throw UsageError(object + "the skin crosses itself: " + crowded);
  }
  if (!targets.empty()) instance.hand.provenance += "; " + asked.told();
  return instance;
}

HandInstance make_hand_instance(const Hand& base, const std::vector<SizedDimension>& targets) {
  return HandInstanceMaker(base).make(targets);
}

}  // namespace palmar
