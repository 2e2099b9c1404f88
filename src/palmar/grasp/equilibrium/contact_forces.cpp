// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/contact_forces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/contact/contact_normals.h"
#include "palmar/core/enum_index.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kRates = 1e-2;    // relative accuracy of derivatives
constexpr double kLeastWay = 0.1;  // mm; a way that is none
constexpr double kStick = 0.75;    // 3/4 mu d: where friction turns from sticking to slipping

/// What one region of the skin carries.
struct RegionSum {
  double force = 0.0;                       ///< N
  double work = 0.0;                        ///< force times depth, N mm
  double depth = 0.0;                       ///< largest, mm
  GripVector opening = GripVector::Zero();  ///< force times change of the gaps, N per unit
};

}  // namespace

ContactForces::ContactForces(const contact::PreparedHand& hand, const product::Product& product,
                             const contact::ContactOptions& options, double friction,
                             const GripState& start)
    : hand_(&hand),
      skin_(hand.hand()),
      product_(&product),
      friction_(friction),
      solver_(hand, options) {
  anchor_ = hand::pose_skin(hand.hand(), start.posture);
  for (Vec3& point : anchor_) point = start.product_from_hand * point;
}

bool ContactForces::is_at(const GripState& state) const {
  const geometry::Rigid3 &a = state_.product_from_hand, &b = state.product_from_hand;
  return state_.posture.angle == state.posture.angle && a.translation == b.translation &&
         a.rotation.coeffs() == b.rotation.coeffs();
}

bool ContactForces::look(const GripState& state, double accuracy) {
  state_ = state;
  posed_ = hand::pose_skin(hand_->hand(), state.posture);
  hand_from_product_ = state.product_from_hand.rotation.conjugate();
  loaded_.clear();
  pressed_.clear();
  depth_.clear();
  in_product_.clear();
  solver_.solve_forces(posed_, state.product_from_hand, *product_->distance, accuracy, contact_);
  fallbacks_ += contact_.fallbacks;
  if (contact_.status == contact::ContactStatus::kNotConverged) return false;
  loaded_ = contact::loaded_vertices(contact_);
  normal_.clear();
  slope_.clear();
  for (const int v : loaded_) {
    normal_.push_back(hand_from_product_ * solver_.pressed_along(v));
    slope_.push_back(hand_from_product_ * solver_.skin().sample[v].normal);
    pressed_.push_back(contact_.force[v]);
    depth_.push_back(std::max(kLeastDepth, -solver_.skin().sample[v].distance));
    in_product_.push_back(contact_.undeformed[v]);
  }
  add_up();
  skin_.add_touches(contact_, state, posed_, force_, stiffness_, is_loaded_);
  return true;
}

