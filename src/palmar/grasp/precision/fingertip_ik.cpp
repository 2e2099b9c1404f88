// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/fingertip_ik.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <span>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/power/finger_motion.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/grasp/precision/posture_terms.h"

namespace palmar::grasp {
namespace {

constexpr int kPlacement = 6;  // unknowns of the hand against the product
constexpr int kFirstDof = static_cast<int>(hand::Dof::kThumbCmcFlexion);
constexpr int kUnknowns = kPlacement + hand::kDofCount - kFirstDof;

using Row = Eigen::Matrix<double, kUnknowns, 1>;
using Square = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr double kBalanceSpread = 0.3;                 // rad; thumb against the others
constexpr double kRangeEnd = 5.0 * geometry::kDegree;  // last part of a range, which hands avoid
constexpr double kEndSpread = 5.0 * geometry::kDegree;
constexpr double kClashSpread = 0.7;  // mm
constexpr double kTouchGive = 1.5;    // mm beyond the depth; a pad is no ball
constexpr double kNextGive = 0.5;     // mm, phalanges next to one that touches
constexpr double kFacingGive = 4.0;   // mm, of thumb and finger on a thin thing
constexpr double kFarOff = 45.0;      // mm; more than any ball
constexpr double kPulp = 4.0;         // mm; radius of the pulp where it slides: rolls over edges
constexpr double kBendStep = 0.5;     // mm
constexpr double kEverywhere = 1e6;   // mm
constexpr double kSmallStep = 1e-7;   // rad or mm
constexpr double kSmallGain = 1e-6;   // relative

struct Stage {
  double reach = 1.0;    // mm
  double natural = 1.0;  // weight of the posture terms
};
constexpr std::array<Stage, 3> kStages = {{{3.0, 1.0}, {0.5, 1.0}, {0.05, 0.3}}};

int column_of(hand::Dof dof) { return kPlacement + static_cast<int>(dof) - kFirstDof; }

hand::Finger finger_of_dof(hand::Dof dof) {
  if (dof <= hand::Dof::kThumbIpFlexion) return hand::Finger::kThumb;
  return static_cast<hand::Finger>(
      1 + (static_cast<int>(dof) - static_cast<int>(hand::Dof::kIndexMcpFlexion)) / 4);
}

/// Two cones that come near each other: nearest points of their lines and the overlap.
struct Crossing {
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();
  double overlap = 0.0;
};

Crossing crossing_of(const RoundCone& p, const RoundCone& q) {
  double s = 0.5, t = 0.5;
  for (int round = 0; round < 4; ++round) {
    t = nearest_share(q.a, q.b, p.a + s * (p.b - p.a));
    s = nearest_share(p.a, p.b, q.a + t * (q.b - q.a));
  }
  Crossing result{p.a + s * (p.b - p.a), q.a + t * (q.b - q.a), 0.0};
  result.overlap = (1.0 - s) * p.radius_a + s * p.radius_b + (1.0 - t) * q.radius_a +
                   t * q.radius_b - (result.p - result.q).norm();
  return result;
}

/// Pairs of fingers that could cross: neighbours, and the thumb with each finger.
bool may_cross(const RoundCone& p, const RoundCone& q) {
  if (p.level == 0 || q.level == 0) return false;
  const int fp = static_cast<int>(p.finger), fq = static_cast<int>(q.finger);
  if (fp >= fq) return false;
  if (p.finger == hand::Finger::kThumb) return q.level >= 1;
  return fq == fp + 1;
}

}  // namespace

/// Residuals of one problem in one state, summed up as normal equations.
class FingertipSystem {
 public:
  FingertipSystem(const FingertipIk& ik, const FingertipProblem& problem)
      : ik_(&ik), problem_(&problem), terms_(posture_terms(problem.natural)) {
    for (const FingertipGoal& goal : problem.goals) {
      pivot_ += goal.point / static_cast<double>(problem.goals.size());
    }
    is_contact_.fill(false);
    for (const FingertipGoal& goal : problem.goals) {
      is_contact_[index_of(goal.fingertip.segment)] = true;
      depth_[index_of(goal.fingertip.segment)] = goal.depth;
    }
    lower_.setConstant(-1e9);
    upper_.setConstant(1e9);
    is_free_.fill(problem.is_hand_free);
    for (int d = kFirstDof; d < hand::kDofCount; ++d) {
      const hand::JointDof& dof = ik.hand().skeleton.dof(static_cast<hand::Dof>(d));
      const auto column = column_of(dof.dof);
      lower_[column_of(dof.dof)] = dof.lower;
      upper_[column_of(dof.dof)] = dof.upper;
      is_free_[column] =
          problem.is_finger_free[index_of(finger_of_dof(dof.dof))] && dof.upper > dof.lower;
    }
  }

