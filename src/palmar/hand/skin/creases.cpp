// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/creases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kWristShare = 0.15;       // of wrist to third MCP: 13.5 of about 90 mm
constexpr double kPipShare = 0.06;         // of the proximal phalanx: 2.5 of about 42 mm
constexpr double kDipShare = 0.31;         // of the middle phalanx: 7.5 of about 24 mm
constexpr double kThumbIpShare = 0.13;     // of the thumb's proximal phalanx: 4 of about 32 mm
constexpr double kTransverse = 9.0;        // mm proximal of the MCP joints; 6.8 to 10.3 mm measured
constexpr double kAboveWeb = 1.5;          // mm; keeps the base crease a loop around one finger
constexpr double kHighestWeb = 0.7;        // of the proximal phalanx; webs reach 0.35 to 0.5
constexpr double kWebFacing = 0.3;         // cosine; our choice
constexpr double kStraight = 0.87;         // cosine; from 30 deg on a finger is bent
constexpr double kBehindWeb = 6.0;         // mm; where palmar skin ends on the first web
constexpr double kWebWeight = 0.3;         // against the rays; small: the border bends gently
constexpr double kWristToMcpOf185 = 90.0;  // mm, hand of 185 mm

constexpr std::array<std::array<JointId, 3>, kFingerCount> kJoints{{
    {JointId::kThumbCmc, JointId::kThumbMp, JointId::kThumbIp},
    {JointId::kIndexMcp, JointId::kIndexPip, JointId::kIndexDip},
    {JointId::kMiddleMcp, JointId::kMiddlePip, JointId::kMiddleDip},
    {JointId::kRingMcp, JointId::kRingPip, JointId::kRingDip},
    {JointId::kLittleMcp, JointId::kLittlePip, JointId::kLittleDip},
}};

// Flexion axes at the three joints; at the thumb's CMC joint that of the MP joint, because the
// nail-to-pulp direction of the thumb is what separates its palmar skin.
constexpr std::array<std::array<Dof, 3>, kFingerCount> kFlexion{{
    {Dof::kThumbMpFlexion, Dof::kThumbMpFlexion, Dof::kThumbIpFlexion},
    {Dof::kIndexMcpFlexion, Dof::kIndexPipFlexion, Dof::kIndexDipFlexion},
    {Dof::kMiddleMcpFlexion, Dof::kMiddlePipFlexion, Dof::kMiddleDipFlexion},
    {Dof::kRingMcpFlexion, Dof::kRingPipFlexion, Dof::kRingDipFlexion},
    {Dof::kLittleMcpFlexion, Dof::kLittlePipFlexion, Dof::kLittleDipFlexion},
}};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

PlaneCurve::PlaneCurve(const std::vector<Vec2>& through) {
  constexpr int kSteps = 16;
  constexpr double kRun = 200.0;  // mm, straight beyond both ends
  const int n = static_cast<int>(through.size());
  const auto point = [&](int i) -> Vec2 {
    if (i < 0) return 2.0 * through.front() - through[1];
    if (i >= n) return 2.0 * through.back() - through[n - 2];
    return through[i];
  };
  for (int i = 0; i + 1 < n; ++i) {
    const Vec2 a = point(i - 1), b = point(i), c = point(i + 1), d = point(i + 2);
    for (int k = 0; k < kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps;
      sample_.push_back(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t +
                               (3.0 * b - a - 3.0 * c + d) * t * t * t));
    }
  }
  sample_.push_back(through.back());
  const Vec2 start = sample_[0] + kRun * (sample_[0] - sample_[1]).normalized();
  const Vec2 end =
      sample_.back() + kRun * (sample_.back() - sample_[sample_.size() - 2]).normalized();
  sample_.insert(sample_.begin(), start);
  sample_.push_back(end);
}

