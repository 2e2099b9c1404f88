// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/instance/scaled_hand.h"

#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/instance/hand_map.h"

namespace palmar::hand {
namespace {

/// Everything times one factor, about the origin of the hand frame.
class UniformMap : public HandMap {
 public:
  UniformMap(const Hand& hand, double factor) : hand_(hand), factor_(factor) {}

  std::vector<Vec3> skin() const override { return scaled(hand_.skin.vertices); }
  Eigen::Matrix3d skin_stretch(int) const override { return stretch(); }
  std::vector<Vec3> bone(int index) const override {
    return scaled(hand_.bones[index].mesh.vertices);
  }
  Vec3 joint(JointId id) const override { return factor_ * hand_.skeleton.joint(id).centre; }
  Vec3 fingertip(Finger finger) const override {
    return factor_ * hand_.skeleton.fingertips[index_of(finger)];
  }
  Vec3 in_palm(const Vec3& point) const override { return factor_ * point; }
  Eigen::Matrix3d palm_stretch(const Vec3&) const override { return stretch(); }

 private:
  Eigen::Matrix3d stretch() const { return factor_ * Eigen::Matrix3d::Identity(); }
  std::vector<Vec3> scaled(std::vector<Vec3> points) const {
    for (Vec3& point : points) point *= factor_;
    return points;
  }

  const Hand& hand_;
  double factor_;
};

}  // namespace

Hand scaled(const Hand& hand, double factor) {
  if (!(factor >= 0.2 && factor <= 5.0)) {
    throw UsageError("scale of hand \"" + hand.name + "\" is " + std::to_string(factor) +
                     "; 0.2 to 5 is allowed");
  }
  Hand result = mapped(hand, UniformMap(hand, factor));
  for (const HandDimension dimension : all_hand_dimensions()) {
    set_value(result.dimensions, dimension, factor * value_of(hand.dimensions, dimension));
  }
  SegmentDimensions& palm = result.dimensions.segment[index_of(Segment::kPalm)];
  palm.width *= factor;
  palm.thickness *= factor;
  result.provenance += "; scaled by " + std::to_string(factor);
  return result;
}

}  // namespace palmar::hand