  struct State {
    hand::Posture posture;
    geometry::Rigid3 product_from_hand;
  };

  void evaluate(const State& state, const Stage& stage, double& cost, Square* h, Row* g);
  FingertipSolution solution(const State& state);
  FingertipSolution solve();

 private:
  void add(double residual, const Row& row) {
    cost_ += residual * residual;
    if (h_ == nullptr) return;
    h_->selfadjointView<Eigen::Lower>().rankUpdate(row);
    *g_ += residual * row;
  }
  /// Derivatives of a point of a part (product frame) along `direction`.
  void point_row(const State& state, const std::vector<DofMotion>& moving, const Vec3& in_hand,
                 const Vec3& direction, double factor, Row& row) const {
    const Vec3 in_product = state.product_from_hand * in_hand;
    row.head<3>() += factor * direction;
    row.segment<3>(3) += factor * (in_product - pivot_).cross(direction);
    const Vec3 seen = state.product_from_hand.rotation.conjugate() * direction;
    for (const DofMotion& m : moving) {
      row[column_of(m.dof)] += factor * seen.dot(m.of_point(in_hand));
    }
  }
  /// Derivatives of a direction that a part carries, seen along `axis` of the product.
  void direction_row(const State& state, const std::vector<DofMotion>& moving, const Vec3& in_hand,
                     const Vec3& axis, double factor, Row& row) const {
    row.segment<3>(3) += factor * (state.product_from_hand.rotation * in_hand).cross(axis);
    const Vec3 seen = state.product_from_hand.rotation.conjugate() * axis;
    for (const DofMotion& m : moving) {
      row[column_of(m.dof)] += factor * seen.dot(m.of_direction(in_hand));
    }
  }
  Vec3 in_hand(const FingerMotion& motion, const FingertipGoal& goal) const {
    return motion.posed().segment[index_of(goal.fingertip.segment)] * goal.fingertip.point;
  }
  bool slides(const FingertipGoal& goal) const {
    return goal.is_sliding && problem_->product != nullptr;
  }
  /// A pulp near the product, as a ball of radius kPulp whose skin is the fingertip point.
  struct Touch {
    Vec3 in_hand = Vec3::Zero();                     ///< centre of the ball
    double height = 0.0;                             ///< of its skin over the surface, mm
    Vec3 normal = Vec3::UnitZ();                     ///< of the product, product frame
    Vec3 surface = Vec3::Zero();                     ///< nearest point of the product
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();  ///< how the normal changes, 1/mm
  };
  Touch touch_of(const State& state, const FingerMotion& motion, const FingertipGoal& goal,
                 bool with_bend) const;
  void add_sliding_goal(const State& state, const FingerMotion& motion, const FingertipGoal& goal,
                        const Stage& stage);
  void add_goals(const State& state, const FingerMotion& motion, const Stage& stage);
  void add_balance(const State& state, const FingerMotion& motion);
  void add_posture(const State& state, const Stage& stage);
  void add_crossings(const State& state, const FingerMotion& motion);
  void add_balls(const State& state, const FingerMotion& motion);
  double give_of(const FingertipIk::Ball& ball) const;
  bool is_moving(hand::Finger finger) const { return problem_->is_finger_free[index_of(finger)]; }
  State stepped(const State& state, const Row& step) const;
  void minimise(State& state, const Stage& stage, int most);

