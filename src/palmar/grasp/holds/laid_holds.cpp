// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/laid_holds.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/holds/hold_candidates.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/holds/opposed_holds.h"
#include "palmar/grasp/power/grip_choice.h"
#include "palmar/product/parts/part_spread.h"

namespace palmar::grasp {
namespace {

const double kLevelFace = std::cos(10.0 * geometry::kDegree);  // of a face that counts as level
constexpr double kLowestLayer = 1.0;                           // mm; what a thing stands on
constexpr double kStandsOn = 0.6;      // of its outline from above that stands on it; choice
constexpr double kMostLevelTop = 0.5;  // of the outline: more is no vault; choice
constexpr double kHighPart = 0.93;     // of the height: where it is highest
// Hand lengths: what lies wholly under one hand. Mice are 90 to 130 mm long; choice.
constexpr double kLeastUnder = 0.4, kMostUnder = 0.9;
constexpr double kLeastUnderWide = 0.2;
constexpr double kLeastHigh = 0.08, kMostHigh = 0.32;
constexpr double kHumpSpread = 40.0;  // mm of the knuckles off the highest place; choice
constexpr double kPerHump = 4.0;      // per share of the length that lies behind it; choice
constexpr double kPerMissing = 0.5;   // a finger (or the palm) that doesn't touch; choice
constexpr double kPushPrior = -0.3;   // a thing with a button may be held as well; choice
constexpr double kPushInHand = -2.5;  // one that doesn't stand against the push; choice
constexpr double kSomeStand = 0.4;    // of its outline on which it stands: hardly; choice
// Of hand length: a fingertip's middle off what it touches; and from where on it surely doesn't.
constexpr double kTipTouches = 0.055, kTipIsOff = 0.1;
constexpr double kTouches = 0.5;  // mm of skin, at most, that make a contact; choice
constexpr std::size_t kMostButtons = 3;
constexpr double kAlongAxis = 0.7;  // cosine: `up` is the part's axis

// How a product stands, and whether its top is vaulted.
struct Vault {
  Vec3 up = Vec3::UnitZ();
  Vec3 along = Vec3::UnitX();  // the longer way across `up`
  double length = 0.0, width = 0.0, height = 0.0;
  Vec3 highest = Vec3::Zero();
};

double extent_of(const geometry::TriangleMesh& mesh, const Vec3& direction) {
  double low = 1e300, high = -1e300;
  for (const Vec3& v : mesh.vertices) {
    low = std::min(low, direction.dot(v));
    high = std::max(high, direction.dot(v));
  }
  return high - low;
}

// The direction across `up` in which the surface spreads most.
Vec3 longer_way(const geometry::TriangleMesh& mesh, const Vec3& up) {
  const Vec3 u = up.unitOrthogonal(), v = up.cross(u);
  Vec3 middle = Vec3::Zero();
  double whole = 0.0;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const bool is_second : {false, true}) {
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const double area = geometry::triangle_area(a, b, c);
      if (!is_second) {
        middle += area * (a + b + c) / 3.0;
        whole += area;
        continue;
      }
      const Vec3 r = (a + b + c) / 3.0 - middle;
      const Eigen::Vector2d q(u.dot(r), v.dot(r));
      spread += area * q * q.transpose();
    }
    if (!is_second && whole > 0.0) middle /= whole;
  }
  const Eigen::Vector2d most =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  return (most.x() * u + most.y() * v).normalized();
}

// The share of its outline, seen along `up`, on which a thing stands.
double standing_share(const geometry::TriangleMesh& mesh, const Vec3& up) {
  double level = 1e300;
  for (const Vec3& v : mesh.vertices) level = std::min(level, up.dot(v));
  double outline = 0.0, base = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    const double seen = area.dot(up);
    outline += std::max(0.0, seen);
    const bool is_low = up.dot(a + b + c) / 3.0 - level < kLowestLayer;
    if (is_low && -seen > kLevelFace * area.norm()) base -= seen;
  }
  return outline > 0.0 ? base / outline : 0.0;
}

std::optional<Vault> vault_over(const geometry::TriangleMesh& mesh, const Vec3& up) {
  double level = 1e300, top = -1e300;
  for (const Vec3& v : mesh.vertices) {
    level = std::min(level, up.dot(v));
    top = std::max(top, up.dot(v));
  }
  double outline = 0.0, level_top = 0.0, high = 0.0;
  Vault vault;
  vault.up = up;
  vault.height = top - level;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    const double seen = area.dot(up);
    const double at = up.dot(a + b + c) / 3.0 - level;
    if (seen < 0.0) continue;
    outline += seen;
    if (seen > kLevelFace * area.norm()) level_top += seen;
    if (at > kHighPart * vault.height) {
      vault.highest += seen * (a + b + c) / 3.0;
      high += seen;
    }
  }
  if (standing_share(mesh, up) < kStandsOn || level_top > kMostLevelTop * outline || high <= 0.0) {
    return {};
  }
  vault.highest /= high;
  vault.along = longer_way(mesh, up);
  vault.length = extent_of(mesh, vault.along);
  vault.width = extent_of(mesh, up.cross(vault.along));
  return vault;
}