/// Forces and stiffness of the loaded skin.
void ContactForces::add_up() {
  const hand::Hand& hand = hand_->hand();
  force_.setZero();
  rate_.setZero();
  stiffness_.setZero();
  drag_.setZero();
  is_loaded_.fill(false);
  pull_.clear();
  way_.clear();
  room_.clear();
  friction_use_ = 0.0;
  grip_ = {};
  if (loaded_.empty()) return;
  std::vector<Vec3> pressed(loaded_.size());
  std::array<RegionSum, hand::kRegionCount> region;
  double sum = 0.0;
  centre_ = Vec3::Zero();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    const double p = pressed_[k];
    pressed[k] = -p * normal_[k];
    sum += p;
    centre_ += p * posed_[v];
    RegionSum& r = region[index_of(hand.region[v])];
    r.force += p;
    r.work += p * depth_[k];
    r.depth = std::max(r.depth, depth_[k]);
  }
  centre_ /= sum;
  grip_ = grip_force(pressed);

  for (int f = 0; f < hand::kFingerCount; ++f) {
    digit_[static_cast<std::size_t>(f)] =
        hand::pose_digit(hand.skeleton, static_cast<hand::Finger>(f), state_.posture);
  }
  // Motions of each loaded vertex over the product, per coordinate.
  motion_.assign(loaded_.size(), {});
  for (int j = 0; j < kGripJoints; ++j) {
    const SkinMotion::Column one = skin_.column(state_.posture, posed_, j, loaded_);
    for (std::size_t i = 0; i < one.row.size(); ++i) {
      motion_[one.row[i]].emplace_back(j, one.speed[i]);
    }
    is_loaded_[j] = !one.row.empty();
  }

  double spread = 0.0, rubbing = 0.0;
  pull_.reserve(loaded_.size());
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    const double p = pressed_[k];
    const Vec3& n = normal_[k];
    const Vec3 x = posed_[v] - centre_;
    spread += p * x.squaredNorm();
    auto& moves = motion_[k];
    for (int c = 0; c < 3; ++c) {
      moves.emplace_back(kGripJoints + c, -Vec3::Unit(c));
      moves.emplace_back(kGripJoints + 3 + c, -Vec3::Unit(c).cross(x));
    }
    RegionSum& r = region[index_of(hand.region[v])];
    const double stiff = kForcePower * p / r.depth;
    // Tangential way since the start, of the skin over the product.
    Vec3 way = hand_from_product_ * (in_product_[k] - anchor_[v]);
    way -= n * n.dot(way);
    const double room = std::hypot(way.norm(), kStick * friction_ * r.work / r.force);
    way_.push_back(way);
    room_.push_back(room);
    const double drag = friction_ > 0.0 ? friction_ * p / room : 0.0;
    const Vec3 pull = -drag * way;
    pull_.push_back(pull);
    rubbing += pull.norm();
    const Vec3 total = p * n + pull;  // of the product on the skin
    const Vec3 gain = stiff * (n + pull / p);
    // The normal force's share in the grip force.
    const double share = 0.5 * std::abs(n.dot(grip_.across));
    for (const auto& [a, speed] : moves) {
      force_[a] += total.dot(speed);
      r.opening[a] += p * n.dot(speed);
      rate_[a] -= stiff * share * n.dot(speed);
    }
    for (const auto& [b, vb] : moves) {
      const double normal_b = n.dot(vb);
      Vec3 along = vb - normal_b * n;
      if (friction_ > 0.0) along -= way * (way.dot(along) / (room * room));
      for (const auto& [a, va] : moves) {
        stiffness_(a, b) += normal_b * gain.dot(va);
        drag_(a, b) += drag * along.dot(va);
      }
    }
  }
  // Skin that a region presses together stiffens together.
  for (const RegionSum& r : region) {
    if (!(r.force > 0.0)) continue;
    const double more = kForcePower * (r.force / r.work - 1.0 / r.depth);
    stiffness_ += more / r.force * r.opening * r.opening.transpose();
    rate_ -= more * (grip_.force / grip_.sum_of_normals) * r.opening;
  }
  stiffness_ += drag_;
  for (std::size_t r = 0; r < region.size(); ++r) {
    depth_of_[r] = {region[r].force,
                    region[r].force > 0.0 ? region[r].work / region[r].force : 0.0};
  }
  arm_ = std::max(1.0, std::sqrt(spread / sum));
  friction_use_ = friction_ > 0.0 ? rubbing / (friction_ * sum) : 0.0;
}

void ContactForces::differentiate() {
  const std::vector<Eigen::Matrix3d> bend = bends();
  const GripMatrix turning = geometric_stiffness(bend);
  const auto count = static_cast<Eigen::Index>(loaded_.size());
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kGripCoordinates>;
  Rows opening = Rows::Zero(count, kGripCoordinates), pulled = opening;
  Eigen::VectorXd share(count);  // of each normal force in the grip force
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3& n = normal_[i];
    share[k] = 0.5 * std::abs(n.dot(grip_.across));
    const Vec3 along = n + pull_[i] / pressed_[i];
    for (const auto& [a, speed] : motion_[i]) {
      opening(k, a) += slope_[i].dot(speed);
      pulled(k, a) += along.dot(speed);
    }
  }
  const auto lost = solver_.stiffness_times(opening, turns(bend), kRates);
  if (lost) {
    stiffness_ = pulled.transpose() * *lost + drag_;
    rate_ = -lost->transpose() * share;
    if (friction_ > 0.0) stiffness_ += depth_stiffness(opening, *lost);
  }
  stiffness_ += turning;
}

/// What friction loses as regions are pressed deeper: e = 3/4 mu d grows with their mean depth.
GripMatrix ContactForces::depth_stiffness(const Eigen::MatrixXd& opening,
                                          const Eigen::MatrixXd& lost) const {
  std::array<GripVector, hand::kRegionCount> deeper, held;  // d; the forces that e takes
  for (GripVector& v : deeper) v.setZero();
  for (GripVector& v : held) v.setZero();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const std::size_t r = index_of(hand_->hand().region[loaded_[k]]);
    const RegionDepth& region = depth_of_[r];
    deeper[r] -= (depth_[k] - region.mean) / region.force * lost.row(i).transpose();
    if (depth_[k] > kLeastDepth) {
      deeper[r] -= pressed_[k] / region.force * opening.row(i).transpose();
    }
    const double e = kStick * friction_ * region.mean;
    const double loss = kStick * friction_ * e / (room_[k] * room_[k]);
    for (const auto& [a, speed] : motion_[k]) held[r][a] += loss * pull_[k].dot(speed);
  }
  GripMatrix result = GripMatrix::Zero();
  for (std::size_t r = 0; r < deeper.size(); ++r) result += held[r] * deeper[r].transpose();
  return result;
}

