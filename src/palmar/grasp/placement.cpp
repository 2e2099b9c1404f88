// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palmar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kThinShare = 0.8;        // of half the thickness may be filled with skin
constexpr double kSegmentCredit = 120.0;  // mm^2 of contact that one more touching phalanx is worth
constexpr double kWrapCredit = 800.0;     // mm^2 for reaching all the way round
constexpr double kClash = 3.0;            // mm^2 per mm^2 of skin outside the palm in the product
constexpr double kNoseCredit = 3000.0;    // mm^2 for a working end that points away from the wrist
constexpr double kStrainCost = 5.0;       // mm^2 per degree
// Leaving the usual lay costs the square of how far, in these units, times kLeaveCost: small
// changes of a product then change its grasp a little, not from one lay to another.
constexpr double kLeaveCost = 2500.0;  // mm^2
constexpr double kProximalUnit = 6.0;  // mm
constexpr double kAlongUnit = 12.0;    // mm
constexpr double kMostAlong = 15.0;    // mm from the site along its axis
constexpr double kSlantUnit = 6.0 * kDeg;
constexpr double kStart =
    140.0;  // mm between palm and section before the push: room for what sticks out
constexpr double kLeastProximal = 10.0;  // mm from the knuckles: nearer, the thumb can't reach over
// A slab is held by its edges with the palm behind it, if the hand spans it: as one holds a phone.
constexpr double kFlat = 0.35;          // thickness / width up to which a section is a slab
constexpr double kSpan = 0.55;          // hand lengths between its edges that a hand spans
constexpr double kFlatCredit = 2500.0;  // mm^2 for its face in the palm
constexpr double kThumbRoom = 60.0;     // mm of product beside the grip's middle for the thumb
constexpr double kAlike = 0.005;        // share of the score within which holds are the same
constexpr int kTurns = 8;

// Axes of the palm: across towards the thumb along the metacarpal heads, distal, palmar.
struct PalmFrame {
  Vec3 heads, across, distal, palmar;
};

PalmFrame palm_frame(const Skeleton& skeleton) {
  PalmFrame frame;
  const Vec3 index = skeleton.joint(JointId::kIndexMcp).centre;
  const Vec3 little = skeleton.joint(JointId::kLittleMcp).centre;
  frame.heads =
      0.5 * (skeleton.joint(JointId::kMiddleMcp).centre + skeleton.joint(JointId::kRingMcp).centre);
  frame.palmar = Vec3::UnitZ();
  frame.across = index - little;
  frame.across.z() = 0.0;
  frame.across.normalize();
  frame.distal = (Vec3::UnitY() - frame.across * frame.across.y()).normalized();
  return frame;
}

// How far fingers stray from what hands do of themselves, degrees in all: knuckles of neighbours
// bend alike (within 25-30 degrees at most) and DIP follows PIP at two thirds, within 15 degrees
// (Rijkpema & Girard 1991).
double strain_of(const Posture& posture) {
  double strain = 0.0;
  for (int f = 1; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const double mcp = posture[flexion_of(finger, 0)], pip = posture[flexion_of(finger, 1)],
                 dip = posture[flexion_of(finger, 2)];
    strain += std::max(0.0, std::abs(dip - 2.0 / 3.0 * pip) / kDeg - 15.0);
    if (f == 1) continue;
    const double before = posture[flexion_of(static_cast<Finger>(f - 1), 0)];
    strain += 2.0 * std::max(0.0, std::abs(mcp - before) / kDeg - 15.0);
  }
  return strain;
}

// A short product moves towards the little finger, so that the thumb meets it and not its rim.
Lay usual_lay(const GripSite& site, bool is_place_fixed) {
  Lay lay;
  if (!is_place_fixed) lay.along = std::clamp(site.ahead - kThumbRoom, -kMostAlong, 0.0);
  return lay;
}

