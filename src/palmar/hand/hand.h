// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/anatomy.h"
#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// Influence of one joint on the skin (Xie 2014, eq. 2-7): vertex i turns by
/// w1_i w2_i (angle - reference). Sparse: only vertices with w1 w2 > 0 are listed.
struct JointWeights {
  JointId joint{};
  std::vector<int> vertex;  ///< ascending
  std::vector<double> w1;   ///< 0 on the steady side, 1 on the rigid side, along the bone
  std::vector<double> w2;   ///< 1 inside an inner ellipse about the finger, 0 outside an outer one
  /// Addition to eq. 2-7: how far the skin over the joint comes out per radian of flexion beyond
  /// the reference angle, mm/rad, reference frame; keeps the volume of a bent finger. Empty or one
  /// per vertex.
  std::vector<Vec3> bulge;
};

/// Gaussian radial-basis correction of the thumb ball at the four CMC limit postures (Xie 2014,
/// eq. 2-8 to 2-10); empty for a hand without measured limit postures.
struct ThumbBallCorrection {
  double beta = 0.0;                             ///< 1/mm^2
  std::vector<Vec3> marker;                      ///< reference posture, mm
  std::vector<int> vertex;                       ///< skin vertices it acts on
  std::array<std::vector<Vec3>, 4> coefficient;  ///< flexion, extension, abduction, adduction; mm
};

/// One bone: closed mesh in the hand frame, reference posture.
struct Bone {
  std::string name;  ///< "index_middle_phalanx", "third_metacarpal", "thumb_metacarpal"
  std::optional<Segment> segment;    ///< rigid part it moves with: a phalanx or the palm
  bool is_thumb_metacarpal = false;  ///< moves with the CMC joint instead
  geometry::TriangleMesh mesh;
};

/// Dimensions of one segment (Xie 2014, fig. 5-4): y along the segment, x along the crease, z
/// normal to the palm plane; mm.
struct SegmentDimensions {
  double length = 0.0, width = 0.0, thickness = 0.0;
};

/// Major dimensions (Xie 2014, fig. 5-3), mm.
struct HandDimensions {
  double hand_length = 0.0;         ///< L: wrist crease to tip of the middle finger
  double hand_circumference = 0.0;  ///< C: girth over the metacarpal heads, thumb excluded
  double hand_width = 0.0;          ///< W: breadth over the metacarpal heads, thumb excluded
  double hand_thickness = 0.0;      ///< T: thickness at the third metacarpal head
  std::array<SegmentDimensions, kSegmentCount> segment;
};

/// Shear modulus that grows with the depth of penetration (Xie 2014, eq. 3-3): linear from g0 at
/// first touch to g_limit at limit_depth, constant beyond.
struct StiffeningLaw {
  double g0 = 0.0;           ///< MPa
  double g_limit = 0.0;      ///< MPa
  double limit_depth = 0.0;  ///< d_lim, mm
  bool operator==(const StiffeningLaw&) const = default;
};

/// A stiffening law with the range that people and measurements leave open.
struct TissueStiffness {
  StiffeningLaw nominal, low, high;
  bool operator==(const TissueStiffness&) const = default;
};

/// Tissue between skin and bone, whose modulus grows linearly with its mean strain:
/// G = G0 (1 + stiffening sqrt(W / V G0)), W the energy that its displacements store at the modulus
/// G0, V the volume of the tissue below the region.
struct BoneTissueLaw {
  double g0 = 0.0;          ///< MPa
  double stiffening = 0.0;  ///< no unit
  bool operator==(const BoneTissueLaw&) const = default;
};
struct BoneTissue {
  BoneTissueLaw nominal, low, high;
  bool operator==(const BoneTissue&) const = default;
};

/// Which of the three laws of a TissueStiffness.
enum class TissueLevel { kLow, kNominal, kHigh };

inline const StiffeningLaw& law_at(const TissueStiffness& stiffness, TissueLevel level) {
  if (level == TissueLevel::kLow) return stiffness.low;
  return level == TissueLevel::kHigh ? stiffness.high : stiffness.nominal;
}

inline const BoneTissueLaw& law_at(const BoneTissue& tissue, TissueLevel level) {
  if (level == TissueLevel::kLow) return tissue.low;
  return level == TissueLevel::kHigh ? tissue.high : tissue.nominal;
}

/// Mechanical class of the skin of a region. MPa, mm.
struct RegionTissue {
  TissueStiffness half_space;    ///< of skin without end (Xie 2014): stiffening stands for the bone
  TissueStiffness layered;       ///< of a layer bonded to bone, which stiffens by itself
  BoneTissue on_bone;            ///< of the tissue that the hand's own bones hold
  double poisson_layered = 0.5;  ///< Poisson's ratio of that layer
  // Bulge around the contact, Xie 2014, eq. (3-5), Table 3-2.
  double swelling_height = 0.0;  ///< a0, mm at 1 N and G0
  double swelling_radius = 0.0;  ///< b, mm
  double swelling_width = 0.0;   ///< c, mm
  double neighbourhood = 0.0;    ///< growth of the collision region to the active region, mm
  std::string source;            ///< where these numbers come from
  bool operator==(const RegionTissue&) const = default;
};

struct Tissue {
  std::array<RegionTissue, kRegionCount> region;  ///< indexed by Region
  std::string source;
};

/// Finger and palm values of Xie 2014 (see docs/method/contact.md).
Tissue default_tissue();

/// A whole hand; an immutable value. Skin, joints and bones are in the hand frame of the reference
/// posture (x radial, y distal, z palmar for a right hand; origin at the wrist joint centre); mm.
/// A left hand is stored mirrored (x -> -x), triangles turned to stay counter-clockwise outside.
struct Hand {
  std::string name;
  Side side = Side::kRight;
  geometry::TriangleMesh skin;   ///< closed, 2-manifold
  std::vector<Segment> segment;  ///< per vertex
  std::vector<Region> region;    ///< per vertex
  Skeleton skeleton;
  std::vector<JointWeights> weights;  ///< one per joint, ascending JointId
  ThumbBallCorrection thumb_ball;
  std::vector<Bone> bones;
  HandDimensions dimensions;
  Tissue tissue;
  std::string provenance;  ///< origin, licence, and what was done to it
};

}  // namespace palmar::hand
