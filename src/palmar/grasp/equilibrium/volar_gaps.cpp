// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/volar_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/contact/prepared/coarse_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/distance/distance_field.h"
#include "palmar/hand/skeleton.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kSoftness = 3.0;   // mm; t of the soft mean
constexpr double kSpeaks = 0.25;    // skin that speaks less for the volar side isn't asked
constexpr double kGapRange = 40.0;  // mm; skin farther off counts as that far
constexpr double kCounts = 1e-4;    // of a part's weight; less doesn't shape how its gap changes
constexpr int kThumbParts = 2;
constexpr std::array kPads{hand::Region::kRadialPalm, hand::Region::kUlnarPalm,
                           hand::Region::kHypothenar};

/// Whether a point is farther than that from a cone: from the ball that holds it.
bool is_surely_beyond(const RoundCone& cone, const Vec3& point, double distance) {
  const double radius = 0.5 * (cone.b - cone.a).norm() + std::max(cone.radius_a, cone.radius_b);
  const double reach = radius + distance;
  return reach > 0.0 && (point - 0.5 * (cone.a + cone.b)).squaredNorm() >= reach * reach;
}

}  // namespace

VolarGaps::VolarGaps(const contact::PreparedHand& prepared, const product::Product& product)
    : hand_(&prepared.hand()),
      motion_(prepared.coarse().prepared.hand()),
      product_(&product),
      cones_(prepared.hand()) {
  const hand::Hand& hand = prepared.coarse().prepared.hand();
  const std::vector<double>& area = prepared.coarse().sample.area;
  const hand::Skeleton& skeleton = hand.skeleton;
  const std::vector<Vec3> posed = hand::pose_skin(hand, hand::reference_posture(skeleton));
  const auto close_part = [&](std::size_t first) {
    double sum = 0.0;
    for (std::size_t k = first; k < skin_.size(); ++k) sum += skin_[k].share;
    for (std::size_t k = first; k < skin_.size(); ++k) skin_[k].share /= sum;
  };
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const auto segments = hand::segments_of(finger);
    for (std::size_t i = 0; i < segments.size() && segments[i]; ++i) {
      const hand::Segment segment = *segments[i];
      const Vec3 from = skeleton.joint(hand::joint_of(segment)).centre;
      const bool is_last = i + 1 == segments.size() || !segments[i + 1];
      const Vec3 to = is_last ? skeleton.fingertips[index_of(finger)]
                              : skeleton.joint(hand::joint_of(*segments[i + 1])).centre;
      const double length = (to - from).norm();
      const Vec3 bone = (to - from) / length;
      std::vector<int> own;
      std::vector<Vec3> direction;
      Vec3 volar = Vec3::Zero();
      for (std::size_t v = 0; v < hand.segment.size(); ++v) {
        if (hand.segment[v] != segment || hand.region[v] == hand::Region::kDorsum) continue;
        const Vec3 p = posed[v] - from;
        own.push_back(static_cast<int>(v));
        direction.emplace_back((p - bone * std::clamp(bone.dot(p), 0.0, length)).normalized());
        volar += area[v] * direction.back();
      }
      volar.normalize();
      const std::size_t first = skin_.size();
      for (std::size_t k = 0; k < own.size(); ++k) {
        const double speaks = std::pow(std::max(0.0, direction[k].dot(volar)), 4.0);
        if (speaks < kSpeaks) continue;
        skin_.push_back({.vertex = own[k],
                         .part = static_cast<int>(segment) - 1,
                         .share = area[own[k]] * speaks});
      }
      close_part(first);
    }
  }
  for (std::size_t pad = 0; pad < kPads.size(); ++pad) {
    const std::size_t first = skin_.size();
    for (std::size_t v = 0; v < hand.segment.size(); ++v) {
      if (hand.region[v] != kPads[pad]) continue;
      skin_.push_back({.vertex = static_cast<int>(v),
                       .part = hand::kSegmentCount - 1 + static_cast<int>(pad),
                       .share = area[v]});
    }
    close_part(first);
  }
  for (const Skin& point : skin_) vertex_.push_back(point.vertex);
}

