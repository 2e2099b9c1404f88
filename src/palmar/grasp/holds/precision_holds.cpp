// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/precision_holds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "palmar/grasp/holds/hold_candidates.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/power/grip_choice.h"
#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/grasp/precision/ring_targets.h"
#include "palmar/product/parts/part_spread.h"

namespace palmar::grasp {
namespace {

// How much rarer a precision grip is than the best for such a thing: choices, in the order in which
// Feix et al. 2016 name the grips' usual objects.
struct GripPrior {
  Grip grip;
  double score;
};

constexpr double kSmallThing = 0.45;  // hand lengths: longer things aren't taken by fingertips
constexpr double kTinyThing = 0.12;   // hand lengths: only two fingers find room on it
constexpr double kFlatThing = 0.4;    // thickness over width: a key, a card
constexpr double kStem = 14.0;        // mm; thicker bars are for the whole hand
constexpr double kSmallKnob = 0.25;   // hand lengths: fingertips rather than the palm
constexpr double kThinPlate = 30.0;   // mm
// Of hand length: how far in from the edge of a plate pads like to be, their own phalanges' length
// (thumb and fingers lie flat on it); farther in the web of the thumb comes up to the edge. Choice.
constexpr double kInFromEdge = 0.16;
constexpr double kEdgeSpread = 15.0;  // mm; choice
constexpr int kOutlineSides = 16;

// Largest first, mm. Of a single part its own: principal axes of a cube are chance.
Vec3 sorted_extents(const HoldScene& scene) {
  const std::vector<product::ProductPart>& parts = scene.parts->parts;
  const product::ProductPart& only = parts.front();
  Vec3 extents = parts.size() > 1 ? body_shape(scene.product->mesh).extent
                                  : Vec3(only.length, only.width, only.thickness);
  std::sort(extents.begin(), extents.end(), std::greater<>());
  return extents;
}

std::vector<GripPrior> priors(const HoldScene& scene, const product::ProductPart& part,
                              const Vec3& extents) {
  const double length = scene.hand->dimensions.hand_length;
  using enum Grip;
  if (part.kind == product::PartKind::kPen) return {{kTripod, 0.0}, {kPalmarPinch, -1.5}};
  if (extents[0] < kSmallThing * length) {
    if (extents[0] < kTinyThing * length) return {{kTipPinch, -0.3}, {kPalmarPinch, -0.5}};
    const bool is_box =
        scene.parts->parts.size() == 1 && product::face_axes_of(scene.product->mesh).is_box();
    // Fingertips spread round what is round; on a box they press on two faces.
    if (is_box && extents[2] >= kFlatThing * extents[1]) {
      return {{kTripod, -0.4}, {kPalmarPinch, -0.8}, {kPrecisionSphere, -1.0}};
    }
    if (extents[2] < kFlatThing * extents[1]) return {{kLateral, -0.2}, {kPalmarPinch, -0.6}};
    return {{kPrecisionSphere, -0.4}, {kTripod, -0.6}, {kPalmarPinch, -1.2}};
  }
  if (part.kind == product::PartKind::kPlate && part.thickness < kThinPlate) {
    // Who can span it takes it into the palm.
    const double spanned = part.width < kHandSpan * length ? 1.0 : 0.0;
    return {{kPalmarPinch, -1.5 - spanned}, {kLateral, -1.7 - spanned}};
  }
  return {};
}

// How far in from the edge of a plate a point is (of its convex outline), mm.
// Directions are counted from the plate's axis, so that they turn and mirror with it.
double depth_from_edge(const geometry::TriangleMesh& mesh, const Vec3& normal, const Vec3& axis,
                       const Vec3& point) {
  const Vec3 u = (axis - normal * normal.dot(axis)).normalized(), v = normal.cross(u);
  double least = 1e300;
  for (int k = 0; k < kOutlineSides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kOutlineSides;
    const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
    double farthest = 0.0;
    for (const Vec3& p : mesh.vertices) farthest = std::max(farthest, out.dot(p - point));
    least = std::min(least, farthest);
  }
  return least;
}

RankedHold ranked_of(const HoldScene& scene, const Grasp& grasp, double prior) {
  RankedHold ranked;
  ranked.grasp = grasp;
  Hold& hold = ranked.hold;
  hold.grip = grasp.grip;
  Vec3 middle = Vec3::Zero();
  for (const FingertipContact& tip : grasp.fingertips) middle += tip.target;
  middle /= static_cast<double>(grasp.fingertips.size());
  hold.part = scene.parts->nearest(*scene.product, middle) + 1;
  const product::ProductPart& part = scene.parts->parts[hold.part - 1];
  hold.part_name = part.name;
  hold.along = std::clamp(product::place_of(part, middle).along, 0.0, 1.0);
  for (const FingertipContact& tip : grasp.fingertips) {
    hold.fingertips.push_back({tip.finger, product::place_of(part, tip.target)});
  }
  ranked.terms.push_back({"grip", 0.0, "", prior,
                          prior < -0.5 ? "seldom taken by the fingertips" : "taken by fingertips"});
  const bool is_passed_over = scene.has_handle && scene.is_handle[hold.part - 1] == 0;
  if (is_passed_over) {
    ranked.terms.push_back({"handle", 0.0, "", std::log(0.1), "beside the handle"});
  }
  const double lever = (scene.gravity_centre - middle).norm();
  constexpr double kMoment = 150.0;  // N mm that fingertips begin to avoid; choice
  const double ratio = scene.weight * lever / kMoment;
  // Klein et al. 2020 (PLoS Comput Biol 16:e1008081): precision grips lie near the centre of mass.
  ranked.terms.push_back({"moment of the weight", scene.weight * lever, "N mm",
                          -0.5 * std::log1p(ratio * ratio),
                          fmt::format("its weight is {:.0f} mm beside the grip", lever)});
  if (part.kind == product::PartKind::kPlate && part.face_normal) {
    const double depth =
        depth_from_edge(scene.product->mesh, *part.face_normal, part.line.front().axis, middle);
    const double usual = kInFromEdge * scene.hand->dimensions.hand_length;
    const double z = std::max(0.0, depth - usual) / kEdgeSpread;
    ranked.terms.push_back({"reach over the edge", depth, "mm", -0.5 * std::min(z * z, 4.0),
                            fmt::format("its pads are {:.0f} mm in from the edge", depth)});
  }
  const double held = grasp.status == GraspStatus::kHeld         ? 0.0
                      : grasp.status == GraspStatus::kPartlyHeld ? -3.0
                                                                 : -8.0;
  ranked.terms.push_back({"closing", 0.0, "", held, grasp.message});
  return ranked;
}

}  // namespace

std::vector<RankedHold> precision_holds(const HoldScene& scene, const HoldOptions& options,
                                        const Progress& progress) {
  std::vector<RankedHold> found;
  if (scene.parts->parts.empty() || options.is_power_only ||
      (options.grip && (is_power(*options.grip) || is_non_prehensile(*options.grip))))
    return found;
  const std::optional<ScissorRings> rings = scissor_rings(*scene.parts, *scene.product);
  std::vector<GripPrior> grips;
  if (options.grip) {
    grips.push_back({*options.grip, 0.0});
  } else {
    // What has a handle is taken there.
    const bool is_passed_over = scene.has_handle && scene.is_handle[0] == 0;
    if (!is_passed_over) {
      grips = priors(scene, scene.parts->parts.front(), sorted_extents(scene));
    }
    // What two rings are for (Feix et al. 2016, grip 19).
    if (rings) grips.insert(grips.begin(), {Grip::kDistalType, 0.0});
  }
  const auto try_grips = [&](const std::vector<GripPrior>& list, std::optional<Vec3> at) {
    for (const GripPrior& tried : list) {
      progress.throw_if_cancelled();
      PrecisionGripOptions precision;
      precision.grip = tried.grip;
      precision.placement.at = at;
      if (tried.grip == Grip::kDistalType && rings) {
        precision.targets = ring_targets(*scene.hand, *scene.product, *rings);
      }
      const Grasp grasp = close_precision_grip(*scene.hand, *scene.product, precision, progress);
      if (grasp.fingertips.empty()) continue;
      RankedHold ranked = ranked_of(scene, grasp, tried.score);
      if (is_part_asked(scene.parts->parts[ranked.hold.part - 1], options)) {
        found.push_back(std::move(ranked));
      }
    }
  };
  const product::ProductPart& largest = scene.parts->parts.front();
  const bool is_wide_plate = !options.grip && largest.kind == product::PartKind::kPlate &&
                             largest.thickness < kThinPlate &&
                             largest.width >= kHandSpan * scene.hand->dimensions.hand_length;
  if (is_wide_plate) {
    // What the hand doesn't span is taken by an edge: at either end of its longer axis.
    const double in = kInFromEdge * scene.hand->dimensions.hand_length / largest.length;
    for (const double along : {in, 1.0 - in}) {
      try_grips(grips, product::part_frame(largest, along, 0.0).translation);
    }
  } else {
    try_grips(grips, {});
  }
  if (options.grip || scene.parts->parts.size() < 2) return found;
  // A small knob on something larger; the stem of what has no handle.
  const double length = scene.hand->dimensions.hand_length;
  for (const product::ProductPart& part : scene.parts->parts) {
    const bool is_small = std::max(part.length, part.width) < kSmallKnob * length;
    const Vec3 middle = product::part_frame(part, 0.5, 0.0).translation;
    if (part.kind == product::PartKind::kBar && !scene.has_handle && part.diameter() < kStem) {
      try_grips({{Grip::kTripod, -0.5}, {Grip::kPalmarPinch, -0.8}}, middle);
    }
    if (!is_small || part.kind == product::PartKind::kPlate ||
        part.kind == product::PartKind::kLoop || scene.is_handle[part.number - 1] == 0) {
      continue;
    }
    try_grips({{Grip::kPrecisionSphere, -0.3}, {Grip::kTripod, -0.3}}, middle);
  }
  return found;
}

}  // namespace palmar::grasp
