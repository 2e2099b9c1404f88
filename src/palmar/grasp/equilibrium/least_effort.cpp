// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/least_effort.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/contact/prepared/coarse_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/grasp/equilibrium/effort_program.h"
#include "palmar/hand/skeleton.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kNoMissing = 0.01;  // of the merit, as it is priced; so little is none

/// When a search ends, and how it begins.
struct Descent {
  double level;  // of the grip force asked for
  double least;  // N; what is held more lightly than that settles at it first
  int most_tries;
  double least_gain;     // of the merit: steps that promise less end it
  double first_damping;  // as hard as skin that has moved by kStep
  double price;          // of what is missing, of the model's
  double nothing = 0.0;  // of the force; so little that is missing isn't searched for
};
// On the way prices are low, so that digits find their places before forces are exact.
constexpr Descent kOnCoarseSkin[] = {{0.6, 30.0, 30, 2e-2, 10.0, 1.0 / 3.0},
                                     {1.0, 0.0, 30, 1e-2, 1.0, 1.0}};
constexpr Descent kOnSkin{1.0, 0.0, 60, 5e-3, 1.0, 1.0, 1e-3};
// What is missing may cost less than what E asks for to have it, or than the last of a grip force
// that the hand doesn't reach: once more, equilibrium for that much more.
constexpr Descent kInNeed{1.0, 0.0, 40, 5e-3, 100.0, 8.0};
// Fingertips lose a small thing by less of a way than a whole hand.
constexpr Descent kWithFingertips[] = {{1.0, 0.0, 40, 1e-2, 100.0, 0.1},
                                       {1.0, 0.0, 60, 5e-3, 100.0, 1.0}};

constexpr int kMostRefused = 5,
              kMostInNeed = 12;             // steps one after the other; if things are missing
constexpr double kAccuracy = 1e-4;          // relative, of contact forces
constexpr double kStep = 8.0, kArm = 50.0;  // mm; angles count by what they move at that arm
constexpr double kBackDamping = 30.0;       // of a correction
constexpr double kFollowed = 1.0;           // damping of what follows a small change
constexpr int kFollowedBack = 2;            // corrections: lightly pressed skin isn't linear
constexpr int kMostCorrections = 4;
constexpr int kMostUnasked = 4;       // steps across a jump of forces
constexpr double kUsualSteps = 50.0;  // of all searches; of what progress is a share
// Shares of the promised gain: less is corrected; less that a correction promises isn't worth it;
// less isn't taken.
constexpr double kPoor = 0.5, kWorthwhile = 0.2, kLeastShare = 0.02;
// A way that much more damped is shorter; if it promises that share, it is better.
constexpr double kShorter = 8.0, kAsGood = 0.9;
constexpr double kFree = 0.02, kNoGain = 3e-4;  // damping of a long way; of the merit
constexpr double kGrowth = 4.0;                 // of damping, where a step is refused
constexpr double kKept = 0.9;                   // less, and derivatives are taken anew
constexpr double kByWrist = 1.02;               // of the strength that the digits alone need
constexpr double kTurnArm = 30.0;               // mm, at which a torque counts as a force
constexpr double kTooMuch = 2000.0;             // N; no hand grips that hard
constexpr int kForceRow = kGripCoordinates, kWristRow = kGripCoordinates + 1,
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

/// Where digits are apart: in the open hand, where webs join; of fingertips, that are put beside
/// each other, as they were put.
hand::Posture apart(const hand::Hand& hand, const GripState& start, const EffortTask& task) {
  const bool is_by_whole_hand = task.takes_part.minCoeff() > 0.0;
  return is_by_whole_hand ? hand::reference_posture(hand.skeleton) : start.posture;
}

/// The digits of which no phalanx takes part.
std::array<bool, hand::kFingerCount> idle_digits(const VolarVector& takes_part) {
  std::array<bool, hand::kFingerCount> is_idle;
  is_idle.fill(true);
  for (int s = 1; s < hand::kSegmentCount; ++s) {
    const auto finger = hand::finger_of(static_cast<hand::Segment>(s));
    if (finger && takes_part[s - 1] > 0.0) is_idle[index_of(*finger)] = false;
  }
  return is_idle;
}

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Of steps: 1 for what moves skin by kStep.
GripVector step_weight() {
  GripVector w = GripVector::Constant(kArm * kArm);
  w.segment<3>(kGripJoints).setOnes();
  return w / (kStep * kStep);
}

