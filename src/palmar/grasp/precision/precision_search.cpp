// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/precision_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/precision/cost_order.h"

namespace palmar::grasp {
namespace {

constexpr int kTurns = kOpposedTurns;
constexpr std::size_t kFinalists = 40;
constexpr std::size_t kPerPair = 3;  // finalists
constexpr std::size_t kStarts = 8;   // for given points
constexpr double kClashRate = 0.12;  // cost per mm of a coarse look
constexpr double kStrainUnit = 10.0;
constexpr double kTiltUnit = 40.0 * geometry::kDegree;
constexpr double kClashUnit = 1.0;  // mm
constexpr double kMissUnit = 0.5;   // mm
constexpr double kBalanceUnit = 30.0 * geometry::kDegree;
constexpr double kOffsetUnit = 10.0;     // mm
constexpr double kPenLean = 0.4;         // cost of a pen perpendicular to the way it likes to lean
constexpr double kAxisWeight = 2.0;      // of the asked axis
constexpr double kDiscWeight = 3.0;      // of a disc's axis off the way fingers hold it
constexpr double kDiscEnd = 8.0;         // mm from the end of a long body to fingertips on its rim
constexpr double kDiscLong = 15.0;       // mm from its centre; a shorter one is held in the middle
constexpr double kPenPlace = 32.0;       // mm behind the tip are fingertips that write ...
constexpr double kPenPlaceShare = 0.28;  // ... or this share of the length if that is less
constexpr double kWebUnit = 4.0;         // mm; cost of a pen that doesn't lean over the web
constexpr double kWristWeight = 4.0;     // of the side on which the wrist is to be
constexpr double kLikeShift = 12.0;      // mm; holds nearer than that ...
constexpr double kLikeTurn = 25.0 * geometry::kDegree;  // ... and turned less are the same
constexpr std::size_t kMostHolds = 8;

/// Directions of a hand about which placements are said.
struct HandAxes {
  Vec3 radial, distal, dorsal;  ///< unit
};

HandAxes hand_axes(const hand::Skeleton& skeleton) {
  HandAxes axes;
  axes.radial = (skeleton.joint(hand::JointId::kIndexMcp).centre -
                 skeleton.joint(hand::JointId::kLittleMcp).centre)
                    .normalized();
  axes.distal = Vec3::UnitY();
  axes.dorsal = -Vec3::UnitZ();
  return axes;
}

/// Turns go the other way round for a left hand, so that it tries what a right hand would in the
/// mirror, in the same order.
double turn_sign(const hand::Hand& hand) { return hand.side == hand::Side::kLeft ? -1.0 : 1.0; }

/// Rotation that takes `in_hand` to `in_product` and turns by `turn` about that.
Quat aligned(const Vec3& in_hand, const Vec3& in_product, const Vec3& zero, double turn) {
  const auto frame = [](const Vec3& z, const Vec3& towards) {
    Eigen::Matrix3d axes;
    axes.col(2) = z;
    axes.col(0) = (towards - z * z.dot(towards)).normalized();
    axes.col(1) = z.cross(axes.col(0));
    return axes;
  };
  const Eigen::Matrix3d to =
      frame(in_product, zero) * Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  // Any direction of the hand will do, as long as it isn't the axis itself.
  const Vec3 towards = std::abs(in_hand.z()) < 0.8 ? Vec3::UnitZ() : Vec3::UnitY();
  return Quat(Eigen::Matrix3d(to * frame(in_hand, towards).transpose())).normalized();
}

/// Rigid motion that places the hand's opening on two points, the thumb at `thumb`.
geometry::Rigid3 placed_opening(const GripOpening& opening, const Vec3& radial, const Vec3& thumb,
                                const Vec3& other, const Vec3& zero, double turn) {
  const auto frame = [](const Vec3& z, const Vec3& towards) {
    Eigen::Matrix3d axes;
    axes.col(2) = z;
    axes.col(0) = (towards - z * z.dot(towards)).normalized();
    axes.col(1) = z.cross(axes.col(0));
    return axes;
  };
  const Vec3 z = (other - thumb).normalized();
  const Eigen::Matrix3d in_hand = frame((opening.others - opening.thumb).normalized(), radial);
  const Eigen::Matrix3d in_product =
      frame(z, zero) * Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  geometry::Rigid3 result;
  result.rotation = Quat(Eigen::Matrix3d(in_product * in_hand.transpose())).normalized();
  result.translation =
      0.5 * (thumb + other) - result.rotation * Vec3(0.5 * (opening.thumb + opening.others));
  return result;
}

/// The product's principal axis that is most nearly perpendicular to a direction; turns are counted
/// from it.
Vec3 zero_for(const PinchShape& shape, const Vec3& direction) {
  int best = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::abs(shape.axes.col(c).dot(direction)) <
        std::abs(shape.axes.col(best).dot(direction)) - 1e-3) {
      best = c;
    }
  }
  return shape.axes.col(best);
}