  const FingertipIk* ik_;
  const FingertipProblem* problem_;
  std::vector<PostureTerm> terms_;
  Vec3 pivot_ = Vec3::Zero();
  std::array<bool, hand::kSegmentCount> is_contact_{};
  std::array<double, hand::kSegmentCount> depth_{};
  Row lower_, upper_;
  std::array<bool, kUnknowns> is_free_{};
  double cost_ = 0.0, clash_ = 0.0;
  Square* h_ = nullptr;
  Row* g_ = nullptr;
  std::vector<Vec3> points_, points_in_hand_;
  std::vector<geometry::DistanceSample> samples_;
  std::vector<Touch> touches_;  ///< of sliding goals
  int iterations_ = 0;
};

FingertipSystem::Touch FingertipSystem::touch_of(const State& state, const FingerMotion& motion,
                                                 const FingertipGoal& goal, bool with_bend) const {
  Touch touch;
  touch.in_hand = motion.posed().segment[index_of(goal.fingertip.segment)] *
                  Vec3(goal.fingertip.point - kPulp * goal.fingertip.normal);
  // One call for the point and for its normal's changes along the hand's axes, so that a turned
  // product or a left hand goes the same way.
  std::array<Vec3, 4> points;
  points.fill(state.product_from_hand * touch.in_hand);
  Eigen::Matrix3d axes = state.product_from_hand.rotation.toRotationMatrix();
  if (ik_->hand().side == hand::Side::kLeft) axes.col(0) = -axes.col(0);
  for (int c = 0; c < 3; ++c) points[c + 1] += kBendStep * axes.col(c);
  std::array<geometry::DistanceSample, 4> samples;
  const std::size_t count = with_bend ? 4 : 1;
  problem_->product->sample(std::span(points).first(count), kEverywhere,
                            std::span(samples).first(count));
  touch.height = samples[0].distance - kPulp;
  touch.normal = samples[0].normal;
  touch.surface = points[0] - samples[0].distance * samples[0].normal;
  for (std::size_t c = 1; c < count; ++c) {
    touch.bend += (samples[c].normal - samples[0].normal) / kBendStep *
                  axes.col(static_cast<int>(c) - 1).transpose();
  }
  return touch;
}

void FingertipSystem::add_sliding_goal(const State& state, const FingerMotion& motion,
                                       const FingertipGoal& goal, const Stage& stage) {
  const std::vector<DofMotion>& moving = motion.moving(goal.fingertip.segment);
  const auto s = static_cast<std::size_t>(goal.fingertip.segment);
  const Vec3 x = in_hand(motion, goal);
  const Vec3 there = state.product_from_hand * x;
  for (int c = 0; c < 3; ++c) {
    Row row = Row::Zero();
    point_row(state, moving, x, Vec3::Unit(c), 1.0 / goal.slide, row);
    add((there - goal.point)[c] / goal.slide, row);
  }
  const Touch touch = touch_of(state, motion, goal, h_ != nullptr);
  if (!goal.is_rest) touches_.push_back(touch);
  Row height = Row::Zero();
  point_row(state, moving, touch.in_hand, touch.normal, 1.0 / stage.reach, height);
  add((touch.height + goal.depth) / stage.reach, height);
  const Vec3 n = motion.posed().segment[s].rotation * goal.fingertip.normal;
  for (int c = 0; c < 3; ++c) {
    Row row = Row::Zero();
    direction_row(state, moving, n, Vec3::Unit(c), 1.0 / goal.square, row);
    // The product's normal turns where the fingertip goes.
    point_row(state, moving, touch.in_hand, touch.bend.row(c).transpose(), 1.0 / goal.square, row);
    add((state.product_from_hand.rotation * n + touch.normal)[c] / goal.square, row);
  }
}

void FingertipSystem::add_goals(const State& state, const FingerMotion& motion,
                                const Stage& stage) {
  for (const FingertipGoal& goal : problem_->goals) {
    if (slides(goal)) {
      add_sliding_goal(state, motion, goal, stage);
      continue;
    }
    const std::vector<DofMotion>& moving = motion.moving(goal.fingertip.segment);
    const std::size_t s = index_of(goal.fingertip.segment);
    const Vec3 x = in_hand(motion, goal);
    const Vec3 there = state.product_from_hand * x;
    Vec3 want = goal.point;
    if (goal.normal) want -= goal.depth * *goal.normal;
    for (int c = 0; c < 3; ++c) {
      Row row = Row::Zero();
      point_row(state, moving, x, Vec3::Unit(c), 1.0 / stage.reach, row);
      add((there - want)[c] / stage.reach, row);
    }
    if (!goal.normal) continue;
    const Vec3 n = motion.posed().segment[s].rotation * goal.fingertip.normal;
    for (int c = 0; c < 3; ++c) {
      Row row = Row::Zero();
      direction_row(state, moving, n, Vec3::Unit(c), 1.0 / goal.square, row);
      add((state.product_from_hand.rotation * n + *goal.normal)[c] / goal.square, row);
    }
  }
}

void FingertipSystem::add_balance(const State& state, const FingerMotion& motion) {
  // The thumb, which comes first, against the rest.
  const std::size_t count = touches_.size();
  const auto pressing = static_cast<std::size_t>(
      std::count_if(problem_->goals.begin(), problem_->goals.end(),
                    [](const FingertipGoal& goal) { return !goal.is_rest; }));
  if (count < 2 || count != pressing) return;
  Vec3 others = Vec3::Zero();
  for (std::size_t k = 1; k < count; ++k) others += touches_[k].normal;
  const double length = others.norm();
  if (length < 0.1) return;
  for (int c = 0; c < 3; ++c) {
    Row row = Row::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const double factor = (k == 0 ? 1.0 : 1.0 / length) / kBalanceSpread;
      point_row(state, motion.moving(problem_->goals[k].fingertip.segment), touches_[k].in_hand,
                touches_[k].bend.row(c).transpose(), factor, row);
    }
    add((touches_[0].normal + others / length)[c] / kBalanceSpread, row);
  }
}