double PlaneCurve::signed_distance(const Vec2& p) const {
  double best = std::numeric_limits<double>::max();
  double side = 1.0;
  for (std::size_t i = 0; i + 1 < sample_.size(); ++i) {
    const Vec2 along = sample_[i + 1] - sample_[i];
    const double t = std::clamp((p - sample_[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double squared = (p - sample_[i] - t * along).squaredNorm();
    if (squared >= best) continue;
    best = squared;
    // At a corner the side is that of the mean direction; the samples turn little.
    Vec2 direction = along.normalized();
    if (t == 1.0 && i + 2 < sample_.size()) {
      direction += (sample_[i + 2] - sample_[i + 1]).normalized();
    }
    side = cross(direction, p - sample_[i] - t * along) >= 0.0 ? 1.0 : -1.0;
  }
  return side * std::sqrt(best);
}

class HandCreases::RayDistances {
 public:
  RayDistances(const geometry::TriangleMesh& skin, const HandCreases& creases)
      : skin_(skin), creases_(creases) {
    for (std::vector<double>& of_ray : distance_) of_ray.assign(skin.vertices.size(), -1.0);
  }

  double of(int ray, std::size_t vertex) {
    double& result = distance_[ray][vertex];
    if (result >= 0.0) return result;
    const auto& node = creases_.ray_[ray].node;
    double best = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 along = node[k + 1] - node[k];
      const Vec3 arm = skin_.vertices[vertex] - node[k];
      const double t = std::clamp(arm.dot(along) / along.squaredNorm(), 0.0, 1.0);
      best = std::min(best, (arm - t * along).squaredNorm());
    }
    return result = std::sqrt(best);
  }

 private:
  const geometry::TriangleMesh& skin_;
  const HandCreases& creases_;
  std::array<std::vector<double>, kFingerCount> distance_;
};

HandCreases::HandCreases(const geometry::TriangleMesh& skin, const Skeleton& skeleton) {
  const Vec3 wrist = skeleton.joint(JointId::kWrist).centre;
  sign_ =
      skeleton.joint(JointId::kIndexMcp).centre.x() > skeleton.joint(JointId::kLittleMcp).centre.x()
          ? 1.0
          : -1.0;
  for (int f = 0; f < kFingerCount; ++f) {
    Ray& ray = ray_[f];
    ray.node[0] = wrist;
    for (int k = 0; k < 3; ++k) ray.node[k + 1] = skeleton.joint(kJoints[f][k]).centre;
    ray.node[4] = skeleton.fingertips[f];
    ray.palmar[0] = Vec3::UnitZ();
    for (int k = 1; k <= 4; ++k) {
      // Thumb nodes 1 to 3 are CMC, MP, IP; the tip turns with the last joint.
      const Vec3 axis = skeleton.dof(kFlexion[f][std::min(k, 3) - 1]).axis;
      const Vec3 before = (ray.node[k] - ray.node[k - 1]).normalized();
      const Vec3 after = k < 4 ? (ray.node[k + 1] - ray.node[k]).normalized() : before;
      ray.palmar[k] = axis.cross(before + after).normalized();
    }
  }
  const Vec3 to_mcp = ray_[static_cast<int>(Finger::kMiddle)].node[1] - wrist;
  scale_ = to_mcp.norm() / kWristToMcpOf185;
  wrist_ = {wrist + kWristShare * to_mcp, Vec3::UnitY()};
  RayDistances distance(skin, *this);
  for (int k = 0; k + 1 < kFingerCount; ++k) web_[k] = find_web(skin, k, distance);
  place_web();
  place_finger_creases();
  place_palm_creases();
}

void HandCreases::place_web() {
  const Ray& thumb = ray_[0];
  const Ray& index = ray_[1];
  const Vec3 along_thumb = thumb.node[2] - thumb.node[1];
  const Vec3 along_index = index.node[1] - index.node[0];
  web_palmar_ = along_thumb.cross(along_index).normalized();
  if (web_palmar_.z() < 0.0) web_palmar_ = -web_palmar_;
  // Palmar skin goes over the ridge of the web and ends a little behind it.
  const Vec3 behind = -kBehindWeb * scale_ * web_palmar_;
  web_root_ = 0.5 * (0.5 * (thumb.node[1] + thumb.node[2]) + index.node[0] + 0.6 * along_index);
  web_end_ = web_[0] + behind;
}

HandCreases::OnRay HandCreases::project(const Ray& ray, const Vec3& point) const {
  OnRay result;
  double best = std::numeric_limits<double>::max();
  for (int k = 0; k < 4; ++k) {
    const Vec3 along = ray.node[k + 1] - ray.node[k];
    const double free = (point - ray.node[k]).dot(along) / along.squaredNorm();
    const double t = std::clamp(free, 0.0, 1.0);
    const Vec3 offset = point - ray.node[k] - t * along;
    if (offset.squaredNorm() >= best) continue;
    best = offset.squaredNorm();
    const Vec3 palmar = ((1.0 - t) * ray.palmar[k] + t * ray.palmar[k + 1]).normalized();
    result.height = offset.dot(palmar);
    result.to_tip = k == 3 ? (free - 1.0) * along.norm() : -std::numeric_limits<double>::max();
  }
  result.distance = std::sqrt(best);
  return result;
}

int HandCreases::nearest_ray(const Vec3& point) const {
  int nearest = 0;
  double best = std::numeric_limits<double>::max();
  for (int f = 0; f < kFingerCount; ++f) {
    const double d = project(ray_[f], point).distance;
    if (d < best) {
      best = d;
      nearest = f;
    }
  }
  return nearest;
}

double HandCreases::palmar_height(const Vec3& point) const {
  // Near a finger its own ray decides; in the palm and the webs the rays blend.
  double sum = 0.0, weight = 0.0;
  for (const Ray& ray : ray_) {
    const OnRay on = project(ray, point);
    double height = on.height;
    // The pulp goes round the tip up to the nail's free edge.
    const double into_tip = on.to_tip + 7.0 * scale_;
    if (into_tip > 0.0) height += 0.12 / scale_ * into_tip * into_tip;
    const double w = std::pow(1.0 + on.distance * on.distance, -3.0);
    sum += w * height;
    weight += w;
  }
  // The first web is a fold of its own, between the rays.
  const Vec3 spine = web_end_ - web_root_;
  const double t = std::clamp((point - web_root_).dot(spine) / spine.squaredNorm(), 0.0, 1.0);
  const Vec3 offset = point - web_root_ - t * spine;
  const double w = kWebWeight * std::pow(1.0 + offset.squaredNorm(), -3.0);
  sum += w * offset.dot(web_palmar_);
  weight += w;
  return sum / weight;
}

Vec3 HandCreases::find_web(const geometry::TriangleMesh& skin, int k,
                           RayDistances& distance) const {
  const Ray& a = ray_[k];
  const Ray& b = ray_[k + 1];
  // A bent finger's middle phalanx doesn't look the way its web lies.
  const auto direction = [](const Ray& ray) {
    const Vec3 proximal = (ray.node[2] - ray.node[1]).normalized();
    const Vec3 middle = (ray.node[3] - ray.node[2]).normalized();
    return middle.dot(proximal) > kStraight ? middle : proximal;
  };
  const Vec3 distal = (direction(a) + direction(b)).normalized();
  const Vec3 foot = 0.5 * (a.node[1] + b.node[1]);
  // Fingers that touch farther out make no web there. The first web is no cleft between phalanges.
  const double highest_web = k == 0 ? std::numeric_limits<double>::max()
                                    : kHighestWeb * std::min((a.node[2] - a.node[1]).norm(),
                                                             (b.node[2] - b.node[1]).norm());
  const auto nearer = [&](std::size_t i) { return distance.of(k, i) - distance.of(k + 1, i); };
  // Half way between these two there may be another finger, in a curled hand: not their web.
  const auto is_others = [&](std::size_t i) {
    const double own = std::min(distance.of(k, i), distance.of(k + 1, i));
    for (int f = 0; f < kFingerCount; ++f) {
      if (f != k && f != k + 1 && distance.of(f, i) < own) return true;
    }
    return false;
  };
  std::vector<double> level;  // of the vertices; no point of an edge lies higher than its ends
  level.reserve(skin.vertices.size());
  for (const Vec3& v : skin.vertices) level.push_back(distal.dot(v - foot));
  double best = -std::numeric_limits<double>::max();
  Vec3 web = Vec3::Zero();
  // A web faces the fingertips; flanks of thick fingers that touch face each other. What lies
  // proximal of the joints only matters to determine how far it is from being a web.
  struct Pass {
    double least, facing;
  };
  for (const Pass& pass : {Pass{0.0, kWebFacing}, Pass{0.0, -1.0}, Pass{best, -1.0}}) {
    const double least = pass.least;
    if (best > 0.0) break;
    for (const Triangle& t : skin.triangles) {
      const double highest = std::max({level[t[0]], level[t[1]], level[t[2]]});
      if (highest < std::max(best, least)) continue;
      const Vec3 normal = (skin.vertices[t[1]] - skin.vertices[t[0]])
                              .cross(skin.vertices[t[2]] - skin.vertices[t[0]]);
      if (distal.dot(normal) < pass.facing * normal.norm()) continue;
      for (int e = 0; e < 3; ++e) {
        const std::size_t i = static_cast<std::size_t>(t[e]),
                          j = static_cast<std::size_t>(t[(e + 1) % 3]);
        if (std::max(level[i], level[j]) < std::max(best, least)) continue;
        const double a_nearer = nearer(i), b_nearer = nearer(j);
        if ((a_nearer < 0.0) == (b_nearer < 0.0)) continue;
        const double s = a_nearer / (a_nearer - b_nearer);
        const Vec3 p = (1.0 - s) * skin.vertices[i] + s * skin.vertices[j];
        const double height = distal.dot(p - foot);
        if (height <= best || height > highest_web || is_others(i) || is_others(j)) continue;
        best = height;
        web = p;
      }
    }
  }
  if (best <= 0.0) {
    throw InputError("skin: no web between " + std::string(name_of(static_cast<Finger>(k))) +
                     " and " + std::string(name_of(static_cast<Finger>(k + 1))) +
                     ": the skin half way between them ends " + std::to_string(best) +
                     " mm distal of their joints; more than 0 is required");
  }
  return web;
}

void HandCreases::place_finger_creases() {
  for (int f = 0; f < kFingerCount; ++f) {
    const Ray& ray = ray_[f];
    const bool is_thumb = f == 0;
    const int base = is_thumb ? 2 : 1;  // node of MP or MCP
    const Vec3 along = (ray.node[base + 1] - ray.node[base]).normalized();
    const Vec3 palmar = ray.palmar[base];
    const Vec3 radial =
        sign_ * along.cross(palmar).normalized();  // of a right hand: distal x palmar
    const auto level = [&](const Vec3& p) { return along.dot(p - ray.node[base]); };
    const auto aside = [&](const Vec3& p) { return radial.dot(p - ray.node[base]); };
    // Slope of the crease across the finger, distal per radial.
    double slope = 0.0, at_axis = 0.0;
    if (is_thumb) {
      const Vec3& web = web_[0];
      slope = std::clamp((level(web) + kAboveWeb) / aside(web), -0.8, 0.8);
      at_axis = level(web) + kAboveWeb - slope * aside(web);
    } else if (f == 1 || f == 4) {
      const Vec3& web = web_[f == 1 ? 1 : 3];
      slope = f == 1 ? -0.12 : 0.35;  // the free side lies more proximal
      at_axis = level(web) + kAboveWeb - slope * aside(web);
    } else {
      const Vec3& a = web_[f - 1];
      const Vec3& b = web_[f];
      slope = std::clamp((level(a) - level(b)) / (aside(a) - aside(b)), -0.5, 0.5);
      at_axis = std::max(level(a) - slope * aside(a), level(b) - slope * aside(b)) + kAboveWeb;
    }
    const Vec3 point = ray.node[base] + at_axis * along;
    crease_[f][0] = {point, (along - slope * radial).normalized()};
    for (int k = base + 1; k <= 3; ++k) {
      const Vec3 before = ray.node[k] - ray.node[k - 1];
      const Vec3 after = ray.node[k + 1] - ray.node[k];
      const double share = is_thumb ? kThumbIpShare : (k == 2 ? kPipShare : kDipShare);
      const Vec3 normal = (before.normalized() + share * after.normalized()).normalized();
      crease_[f][k - base] = {ray.node[k] - share * before, normal};
    }
  }
}

void HandCreases::place_palm_creases() {
  const auto mcp = [&](int f) { return in_palm(ray_[f].node[1]); };
  const Vec2 m2 = mcp(1), m3 = mcp(2), m4 = mcp(3), m5 = mcp(4);
  const Vec2 wrist = in_palm(wrist_.point);
  const Vec2 down(0.0, -kTransverse * scale_);
  const Vec2 web1 = in_palm(web_[0]);
  // From the ulnar to the radial border; left of it (distal) lie the pads. It ends just above the
  // first web, so that the web is thenar skin.
  const Vec2 radial_end(std::max(web1.x(), m2.x() + 5.0 * scale_),
                        std::min(web1.y() + 4.0 * scale_, m2.y() + down.y()));
  transverse_ = PlaneCurve({m5 + down + 0.6 * (m5 - m4), m5 + down, m4 + down, m3 + down, m2 + down,
                            radial_end + Vec2(2.0 * scale_, 0.0)});
  const double height = m3.y() - wrist.y();
  const double width = m2.x() - m4.x();
  const auto palm = [&](double across, double up) {
    return Vec2(m3.x() + across * width, wrist.y() + up * height);
  };
  // Radially of it (left when travelling proximally... from the index to the wrist) lies the thumb
  // ball.
  thenar_ = PlaneCurve({palm(0.80, 1.02), palm(0.52, 0.86), palm(0.26, 0.68), palm(0.10, 0.46),
                        palm(0.04, 0.22), palm(0.03, 0.0)});
  hypothenar_ = PlaneCurve({palm(0.24, 0.12), palm(0.10, 0.20), palm(-0.08, 0.36),
                            palm(-0.26, 0.60), palm(-0.42, 0.90)});
  const Vec2 between = 0.5 * (m3 + m4);
  const Vec2 web = in_palm(web_[2]);
  between_pads_ = PlaneCurve({between + 2.0 * down, web});
}

std::array<std::size_t, 2> HandCreases::place_of(Segment phalanx) {
  const auto finger = finger_of(phalanx);
  if (!finger) throw UsageError("segment \"palm\": a phalanx is required");
  const auto chain = segments_of(*finger);
  for (std::size_t k = 0; k < 3; ++k) {
    if (chain[k] == phalanx) return {static_cast<std::size_t>(*finger), k};
  }
  throw UsageError("segment: not a phalanx");
}

const CreasePlane& HandCreases::proximal_crease(Segment phalanx) const {
  const auto [finger, k] = place_of(phalanx);
  return crease_[finger][k];
}

void HandCreases::set_proximal_crease(Segment phalanx, const CreasePlane& crease) {
  const auto [finger, k] = place_of(phalanx);
  crease_[finger][k] = crease;
}

const Vec3& HandCreases::palmar_direction(Finger finger, int node) const {
  return ray_[static_cast<int>(finger)].palmar[node];
}

SkinLabel HandCreases::label(const Vec3& point) const {
  const bool is_palmar = palmar_height(point) > 0.0;
  const int f = nearest_ray(point);
  const auto& crease = crease_[f];
  if (crease[0].value(point) > 0.0) {
    const auto chain = segments_of(static_cast<Finger>(f));
    const int last = chain[2] ? 2 : 1;
    int k = 0;
    while (k < last && crease[k + 1].value(point) > 0.0) ++k;
    const Segment segment = *chain[k];
    return {segment, is_palmar ? *region_of(segment) : Region::kDorsum};
  }
  if (!is_palmar || wrist_.value(point) <= 0.0) return {Segment::kPalm, Region::kDorsum};
  const Vec2 p = in_palm(point);
  if (transverse_.signed_distance(p) > 0.0) {
    const bool is_ulnar = between_pads_.signed_distance(p) > 0.0;
    return {Segment::kPalm, is_ulnar ? Region::kUlnarPalm : Region::kRadialPalm};
  }
  if (thenar_.signed_distance(p) > 0.0) return {Segment::kPalm, Region::kThenar};
  if (hypothenar_.signed_distance(p) > 0.0) return {Segment::kPalm, Region::kHypothenar};
  return {Segment::kPalm, Region::kCentralPalm};
}

double HandCreases::boundary_value(const Vec3& point, const SkinLabel& a,
                                   const SkinLabel& b) const {
  if (a.segment != b.segment) {
    const Segment distal = std::max(a.segment, b.segment);
    // Segments of one finger ascend from proximal to distal, and the palm comes first.
    return proximal_crease(distal).value(point);
  }
  if (a.region == Region::kDorsum || b.region == Region::kDorsum) {
    const double height = palmar_height(point);
    return a.segment == Segment::kPalm ? std::min(height, wrist_.value(point)) : height;
  }
  const auto involves = [&](Region r) { return a.region == r || b.region == r; };
  const Vec2 p = in_palm(point);
  if (involves(Region::kRadialPalm) && involves(Region::kUlnarPalm)) {
    return between_pads_.signed_distance(p);
  }
  if (involves(Region::kRadialPalm) || involves(Region::kUlnarPalm)) {
    return transverse_.signed_distance(p);
  }
  return involves(Region::kThenar) ? thenar_.signed_distance(p) : hypothenar_.signed_distance(p);
}

}  // namespace palmar::hand
