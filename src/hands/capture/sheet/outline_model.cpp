// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/outline_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/line_fit.h"
#include "hands/capture/sheet/silhouette.h"
#include "palmar/core/enum_index.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/dimensions/hand_sections.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/posture/skeleton_in_posture.h"
#include "palmar/hand/posture/table_posture.h"
#include "palmar/hand/skin/creases.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::capture {
namespace {

constexpr std::array<std::array<hand::Segment, 3>, 5> kChain = {
    {{hand::Segment::kThumbProximal, hand::Segment::kThumbDistal, hand::Segment::kThumbDistal},
     {hand::Segment::kIndexProximal, hand::Segment::kIndexMiddle, hand::Segment::kIndexDistal},
     {hand::Segment::kMiddleProximal, hand::Segment::kMiddleMiddle, hand::Segment::kMiddleDistal},
     {hand::Segment::kRingProximal, hand::Segment::kRingMiddle, hand::Segment::kRingDistal},
     {hand::Segment::kLittleProximal, hand::Segment::kLittleMiddle, hand::Segment::kLittleDistal}}};

constexpr std::array<hand::Dof, 4> kAbduction = {
    hand::Dof::kIndexMcpAbduction, hand::Dof::kMiddleMcpAbduction, hand::Dof::kRingMcpAbduction,
    hand::Dof::kLittleMcpAbduction};

/// Angle from one direction to another, anticlockwise.
double angle_between(const Vec2& from, const Vec2& to) {
  return std::atan2(cross2(from, to), from.dot(to));
}

/// +1 if positive abduction turns a finger of the placed hand anticlockwise: towards a thumb that
/// lies to the left of fingers that point up.
double anticlockwise(hand::Side side, bool palm_up) {
  return (side == hand::Side::kRight) != palm_up ? 1.0 : -1.0;
}

/// Palm (or back) down.
Vec3 down(const Vec3& p, bool palm_up) { return palm_up ? p : Vec3(-p.x(), p.y(), -p.z()); }

/// Takes off what reaches beyond the grid's edges, but for the forearm: a model on its way to the
/// photographed hand's place may.
void hold_inside(imaging::VoxelMask& mask, const SheetGrid& grid, const Vec2& wrist) {
  constexpr double kForearm = 60.0;  // mm
  const auto clear = [&](int x, int y) {
    if ((grid.sheet(x, y) - wrist).norm() > kForearm) mask[grid.at(x, y)] = 0;
  };
  for (int x = 0; x < grid.width; ++x) {
    clear(x, 0);
    clear(x, grid.height - 1);
  }
  for (int y = 0; y < grid.height; ++y) {
    clear(0, y);
    clear(grid.width - 1, y);
  }
}

}  // namespace

hand::HandDimensions straight_dimensions(const hand::Hand& hand) {
  const hand::Posture reference = hand::reference_posture(hand.skeleton);
  hand::Posture straight = *hand::named_posture(hand.skeleton, "flat");
  for (const hand::Dof dof : {hand::Dof::kThumbCmcFlexion, hand::Dof::kThumbCmcAbduction,
                              hand::Dof::kThumbMpFlexion, hand::Dof::kThumbIpFlexion}) {
    straight[dof] = reference[dof];
  }
  return hand::measure_hand({hand::pose_skin(hand, straight), hand.skin.triangles},
                            hand::skeleton_in_posture(hand.skeleton, straight));
}

OutlineProportions outline_proportions(const hand::HandDimensions& d) {
  const auto of = [&](hand::Segment s) -> const auto& { return d.segment[index_of(s)]; };
  OutlineProportions p;
  for (std::size_t f = 0; f < 5; ++f) {
    double whole = 0.0;
    for (const hand::Segment s : kChain[f]) whole += of(s).length;
    for (std::size_t k = 0; k < 3; ++k) {
      p.segment[f][k] = of(kChain[f][k]).length / (f == 0 ? d.hand_length : whole);
    }
    p.finger_height[f] = 0.5 * of(kChain[f][2]).thickness / d.hand_length;
  }
  p.web_height = 0.5 * of(hand::Segment::kMiddleProximal).thickness / d.hand_length;
  p.palm_height = 0.5 * d.hand_thickness / d.hand_length;
  return p;
}

