// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/hand/instance/hand_map.h"

namespace palmar::hand {

/// Factors on the size of each segment. Palm: across = x, along = y, thickness = z of the hand
/// frame. Phalanx: along = from crease to crease, across = along the flexion axis, thickness =
/// perpendicular to both.
struct SegmentScales {
  struct Factors {
    double along = 1.0, across = 1.0, thickness = 1.0;
  };
  std::array<Factors, kSegmentCount> segment;  ///< indexed by Segment
  /// How much thicker the borders of the palm become than its middle: z is multiplied by
  /// 1 + bow (1 - exp(-2 s^2)) f(s) exp(-t^2), s = distance across from the third metacarpal head
  /// over that of the ulnar border, t = distance along from it over 0.45 of that to the wrist;
  /// f fades from 1 at s = 1 to 0 at s = 1.6, for the thumb.
  double bow = 0.0;
};

/// A hand laid out for scaling segment by segment, any number of times (Xie 2014, 4.3, 5.4; the
/// blending is Palmar's own).
///
/// The palm is stretched along the axes of the hand frame: v' = P(v). A ray (thumb from the MP
/// joint, finger from the MCP joint) is stretched about its chain of bones: a point at arc length y
/// along the chain and offset o from it goes to c'(y') + M(y) o. y' has the slope of the palm up to
/// the base crease and of each phalanx from joint to joint (the PIP and DIP creases lie at a share
/// of the bone, so they land where HandCreases puts them), with corners rounded; c' keeps the
/// directions of the bones; M stretches across and in thickness by factors that run smoothly from
/// the middle of one segment to the middle of the next. Between the MCP joint and the middle of
/// the proximal segment P and the ray's map are mixed, and in the webs those of both fingers, in
/// the shares of the MCP joints' skinning weights w2; hence no step at the creases.
class SegmentScaling {
 public:
  explicit SegmentScaling(const Hand& hand);

  /// What of each segment of a finger, from crease to crease, lies on which link of its chain:
  /// [segment][link], mm. A link follows the factor `along` of the segment of the same number, the
  /// first one only beyond the base crease.
  using Parts = std::array<std::array<double, 3>, 3>;
  const Parts& parts(Finger finger) const { return ray_[index_of(finger)].parts; }

  std::vector<Vec3> skin(const SegmentScales& scales) const;
  std::vector<Vec3> skin_at(const std::vector<int>& vertices, const SegmentScales& scales) const;
  Skeleton skeleton(const SegmentScales& scales) const;
  Hand hand(const SegmentScales& scales) const;

  /// A point of the palm.
  Vec3 in_palm(const Vec3& point, const SegmentScales& scales) const;

 private:
  class Map;
  struct Ray {
    int links = 3;
    std::array<Segment, 3> segment{};
    std::array<JointId, 3> joint{};
    std::array<Vec3, 4> node;        ///< joints and tip
    std::array<Vec3, 3> along;       ///< of each link, unit
    std::array<Vec3, 4> cut;         ///< normals of the planes between links
    std::array<Vec3, 4> palmar;      ///< at the nodes
    std::array<double, 4> level{};   ///< arc length of the nodes
    double base = 0.0;               ///< arc length of the base crease
    std::array<double, 3> middle{};  ///< arc length of the segments' middles
    Parts parts{};
    std::array<double, 3> rounding{};  ///< half lengths of the rounded corners of y'
  };
  /// A point laid out on a ray; nothing of it depends on the factors.
  struct Placed {
    int ray = 0;
    double share = 0.0;            ///< of the ray's map in where the point goes
    double level = 0.0;            ///< y
    std::array<double, 3> past{};  ///< rounded max(0, y - corner), corners: base, PIP, DIP
    int segment = 0;               ///< factors run from those of this segment of the ray
    double towards_next = 0.0;     ///< to those of the next one
    Vec3 offset = Vec3::Zero();    ///< o: across, palmar, along
    Eigen::Matrix3d frame;         ///< columns: across, palmar, along
  };
  /// A ray for given factors.
  struct ScaledRay {
    std::array<Vec3, 4> node;
    std::array<double, 4> level{};
    std::array<double, 4> slope{};  ///< of y': palm, then the links
  };
  struct PointSet {
    std::vector<Vec3> point;
    std::vector<int> begin;  ///< of each point in `placed`, one more at the end
    std::vector<Placed> placed;
  };

  std::array<ScaledRay, kFingerCount> scaled_rays(const SegmentScales& scales) const;
  Placed place(int ray, const Vec3& point) const;
  void add(PointSet& set, const Vec3& point, const std::array<double, kFingerCount>& share) const;
  Vec3 moved(const PointSet& set, std::size_t i, const std::array<ScaledRay, kFingerCount>& rays,
             const SegmentScales& scales) const;
  Eigen::DiagonalMatrix<double, 3> palm_stretch(const Vec3& point,
                                                const SegmentScales& scales) const;
  double palm_thickness(const Vec3& point, const SegmentScales& scales) const;
  Eigen::Matrix3d ray_stretch(const Placed& placed, const SegmentScales& scales) const;

  const Hand* hand_;
  std::array<Ray, kFingerCount> ray_;
  Vec3 head_ = Vec3::Zero();  ///< of the third metacarpal
  double border_ = 1.0;       ///< of the palm, ulnar of it, mm
  PointSet skin_;
  std::vector<PointSet> bones_;
};

}  // namespace palmar::hand
