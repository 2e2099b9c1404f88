// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/person_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "hands/phantom/person/bell.h"
#include "hands/phantom/person/person_random.h"
#include "hands/phantom/person/person_size.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::phantom {
namespace {

enum OutlineStream : std::uint64_t { kOutline = 2, kFingers = 7 };

// Joints of a finger from its knuckle to its tip.
struct FingerAxis {
  std::vector<Vec3> node;

  /// Nearest point of it and how far along from the first joint, mm.
  struct Foot {
    Vec3 point = Vec3::Zero();
    double along = 0.0;
  };
  Foot foot(const Vec3& p) const {
    Foot best;
    double nearest = -1.0, before = 0.0;
    for (std::size_t k = 0; k + 1 < node.size(); ++k) {
      const Vec3 link = node[k + 1] - node[k];
      const double share = std::clamp(link.dot(p - node[k]) / link.squaredNorm(), 0.0, 1.0);
      const Vec3 q = node[k] + share * link;
      const double distance = (p - q).norm();
      if (nearest < 0.0 || distance < nearest) {
        nearest = distance;
        best = {q, before + share * link.norm()};
      }
      before += link.norm();
    }
    return best;
  }
};

double smooth(double u) { return u * u * (3.0 - 2.0 * u); }

// How much thicker a broader finger is: our choice, as surveys measured no depths.
constexpr double kDepth = 0.7;

void move_webs(geometry::TriangleMesh& skin, const hand::Skeleton& skeleton, double deviation,
               RandomStream& random) {
  const hand::HandCreases creases(skin, skeleton);
  for (int k = 0; k + 1 < hand::kFingerCount; ++k) {
    const auto towards = [&](int f) {
      const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
      return Vec3((skeleton.joint(hand::joint_of(*segments[1])).centre -
                   skeleton.joint(hand::joint_of(*segments[0])).centre)
                      .normalized());
    };
    const Vec3 shift = spread(random, deviation) * (towards(k) + towards(k + 1)).normalized();
    const Vec3& web = creases.web(k);
    for (Vec3& v : skin.vertices) v += bell((v - web).norm(), 7.0) * shift;
  }
}

}  // namespace

void shape_fingers(geometry::TriangleMesh& skin, const hand::Hand& hand, std::uint64_t seed,
                   const PersonDispersion& dispersion) {
  RandomStream random(seed, kFingers);
  const std::array<double, hand::kFingerCount> widening =
      surveyed_widenings(hand, seed, dispersion);
  const hand::HandCreases creases(hand.skin, hand.skeleton);
  const double blunter = spread(random, dispersion.fingertip);
  const double thicker = dispersion.knuckle + spread(random, dispersion.knuckle);
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const auto segments = hand::segments_of(finger);
    FingerAxis axis;
    std::vector<double> joint;  // mm along the axis
    for (const auto& segment : segments) {
      if (segment) axis.node.push_back(hand.skeleton.joint(hand::joint_of(*segment)).centre);
    }
    axis.node.push_back(hand.skeleton.fingertips[f]);
    const Vec3& across = hand.skeleton.joint(hand::joint_of(*segments[1])).dofs.back().axis;
    const hand::CreasePlane& crease = creases.proximal_crease(*segments[0]);
    const double rise = 0.6 * crease.value(axis.node[1]);
    double length = 0.0;
    for (std::size_t k = 0; k + 1 < axis.node.size(); ++k) {
      joint.push_back(length);
      length += (axis.node[k + 1] - axis.node[k]).norm();
    }
    const double own_tip = blunter + spread(random, 0.5 * dispersion.fingertip);
    const double own_joint = thicker + spread(random, 0.5 * dispersion.knuckle);
    for (std::size_t i = 0; i < skin.vertices.size(); ++i) {
      if (hand::finger_of(hand.segment[i]) != finger) continue;
      const FingerAxis::Foot foot = axis.foot(hand.skin.vertices[i]);
      // Grows from the base crease to 0.6 of the way to the PIP joint.
      const double base = std::clamp(crease.value(hand.skin.vertices[i]) / rise, 0.0, 1.0);
      const double u = std::clamp((foot.along - joint.back()) / (length - joint.back()), 0.0, 1.0);
      double larger = own_tip * smooth(u);
      for (std::size_t k = 1; k < joint.size(); ++k) {
        larger += own_joint * (k == 1 ? 1.0 : 0.6) * bell(foot.along - joint[k], 5.0);
        // Shafts are as much slimmer in between.
        const double next = k + 1 < joint.size() ? joint[k + 1] : length;
        larger -= 0.5 * own_joint * bell(foot.along - 0.5 * (joint[k] + next), 5.0);
      }
      const double wider = (widening[f] - 1.0) * smooth(base);
      const Vec3 out = hand.skin.vertices[i] - foot.point;
      const Vec3 aside = out.dot(across) * across;
      skin.vertices[i] += (larger + wider) * aside + (larger + kDepth * wider) * (out - aside);
    }
  }
  if (dispersion.web > 0.0) move_webs(skin, hand.skeleton, dispersion.web, random);
}

