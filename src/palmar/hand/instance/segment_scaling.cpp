// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/instance/segment_scaling.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/smooth_step.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {
namespace {

/// max(0, t) with its corner rounded over [-half, half].
double rounded_ramp(double t, double half) {
  if (t <= -half) return 0.0;
  if (t >= half) return t;
  return (t + half) * (t + half) / (4.0 * half);
}

}  // namespace

SegmentScaling::SegmentScaling(const Hand& hand) : hand_(&hand) {
  const Skeleton& skeleton = hand.skeleton;
  const HandCreases creases(hand.skin, skeleton);
  const Vec3& head2 = skeleton.joint(JointId::kIndexMcp).centre;
  const Vec3& head5 = skeleton.joint(JointId::kLittleMcp).centre;
  head_ = skeleton.joint(JointId::kMiddleMcp).centre;
  // The ulnar border lies about a fifth of the knuckles' breadth beyond the fifth head.
  border_ = std::max(1e-3, std::abs(head_.x() - head5.x()) + 0.2 * std::abs(head2.x() - head5.x()));
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const bool is_thumb = finger == Finger::kThumb;
    Ray& ray = ray_[f];
    const auto chain = segments_of(finger);
    ray.links = is_thumb ? 2 : 3;
    const int first_node = is_thumb ? 2 : 1;  // of the finger's ray in HandCreases
    for (int k = 0; k < ray.links; ++k) {
      ray.segment[k] = *chain[k];
      ray.joint[k] = joint_of(*chain[k]);
      ray.node[k] = skeleton.joint(ray.joint[k]).centre;
    }
    ray.node[ray.links] = skeleton.fingertips[f];
    for (int k = 0; k < ray.links; ++k) {
      const Vec3 link = ray.node[k + 1] - ray.node[k];
      ray.along[k] = link.normalized();
      ray.level[k + 1] = ray.level[k] + link.norm();
    }
    for (int k = 0; k <= ray.links; ++k) {
      ray.palmar[k] = creases.palmar_direction(finger, first_node + k);
      const Vec3& before = ray.along[std::max(0, k - 1)];
      const Vec3& after = ray.along[std::min(k, ray.links - 1)];
      ray.cut[k] = (before + after).normalized();
    }
    const Vec3 base = creases.proximal_crease(ray.segment[0]).point;
    ray.base = std::clamp(ray.along[0].dot(base - ray.node[0]), 0.0, 0.8 * ray.level[1]);
    std::array<double, 4> crease{};  // arc lengths, and that of the tip
    for (int k = 0; k < ray.links; ++k) {
      const Vec3& from = creases.proximal_crease(ray.segment[k]).point;
      const Vec3 to = k + 1 < ray.links ? creases.proximal_crease(ray.segment[k + 1]).point
                                        : ray.node[ray.links];
      ray.middle[k] = place(f, 0.5 * (from + to)).level;
      crease[k] = k == 0 ? ray.base : place(f, from).level;
    }
    crease[ray.links] = ray.level[ray.links];
    for (int s = 0; s < ray.links; ++s) {
      for (int k = 0; k < ray.links; ++k) {
        const double begin = std::max(crease[s], ray.level[k]);
        const double end = std::min(crease[s + 1], ray.level[k + 1]);
        ray.parts[s][k] = std::max(0.0, end - begin);
      }
    }
    ray.rounding[0] = 0.5 * std::max(1e-3, std::min(ray.base, ray.middle[0] - ray.base));
    for (int k = 1; k < ray.links; ++k) {
      ray.rounding[k] =
          0.25 * std::min(ray.level[k] - ray.level[k - 1], ray.level[k + 1] - ray.level[k]);
    }
  }

  // Shares of the rays in each vertex of the skin: w2 of the joints at their roots.
  std::vector<std::array<double, kFingerCount>> share(hand.skin.vertices.size());
  for (auto& of_vertex : share) of_vertex.fill(0.0);
  for (const JointWeights& weights : hand.weights) {
    for (int f = 0; f < kFingerCount; ++f) {
      if (weights.joint != ray_[f].joint[0]) continue;
      for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
        share[weights.vertex[k]][f] = weights.w2[k];
      }
    }
  }
  skin_.begin.push_back(0);
  for (std::size_t v = 0; v < share.size(); ++v) {
    double sum = 0.0;
    for (const double s : share[v]) sum += s;
    if (sum > 1.0) {
      for (double& s : share[v]) s /= sum;
    }
    add(skin_, hand.skin.vertices[v], share[v]);
  }
  for (const Bone& bone : hand.bones) {
    std::array<double, kFingerCount> of_bone{};
    const auto finger = bone.segment ? finger_of(*bone.segment) : std::nullopt;
    if (finger) of_bone[index_of(*finger)] = 1.0;
    PointSet& set = bones_.emplace_back();
    set.begin.push_back(0);
    for (const Vec3& v : bone.mesh.vertices) add(set, v, of_bone);
  }
}

