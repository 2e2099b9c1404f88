// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/template/hand_frame.h"

#include <array>
#include <string>

#include "palmar/core/error.h"

namespace palmar::hand {

const geometry::Rigid3& frame_named(const HandAsset& asset, std::string_view name) {
  for (const HandAsset::Frame& frame : asset.frames) {
    if (frame.name == name) return frame.asset_from_joint;
  }
  throw InputError("hand asset: joint frame \"" + std::string(name) + "\" is missing (it has " +
                   std::to_string(asset.frames.size()) + " frames; the generic hand has 25)");
}

geometry::Rigid3 hand_from_asset(const HandAsset& asset) {
  const Vec3 wrist = frame_named(asset, "wrist").translation;
  const Vec3 index = frame_named(asset, "index-finger-phalanx-proximal").translation;
  const Vec3 middle = frame_named(asset, "middle-finger-phalanx-proximal").translation;
  const Vec3 little = frame_named(asset, "pinky-finger-phalanx-proximal").translation;
  const Vec3 thumb = frame_named(asset, "thumb-tip").translation;

  const Vec3 y = (middle - wrist).normalized();
  const Vec3 across = index - little;
  const Vec3 x = (across - across.dot(y) * y).normalized();
  const Vec3 z = x.cross(y);
  Eigen::Matrix3d axes;
  axes << x.transpose(), y.transpose(), z.transpose();
  if (!axes.allFinite()) {
    throw InputError("hand asset: wrist and MCP joints coincide; no hand frame can be made");
  }
  for (const char* name : {"index-finger-phalanx-proximal", "middle-finger-phalanx-proximal",
                           "ring-finger-phalanx-proximal", "pinky-finger-phalanx-proximal"}) {
    const Vec3 dorsal = frame_named(asset, name).rotation * Vec3::UnitY();
    if (dorsal.dot(z) > -0.7) {  // within 45 degrees
      throw InputError("hand asset: the dorsal direction of joint \"" + std::string(name) +
                       "\" does not point away from the palm; a right hand is needed");
    }
  }
  if ((thumb - wrist).dot(x) <= 0) {
    throw InputError("hand asset: the tip of the thumb is not on the radial side");
  }
  const Quat rotation(axes);
  return {rotation.normalized(), -(rotation.normalized() * wrist)};
}

HandAsset in_hand_frame(const HandAsset& asset) {
  const geometry::Rigid3 hand_from = hand_from_asset(asset);
  HandAsset moved = asset;
  for (Vec3& v : moved.skin.vertices) v = hand_from * v;
  for (HandAsset::Frame& frame : moved.frames) {
    frame.asset_from_joint = hand_from * frame.asset_from_joint;
  }
  return moved;
}

std::string frame_name(Finger finger, const char* bone) {
  if (finger == Finger::kThumb) return std::string("thumb-") + bone;
  const std::string_view name = finger == Finger::kLittle ? "pinky" : name_of(finger);
  return std::string(name) + "-finger-" + bone;
}

Vec3 fingertip(const HandAsset& asset, Finger finger) {
  constexpr double kFingerRadius = 12.0;  // mm; more than half a thumb, less than to a neighbour
  const Vec3 joint = frame_named(asset, frame_name(finger, "phalanx-distal")).translation;
  const Vec3 tip = frame_named(asset, frame_name(finger, "tip")).translation;
  const Vec3 along = (tip - joint).normalized();
  Vec3 best = tip;
  for (const Vec3& v : asset.skin.vertices) {
    const double y = (v - joint).dot(along);
    if (y <= (best - joint).dot(along)) continue;
    if ((v - joint - y * along).norm() < kFingerRadius) best = v;
  }
  return best;
}

}  // namespace palmar::hand