PlacedModel flat_model(const hand::Hand& hand, const HandOutline& like, bool palm_up) {
  PlacedModel model;
  model.posture = *hand::named_posture(hand.skeleton, "flat");
  model.posture = hand::posture_on_table(model.posture, [&](const hand::Posture& p) {
    const auto tips = hand::skeleton_in_posture(hand.skeleton, p).fingertips;
    return std::array{tips[0].z(), tips[1].z(), tips[2].z(), tips[3].z(), tips[4].z()};
  });
  model.place = like.wrist;
  const Vec3 wrist = hand::HandCreases(hand.skin, hand.skeleton).wrist().point;
  const Vec3 way = down(hand.skeleton.fingertips[index_of(hand::Finger::kMiddle)], palm_up) -
                   down(wrist, palm_up);
  model.turn = angle_between(way.head<2>(), like.finger[2].tip - like.wrist);
  return model;
}

geometry::TriangleMesh place_model(const hand::Hand& hand, const PlacedModel& model, bool palm_up) {
  geometry::TriangleMesh lying{hand::pose_skin(hand, model.posture), hand.skin.triangles};
  double paper = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < lying.vertices.size(); ++v) {
    lying.vertices[v] = down(lying.vertices[v], palm_up);
    const hand::Segment s = hand.segment[v];
    if (s == hand::Segment::kIndexDistal || s == hand::Segment::kMiddleDistal ||
        s == hand::Segment::kRingDistal || s == hand::Segment::kLittleDistal) {
      paper = std::min(paper, lying.vertices[v].z());
    }
  }
  const hand::HandCreases creases(hand.skin, hand.skeleton);
  const Vec3 wrist =
      down(hand::hand_sections(hand.skin, hand.skeleton, creases).wrist_middle, palm_up);
  const Eigen::Rotation2Dd about(model.turn);
  constexpr double kFlat = 0.3;  // mm
  for (Vec3& p : lying.vertices) {
    const Vec2 at = about * (p - wrist).head<2>() + model.place;
    p = {at.x(), at.y(), std::max(p.z() - paper, kFlat)};
  }
  return lying;
}

ModelOutline match_model(const hand::Hand& hand, const HandOutline& seen, const OutlineScene& scene,
                         const PlacedModel& start, int rounds) {
  const bool palm_up = scene.options.palm_up;
  const double sign = anticlockwise(hand.side, palm_up);
  ModelOutline result{start, {}, 0.0};
  for (int round = 0;; ++round) {
    imaging::VoxelMask mask =
        silhouette(place_model(hand, result.model, palm_up), scene.sheet.eye, scene.grid);
    hold_inside(mask, scene.grid, seen.wrist);
    result.outline =
        measure_outline(scene.grid, mask, scene.sheet, scene.proportions, "model", scene.options);
    std::array<double, 5> off{};
    result.direction_error = 0.0;
    for (std::size_t f = 0; f < 5; ++f) {
      off[f] = angle_between(result.outline.finger[f].direction, seen.finger[f].direction);
      if (f > 0) result.direction_error = std::max(result.direction_error, std::abs(off[f]));
    }
    if (round == rounds) return result;
    // The hand as the way from the wrist to the middle finger's tip; fingers against it.
    const double whole = angle_between(result.outline.finger[2].tip - result.outline.wrist,
                                       seen.finger[2].tip - seen.wrist);
    result.model.turn += whole;
    result.model.place += seen.wrist - result.outline.wrist;
    hand::Posture& posture = result.model.posture;
    const auto turn_by = [&](hand::Dof dof, double angle) {
      const hand::JointDof& range = hand.skeleton.dof(dof);
      posture[dof] = std::clamp(posture[dof] + angle, range.lower, range.upper);
    };
    for (std::size_t f = 1; f < 5; ++f) turn_by(kAbduction[f - 1], sign * (off[f] - whole));
    // Extension at its root turns the thumb away from the fingers.
    constexpr double kGain = 0.7;
    turn_by(hand::Dof::kThumbCmcFlexion, -kGain * sign * (off[0] - whole));
  }
}

}  // namespace palmar::capture
