// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/balance.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/grasp/rest/fingertip_closing.h"
#include "palmar/grasp/rest/grip_effort.h"
#include "palmar/grasp/rest/grip_mechanics.h"
#include "palmar/grasp/rest/press_down.h"
#include "palmar/grasp/rest/thumb_meeting.h"
#include "palmar/grasp/rest/way_words.h"
#include "palmar/hand/skeleton.h"

namespace palmar {
namespace {

constexpr double kBalanced = 0.01;  // residual over grip force; what counts as balanced
constexpr double kJointAim = kNegligibleMoment;  // residual moment over the strongest muscle moment
constexpr double kJointSaid = 0.05;              // the same; more is reported
constexpr double kLevelAim = 0.005;              // of the grip force asked for
constexpr int kMostSteps = 120;
constexpr int kUsualSteps = 60;  // not there by then, the search goes on only while it gets nearer
constexpr int kVainSteps = 25;   // without getting nearer: it goes round in circles
constexpr int kLastSteps = 5;    // the same, where the nearest state so far counts as balanced
constexpr double kLongestStep = 4.0;  // mm, of any skin or of the product
constexpr double kLeastRelaxation = 0.3;
constexpr double kShifted = 5.0;  // mm; a precision grip in which the product shifts more is poor
constexpr double kLongestPress = 0.7;  // mm, of fingertips in one step
constexpr double kLongestTurn = 0.06;  // rad, of what they hold
constexpr double kNothing = 0.1;       // N; less left over is nothing to a hand: the weight of 10 g
constexpr double kReach = 40.0;        // mm; arm by which turns are counted as way
constexpr double kOut = 25.0;          // mm; a product that went farther has left the hand
// the same, with muscles of least effort: then others are tried that keep it in place; our choice
constexpr double kWandered = 12.0;
constexpr double kOutTurn = 0.8;                        // rad
constexpr double kMostLooser = 0.4, kMostFirmer = 0.6;  // of the squeeze, in one step
// Of what is missing to rest, to which the forces that say so are found; and at most.
constexpr double kForcesShare = 0.2, kRoughForces = 0.1;
constexpr double kLostShare = 0.05;  // of the grip force at the start; less is a lost grip
// mm; pulp of thumb and finger pressed together, 2 mm each: stiff ones close no further; our choice
constexpr double kPulpGive = 4.0;
constexpr double kSoftest = 0.02;  // of the mean stiffness of joints and of the product: the least

/// How a grasp is brought to rest.
enum class Way {
  kLeastEffort,  ///< by the muscles, wherever the product comes to rest
  kInPlace,      ///< by the muscles, so that the product stays where it was taken hold of
  kStiff         ///< joints held as they were closed
};

/// One run of the search for rest.
class Settling {
 public:
  Settling(const PreparedHand& hand, const Product& product, const Grasp& grasp,
           const BalanceOptions& options, const ContactOptions& contact, Way way)
      : hand_(&hand.hand()),
        options_(&options),
        way_(way),
        is_by_muscles_(way != Way::kStiff),
        squeezes_(is_power(grasp.grip) && grasp.grip != Grip::kFixedHook),
        asked_(options.asked_grip_force(grasp.grip)),
        has_level_(is_power(grasp.grip) || asked_),
        start_{grasp.posture, grasp.product_from_hand},
        state_(start_),
        meeting_(hand.hand(), start_.posture),
        has_skin_on_skin_(contact.skin_on_skin),
        closing_(hand.hand(), grasp),
        mechanics_(hand, product, contact, options.friction, start_),
        effort_(hand.hand(), options.activation.value_or(options.strength), start_.posture,
                options.wrist) {
    const bool needs_centre = options.load.weight > 0.0 || !options.load.force.isZero(0.0);
    has_load_ = needs_centre || !options.load.torque.isZero(0.0);
    load_ =
        wrench_of(options.load, needs_centre ? centre_of_volume(product.mesh) : Vec3(Vec3::Zero()));
    // Hooked fingers carry what pulls at them; they don't squeeze.
    const bool is_hook = grasp.grip == Grip::kFixedHook;
    has_level_ = !is_hook && !options.activation && (has_level_ || extra_grip() > 0.0);
  }