contact::ContactOptions without_touches(contact::ContactOptions options) {
  options.skin_on_skin = false;
  return options;
}

/// A state with all that acts in it.
struct Look {
  GripState state;
  GripVector outside = GripVector::Zero();  ///< all that acts but muscles, N and N mm
  GripVector contact = GripVector::Zero();  ///< of it contact and friction
  GripMatrix stiffness = GripMatrix::Zero(), contact_stiffness = GripMatrix::Zero();
  double measured = 0.0;                          ///< force that the task asks for, N
  GripVector measured_rate = GripVector::Zero();  ///< N per mm and rad
  Squeeze grip;
  Vec3 centre = Vec3::Zero();
  Eigen::MatrixXd moments;   ///< of the muscles at full activation, angles x muscles
  Eigen::RowVectorXd wrist;  ///< the same about the wrist
  double wrist_load = 0.0;
  double wrist_per_torque = 0.0;  ///< of what a turn measures
  std::vector<DigitPress> presses;
  VolarVector gap = VolarVector::Zero();  ///< over its spread; 0 where skin touches
  VolarRates gap_rate = VolarRates::Zero();
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
        meeting_(hand.hand(), apart(hand.hand(), start, task)),
        has_skin_on_skin_(contact.skin_on_skin),
        skin_(hand, product, contact, task.friction, start),
        coarse_skin_(hand.coarse().prepared, product, without_touches(contact), task.friction,
                     start),
        coarse_(&hand.coarse().sample),
        gaps_(hand, product),
        muscles_(hand.hand(), {.ligaments = task.model.ligaments, .wrist = task.wrist}),
        weight_(spread(task.model).cwiseAbs2().cwiseInverse()),
        damped_(step_weight()),
        is_idle_(idle_digits(task.takes_part)) {
    if (task.measure != EffortMeasure::kPush) return;
    laid_gap_ = gaps_.look(start, hand::pose_skin_vertices(*hand_, start.posture, coarse_->vertex))
                    .cwiseMax(0.0);
  }

  EffortRest run(const SearchStart* from, const Progress& progress);
  std::optional<GripState> run_on_coarse_skin(const GripState* from, const Progress& progress);
  /// The motion that a state on the whole skin asks for at a force; nothing where its contact has
  /// no solution.
  GripVector next(const GripState& state, const Vec3& held_at, double force, double damping);
  const Vec3& centre() const { return skin_.centre(); }

 private:
  double lightness() const { return std::max(1.0, task_->model.light_grip * unit() / target_); }
  /// Of what is measured, per N.
  double unit() const { return task_->measure == EffortMeasure::kTurn ? kTurnArm : 1.0; }
  ContactForces& forces() { return is_coarse_ ? coarse_skin_ : skin_; }
  bool is_whole_hand() const { return task_->takes_part.minCoeff() > 0.0; }
  bool begin(Look& now, EffortRest& rest);
  /// From a state, or from where begin() left off. False where that touches nothing.
  bool rest_on_coarse_skin(const GripState* from, const Progress& progress, Look& now,
                           EffortRest& rest);
  bool look(const GripState& state, Look& at);
  void measure(const ContactForces& forces, Look& at) const;
  void add_muscles(Look& at) const;
  GripMatrix muscle_rate(const Look& at) const;
  EffortProgram program(const Look& at, double damping) const;
  void judge(Look& at) const;
  GripVector departure(const GripState& state) const;
  static double missing(const Look& at);
  bool is_in_need(const Look& at, const Descent& how) const;
  bool differentiate(const Look& at);
  bool go(const Look& from, const GripVector& way, Look& to);
  bool pass_a_jump(Look& now, const Descent& how);
  void descend(Look& now, const Descent& how, const Progress& progress, EffortRest& rest);
  double least_share(const Look& at, bool with_wrist) const;
  void finish(const Look& at, EffortRest& rest) const;

