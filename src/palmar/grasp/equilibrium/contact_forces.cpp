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

constexpr double kRates = 1e-2;                       // relative accuracy of derivatives
constexpr double kBendStep = 1.0, kBendRange = 20.0;  // mm; of differences of normals
constexpr double kStick = 0.75;  // 3/4 mu d: where friction turns from sticking to slipping

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
      solver_(hand, options),
      bed_(hand.hand(), *product.distance) {
  anchor_ = hand::pose_skin(hand.hand(), start.posture);
  for (Vec3& point : anchor_) point = start.product_from_hand * point;
}

void ContactForces::pose(const GripState& state) {
  state_ = state;
  posed_ = hand::pose_skin(hand_->hand(), state.posture);
  hand_from_product_ = state.product_from_hand.rotation.conjugate();
  loaded_.clear();
  pressed_.clear();
  depth_.clear();
  spring_.clear();
  in_product_.clear();
}

bool ContactForces::is_at(const GripState& state) const {
  const geometry::Rigid3 &a = state_.product_from_hand, &b = state.product_from_hand;
  return state_.posture.angle == state.posture.angle && a.translation == b.translation &&
         a.rotation.coeffs() == b.rotation.coeffs();
}

void ContactForces::look_on_springs(const GripState& state) {
  pose(state);
  std::vector<Vec3> skin(posed_.size());
  for (std::size_t v = 0; v < skin.size(); ++v) skin[v] = state.product_from_hand * posed_[v];
  normal_.clear();
  for (const SkinBed::Load& load : bed_.look(skin)) {
    loaded_.push_back(load.vertex);
    pressed_.push_back(load.force);
    depth_.push_back(load.depth);
    spring_.push_back(load.stiffness);
    in_product_.push_back(skin[load.vertex]);
    normal_.push_back(hand_from_product_ * load.normal);
  }
  add_up();
}

bool ContactForces::look(const GripState& state, double accuracy) {
  pose(state);
  solver_.solve_forces(posed_, state.product_from_hand, *product_->distance, accuracy, contact_);
  fallbacks_ += contact_.fallbacks;
  if (contact_.status == contact::ContactStatus::kNotConverged) return false;
  loaded_ = contact::loaded_vertices(contact_);
  normal_ = contact::contact_normals(contact_, *product_->distance, loaded_);
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    normal_[k] = hand_from_product_ * normal_[k];
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

  // Motions of each loaded vertex over the product, per coordinate.
  motion_.assign(loaded_.size(), {});
  for (int j = 0; j < kGripJoints; ++j) {
    const SkinMotion::Column one = skin_.column(state_.posture, posed_, j, loaded_);
    for (std::size_t i = 0; i < one.row.size(); ++i) {
      motion_[one.row[i]].emplace_back(j, one.speed[i]);
    }
    is_loaded_[j] = !one.row.empty();
  }

  const bool is_on_bed = !spring_.empty();
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
    const double stiff = is_on_bed ? spring_[k] : kForcePower * p / r.depth;
    // Tangential way since the start, of the skin over the product.
    Vec3 way = hand_from_product_ * (in_product_[k] - anchor_[v]);
    way -= n * n.dot(way);
    const double room = std::hypot(way.norm(), kStick * friction_ * r.work / r.force);
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
  if (is_on_bed) {
    stiffness_ += geometric_stiffness();
  } else {
    // Skin that a region presses together stiffens together.
    for (const RegionSum& r : region) {
      if (!(r.force > 0.0)) continue;
      const double more = kForcePower * (r.force / r.work - 1.0 / r.depth);
      stiffness_ += more / r.force * r.opening * r.opening.transpose();
      rate_ -= more * (grip_.force / grip_.sum_of_normals) * r.opening;
    }
  }
  stiffness_ += drag_;
  arm_ = std::max(1.0, std::sqrt(spread / sum));
  friction_use_ = friction_ > 0.0 ? rubbing / (friction_ * sum) : 0.0;
}

void ContactForces::differentiate() {
  const GripMatrix turning = geometric_stiffness();
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
      opening(k, a) += n.dot(speed);
      pulled(k, a) += along.dot(speed);
    }
  }
  const auto lost = solver_.stiffness_times(opening, kRates);
  if (lost) {
    stiffness_ = pulled.transpose() * *lost + drag_;
    rate_ = -lost->transpose() * share;
  }
  stiffness_ += turning;
}

/// What the forces' arms and directions, turning at forces held, add to the stiffness.
GripMatrix ContactForces::geometric_stiffness() const {
  std::array<Vec3, kGripJoints> axis;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const hand::PosedDigit digit =
        hand::pose_digit(hand_->hand().skeleton, static_cast<hand::Finger>(f), state_.posture);
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      axis[hand::kDigitDofs * f + k] = digit.twist[k].omega;
    }
  }
  // How the product's normals turn along two tangents.
  constexpr int kSides = 4;
  const std::size_t count = loaded_.size();
  std::vector<std::array<Vec3, 2>> tangent(count);
  std::vector<Vec3> at;
  at.reserve(kSides * count);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 u = normal_[k].unitOrthogonal();
    tangent[k] = {u, normal_[k].cross(u)};
    for (const Vec3& t : tangent[k]) {
      const Vec3 step = kBendStep * (hand_from_product_.conjugate() * t);
      at.push_back(in_product_[k] + step);
      at.push_back(in_product_[k] - step);
    }
  }
  std::vector<geometry::DistanceSample> sample(at.size());
  product_->distance->sample(at, kBendRange, sample);
  GripMatrix result = GripMatrix::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 total = pressed_[k] * normal_[k] + pull_[k];
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();  // of the normal, per motion over the product
    for (std::size_t t = 0; t < 2; ++t) {
      const Vec3 turn = sample[kSides * k + 2 * t].normal - sample[kSides * k + 2 * t + 1].normal;
      bend += hand_from_product_ * turn / (2.0 * kBendStep) * tangent[k][t].transpose();
    }
    for (const auto& [b, vb] : motion_[k]) {
      Vec3 change = pressed_[k] * (bend * vb);
      const bool turns_product = b >= kGripJoints + 3;
      if (turns_product) change += Vec3::Unit(b - kGripJoints - 3).cross(total);
      for (const auto& [a, va] : motion_[k]) {
        double gain = change.dot(va);
        // Of two angles the one nearer to the palm turns what the other moves.
        if (std::max(a, b) < kGripJoints && grip_finger(a) == grip_finger(b)) {
          gain += total.dot(axis[std::min(a, b)].cross(a < b ? vb : va));
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