/// How the product's normals turn with motion over it, per loaded vertex, hand frame, 1/mm: the
/// slope of those at the vertex' neighbours, by least squares in its tangent plane.
std::vector<Eigen::Matrix3d> ContactForces::bends() const {
  const std::vector<geometry::DistanceSample>& sample = solver_.skin().sample;
  const std::vector<Vec3>& facing = solver_.skin().facing;
  std::vector<Eigen::Matrix3d> bend(loaded_.size(), Eigen::Matrix3d::Zero());
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    const Vec3& own = facing[v];
    const Vec3 n = hand_from_product_ * own;
    Eigen::Matrix<double, 3, 2> tangent;
    tangent << n.unitOrthogonal(), n.cross(n.unitOrthogonal());
    Eigen::Matrix2d turns = Eigen::Matrix2d::Zero(), ways = Eigen::Matrix2d::Zero();
    for (const int w : solver_.prepared->skin.neighbours(v)) {
      const bool is_beside = sample[w].distance < contact::kPressedNear && own.dot(facing[w]) > 0.0;
      if (!is_beside) continue;
      const Eigen::Vector2d way = tangent.transpose() * (posed_[w] - posed_[v]);
      const Vec3 turn = hand_from_product_ * Vec3(facing[w] - own);
      turns += tangent.transpose() * turn * way.transpose();
      ways += way * way.transpose();
    }
    ways.diagonal().array() += kLeastWay * kLeastWay;
    bend[k] = tangent * turns * ways.inverse() * tangent.transpose();
  }
  return bend;
}

/// How the directions in which the product presses turn against the skin, product frame.
contact::LoadedSkin::Turns ContactForces::turns(const std::vector<Eigen::Matrix3d>& bend) const {
  contact::LoadedSkin::Turns result(loaded_.size());
  const Quat product_from_hand = hand_from_product_.conjugate();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const Vec3& n = normal_[k];
    for (const auto& [a, speed] : motion_[k]) {
      Vec3 turn = bend[k] * speed;
      if (a >= kGripJoints + 3) {
        turn += Vec3::Unit(a - kGripJoints - 3).cross(n);
      } else if (a < kGripJoints) {
        // The share of the angle in the skin's motion turns the skin, too.
        const hand::Twist& twist = digit_[static_cast<std::size_t>(a / hand::kDigitDofs)]
                                       .twist[static_cast<std::size_t>(a % hand::kDigitDofs)];
        const Vec3 whole = twist.at(posed_[loaded_[k]]);
        const double share = speed.dot(whole) / std::max(1e-12, whole.squaredNorm());
        turn -= share * twist.omega.cross(n);
      }
      result[k].emplace_back(a, product_from_hand * turn);
    }
  }
  return result;
}

/// What the forces' arms and directions, turning at forces held, add to the stiffness.
GripMatrix ContactForces::geometric_stiffness(const std::vector<Eigen::Matrix3d>& bend) const {
  GripMatrix result = GripMatrix::Zero();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const Vec3 total = pressed_[k] * normal_[k] + pull_[k];
    const Vec3 raw = hand_from_product_ * (in_product_[k] - anchor_[loaded_[k]]);
    const double drag = friction_ > 0.0 ? friction_ * pressed_[k] / room_[k] : 0.0;
    for (const auto& [b, vb] : motion_[k]) {
      const Vec3 turn = bend[k] * vb;
      Vec3 change = pressed_[k] * turn;
      if (drag > 0.0) {  // friction lies in the surface, which turns
        Vec3 slid = -turn * normal_[k].dot(raw) - normal_[k] * turn.dot(raw);
        slid -= way_[k] * (way_[k].dot(slid) / (room_[k] * room_[k]));
        change -= drag * slid;
      }
      const bool turns_product = b >= kGripJoints + 3;
      if (turns_product) change += Vec3::Unit(b - kGripJoints - 3).cross(total);
      for (const auto& [a, va] : motion_[k]) {
        double gain = change.dot(va);
        // Of two angles the one nearer to the palm turns what the other moves.
        if (std::max(a, b) < kGripJoints && grip_finger(a) == grip_finger(b)) {
          const int nearer = std::min(a, b);
          const Vec3& axis = digit_[static_cast<std::size_t>(nearer / hand::kDigitDofs)]
                                 .twist[static_cast<std::size_t>(nearer % hand::kDigitDofs)]
                                 .omega;
          gain += total.dot(axis.cross(a < b ? vb : va));
        }
        if (a >= kGripJoints + 3 && b < kGripJoints) {
          gain -= Vec3::Unit(a - kGripJoints - 3).cross(vb).dot(total);
        }
        result(a, b) -= gain;
      }
    }
  }
  return result;
}

std::vector<Vec3> ContactForces::friction_force() const {
  std::vector<Vec3> result(contact_.force.size(), Vec3::Zero());
  const Quat product_from_hand = hand_from_product_.conjugate();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    result[loaded_[k]] = product_from_hand * -pull_[k];
  }
  return result;
}

}  // namespace palmar::grasp
