// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/grip_mechanics.h"

#include <algorithm>
#include <cmath>

#include "palmar/contact/contact_normals.h"
#include "palmar/core/enum_index.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kTangential = 2.0 / 3;  // tangential over normal stiffness; Mindlin 1949
constexpr double kTurn = 1e-3;           // rad; of the differences

}  // namespace

GripMechanics::GripMechanics(const contact::PreparedHand& hand, const product::Product& product,
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

bool GripMechanics::look(const GripState& state, double accuracy) {
  const hand::Hand& hand = hand_->hand();
  posed_ = hand::pose_skin(hand, state.posture);
  solver_.solve_forces(posed_, state.product_from_hand, *product_->distance, accuracy, contact_);
  fallbacks_ += contact_.fallbacks;
  force_.setZero();
  squeeze_.setZero();
  stiffness_.setZero();
  is_loaded_.fill(false);
  tangential_.clear();
  normal_.clear();
  stiff_.clear();
  drag_.clear();
  friction_use_ = 0.0;
  grip_ = {};
  if (contact_.status == contact::ContactStatus::kNotConverged) return false;
  loaded_ = contact::loaded_vertices(contact_);
  if (loaded_.empty()) return true;
  hand_from_product_ = state.product_from_hand.rotation.conjugate();

  std::array<double, hand::kRegionCount> depth;
  depth.fill(kLeastDepth);
  for (const contact::RegionContact& region : contact_.regions) {
    double& d = depth[index_of(region.region)];
    d = std::max(d, region.max_penetration);
  }
  normal_ = contact::contact_normals(contact_, *product_->distance, loaded_);
  double sum = 0.0;
  centre_ = Vec3::Zero();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    normal_[k] = hand_from_product_ * normal_[k];
    sum += contact_.force[v];
    centre_ += contact_.force[v] * posed_[v];
  }
  centre_ /= sum;

  // Motions of each loaded vertex: over the product, per coordinate.
  std::vector<std::vector<std::pair<int, Vec3>>> motion(loaded_.size());
  for (int j = 0; j < kGripJoints; ++j) {
    const SkinMotion::Column one = skin_.column(state.posture, posed_, j, loaded_);
    for (std::size_t i = 0; i < one.row.size(); ++i) {
      motion[one.row[i]].emplace_back(j, one.speed[i]);
    }
    is_loaded_[j] = !one.row.empty();
  }

  double spread = 0.0, rubbing = 0.0, limit = 0.0;
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    const Vec3& n = normal_[k];
    const Vec3 x = posed_[v] - centre_;
    spread += contact_.force[v] * x.squaredNorm();
    auto& moves = motion[k];
    for (int c = 0; c < 3; ++c) {
      moves.emplace_back(kGripJoints + c, -Vec3::Unit(c));
      moves.emplace_back(kGripJoints + 3 + c, -Vec3::Unit(c).cross(x));
    }
    const double p = contact_.force[v];
    const double stiff = kForcePower * p / depth[index_of(hand.region[v])];
    // Tangential way since the start, of the skin over the product.
    Vec3 way = hand_from_product_ * (contact_.undeformed[v] - anchor_[v]);
    way -= n * n.dot(way);
    const double most = friction_ * p;
    double drag = friction_ > 0.0 ? kTangential * stiff : 0.0;
    Vec3 pull = -drag * way;
    double with_normal = 0.5;  // share of the change of p that friction takes part in
    Vec3 slip = Vec3::Zero();  // direction in which the skin slips
    double across = drag;      // resists ways across that
    if (pull.norm() > most) {
      const double share = most / pull.norm();
      pull *= share;
      with_normal = 1.0;
      slip = way.normalized();
      across *= share;
      drag *= share * share;  // of skin that slips little resists further motion
    }
    tangential_.push_back(pull);
    stiff_.push_back(stiff);
    drag_.push_back(drag);
    rubbing += pull.norm();
    limit += most;
    const Vec3 total = p * n + pull;  // of the product on the skin
    const Vec3 gain = stiff * (n + (with_normal / p) * pull);
    for (const auto& [a, speed] : moves) {
      force_[a] += total.dot(speed);
      squeeze_[a] -= stiff * n.dot(speed);
    }
    for (const auto& [b, vb] : moves) {
      const double normal_b = n.dot(vb);
      const Vec3 along = vb - normal_b * n;
      const Vec3 change = normal_b * gain + across * (along - slip * slip.dot(along));
      for (const auto& [a, va] : moves) stiffness_(a, b) += change.dot(va);
    }
  }
  skin_.add_touches(contact_, state, posed_, force_, stiffness_, is_loaded_);
  arm_ = std::max(1.0, std::sqrt(spread / sum));
  friction_use_ = limit > 0.0 ? rubbing / limit : 0.0;
  grip_ = squeeze_of_normals();
  return true;
}

GripMechanics::Closing GripMechanics::closing(const hand::Posture& posture,
                                              const hand::Posture& rate) const {
  Closing result;
  double largest = 0.0;
  for (const double r : rate.angle) largest = std::max(largest, std::abs(r));
  if (largest == 0.0 || loaded_.empty()) return result;
  const double step = kTurn / largest;
  hand::Posture moved = posture;
  for (std::size_t d = 0; d < moved.angle.size(); ++d) moved.angle[d] += step * rate.angle[d];
  const std::vector<Vec3> there = hand::pose_skin_vertices(hand_->hand(), moved, loaded_);
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const Vec3& n = normal_[k];
    const Vec3 speed = (there[k] - posed_[loaded_[k]]) / step;
    const Vec3 along = n * n.dot(speed);
    // On the product: against what the skin meets.
    const Vec3 force = stiff_[k] * along + drag_[k] * (speed - along);
    result.squeeze -= stiff_[k] * n.dot(speed);
    result.force.head<3>() += force;
    result.force.tail<3>() += (posed_[loaded_[k]] - centre_).cross(force);
  }
  return result;
}

Squeeze GripMechanics::squeeze_of_normals() const {
  std::vector<Vec3> forces(loaded_.size());
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    forces[k] = -contact_.force[loaded_[k]] * normal_[k];
  }
  return grip_force(forces);
}

Eigen::Matrix<double, 6, 1> GripMechanics::wrench_of(std::optional<hand::Finger> finger) const {
  Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    const int v = loaded_[k];
    if (hand::finger_of(hand_->hand().segment[v]) != finger) continue;
    const Vec3 force = -contact_.force[v] * normal_[k];
    wrench.head<3>() += force;
    wrench.tail<3>() += (posed_[v] - centre_).cross(force);
  }
  return wrench;
}

std::vector<Vec3> GripMechanics::friction_force() const {
  std::vector<Vec3> result(contact_.force.size(), Vec3::Zero());
  const Quat product_from_hand = hand_from_product_.conjugate();
  for (std::size_t k = 0; k < loaded_.size(); ++k) {
    result[loaded_[k]] = product_from_hand * -tangential_[k];
  }
  return result;
}

}  // namespace palmar::grasp
