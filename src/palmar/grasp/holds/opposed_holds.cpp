// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/opposed_holds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/grid_distance.h"
#include "palmar/grasp/precision/opposing_points.h"
#include "palmar/grasp/precision/precision_search.h"
#include "palmar/grasp/precision/precision_shape.h"

namespace palmar::grasp {
namespace {

constexpr double kTipShare = 0.8;     // of the last phalanx, from its joint
constexpr double kWidest = 0.58;      // hand lengths between the two points
constexpr double kWiderThanHand = 4;  // mm; pads give way, as search_precision_grip() has it
constexpr int kPairPoints = 900, kSurfacePoints = 300;
constexpr double kGridSpacing = 3.0, kGridBand = 30.0;  // mm
// Where the features change, mm; all chosen by sense, before any fit.
constexpr double kOnIt = 15.0;
constexpr double kDepthUnit = 10.0, kDeepest = 30.0;
constexpr double kCrossingUnit = 5.0;
constexpr double kPalmUnit = 15.0, kPalmSkin = 20.0;  // the palm's skin is so far from its bones
constexpr double kBeyondThumb = 40.0, kBeyondTips = 30.0, kBeyondRamp = 5.0;
constexpr double kPalmShare = 0.6;  // of the way from the wrist to the knuckles
constexpr double kAboveTable = 15.0, kBelowUnit = 20.0;  // half of a hand is 15 mm thick

struct Axes {
  Vec3 centre;           // of volume
  Eigen::Matrix3d axes;  // longest extent first
  Vec3 extent;           // mm
};

Axes sorted_axes(const PinchShape& shape) {
  const Vec3 size = shape.upper - shape.lower;
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return size[a] > size[b]; });
  Axes result;
  result.centre = shape.centre;
  for (int k = 0; k < 3; ++k) {
    result.axes.col(k) = shape.axes.col(order[static_cast<std::size_t>(k)]);
    result.extent[k] = std::max(size[order[static_cast<std::size_t>(k)]], 1e-6);
  }
  return result;
}

/// What holds of one product are judged against.
class FeatureScene {
 public:
  FeatureScene(const hand::Hand& hand, const product::Product& product, const FingertipIk& ik)
      : hand_(&hand),
        ik_(&ik),
        field_(product.distance, {.spacing = kGridSpacing, .band = kGridBand}),
        shape_(pinch_shape(product.mesh)),
        axes_(sorted_axes(shape_)),
        surface_(spread_points(product.mesh, kSurfacePoints)) {}

  const PinchShape& shape() const { return shape_; }

  ShapeFeatures features_of(const HandPoints& points, const hand::Posture& posture,
                            const geometry::Rigid3& product_from_hand,
                            const std::vector<FingertipPoint>& contacts) const;

 private:
  const hand::Hand* hand_;
  const FingertipIk* ik_;
  geometry::GridDistance field_;
  PinchShape shape_;
  Axes axes_;
  std::vector<SurfacePoint> surface_;
};

double above(double value, double limit) {
  return 1.0 / (1.0 + std::exp(-(value - limit) / kBeyondRamp));
}

