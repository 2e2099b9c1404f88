// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/power/closing.h"
#include "palmar/grasp/power/grip_axis.h"

namespace palmar::grasp {

/// How a handle lies in a hand, as few numbers. The hand frame's z is palmar, y distal.
struct HandlePose {
  double turn = 0.0;  ///< of the product about the grip axis, towards the fingertips for a right
                      ///< hand, rad (0: `wide` faces the palm)
  double oblique = 0.25;  ///< of the grip axis against the line of the metacarpal heads, its ulnar
                          ///< end towards the wrist, rad; people use 10-25 degrees
  double tilt = 0.02;     ///< radial end out of the palm, rad
  double proximal = 12;   ///< of the grip axis from the metacarpal heads towards the wrist, mm
  double along = 0.0;     ///< shift of the hand along the product's axis, mm
};

/// Product and hand before fingers close: the product pressed into the palm.
struct Placement {
  HandlePose pose;
  geometry::Rigid3 product_from_hand;
  Vec3 axis_in_hand = Vec3::UnitX();   ///< grip axis, unit
  Vec3 push_in_hand = -Vec3::UnitZ();  ///< unit direction in which the product meets the palm
};

/// Puts a grip site into the hand and pushes it into the palm until the palm or a finger's base
/// reaches its limit (HandCloser::free_travel). `product` gives the distance; its transform is not
/// used. With the fingers open.
Placement place(const HandCloser& closer, const geometry::DistanceField& product,
                const DepthLimits& limits, const ClosingStyle& style, const GripSite& site,
                const HandlePose& pose);

/// Where a grip axis usually lies in a hand: a point of it and its direction towards the thumb.
struct PalmLine {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitX();
};
PalmLine palm_line(const hand::Hand& hand);

/// The pose that a grip has of itself on a site, whatever the product's details.
HandlePose usual_pose(const hand::Hand& hand, const ClosingStyle& style, const GripSite& site,
                      bool is_place_fixed);

/// One way of holding, closed on a sparse skin.
struct ClosedPose {
  std::size_t site = 0;
  ClosingStyle style;
  Placement placement;
  hand::Posture posture;
  HoldMeasure measure;
  double score = 0.0;  ///< mm^2 of palmar contact, plus credit for segments, wrap and an
                       ///< opposed thumb, minus clashes
  double rank = 0.0;   ///< score, less for sites that are less of a handle
};

struct PoseSearch {
  std::vector<ClosingStyle> styles = {ClosingStyle{}};  ///< tried at every site
  std::optional<double> turn;                           ///< only that turn (see HandlePose), rad
  bool is_place_fixed = false;                          ///< the hand isn't shifted along the axis
  int most = 200;                                       ///< placements to try
};

struct PosesFound {
  std::vector<ClosedPose>
      holds;      ///< thumb included; best first, each different from those before it
  int tried = 0;  ///< placements that were closed and scored
};

/// Searches for the holds that most palmar skin takes part in: what distinguishes a power grip
/// (Napier 1956). Coarse to fine, always in the same order: eight turns at every site, the best of
/// them improved one number after the other with shrinking steps, then the thumb. distances[k] is
/// the product's distance as seen near sites[k]; sites beyond distances.size() are not tried.
PosesFound find_poses(const HandCloser& closer,
                      const std::vector<const geometry::DistanceField*>& distances,
                      const std::vector<GripSite>& sites, const DepthLimits& limits,
                      const PoseSearch& search, const Progress& progress);

struct PoseKept {
  bool is_place_fixed = false;  ///< the usual pose isn't shifted along the axis
  bool may_adapt = true;        ///< the best of a few poses near it is taken
};

/// The way of holding that another hand found at a site, for this one: its pose differs from the
/// usual pose as that hand's does (lengths in hand lengths), fingers start as far abducted.
/// `tried` counts the placements that were closed.
ClosedPose pose_like(const HandCloser& closer, const geometry::DistanceField& product,
                     const GripSite& site, const DepthLimits& limits, const hand::Hand& other,
                     const ClosedPose& of_other, const PoseKept& kept, int& tried,
                     const Progress& progress);

/// Whether two ways of holding differ by more than 30 degrees or 20 mm.
bool differ(const hand::Hand& hand, const geometry::Rigid3& product_from_hand,
            const geometry::Rigid3& other);

/// Limits that a product (its wall, if hollow) can take: skin must not come out on the other side,
/// nor meet skin from there.
DepthLimits limits_for(const DepthLimits& asked, const GripSite& site);

}  // namespace palmar::grasp