// What a hold costs by its fingertips, wherever on the product it is.
double fingertip_cost(const FingertipSolution& solution, std::size_t count) {
  double cost = solution.strain / kStrainUnit;
  cost += std::pow(solution.clash / kClashUnit, 2);
  Vec3 others = Vec3::Zero(), push = Vec3::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    cost += 0.5 * std::pow(solution.tilt[k] / kTiltUnit, 2);
    cost += std::pow(solution.miss[k] / kMissUnit, 2);
    if (k == 0) continue;
    others += solution.reached[k] / static_cast<double>(count - 1);
    push -= solution.normal[k];
  }
  if (solution.miss.size() > count) cost += std::pow(solution.miss[count] / kWebUnit, 2);
  const Vec3 thumb = -solution.normal[0];
  const double balance = std::atan2(thumb.cross(-push).norm(), thumb.dot(-push));
  cost += std::pow(balance / kBalanceUnit, 2);
  const Vec3 arm = others - solution.reached[0];
  cost += std::pow((arm - thumb * thumb.dot(arm)).norm() / kOffsetUnit, 2);
  return cost;
}

struct Candidate {
  std::size_t pair = 0;
  int way = 0;  ///< which side the thumb is on, and the turn
  Vec3 thumb, other;
  geometry::Rigid3 product_from_hand;
  double cost = 0.0;
};

class Search {
 public:
  Search(const FingertipIk& ik, const GripOpenings& openings, const product::Product& product,
         const PrecisionGripOptions& options)
      : ik_(&ik),
        openings_(&openings),
        product_(&product),
        options_(&options),
        shape_(pinch_shape(product.mesh)),
        axes_(hand_axes(ik.hand().skeleton)) {}

  PrecisionSearch run(const Progress& progress) const;

 private:
  std::vector<OpposingPair> pairs(double& widest) const;
  std::vector<Candidate> opposed(const std::vector<OpposingPair>& all,
                                 const Progress& progress) const;
  PrecisionSearch write(const Progress& progress) const;
  double placing_cost(const geometry::Rigid3& product_from_hand) const;
  PrecisionHold set_down_on(const Candidate& candidate, const OpposingPair& pair) const;
  double hold_cost(const PrecisionHold& hold) const;

  const FingertipIk* ik_;
  const GripOpenings* openings_;
  const product::Product* product_;
  const PrecisionGripOptions* options_;
  PinchShape shape_;
  HandAxes axes_;
};

std::vector<OpposingPair> Search::pairs(double& widest) const {
  const bool is_lateral = openings_->grip() == Grip::kLateral;
  const bool is_disc = openings_->grip() == Grip::kPrecisionDisk;
  const bool is_ball = is_disc || openings_->grip() == Grip::kPrecisionSphere;
  const double length = ik_->hand().dimensions.hand_length;
  OpposingOptions options;
  options.widest = std::min(openings_->widest() + 4.0, is_lateral ? 0.25 * length : 0.55 * length);
  options.comfortable = (is_lateral ? 0.06 : is_ball ? 0.40 : 0.28) * length;
  options.central = is_lateral ? 0.5 : 1.0;
  options.most = options_->candidates;
  options.at = options_->placement.at;
  widest = options.widest;
  if (is_disc) {
    for (const Vec3& axis : shape_.disc_axes) {
      double low = 0.0, high = 0.0;
      for (const Vec3& v : product_->mesh.vertices) {
        low = std::min(low, axis.dot(v - shape_.centre));
        high = std::max(high, axis.dot(v - shape_.centre));
      }
      if (std::max(high, -low) < kDiscLong) {
        options.places.push_back(shape_.centre);
      } else {
        options.places.push_back(shape_.centre + (high - kDiscEnd) * axis);
        options.places.push_back(shape_.centre + (low + kDiscEnd) * axis);
      }
    }
  }
  return find_opposing_pairs(*product_, shape_, options);
}

