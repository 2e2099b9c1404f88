// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/anatomy.h"
#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// Segment and region of a point of the skin.
struct SkinLabel {
  Segment segment = Segment::kPalm;
  Region region = Region::kDorsum;
  friend bool operator==(const SkinLabel&, const SkinLabel&) = default;
};

/// An oriented plane in the hand frame: value(p) = normal . (p - point), mm.
struct CreasePlane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, towards the fingertip
  double value(const Vec3& p) const { return normal.dot(p - point); }
};

/// Smooth curve in a plane: a Catmull-Rom spline through given points, drawn on straight at both
/// ends. signed_distance() is positive to the left of the direction of travel.
class PlaneCurve {
 public:
  PlaneCurve() = default;
  explicit PlaneCurve(const std::vector<Eigen::Vector2d>& through);
  double signed_distance(const Eigen::Vector2d& p) const;

 private:
  std::vector<Eigen::Vector2d> sample_;
};

/// The main creases of one hand as level sets in space, from its joints and webs; hence they scale
/// with any hand. All lengths mm, hand frame, reference posture.
///
/// - Wrist crease: plane across the forearm, distal of the radiocarpal joint by 0.15 of the
///   distance from there to the third MCP joint (13.5 mm; Bugbee & Botte 1993). What lies proximal
///   of it, the stub of the forearm, counts as palm segment and dorsum region.
/// - Finger base (palmar digital) crease: plane through the webs beside the finger, which lie 14 to
///   20 mm distal of the MCP joint; that of the thumb through the first web and the MP joint.
/// - PIP and DIP creases: planes 2-3 mm and 7-8 mm proximal of their joints (same source), as a
///   share of the link they lie on; thumb IP crease likewise.
/// - Palmar skin ends beside the finger at the height of the joint axes and, at the tip, below the
///   free edge of the nail. The first web belongs to the palmar side.
/// - Across the palm: one transverse line, 8-10 mm proximal of the MCP joints (distal palmar crease
///   on the ulnar side, proximal palmar crease on the radial side); thenar crease; a line between
///   hypothenar and central palm; a line from the web of middle and ring finger between the pads.
///
/// Source: Bugbee & Botte 1993, Clin Orthop Relat Res 296:122-126 (distances); Xie 2014, fig. 3-10
/// (which regions). The shapes of thenar and hypothenar border are drawn here, not measured.
class HandCreases {
 public:
  /// Throws InputError if two neighbouring fingers have no web between them on this skin.
  HandCreases(const geometry::TriangleMesh& skin, const Skeleton& skeleton);

  /// Segment and region of a point on (or near) the skin.
  SkinLabel label(const Vec3& point) const;

  /// The level set between two labels: 0 on their common crease, mm (approximately a distance). Its
  /// sign differs on the two sides.
  double boundary_value(const Vec3& point, const SkinLabel& a, const SkinLabel& b) const;

  const CreasePlane& wrist() const { return wrist_; }
  /// Proximal crease of a phalanx. Throws UsageError for the palm.
  const CreasePlane& proximal_crease(Segment phalanx) const;
  /// Puts a crease where this person's is seen. Throws UsageError for the palm.
  void set_proximal_crease(Segment phalanx, const CreasePlane& crease);
  void set_wrist(const CreasePlane& crease) { wrist_ = crease; }
  /// Deepest point of the web between finger k and k + 1 (0: thumb and index).
  const Vec3& web(int k) const { return web_[k]; }
  /// Height above the joint axes towards the palm, mm; 0 where palmar skin ends.
  double palmar_height(const Vec3& point) const;
  /// Palmar direction of a finger at a node of its ray (0: wrist or CMC, 1: MCP, 2: PIP, 3: DIP,
  /// 4: tip; thumb: wrist, CMC, MP, IP, tip).
  const Vec3& palmar_direction(Finger finger, int node) const;
  /// +1 for a right hand, -1 for a left one: radial is radial_sign() * x.
  double radial_sign() const { return sign_; }

 private:
  struct Ray {
    std::array<Vec3, 5> node;
    std::array<Vec3, 5> palmar;
  };
  struct OnRay {
    double distance = 0.0;
    double height = 0.0;  ///< palmar of the ray
    double to_tip = 0.0;  ///< along the last link, negative before the tip
  };
  OnRay project(const Ray& ray, const Vec3& point) const;
  int nearest_ray(const Vec3& point) const;
  /// Finger and place of a phalanx's proximal crease in crease_.
  static std::array<std::size_t, 2> place_of(Segment phalanx);
  /// Distances of the skin's vertices from the rays, mm; only those asked for are computed.
  class RayDistances;
  Vec3 find_web(const geometry::TriangleMesh& skin, int k, RayDistances& distance) const;
  void place_web();
  void place_finger_creases();
  void place_palm_creases();
  Eigen::Vector2d in_palm(const Vec3& point) const { return {sign_ * point.x(), point.y()}; }

  double sign_ = 1.0;
  double scale_ = 1.0;  ///< wrist to third MCP joint over that of a 185 mm hand
  std::array<Ray, kFingerCount> ray_;
  std::array<Vec3, kFingerCount - 1> web_;
  /// First web: from its root between the metacarpals to its ridge; normal towards the palm.
  Vec3 web_root_, web_end_, web_palmar_;
  CreasePlane wrist_;
  std::array<std::array<CreasePlane, 3>, kFingerCount> crease_;  ///< base, PIP, DIP (thumb: 2)
  PlaneCurve transverse_, thenar_, hypothenar_, between_pads_;
};

}  // namespace palmar::hand
