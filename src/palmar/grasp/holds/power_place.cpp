// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/power_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/grasp/power/grasp_verdict.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/grasp/power/grip_choice.h"
#include "palmar/grasp/power/site_distance.h"

namespace palmar::grasp {
namespace {

constexpr double kFarPoint = 40.0;  // mm off the product; no hollow of a handle is wider
constexpr double kRival = 0.85;     // share of the best site's score from which one is tried too
constexpr int kSettleRounds = 6;    // product and fingers give way to each other in turn
constexpr std::size_t kTriedSites = 2;
constexpr double kMostSpread = 0.6;  // of the range of abduction, round a large ball
constexpr double kSmallBall = 0.3, kLargeBall = 0.65;  // hand lengths; none to most
constexpr double kShownDepth = 0.05;  // mm into the palm of what is only placed on it
constexpr int kGiveWaySteps = 4;
constexpr int kTrimRounds = 16;
constexpr double kTrimTolerance = 0.02;  // mm
constexpr double kTrimArm = 18.0;        // mm from a finger joint to the skin it presses
constexpr double kGridError = 1.0;       // mm; the quick distance is never that wrong
constexpr double kTouched = 0.5;  // mm; farther skin can't touch by the exact distance either

// Turn of `facing` from the site's wide direction, for a turn asked for in the product's own frame.
double turn_in_pose(const hand::Hand& hand, const GripSite& site, double asked) {
  // Zero: the coordinate axis that is most nearly perpendicular to the grip axis, made
  // perpendicular to it.
  int least = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::abs(site.axis[c]) < std::abs(site.axis[least]) - 1e-9) least = c;
  }
  Vec3 zero = Vec3::Unit(least);
  zero = (zero - site.axis * site.axis.dot(zero)).normalized();
  const Vec3 facing = Eigen::AngleAxisd(asked, site.axis) * zero;
  const Vec3 wide = (site.wide - site.axis * site.axis.dot(site.wide)).normalized();
  const double turn = std::atan2(site.axis.dot(wide.cross(facing)), wide.dot(facing));
  return hand.side == hand::Side::kRight ? turn : -turn;
}

// The quick distance is right to a few hundredths of a millimetre: what went too deep by the exact
// one is opened again at its own joint. How deep the palm stays, mm.
double trim(const HandCloser& closer, const HeldProduct& product, const DepthLimits& limits,
            hand::Posture& posture) {
  auto depth = closer.depths(product, posture);
  for (int round = 0; round < kTrimRounds; ++round) {
    bool is_changed = false;
    for (int s = 1; s < hand::kSegmentCount; ++s) {
      const auto segment = static_cast<hand::Segment>(s);
      const double excess = depth[s] - limits.finger;
      if (excess <= kTrimTolerance) continue;
      const hand::Joint& joint = closer.hand().skeleton.joint(hand::joint_of(segment));
      for (const hand::JointDof& dof : joint.dofs) {
        if (dof.dof == abduction_of(*hand::finger_of(segment))) continue;
        posture[dof.dof] = std::max(dof.lower, posture[dof.dof] - (excess + 0.01) / kTrimArm);
        is_changed = true;
      }
    }
    if (!is_changed) break;
    depth = closer.depths(product, posture);
  }
  return depth[0];
}

// Where to look, and the grip meant there.
struct Sites {
  std::vector<GripSite> sites;
  Grip grip = Grip::kMediumWrap;
};

// Middle of the surface that lies in a box, mm; nothing if none does.
std::optional<Vec3> middle_of(const geometry::TriangleMesh& mesh, const Box3& region) {
  Vec3 moment = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const Vec3 centre = (a + b + c) / 3.0;
    if (!region.contains(centre)) continue;
    const double weight = (b - a).cross(c - a).norm();
    moment += weight * centre;
    area += weight;
  }
  if (area <= 0.0) return {};
  return Vec3(moment / area);
}