double Search::placing_cost(const geometry::Rigid3& product_from_hand) const {
  double cost = 0.0;
  if (options_->placement.axis) {
    const Vec3 radial = product_from_hand.rotation * axes_.radial;
    cost += kAxisWeight * (1.0 - radial.dot(options_->placement.axis->normalized()));
  }
  if (openings_->grip() == Grip::kPrecisionDisk) {
    const Vec3 held = product_from_hand.rotation * openings_->all().front().axis;
    double along = 0.0;
    for (const Vec3& axis : shape_.disc_axes) along = std::max(along, std::abs(held.dot(axis)));
    cost += kDiscWeight * (1.0 - along);
  }
  const bool leans = openings_->grip() == Grip::kTripod || openings_->fingertips().size() == 2;
  if (shape_.is_pen && leans && openings_->grip() != Grip::kLateral) {
    // The far end of a pen lies on the web between thumb and index finger or sticks out over it.
    const Vec3 grip = product_from_hand * Vec3(openings_->all().front().thumb);
    const Vec3& tip = *std::min_element(
        shape_.tips.begin(), shape_.tips.end(),
        [&](const Vec3& a, const Vec3& b) { return (a - grip).norm() < (b - grip).norm(); });
    const Vec3 back = product_from_hand.rotation.conjugate() * (shape_.centre - tip).normalized();
    const Vec3 lean = (0.6 * axes_.radial - 0.45 * axes_.distal + 0.65 * axes_.dorsal).normalized();
    cost += kPenLean * (1.0 - back.dot(lean));
  }
  return cost;
}

PrecisionHold Search::set_down_on(const Candidate& candidate, const OpposingPair& pair) const {
  PrecisionHold hold = set_down(*ik_, *openings_, *product_,
                                {candidate.thumb, candidate.other, candidate.product_from_hand});
  hold.cost += pair.cost + openings_->at(pair.width()).strain / kStrainUnit +
               placing_cost(hold.solution.product_from_hand);
  return hold;
}

double Search::hold_cost(const PrecisionHold& hold) const {
  return placing_cost(hold.solution.product_from_hand) +
         fingertip_cost(hold.solution, openings_->fingertips().size());
}

bool is_like(const PrecisionHold& a, const PrecisionHold& b) {
  const geometry::Rigid3& p = a.solution.product_from_hand;
  const geometry::Rigid3& q = b.solution.product_from_hand;
  Vec3 shift = Vec3::Zero();
  for (std::size_t k = 0; k < a.solution.reached.size(); ++k) {
    shift += (a.solution.reached[k] - b.solution.reached[k]) /
             static_cast<double>(a.solution.reached.size());
  }
  return shift.norm() < kLikeShift && p.rotation.angularDistance(q.rotation) < kLikeTurn;
}

void sort_and_thin(std::vector<PrecisionHold>& holds) {
  sort_by_cost(holds, kIteratedTie, [](const PrecisionHold& hold) { return hold.cost; });
  std::vector<PrecisionHold> kept;
  for (PrecisionHold& hold : holds) {
    if (kept.size() == kMostHolds) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(),
                                     [&](const PrecisionHold& one) { return is_like(one, hold); });
    if (is_new) kept.push_back(std::move(hold));
  }
  holds = std::move(kept);
}

double width_of(const FingertipSolution& solution, std::size_t count) {
  Vec3 others = Vec3::Zero();
  for (std::size_t k = 1; k < count; ++k) {
    others += solution.reached[k] / static_cast<double>(count - 1);
  }
  return (others - solution.reached[0]).norm();
}