// A direction about upwards, made perpendicular to what faces down near the bottom.
Vec3 levelled(const geometry::TriangleMesh& mesh, Vec3 up) {
  constexpr int kRounds = 4;  // what counts as facing down goes with it
  for (int round = 0; round < kRounds; ++round) {
    const double height = extent_of(mesh, up);
    double level = 1e300;
    for (const Vec3& v : mesh.vertices) level = std::min(level, up.dot(v));
    Vec3 sum = Vec3::Zero();
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const Vec3 area = 0.5 * (b - a).cross(c - a);
      const double at = up.dot(a + b + c) / 3.0 - level;
      if (-area.dot(up) > kLevelFace * area.norm() && at < 0.25 * height) sum -= area;
    }
    if (sum.norm() > 0.0) up = sum.normalized();
  }
  return up;
}

// A thing that stands on a flat base and is vaulted above, low enough to lie under a hand.
std::optional<Vault> vault_of(const HoldScene& scene) {
  const geometry::TriangleMesh& mesh = scene.product->mesh;
  const Eigen::Matrix3d axes = product::face_axes_of(mesh).axes;
  std::optional<Vault> found;
  if (scene.is_up_given) return vault_over(mesh, levelled(mesh, *scene.up));
  for (int k = 0; k < 3 && !found; ++k) {
    for (const double sign : {1.0, -1.0}) {
      if (!found) found = vault_over(mesh, levelled(mesh, sign * axes.col(k)));
    }
  }
  return found;
}

bool lies_under_hand(const Vault& vault, double hand_length) {
  const double length = vault.length / hand_length, width = vault.width / hand_length;
  const double height = vault.height / hand_length;
  return length > kLeastUnder && length < kMostUnder && width > kLeastUnderWide &&
         width < kHandSpan && height > kLeastHigh && height < kMostHigh;
}

Vec3 surface_below(const product::Product& product, const Vec3& from, const Vec3& direction) {
  const double longest = 2.0 * product.distance->bounding_box().diagonal().norm() + 1.0;
  double way = 0.0;
  for (int step = 0; step < 500 && way < longest; ++step) {
    const geometry::DistanceSample sample = product.distance->at(from + way * direction);
    if (sample.distance < 0.05) return sample.closest;
    way += std::max(sample.distance, 0.05);
  }
  return product.distance->at(from).closest;
}

// The hold of a hand that lies so, in the part's coordinates.
Hold hold_of(Grip grip, const product::ProductPart& part, const LaidSite& site) {
  Hold hold;
  hold.grip = grip;
  hold.part = part.number;
  hold.part_name = part.name;
  const auto turn_to = [&](double along, const Vec3& direction) {
    const geometry::Rigid3 frame = product::part_frame(part, along, 0.0);
    const Vec3 z = frame.rotation * Vec3::UnitZ(), axis = frame.rotation * Vec3::UnitX();
    return std::atan2(axis.cross(z).dot(direction), z.dot(direction));
  };
  hold.along = std::clamp(product::place_of(part, site.knuckle).along, 0.0, 1.0);
  const Vec3 axis = product::part_frame(part, hold.along, 0.0).rotation * Vec3::UnitX();
  if (std::abs(axis.dot(site.up)) > kAlongAxis) {
    hold.is_over_end = true;
    hold.along = axis.dot(site.up) > 0.0 ? 1.0 : 0.0;
    hold.turn = turn_to(hold.along, site.fingers);
    return hold;
  }
  hold.turn = turn_to(hold.along, site.up);
  hold.toward = axis.dot(site.fingers) < 0.0 ? -1 : 1;
  return hold;
}

// How many of palm and fingers touch; what hardly does, or whose tip nearly does, in part.
double touching_of(const HoldScene& scene, const Grasp& grasp) {
  std::array<double, hand::kFingerCount + 1> deepest{};  // mm; the palm's last
  for (const SegmentStop& stop : grasp.stops) {
    const auto finger = hand::finger_of(stop.segment);
    double& most = finger ? deepest[index_of(*finger)] : deepest.back();
    if (finger || stop.segment == hand::Segment::kPalm) most = std::max(most, stop.penetration);
  }
  const double length = scene.hand->dimensions.hand_length;
  const HandPoints points = hand_points(*scene.hand, grasp.posture, grasp.product_from_hand);
  double touching = smooth_step(deepest.back(), 0.0, kTouches);
  for (std::size_t f = 0; f < hand::kFingerCount; ++f) {
    const double off = scene.product->distance->at(points.tip(f)).distance / length;
    touching +=
        std::max(smooth_step(deepest[f], 0.0, kTouches), smooth_step(off, kTipIsOff, kTipTouches));
  }
  return touching;
}