void give_relief(geometry::TriangleMesh& skin, const hand::Skeleton& skeleton, std::uint64_t seed,
                 double relief) {
  RandomStream random(seed, kOutline);
  const std::vector<Vec3> normal = geometry::vertex_normals(skin);
  struct Bump {
    Vec3 place;
    double width, height;
  };
  std::vector<Bump> bumps;
  for (int k = 0; k < 60; ++k) {
    const Vec3& place = skin.vertices[random.below(skin.vertices.size())];
    const double width = 8.0 + 14.0 * random.uniform();
    bumps.push_back({place, width, spread(random, 0.35 * relief)});
  }
  const double wrist = skeleton.joint(hand::JointId::kWrist).centre.y();
  for (std::size_t i = 0; i < skin.vertices.size(); ++i) {
    const Vec3 v = skin.vertices[i];
    double out = 0.0;
    for (const Bump& b : bumps) {
      out += b.height * std::exp(-(v - b.place).squaredNorm() / (2.0 * b.width * b.width));
    }
    // The end of the forearm stays plane.
    out *= std::clamp((v.y() - wrist + 20.0) / 10.0, 0.0, 1.0);
    skin.vertices[i] += std::clamp(out, -0.9 * relief, 1.2 * relief) * normal[i];
  }
}

void lengthen_forearm(geometry::TriangleMesh& skin, const Vec3& wrist) {
  constexpr double kEnd = -85.0;  // mm from the wrist joint
  const double begin = wrist.y() - 4.0;
  // The cut: y = c . (1, x, z) through the vertices that face backwards.
  const std::vector<Vec3> normal = geometry::vertex_normals(skin);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  for (std::size_t i = 0; i < normal.size(); ++i) {
    const Vec3& v = skin.vertices[i];
    if (v.y() > begin || normal[i].y() > -0.8) continue;
    const Vec3 row(1.0, v.x(), v.z());
    sum += row * row.transpose();
    right += v.y() * row;
  }
  if (!(sum(0, 0) >= 3.0)) return;  // closed in another way
  const Vec3 plane = sum.ldlt().solve(right);
  for (Vec3& v : skin.vertices) {
    if (v.y() >= begin) continue;
    const double end = std::min(plane.dot(Vec3(1.0, v.x(), v.z())), begin - 5.0);
    const double u = std::clamp((begin - v.y()) / (begin - end), 0.0, 1.05);
    const double longer = (begin - wrist.y() - kEnd) / (begin - end);
    v.y() = begin - (begin - end) * (u + (longer - 1.0) * u * u);
    const double wider = 1.0 + 0.14 * u * u;
    v.x() = wrist.x() + wider * (v.x() - wrist.x());
    v.z() = wrist.z() + wider * (v.z() - wrist.z());
  }
}

}  // namespace palmar::phantom
