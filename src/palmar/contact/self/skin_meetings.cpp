// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/self/skin_meetings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/distance/closest_point.h"

namespace palmar::contact {
namespace {

// A vertex is folded by a joint that turns it by a share between these of the joint's angle; ours.
constexpr double kLeastFold = 0.02, kMostFold = 0.98;
// Cosine of two skins' normals: those that meet look at each other. Ours; two round fingers of 16
// mm that cross by 4 mm reach -0.1 at the rim of what they share.
constexpr double kFacing = -0.1;
constexpr std::size_t kClusterSize = 24;  // vertices; a multiple of the lanes of a processor
constexpr double kEdge = 2.0;             // mm; nearest vertices are that much farther than skin
constexpr int kCommonRounds = 3;  // that settle a common normal to some hundredths of a millimetre
constexpr int kMostWalk = 8;      // triangles' rings from the nearest vertex to the nearest point

/// How far from the palm a segment is, and of equals how near its finger is to the thumb: the
/// greater brings the vertices.
int order_of(int segment) {
  const auto s = static_cast<hand::Segment>(segment);
  const auto finger = hand::finger_of(s);
  if (!finger) return -1;
  const auto segments = hand::segments_of(*finger);
  int level = 0;
  while (segments[static_cast<std::size_t>(level)] != s) ++level;
  // The thumb's two phalanges count as the outer two.
  if (*finger == hand::Finger::kThumb) ++level;
  return level * hand::kFingerCount +
         (hand::kFingerCount - 1 - static_cast<int>(index_of(*finger)));
}

/// The corner of the triangle that the point is nearest to.
int heaviest_corner(const SkinMeeting& meeting) {
  const auto heaviest = std::max_element(meeting.weight.begin(), meeting.weight.end());
  return meeting.on[static_cast<std::size_t>(heaviest - meeting.weight.begin())];
}

/// Halves vertices along the longest side of their box until few are left.
void split(const std::vector<Vec3>& position, std::vector<int> vertices,
           std::vector<std::vector<int>>& parts) {
  if (vertices.empty()) return;
  if (vertices.size() <= kClusterSize) {
    std::sort(vertices.begin(), vertices.end());
    parts.push_back(std::move(vertices));
    return;
  }
  Box3 box;
  for (const int v : vertices) box.extend(position[v]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto middle = vertices.begin() + static_cast<std::ptrdiff_t>(vertices.size() / 2);
  std::nth_element(vertices.begin(), middle, vertices.end(), [&](int a, int b) {
    const double pa = position[a][axis];
    const double pb = position[b][axis];
    return pa != pb ? pa < pb : a < b;
  });
  split(position, {vertices.begin(), middle}, parts);
  split(position, {middle, vertices.end()}, parts);
}

}  // namespace

SkinMeetings::SkinMeetings(const hand::Hand& hand) : hand_(&hand) {
  const std::size_t count = hand.skin.vertices.size();
  std::vector<std::vector<int>> of_segment(hand::kSegmentCount);
  for (std::size_t v = 0; v < count; ++v) {
    of_segment[index_of(hand.segment[v])].push_back(static_cast<int>(v));
  }
  for (std::size_t s = 0; s < of_segment.size(); ++s) {
    first_[s] = static_cast<int>(cluster_.size());
    std::vector<std::vector<int>> parts;
    split(hand.skin.vertices, of_segment[s], parts);
    for (auto& part : parts) {
      cluster_.push_back({static_cast<int>(s), std::move(part), ~0U, ~0U});
    }
  }
  first_[hand::kSegmentCount] = static_cast<int>(cluster_.size());

  triangle_begin_.assign(count + 1, 0);
  for (const Triangle& t : hand.skin.triangles) {
    for (const int v : t) ++triangle_begin_[v + 1];
  }
  for (std::size_t v = 0; v < count; ++v) triangle_begin_[v + 1] += triangle_begin_[v];
  triangle_.resize(triangle_begin_.back());
  std::vector<int> next(triangle_begin_.begin(), triangle_begin_.end() - 1);
  for (std::size_t t = 0; t < hand.skin.triangles.size(); ++t) {
    for (const int v : hand.skin.triangles[t]) triangle_[next[v]++] = static_cast<int>(t);
  }

  fold_.assign(count, 0);
  beside_.assign(count, 0);
  for (int f = 0; f < hand::kFingerCount; ++f) {
    for (const auto& segment : hand::segments_of(static_cast<hand::Finger>(f))) {
      if (!segment) continue;
      const unsigned bit = 1U << index_of(hand::joint_of(*segment));
      // The joint's own phalanx and the next one towards the palm.
      hand::Segment inner = hand::Segment::kPalm;
      for (const auto& other : hand::segments_of(static_cast<hand::Finger>(f))) {
        if (other == segment) break;
        inner = *other;
      }
      for (std::size_t v = 0; v < count; ++v) {
        if (hand.segment[v] == *segment || hand.segment[v] == inner) beside_[v] |= bit;
      }
    }
  }
  for (const hand::JointWeights& weights : hand.weights) {
    const unsigned bit = 1U << index_of(weights.joint);
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      const double share = weights.w1[k] * weights.w2[k];
      if (share < kLeastFold || share > kMostFold) continue;
      fold_[weights.vertex[k]] |= bit;
      beside_[weights.vertex[k]] |= bit;
    }
  }
  for (Cluster& cluster : cluster_) {
    for (const int v : cluster.vertex) {
      cluster.all_fold &= fold_[v];
      cluster.all_beside &= beside_[v];
    }
  }
}

bool SkinMeetings::may_meet(int v, int w) const {
  return ((fold_[v] & beside_[w]) | (fold_[w] & beside_[v])) == 0;
}

std::vector<SkinMeeting> SkinMeetings::find(const std::vector<Vec3>& posed,
                                            const std::vector<Vec3>& normal, double range) const {
  const double reach = std::max(kDeepestCrossing, range) + kEdge;
  struct Ball {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
    // Skin whose normal has a larger cosine with the axis looks away from all of the cluster.
    Vec3 axis = Vec3::Zero();
    double away = 1.0;
  };
  struct Lanes {
    std::array<double, kClusterSize> x{}, y{}, z{};
  };
  std::vector<Ball> ball(cluster_.size());
  std::vector<Lanes> lanes(cluster_.size());
  std::array<Box3, hand::kSegmentCount> box;
  for (std::size_t c = 0; c < cluster_.size(); ++c) {
    Box3 own;
    Vec3 axis = Vec3::Zero();
    for (std::size_t k = 0; k < cluster_[c].vertex.size(); ++k) {
      const Vec3& point = posed[cluster_[c].vertex[k]];
      own.extend(point);
      axis += normal[cluster_[c].vertex[k]];
      lanes[c].x[k] = point.x();
      lanes[c].y[k] = point.y();
      lanes[c].z[k] = point.z();
    }
    ball[c] = {own.center(), 0.5 * own.diagonal().norm(), axis.normalized(), 1.0};
    double least = 1.0;
    for (const int v : cluster_[c].vertex) least = std::min(least, normal[v].dot(ball[c].axis));
    const double apart = std::acos(kFacing) - std::acos(std::clamp(least, -1.0, 1.0));
    if (apart > 0.0) ball[c].away = std::cos(apart);
    box[static_cast<std::size_t>(cluster_[c].segment)].extend(own);
  }
  struct Nearest {
    int vertex = -1;
    double squared = 0.0;
  };
  std::vector<Nearest> nearest(posed.size(), {-1, reach * reach});
  std::vector<int> met;
  const auto look = [&](const Cluster& from, const Cluster& to, std::size_t d) {
    const double far = ball[d].radius + reach;
    const Lanes& at = lanes[d];
    for (const int v : from.vertex) {
      if (normal[v].dot(ball[d].axis) > ball[d].away) continue;
      if ((posed[v] - ball[d].centre).squaredNorm() >= far * far) continue;
      double squared[kClusterSize];
      for (std::size_t k = 0; k < kClusterSize; ++k) {
        const double x = at.x[k] - posed[v].x();
        const double y = at.y[k] - posed[v].y();
        const double z = at.z[k] - posed[v].z();
        squared[k] = x * x + y * y + z * z;
      }
      Nearest& best = nearest[v];
      for (std::size_t k = 0; k < to.vertex.size(); ++k) {
        if (squared[k] >= best.squared) continue;
        const int w = to.vertex[k];
        if (normal[v].dot(normal[w]) > kFacing || !may_meet(v, w)) continue;
        if (best.vertex < 0) met.push_back(v);
        best = {w, squared[k]};
      }
    }
  };
  for (int a = 0; a < hand::kSegmentCount; ++a) {
    for (int b = 0; b < hand::kSegmentCount; ++b) {
      if (a == b || order_of(a) < order_of(b)) continue;
      Box3 near = box[b];
      near.min().array() -= reach;
      near.max().array() += reach;
      if (!near.intersects(box[a])) continue;
      for (int c = first_[a]; c < first_[a + 1]; ++c) {
        const Cluster& from = cluster_[c];
        const double off = near.squaredExteriorDistance(ball[c].centre);
        if (off > ball[c].radius * ball[c].radius) continue;
        for (int d = first_[b]; d < first_[b + 1]; ++d) {
          const double most = ball[c].radius + ball[d].radius + reach;
          if ((ball[c].centre - ball[d].centre).squaredNorm() >= most * most) continue;
          const Cluster& to = cluster_[d];
          const unsigned never = (from.all_fold & to.all_beside) | (to.all_fold & from.all_beside);
          if (never == 0) look(from, to, static_cast<std::size_t>(d));
        }
      }
    }
  }
  std::sort(met.begin(), met.end());
  std::vector<SkinMeeting> result;
  for (const int v : met) {
    const int w = nearest[v].vertex;
    if (normal[w].dot(posed[v] - posed[w]) > range + kEdge) continue;
    const SkinMeeting found = meeting(posed, normal, v, w);
    // Beside skin that the vertex can't meet the nearest point says nothing about the side.
    bool is_whole = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const int corner = found.on[c];
      is_whole = is_whole && hand_->segment[corner] != hand_->segment[v] && may_meet(v, corner);
    }
    if (!is_whole) continue;
    if (found.distance < range && found.distance > -kDeepestCrossing &&
        normal[v].dot(found.normal) < kFacing) {
      result.push_back(found);
    }
  }
  return result;
}