  Balance run(const Progress& progress);
  const GripState& state() const { return state_; }

 private:
  struct Misfit {
    GripVector outside = GripVector::Zero();   ///< without muscles; N, N mm
    GripVector residual = GripVector::Zero();  ///< with them
    GripMatrix stiffness = GripMatrix::Zero();
    double force = 0.0, moment = 0.0;  ///< on the product, N and N mm
    double of_product = 0.0;           ///< those over the grip force
    double of_joints = 0.0;            ///< largest moment left over the strongest muscle moment
    double of_level = 0.0;             ///< of the grip force against the one asked for
    double sum() const { return of_product + of_joints + of_level; }
    /// All but at rest.
    bool is_near() const {
      return of_product < 0.5 * kBalanced && of_joints < kJointAim && of_level < kLevelAim;
    }
  };

  bool is_stuck(int joint, double residual) const;
  void add_load(GripVector& residual) const;
  double wrist_load() const;
  std::vector<ThumbPress> presses() const;
  double extra_grip() const;
  Misfit misfit(double grip) const;
  void step(const Misfit& misfit, double missing);
  GripVector step_by_muscles(const Misfit& misfit, const std::vector<int>& free,
                             const Eigen::MatrixXd& k, double missing);
  GripVector step_stiff(const Misfit& misfit, const std::vector<int>& free,
                        const Eigen::MatrixXd& k, double missing) const;
  void step_fingertips(const Misfit& misfit, double missing);
  double share_of(const GripVector& way, double longest);
  void move_product(const Vec3& shift, const Vec3& turn);
  void finish(Balance& balance);
  bool judge_way(Balance& balance) const;