Sites find_sites(const hand::Hand& hand, const product::Product& product,
                 const PowerGraspOptions& options) {
  Sites found;
  const PlacementRequest& asked = options.placement;
  GripSearchOptions search;
  search.hand_length = hand.dimensions.hand_length;
  search.palm_breadth = hand.dimensions.hand_width;
  search.at = asked.at;
  if (asked.axis) search.axis = asked.axis->normalized();
  if (asked.region) {
    search.near = middle_of(product.mesh, *asked.region);
    if (!search.near) {
      throw UsageError("placement: the region holds no part of the surface of " + product.name +
                       "; corners are in mm in the product's own frame");
    }
  }
  if (asked.product_from_hand) {
    const PalmLine line = palm_line(hand);
    search.near = *asked.product_from_hand * line.point;
    search.axis = (asked.product_from_hand->rotation * line.axis).normalized();
  }
  const bool is_free = !asked.at && !asked.axis && !asked.region && !asked.product_from_hand;
  const bool is_sphere_asked = options.grip == Grip::kPowerSphere;
  if (is_free && (is_sphere_asked || !options.grip)) {
    const BodyShape shape = body_shape(product.mesh);
    if (is_sphere_asked || is_ball_like(shape)) {
      found.grip = Grip::kPowerSphere;
      found.sites = ball_sites(product.mesh, shape);
      return found;
    }
  }
  found.grip = options.grip.value_or(Grip::kMediumWrap);
  found.sites = find_grip_sites(product.mesh, search);
  return found;
}

// A wrap is called by its size unless it was asked for by name.
Grip grip_of(Grip grip, const PowerGraspOptions& options, const GripSite& site,
             const hand::Hand& hand) {
  if (options.grip || grip == Grip::kPowerSphere) return grip;
  return wrap_for(site.girth, hand.dimensions.hand_length);
}

struct Distances {
  const geometry::DistanceField* quick;
  const geometry::DistanceField* exact;
};

// Closes the hand on all of its skin and by the exact distance. The product gives way where closing
// folds the palm further into it, if it may; at once, that takes fewer rounds.
HoldMeasure close_finely(const HandCloser& fine, const Distances& distances, const GripSite& site,
                         const DepthLimits& limits, const ClosedPose& hold, Placement& placement,
                         bool may_give_way, bool gives_way_at_once, const Progress& progress,
                         Grasp& grasp) {
  HeldProduct held{distances.quick, placement.product_from_hand,   site.point,
                   site.axis,       site.girth / std::numbers::pi, hold.style.has_thumb};
  // To trim, only skin that may be too deep is asked about exactly.
  const double deep = std::min(kTouched, kGridError - std::min(limits.palm, limits.finger));
  const auto exact_deep = exact_where_touched(*distances.quick, *distances.exact, deep);
  const auto exact = exact_where_touched(*distances.quick, *distances.exact, kTouched);
  const auto seen_by = [](HeldProduct seen, const geometry::DistanceField& field) {
    seen.distance = &field;
    return seen;
  };
  hand::Posture start = fine.start_posture(hold.style);
  for (int f = 1; f < hand::kFingerCount && may_give_way; ++f) {
    const hand::Dof dof = abduction_of(static_cast<hand::Finger>(f));
    start[dof] = hold.posture[dof];
  }
  for (int round = 0; round < kSettleRounds; ++round) {
    progress.throw_if_cancelled();
    grasp.posture = fine.close_fingers(held, limits, hold.style, start, 2, grasp.stops);
    if (hold.style.uses_thumb()) {
      grasp.posture = fine.close_thumb(held, limits, hold.style, grasp.posture, grasp.stops);
    }
    double excess = trim(fine, seen_by(held, *exact_deep), limits, grasp.posture) - limits.palm;
    if (excess <= kTrimTolerance || !may_give_way) break;
    // All the way with the fingers as they are, or a step before they close again.
    for (int step = 0; step < (gives_way_at_once ? kGiveWaySteps : 1) && excess > 0.0; ++step) {
      held.product_from_hand.translation +=
          held.product_from_hand.rotation * ((1.2 * excess + 0.02) * placement.push_in_hand);
      if (!gives_way_at_once) break;
      excess = fine.depths(seen_by(held, *exact_deep), grasp.posture)[0] - limits.palm;
    }
    if (round + 1 < kSettleRounds) continue;
    trim(fine, seen_by(held, *exact_deep), limits, grasp.posture);
  }
  placement.product_from_hand = held.product_from_hand;
  return fine.measure(seen_by(held, *exact), limits, grasp.posture, placement.axis_in_hand);
}