double closing_score(const Grasp& grasp) {
  return grasp.status == GraspStatus::kHeld         ? 0.0
         : grasp.status == GraspStatus::kPartlyHeld ? -3.0
                                                    : -8.0;
}

class LaidHolds {
 public:
  LaidHolds(const HoldScene& scene, const HoldOptions& options)
      : scene_(scene), options_(options), vault_(vault_of(scene)) {}

  std::vector<RankedHold> find(const Progress& progress) {
    const double length = scene_.hand->dimensions.hand_length;
    const product::ProductParts& parts = *scene_.parts;
    const bool is_asked = options_.grip && is_laid(*options_.grip);
    const bool suits =
        !options_.grip && parts.parts.size() == 1 && vault_ && lies_under_hand(*vault_, length);
    for (const product::ProductPart& part : parts.parts) {
      if (!(is_asked || suits) || !is_part_asked(part, options_) || part.line.size() < 2) continue;
      progress.throw_if_cancelled();
      lay_on(part, options_.grip.value_or(Grip::kRestingHand));
      if (!options_.part && options_.part_name.empty()) break;  // the largest
    }
    const bool may_push = !options_.grip && !scene_.has_handle() && parts.triggers.empty();
    if (may_push || options_.grip == Grip::kFingerPush) push(progress);
    return std::move(found_);
  }

 private:
  // The directions that may be up: the one that is known, else both sides of the flattest way.
  std::vector<Vec3> ups(const product::ProductPart& part) const {
    if (scene_.is_up_given) return {*scene_.up};
    if (vault_) return {vault_->up};
    if (part.face_normal) return {*part.face_normal, -*part.face_normal};
    if (scene_.up) return {*scene_.up};
    const BodyShape shape = body_shape(scene_.product->mesh);
    Eigen::Index least = 0;
    shape.extent.minCoeff(&least);
    return {shape.axes.col(least), -shape.axes.col(least)};
  }

  void lay_on(const product::ProductPart& part, Grip grip) {
    for (const Vec3& up : ups(part)) {
      Vec3 along =
          vault_ ? vault_->along : product::part_frame(part, 0.5, 0.0).rotation * Vec3::UnitX();
      if (std::abs(along.dot(up)) > kAlongAxis) {
        along = product::part_frame(part, 0.5, 0.0).rotation * Vec3::UnitZ();
      }
      along = (along - up * up.dot(along)).normalized();
      const Vec3 middle = product::part_frame(part, 0.5, 0.0).translation;
      for (const double sign : {1.0, -1.0}) {
        LaidSite site;
        site.up = up;
        site.fingers = sign * along;
        // The knuckles over the highest place, else in the middle.
        double at = options_.along ? (*options_.along - 0.5) * part.length * sign : 0.0;
        if (vault_ && !options_.along) at = site.fingers.dot(vault_->highest - middle);
        const Vec3 above = middle + at * site.fingers + 300.0 * up;
        site.knuckle = surface_below(*scene_.product, above, -up);
        const Vec3 thumb =
            (scene_.hand->side == hand::Side::kRight ? 1.0 : -1.0) * up.cross(site.fingers);
        const double limit = std::cos(60.0 * geometry::kDegree);
        if (options_.toward && thumb.dot(options_.toward->normalized()) < limit) continue;
        add_laid(hold_of(grip, part, site), site);
      }
    }
  }

  void add_laid(Hold hold, const LaidSite& wanted) {
    RankedHold ranked;
    const LaidSite site = laid_site_of(hold, *scene_.parts, *scene_.product);
    ranked.grasp = close_laid_hand(*scene_.hand, *scene_.product, hold.grip, site);
    ranked.terms.push_back(
        {"grip", 0.0, "", 0.0, vault_ ? "a vaulted thing that stands fast" : "as asked for"});
    if (vault_) {
      const double ahead = reach_from(vault_->highest, wanted.fingers);
      const double behind = reach_from(vault_->highest, -wanted.fingers);
      const double share = ahead / std::max(1e-9, ahead + behind);
      ranked.terms.push_back({"fingers' side", share, "", -kPerHump * std::max(0.0, 0.5 - share),
                              share < 0.45 ? "the palm on the lower end, the fingers on the hump"
                                           : "the fingers on the lower end"});
      const Vec3 knuckle = ranked.grasp.product_from_hand *
                           scene_.hand->skeleton.joint(hand::JointId::kMiddleMcp).centre;
      const double off = std::abs(wanted.fingers.dot(vault_->highest - knuckle));
      const double z = off / kHumpSpread;
      ranked.terms.push_back(
          {"place over the top", off, "mm", -0.5 * z * z,
           fmt::format("its knuckles are {:.0f} mm off the highest place", off)});
    }
    const double touching = touching_of(scene_, ranked.grasp);
    ranked.terms.push_back(
        {"closing", touching, "",
         closing_score(ranked.grasp) - kPerMissing * (hand::kFingerCount + 1 - touching),
         ranked.grasp.message});
    ranked.hold = std::move(hold);
    found_.push_back(std::move(ranked));
  }