std::vector<Candidate> Search::opposed(const std::vector<OpposingPair>& all,
                                       const Progress& progress) const {
  std::vector<Candidate> candidates;
  const double sign = turn_sign(ik_->hand());
  for (std::size_t i = 0; i < all.size(); ++i) {
    progress.throw_if_cancelled();
    const OpposingPair& pair = all[i];
    const GripOpening& opening = openings_->at(pair.width());
    for (const bool is_swapped : {false, true}) {
      Candidate one;
      one.pair = i;
      one.thumb = is_swapped ? pair.b : pair.a;
      one.other = is_swapped ? pair.a : pair.b;
      const Vec3 zero = zero_for(shape_, (one.other - one.thumb).normalized());
      for (int turn = 0; turn < kTurns; ++turn) {
        one.product_from_hand = placed_opening(opening, axes_.radial, one.thumb, one.other, zero,
                                               sign * 2.0 * std::numbers::pi * turn / kTurns);
        one.way = turn + (is_swapped ? kTurns : 0);
        const double clash = ik_->clash_of(*product_->distance, opening.posture,
                                           one.product_from_hand, openings_->fingertips());
        one.cost = pair.cost + opening.strain / kStrainUnit + kClashRate * clash +
                   placing_cost(one.product_from_hand);
        candidates.push_back(one);
      }
    }
  }
  return candidates;
}

/// The writing tripod: behind each end that may write, the hand turned all round the pen.
PrecisionSearch Search::write(const Progress& progress) const {
  PrecisionSearch result;
  result.widest = openings_->widest();
  if (!shape_.is_pen) return result;
  const double length = shape_.upper.x() - shape_.lower.x();
  for (const Vec3& tip : shape_.tips) {
    const Vec3 back = (shape_.centre - tip).normalized();
    Vec3 place = tip + std::min(kPenPlace, kPenPlaceShare * length) * back;
    if (options_->placement.at) place = tip + back * back.dot(*options_->placement.at - tip);
    const double width = std::max(1.0, -2.0 * product_->distance->at(place).distance);
    if (width > openings_->widest() + 4.0) continue;
    const GripOpening& opening = openings_->at(width);
    const hand::PosedSkeleton posed = hand::pose_skeleton(ik_->hand().skeleton, opening.posture);
    for (int turn = 0; turn < kTurns; ++turn) {
      progress.throw_if_cancelled();
      PrecisionHold hold;
      FingertipProblem& problem = hold.problem;
      problem.product = product_->distance.get();
      problem.natural = problem.start = opening.posture;
      geometry::Rigid3& placed = problem.product_from_hand;
      placed.rotation = aligned(opening.axis, back, shape_.axes.col(1),
                                turn_sign(ik_->hand()) * 2.0 * std::numbers::pi * turn / kTurns);
      placed.translation = place - placed.rotation * opening.centre;
      const auto there = [&](const FingertipPoint& tip_point) -> Vec3 {
        return placed * (posed.segment[index_of(tip_point.segment)] * tip_point.point);
      };
      for (const FingertipPoint& fingertip : openings_->fingertips()) {
        FingertipGoal goal;
        goal.fingertip = fingertip;
        goal.is_sliding = true;
        goal.square = kBallSquare;
        goal.point = product_->distance->at(there(fingertip)).closest;
        problem.goals.push_back(goal);
      }
      FingertipGoal web = web_goal(ik_->hand());
      web.point = product_->distance->at(there(web.fingertip)).closest;
      problem.goals.push_back(web);
      hold.solution = ik_->solve(problem);
      hold.width = width;
      hold.cost = hold_cost(hold);
      result.holds.push_back(std::move(hold));
    }
  }
  result.candidates = static_cast<int>(result.holds.size());
  result.pairs = result.candidates;
  sort_and_thin(result.holds);
  return result;
}