void FingertipSystem::add_posture(const State& state, const Stage& stage) {
  const double factor = std::sqrt(stage.natural);
  for (const PostureTerm& term : terms_) {
    Row row = Row::Zero();
    row[column_of(term.dof[0])] += factor * term.factor[0] / term.spread;
    row[column_of(term.dof[1])] += factor * term.factor[1] / term.spread;
    add(factor * value_of(term, state.posture), row);
  }
  for (int d = kFirstDof; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    const int c = column_of(dof);
    if (is_abduction(dof) || upper_[c] - lower_[c] < 4.0 * kRangeEnd) continue;
    const double q = state.posture[dof];
    const double beyond = q > upper_[c] - kRangeEnd   ? q - (upper_[c] - kRangeEnd)
                          : q < lower_[c] + kRangeEnd ? q - (lower_[c] + kRangeEnd)
                                                      : 0.0;
    if (beyond == 0.0) continue;
    Row row = Row::Zero();
    row[c] = factor / kEndSpread;
    add(factor * beyond / kEndSpread, row);
  }
}

void FingertipSystem::add_crossings(const State& state, const FingerMotion& motion) {
  const std::vector<RoundCone> cones = ik_->cones_.posed(ik_->hand().skeleton, state.posture);
  const auto phalanx_of = [](const RoundCone& cone) {
    return *hand::segments_of(cone.finger)[cone.level - 1];
  };
  for (const RoundCone& p : cones) {
    for (const RoundCone& q : cones) {
      if (!may_cross(p, q)) continue;
      if (!is_moving(p.finger) && !is_moving(q.finger)) continue;
      const hand::Segment sp = phalanx_of(p), sq = phalanx_of(q);
      // Two that touch the product face each other over it, flattened.
      const bool is_facing = p.finger == hand::Finger::kThumb && is_contact_[index_of(sp)] &&
                             is_contact_[index_of(sq)];
      const Crossing crossing = crossing_of(p, q);
      const double excess = crossing.overlap - (is_facing ? kFacingGive : kNeighbourGive);
      if (excess <= 0.0) continue;
      clash_ = std::max(clash_, excess);
      const Vec3 apart = crossing.p - crossing.q;
      if (apart.norm() < 1e-6) continue;
      const Vec3 n = apart.normalized();
      Row row = Row::Zero();
      for (const DofMotion& m : motion.moving(sp)) {
        row[column_of(m.dof)] -= n.dot(m.of_point(crossing.p)) / kClashSpread;
      }
      for (const DofMotion& m : motion.moving(sq)) {
        row[column_of(m.dof)] += n.dot(m.of_point(crossing.q)) / kClashSpread;
      }
      add(excess / kClashSpread, row);
    }
  }
}