double leave_cost(const Lay& lay, const Lay& usual) {
  const auto square = [](double x) { return x * x; };
  return kLeaveCost * (square((lay.oblique - usual.oblique) / kSlantUnit) +
                       square((lay.tilt - usual.tilt) / kSlantUnit) +
                       square((lay.proximal - usual.proximal) / kProximalUnit) +
                       square((lay.along - usual.along) / kAlongUnit));
}

double score_of(const HoldMeasure& measure, const GripSite& site, const Placement& placement,
                const Lay& usual, double hand_length, const Posture& posture) {
  double score = measure.contact_area + kSegmentCredit * measure.touching +
                 kWrapCredit * measure.wrap - kClash * measure.other_area -
                 200.0 * std::max(0.0, measure.deepest_other - 2.0) -
                 kStrainCost * strain_of(posture) - leave_cost(placement.lay, usual);
  if (site.thickness < kFlat * site.width && site.width < kSpan * hand_length) {
    const Vec3 palm = placement.product_from_hand.rotation * placement.push_in_hand;
    score += kFlatCredit * std::abs(palm.dot(site.axis.cross(site.wide).normalized()));
  }
  if (site.nose) {
    const Vec3 nose = placement.product_from_hand.rotation.conjugate() * *site.nose;
    score += kNoseCredit * nose.dot(Vec3(0.0, 1.0, 1.0).normalized());
  }
  return score;
}

Hold try_hold(const HandCloser& closer, const DistanceField& product, const GripSite& site,
              std::size_t site_index, const DepthLimits& limits, const Lay& lay, const Lay& usual) {
  Hold hold;
  hold.site = site_index;
  hold.placement = place(closer, product, limits, site, lay);
  const HeldProduct held{&product, hold.placement.product_from_hand, site.point, site.axis,
                         site.girth / std::numbers::pi};
  std::array<SegmentStop, kSegmentCount> stops;
  hold.posture = closer.close_fingers(held, limits, closer.open_posture(), stops);
  hold.measure = closer.measure(held, hold.posture, hold.placement.axis_in_hand);
  hold.score = score_of(hold.measure, site, hold.placement, usual,
                        closer.hand().dimensions.hand_length, hold.posture);
  return hold;
}

}  // namespace

DepthLimits limits_for(const DepthLimits& asked, const GripSite& site) {
  const double thickness = std::min(site.thickness, site.wall);
  const double most = kThinShare * 0.5 * thickness;
  return {std::min(asked.palm, most), std::min(asked.finger, most)};
}

Placement place(const HandCloser& closer, const DistanceField& product, const DepthLimits& limits,
                const GripSite& site, const Lay& lay) {
  const PalmFrame palm = palm_frame(closer.hand().skeleton);
  Vec3 axis = std::cos(lay.oblique) * palm.across + std::sin(lay.oblique) * palm.distal;
  axis = std::cos(lay.tilt) * axis + std::sin(lay.tilt) * palm.palmar;
  const Vec3 outward = (palm.palmar - axis * axis.dot(palm.palmar)).normalized();

  Eigen::Matrix3d in_hand;  // grip axis, towards the palm, third
  in_hand << axis, -outward, axis.cross(-outward);
  const Vec3 wide = (site.wide - site.axis * site.axis.dot(site.wide)).normalized();
  const Vec3 facing = Eigen::AngleAxisd(lay.turn, site.axis) * wide;
  Eigen::Matrix3d in_product;
  in_product << site.axis, facing, site.axis.cross(facing);

  Placement placement;
  placement.lay = lay;
  placement.axis_in_hand = axis;
  placement.push_in_hand = -outward;
  placement.product_from_hand.rotation = Quat(in_product * in_hand.transpose()).normalized();
  const double reach = kStart + 0.5 * site.width;
  const Vec3 start = palm.heads - lay.proximal * palm.distal + reach * outward;
  const Vec3 grip = site.point + lay.along * site.axis;
  placement.product_from_hand.translation = grip - placement.product_from_hand.rotation * start;
  const HeldProduct held{&product, placement.product_from_hand, site.point, site.axis,
                         site.girth / std::numbers::pi};
  const double travel =
      closer.free_travel(held, limits, closer.open_posture(), placement.push_in_hand, 2.0 * reach);
  placement.product_from_hand.translation -=
      placement.product_from_hand.rotation * (travel * placement.push_in_hand);
  return placement;
}