  const hand::Hand* hand_;
  const EffortTask* task_;
  GripState start_;
  Vec3 held_point_ = Vec3::Zero();  ///< product frame: centre of contact at the start
  Vec3 held_at_ = Vec3::Zero();     ///< where that was, hand frame
  bool is_coarse_ = true;
  double asked_ = 0.0;   ///< grip force, N
  double target_ = 0.0;  ///< of the search under way, N
  double price_ = 1.0;   ///< of what is missing, in the search under way
  DigitMeeting meeting_;
  bool has_skin_on_skin_;
  ContactForces skin_, coarse_skin_;
  const hand::SkinSample* coarse_;
  VolarGaps gaps_;
  /// Gaps that cost nothing, mm: a hand lies on something as it was laid, and doesn't close.
  VolarVector laid_gap_ = VolarVector::Zero();
  hand::HandMuscles muscles_;
  GripVector weight_;  ///< of what coordinates have moved, in E
  GripVector damped_;  ///< of a step
  std::array<bool, hand::kFingerCount> is_idle_;
  // Of the state that was differentiated last, beyond what its look says.
  GripMatrix more_stiffness_ = GripMatrix::Zero();
  GripVector more_rate_ = GripVector::Zero();  ///< of the force
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
      const double strength = is_idle_[f] ? 0.0 : task_->strength * digit.strength[t];
      for (int k = 0; k < hand::kDigitDofs; ++k) {
        at.moments(first + k, column) = strength * digit.arm[t][k];
      }
      at.wrist[column] = strength * digit.wrist_arm[t].x();
    }
    at.outside.segment<hand::kDigitDofs>(first) += digit.passive.moment;
    at.stiffness.block<hand::kDigitDofs, hand::kDigitDofs>(first, first) += digit.passive.stiffness;
  }
  const hand::WristMuscles& motors = muscles_.wrist();
  for (std::size_t i = 0; i < motors.arm.size(); ++i) {
    at.wrist[column++] = task_->strength * motors.strength[i] * motors.arm[i].x();
  }
}

/// How the moments of the muscles change with the angles at the activations held.
GripMatrix LeastEffort::muscle_rate(const Look& at) const {
  GripMatrix rate = GripMatrix::Zero();
  Eigen::Index column = 0;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const int first = hand::kDigitDofs * f;
    const auto count = static_cast<Eigen::Index>(hand::tendons_of(finger).size());
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      hand::Posture posture = at.state.posture;
      posture[grip_dof(first + k)] += kAngleStep;
      const hand::DigitMuscles digit = muscles_.in(finger, posture);
      for (Eigen::Index t = 0; t < count; ++t) {
        const double force = task_->strength * digit.strength[t] * at.effort.activation[column + t];
        for (int a = 0; a < hand::kDigitDofs; ++a)
          rate(first + a, first + k) += force * digit.arm[t][a];
      }
      for (int a = 0; a < hand::kDigitDofs; ++a) {
        rate(first + a, first + k) -= at.moments.row(first + a)
                                          .segment(column, count)
                                          .dot(at.effort.activation.segment(column, count));
        rate(first + a, first + k) /= kAngleStep;
      }
    }
    column += count;
  }
  return rate;
}

/// The force that the task asks for, by the stiffness that `forces` has now.
void LeastEffort::measure(const ContactForces& forces, Look& at) const {
  if (task_->measure == EffortMeasure::kNone) return;
  at.measured = at.grip.force;
  at.measured_rate = forces.squeeze_rate();
  if (task_->measure == EffortMeasure::kSqueeze) return;
  if (task_->measure == EffortMeasure::kHang) {
    const Vec3 carried = forces.force().segment<3>(kGripJoints);
    at.measured = carried.norm();
    at.measured_rate =
        -forces.stiffness().middleRows<3>(kGripJoints).transpose() * carried.stableNormalized();
    return;
  }
  // Along a direction that goes with the product.
  const int first = task_->measure == EffortMeasure::kPush ? kGripJoints : kGripJoints + 3;
  const Vec3 along = at.state.product_from_hand.rotation.conjugate() * task_->along;
  const Vec3 force = forces.force().segment<3>(first);
  at.measured = along.dot(force);
  at.measured_rate = -forces.stiffness().middleRows<3>(first).transpose() * along;
  at.measured_rate.tail<3>() += along.cross(force);
}

