// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/least_effort.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/hand/skeleton.h"

namespace palmar::grasp {
namespace {

constexpr int kMostTries = 60;
constexpr int kMostRefused = 10;     // steps one after the other
constexpr double kLeastGain = 1e-3;  // of the merit: steps that promise less end it
constexpr double kAccuracy = 1e-5;   // relative, of contact forces
constexpr double kShiftStep = 0.03, kTurnStep = 1e-3;  // mm, rad; of differences
constexpr int kMostDerivatives = 6;
// Damping, of the spreads' own curvature: at first, of a correction, times which without solution.
constexpr double kFirstDamping = 1.0, kBackDamping = 30.0, kNoStep = 8.0;
// Share of the promised gain: less is corrected; less isn't taken.
constexpr double kPoor = 0.5, kLeastShare = 0.02;
constexpr int kSqueezeRow = kGripCoordinates, kWristRow = kGripCoordinates + 1,
              kRows = kGripCoordinates + 2;

/// One standard deviation of each coordinate.
GripVector spread(const EffortModel& model) {
  GripVector s;
  for (int j = 0; j < kGripJoints; ++j) {
    s[j] = hand::is_flexion(grip_dof(j)) ? model.flexion_spread : model.abduction_spread;
  }
  s.segment<3>(kGripJoints).setConstant(model.place_spread);
  s.tail<3>().setConstant(model.turn_spread);
  return s;
}

/// A state with all that acts in it.
struct Look {
  GripState state;
  GripVector contact = GripVector::Zero();  ///< forces of contact and friction, N and N mm
  GripVector outside = GripVector::Zero();  ///< all but muscles
  GripMatrix stiffness = GripMatrix::Zero(), contact_stiffness = GripMatrix::Zero();
  bool is_differentiated = false;
  GripVector squeeze_rate = GripVector::Zero();
  Squeeze grip;
  Vec3 centre = Vec3::Zero();
  Eigen::MatrixXd moments;   ///< of the muscles at full activation, angles x muscles
  Eigen::RowVectorXd wrist;  ///< the same about the wrist
  double wrist_load = 0.0;
  std::vector<ThumbPress> presses;
  EffortSolution effort;  ///< with the state held
  double off = 0.0;       ///< E
  double merit() const { return effort.value + off; }
};

class LeastEffort {
 public:
  LeastEffort(const contact::PreparedHand& hand, const product::Product& product,
              const GripState& start, const EffortTask& task,
              const contact::ContactOptions& contact)
      : hand_(&hand.hand()),
        task_(&task),
        start_(start),
        meeting_(hand.hand(), start.posture),
        has_skin_on_skin_(contact.skin_on_skin),
        forces_(hand, product, contact, task.friction, start),
        muscles_(hand.hand(), {.wrist = task.wrist}),
        weight_(spread(task.model).cwiseAbs2().cwiseInverse()) {}

  EffortRest run(const Progress& progress);

 private:
  bool look(const GripState& state, Look& at);
  void add_muscles(Look& at) const;
  EffortProgram program(const Look& at, double damping) const;
  void judge(Look& at) const;
  GripVector departure(const GripState& state) const;
  void learn(const Look& from, const Look& to, const GripVector& way);
  bool differentiate(const Look& at);
  bool go(const Look& from, const GripVector& way, Look& to);
  void finish(const Look& at, EffortRest& rest) const;

  const hand::Hand* hand_;
  const EffortTask* task_;
  GripState start_;
  Vec3 held_point_ = Vec3::Zero();  ///< product frame: centre of contact at the start
  Vec3 held_at_ = Vec3::Zero();     ///< where that was, hand frame
  double target_ = 0.0;             ///< grip force, N
  ThumbMeeting meeting_;
  bool has_skin_on_skin_;
  ContactForces forces_;
  hand::HandMuscles muscles_;
  GripVector weight_;                            ///< of what coordinates have moved, in E
  GripMatrix learnt_ = GripMatrix::Zero();       ///< stiffness beyond the contact's own
  GripVector learnt_rate_ = GripVector::Zero();  ///< the same of the squeeze
};

void LeastEffort::add_muscles(Look& at) const {
  Eigen::Index count = hand::kWristMuscleCount;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    count += static_cast<Eigen::Index>(hand::tendons_of(static_cast<hand::Finger>(f)).size());
  }
  at.moments = Eigen::MatrixXd::Zero(kGripJoints, count);
  at.wrist = Eigen::RowVectorXd::Zero(count);
  Eigen::Index column = 0;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const hand::DigitMuscles digit = muscles_.in(static_cast<hand::Finger>(f), at.state.posture);
    const int first = hand::kDigitDofs * f;
    for (std::size_t t = 0; t < digit.arm.size(); ++t, ++column) {
      const double strength = task_->strength * digit.strength[t];
      for (int k = 0; k < hand::kDigitDofs; ++k) {
        at.moments(first + k, column) = strength * digit.arm[t][k];
      }
      at.wrist[column] = strength * digit.wrist_arm[t].x();
    }
    const hand::PassiveMoments ligaments = ligament_moments(
        hand_->skeleton, digit.finger, at.state.posture, start_.posture, task_->model.ligaments);
    at.outside.segment<hand::kDigitDofs>(first) += digit.passive.moment + ligaments.moment;
    at.stiffness.block<hand::kDigitDofs, hand::kDigitDofs>(first, first) +=
        digit.passive.stiffness + ligaments.stiffness;
  }
  const hand::WristMuscles& motors = muscles_.wrist();
  for (std::size_t i = 0; i < motors.arm.size(); ++i) {
    at.wrist[column++] = task_->strength * motors.strength[i] * motors.arm[i].x();
  }
}