PrecisionSearch Search::run(const Progress& progress) const {
  if (openings_->grip() == Grip::kWritingTripod) return write(progress);
  PrecisionSearch result;
  const std::vector<OpposingPair> all = pairs(result.widest);
  result.pairs = static_cast<int>(all.size());
  std::vector<Candidate> candidates = opposed(all, progress);
  result.candidates = static_cast<int>(candidates.size());
  sort_by_cost(candidates, kRoundedTie, [](const Candidate& one) { return one.cost; });
  std::vector<std::vector<int>> used(all.size());
  std::size_t taken = 0;
  for (const Candidate& candidate : candidates) {
    if (taken == kFinalists) break;
    std::vector<int>& ways = used[candidate.pair];
    // Neighbouring turns slide to the same end.
    const bool is_like = std::any_of(ways.begin(), ways.end(), [&](int way) {
      const int apart = std::abs(way - candidate.way) % kTurns;
      return way / kTurns == candidate.way / kTurns && std::min(apart, kTurns - apart) < 2;
    });
    if (ways.size() == kPerPair || is_like) continue;
    ways.push_back(candidate.way);
    progress.throw_if_cancelled();
    ++taken;
    result.holds.push_back(set_down_on(candidate, all[candidate.pair]));
    result.holds.back().width =
        width_of(result.holds.back().solution, openings_->fingertips().size());
  }
  sort_and_thin(result.holds);
  return result;
}

// The wrist off where it is to be.
double wrist_cost(const geometry::Rigid3& product_from_hand, const Vec3& middle,
                  const Vec3& wanted) {
  const Vec3 wrist = product_from_hand.translation - middle;  // the hand's origin is its wrist
  return kWristWeight * (1.0 - wanted.dot(wrist) / std::max(wrist.norm(), 1e-9));
}

}  // namespace

OpposedPlace opposed_place(const hand::Hand& hand, const GripOpening& opening,
                           const PinchShape& shape, const Vec3& thumb, const Vec3& others,
                           int turn) {
  const Vec3 zero = zero_for(shape, (others - thumb).normalized());
  const double angle = turn_sign(hand) * 2.0 * std::numbers::pi * turn / kTurns;
  return {thumb, others,
          placed_opening(opening, hand_axes(hand.skeleton).radial, thumb, others, zero, angle)};
}

PrecisionHold set_down(const FingertipIk& ik, const GripOpenings& openings,
                       const product::Product& product, const OpposedPlace& place) {
  const double width = (place.others - place.thumb).norm();
  const GripOpening& opening = openings.at(width);
  const std::vector<FingertipPoint>& tips = openings.fingertips();
  PrecisionHold hold;
  hold.width = width;
  FingertipProblem& problem = hold.problem;
  problem.product = product.distance.get();
  problem.natural = opening.posture;
  problem.start = opening.posture;
  problem.product_from_hand = place.product_from_hand;
  const hand::PosedSkeleton posed = hand::pose_skeleton(ik.hand().skeleton, opening.posture);
  for (const FingertipPoint& tip : tips) {
    FingertipGoal goal;
    goal.fingertip = tip;
    goal.is_sliding = true;
    if (tips.size() == 5) {
      goal.slide = kBallSlide;
      goal.square = kBallSquare;
    }
    const Vec3 there = place.product_from_hand * (posed.segment[index_of(tip.segment)] * tip.point);
    goal.point = tip.finger == hand::Finger::kThumb ? place.thumb
                 : tips.size() == 2                 ? place.others
                                                    : product.distance->at(there).closest;
    problem.goals.push_back(goal);
  }
  hold.solution = ik.solve(problem);
  hold.cost = fingertip_cost(hold.solution, tips.size());
  return hold;
}

PrecisionSearch search_precision_grip(const FingertipIk& ik, const GripOpenings& openings,
                                      const product::Product& product,
                                      const PrecisionGripOptions& options,
                                      const Progress& progress) {
  return Search(ik, openings, product, options).run(progress);
}