/// Nobody holds it: the hand is shown beside the product, touching nothing.
void place_beside(const hand::Hand& hand, const product::Product& product, Grasp& grasp) {
  const Box3 box = product.distance->bounding_box();
  const double beside = 0.5 * box.diagonal().norm() + 1.5 * hand.dimensions.hand_length;
  grasp.product_from_hand.translation = box.center() + Vec3(0.0, 0.0, -beside);
}

}  // namespace

Grasp no_place(const hand::Hand& hand, const product::Product& product) {
  Grasp grasp;
  for (int s = 0; s < hand::kSegmentCount; ++s)
    grasp.stops[s].segment = static_cast<hand::Segment>(s);
  grasp.posture = hand::reference_posture(hand.skeleton);
  grasp.status = GraspStatus::kNotGraspable;
  grasp.message = "no part of the product offers a hand a hold";
  place_beside(hand, product, grasp);
  return grasp;
}

std::vector<ClosingStyle> styles_for(Grip grip, double diameter, double hand_length) {
  if (grip == Grip::kPowerSphere) {
    // Round a ball smaller than the palm fingers stay together.
    const double share =
        std::clamp((diameter / hand_length - kSmallBall) / (kLargeBall - kSmallBall), 0.0, 1.0);
    return {ClosingStyle{.spread = kMostSpread * share, .hook = {}},
            ClosingStyle{.spread = 0.5 * kMostSpread * share, .hook = {}}};
  }
  if (grip == Grip::kFixedHook) return {ClosingStyle{.spread = 0.0, .hook = 0.0}};
  return {ClosingStyle{}};
}

PowerPlace find_power_place(const hand::Hand& hand, const product::Product& product,
                            const PowerGraspOptions& options, const Progress& progress) {
  PowerPlace result;
  Grasp& grasp = result.grasp;
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    grasp.stops[s].segment = static_cast<hand::Segment>(s);
  }
  grasp.posture = hand::reference_posture(hand.skeleton);
  progress.update(0.0, "finding a place to hold " + product.name);
  if (options.placement.at) {
    // A point of the grip's axis lies in the product, or in the hollow of a thin-walled one.
    const std::vector<Vec3> point = {*options.placement.at};
    std::vector<geometry::DistanceSample> sample(1);
    product.distance->sample(point, 1e6, sample);
    if (sample.front().distance > kFarPoint) {
      grasp.status = GraspStatus::kNotGraspable;
      grasp.message =
          fmt::format("the given point is {:.0f} mm off the product", sample.front().distance);
      place_beside(hand, product, grasp);
      return result;
    }
  }
  const Sites found = find_sites(hand, product, options);
  std::vector<GripSite> sites = found.sites;
  grasp.grip = found.grip;
  if (sites.empty()) {
    grasp.status = GraspStatus::kNotGraspable;
    grasp.message =
        options.placement.at || options.placement.region
            ? "nothing near the given point or region is bar-like enough for a power grip"
            : "no part of the product is bar-like enough for a power grip";
    place_beside(hand, product, grasp);
    return result;
  }

  grasp.grip_point = sites.front().point;
  grasp.grip_axis = sites.front().axis;
  grasp.grip_girth = sites.front().girth;
  if (is_out_of_reach(sites.front(), options, grasp)) {
    // The open hand is shown with the product on the palm.
    const HandCloser hint(hand, kSearchSpacing);
    const GripSite& site = sites.front();
    const DepthLimits least{kShownDepth, kShownDepth};
    const auto quick = distance_near(product.mesh, product.distance, site);
    grasp.posture = hint.open_posture();
    grasp.product_from_hand = place(hint, *quick, least, {}, site, {}).product_from_hand;
    return result;
  }

  progress.update(0.2, "trying ways to hold " + product.name);
  const DepthLimits asked{options.palm_limit_depth, options.finger_limit_depth};
  const HandCloser coarse(hand, kSearchSpacing);
  std::vector<std::shared_ptr<const geometry::DistanceField>> near;
  std::vector<const geometry::DistanceField*> distances;
  for (GripSite& candidate : sites) {
    if (near.size() == kTriedSites || candidate.score < kRival * sites.front().score) break;
    candidate.wall =
        wall_at(product.mesh, *product.distance, candidate, hand.dimensions.hand_width);
    near.push_back(distance_near(product.mesh, product.distance, candidate));
    distances.push_back(near.back().get());
  }
  PoseSearch search;
  search.styles =
      styles_for(grasp.grip, sites.front().girth / std::numbers::pi, hand.dimensions.hand_length);
  search.is_place_fixed = options.placement.at || options.placement.region;
  search.most = options.candidates;
  if (options.placement.turn)
    search.turn = turn_in_pose(hand, sites.front(), *options.placement.turn);
  ClosedPose hold;
  if (options.placement.product_from_hand) {
    hold.placement.product_from_hand = *options.placement.product_from_hand;
    const Quat back = hold.placement.product_from_hand.rotation.conjugate();
    hold.placement.axis_in_hand = back * sites.front().axis;
    hold.style = search.styles.front();
    grasp.candidates = 1;
  } else {
    PosesFound holds = find_poses(coarse, distances, sites, asked, search, progress);
    hold = holds.holds.front();
    grasp.candidates = holds.tried;
    for (std::size_t k = 1; k < holds.holds.size(); ++k) {
      const ClosedPose& other = holds.holds[k];
      grasp.runners_up.push_back({grip_of(found.grip, options, sites[other.site], hand),
                                  other.posture, other.placement.product_from_hand, other.rank});
    }
  }
  grasp.grip = grip_of(found.grip, options, sites[hold.site], hand);
  grasp.score = hold.rank;
  result.is_found = true;
  result.is_fixed = options.placement.product_from_hand.has_value();
  result.may_shift = !search.is_place_fixed;
  result.site = sites[hold.site];
  result.quick = near[hold.site];
  result.pose = std::move(hold);
  return result;
}