bool LeastEffort::look(const GripState& state, Look& at) {
  at.state = state;
  if (!forces_.look(state, kAccuracy)) return false;
  at.contact = at.outside = forces_.force();
  at.stiffness = at.contact_stiffness = forces_.stiffness();
  at.squeeze_rate = forces_.squeeze_rate();
  at.centre = forces_.centre();
  at.grip = forces_.grip();
  const geometry::Rigid3 hand_from_product = state.product_from_hand.inverse();
  const Vec3 force = hand_from_product.rotation * task_->load.force;
  const Vec3 moment = hand_from_product.rotation * task_->load.moment;
  at.outside.segment<3>(kGripJoints) += force;
  at.outside.tail<3>() += moment + (hand_from_product.translation - at.centre).cross(force);
  at.wrist_load = hand::wrist_moment(*hand_, force, hand_from_product.translation, moment);
  add_muscles(at);
  if (!has_skin_on_skin_) at.presses = meeting_.presses(state.posture);
  for (const ThumbPress& press : at.presses) {
    at.outside += press.force * press.moment;
    at.stiffness += press.stiffness * press.moment * press.moment.transpose();
  }
  return true;
}

/// How far a state is from the start, coordinate by coordinate.
GripVector LeastEffort::departure(const GripState& state) const {
  GripVector off;
  for (int j = 0; j < kGripJoints; ++j) {
    off[j] = state.posture[grip_dof(j)] - start_.posture[grip_dof(j)];
  }
  const geometry::Rigid3 hand_from_product = state.product_from_hand.inverse();
  off.segment<3>(kGripJoints) = hand_from_product * held_point_ - held_at_;
  const Eigen::AngleAxisd turn(hand_from_product.rotation * start_.product_from_hand.rotation);
  off.tail<3>() = turn.angle() * turn.axis();
  return off;
}

/// The problem at a state; `damping` below 0: with the state held.
EffortProgram LeastEffort::program(const Look& at, double damping) const {
  EffortProgram program;
  program.muscles = Eigen::MatrixXd::Zero(kRows, at.moments.cols());
  program.muscles.topRows(kGripJoints) = at.moments;
  program.muscles.row(kWristRow) = at.wrist;
  program.required.resize(kRows);
  program.required.head<kGripCoordinates>() = -at.outside;
  program.required[kSqueezeRow] = target_ - at.grip.force;
  program.required[kWristRow] = -at.wrist_load;
  program.price = Eigen::VectorXd::Constant(kRows, task_->model.moment_price);
  program.price.segment<3>(kGripJoints).setConstant(task_->model.force_price);
  program.price[kSqueezeRow] = task_->model.squeeze_price;
  const bool moves = damping >= 0.0;
  program.motion.resize(kRows, moves ? kGripCoordinates : 0);
  if (!moves) return program;
  program.motion.setZero();
  program.motion.topRows<kGripCoordinates>() = -(at.stiffness + learnt_);
  program.motion.row(kSqueezeRow) = (at.squeeze_rate + learnt_rate_).transpose();
  // Of E: a turn about the centre of contact moves the point that was held.
  GripMatrix jacobian = GripMatrix::Identity();
  const Vec3 x = at.state.product_from_hand.inverse() * held_point_ - at.centre;
  for (int c = 0; c < 3; ++c) {
    jacobian.block<3, 1>(kGripJoints, kGripJoints + 3 + c) = Vec3::Unit(c).cross(x);
  }
  program.gradient = jacobian.transpose() * weight_.cwiseProduct(departure(at.state));
  program.hessian = jacobian.transpose() * weight_.asDiagonal() * jacobian;
  program.hessian.diagonal() += damping * weight_;
  return program;
}

void LeastEffort::judge(Look& at) const {
  at.effort = solve_effort(program(at, -1.0));
  const GripVector off = departure(at.state);
  at.off = 0.5 * off.dot(weight_.cwiseProduct(off));
}

/// Broyden's update of the derivatives, in units of the spreads.
void LeastEffort::learn(const Look& from, const Look& to, const GripVector& way) {
  const GripVector scaled = weight_.cwiseProduct(way);
  const double size = way.dot(scaled);
  if (!(size > 1e-14)) return;
  GripVector lost = from.outside - to.outside;
  // Moments about the same point.
  const Vec3 force = to.outside.segment<3>(kGripJoints);
  lost.tail<3>() -= (to.centre - from.centre).cross(force);
  learnt_ += (lost - (from.stiffness + learnt_) * way) * scaled.transpose() / size;
  const double gained = to.grip.force - from.grip.force;
  learnt_rate_ += (gained - (from.squeeze_rate + learnt_rate_).dot(way)) / size * scaled;
}