SegmentScaling::Placed SegmentScaling::place(int r, const Vec3& point) const {
  const Ray& ray = ray_[r];
  Placed placed;
  placed.ray = r;
  // Between which two of the planes through the joints the point lies.
  int k = 0;
  while (k + 1 < ray.links && ray.cut[k + 1].dot(point - ray.node[k + 1]) >= 0.0) ++k;
  const double behind = ray.cut[k].dot(point - ray.node[k]);
  const double ahead = ray.cut[k + 1].dot(ray.node[k + 1] - point);
  const double length = ray.level[k + 1] - ray.level[k];
  double t = 0.0;  // along the link; beyond 0 and 1 past the chain's ends
  if (k == 0 && behind < 0.0) {
    t = behind / length;
  } else if (ahead < 0.0) {
    t = 1.0 - ahead / length;
  } else {
    t = behind / std::max(1e-12, behind + ahead);
  }
  placed.level = ray.level[k] + t * length;
  const double inside = std::clamp(t, 0.0, 1.0);
  const Vec3 along = ((1.0 - inside) * ray.cut[k] + inside * ray.cut[k + 1]).normalized();
  const Vec3 palmar = (1.0 - inside) * ray.palmar[k] + inside * ray.palmar[k + 1];
  const Vec3 across = along.cross(palmar).normalized();
  placed.frame.col(0) = across;
  placed.frame.col(1) = across.cross(along);
  placed.frame.col(2) = along;
  const Vec3 centre = ray.node[k] + t * length * ray.along[k];
  placed.offset = placed.frame.transpose() * (point - centre);
  for (int c = 0; c < ray.links; ++c) {
    const double corner = c == 0 ? ray.base : ray.level[c];
    placed.past[c] = rounded_ramp(placed.level - corner, ray.rounding[c]);
  }
  int s = 0;
  while (s + 2 < ray.links && placed.level > ray.middle[s + 1]) ++s;
  placed.segment = s;
  placed.towards_next =
      geometry::smooth_step((placed.level - ray.middle[s]) / (ray.middle[s + 1] - ray.middle[s]));
  return placed;
}

void SegmentScaling::add(PointSet& set, const Vec3& point,
                         const std::array<double, kFingerCount>& share) const {
  set.point.push_back(point);
  for (int f = 0; f < kFingerCount; ++f) {
    if (share[f] <= 0.0) continue;
    Placed placed = place(f, point);
    placed.share = share[f] * geometry::smooth_step(placed.level / ray_[f].middle[0]);
    if (placed.share > 0.0) set.placed.push_back(placed);
  }
  set.begin.push_back(static_cast<int>(set.placed.size()));
}

std::array<SegmentScaling::ScaledRay, kFingerCount> SegmentScaling::scaled_rays(
    const SegmentScales& scales) const {
  std::array<ScaledRay, kFingerCount> result;
  for (int f = 0; f < kFingerCount; ++f) {
    const Ray& ray = ray_[f];
    ScaledRay& scaled = result[f];
    scaled.slope[0] = scales.segment[index_of(Segment::kPalm)].along;
    scaled.node[0] = in_palm(ray.node[0], scales);
    for (int k = 0; k < ray.links; ++k) {
      scaled.slope[k + 1] = scales.segment[index_of(ray.segment[k])].along;
      double length = scaled.slope[k + 1] * (ray.level[k + 1] - ray.level[k]);
      if (k == 0) length += (scaled.slope[0] - scaled.slope[1]) * ray.base;
      scaled.level[k + 1] = scaled.level[k] + length;
      scaled.node[k + 1] = scaled.node[k] + length * ray.along[k];
    }
  }
  return result;
}

double SegmentScaling::palm_thickness(const Vec3& point, const SegmentScales& scales) const {
  const double thickness = scales.segment[index_of(Segment::kPalm)].thickness;
  if (scales.bow == 0.0) return thickness;
  const double s = (point.x() - head_.x()) / border_;
  const double t = (point.y() - head_.y()) / (0.45 * head_.y());
  const double aside = 1.0 - geometry::smooth_step((std::abs(s) - 1.0) / 0.6);
  return thickness * (1.0 + scales.bow * (1.0 - std::exp(-2.0 * s * s)) * aside * std::exp(-t * t));
}

Vec3 SegmentScaling::in_palm(const Vec3& point, const SegmentScales& scales) const {
  return palm_stretch(point, scales) * point;
}

Eigen::DiagonalMatrix<double, 3> SegmentScaling::palm_stretch(const Vec3& point,
                                                              const SegmentScales& scales) const {
  const auto& palm = scales.segment[index_of(Segment::kPalm)];
  return Eigen::DiagonalMatrix<double, 3>(palm.across, palm.along, palm_thickness(point, scales));
}