/// Nearest point to `target` on the triangles around a vertex, and on from there.
void SkinMeetings::walk_to(const std::vector<Vec3>& posed, const Vec3& target, int from,
                           SkinMeeting& meeting) const {
  double least = std::numeric_limits<double>::infinity();
  for (int walk = 0; walk < kMostWalk; ++walk) {
    bool is_nearer = false;
    for (int k = triangle_begin_[from]; k < triangle_begin_[from + 1]; ++k) {
      const Triangle& t = hand_->skin.triangles[triangle_[k]];
      const geometry::TrianglePoint at =
          geometry::closest_point_on_triangle(target, posed[t[0]], posed[t[1]], posed[t[2]]);
      if (!(at.squared_distance < least)) continue;
      is_nearer = true;
      least = at.squared_distance;
      meeting.on = t;
      meeting.weight = at.weights;
    }
    if (!is_nearer) break;
    // On from the corner that the nearest point is nearest to.
    const int next = heaviest_corner(meeting);
    if (next == from) break;
    from = next;
  }
}

/// From the nearest point to the one that faces the vertex along the common normal: then neither
/// skin's curvature is preferred, and two equal bodies meet in their plane of symmetry.
SkinMeeting SkinMeetings::meeting(const std::vector<Vec3>& posed, const std::vector<Vec3>& normal,
                                  int v, int nearest) const {
  SkinMeeting result;
  result.vertex = v;
  Vec3 target = posed[v];
  int from = nearest;
  for (int round = 0; round <= kCommonRounds; ++round) {
    walk_to(posed, target, from, result);
    Vec3 point = Vec3::Zero();
    Vec3 outward = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      point += result.weight[c] * posed[result.on[c]];
      outward += result.weight[c] * normal[result.on[c]];
    }
    result.normal = (outward.normalized() - normal[v]).normalized();
    result.distance = result.normal.dot(posed[v] - point);
    target = posed[v] - result.distance * result.normal;
    from = heaviest_corner(result);
  }
  return result;
}

double deepest_crossing(const std::vector<SkinMeeting>& meetings) {
  double deepest = 0.0;
  for (const SkinMeeting& meeting : meetings) deepest = std::max(deepest, -meeting.distance);
  return deepest;
}

}  // namespace palmar::contact