ShapeFeatures FeatureScene::features_of(const HandPoints& points, const hand::Posture& posture,
                                        const geometry::Rigid3& product_from_hand,
                                        const std::vector<FingertipPoint>& contacts) const {
  using enum HoldFeature;
  ShapeFeatures result;
  const auto at = [&](HoldFeature feature) -> double& { return result[static_cast<int>(feature)]; };
  const double length = hand_->dimensions.hand_length;
  const auto [middle, thumb, wrist, row] = grip_frame(points);

  double on_it = 0.0, deepest = 0.0;
  for (std::size_t f = 1; f < hand::kFingerCount; ++f) {
    const double off = field_.at(points.tip(f)).distance;
    on_it += std::exp(-off * off / (kOnIt * kOnIt));
    deepest = std::max(deepest, std::min(-off, kDeepest));
  }
  at(kFingersOnIt) = on_it;
  at(kDepth) = deepest / kDepthUnit;
  at(kCrossing) =
      std::log1p(ik_->clash_of(field_, posture, product_from_hand, contacts) / kCrossingUnit);
  const Vec3 knuckles = 0.5 * (hand_->skeleton.joint(hand::JointId::kMiddleMcp).centre +
                               hand_->skeleton.joint(hand::JointId::kRingMcp).centre);
  const Vec3 palm = product_from_hand * Vec3(kPalmShare * knuckles + kPalmSkin * Vec3::UnitZ());
  const double gap = std::max(0.0, field_.at(palm).distance);
  at(kPalm) = std::exp(-gap * gap / (kPalmUnit * kPalmUnit));
  const Vec3 weight = (axes_.centre - middle) / length;
  at(kWeightAlong) = std::pow(row.dot(weight), 2);
  at(kWeightBeside) = std::abs(thumb.dot(weight));
  double beyond_thumb = 0.0, beyond_tips = 0.0;
  for (const SurfacePoint& point : surface_) {
    const Vec3 r = point.point - middle;
    beyond_thumb += above(row.dot(r), kBeyondThumb);
    beyond_tips += above(-wrist.dot(r), kBeyondTips);
  }
  const double count = std::max<double>(1.0, static_cast<double>(surface_.size()));
  at(kBeyondThumbSide) = beyond_thumb / count;
  at(kBeyondFingertips) = beyond_tips / count;
  const double flatness = 1.0 - axes_.extent[2] / axes_.extent[1];
  at(kRowAcrossFlat) = flatness * std::pow(row.dot(axes_.axes.col(2)), 2);
  return result;
}

struct FeatureText {
  std::string_view name, much, little;
};
constexpr std::array<FeatureText, kHoldFeatureCount> kTexts = {{
    {"fingers_on_it", "the fingers are on it", "not all fingers are on it"},
    {"depth", "it lies deep between thumb and fingers",
     "it lies shallow between thumb and fingers"},
    {"crossing", "little room for the hand", "room for the hand"},
    {"palm", "the palm is against it", "the palm is clear of it"},
    {"weight_along", "its weight is beside the fingers' row",
     "its weight is within the fingers' row"},
    {"weight_beside", "its weight is beside the line from thumb to fingers",
     "its weight is between thumb and fingers"},
    {"beyond_thumb_side", "much of it is beyond the thumb's side",
     "little of it is beyond the thumb's side"},
    {"beyond_fingertips", "much of it is beyond the fingertips",
     "little of it is beyond the fingertips"},
    {"row_across_flat", "the fingers' row is across its flat sides",
     "the fingers' row is along its flat sides"},
    {"thumb_side_up", "the thumb's side is up", "the thumb's side is down"},
    {"palm_down", "the palm faces down", "the palm faces up"},
    {"below_table", "the hand is where the table is", "the hand is clear of the table"},
}};

}  // namespace

std::string_view name_of(HoldFeature feature) { return kTexts[index_of(feature)].name; }
std::string_view words_of(HoldFeature feature, bool is_much) {
  const FeatureText& text = kTexts[index_of(feature)];
  return is_much ? text.much : text.little;
}

double HandPoints::distance_to(const HandPoints& other) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < kCount; ++k) sum += (point[k] - other.point[k]).squaredNorm();
  return std::sqrt(sum / kCount);
}

Standing standing_with(const geometry::TriangleMesh& mesh, const Vec3& up) {
  Standing standing;
  standing.up = up.normalized();
  standing.table = std::numeric_limits<double>::infinity();
  for (const Vec3& v : mesh.vertices) standing.table = std::min(standing.table, standing.up.dot(v));
  return standing;
}

GripFrame grip_frame(const HandPoints& points) {
  const Vec3 others = (points.tip(1) + points.tip(2) + points.tip(3)) / 3.0;
  GripFrame frame;
  frame.middle = 0.5 * (points.tip(0) + others);
  frame.thumb = (points.tip(0) - others).normalized();
  const Vec3 wrist = points.wrist() - frame.middle;
  frame.wrist = (wrist - frame.thumb * frame.thumb.dot(wrist)).normalized();
  frame.row = frame.wrist.cross(frame.thumb);
  if (frame.row.dot(points.tip(1) - points.tip(4)) < 0.0) frame.row = -frame.row;
  return frame;
}

bool is_opposed(Grip grip) {
  return std::find(kOpposedGrips.begin(), kOpposedGrips.end(), grip) != kOpposedGrips.end();
}