double FingertipSystem::give_of(const FingertipIk::Ball& ball) const {
  if (!ball.phalanx || !ball.finger) return 0.0;
  if (is_contact_[index_of(*ball.phalanx)]) {
    return kTouchGive + depth_[index_of(*ball.phalanx)];
  }
  for (const std::optional<hand::Segment>& segment : hand::segments_of(*ball.finger)) {
    if (segment && is_contact_[index_of(*segment)]) return kNextGive;
  }
  return 0.0;
}

void FingertipSystem::add_balls(const State& state, const FingerMotion& motion) {
  if (problem_->product == nullptr) return;
  points_.clear();
  points_in_hand_.clear();
  std::vector<const FingertipIk::Ball*> balls;
  for (const FingertipIk::Ball& ball : ik_->balls_) {
    const bool is_still = !ball.finger || (!ball.phalanx && ball.finger != hand::Finger::kThumb);
    if (!problem_->is_hand_free && (is_still || !is_moving(*ball.finger))) continue;
    balls.push_back(&ball);
    const geometry::Rigid3& moved = !ball.finger   ? motion.posed().forearm
                                    : ball.phalanx ? motion.posed().segment[index_of(*ball.phalanx)]
                                    : *ball.finger == hand::Finger::kThumb
                                        ? motion.posed().thumb_metacarpal
                                        : motion.posed().segment[0];
    points_in_hand_.push_back(moved * ball.centre);
    points_.push_back(state.product_from_hand * points_in_hand_.back());
  }
  samples_.resize(points_.size());
  problem_->product->sample(points_, kFarOff, samples_);
  static const std::vector<DofMotion> kFixed;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const FingertipIk::Ball& ball = *balls[k];
    const double excess = ball.radius - samples_[k].distance - give_of(ball);
    if (excess <= 0.0) continue;
    clash_ = std::max(clash_, excess);
    const std::vector<DofMotion>& moving = ball.phalanx ? motion.moving(*ball.phalanx)
                                           : ball.finger == hand::Finger::kThumb
                                               ? motion.moving_thumb_metacarpal()
                                               : kFixed;
    Row row = Row::Zero();
    point_row(state, moving, points_in_hand_[k], samples_[k].normal, -1.0 / kClashSpread, row);
    add(excess / kClashSpread, row);
  }
}

void FingertipSystem::evaluate(const State& state, const Stage& stage, double& cost, Square* h,
                               Row* g) {
  cost_ = clash_ = 0.0;
  h_ = h;
  g_ = g;
  if (h != nullptr) {
    h->setZero();
    g->setZero();
  }
  const FingerMotion motion(ik_->hand().skeleton, state.posture);
  touches_.clear();
  add_goals(state, motion, stage);
  add_balance(state, motion);
  add_posture(state, stage);
  add_crossings(state, motion);
  add_balls(state, motion);
  cost = cost_;
}

