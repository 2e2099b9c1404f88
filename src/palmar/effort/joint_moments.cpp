// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/joint_moments.h"

#include "palmar/contact/contact_normals.h"

namespace palmar::effort {
namespace {

/// Share of each skin vertex that moves with the thumb's metacarpal.
std::vector<double> metacarpal_share(const hand::Hand& hand) {
  std::vector<double> share(hand.skin.vertices.size(), 0.0);
  for (const hand::JointWeights& weights : hand.weights) {
    if (weights.joint != hand::JointId::kThumbCmc) continue;
    for (std::size_t i = 0; i < weights.vertex.size(); ++i) {
      share[weights.vertex[i]] = weights.w1[i] * weights.w2[i];
    }
  }
  return share;
}

}  // namespace

std::vector<SkinForce> skin_loads(const contact::ContactResult& contact,
                                  const geometry::Rigid3& product_from_hand,
                                  const geometry::DistanceField& product,
                                  const contact::FrictionResult* friction) {
  std::vector<int> loaded;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (contact.force[v] > 0.0) loaded.push_back(static_cast<int>(v));
  }
  const std::vector<Vec3> normals = contact::contact_normals(contact, product, loaded);
  const geometry::Rigid3 hand_from_product = product_from_hand.inverse();
  std::vector<SkinForce> loads;
  loads.reserve(loaded.size());
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const auto v = static_cast<std::size_t>(loaded[k]);
    Vec3 force = contact.force[v] * normals[k];
    if (friction != nullptr && v < friction->force.size()) force -= friction->force[v];
    loads.push_back(
        {loaded[k], hand_from_product * contact.deformed[v], hand_from_product.rotation * force});
  }
  const auto add = [&](int vertex, const Vec3& force) {
    if (force.isZero(0.0)) return;
    loads.push_back({vertex, hand_from_product * contact.deformed[static_cast<std::size_t>(vertex)],
                     hand_from_product.rotation * force, true});
  };
  for (const contact::SkinTouch& touch : contact.skin_touch) {
    const Vec3 force = touch.force * touch.meeting.normal;
    add(touch.meeting.vertex, force);
    for (std::size_t c = 0; c < 3; ++c) add(touch.meeting.on[c], -touch.meeting.weight[c] * force);
  }
  return loads;
}

DigitMoments digit_moments(const hand::Hand& hand, const hand::PosedDigit& digit,
                           std::span<const SkinForce> loads) {
  DigitMoments result;
  std::vector<double> metacarpal;
  if (digit.finger == hand::Finger::kThumb) metacarpal = metacarpal_share(hand);
  for (const SkinForce& load : loads) {
    const int v = load.vertex;
    const hand::Segment segment = hand.segment[v];
    const auto finger = hand::finger_of(segment);
    int body = 0;
    double share = 1.0;
    if (finger) {
      if (*finger != digit.finger) continue;
      body = hand::body_of(segment);
    } else {
      if (metacarpal.empty() || metacarpal[v] <= 0.0) continue;
      body = 1;
      share = metacarpal[v];
    }
    if (!load.is_by_skin) result.force += share * load.force.norm();
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      result.moment[k] += share * load.force.dot(digit.velocity(k, body, load.point));
    }
  }
  return result;
}

}  // namespace palmar::effort