  double reach_from(const Vec3& point, const Vec3& direction) const {
    double farthest = 0.0;
    for (const Vec3& v : scene_.product->mesh.vertices) {
      farthest = std::max(farthest, direction.dot(v - point));
    }
    return farthest;
  }

  void push(const Progress& progress) {
    const product::ProductParts& parts = *scene_.parts;
    struct Place {
      int number;
      Vec3 point, normal;
    };
    std::vector<Place> places;
    for (const product::PartButton& button : parts.buttons) {
      if (places.size() < kMostButtons && is_part_asked(parts.parts[button.part - 1], options_)) {
        places.push_back({button.part, button.point, button.normal});
      }
    }
    if (places.empty() && options_.grip && !parts.parts.empty()) {
      // No button: the middle of its top.
      for (const product::ProductPart& part : parts.parts) {
        if (!is_part_asked(part, options_) || part.line.size() < 2) continue;
        const Vec3 up = ups(part).front();
        const Vec3 middle =
            product::part_frame(part, options_.along.value_or(0.5), 0.0).translation;
        places.push_back(
            {part.number, surface_below(*scene_.product, middle + 300.0 * up, -up), up});
        break;
      }
    }
    for (const auto& [number, point, normal] : places) {
      progress.throw_if_cancelled();
      const product::ProductPart& part = parts.parts[number - 1];
      RankedHold ranked;
      ranked.grasp = close_finger_push(*scene_.hand, *scene_.product, point);
      ranked.hold.grip = Grip::kFingerPush;
      ranked.hold.part = number;
      ranked.hold.part_name = part.name;
      ranked.hold.fingertips = {{hand::Finger::kIndex, product::place_of(part, point)}};
      ranked.hold.along = std::clamp(ranked.hold.fingertips.front().place.along, 0.0, 1.0);
      const double stands =
          smooth_step(standing_share(scene_.product->mesh, levelled(scene_.product->mesh, normal)),
                      kSomeStand, kStandsOn);
      const double prior = stands * kPushPrior + (1.0 - stands) * kPushInHand;
      ranked.terms.push_back({"grip", stands, "", options_.grip ? 0.0 : prior,
                              parts.buttons.empty() ? "as asked for"
                              : stands > 0.5        ? "a button is pressed"
                                                    : "it doesn't stand against a push"});
      ranked.terms.push_back(
          {"closing", 1.0, "", closing_score(ranked.grasp), ranked.grasp.message});
      found_.push_back(std::move(ranked));
    }
  }

  const HoldScene& scene_;
  const HoldOptions& options_;
  std::optional<Vault> vault_;
  std::vector<RankedHold> found_;
};

}  // namespace

LaidSite laid_site_of(const Hold& hold, const product::ProductParts& parts,
                      const product::Product& product) {
  const product::ProductPart& part = part_of(hold, parts);
  const geometry::Rigid3 frame = product::part_frame(part, hold.along, hold.turn);
  LaidSite site;
  if (hold.is_over_end) {
    site.up = (hold.along >= 0.5 ? 1.0 : -1.0) * (frame.rotation * Vec3::UnitX());
    site.fingers = frame.rotation * Vec3::UnitZ();
    site.knuckle = frame.translation;
  } else {
    site.up = frame.rotation * Vec3::UnitZ();
    site.fingers = hold.toward * (frame.rotation * Vec3::UnitX());
    site.knuckle = frame.translation;
  }
  site.knuckle = surface_below(product, site.knuckle + 300.0 * site.up, -site.up);
  return site;
}

std::vector<RankedHold> laid_holds(const HoldScene& scene, const HoldOptions& options,
                                   const Progress& progress) {
  if (scene.parts->parts.empty() || options.is_power_only) return {};
  if (options.grip && !is_non_prehensile(*options.grip)) return {};
  return LaidHolds(scene, options).find(progress);
}

}  // namespace palmar::grasp