  const Hand* hand_;
  const BalanceOptions* options_;
  Way way_;
  bool is_by_muscles_;
  bool squeezes_;            // fingers against the palm or the thumb: a power grip, but for a hook
  double load_share_ = 1.0;  // of the load that is put on; all of it once the grip is firm enough
  std::optional<double> asked_;  // grip force, N
  bool has_level_;               // the squeeze is brought to the grip force asked for
  GripState start_, state_;
  ThumbMeeting meeting_;
  bool has_skin_on_skin_;     // what fingers do to each other is in the contact
  FingertipClosing closing_;  // how a precision grip presses
  GripMechanics mechanics_;
  Wrench load_;  // product frame
  bool has_load_ = false;
  double target_ = 0.0;  // grip force, N
  GripEffort effort_;
  bool is_at_limit_ = false;  // the muscles can't give the squeeze asked for
  double relaxation_ = 1.0;   // share of a step that is taken
  GripVector last_way_ = GripVector::Zero();
  Vec3 moved_ = Vec3::Zero();  // of the product, hand frame, mm
};

void Settling::add_load(GripVector& residual) const {
  // From the origin of the product frame to the centre of contact in the hand frame.
  const Rigid3 hand_from_product = state_.product_from_hand.inverse();
  const Vec3 centre = state_.product_from_hand * mechanics_.centre();
  residual.segment<3>(kGripJoints) += load_share_ * (hand_from_product.rotation * load_.force);
  residual.tail<3>() +=
      load_share_ * (hand_from_product.rotation * (load_.moment - centre.cross(load_.force)));
}

/// Of the thumb on fingers, unless the contact has it.
std::vector<ThumbPress> Settling::presses() const {
  return has_skin_on_skin_ ? std::vector<ThumbPress>{} : meeting_.presses(state_.posture);
}

/// Moment of the load about the wrist: what the grip itself does there adds up to nothing.
double Settling::wrist_load() const {
  if (!has_load_) return 0.0;
  const Rigid3 hand_from_product = state_.product_from_hand.inverse();
  return load_share_ * wrist_moment(*hand_, hand_from_product.rotation * load_.force,
                                    hand_from_product.translation,
                                    hand_from_product.rotation * load_.moment);
}

/// People press the harder the heavier a thing is: by what two opposed contacts need to hold the
/// load by friction (Westling & Johansson 1984), N.
double Settling::extra_grip() const {
  return options_->friction > 0.0 ? 0.5 * load_.force.norm() / options_->friction : 0.0;
}

/// As far as the joint goes and pushed against it.
bool Settling::is_stuck(int joint, double residual) const {
  const JointDof& dof = hand_->skeleton.dof(grip_dof(joint));
  const double angle = state_.posture[dof.dof];
  const double upper = dof.upper + (GripEffort::is_free(joint) ? kPassiveRange : 0.0);
  return (angle >= upper - 1e-9 && residual > 0.0) || (angle <= dof.lower + 1e-9 && residual < 0.0);
}

/// What is missing to rest in the state that mechanics_ looks at.
Settling::Misfit Settling::misfit(double grip) const {
  Misfit result;
  result.residual = mechanics_.force();
  result.stiffness = mechanics_.stiffness();
  add_load(result.residual);
  if (is_by_muscles_) {
    effort_.add_passive(result.residual, result.stiffness);
    result.outside = result.residual;
    result.residual += effort_.moments();
    const double strongest = effort_.strongest();
    for (int j = 0; j < kGripJoints; ++j) {
      if (!effort_.is_judged(j) || is_stuck(j, result.residual[j])) continue;
      result.of_joints = std::max(result.of_joints, std::abs(result.residual[j]) / strongest);
    }
  }
  if (has_level_) result.of_level = std::abs(grip / target_ - 1.0);
  result.force = result.residual.segment<3>(kGripJoints).norm();
  result.moment = result.residual.tail<3>().norm();
  result.of_product = std::max(result.force, result.moment / mechanics_.arm()) / grip;
  return result;
}

/// One Newton step towards rest and the grip force asked for, with the activations of the muscles
/// (GripEffort) or, where joints are stiff, the level of a common closing as unknowns beside the
/// coordinates:
///
///     stiffness dx = residual + muscles,    squeeze . dx = missing sum of normal forces.
void Settling::step(const Misfit& misfit, double missing) {
  std::vector<int> free;
  for (int j = 0; j < kGripJoints; ++j) {
    if (is_by_muscles_ && GripEffort::is_free(j) && effort_.is_judged(j) &&
        !is_stuck(j, misfit.residual[j])) {
      free.push_back(j);
    }
  }
  const auto joints = static_cast<Eigen::Index>(free.size());
  for (int j = kGripJoints; j < kGripCoordinates; ++j) free.push_back(j);
  Eigen::MatrixXd k = misfit.stiffness(free, free);
  const auto stiffen = [&](Eigen::Index begin, Eigen::Index count) {
    if (count == 0) return;
    k.diagonal().segment(begin, count).array() +=
        kSoftest * k.diagonal().segment(begin, count).mean() + 1e-9;
  };
  stiffen(0, joints);
  stiffen(joints, 3);
  stiffen(joints + 3, 3);
  GripVector way = is_by_muscles_ ? step_by_muscles(misfit, free, k, missing)
                                  : step_stiff(misfit, free, k, missing);
  double longest = std::max(way.segment<3>(kGripJoints).norm(), kReach * way.tail<3>().norm());
  for (int j = 0; j < kGripJoints; ++j) longest = std::max(longest, kReach * std::abs(way[j]));
  way *= share_of(way, longest);

  Posture turned = state_.posture;
  for (int j = 0; j < kGripJoints; ++j) {
    const JointDof& dof = hand_->skeleton.dof(grip_dof(j));
    const double angle = state_.posture[dof.dof];
    const double upper = dof.upper + (GripEffort::is_free(j) ? kPassiveRange : 0.0);
    turned[dof.dof] =
        std::clamp(angle + way[j], std::min(dof.lower, angle), std::max(upper, angle));
  }
  state_.posture = turned;
  move_product(way.segment<3>(kGripJoints), way.tail<3>());
}

GripVector Settling::step_by_muscles(const Misfit& misfit, const std::vector<int>& free,
                                     const Eigen::MatrixXd& k, double missing) {
  std::optional<double> asked;
  if (!options_->activation) {
    const double sum = mechanics_.grip().sum_of_normals;
    asked = has_level_ ? std::clamp(missing, -kMostLooser * sum, kMostFirmer * sum) : 0.0;
  }
  const GripEffort::Step step =
      effort_.solve(free, k, misfit.outside, misfit.stiffness, mechanics_.squeeze(), asked,
                    way_ == Way::kInPlace ? &moved_ : nullptr);
  is_at_limit_ = step.is_short;
  return step.way;
}

GripVector Settling::step_stiff(const Misfit& misfit, const std::vector<int>& free,
                                const Eigen::MatrixXd& k, double missing) const {
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(k);
  const auto solved = [&](const GripVector& right) {
    const Eigen::VectorXd part = factor.solve(Eigen::VectorXd(right(free)));
    GripVector whole = GripVector::Zero();
    for (std::size_t i = 0; i < free.size(); ++i) {
      whole[free[i]] = part[static_cast<Eigen::Index>(i)];
    }
    return whole;
  };
  GripVector way = solved(misfit.residual);
  if (!has_level_) return way;
  GripVector closing = GripVector::Zero();
  std::array<bool, kFingerCount> has_met{};
  for (const ThumbPress& press : meeting_.presses(state_.posture)) {
    if (press.overlap > kPulpGive) has_met[index_of(press.finger)] = true;
  }
  for (int j = 0; j < kGripJoints; ++j) {
    const bool closes = is_flexion(grip_dof(j)) && mechanics_.is_loaded()[j];
    if (closes && !has_met[index_of(grip_finger(j))]) closing[j] = 1.0;
  }
  const GripVector gain = solved(-(misfit.stiffness * closing)) + closing;
  const double rate = mechanics_.squeeze().dot(gain);
  if (rate > 1e-12) way += (missing - mechanics_.squeeze().dot(way)) / rate * gain;
  return way;
}

/// How much of a step is taken; `longest` is the longest way that something goes in it, mm.
double Settling::share_of(const GripVector& way, double longest) {
  // Going to and fro says that forces change faster than the stiffness says: shorter steps.
  GripVector scaled = way;
  scaled.head<kGripJoints>() *= kReach;
  scaled.tail<3>() *= kReach;
  const double cosine = scaled.dot(last_way_) / (scaled.norm() * last_way_.norm() + 1e-300);
  relaxation_ = std::clamp(relaxation_ * (cosine < -0.2  ? 0.6
                                          : cosine > 0.2 ? 1.25
                                                         : 1.0),
                           kLeastRelaxation, 1.0);
  last_way_ = scaled;
  return relaxation_ * std::min(1.0, kLongestStep / longest);
}

void Settling::move_product(const Vec3& shift, const Vec3& turn) {
  Rigid3 motion;
  if (turn.norm() > 0.0) {
    motion = Rigid3::about_axis(turn.normalized(), mechanics_.centre(), turn.norm());
  }
  motion.translation += shift;
  moved_ += shift;
  state_.product_from_hand = state_.product_from_hand * motion.inverse();
}

/// The same for a precision grip: joints are held stiff, and fingertips go straight into the
/// product, all alike, until the grip force is there.
void Settling::step_fingertips(const Misfit& misfit, double missing) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> k = misfit.stiffness.bottomRightCorner<6, 6>();
  for (const int begin : {0, 3}) {
    k.diagonal().segment<3>(begin).array() +=
        kSoftest * k.diagonal().segment<3>(begin).mean() + 1e-9;
  }
  const Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>> factor(k);
  const Vector6 squeeze = mechanics_.squeeze().tail<6>();
  Vector6 force = misfit.residual.tail<6>();
  Posture rate;
  double level = 0.0;
  if (has_level_) {
    rate = closing_.rate(state_.posture, state_.product_from_hand, missing > 0.0 ? 1.0 : -1.0);
    const GripMechanics::Closing closing = mechanics_.closing(state_.posture, rate);
    const double per_mm = closing.squeeze + squeeze.dot(factor.solve(closing.force));
    if (per_mm > 1e-12) {
      level = std::clamp((missing - squeeze.dot(factor.solve(force))) / per_mm, -kLongestPress,
                         kLongestPress);
      force += level * closing.force;
    }
  }
  // A thing between two fingertips turns much more easily than it moves: the turn is limited by
  // itself, and the shift is that which suits it.
  Vector6 way = factor.solve(force);
  const double turn = way.tail<3>().norm();
  way.tail<3>() *= std::min(1.0, kLongestTurn / std::max(turn, 1e-12));
  const Eigen::PartialPivLU<Eigen::Matrix3d> shift(k.topLeftCorner<3, 3>());
  way.head<3>() = shift.solve(Vec3(force.head<3>() - k.topRightCorner<3, 3>() * way.tail<3>()));
  GripVector whole = GripVector::Zero();
  whole.tail<6>() = way;
  const double share = share_of(whole, std::max(way.head<3>().norm(), 1e-12));
  for (int d = 0; d < kDofCount; ++d) {
    const JointDof& dof = hand_->skeleton.dof(static_cast<Dof>(d));
    double& angle = state_.posture[dof.dof];
    angle = std::clamp(angle + share * level * rate[dof.dof], std::min(dof.lower, angle),
                       std::max(dof.upper, angle));
  }
  move_product(share * way.head<3>(), share * way.tail<3>());
}

bool Settling::judge_way(Balance& balance) const {
  const Rigid3 motion = state_.product_from_hand.inverse() * start_.product_from_hand;
  balance.turned = Eigen::AngleAxisd(motion.rotation).angle();
  balance.moved = moved_.norm();
  const double out = way_ == Way::kLeastEffort ? kWandered : kOut;
  return balance.moved > out || balance.turned > kOutTurn;
}

void Settling::finish(Balance& balance) {
  const Squeeze grip = mechanics_.grip();
  balance.grip_force = grip.force;
  balance.sum_of_normals = grip.sum_of_normals;
  balance.friction = options_->friction;
  balance.friction_use = mechanics_.friction_use();
  balance.friction_force = mechanics_.friction_force();
  balance.fallbacks = mechanics_.fallbacks();
  if (squeezes_) {
    const double limit = options_->activation.value_or(options_->strength);
    effort_.look(state_.posture, mechanics_.is_loaded(), presses(), wrist_load());
    const GripEffort::Strength strength = effort_.strength_of(mechanics_.force());
    const double share = strength.share * limit / options_->strength;
    if (std::isfinite(share)) balance.strength_use = share;
    balance.is_by_wrist = strength.is_by_wrist;
    balance.is_overloaded = !(share <= 1.0 + (is_by_muscles_ ? kJointSaid : 0.0));
    balance.joint_load = strength.load;
  } else {
    HandLoad& load = balance.joint_load.emplace();
    for (int j = 0; j < kGripJoints; ++j) {
      load.digit[j / kDigitDofs][j % kDigitDofs] = mechanics_.force()[j];
    }
    load.wrist = wrist_load();
  }
  judge_way(balance);
}

Balance Settling::run(const Progress& progress) {
  Balance balance;
  double start_grip = 0.0;
  Misfit now;
  struct {
    GripState state;
    Misfit misfit;
    GripEffort::Activations muscles;
    Vec3 moved = Vec3::Zero();
    int step = 0;
  } best;
  bool gives_up = false;  // the best state found is looked at once more
  // Without one asked for, the squeeze of the first state is the goal.
  double accuracy = asked_ ? kRoughForces : kForcesAccuracy;
  best.misfit.of_product = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    progress.throw_if_cancelled();
    balance.iterations = i;
    if (!mechanics_.look(state_, accuracy)) {
      balance.status = BalanceStatus::kFailed;
      balance.message = "the contact could not be solved while the grasp came to rest";
      break;
    }
    if (is_by_muscles_) {
      effort_.look(state_.posture, mechanics_.is_loaded(), presses(), wrist_load());
    }
    const double grip = mechanics_.grip().force;
    if (i == 0) {
      start_grip = grip;
      target_ = asked_.value_or(grip + extra_grip());
      if (grip == 0.0) {
        balance.status = BalanceStatus::kNoContact;
        balance.message = "nothing is touched, so nothing can come to rest";
        break;
      }
    }
    const bool is_lost = grip < kLostShare * std::min(start_grip, target_);
    if (is_lost || judge_way(balance)) {
      balance.status = BalanceStatus::kSlipsOut;
      balance.slip = moved_.norm() > 0.0 ? Vec3(moved_.normalized()) : Vec3(Vec3::UnitY());
      balance.message = balance.turned > kOutTurn && balance.moved < kOut
                            ? fmt::format("turns by more than {:.0f} degrees in the hand",
                                          kOutTurn * kDegreesPerRadian)
                            : "slips out, towards " + way_words(*hand_, *balance.slip);
      break;
    }

    // People take hold before they lift.
    load_share_ =
        has_load_ && has_level_ ? std::clamp((grip / target_ - 0.5) / 0.45, 0.0, 1.0) : 1.0;
    now = misfit(grip);
    balance.residual_force = now.force;
    balance.residual_moment = now.moment;
    balance.residual_share = now.of_product;
    const bool is_there = now.of_product < options_->aim && now.of_joints < kJointAim &&
                          (now.of_level < kLevelAim || is_at_limit_);
    if (is_there && accuracy > kForcesAccuracy) {
      accuracy = kForcesAccuracy;  // the same state again
      continue;
    }
    if (is_there || gives_up) {
      balance.status = now.of_product < kBalanced || now.of_product * grip < kNothing
                           ? BalanceStatus::kBalanced
                           : BalanceStatus::kNotConverged;
      break;
    }
    if (now.sum() < best.misfit.sum()) best = {state_, now, effort_.activations(), moved_, i};
    progress.update(std::min(1.0, static_cast<double>(i) / kMostSteps),
                    "letting the grasp come to rest");
    accuracy = std::clamp(kForcesShare * now.sum(), kForcesAccuracy, kRoughForces);
    gives_up = i >= kMostSteps || (i >= kUsualSteps && i - best.step >= kVainSteps) ||
               (best.misfit.is_near() && i - best.step >= kLastSteps);
    if (!gives_up) {
      const double missing = (target_ / grip - 1.0) * mechanics_.grip().sum_of_normals;
      is_by_muscles_ || closing_.is_empty() ? step(now, missing) : step_fingertips(now, missing);
    } else {
      accuracy = kForcesAccuracy;
      state_ = best.state;
      effort_.set(best.muscles);
      moved_ = best.moved;
    }
  }
  if (balance.status == BalanceStatus::kBalanced && load_share_ < 1.0) {
    balance.status = BalanceStatus::kSlipsOut;
    const Vec3 pull = state_.product_from_hand.rotation.conjugate() * load_.force;
    if (pull.norm() > 0.0) balance.slip = pull.normalized();
    balance.message = fmt::format(
        "slips out under its load: the hand reaches a grip force of {:.0f} N, "
        "{:.0f} N are needed",
        mechanics_.grip().force, target_);
  }
  if (balance.status == BalanceStatus::kBalanced) {
    balance.message =
        fmt::format("in balance at a grip force of {:.0f} N", mechanics_.grip().force);
    if (now.of_level > 0.05) {
      balance.message +=
          fmt::format("; {:.0f} N were requested, which the hand doesn't reach", target_);
    }
    if (now.of_joints > kJointSaid) {
      balance.message += fmt::format("; a finger joint is still {:.0f} % off its muscles' moment",
                                     100.0 * now.of_joints);
    }
  } else if (balance.status == BalanceStatus::kNotConverged) {
    balance.message = fmt::format("not in balance after {} steps: ", balance.iterations) +
                      fmt::format("{:.1f} N are left over at a grip force of {:.0f} N",
                                  balance.residual_force, mechanics_.grip().force);
  }
  finish(balance);
  return balance;
}