bool LeastEffort::look(const GripState& state, Look& at) {
  at.state = state;
  ContactForces& forces = this->forces();
  const Vec3 before = forces.centre();
  if (!forces.look(state, kAccuracy)) return false;
  at.contact = at.outside = forces.force();
  at.stiffness = at.contact_stiffness = forces.stiffness();
  at.grip = forces.grip();
  measure(forces, at);
  at.centre = at.grip.force > 0.0 ? forces.centre() : before;
  const geometry::Rigid3 hand_from_product = state.product_from_hand.inverse();
  const Vec3 force = hand_from_product.rotation * task_->load.force;
  const Vec3 moment = hand_from_product.rotation * task_->load.moment;
  at.outside.segment<3>(kGripJoints) += force;
  at.outside.tail<3>() += moment + (hand_from_product.translation - at.centre).cross(force);
  at.wrist_load = hand::wrist_moment(*hand_, force, hand_from_product.translation, moment);
  if (task_->measure == EffortMeasure::kHang) {
    const Vec3 up = at.contact.segment<3>(kGripJoints).stableNormalized();
    at.wrist_load = hand::wrist_moment(*hand_, -*task_->force * up,
                                       hand_from_product * task_->hangs_at, Vec3::Zero());
  }
  if (task_->measure == EffortMeasure::kTurn) {
    const Vec3 axis = hand_from_product.rotation * task_->along;
    at.wrist_per_torque = -hand::wrist_moment(*hand_, Vec3::Zero(), Vec3::Zero(), axis);
    at.wrist_load += at.wrist_per_torque * at.measured;
  }
  add_muscles(at);
  std::vector<Vec3> posed = forces.posed();
  if (!is_coarse_) {
    for (std::size_t e = 0; e < coarse_->vertex.size(); ++e) posed[e] = posed[coarse_->vertex[e]];
    posed.resize(coarse_->vertex.size());
  }
  const VolarVector gap = gaps_.look(state, posed);
  at.gap_rate = gaps_.rates(state, posed, at.centre);
  for (int k = 0; k < kVolarParts; ++k) {
    const double scale = task_->takes_part[k] / task_->model.gap_spread;
    at.gap[k] = scale * std::max(0.0, gap[k] - laid_gap_[k]);
    at.gap_rate.row(k) *= at.gap[k] > 0.0 ? scale : 0.0;
  }
  if (is_coarse_ || !has_skin_on_skin_) {
    at.presses = meeting_.presses(state.posture);
    for (const DigitPress& press : at.presses) at.outside += press.force * press.moment;
    at.stiffness += meeting_.stiffness(state.posture);
  }
  return true;
}

/// What is missing, as it is priced.
double LeastEffort::missing(const Look& at) {
  return at.effort.value - at.effort.activation.array().cube().sum();
}

