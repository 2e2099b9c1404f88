// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/hand_points.h"

#include <algorithm>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::hand {
namespace {

constexpr const char* kForearm = "forearm";
constexpr const char* kThumbMetacarpal = "thumb_metacarpal";

Vec3 vertex_normal(const Hand& hand, int vertex) {
  Vec3 normal = Vec3::Zero();
  for (const Triangle& t : hand.skin.triangles) {
    if (t[0] != vertex && t[1] != vertex && t[2] != vertex) continue;
    const Vec3& a = hand.skin.vertices[t[0]];
    const Vec3& b = hand.skin.vertices[t[1]];
    const Vec3& c = hand.skin.vertices[t[2]];
    normal += (b - a).cross(c - a);
  }
  return normal.stableNormalized();
}

/// Joints between the palm and a segment.
std::vector<JointId> joints_to(Segment segment) {
  std::vector<JointId> joints;
  const auto finger = finger_of(segment);
  if (!finger) return joints;
  if (*finger == Finger::kThumb) joints.push_back(JointId::kThumbCmc);
  for (const std::optional<Segment>& one : segments_of(*finger)) {
    if (!one) continue;
    joints.push_back(joint_of(*one));
    if (*one == segment) break;
  }
  return joints;
}

}  // namespace

HandPoint skin_point(const Hand& hand, int vertex, double height) {
  if (vertex < 0 || vertex >= hand.skin.vertex_count()) {
    throw UsageError("skin vertex " + std::to_string(vertex) + " is requested; the hand has 0 to " +
                     std::to_string(hand.skin.vertex_count() - 1));
  }
  HandPoint point{hand.skin.vertices[vertex], vertex, {}};
  if (height != 0.0) point.reference += height * vertex_normal(hand, vertex);
  return point;
}

HandPoint skin_point_near(const Hand& hand, const Vec3& reference) {
  double nearest = std::numeric_limits<double>::infinity();
  int vertex = 0;
  for (int v = 0; v < hand.skin.vertex_count(); ++v) {
    const double d = (hand.skin.vertices[v] - reference).squaredNorm();
    if (d < nearest) {
      nearest = d;
      vertex = v;
    }
  }
  return {reference, vertex, {}};
}

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (int s = 0; s < kSegmentCount; ++s) names.emplace_back(name_of(static_cast<Segment>(s)));
  names.emplace_back(kThumbMetacarpal);
  names.emplace_back(kForearm);
  return names;
}

HandPoint part_point(const std::string& part, const Vec3& reference) {
  if (part == kForearm) return {reference, {}, {JointId::kWrist}};
  if (part == kThumbMetacarpal) return {reference, {}, {JointId::kThumbCmc}};
  if (const auto segment = segment_named(part)) return {reference, {}, joints_to(*segment)};
  throw UsageError("\"" + part + "\" is no part of the hand; " +
                   did_you_mean(part, part_names(),
                                "a segment (palm, index_distal, ...), thumb_metacarpal or forearm "
                                "is needed"));
}

PosablePoints::PosablePoints(const Hand& hand, const std::vector<HandPoint>& points) {
  few_.skeleton = hand.skeleton;
  few_.thumb_ball = hand.thumb_ball;
  few_.thumb_ball.vertex.clear();
  std::vector<std::vector<int>> slots(hand.skin.vertices.size());  // of a skin vertex
  for (std::size_t i = 0; i < points.size(); ++i) {
    few_.skin.vertices.push_back(points[i].reference);
    if (points[i].vertex) {
      slots.at(*points[i].vertex).push_back(static_cast<int>(i));
    }
  }
  for (const JointWeights& all : hand.weights) {
    JointWeights few;
    few.joint = all.joint;
    for (std::size_t k = 0; k < all.vertex.size(); ++k) {
      for (const int slot : slots[all.vertex[k]]) {
        few.vertex.push_back(slot);
        few.w1.push_back(all.w1[k]);
        few.w2.push_back(all.w2[k]);
        if (!all.bulge.empty()) few.bulge.push_back(all.bulge[k]);
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::vector<JointId>& joints = points[i].joints;
      if (points[i].vertex || std::find(joints.begin(), joints.end(), all.joint) == joints.end()) {
        continue;
      }
      few.vertex.push_back(static_cast<int>(i));
      few.w1.push_back(1.0);
      few.w2.push_back(1.0);
      if (!all.bulge.empty()) few.bulge.emplace_back(Vec3::Zero());
    }
    if (!few.vertex.empty()) few_.weights.push_back(std::move(few));
  }
  for (const int vertex : hand.thumb_ball.vertex) {
    for (const int slot : slots[vertex]) {
      few_.thumb_ball.vertex.push_back(slot);
    }
  }
}

std::vector<Vec3> PosablePoints::pose(const Posture& posture) const {
  return pose_skin(few_, posture);
}

}  // namespace palmar::hand
