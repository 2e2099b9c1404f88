// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/geometry/degrees.h"

namespace palmar::grasp {
namespace {

constexpr double kThinBoxShare = 0.8;     // of half the thickness may be filled with skin
constexpr double kSegmentCredit = 120.0;  // mm^2 of contact that one more touching phalanx is worth
constexpr double kOpposedCredit = 2.0;    // per mm^2 of the thumb against the fingers
constexpr double kWrapCredit = 800.0;     // mm^2 for reaching all the way round
constexpr double kClash = 3.0;            // mm^2 per mm^2 of skin outside the palm in the product
constexpr double kNoseCredit = 3000.0;    // mm^2 for a working end that points away from the wrist
constexpr double kStrainCost = 5.0;       // mm^2 per degree
// Leaving the usual pose costs the square of how far, in these units, times kLeaveCost: small
// changes of a product then change its grasp a little, not from one pose to another.
constexpr double kLeaveCost = 400.0;   // mm^2
constexpr double kProximalUnit = 6.0;  // mm
constexpr double kAlongUnit = 16.0;    // mm
constexpr double kMostAlong = 24.0;    // mm from the site along its axis
constexpr double kSlantUnit = 6.0 * geometry::kDegree;
constexpr double kStart =
    140.0;  // mm between palm and section before the push: room for what sticks out
constexpr double kUsualProximal = 0.074;  // hand lengths from the knuckles to the grip axis
constexpr double kPalmToAxis = 30.0;      // mm from the bones of the palm to an ordinary grip axis
constexpr double kThinTilt = 0.13;        // rad more out of the palm ...
constexpr double kThin = 0.13,
                 kThick = 0.165;        // ... from the one diameter / hand length to the other
constexpr double kLeastProximal = 8.0;  // mm from the knuckles: nearer, the thumb can't reach over
constexpr double kMostProximal = 45.0;  // mm
// mm towards the fingers, for the thumb; less deep than may be, as the skin looked at is sparse.
constexpr double kMostRoom = 30.0, kRoomSpare = 1.0;
constexpr double kHookShare = 0.5;  // of the middle finger's proximal phalanx, to a hooked handle
constexpr double kThumbedHookShare = 0.65;  // ... with the thumb on top of it
constexpr double kHookOblique =
    0.15;  // rad; the finger joints lie more obliquely than the knuckles
// A slab is held by its edges with the palm behind it, if the hand spans it: as one holds a phone.
constexpr double kFlat = 0.35;          // thickness / width up to which a section is a slab
constexpr double kSpan = 0.55;          // hand lengths between its edges that a hand spans
constexpr double kFlatCredit = 2500.0;  // mm^2 for its face in the palm
constexpr double kThumbRoom = 60.0;     // mm of product beside the grip's middle for the thumb
constexpr double kEquallyGood = 0.01;   // share of the score within which holds are the same
constexpr int kTurnsTried = 8;
// Steps by which a kept pose may be improved for another hand.
constexpr double kNearProximal = 3.0;  // mm
constexpr double kNearTilt = 3.0 * geometry::kDegree;
constexpr double kPromising = 0.6;     // share of the best rank from which a hold is improved
constexpr std::size_t kImproved = 3;   // holds that are looked at more finely
constexpr std::size_t kHoldsKept = 4;  // holds that are given back
constexpr double kOtherAngle =
    30.0 * geometry::kDegree;         // beyond which a way of holding is another one
constexpr double kOtherPlace = 20.0;  // mm; the same

// Axes of the palm: across towards the thumb along the metacarpal heads, distal, palmar.
struct PalmFrame {
  Vec3 heads, across, distal, palmar;
};

PalmFrame palm_frame(const hand::Skeleton& skeleton) {
  PalmFrame frame;
  const Vec3 index = skeleton.joint(hand::JointId::kIndexMcp).centre;
  const Vec3 little = skeleton.joint(hand::JointId::kLittleMcp).centre;
  frame.heads = 0.5 * (skeleton.joint(hand::JointId::kMiddleMcp).centre +
                       skeleton.joint(hand::JointId::kRingMcp).centre);
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
double strain_of(const hand::Posture& posture) {
  double strain = 0.0;
  for (int f = 1; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const double mcp = posture[flexion_of(finger, 0)], pip = posture[flexion_of(finger, 1)],
                 dip = posture[flexion_of(finger, 2)];
    strain += std::max(0.0, std::abs(dip - 2.0 / 3.0 * pip) / geometry::kDegree - 15.0);
    if (f == 1) continue;
    const double before = posture[flexion_of(static_cast<hand::Finger>(f - 1), 0)];
    strain += 2.0 * std::max(0.0, std::abs(mcp - before) / geometry::kDegree - 15.0);
  }
  return strain;
}

double leave_cost(const HandlePose& pose, const HandlePose& usual) {
  const auto square = [](double x) { return x * x; };
  return kLeaveCost * (square((pose.oblique - usual.oblique) / kSlantUnit) +
                       square((pose.tilt - usual.tilt) / kSlantUnit) +
                       square((pose.proximal - usual.proximal) / kProximalUnit) +
                       square((pose.along - usual.along) / kAlongUnit));
}

double score_of(const HoldMeasure& measure, const GripSite& site, const Placement& placement,
                const HandlePose& usual, double hand_length, const hand::Posture& posture) {
  double score = measure.contact_area + kSegmentCredit * measure.touching +
                 kWrapCredit * measure.wrap + kOpposedCredit * measure.opposed_area -
                 kClash * measure.other_area - 200.0 * std::max(0.0, measure.deepest_other - 2.0) -
                 kStrainCost * strain_of(posture) - leave_cost(placement.pose, usual);
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

// One placement closed from a given start, and what it is worth.
struct Trial {
  const HandCloser& closer;
  const geometry::DistanceField& product;
  const GripSite& site;
  DepthLimits limits;
  HandlePose usual;

  HeldProduct held(const Placement& placement, const ClosingStyle& style = {}) const {
    return {&product,  placement.product_from_hand,   site.point,
            site.axis, site.girth / std::numbers::pi, style.has_thumb};
  }
  /// The product placed as far from the thumb's root as the thumb, in front of the palm, asks for:
  /// round a thick body it has no room else.
  Placement placed(const ClosingStyle& style, HandlePose pose) const {
    const auto at = [&](double shift) {
      HandlePose shifted = pose;
      shifted.proximal -= shift;
      return place(closer, product, limits, style, site, shifted);
    };
    const auto has_room = [&](const Placement& placement) {
      const DepthLimits less{limits.palm - kRoomSpare, limits.finger - kRoomSpare};
      return closer.has_room_for_thumb(held(placement), less, closer.open_posture());
    };
    Placement usual_place = at(0.0);
    if (style.hook || !style.uses_thumb() || has_room(usual_place)) return usual_place;
    double low = 0.0, high = kMostRoom;
    Placement result = at(high);
    if (!has_room(result)) return usual_place;
    while (high - low > 0.2 * kRoomSpare) {
      const double middle = 0.5 * (low + high);
      Placement between = at(middle);
      if (has_room(between)) {
        high = middle;
        result = std::move(between);
      } else {
        low = middle;
      }
    }
    return result;
  }
  void judge(ClosedPose& hold) const {
    hold.measure =
        closer.measure(held(hold.placement), limits, hold.posture, hold.placement.axis_in_hand);
    hold.score = score_of(hold.measure, site, hold.placement, usual,
                          closer.hand().dimensions.hand_length, hold.posture);
  }
  void add_thumb(ClosedPose& hold) const {
    if (!hold.style.uses_thumb()) return;
    const HeldProduct at = held(hold.placement, hold.style);
    std::array<SegmentStop, hand::kSegmentCount> stops;
    hold.posture = closer.close_thumb(at, limits, hold.style, hold.posture, stops);
    judge(hold);
  }
  ClosedPose run(std::size_t site_index, const ClosingStyle& style, const HandlePose& pose,
                 const hand::Posture& start, int rounds) const {
    ClosedPose hold;
    hold.site = site_index;
    hold.style = style;
    hold.placement = placed(style, pose);
    std::array<SegmentStop, hand::kSegmentCount> stops;
    hold.posture = closer.close_fingers(held(hold.placement), limits, style, start, rounds, stops);
    judge(hold);
    return hold;
  }
};

// The open hand with the fingers abducted as in a hold that was found.
hand::Posture start_like(const HandCloser& closer, const ClosedPose& hold) {
  hand::Posture start = closer.start_posture(hold.style);
  for (int f = 1; f < hand::kFingerCount; ++f) {
    const hand::Dof dof = abduction_of(static_cast<hand::Finger>(f));
    start[dof] = hold.posture[dof];
  }
  return start;
}

}  // namespace

// A short product moves towards the little finger, so that the thumb meets it and not its rim.
HandlePose usual_pose(const hand::Hand& hand, const ClosingStyle& style, const GripSite& site,
                      bool is_place_fixed) {
  HandlePose pose;
  pose.proximal = kUsualProximal * hand.dimensions.hand_length;
  // Round a thin handle the index finger finds room only if the handle leaves its base.
  const double share = site.girth / std::numbers::pi / hand.dimensions.hand_length;
  pose.tilt += kThinTilt * std::clamp((kThick - share) / (kThick - kThin), 0.0, 1.0);
  if (style.hook) {
    const Vec3& mcp = hand.skeleton.joint(hand::JointId::kMiddleMcp).centre;
    const Vec3& pip = hand.skeleton.joint(hand::JointId::kMiddlePip).centre;
    const double past = style.has_thumb ? kThumbedHookShare : kHookShare;
    pose.proximal = -past * (pip - mcp).norm();
    pose.oblique = kHookOblique;
    pose.tilt = 0.0;
  } else if (!is_place_fixed) {
    pose.along = std::clamp(site.ahead - kThumbRoom, -kMostAlong, 0.0);
  }
  return pose;
}

PalmLine palm_line(const hand::Hand& hand) {
  const PalmFrame palm = palm_frame(hand.skeleton);
  const HandlePose pose;
  return {palm.heads - kUsualProximal * hand.dimensions.hand_length * palm.distal +
              kPalmToAxis * palm.palmar,
          std::cos(pose.oblique) * palm.across + std::sin(pose.oblique) * palm.distal};
}

bool differ(const hand::Hand& hand, const geometry::Rigid3& product_from_hand,
            const geometry::Rigid3& other) {
  const Vec3 heads = palm_frame(hand.skeleton).heads;
  return product_from_hand.rotation.angularDistance(other.rotation) > kOtherAngle ||
         (product_from_hand * heads - other * heads).norm() > kOtherPlace;
}

DepthLimits limits_for(const DepthLimits& asked, const GripSite& site) {
  const double thickness = std::min(site.thickness, site.wall);
  const double most = kThinBoxShare * 0.5 * thickness;
  return {std::min(asked.palm, most), std::min(asked.finger, most)};
}

Placement place(const HandCloser& closer, const geometry::DistanceField& product,
                const DepthLimits& limits, const ClosingStyle& style, const GripSite& site,
                const HandlePose& pose) {
  PalmFrame palm = palm_frame(closer.hand().skeleton);
  if (style.hook) {
    // The handle lies on the bent proximal phalanges.
    const PalmFrame flat = palm;
    palm.distal = std::cos(*style.hook) * flat.distal + std::sin(*style.hook) * flat.palmar;
    palm.palmar = std::cos(*style.hook) * flat.palmar - std::sin(*style.hook) * flat.distal;
  }
  Vec3 axis = std::cos(pose.oblique) * palm.across + std::sin(pose.oblique) * palm.distal;
  axis = std::cos(pose.tilt) * axis + std::sin(pose.tilt) * palm.palmar;
  const Vec3 outward = (palm.palmar - axis * axis.dot(palm.palmar)).normalized();

  Eigen::Matrix3d in_hand;  // grip axis, towards the palm, third
  in_hand << axis, -outward, axis.cross(-outward);
  const Vec3 wide = (site.wide - site.axis * site.axis.dot(site.wide)).normalized();
  // A left hand turns its product the other way.
  const double turn = closer.hand().side == hand::Side::kRight ? pose.turn : -pose.turn;
  const Vec3 facing = Eigen::AngleAxisd(turn, site.axis) * wide;
  Eigen::Matrix3d in_product;
  in_product << site.axis, facing, site.axis.cross(facing);

  Placement placement;
  placement.pose = pose;
  placement.axis_in_hand = axis;
  placement.push_in_hand = -outward;
  placement.product_from_hand.rotation = Quat(in_product * in_hand.transpose()).normalized();
  const double reach = kStart + 0.5 * site.width;
  const Vec3 start = palm.heads - pose.proximal * palm.distal + reach * outward;
  const Vec3 grip = site.point + pose.along * site.axis;
  placement.product_from_hand.translation = grip - placement.product_from_hand.rotation * start;
  const HeldProduct held{&product, placement.product_from_hand, site.point, site.axis,
                         site.girth / std::numbers::pi};
  const double travel =
      closer.free_travel(held, limits, style, placement.push_in_hand, 2.0 * reach);
  placement.product_from_hand.translation -=
      placement.product_from_hand.rotation * (travel * placement.push_in_hand);
  return placement;
}

PosesFound find_poses(const HandCloser& closer,
                      const std::vector<const geometry::DistanceField*>& distances,
                      const std::vector<GripSite>& sites, const DepthLimits& limits,
                      const PoseSearch& search, const Progress& progress) {
  PosesFound found;
  const hand::Hand& hand = closer.hand();
  const double best_site = sites.empty() ? 1.0 : sites.front().score;
  const auto finish = [&](ClosedPose& hold) {
    // A part that is less of a handle must hold much better to be preferred.
    const double share = sites[hold.site].score / best_site;
    hold.rank = hold.score * (hold.score > 0.0 ? std::pow(share, 4) : 1.0);
    ++found.tried;
  };
  const auto trial_at = [&](std::size_t s, const ClosingStyle& style) {
    return Trial{closer, *distances[s], sites[s], limits_for(limits, sites[s]),
                 usual_pose(hand, style, sites[s], search.is_place_fixed)};
  };
  std::vector<ClosedPose> tried;
  for (std::size_t s = 0; s < distances.size(); ++s) {
    for (const ClosingStyle& style : search.styles) {
      const Trial trial = trial_at(s, style);
      hand::Posture start = closer.start_posture(style);
      const std::size_t first = tried.size();
      for (int k = 0; k < (search.turn ? 1 : kTurnsTried); ++k) {
        progress.throw_if_cancelled();
        HandlePose pose = trial.usual;
        pose.turn = search.turn ? *search.turn : 2.0 * std::numbers::pi * k / kTurnsTried;
        ClosedPose hold = trial.run(s, style, pose, start, k == 0 ? 2 : 1);
        finish(hold);
        if (k == 0) start = start_like(closer, hold);
        tried.push_back(std::move(hold));
        // Round: it lies the same whichever way it is turned.
        const auto is_alike = [&](const ClosedPose& other) {
          return std::abs(other.score - tried[first].score) <
                 kEquallyGood * std::abs(tried[first].score);
        };
        if (k == 2 && is_alike(tried[first + 1]) && is_alike(tried[first + 2])) {
          tried.resize(first + 1);
          break;
        }
      }
    }
  }
  const auto by_rank = [](const ClosedPose& a, const ClosedPose& b) { return a.rank > b.rank; };
  std::stable_sort(tried.begin(), tried.end(), by_rank);

  // A finer look at the best: one number after the other, with smaller and smaller steps.
  const auto better = [&](ClosedPose& current, double scale) {
    const GripSite& site = sites[current.site];
    const Trial trial = trial_at(current.site, current.style);
    const hand::Posture start = start_like(closer, current);
    bool is_changed = false;
    const auto improve = [&](double HandlePose::*what, double step, double low, double high) {
      const HandlePose from = current.placement.pose;
      for (const double by : {scale * step, -scale * step}) {
        if (found.tried >= search.most) return;
        progress.throw_if_cancelled();
        HandlePose pose = from;
        pose.*what += by;
        if (pose.*what < low || pose.*what > high) continue;
        ClosedPose hold = trial.run(current.site, current.style, pose, start, 0);
        finish(hold);
        if (hold.rank <= current.rank) continue;
        current = std::move(hold);
        is_changed = true;
      }
    };
    const double usual = trial.usual.proximal;
    const bool is_hook = current.style.hook.has_value();
    improve(&HandlePose::proximal, 6.0, is_hook ? usual - 8.0 : kLeastProximal,
            is_hook ? usual + 8.0 : kMostProximal);
    improve(&HandlePose::tilt, 5.0 * geometry::kDegree, -15.0 * geometry::kDegree,
            15.0 * geometry::kDegree);
    improve(&HandlePose::oblique, 6.0 * geometry::kDegree, 2.0 * geometry::kDegree,
            30.0 * geometry::kDegree);
    if (!search.is_place_fixed) improve(&HandlePose::along, 8.0, -kMostAlong, kMostAlong);
    if (!search.turn && site.thickness < 0.98 * site.width) {
      improve(&HandlePose::turn, 15.0 * geometry::kDegree, -100.0, 100.0);
    }
    return is_changed;
  };
  // Fingers fanned out in more than one way leave more to be distinguished.
  const std::size_t finest = search.styles.size() > 1 ? 2 : 1;
  std::vector<ClosedPose> improved_holds;
  for (std::size_t k = 0; k < tried.size() && improved_holds.size() < kImproved + finest - 1; ++k) {
    if (tried[k].rank < kPromising * tried.front().rank && !improved_holds.empty()) break;
    ClosedPose current = tried[k];
    better(current, 1.0);
    improved_holds.push_back(std::move(current));
  }
  std::stable_sort(improved_holds.begin(), improved_holds.end(), by_rank);
  for (std::size_t k = 0; k < std::min(improved_holds.size(), finest); ++k) {
    for (const double scale : {0.6, 0.3}) better(improved_holds[k], scale);
  }
  for (std::size_t k = 0; k < improved_holds.size(); ++k) {
    // Once more with the fingers brought side by side, and with the thumb, for which the best are
    // shifted along the product, too.
    const ClosedPose from = improved_holds[k];
    const Trial trial = trial_at(from.site, from.style);
    const auto with_thumb = [&](double along) {
      progress.throw_if_cancelled();
      HandlePose pose = from.placement.pose;
      pose.along = std::clamp(pose.along + along, -kMostAlong, kMostAlong);
      ClosedPose hold = trial.run(from.site, from.style, pose, start_like(closer, from), 2);
      trial.add_thumb(hold);
      finish(hold);
      return hold;
    };
    improved_holds[k] = with_thumb(0.0);
    if (k >= finest || search.is_place_fixed || !from.style.uses_thumb()) continue;
    for (const double along : {-16.0, -8.0, 8.0}) {
      ClosedPose other = with_thumb(along);
      if (other.rank > improved_holds[k].rank) improved_holds[k] = std::move(other);
    }
  }
  std::stable_sort(improved_holds.begin(), improved_holds.end(), by_rank);
  for (ClosedPose& hold : improved_holds) {
    const bool is_new =
        std::all_of(found.holds.begin(), found.holds.end(), [&](const ClosedPose& other) {
          return differ(hand, hold.placement.product_from_hand, other.placement.product_from_hand);
        });
    if (is_new && found.holds.size() < kHoldsKept) found.holds.push_back(std::move(hold));
  }
  return found;
}

ClosedPose pose_like(const HandCloser& closer, const geometry::DistanceField& product,
                     const GripSite& site, const DepthLimits& limits, const hand::Hand& other,
                     const ClosedPose& of_other, const PoseKept& kept, int& tried,
                     const Progress& progress) {
  progress.throw_if_cancelled();
  const hand::Hand& hand = closer.hand();
  const HandlePose theirs = usual_pose(other, of_other.style, site, kept.is_place_fixed);
  const Trial trial{closer, product, site, limits_for(limits, site),
                    usual_pose(hand, of_other.style, site, kept.is_place_fixed)};
  HandlePose pose = of_other.placement.pose;
  const double size = hand.dimensions.hand_length / other.dimensions.hand_length;
  pose.proximal = trial.usual.proximal + size * (pose.proximal - theirs.proximal);
  pose.tilt += trial.usual.tilt - theirs.tilt;
  pose.along += trial.usual.along - theirs.along;
  hand::Posture start = start_like(closer, of_other);
  for (int f = 1; f < hand::kFingerCount; ++f) {
    const hand::JointDof& dof = hand.skeleton.dof(abduction_of(static_cast<hand::Finger>(f)));
    start[dof.dof] = std::clamp(start[dof.dof], dof.lower, dof.upper);
  }
  ClosedPose hold = trial.run(of_other.site, of_other.style, pose, start, 2);
  tried = 1;
  // A few placements near it: what fits one size is a little off for another.
  start = start_like(closer, hold);
  const auto better = [&](double HandlePose::*what, double step) {
    const HandlePose from = hold.placement.pose;
    for (const double by : {step, -step}) {
      progress.throw_if_cancelled();
      HandlePose next = from;
      next.*what += by;
      ClosedPose other_hold = trial.run(of_other.site, of_other.style, next, start, 0);
      ++tried;
      if (other_hold.score <= hold.score) continue;
      hold = std::move(other_hold);
      break;
    }
  };
  if (kept.may_adapt) {
    better(&HandlePose::proximal, kNearProximal);
    better(&HandlePose::tilt, kNearTilt);
    better(&HandlePose::oblique, kNearTilt);
  }
  hold.rank = hold.score;
  return hold;
}

}  // namespace palmar::grasp