/// A precision grip comes to rest; if it doesn't where fingertips were first put, people put them
/// elsewhere: where the search found the next best places.
Balance settle_precision(const PreparedHand& hand, const Product& product, Grasp& grasp,
                         const BalanceOptions& options, const ContactOptions& contact,
                         const Progress& progress) {
  const std::size_t others = grasp.status == GraspStatus::kHeld ? grasp.runners_up.size() : 0;
  Balance first;
  Grasp nearest = grasp;  // where it is at rest or the first comes near to that
  for (std::size_t i = 0; i <= others; ++i) {
    // Runners-up of another grip are other holds: never taken unasked.
    if (i > 0 && grasp.runners_up[i - 1].grip != grasp.grip) continue;
    Grasp there = grasp;
    if (i > 0) take_runner_up(hand.hand(), product, i - 1, there);
    if (i > 0 && there.status != GraspStatus::kHeld) continue;
    Settling settling(hand, product, there, options, contact, Way::kStiff);
    Balance balance = settling.run(progress);
    const bool is_at_rest = balance.status == BalanceStatus::kBalanced;
    const bool is_near = balance.status == BalanceStatus::kNotConverged;
    if (is_at_rest || is_near) {
      there.posture = settling.state().posture;
      there.product_from_hand = settling.state().product_from_hand;
    }
    if (is_at_rest && balance.moved < kShifted) {
      if (i > 0) there.message += "; the place first chosen: " + first.message;
      grasp = std::move(there);
      return balance;
    }
    if (i == 0 || (is_at_rest && first.status != BalanceStatus::kBalanced)) {
      if (is_near || is_at_rest) nearest = std::move(there);
      first = std::move(balance);
    }
    if (first.status == BalanceStatus::kNoContact || first.status == BalanceStatus::kFailed) break;
  }
  grasp = std::move(nearest);
  return first;
}

}  // namespace