/// The contact's own derivatives at a state, by differences where it has none. False if a state
/// beside it has no solution.
bool LeastEffort::differentiate(const Look& at) {
  if (!forces_.look(at.state, kAccuracy)) return false;
  GripMatrix stiffness = forces_.stiffness();
  GripVector rate = forces_.squeeze_rate();
  if (forces_.differentiate()) {
    stiffness = forces_.stiffness();
    rate = forces_.squeeze_rate();
  } else {
    for (int c = 0; c < kGripCoordinates; ++c) {
      GripVector way = GripVector::Zero();
      way[c] = c >= kGripJoints && c < kGripJoints + 3 ? kShiftStep : kTurnStep;
      if (!forces_.look(moved(at.state, way, at.centre), kAccuracy)) return false;
      GripVector force = forces_.force();
      force.tail<3>() += (forces_.centre() - at.centre).cross(Vec3(force.segment<3>(kGripJoints)));
      stiffness.col(c) = (at.contact - force) / way[c];
      rate[c] = (forces_.grip().force - at.grip.force) / way[c];
    }
  }
  learnt_ = stiffness - at.contact_stiffness;
  learnt_rate_ = rate - at.squeeze_rate;
  return true;
}

void LeastEffort::finish(const Look& at, EffortRest& rest) const {
  rest.state = at.state;
  rest.grip = at.grip;
  rest.activation = at.effort.activation;
  rest.missing = at.effort.missing.head<kGripCoordinates>();
  rest.strongest_moment = (at.moments * at.effort.activation).lpNorm<Eigen::Infinity>();
  rest.arm = forces_.arm();
  rest.wrist_load = at.wrist_load;
  rest.contact_force = at.contact;
  rest.presses = at.presses;
  rest.is_loaded = forces_.is_loaded();
  rest.friction_use = forces_.friction_use();
  rest.friction_force = forces_.friction_force();
  rest.fallbacks = forces_.fallbacks();
  const GripVector off = departure(at.state);
  rest.way = off.segment<3>(kGripJoints);
  rest.moved = rest.way.norm();
  rest.turned = off.tail<3>().norm();
}

bool LeastEffort::go(const Look& from, const GripVector& way, Look& to) {
  if (!look(moved(from.state, way, from.centre), to) || to.grip.force == 0.0) return false;
  judge(to);
  learn(from, to, way);
  return true;
}

EffortRest LeastEffort::run(const Progress& progress) {
  EffortRest rest;
  Look now;
  if (!look(start_, now)) return rest;
  if (now.grip.force == 0.0) {
    rest.status = EffortRest::Status::kNoContact;
    return rest;
  }
  target_ = task_->grip_force.value_or(now.grip.force);
  held_at_ = now.centre;
  held_point_ = start_.product_from_hand * held_at_;
  judge(now);
  rest.merit.push_back(now.merit());
  double damping = kFirstDamping;
  int refused = 0, derivatives = 0;
  for (; rest.iterations < kMostTries && refused < kMostRefused; ++rest.iterations) {
    progress.throw_if_cancelled();
    const EffortSolution step = solve_effort(program(now, damping));
    const double promised = now.merit() - (step.value + now.off);
    if (promised < kLeastGain * now.merit()) break;
    Look next;
    if (!go(now, step.motion, next)) {
      damping *= kNoStep;
      ++refused;
      continue;
    }
    const bool is_poor = now.merit() - next.merit() < kPoor * promised;
    if (is_poor) {
      // Forces bend away from their tangent: from there back onto the equilibrium, by a way as
      // short as can be (second-order correction; Nocedal & Wright 2006, section 18.3).
      Look corrected;
      const GripVector back = solve_effort(program(next, kBackDamping)).motion;
      if (go(next, back, corrected) && corrected.merit() < next.merit())
        next = std::move(corrected);
    }
    const double share = (now.merit() - next.merit()) / promised;
    if (share > 0.75) damping /= 3.0;
    if (share < 0.25) damping *= 4.0;
    ++refused;
    if (share > kLeastShare) {
      now = std::move(next);
      rest.merit.push_back(now.merit());
      refused = 0;
    }
    if (is_poor && !now.is_differentiated && derivatives < kMostDerivatives) {
      now.is_differentiated = true;
      ++derivatives;
      if (differentiate(now)) damping = std::min(damping, kFirstDamping);
    }
  }
  if (!forces_.look(now.state, kAccuracy)) return rest;
  rest.status = EffortRest::Status::kSolved;
  finish(now, rest);
  return rest;
}

}  // namespace

EffortRest rest_with_least_effort(const contact::PreparedHand& hand,
                                  const product::Product& product, const GripState& start,
                                  const EffortTask& task, const contact::ContactOptions& contact,
                                  const Progress& progress) {
  return LeastEffort(hand, product, start, task, contact).run(progress);
}

}  // namespace palmar::grasp