/// More is missing than what is nothing to a search.
bool LeastEffort::is_in_need(const Look& at, const Descent& how) const {
  const double nothing = how.nothing * task_->model.force_price * lightness() * target_ / unit();
  return missing(at) > std::max(kNoMissing * at.merit(), nothing);
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
  program.required[kForceRow] =
      task_->measure == EffortMeasure::kNone ? 0.0 : target_ - at.measured;
  program.required[kWristRow] = -at.wrist_load;
  program.price = Eigen::VectorXd::Constant(kRows, task_->model.moment_price);
  program.price.segment<3>(kGripJoints).setConstant(task_->model.force_price);
  // Soft skin that is lightly pressed gives way a lot for little force.
  program.price *= price_ * lightness();
  program.price[kForceRow] = task_->model.squeeze_price * std::min(price_, 1.0) * lightness();
  // What the product stands on or turns carries what isn't asked of the hand.
  Eigen::Matrix<double, 6, 6> left = Eigen::Matrix<double, 6, 6>::Identity();
  if (task_->measure == EffortMeasure::kPush) left.setZero();
  if (task_->measure == EffortMeasure::kTurn) {
    const Vec3 axis = at.state.product_from_hand.rotation.conjugate() * task_->along;
    left.bottomRightCorner<3, 3>() -= axis * axis.transpose();
    program.price[kForceRow] = task_->model.moment_price * std::min(price_, 1.0) * lightness();
  }
  const Vec3 hangs = at.state.product_from_hand.inverse() * task_->hangs_at - at.centre;
  if (task_->measure == EffortMeasure::kHang) {  // moments about the centre of mass
    left.topLeftCorner<3, 3>().setZero();
    left.bottomLeftCorner<3, 3>() = -cross_matrix(hangs);
    program.price[kForceRow] = task_->model.force_price * price_ * lightness();
  }
  program.required.segment<6>(kGripJoints) = left * program.required.segment<6>(kGripJoints);
  for (int j = 0; j < kGripJoints; ++j) {
    if (is_idle_[index_of(grip_finger(j))]) program.required[j] = 0.0;
  }
  const bool moves = damping >= 0.0;
  program.motion.resize(kRows, moves ? kGripCoordinates : 0);
  if (!moves) return program;
  program.motion.setZero();
  program.motion.topRows<kGripCoordinates>() = -(at.stiffness + more_stiffness_);
  program.motion.topRows<kGripCoordinates>() += muscle_rate(at);
  program.motion.middleRows<6>(kGripJoints) =
      (left * program.motion.middleRows<6>(kGripJoints)).eval();
  if (task_->measure == EffortMeasure::kHang) {  // which goes with the product
    const Eigen::Matrix3d carried = cross_matrix(at.contact.segment<3>(kGripJoints));
    program.motion.block<3, 3>(kGripJoints + 3, kGripJoints) += carried;
    program.motion.block<3, 3>(kGripJoints + 3, kGripJoints + 3) -= carried * cross_matrix(hangs);
  }
  program.motion.row(kForceRow) = (at.measured_rate + more_rate_).transpose();
  program.motion.row(kWristRow) = at.wrist_per_torque * program.motion.row(kForceRow);
  for (int j = 0; j < kGripJoints; ++j) {
    if (!is_idle_[index_of(grip_finger(j))]) continue;
    program.motion.row(j).setZero();
    program.motion.col(j).setZero();
  }
  // Of E: a turn about the centre of contact moves the point that was held.
  GripMatrix jacobian = GripMatrix::Identity();
  const Vec3 x = at.state.product_from_hand.inverse() * held_point_ - at.centre;
  for (int c = 0; c < 3; ++c) {
    jacobian.block<3, 1>(kGripJoints, kGripJoints + 3 + c) = Vec3::Unit(c).cross(x);
  }
  // Of gaps: curvature of the parabola that touches from above.
  const VolarVector share = (1.0 + at.gap.array().square()).rsqrt();
  program.gradient = jacobian.transpose() * weight_.cwiseProduct(departure(at.state)) +
                     at.gap_rate.transpose() * share.cwiseProduct(at.gap);
  program.hessian = jacobian.transpose() * weight_.asDiagonal() * jacobian +
                    at.gap_rate.transpose() * share.asDiagonal() * at.gap_rate;
  program.hessian.diagonal() += damping * damped_;
  return program;
}

void LeastEffort::judge(Look& at) const {
  at.effort = solve_effort(program(at, -1.0));
  const GripVector off = departure(at.state);
  at.off = 0.5 * off.dot(weight_.cwiseProduct(off)) +
           ((1.0 + at.gap.array().square()).sqrt() - 1.0).sum();
}

/// The tissue's own derivatives at a state. False if its contact has no solution.
bool LeastEffort::differentiate(const Look& at) {
  ContactForces& forces = this->forces();
  if (!forces.is_at(at.state) && !forces.look(at.state, kAccuracy)) return false;
  forces.differentiate();
  more_stiffness_ = forces.stiffness() - at.contact_stiffness;
  Look exact;
  exact.state = at.state;
  exact.grip = at.grip;
  measure(forces, exact);
  more_rate_ = exact.measured_rate - at.measured_rate;
  return true;
}

/// Least share of the muscles' strength that holds what is held in a state, to 1 %.
double LeastEffort::least_share(const Look& at, bool with_wrist) const {
  EffortProgram held = program(at, -1.0);
  const auto leave_out = [&](int row) {
    held.required[row] = 0.0;
    held.muscles.row(row).setZero();
  };
  leave_out(kForceRow);
  if (!with_wrist) leave_out(kWristRow);
  const Eigen::MatrixXd muscles = held.muscles;
  const auto missing_with = [&](double share) {
    held.muscles = share * muscles;
    return solve_effort(held).missing.cwiseAbs().dot(held.price);
  };
  const double allowed = missing_with(1.0) + kNoMissing * lightness() * price_;
  double low = 0.0, high = 1.0;
  if (missing_with(0.0) <= allowed) return 0.0;
  while (high - low > 0.01 * high) {
    const double middle = 0.5 * (low + high);
    (missing_with(middle) <= allowed ? high : low) = middle;
  }
  return high;
}