VolarVector VolarGaps::look(const GripState& state, const std::vector<Vec3>& posed) {
  std::vector<Vec3> at;
  at.reserve(vertex_.size());
  for (const int v : vertex_) at.push_back(state.product_from_hand * posed[v]);
  if (sample_.empty()) {
    sample_.resize(at.size());
    product_->distance->sample(at, kGapRange, sample_);
  } else {
    product_->distance->resample(at, kGapRange, sample_);
  }
  const std::vector<RoundCone> cones = cones_.posed(hand_->skeleton, state.posture);
  const Quat hand_from_product = state.product_from_hand.rotation.conjugate();
  VolarVector sum = VolarVector::Zero();
  for (std::size_t k = 0; k < skin_.size(); ++k) {
    Skin& skin = skin_[k];
    double distance = sample_[k].distance;
    skin.body = 0;
    skin.normal = std::abs(distance) < kGapRange ? Vec3(hand_from_product * sample_[k].normal)
                                                 : Vec3(Vec3::Zero());
    if (skin.part < kThumbParts) {
      const Vec3& point = posed[skin.vertex];
      for (const RoundCone& cone : cones) {
        if (cone.finger == hand::Finger::kThumb || cone.level == 0) continue;
        if (is_surely_beyond(cone, point, distance)) continue;
        const ConeDistance to_finger = distance_from(cone, point);
        if (to_finger.distance >= distance) continue;
        distance = to_finger.distance;
        skin.normal = to_finger.away;
        skin.finger = cone.finger;
        skin.body = cone.level + 1;  // the MCP has a body between its two axes
        skin.touched = point - distance * skin.normal;
      }
    }
    skin.weight = skin.share * std::exp(-distance / kSoftness);
    sum[skin.part] += skin.weight;
  }
  for (Skin& skin : skin_) skin.weight /= sum[skin.part];
  return -kSoftness * sum.array().log();
}

VolarRates VolarGaps::rates(const GripState& state, const std::vector<Vec3>& posed,
                            const Vec3& centre) const {
  std::array<hand::PosedDigit, hand::kFingerCount> digit;
  for (std::size_t f = 0; f < digit.size(); ++f) {
    digit[f] = hand::pose_digit(hand_->skeleton, static_cast<hand::Finger>(f), state.posture);
  }
  VolarRates rates = VolarRates::Zero();
  for (const Skin& skin : skin_) {
    if (skin.weight < kCounts) continue;
    const Vec3 away = skin.weight * skin.normal;
    if (skin.body > 0) {
      const auto f = index_of(skin.finger);
      for (int j = 0; j < hand::kDigitDofs; ++j) {
        rates(skin.part, hand::kDigitDofs * static_cast<int>(f) + j) -=
            away.dot(digit[f].velocity(j, skin.body, skin.touched));
      }
      continue;
    }
    rates.block<1, 3>(skin.part, kGripJoints) -= away.transpose();
    rates.block<1, 3>(skin.part, kGripJoints + 3) -=
        (posed[skin.vertex] - centre).cross(away).transpose();
  }
  std::vector<int> vertex;
  std::vector<const Skin*> counts;
  for (const Skin& skin : skin_) {
    if (skin.weight < kCounts) continue;
    vertex.push_back(skin.vertex);
    counts.push_back(&skin);
  }
  for (int j = 0; j < kGripJoints; ++j) {
    const SkinMotion::Column one = motion_.column(state.posture, posed, j, vertex);
    for (std::size_t i = 0; i < one.row.size(); ++i) {
      const Skin& skin = *counts[static_cast<std::size_t>(one.row[i])];
      rates(skin.part, j) += skin.weight * skin.normal.dot(one.speed[i]);
    }
  }
  return rates;
}

}  // namespace palmar::grasp
