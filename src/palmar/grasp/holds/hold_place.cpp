// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_place.h"

#include <numbers>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/power/grasp_verdict.h"
#include "palmar/grasp/power/site_distance.h"

namespace palmar::grasp {
namespace {

// How far the knuckles are bent round a handle that fingers reach through, rad; plain sense: the
// thumb comes to lie on top of it. Choice.
constexpr double kLoopMcp = 50.0 * geometry::kDegree;

}  // namespace

GraspedSurface grasped_surface_near(const Hold& hold, const product::ProductParts& parts,
                                    const product::Product& product, const HoldSite& at,
                                    const hand::Hand& hand) {
  GraspedSurface surface;
  const std::shared_ptr<const geometry::DistanceField> exact =
      grasped_surface(hold, parts, product);
  GripSite site = at.site;
  site.wide = at.palm;  // which of a round bar's directions is the wide one is chance
  site.wall = wall_at(product.mesh, *exact, site, hand.dimensions.hand_width);
  surface.wall = site.wall;
  surface.quick = distance_near(product.mesh, exact, site);
  surface.whole = product.distance;
  return surface;
}

PowerPlace place_of_hold(const HoldSite& at, Grip grip, const GraspedSurface& surface,
                         const HandCloser& coarse, const PowerGraspOptions& options,
                         const Progress& progress) {
  PowerPlace result;
  Grasp& grasp = result.grasp;
  const hand::Hand& hand = coarse.hand();
  grasp.grip = grip;
  grasp.posture = hand::reference_posture(hand.skeleton);
  for (int s = 0; s < hand::kSegmentCount; ++s)
    grasp.stops[s].segment = static_cast<hand::Segment>(s);
  result.site = at.site;
  result.site.wall = surface.wall;
  result.quick = surface.quick;
  result.may_shift = false;
  grasp.grip_point = at.site.point;
  grasp.grip_axis = at.site.axis;
  grasp.grip_girth = at.site.girth;
  const DepthLimits asked{options.palm_limit_depth, options.finger_limit_depth};
  if (is_out_of_reach(result.site, options, grasp)) {
    // The open hand is shown with the product on the palm.
    constexpr double kShownDepth = 0.05;  // mm into the palm of what is only placed on it
    grasp.posture = coarse.open_posture();
    HandlePose pose;
    pose.turn = at.turn;
    grasp.product_from_hand =
        place(coarse, *surface.quick, {kShownDepth, kShownDepth}, {}, result.site, pose)
            .product_from_hand;
    return result;
  }
  PoseSearch search;
  search.styles = styles_for(grip, at.site.girth / std::numbers::pi, hand.dimensions.hand_length);
  if (at.is_loop) {
    // People rest the thumb on top of a handle that their fingers reach through.
    for (ClosingStyle& style : search.styles) {
      if (!style.hook) continue;
      style.hook = kLoopMcp;
      style.has_thumb = true;
    }
    result.whole = surface.whole;
  }
  search.turn = at.turn;
  search.is_place_fixed = true;
  search.most = static_cast<int>(search.styles.size());
  PosesFound found =
      find_poses(coarse, {surface.quick.get()}, {result.site}, asked, search, progress);
  grasp.candidates = found.tried;
  result.pose = std::move(found.holds.front());
  if (at.is_loop) {
    // The fingers closed on the loop alone: whether what is behind it leaves them room.
    ClosedPose& pose = result.pose;
    const HeldProduct held{surface.whole.get(), pose.placement.product_from_hand, at.site.point,
                           at.site.axis, at.site.girth / std::numbers::pi};
    const HoldMeasure whole =
        coarse.measure(held, asked, pose.posture, pose.placement.axis_in_hand);
    result.pose.measure.other_area = whole.other_area;
    result.pose.measure.deepest_other = whole.deepest_other;
  }
  grasp.score = result.pose.rank;
  grasp.posture = result.pose.posture;
  grasp.product_from_hand = result.pose.placement.product_from_hand;
  result.is_found = true;
  return result;
}

}  // namespace palmar::grasp
