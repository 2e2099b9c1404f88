// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/phantom/person/subject_person.h"
#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::phantom {

/// What is drawn on a synthetic person's skin for a scan (Xie 2014, 4.2): a line along each of the
/// 14 creases of the fingers and that of the wrist, three dots on the back of every phalanx, eight
/// on that of the hand.
struct SkinPaint {
  geometry::Srgb skin{0.80F, 0.60F, 0.50F};
  geometry::Srgb crease{0.10F, 0.45F, 0.22F};
  geometry::Srgb dot{0.12F, 0.18F, 0.60F};
  double coverage = 0.92;     ///< share of the ink's colour where it is drawn, 0 to 1
  double crease_width = 1.4;  ///< mm
  double dot_diameter = 3.0;  ///< mm
  double texture = 0.07;      ///< relative contrast of the skin's own pattern
  bool has_creases = true, has_dots = true;
  bool is_tinted = false;  ///< redder where blood shows through, nails: see SkinTint
  geometry::Srgb ring_colour{0.78F, 0.78F, 0.80F};
  void check() const;  ///< throws UsageError: field, value, allowed range
};

struct PaintedHandOptions {
  std::uint64_t seed = 1;  ///< of the person, see make_person(), and of the pattern on its skin
  hand::Side side = hand::Side::kRight;
  PersonDispersion dispersion{};  ///< how far the person differs from the base
  SkinPaint paint;
  std::optional<hand::Finger> ring;  ///< that wears one, on its proximal phalanx: 5 mm wide, 1.2 mm
                                     ///< thick
  int takes = 1;          ///< of the first posture: photographs between which fingers move a little
  double restless = 0.0;  ///< how far each fingertip moves from take to take, RMS, mm
  int levels = 2;         ///< 0 to 3: how often triangles with edges of 2 mm are cut into four
  void check() const;
};

struct PaintedDot {
  hand::Segment segment = hand::Segment::kPalm;  ///< the palm's lie on the back of the hand
  Vec3 point = Vec3::Zero();                     ///< mm
};

/// A painted hand in one posture. Hand frame of the reference posture, the palm standing still.
struct PaintedPosture {
  std::vector<Vec3> skin;        ///< vertex for vertex that of the reference posture
  std::vector<PaintedDot> dots;  ///< centres
  std::map<hand::Segment, std::vector<Vec3>> crease;  ///< middle line of each proximal crease;
                                                      ///< palm: the wrist's
  /// Where the flexion axis of each phalanx' joint lies: axis (unit) and a point, its middle.
  struct TrueJoint {
    Vec3 axis = Vec3::UnitX(), centre = Vec3::Zero();
  };
  std::map<hand::Segment, TrueJoint> joint;
  std::map<hand::Segment, Vec3> fingertip;       ///< of the last segments: point of the skin
  std::array<double, hand::kDofCount> angles{};  ///< rad
};

/// A person that doesn't exist, painted; moves by a model of its own (docs/method/phantom.md).
struct PaintedHand {
  std::string name;
  hand::Side side = hand::Side::kRight;
  std::vector<Triangle> triangles;
  std::vector<geometry::Srgb> colour;  ///< per vertex
  std::vector<double> ring;  ///< per vertex: how far a ring stands off the skin, mm; empty: none
  hand::HandDimensions dimensions;  ///< from the painted creases
  std::map<hand::ScanPosture, PaintedPosture> postures;
  std::vector<std::vector<Vec3>> takes;  ///< skins of the takes after the first
};

/// `base`: whose skin's outline the person starts from; `postures`: which are made.
PaintedHand make_painted_hand(const hand::Hand& base,
                              const std::vector<hand::ScanPosture>& postures,
                              const PaintedHandOptions& options = {});

/// One of its postures as a coloured surface, with the ring if one is worn.
geometry::ColouredMesh surface_of(const PaintedHand& hand, hand::ScanPosture posture);
/// The same with its skin somewhere else.
geometry::ColouredMesh surface_of(const PaintedHand& hand, const std::vector<Vec3>& skin);

}  // namespace palmar::phantom