PrecisionSearch solve_precision_targets(const FingertipIk& ik, const GripOpenings& openings,
                                        const product::Product& product,
                                        const std::vector<FingertipGoal>& goals,
                                        const std::optional<Vec3>& wrist,
                                        const Progress& progress) {
  PrecisionSearch result;
  result.pairs = 1;
  const PinchShape shape = pinch_shape(product.mesh);
  const HandAxes axes = hand_axes(ik.hand().skeleton);
  const Vec3 thumb = goals[0].point;
  Vec3 other = Vec3::Zero();
  for (std::size_t k = 1; k < goals.size(); ++k) {
    other += goals[k].point / static_cast<double>(goals.size() - 1);
  }
  // Points on one spot have no line between them: any will do to start from.
  if ((other - thumb).norm() < 0.1) other = thumb - 0.1 * goals[0].normal.value_or(Vec3::UnitZ());
  const GripOpening& opening = openings.at((other - thumb).norm());
  const Vec3 zero = zero_for(shape, (other - thumb).normalized());
  const double sign = turn_sign(ik.hand());
  const bool is_writing = openings.grip() == Grip::kWritingTripod;
  std::vector<Candidate> candidates;
  const hand::PosedSkeleton posed = hand::pose_skeleton(ik.hand().skeleton, opening.posture);
  for (int turn = 0; turn < 2 * kTurns; ++turn) {
    Candidate one;
    const double angle = sign * std::numbers::pi * turn / kTurns;
    one.product_from_hand = placed_opening(opening, axes.radial, thumb, other, zero, angle);
    if (is_writing) {
      // The pen's long end over the web; which end is long is seen from where the points are.
      const Vec3 middle = (thumb + 2.0 * other) / 3.0;
      const double along = shape.axes.col(0).dot(shape.centre - middle);
      const Vec3 back = (along < 0.0 ? -1.0 : 1.0) * shape.axes.col(0);
      one.product_from_hand.rotation = aligned(opening.axis, back, shape.axes.col(1), 2.0 * angle);
      one.product_from_hand.translation =
          middle -
          one.product_from_hand.rotation * Vec3((opening.thumb + 2.0 * opening.others) / 3.0);
    }
    one.cost = 0.1 * kClashRate *
               ik.clash_of(*product.distance, opening.posture, one.product_from_hand,
                           openings.fingertips());
    for (const FingertipGoal& goal : goals) {
      const Vec3 there = one.product_from_hand *
                         (posed.segment[index_of(goal.fingertip.segment)] * goal.fingertip.point);
      one.cost += (there - goal.point).squaredNorm() / 400.0;
    }
    if (wrist) one.cost += wrist_cost(one.product_from_hand, 0.5 * (thumb + other), *wrist);
    candidates.push_back(one);
  }
  result.candidates = static_cast<int>(candidates.size());
  sort_by_cost(candidates, kRoundedTie, [](const Candidate& one) { return one.cost; });
  for (std::size_t i = 0; i < std::min(kStarts, candidates.size()); ++i) {
    progress.throw_if_cancelled();
    PrecisionHold hold;
    hold.problem.goals = goals;
    hold.problem.product = product.distance.get();
    hold.problem.natural = hold.problem.start = opening.posture;
    hold.problem.product_from_hand = candidates[i].product_from_hand;
    hold.problem.max_iterations = 150;
    if (is_writing) {
      FingertipGoal web = web_goal(ik.hand());
      const Vec3 there = candidates[i].product_from_hand *
                         (posed.segment[index_of(web.fingertip.segment)] * web.fingertip.point);
      web.point = product.distance->at(there).closest;
      hold.problem.goals.push_back(web);
    }
    hold.solution = ik.solve(hold.problem);
    hold.width = (other - thumb).norm();
    for (std::size_t k = 0; k < goals.size(); ++k) {
      hold.cost += std::pow(hold.solution.miss[k] / kMissUnit, 2) +
                   0.5 * std::pow(hold.solution.tilt[k] / kTiltUnit, 2);
    }
    hold.cost += std::pow(hold.solution.clash / kClashUnit, 2) + hold.solution.strain / kStrainUnit;
    if (wrist) {
      hold.cost += wrist_cost(hold.solution.product_from_hand, 0.5 * (thumb + other), *wrist);
    }
    result.holds.push_back(hold);
  }
  sort_and_thin(result.holds);
  return result;
}

}  // namespace palmar::grasp
