// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/template/joint_placement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/template/hand_frame.h"

namespace palmar::hand {
namespace {

/// Last two links of each digit: Buchholz in fractions of hand length, Buryanov in mm.
struct Links {
  double middle, distal;
};
constexpr std::array<Links, kFingerCount> kBuchholz = {
    {{0.196, 0.158}, {0.143, 0.097}, {0.170, 0.108}, {0.165, 0.107}, {0.117, 0.093}}};
constexpr std::array<Links, kFingerCount> kBuryanov = {{{31.57, 21.67 + 5.67},
                                                        {22.38, 15.82 + 3.84},
                                                        {26.33, 17.40 + 3.95},
                                                        {25.65, 17.30 + 3.95},
                                                        {18.11, 15.96 + 3.73}}};
constexpr double kBuchholzMetacarpal = 0.251, kBuryanovMetacarpal = 46.22;

double distal_share(const Links& links) { return links.distal / (links.middle + links.distal); }

Vec3& centre_of(HandAsset& asset, const std::string& name) {
  for (HandAsset::Frame& frame : asset.frames) {
    if (frame.name == name) return frame.asset_from_joint.translation;
  }
  throw InputError("hand asset: joint frame \"" + name + "\" is missing");
}

/// Axis-aligned box round a finger's section, seen from a point: lowest and highest coordinate
/// along two directions.
struct SectionBox {
  std::array<double, 2> lowest{}, highest{};
};

SectionBox box_round(const geometry::TriangleMesh& skin, const Vec3& point, const Vec3& along,
                     const std::array<Vec3, 2>& directions, const std::string& joint) {
  double nearest = std::numeric_limits<double>::max();
  SectionBox box;
  for (const geometry::SectionCurve& curve : geometry::plane_section(skin, point, along)) {
    const double d = (geometry::curve_centre(curve) - point).norm();
    if (d >= nearest) continue;
    nearest = d;
    for (std::size_t k = 0; k < 2; ++k) {
      box.lowest[k] = std::numeric_limits<double>::max();
      box.highest[k] = std::numeric_limits<double>::lowest();
      for (const Vec3& p : curve.point) {
        const double x = directions[k].dot(p - point);
        box.lowest[k] = std::min(box.lowest[k], x);
        box.highest[k] = std::max(box.highest[k], x);
      }
    }
  }
  if (nearest == std::numeric_limits<double>::max()) {
    throw InputError("hand asset: the plane across joint \"" + joint + "\" misses the skin");
  }
  return box;
}

/// Moves the joint between `before` and `tip` to its share of the way, as deep in the finger as it
/// was.
void slide(const geometry::TriangleMesh& skin, geometry::Rigid3& frame, const Vec3& before,
           const Vec3& tip, double distal_share, const std::string& joint) {
  const Vec3 old = frame.translation;
  const double proximal = (old - before).norm(), distal = (tip - old).norm();
  const double shift = distal - distal_share * (proximal + distal);
  const Vec3 forwards = shift > 0 ? (tip - old).normalized() : (old - before).normalized();
  const Vec3 moved = old + shift * forwards;
  const Vec3 along = ((old - before).normalized() + (tip - old).normalized()).normalized();
  const Vec3 lateral = frame.rotation * Vec3::UnitX();
  const Vec3 across = (lateral - lateral.dot(along) * along).normalized();
  const std::array<Vec3, 2> directions = {across, along.cross(across)};
  const SectionBox was = box_round(skin, old, along, directions, joint);
  const SectionBox is = box_round(skin, moved, along, directions, joint);
  frame.translation = moved;
  for (std::size_t k = 0; k < 2; ++k) {
    const double share = -was.lowest[k] / (was.highest[k] - was.lowest[k]);
    frame.translation += (is.lowest[k] + share * (is.highest[k] - is.lowest[k])) * directions[k];
  }
}

}  // namespace

double published_distal_share(Finger finger) {
  return 0.5 *
         (distal_share(kBuchholz[index_of(finger)]) + distal_share(kBuryanov[index_of(finger)]));
}

double published_thumb_metacarpal() {
  return 0.5 * (kBuchholzMetacarpal / (kBuchholz[0].middle + kBuchholz[0].distal) +
                kBuryanovMetacarpal / (kBuryanov[0].middle + kBuryanov[0].distal));
}

HandAsset with_published_links(const HandAsset& asset_in_hand) {
  HandAsset asset = asset_in_hand;
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const bool is_thumb = finger == Finger::kThumb;
    const std::string before =
        frame_name(finger, is_thumb ? "phalanx-proximal" : "phalanx-intermediate");
    const std::string joint = frame_name(finger, "phalanx-distal");
    geometry::Rigid3 frame = frame_named(asset, joint);
    slide(asset.skin, frame, frame_named(asset, before).translation, fingertip(asset, finger),
          published_distal_share(finger), joint);
    centre_of(asset, joint) = frame.translation;
  }
  const Vec3 mp = frame_named(asset, "thumb-phalanx-proximal").translation;
  const Vec3 ip = frame_named(asset, "thumb-phalanx-distal").translation;
  const double rest = (ip - mp).norm() + (fingertip(asset, Finger::kThumb) - ip).norm();
  Vec3& cmc = centre_of(asset, "thumb-metacarpal");
  cmc = mp + published_thumb_metacarpal() * rest * (cmc - mp).normalized();
  return asset;
}

}  // namespace palmar::hand