Eigen::Matrix3d SegmentScaling::ray_stretch(const Placed& placed,
                                            const SegmentScales& scales) const {
  const Ray& ray = ray_[placed.ray];
  const auto& here = scales.segment[index_of(ray.segment[placed.segment])];
  const auto& next = scales.segment[index_of(ray.segment[placed.segment + 1])];
  const double t = placed.towards_next;
  const double across = here.across + t * (next.across - here.across);
  const double thickness = here.thickness + t * (next.thickness - here.thickness);
  return placed.frame * Vec3(across, thickness, thickness).asDiagonal() * placed.frame.transpose();
}

Vec3 SegmentScaling::moved(const PointSet& set, std::size_t i,
                           const std::array<ScaledRay, kFingerCount>& rays,
                           const SegmentScales& scales) const {
  Vec3 result = in_palm(set.point[i], scales);
  if (set.begin[i] == set.begin[i + 1]) return result;
  const Vec3 of_palm = result;
  for (int p = set.begin[i]; p < set.begin[i + 1]; ++p) {
    const Placed& placed = set.placed[p];
    const Ray& ray = ray_[placed.ray];
    const ScaledRay& scaled = rays[placed.ray];
    double level = scaled.slope[0] * placed.level;
    for (int c = 0; c < ray.links; ++c) {
      level += (scaled.slope[c + 1] - scaled.slope[c]) * placed.past[c];
    }
    int k = 0;
    while (k + 1 < ray.links && level > scaled.level[k + 1]) ++k;
    const Vec3 centre = scaled.node[k] + (level - scaled.level[k]) * ray.along[k];
    const auto& here = scales.segment[index_of(ray.segment[placed.segment])];
    const auto& next = scales.segment[index_of(ray.segment[placed.segment + 1])];
    const double t = placed.towards_next;
    const double across = here.across + t * (next.across - here.across);
    const double thickness = here.thickness + t * (next.thickness - here.thickness);
    const Vec3 offset(across * placed.offset.x(), thickness * placed.offset.y(),
                      thickness * placed.offset.z());
    result += placed.share * (centre + placed.frame * offset - of_palm);
  }
  return result;
}

std::vector<Vec3> SegmentScaling::skin(const SegmentScales& scales) const {
  const auto rays = scaled_rays(scales);
  std::vector<Vec3> result(skin_.point.size());
  for (std::size_t v = 0; v < result.size(); ++v) result[v] = moved(skin_, v, rays, scales);
  return result;
}

std::vector<Vec3> SegmentScaling::skin_at(const std::vector<int>& vertices,
                                          const SegmentScales& scales) const {
  const auto rays = scaled_rays(scales);
  std::vector<Vec3> result;
  result.reserve(vertices.size());
  for (const int v : vertices) result.push_back(moved(skin_, v, rays, scales));
  return result;
}

/// The scaling for given factors.
class SegmentScaling::Map : public HandMap {
 public:
  Map(const SegmentScaling& scaling, const SegmentScales& scales)
      : scaling_(scaling), scales_(scales), rays_(scaling.scaled_rays(scales)) {}

  std::vector<Vec3> skin() const override { return scaling_.skin(scales_); }

  Eigen::Matrix3d skin_stretch(int vertex) const override {
    const PointSet& set = scaling_.skin_;
    const Eigen::Matrix3d of_palm = palm_stretch(set.point[vertex]);
    Eigen::Matrix3d result = of_palm;
    for (int p = set.begin[vertex]; p < set.begin[vertex + 1]; ++p) {
      const Placed& placed = set.placed[p];
      result += placed.share * (scaling_.ray_stretch(placed, scales_) - of_palm);
    }
    return result;
  }

  std::vector<Vec3> bone(int index) const override {
    const PointSet& set = scaling_.bones_[index];
    std::vector<Vec3> result(set.point.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
      result[v] = scaling_.moved(set, v, rays_, scales_);
    }
    return result;
  }

  Vec3 joint(JointId id) const override {
    for (int f = 0; f < kFingerCount; ++f) {
      const Ray& ray = scaling_.ray_[f];
      for (int k = 0; k < ray.links; ++k) {
        if (ray.joint[k] == id) return rays_[f].node[k];
      }
    }
    return in_palm(scaling_.hand_->skeleton.joint(id).centre);
  }

  Vec3 fingertip(Finger finger) const override {
    return rays_[index_of(finger)].node[scaling_.ray_[index_of(finger)].links];
  }

  Vec3 in_palm(const Vec3& point) const override { return scaling_.in_palm(point, scales_); }

  Eigen::Matrix3d palm_stretch(const Vec3& point) const override {
    return scaling_.palm_stretch(point, scales_);
  }

 private:
  const SegmentScaling& scaling_;
  const SegmentScales& scales_;
  std::array<ScaledRay, kFingerCount> rays_;
};

Skeleton SegmentScaling::skeleton(const SegmentScales& scales) const {
  return mapped_skeleton(hand_->skeleton, Map(*this, scales));
}

Hand SegmentScaling::hand(const SegmentScales& scales) const {
  return mapped(*hand_, Map(*this, scales));
}

}  // namespace palmar::hand