PalmPlace palm_place(const hand::Hand& hand, const geometry::Rigid3& product_from_hand) {
  const auto joint = [&](hand::JointId id) -> Vec3 {
    return product_from_hand * hand.skeleton.joint(id).centre;
  };
  const double thumb = hand.side == hand::Side::kRight ? 1.0 : -1.0;
  return {.wrist = product_from_hand.translation,  // the hand frame's origin is the wrist
          .index_knuckle = joint(hand::JointId::kIndexMcp),
          .little_knuckle = joint(hand::JointId::kLittleMcp),
          .faces = product_from_hand.rotation * Vec3::UnitZ(),
          .thumb_side = product_from_hand.rotation * Vec3(thumb * Vec3::UnitX())};
}

TableFeatures table_features(const PalmPlace& palm, const Standing& lay) {
  double below = 0.0;
  for (const Vec3& point : {palm.wrist, palm.index_knuckle, palm.little_knuckle}) {
    below += std::max(0.0, lay.table + kAboveTable - lay.up.dot(point));
  }
  return {palm.thumb_side.dot(lay.up), -palm.faces.dot(lay.up), std::log1p(below / kBelowUnit)};
}

HandPoints hand_points(const hand::Hand& hand, const hand::Posture& posture,
                       const geometry::Rigid3& product_from_hand) {
  using enum hand::JointId;
  constexpr std::array kLast = {kThumbIp, kIndexDip, kMiddleDip, kRingDip, kLittleDip};
  constexpr std::array kPhalanx = {hand::Segment::kThumbDistal, hand::Segment::kIndexDistal,
                                   hand::Segment::kMiddleDistal, hand::Segment::kRingDistal,
                                   hand::Segment::kLittleDistal};
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand.skeleton, posture);
  HandPoints points;
  points.point[0] = product_from_hand.translation;
  for (std::size_t f = 0; f < hand::kFingerCount; ++f) {
    const Vec3& joint = hand.skeleton.joint(kLast[f]).centre;
    const Vec3 tip = joint + kTipShare * (hand.skeleton.fingertips[f] - joint);
    points.point[1 + f] = product_from_hand * (posed.segment[index_of(kPhalanx[f])] * tip);
  }
  return points;
}

std::vector<OpposedHold> opposed_holds(OpenedHand& opened, const product::Product& product,
                                       std::span<const Grip> grips, const Progress& progress) {
  const hand::Hand& hand = opened.hand();
  const FingertipIk& ik = opened.ik();
  const FeatureScene scene(hand, product, ik);
  OpposingOptions wanted;
  wanted.widest = kWidest * hand.dimensions.hand_length;
  wanted.most = std::numeric_limits<int>::max();
  wanted.points = kPairPoints;
  const std::vector<OpposingPair> pairs = find_opposing_pairs(product, scene.shape(), wanted);
  std::vector<OpposedHold> holds;
  for (const Grip grip : grips) {
    progress.throw_if_cancelled();
    if (!is_opposed(grip)) continue;
    const GripOpenings& openings = opened.openings(grip);
    if (openings.all().empty()) continue;
    std::vector<std::vector<OpposedHold>> found(pairs.size());
    parallel_for(static_cast<int>(pairs.size()), [&](int i) {
      const OpposingPair& pair = pairs[static_cast<std::size_t>(i)];
      if (pair.width() > openings.widest() + kWiderThanHand) return;
      if (grip == Grip::kPrecisionSphere && pair.width() < kFiveFit) return;
      const GripOpening& opening = openings.at(pair.width());
      for (const bool is_swapped : {false, true}) {
        const Vec3& thumb = is_swapped ? pair.b : pair.a;
        const Vec3& others = is_swapped ? pair.a : pair.b;
        for (int turn = 0; turn < kOpposedTurns; ++turn) {
          OpposedHold hold;
          hold.grip = grip;
          hold.place = opposed_place(hand, opening, scene.shape(), thumb, others, turn);
          hold.points = hand_points(hand, opening.posture, hold.place.product_from_hand);
          hold.palm = palm_place(hand, hold.place.product_from_hand);
          hold.features = scene.features_of(hold.points, opening.posture,
                                            hold.place.product_from_hand, openings.fingertips());
          found[static_cast<std::size_t>(i)].push_back(hold);
        }
      }
    });
    for (const std::vector<OpposedHold>& some : found) {
      holds.insert(holds.end(), some.begin(), some.end());
    }
  }
  return holds;
}

}  // namespace palmar::grasp