void LeastEffort::finish(const Look& at, EffortRest& rest) const {
  rest.start = start_;
  rest.held_at = held_at_;
  rest.asked = asked_;
  rest.state = at.state;
  rest.grip = at.grip;
  rest.force = task_->measure == EffortMeasure::kNone ? at.grip.force : at.measured;
  rest.activation = at.effort.activation;
  rest.missing = at.effort.missing.head<kGripCoordinates>();
  if (task_->measure == EffortMeasure::kHang) {
    rest.missing.segment<3>(kGripJoints) =
        at.effort.missing[kForceRow] * at.contact.segment<3>(kGripJoints).stableNormalized();
  }
  rest.strongest_moment = (at.moments * at.effort.activation).lpNorm<Eigen::Infinity>();
  rest.arm = skin_.arm();
  rest.load.wrist = at.wrist_load;
  GripVector load = at.contact;
  for (const DigitPress& press : at.presses) load += press.force * press.moment;
  for (int j = 0; j < kGripJoints; ++j) {
    rest.load.digit[j / hand::kDigitDofs][j % hand::kDigitDofs] = load[j];
  }
  rest.share = least_share(at, true);
  rest.is_by_wrist = rest.share > kByWrist * least_share(at, false);
  rest.friction_use = skin_.friction_use();
  rest.friction_force = skin_.friction_force();
  rest.force_on_product = at.state.product_from_hand.rotation * at.contact.segment<3>(kGripJoints);
  rest.fallbacks = skin_.fallbacks();
  const GripVector off = departure(at.state);
  rest.way = off.segment<3>(kGripJoints);
  rest.moved = rest.way.norm();
  rest.turned = off.tail<3>().norm();
}

bool LeastEffort::go(const Look& from, const GripVector& way, Look& to) {
  if (!look(moved(from.state, way, from.centre), to)) return false;
  if (to.grip.force == 0.0 && !is_coarse_) return false;
  judge(to);
  return true;
}

/// Where a force jumps, as that of skin which comes round an edge does, every step across raises
/// the merit, and yet it may be lower some steps farther on: a few are taken without asking
/// (watchdog; Chamberlain et al. 1982, Math Program Study 16:1). False, and nothing changed, if it
/// isn't.
bool LeastEffort::pass_a_jump(Look& now, const Descent& how) {
  const double enough = (1.0 - how.least_gain) * now.merit();
  Look at = now;
  for (int k = 0; k < kMostUnasked; ++k) {
    if (!differentiate(at)) return false;
    Look next;
    if (!go(at, solve_effort(program(at, how.first_damping)).motion, next)) return false;
    at = std::move(next);
    if (at.merit() < enough) {
      now = std::move(at);
      return true;
    }
  }
  return false;
}