FingertipSystem::State FingertipSystem::stepped(const State& state, const Row& step) const {
  State next = state;
  const Vec3 turn = step.segment<3>(3);
  const double angle = turn.norm();
  if (angle > 0.0) {
    next.product_from_hand =
        geometry::Rigid3::about_axis(turn / angle, pivot_, angle) * next.product_from_hand;
  }
  next.product_from_hand.translation += step.head<3>();
  for (int d = kFirstDof; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    const int c = column_of(dof);
    if (!is_free_[c]) continue;
    next.posture[dof] = std::clamp(next.posture[dof] + step[c], lower_[c], upper_[c]);
  }
  return next;
}

// A loop of its own, not solve_least_squares(): how many residuals there are changes from step to
// step (fingers begin to cross, joints come near their ends), so evaluate() adds up the normal
// matrix and the gradient, whose size stays.
void FingertipSystem::minimise(State& state, const Stage& stage, int most) {
  Square h;
  Row g;
  double cost = 0.0, damping = 1e-3;
  evaluate(state, stage, cost, &h, &g);
  for (int i = 0; i < most; ++i, ++iterations_) {
    // Unknowns that are held, or stand at a bound that they would leave.
    Square system = h.selfadjointView<Eigen::Lower>();
    Row rhs = -g;
    for (int c = 0; c < kUnknowns; ++c) {
      bool is_held = !is_free_[c];
      if (c >= kPlacement && !is_held) {
        const double q = state.posture[static_cast<hand::Dof>(c - kPlacement + kFirstDof)];
        is_held = (q <= lower_[c] && g[c] > 0.0) || (q >= upper_[c] && g[c] < 0.0);
      }
      if (!is_held) continue;
      system.row(c).setZero();
      system.col(c).setZero();
      system(c, c) = 1.0;
      rhs[c] = 0.0;
    }
    bool is_better = false;
    double gain = 0.0, length = 0.0;
    for (int trial = 0; trial < 8 && !is_better; ++trial) {
      Square damped = system;
      // Angles and millimetres: each is damped by its own curvature, the placement's by means over
      // three axes, which don't turn with the product.
      Row curvature = system.diagonal();
      curvature.head<3>().setConstant(curvature.head<3>().mean());
      curvature.segment<3>(3).setConstant(curvature.segment<3>(3).mean());
      damped.diagonal() += damping * (curvature.array() + 1e-3).matrix();
      Row step = damped.ldlt().solve(rhs);
      const double turn = step.segment<3>(3).norm();
      if (turn > 0.5) step *= 0.5 / turn;
      length = step.norm();
      const State next = stepped(state, step);
      double next_cost = 0.0;
      Square next_h;
      Row next_g;
      evaluate(next, stage, next_cost, &next_h, &next_g);
      if (next_cost < cost) {
        gain = (cost - next_cost) / cost;
        state = next;
        cost = next_cost;
        h = next_h;
        g = next_g;
        damping = std::max(1e-7, 0.3 * damping);
        is_better = true;
      } else {
        damping *= 6.0;
      }
    }
    if (!is_better || gain < kSmallGain || length < kSmallStep) break;
  }
}