std::optional<Hold> find_hold(const HandCloser& closer,
                              const std::vector<const DistanceField*>& distances,
                              const std::vector<GripSite>& sites, const DepthLimits& limits,
                              std::optional<double> turn, bool is_place_fixed,
                              const Progress& progress) {
  struct Rated {
    Hold hold;
    double rank = 0.0;
  };
  std::vector<Rated> tried;
  const double best_site = sites.empty() ? 1.0 : sites.front().score;
  const auto rank_of = [&](const Hold& hold) {
    // A part that is less of a handle must hold much better to be preferred.
    const double share = sites[hold.site].score / best_site;
    return hold.score * (hold.score > 0.0 ? std::pow(share, 4) : 1.0);
  };
  for (std::size_t s = 0; s < distances.size(); ++s) {
    const DepthLimits here = limits_for(limits, sites[s]);
    for (int k = 0; k < (turn ? 1 : kTurns); ++k) {
      progress.throw_if_cancelled();
      const Lay usual = usual_lay(sites[s], is_place_fixed);
      Lay lay = usual;
      lay.turn = turn ? *turn : 2.0 * std::numbers::pi * k / kTurns;
      const Hold hold = try_hold(closer, *distances[s], sites[s], s, here, lay, usual);
      tried.push_back({hold, rank_of(hold)});
    }
  }
  if (tried.empty()) return {};
  std::stable_sort(tried.begin(), tried.end(),
                   [](const Rated& a, const Rated& b) { return a.rank > b.rank; });
  // A finer look at the two best: one number after the other.
  std::optional<Rated> best;
  for (std::size_t k = 0; k < std::min<std::size_t>(tried.size(), 2); ++k) {
    Rated current = tried[k];
    // Round handles lie alike whichever way they are turned.
    if (k > 0 && current.hold.site == tried[0].hold.site &&
        current.rank > (1.0 - kAlike) * tried[0].rank) {
      break;
    }
    const GripSite& site = sites[current.hold.site];
    const DepthLimits here = limits_for(limits, site);
    const Lay usual = usual_lay(site, is_place_fixed);
    const auto improve = [&](double Lay::*what, double low, double high,
                             std::initializer_list<double> steps) {
      const Lay from = current.hold.placement.lay;
      for (const double step : steps) {
        progress.throw_if_cancelled();
        Lay lay = from;
        lay.*what += step;
        if (lay.*what < low || lay.*what > high) continue;
        const Hold hold = try_hold(closer, *distances[current.hold.site], site, current.hold.site,
                                   here, lay, usual);
        if (rank_of(hold) > current.rank) current = {hold, rank_of(hold)};
      }
    };
    improve(&Lay::proximal, kLeastProximal, 45.0, {6.0, 12.0, 20.0});
    improve(&Lay::tilt, -15 * kDeg, 15 * kDeg, {-6 * kDeg, 6 * kDeg});
    improve(&Lay::oblique, 4 * kDeg, 26 * kDeg, {-6 * kDeg, 6 * kDeg});
    if (!is_place_fixed) improve(&Lay::along, -kMostAlong, kMostAlong, {-8.0, 8.0});
    if (!turn) improve(&Lay::turn, -100.0, 100.0, {-15 * kDeg, 15 * kDeg});
    improve(&Lay::proximal, kLeastProximal, 45.0, {-4.0, 4.0});
    if (!best || current.rank > best->rank) best = current;
  }
  return best->hold;
}

}  // namespace palmar