/// Goes down from a state until steps promise too little.
void LeastEffort::descend(Look& now, const Descent& how, const Progress& progress,
                          EffortRest& rest) {
  target_ = std::max(how.level * asked_, how.least * unit());
  price_ = how.price;
  judge(now);
  rest.merit.assign(1, now.merit());
  double damping = how.first_damping, growth = kGrowth;
  bool is_new = true;       // the state, since its derivatives were taken
  double last_share = 0.0;  // of what was promised
  int refused = 0;
  // Nothing is missing, and what else there is to gain, by however long a way, is next to nothing:
  // the last of the missing forces would cost as many contacts as all before.
  const auto is_at_rest = [&] {
    if (is_in_need(now, how)) return false;
    const EffortSolution free = solve_effort(program(now, kFree));
    return now.effort.value - missing(now) - free.value < kNoGain * now.merit();
  };
  const auto passes_a_jump = [&] {
    if (!is_in_need(now, how) || !pass_a_jump(now, how)) return false;
    refused = 0;
    damping = how.first_damping;
    growth = kGrowth;
    is_new = true;
    last_share = 0.0;
    rest.merit.push_back(now.merit());
    return true;
  };
  for (int tries = 0; tries < how.most_tries; ++tries) {
    progress.throw_if_cancelled();
    ++rest.iterations;
    progress.update(std::min(1.0, rest.iterations / kUsualSteps), "letting the grasp come to rest");
    if (refused >= (is_in_need(now, how) ? kMostInNeed : kMostRefused) && !passes_a_jump()) break;
    // Derivatives serve as long as steps keep what they promise; where to end is never theirs.
    if (is_new && last_share < kKept) {
      if (!differentiate(now)) return;
      is_new = false;
    }
    EffortSolution step = solve_effort(program(now, damping));
    double promised = now.merit() - (step.value + now.off);
    // Shorter ways that promise as much are better ones.
    for (double used = damping; refused > 0; used *= kShorter) {
      EffortSolution shorter = solve_effort(program(now, kShorter * used));
      const double left = now.merit() - (shorter.value + now.off);
      if (!(left > kAsGood * promised)) break;
      promised = left;
      step = std::move(shorter);
    }
    if (promised < how.least_gain * now.merit() || is_at_rest()) {
      if (!is_new && !passes_a_jump()) break;
      last_share = 0.0;
      continue;
    }
    // Damping after Madsen, Nielsen & Tingleff 2004 (Methods for non-linear least squares problems,
    // section 3.2).
    const auto refuse = [&] {
      ++refused;
      damping *= growth;
      growth *= 2.0;
    };
    Look next;
    if (!go(now, step.motion, next)) {
      refuse();
      continue;
    }
    // Forces bend away from their tangent: from there back onto the equilibrium, by ways as short
    // as can be (second-order correction; Nocedal & Wright 2006, section 18.3).
    for (int c = 0; c < kMostCorrections && now.merit() - next.merit() < kPoor * promised; ++c) {
      const EffortSolution back = solve_effort(program(next, kBackDamping));
      if (next.merit() - (back.value + next.off) < kWorthwhile * promised) break;
      Look corrected;
      if (!go(next, back.motion, corrected) || corrected.merit() >= next.merit()) break;
      next = std::move(corrected);
    }
    const double share = (now.merit() - next.merit()) / promised;
    last_share = share;
    if (share <= kLeastShare) {
      refuse();
      continue;
    }
    damping *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * share - 1.0, 3));
    growth = kGrowth;
    refused = 0;
    now = std::move(next);
    is_new = true;
    rest.merit.push_back(now.merit());
  }
}

/// A state after the motion that takes `before` to `after`.
GripState moved_alike(const GripState& state, const GripState& before, const GripState& after) {
  GripState to = state;
  for (int j = 0; j < kGripJoints; ++j) {
    to.posture[grip_dof(j)] += after.posture[grip_dof(j)] - before.posture[grip_dof(j)];
  }
  to.product_from_hand =
      state.product_from_hand * before.product_from_hand.inverse() * after.product_from_hand;
  return to;
}

/// Where the search is to go: what is asked for, and where the product is held. False, and the
/// status says why, if there is no contact to begin with.
bool LeastEffort::begin(Look& now, EffortRest& rest) {
  if (!look(start_, now)) return false;
  rest.status = EffortRest::Status::kNoContact;
  if (now.grip.force == 0.0) return false;
  held_at_ = now.centre;
  held_point_ = start_.product_from_hand * held_at_;
  if (task_->is_hardest) {
    asked_ = kTooMuch * unit();
  } else if (task_->force) {
    asked_ = *task_->force;
  } else if (skin_.look(start_, kAccuracy)) {
    Look closed;
    closed.state = start_;
    closed.grip = skin_.grip();
    measure(skin_, closed);
    const double load = task_->load.force.norm();
    switch (task_->measure) {
      case EffortMeasure::kSqueeze:
        // Under a load what two opposed contacts need to hold it by friction is added.
        asked_ = closed.measured + (task_->friction > 0.0 ? 0.5 * load / task_->friction : 0.0);
        break;
      case EffortMeasure::kPush:
      case EffortMeasure::kTurn:
        asked_ = closed.measured;
        break;
      case EffortMeasure::kHang:
      case EffortMeasure::kNone:
        asked_ = load;
    }
    if (!(asked_ > 0.0)) return false;
  } else {
    rest.status = EffortRest::Status::kNoSolution;
    return false;
  }
  rest.status = EffortRest::Status::kNoSolution;
  return true;
}