FingertipSolution FingertipSystem::solution(const State& state) {
  FingertipSolution result;
  result.posture = state.posture;
  result.product_from_hand = state.product_from_hand;
  double cost = 0.0;
  evaluate(state, kStages.back(), cost, nullptr, nullptr);
  result.clash = clash_;
  result.strain = posture_strain(problem_->natural, state.posture);
  result.iterations = iterations_;
  const FingerMotion motion(ik_->hand().skeleton, state.posture);
  for (const FingertipGoal& goal : problem_->goals) {
    const std::size_t s = index_of(goal.fingertip.segment);
    const Vec3 x = state.product_from_hand * in_hand(motion, goal);
    std::optional<Vec3> normal = goal.normal;
    if (slides(goal)) {
      const Touch touch = touch_of(state, motion, goal, false);
      normal = touch.normal;
      result.reached.push_back(touch.surface);
      result.miss.push_back(std::abs(touch.height + goal.depth));
    } else {
      result.reached.push_back(normal ? Vec3(x + goal.depth * *normal) : x);
      result.miss.push_back((result.reached.back() - goal.point).norm());
    }
    result.normal.push_back(normal.value_or(Vec3::Zero()));
    const Vec3 n = state.product_from_hand.rotation *
                   (motion.posed().segment[s].rotation * goal.fingertip.normal);
    result.tilt.push_back(normal ? std::acos(std::clamp(-n.dot(*normal), -1.0, 1.0)) : 0.0);
    if (!goal.is_rest) result.worst_miss = std::max(result.worst_miss, result.miss.back());
  }
  return result;
}

FingertipSolution FingertipSystem::solve() {
  State state{hand::clamp_to_range(ik_->hand().skeleton, problem_->start).posture,
              problem_->product_from_hand};
  if (problem_->is_refining) {
    minimise(state, kStages.back(), problem_->max_iterations);
  } else {
    for (const Stage& stage : kStages) minimise(state, stage, problem_->max_iterations / 3);
  }
  return solution(state);
}

FingertipIk::FingertipIk(const hand::Hand& hand) : hand_(&hand), cones_(hand) {
  for (const RoundCone& cone :
       cones_.posed(hand.skeleton, hand::reference_posture(hand.skeleton))) {
    const bool is_metacarpal = cone.level == 0;
    for (const double t : {0.1, 0.55, 1.0}) {
      Ball ball;
      ball.centre = cone.a + t * (cone.b - cone.a);
      ball.radius = (1.0 - t) * cone.radius_a + t * cone.radius_b;
      ball.finger = cone.finger;
      if (!is_metacarpal) {
        ball.phalanx = hand::segments_of(cone.finger)[cone.level - 1];
      }
      balls_.push_back(ball);
    }
  }
  const double thickness =
      hand.dimensions.hand_thickness > 0.0 ? hand.dimensions.hand_thickness : 28.0;
  for (int i = 0; i < 5; ++i) {
    Ball ball;
    ball.centre = Vec3(0.0, -45.0 * i, 0.0);
    ball.radius = (0.75 + 0.06 * i) * thickness;
    balls_.push_back(ball);
  }
}

FingertipSolution FingertipIk::solve(const FingertipProblem& problem) const {
  return FingertipSystem(*this, problem).solve();
}

double FingertipIk::clash_of(const geometry::DistanceField& product, const hand::Posture& posture,
                             const geometry::Rigid3& product_from_hand,
                             const std::vector<FingertipPoint>& contacts) const {
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand_->skeleton, posture);
  std::vector<Vec3> points;
  for (const Ball& ball : balls_) {
    const geometry::Rigid3& moved = !ball.finger   ? posed.forearm
                                    : ball.phalanx ? posed.segment[index_of(*ball.phalanx)]
                                    : *ball.finger == hand::Finger::kThumb ? posed.thumb_metacarpal
                                                                           : posed.segment[0];
    points.push_back(product_from_hand * (moved * ball.centre));
  }
  std::vector<geometry::DistanceSample> samples(points.size());
  product.sample(points, kFarOff, samples);
  double sum = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    double give = 0.0;
    for (const FingertipPoint& contact : contacts) {
      if (balls_[k].finger != contact.finger || !balls_[k].phalanx) continue;
      give = std::max(give, balls_[k].phalanx == contact.segment ? kTouchGive + 2.0 : kNextGive);
    }
    sum += std::max(0.0, balls_[k].radius - samples[k].distance - give);
  }
  return sum;
}

}  // namespace palmar::grasp