Grasp close_at(const PowerPlace& place_found, const HandCloser& fine,
               const product::Product& product, const PowerGraspOptions& options,
               const Progress& progress) {
  progress.update(0.6, "closing the hand round " + product.name);
  const GripSite& site = place_found.site;
  const ClosedPose& hold = place_found.pose;
  Grasp grasp = place_found.grasp;
  const DepthLimits limits =
      limits_for({options.palm_limit_depth, options.finger_limit_depth}, site);
  const geometry::DistanceField& quick = *place_found.quick;
  Placement placement = hold.placement;
  if (!place_found.is_fixed) {
    placement = place(fine, quick, limits, hold.style, site, hold.placement.pose);
  }
  HoldMeasure measure =
      close_finely(fine, {&quick, product.distance.get()}, site, limits, hold, placement,
                   !place_found.is_fixed, place_found.is_carried, progress, grasp);
  if (place_found.whole != nullptr) {
    const HeldProduct whole{place_found.whole.get(), placement.product_from_hand, site.point,
                            site.axis, site.girth / std::numbers::pi};
    fine.make_room(whole, limits, grasp.posture);
    if (hold.style.uses_thumb()) {
      grasp.posture = fine.close_thumb(whole, limits, hold.style, grasp.posture, grasp.stops);
    }
    measure = fine.measure(whole, limits, grasp.posture, placement.axis_in_hand);
  }
  grasp.product_from_hand = placement.product_from_hand;
  grasp.grip_axis = site.axis;
  grasp.grip_point = site.point + hold.placement.pose.along * site.axis;
  grasp.grip_girth = site.girth;
  finish_stops(measure, limits, grasp);
  judge_hold(fine.hand(), measure, site, grasp);
  return grasp;
}

PowerPlace carried_over(const PowerPlace& place_found, const hand::Hand& reference,
                        const HandCloser& coarse, const HoldSite* at,
                        const PowerGraspOptions& options, const Progress& progress) {
  PowerPlace result = place_found;
  result.grasp.runners_up.clear();
  result.is_carried = true;
  ClosedPose theirs = place_found.pose;
  if (at != nullptr) {
    result.site = at->site;
    result.site.wall = place_found.site.wall;
    theirs.placement.pose.turn = at->turn;
  }
  result.pose = pose_like(coarse, *place_found.quick, result.site,
                          {options.palm_limit_depth, options.finger_limit_depth}, reference, theirs,
                          {.is_place_fixed = !place_found.may_shift, .may_adapt = at == nullptr},
                          result.grasp.candidates, progress);
  result.grasp.score = result.pose.rank;
  if (!options.grip && result.grasp.grip != Grip::kPowerSphere) {
    result.grasp.grip = wrap_for(result.site.girth, coarse.hand().dimensions.hand_length);
  }
  return result;
}

}  // namespace palmar::grasp
