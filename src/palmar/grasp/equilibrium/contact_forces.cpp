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

constexpr double kRates = 1e-3;  // relative accuracy of derivatives
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
      solver_(hand, options) {
  anchor_ = hand::pose_skin(hand.hand(), start.posture);
  for (Vec3& point : anchor_) point = start.product_from_hand * point;
}

bool ContactForces::look(const GripState& state, double accuracy) {
  const hand::Hand& hand = hand_->hand();
  posed_ = hand::pose_skin(hand, state.posture);
  solver_.solve_forces(posed_, state.product_from_hand, *product_->distance, accuracy, contact_);
  fallbacks_ += contact_.fallbacks;
  force_.setZero();
  rate_.setZero();
  stiffness_.setZero();
  drag_.setZero();
  is_loaded_.fill(false);
  pull_.clear();
  friction_use_ = 0.0;
  grip_ = {};
  if (contact_.status == contact::ContactStatus::kNotConverged) return false;
  loaded_ = contact::loaded_vertices(contact_);
  if (loaded_.empty()) return true;
  hand_from_product_ = state.product_from_hand.rotation.conjugate();

  normal_ = contact::contact_normals(contact_, *product_->distance, loaded_);
  std::vector<Vec3> pressed(loaded_.size());
  std::array<RegionSum, hand::kRegionCount> region;
  double sum = 0.0;
  centre_ = Vec3::Zero();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    const double p = contact_.force[v];
    normal_[k] = hand_from_product_ * normal_[k];
    pressed[k] = -p * normal_[k];
    sum += p;
    centre_ += p * posed_[v];
    RegionSum& r = region[index_of(hand.region[v])];
    const double depth = std::max(kLeastDepth, -solver_.skin().sample[v].distance);
    r.force += p;
    r.work += p * depth;
    r.depth = std::max(r.depth, depth);
  }
  centre_ /= sum;
  grip_ = grip_force(pressed);

  // Motions of each loaded vertex over the product, per coordinate.
  motion_.assign(loaded_.size(), {});
  for (int j = 0; j < kGripJoints; ++j) {
    const SkinMotion::Column one = skin_.column(state.posture, posed_, j, loaded_);
    for (std::size_t i = 0; i < one.row.size(); ++i) {
      motion_[one.row[i]].emplace_back(j, one.speed[i]);
    }
    is_loaded_[j] = !one.row.empty();
  }

  double spread = 0.0, rubbing = 0.0;
  GripVector across = GripVector::Zero();  // of the grip force, without the coherent part
  pull_.reserve(loaded_.size());
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    const double p = contact_.force[v];
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
    Vec3 way = hand_from_product_ * (contact_.undeformed[v] - anchor_[v]);
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
      across[a] -= stiff * share * n.dot(speed);
    }
    for (const auto& [b, vb] : moves) {
      const double normal_b = n.dot(vb);
      Vec3 along = vb - normal_b * n;
      along -= way * (way.dot(along) / (room * room));
      for (const auto& [a, va] : moves) {
        stiffness_(a, b) += normal_b * gain.dot(va);
        drag_(a, b) += drag * along.dot(va);
      }
    }
  }
  // Skin that a region presses together stiffens together.
  rate_ = across;
  for (const RegionSum& r : region) {
    if (!(r.force > 0.0)) continue;
    const double more = kForcePower * (r.force / r.work - 1.0 / r.depth);
    stiffness_ += more / r.force * r.opening * r.opening.transpose();
    rate_ -= more * (grip_.force / grip_.sum_of_normals) * r.opening;
  }
  stiffness_ += drag_;
  skin_.add_touches(contact_, state, posed_, force_, stiffness_, is_loaded_);
  arm_ = std::max(1.0, std::sqrt(spread / sum));
  friction_use_ = friction_ > 0.0 ? rubbing / (friction_ * sum) : 0.0;
  return true;
}

bool ContactForces::differentiate() {
  const auto count = static_cast<Eigen::Index>(loaded_.size());
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kGripCoordinates>;
  Rows opening = Rows::Zero(count, kGripCoordinates), pulled = opening;
  Eigen::VectorXd share(count);  // of each normal force in the grip force
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3& n = normal_[i];
    share[k] = 0.5 * std::abs(n.dot(grip_.across));
    const Vec3 along = n + pull_[i] / contact_.force[loaded_[i]];
    for (const auto& [a, speed] : motion_[i]) {
      opening(k, a) += n.dot(speed);
      pulled(k, a) += along.dot(speed);
    }
  }
  const auto lost = solver_.stiffness_times(opening, kRates);
  if (!lost) return false;
  stiffness_ = pulled.transpose() * *lost + drag_;
  rate_ = -lost->transpose() * share;
  return true;
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