Balance balance_grasp(const PreparedHand& hand, const Product& product, Grasp& grasp,
                      const BalanceOptions& options, const ContactOptions& contact,
                      const Progress& progress) {
  options.check();
  contact.check();
  if (!options.is_on) return {};
  ContactOptions plain = contact;
  plain.error_band = false;
  if (is_non_prehensile(grasp.grip)) {
    return press_down(hand, product, grasp, options, plain, progress);
  }
  if (!is_power(grasp.grip)) {
    return settle_precision(hand, product, grasp, options, plain, progress);
  }
  // A large body slips past muscles of least effort. Then they are tried so that it stays where it
  // is, and last the hand stiff: all joints held as they were closed. Hooked fingers meet no palm
  // that would hold against them: stiff from the start.
  const bool has_muscles = grasp.grip != Grip::kFixedHook;
  Balance balance;
  for (const Way way : {Way::kLeastEffort, Way::kInPlace, Way::kStiff}) {
    if (way != Way::kStiff && !has_muscles) continue;
    Settling settling(hand, product, grasp, options, plain, way);
    Balance attempt = settling.run(progress);
    const bool is_first = way == Way::kLeastEffort || !has_muscles;
    const bool is_at_rest = attempt.status == BalanceStatus::kBalanced;
    const bool slips = attempt.status == BalanceStatus::kSlipsOut;
    if (is_at_rest || (is_first && attempt.status == BalanceStatus::kNotConverged)) {
      grasp.posture = settling.state().posture;
      grasp.product_from_hand = settling.state().product_from_hand;
    }
    if (is_at_rest || is_first) balance = std::move(attempt);
    if (is_at_rest && way == Way::kStiff && has_muscles) {
      balance.message += ", by fingers that are held stiff";
    }
    if (is_at_rest && balance.is_overloaded) {
      balance.message +=
          balance.strength_use
              ? fmt::format(", which takes {:.1f} times the strength of the muscles{}",
                            *balance.strength_use, balance.is_by_wrist ? " of the wrist" : "")
              : ", which no muscles could";
    }
    if (is_at_rest || (is_first && !slips)) break;
  }
  return balance;
}

}  // namespace palmar