bool LeastEffort::rest_on_coarse_skin(const GripState* from, const Progress& progress, Look& now,
                                      EffortRest& rest) {
  if (from != nullptr && (!look(*from, now) || now.grip.force == 0.0)) return false;
  for (const Descent& how : kOnCoarseSkin) {
    if (from == nullptr || how.level == 1.0) descend(now, how, progress, rest);
  }
  rest.on_coarse_skin = now.state;
  return true;
}

EffortRest LeastEffort::run(const SearchStart* from, const Progress& progress) {
  EffortRest rest;
  Look now;
  if (!begin(now, rest)) return rest;
  GripState state = from != nullptr ? from->on_skin : start_;
  if (from == nullptr && is_whole_hand() && rest_on_coarse_skin(nullptr, progress, now, rest)) {
    state = now.state;
  } else if (from != nullptr && from->on_coarse_skin &&
             rest_on_coarse_skin(&*from->on_coarse_skin, progress, now, rest) &&
             !is_in_need(now, kOnCoarseSkin[1])) {
    state = moved_alike(from->on_skin, *from->on_coarse_skin, now.state);
  }
  is_coarse_ = false;
  if (!look(state, now)) return rest;
  if (now.grip.force == 0.0) {
    rest.status = EffortRest::Status::kNoContact;
    return rest;
  }
  if (is_whole_hand()) {
    descend(now, kOnSkin, progress, rest);
  } else {
    for (const Descent& how : kWithFingertips) descend(now, how, progress, rest);
  }
  if (is_in_need(now, is_whole_hand() ? kOnSkin : kWithFingertips[1])) {
    descend(now, kInNeed, progress, rest);
  }
  if (!skin_.is_at(now.state) && !skin_.look(now.state, kAccuracy)) return rest;
  rest.status = EffortRest::Status::kSolved;
  finish(now, rest);
  return rest;
}

std::optional<GripState> LeastEffort::run_on_coarse_skin(const GripState* from,
                                                         const Progress& progress) {
  EffortRest rest;
  Look now;
  if (!is_whole_hand() || !begin(now, rest)) return std::nullopt;
  rest_on_coarse_skin(from, progress, now, rest);
  return rest.on_coarse_skin;
}

GripVector LeastEffort::next(const GripState& state, const Vec3& held_at, double force,
                             double damping) {
  is_coarse_ = false;
  held_at_ = held_at;
  held_point_ = start_.product_from_hand * held_at_;
  target_ = force;
  price_ = 1.0;
  Look now;
  if (!look(state, now)) return GripVector::Zero();
  judge(now);
  if (!differentiate(now)) return GripVector::Zero();
  return solve_effort(program(now, damping)).motion;
}

}  // namespace

GripState rest_after_change(const contact::PreparedHand& hand, const product::Product& product,
                            const product::Product& changed, const EffortRest& rest, double force,
                            const EffortTask& task, const contact::ContactOptions& contact) {
  LeastEffort before(hand, product, rest.start, task, contact);
  LeastEffort after(hand, changed, rest.start, task, contact);
  // What is left where the search ended is no change.
  const double asked = force * rest.asked;
  const GripVector way = after.next(rest.state, rest.held_at, asked, kFollowed) -
                         before.next(rest.state, rest.held_at, rest.asked, kFollowed);
  GripState state = moved(rest.state, way, before.centre());
  for (int k = 0; k < kFollowedBack; ++k) {
    const GripVector back = after.next(state, rest.held_at, asked, kBackDamping);
    state = moved(state, back, after.centre());
  }
  return state;
}

EffortRest rest_with_least_effort(const contact::PreparedHand& hand,
                                  const product::Product& product, const GripState& closed,
                                  const EffortTask& task, const contact::ContactOptions& contact,
                                  const Progress& progress, const SearchStart* from) {
  return LeastEffort(hand, product, closed, task, contact).run(from, progress);
}

std::optional<GripState> rest_on_coarse_skin(const contact::PreparedHand& hand,
                                             const product::Product& product,
                                             const GripState& closed, const EffortTask& task,
                                             const contact::ContactOptions& contact,
                                             const Progress& progress, const GripState* from) {
  return LeastEffort(hand, product, closed, task, contact).run_on_coarse_skin(from, progress);
}

}  // namespace palmar::grasp
