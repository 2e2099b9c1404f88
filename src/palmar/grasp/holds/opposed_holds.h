// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/precision/precision_grip.h"

namespace palmar::grasp {

/// What a camera sees of a hand that holds something. Product frame, mm.
struct HandPoints {
  static constexpr std::size_t kCount = 1 + hand::kFingerCount;
  /// The wrist's centre, then the fingertips, thumb first: 0.8 of the last phalanx from its joint.
  std::array<Vec3, kCount> point{};

  const Vec3& wrist() const { return point[0]; }
  const Vec3& tip(std::size_t finger) const { return point[1 + finger]; }
  /// Root of the mean square distance of like points, mm.
  double distance_to(const HandPoints& other) const;
};
HandPoints hand_points(const hand::Hand& hand, const hand::Posture& posture,
                       const geometry::Rigid3& product_from_hand);

/// Where a hand's palm is, however its fingers are bent. Product frame, mm.
struct PalmPlace {
  Vec3 wrist = Vec3::Zero();
  Vec3 index_knuckle = Vec3::Zero(), little_knuckle = Vec3::Zero();
  Vec3 faces = Vec3::UnitZ();       ///< out of the palm; unit
  Vec3 thumb_side = Vec3::UnitX();  ///< across the palm, from the little to the index finger; unit
};
PalmPlace palm_place(const hand::Hand& hand, const geometry::Rigid3& product_from_hand);

/// How a thing lies or stands on a table. Its own frame, mm.
struct Standing {
  Vec3 up = Vec3::UnitZ();  ///< unit
  double table = 0.0;       ///< height of the table along `up`
};
/// With that side up, on its lowest point.
Standing standing_with(const geometry::TriangleMesh& mesh, const Vec3& up);

/// A grip's own frame: unit directions across each other, product frame.
struct GripFrame {
  Vec3 middle = Vec3::Zero();  ///< between the thumb's tip and the mean of three fingers', mm
  Vec3 thumb = Vec3::UnitX();  ///< from the fingers to the thumb
  Vec3 wrist = Vec3::UnitY();  ///< towards the wrist
  Vec3 row = Vec3::UnitZ();    ///< along the fingers' row, to the thumb's side
};
GripFrame grip_frame(const HandPoints& points);

/// What a hold is judged by before anything is closed: each a continuous function of the posed hand
/// and of the product's shape; other triangles change them by what a sample of the surface differs.
/// The last three need to know how the product lay before (Standing). L is hand length; the grip is
/// the middle between thumb and fingers.
enum class HoldFeature : std::uint8_t {
  kFingersOnIt,       ///< of four, how many fingertips are at its surface (a bell of 15 mm)
  kDepth,             ///< how far the deepest fingertip is in it: up to 3 cm
  kCrossing,          ///< ln(1 + c / 5 mm), c how far fingers, palm and forearm are in it, summed
  kPalm,              ///< 1 if it touches the palm, nearly 0 if it is 30 mm away
  kWeightAlong,       ///< (a / L)^2, a its centre of gravity from the grip along the fingers' row
  kWeightBeside,      ///< |b| / L, b the same along the line from fingers to thumb
  kBeyondThumbSide,   ///< share of its surface more than 40 mm beyond the grip there
  kBeyondFingertips,  ///< share of its surface more than 30 mm beyond the grip, off the wrist
  kRowAcrossFlat,     ///< flatness times the square of cos(fingers' row, shortest axis)
  kThumbSideUp,       ///< cos(PalmPlace::thumb_side, up)
  kPalmDown,          ///< -cos(PalmPlace::faces, up)
  kBelowTable,        ///< ln(1 + b / 20 mm), b how far the wrist and two knuckles, summed, are
                      ///< lower than 15 mm above the table
};
inline constexpr int kHoldFeatureCount = 12, kTableFeatureCount = 3;
inline constexpr int kShapeFeatureCount = kHoldFeatureCount - kTableFeatureCount;
using HoldFeatures = Eigen::Matrix<double, kHoldFeatureCount, 1>;
using ShapeFeatures = Eigen::Matrix<double, kShapeFeatureCount, 1>;
using TableFeatures = Eigen::Matrix<double, kTableFeatureCount, 1>;
/// The last three features, of a hand in any grip.
TableFeatures table_features(const PalmPlace& palm, const Standing& lay);
std::string_view name_of(HoldFeature feature);  ///< "fingers_on_it", as in a file of weights
/// For people, a clause: what it is like if there is much of it, "the fingers are on it", or
/// little.
std::string_view words_of(HoldFeature feature, bool is_much);

/// A hold between the pads of thumb and fingers: the hand opened to the distance of two opposite
/// points of a product, before its fingertips come down there.
struct OpposedHold {
  Grip grip{};
  OpposedPlace place;
  HandPoints points;
  PalmPlace palm;
  ShapeFeatures features;
};

inline constexpr std::array kOpposedGrips = {Grip::kPrismatic, Grip::kPrecisionSphere,
                                             Grip::kTripod, Grip::kPalmarPinch};
bool is_opposed(Grip grip);  ///< one of these

/// All of a product's: each of its opposing pairs of points, the thumb at either, in twelve turns
/// of the hand, in each of `grips` (others than kOpposedGrips have none). Some thousands for each,
/// in an order that moves along with the product.
std::vector<OpposedHold> opposed_holds(OpenedHand& hand, const product::Product& product,
                                       std::span<const Grip> grips = kOpposedGrips,
                                       const Progress& progress = {});

}  // namespace palmar::grasp
