// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/holds/twin_handles.h"

namespace palmar::grasp {
namespace {

constexpr double kThinLoopSpread = 0.9;  // fingers through a loop hook it, however thin; choice
// El-Khoury & Sahbani 2010 (Autonomous Robots 28:57-71): people take things that have a handle by
// the handle. One in ten doesn't: our choice, that study gives no share.
constexpr double kBesideHandle = 0.1;
constexpr double kNoseAngle = 40.0 * geometry::kDegree;  // choice
constexpr double kFlatLoss = 3.0;                        // an edge of a sheet in the palm; choice
constexpr double kOneOfTwo = 0.1;                        // who takes one of two handles; choice
constexpr double kThumbSide = 1.5;   // per share of the product on the little finger's side; choice
constexpr double kUpsideDown = 2.5;  // thumb down of a vessel with a hollow; choice
constexpr double kMaybeUpsideDown = 1.2;  // where up was guessed from where it is heavier; choice
// Of hand lengths, where a wrist is beside a handle: from its middle out of the palm, and back.
constexpr double kWristOut = 0.13, kWristBack = 0.37;
constexpr double kWrongEnd = 1.5;       // a tool's working end at the little finger; choice
constexpr double kIndexPlace = 0.375;   // of the fingers' breadth, from their middle
constexpr double kTriggerSpread = 0.2;  // of the fingers' breadth; choice
constexpr double kOffTrigger = 0.1;     // who uses it so that no finger is on it; choice
constexpr double kSkinRoom = 6.0;       // mm that a finger's middle keeps off the product
constexpr double kBlocked = 6.0;        // all of the hand's room taken; choice

/// How much each reason counts: fitted to what people do with 54 products; docs/method/holds.md has
/// the data, the fit and how well it does on products that were left out.
struct TermWeight {
  std::string_view name;
  double weight;
};
constexpr std::array<TermWeight, 7> kWeights = {{{"handle", 1.85},
                                                 {"girth", 1.25},
                                                 {"place along it", 1.00},
                                                 {"thumb's side", 1.83},
                                                 {"palm's side", 0.67},
                                                 {"trigger", 1.18},
                                                 {"room for the hand", 1.36}}};

double log_normal(double value, double best, double thin, double thick) {
  const double ratio = std::log(value / best);
  const double z = ratio / (ratio < 0.0 ? thin : thick);
  return -0.5 * z * z;
}

HoldTerm girth_term(const HoldScene& scene, const product::ProductPart& part,
                    const GripSite& site) {
  const double diameter = site.girth / std::numbers::pi;
  const double length = scene.hand->dimensions.hand_length;
  const double thin = part.kind == product::PartKind::kLoop ? kThinLoopSpread : kThinSpread;
  return {"girth", diameter, "mm",
          log_normal(std::max(diameter, 1.0), kBestDiameter * length, thin, kThickSpread),
          fmt::format("{:.0f} mm thick by its girth, {:.0f} % of hand length", diameter,
                      100.0 * diameter / length)};
}

// The index finger, a quarter of the breadth of the four on the thumb's side, lies on the trigger.
HoldTerm trigger_term(const HoldScene& scene, const product::PartTrigger& trigger,
                      const HoldSite& at) {
  const double breadth = fingers_breadth(*scene.hand);
  const Vec3 index = at.site.point + kIndexPlace * breadth * at.site.axis;
  const double off = at.site.axis.dot(trigger.point - index);
  const product::ProductPart& part = scene.parts->parts[trigger.part - 1];
  const Vec3 outwards =
      (trigger.end == 1 ? 1.0 : -1.0) *
      (product::part_frame(part, static_cast<double>(trigger.end), 0.0).rotation * Vec3::UnitX());
  if (at.site.axis.dot(outwards) < 0.0) {
    return {"trigger", std::abs(off), "mm", std::log(kOffTrigger),
            "the little finger is next to the trigger"};
  }
  // Anywhere on it, half a finger within its ends.
  const double beside =
      std::max(0.0, std::abs(off) - std::max(0.0, 0.5 * trigger.length - 0.125 * breadth));
  const double z = beside / (kTriggerSpread * breadth);
  return {"trigger", std::abs(off), "mm", std::max(std::log(kOffTrigger), -0.5 * z * z),
          beside < 0.125 * breadth
              ? "the index finger lies on the trigger"
              : fmt::format("the index finger is {:.0f} mm beside the trigger", std::abs(off))};
}

// Shares of the surface that lie beyond the hand on the thumb's and on the little finger's side,
// and how far the product reaches there.
struct Beyond {
  double thumb_area = 0.0, other_area = 0.0;    // shares
  double thumb_reach = 0.0, other_reach = 0.0;  // mm from the middle of the hand
};

Beyond beyond_hand(const HoldScene& scene, const GripSite& site) {
  Beyond beyond;
  const geometry::TriangleMesh& mesh = scene.product->mesh;
  const double edge = 0.5 * fingers_breadth(*scene.hand);
  double whole = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = geometry::triangle_area(a, b, c);
    const double along = site.axis.dot((a + b + c) / 3.0 - site.point);
    whole += area;
    if (along > edge) beyond.thumb_area += area;
    if (along < -edge) beyond.other_area += area;
  }
  if (whole > 0.0) {
    beyond.thumb_area /= whole;
    beyond.other_area /= whole;
  }
  for (const Vec3& v : mesh.vertices) {
    const double along = site.axis.dot(v - site.point);
    beyond.thumb_reach = std::max(beyond.thumb_reach, along);
    beyond.other_reach = std::max(beyond.other_reach, -along);
  }
  return beyond;
}

// Tools point to the thumb's side; vessels have their mouth there.
HoldTerm thumb_side_term(const HoldScene& scene, const product::ProductPart& part, int toward,
                         const GripSite& site) {
  const bool is_vessel =
      part.kind == product::PartKind::kBody || part.kind == product::PartKind::kLoop;
  if (scene.up && is_vessel) {
    const double up = site.axis.dot(*scene.up);
    const double most = scene.is_vessel ? kUpsideDown : kMaybeUpsideDown;
    return {"thumb's side", std::acos(std::clamp(up, -1.0, 1.0)) / geometry::kDegree, "deg",
            -most * std::max(0.0, -up),
            up > 0.5    ? "thumb's side up"
            : up < -0.5 ? "thumb's side down"
                        : "thumb's side neither up nor down"};
  }
  if (part.kind == product::PartKind::kBar && !part.is_ring &&
      part.ends[0].joined.has_value() != part.ends[1].joined.has_value()) {
    const bool is_to_work = part.ends[toward > 0 ? 1 : 0].joined.has_value();
    return {"thumb's side", is_to_work ? 1.0 : 0.0, "", is_to_work ? 0.0 : -kWrongEnd,
            is_to_work ? "what it carries is on the thumb's side"
                       : "what it carries is on the little finger's side"};
  }
  const Beyond beyond = beyond_hand(scene, site);
  const double reach = (beyond.thumb_reach - beyond.other_reach) /
                       std::max(1e-9, beyond.thumb_reach + beyond.other_reach);
  const double lead = reach + beyond.thumb_area - beyond.other_area;
  return {"thumb's side", lead, "", -kThumbSide * std::clamp(-lead, 0.0, 2.0),
          lead < -0.1 ? "the longer end is on the little finger's side"
                      : "the longer end is on the thumb's side"};
}

// Where the working end sticks out from a site across its axis, beyond the hand on the thumb's
// side: unit, product frame; nothing if it doesn't.
std::optional<Vec3> nose_of(const HoldScene& scene, const GripSite& site) {
  const geometry::TriangleMesh& mesh = scene.product->mesh;
  const double edge = 0.4 * fingers_breadth(*scene.hand);
  Vec3 moment = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 r = (a + b + c) / 3.0 - site.point;
    if (site.axis.dot(r) < edge) continue;
    const double weight = geometry::triangle_area(a, b, c);
    moment += weight * (r - site.axis * site.axis.dot(r));
    area += weight;
  }
  // Off the handle's middle by half its radius at least: else it is straight.
  if (area <= 0.0 || moment.norm() / area < 0.25 * site.girth / std::numbers::pi) return {};
  return moment.normalized();
}

HoldTerm palm_term(const HoldScene& scene, const product::ProductPart& part, const HoldSite& at) {
  const GripSite& site = at.site;
  if (at.is_round_both) {
    return {"palm's side", 0.0, "deg", 0.0, "one handle in the palm, the fingers on the other"};
  }
  if (twin_of(part, *scene.parts) != nullptr) {
    return {"palm's side", 180.0, "deg", std::log(kOneOfTwo), "only one of its two handles"};
  }
  if (part.kind == product::PartKind::kBar) {
    if (const auto nose = nose_of(scene, site)) {
      const double angle = std::acos(std::clamp(-nose->dot(at.palm), -1.0, 1.0));
      const double z = angle / kNoseAngle;
      return {"palm's side", angle / geometry::kDegree, "deg", -0.5 * z * z / (1.0 + 0.1 * z * z),
              fmt::format("what it works with is {:.0f} degrees off the direction of the forearm",
                          angle / geometry::kDegree)};
    }
  }
  const double thin = 1.0 - std::min(1.0, site.thickness / std::max(site.width, 1e-9));
  const double edge = site.wide.dot(at.palm);
  const double score = -kFlatLoss * thin * edge * edge;
  return {"palm's side", std::acos(std::min(1.0, std::abs(edge))) / geometry::kDegree, "deg", score,
          score < -0.5 ? "an edge in the palm" : "its flat side in the palm"};
}

// Where on a part people take hold: near the centre of gravity if that lies in the part, of a tool
// with a heavy head far from the head.
HoldTerm place_term(const HoldScene& scene, const product::ProductPart& part, const HoldSite& at) {
  const double length = std::max(part.length, 1e-9);
  const Vec3 start = product::part_frame(part, 0.0, 0.0).translation;
  const Vec3 end = product::part_frame(part, 1.0, 0.0).translation;
  const Vec3 line = end - start;
  const double span = line.norm();
  const double breadth = fingers_breadth(*scene.hand);
  if (trigger_of(scene, part) != nullptr) {
    return {"place along it", 0.0, "mm", 0.0, "where its trigger is"};
  }
  if (part.is_ring || part.opening || span < 0.5 * length) {
    return {"place along it", 0.0, "mm", 0.0, "at its middle"};
  }
  const double gravity = line.dot(scene.gravity_centre - start) / span;
  const double here = line.dot(at.site.point - start) / span;
  const double away = std::abs(here - gravity);
  const auto squared = [&](double distance) {
    return std::min(std::pow(distance / breadth, 2), 4.0);
  };
  const auto index = static_cast<std::size_t>(part.number) - 1;
  const double within = -0.5 * squared(away);
  const double as_handle = std::min(1.0, away / (span + std::abs(away - span))) - 1.0;
  // What it stands on, or works with, is nothing to hold it by.
  const double beside = (part.kind == product::PartKind::kPlate ? -1.0 : -0.5) *
                        squared((scene.gravity_centre - at.site.point).norm());
  const double handle = scene.handle[index], weight = scene.weight_share[index];
  return {"place along it", away, "mm",
          weight * within + (1.0 - weight) * (handle * as_handle + (1.0 - handle) * beside),
          fmt::format("{:.0f} mm from the middle of its weight", away)};
}

// Whether palm and fingers would have room: middles of a palm's and four fingers' skin round the
// section, each to be clear of the product.
HoldTerm room_term(const HoldScene& scene, const product::ProductPart& part, const HoldSite& at) {
  const GripSite& site = at.site;
  const double breadth = fingers_breadth(*scene.hand);
  const double length = scene.hand->dimensions.hand_length;
  const double side = scene.hand->side == hand::Side::kRight ? 1.0 : -1.0;
  const Vec3 distal = side * site.axis.cross(at.palm);  // fingers reach over there first
  const Vec3 wide = site.wide, thin = site.axis.cross(site.wide);
  const auto radius = [&](const Vec3& direction) {
    const double w = direction.dot(wide), t = direction.dot(thin);
    return 0.5 *
           std::sqrt(w * w * site.width * site.width + t * t * site.thickness * site.thickness);
  };
  std::vector<Vec3> points;
  const double palm_off = radius(at.palm) + 12.0;
  for (const double x : {-0.375, -0.125, 0.125, 0.375}) {
    for (const double back : {0.0, 0.12, 0.24, 0.36}) {
      points.push_back(site.point + x * breadth * site.axis + palm_off * at.palm -
                       back * length * distal);
    }
  }
  const std::size_t palm_points = points.size();
  const bool is_loop = part.kind == product::PartKind::kLoop;
  for (const double x : is_loop ? std::vector<double>{-0.125, 0.125}
                                : std::vector<double>{-0.375, -0.125, 0.125, 0.375}) {
    for (double angle = 60.0; angle <= 210.0; angle += 30.0) {
      const Vec3 out = std::cos(angle * geometry::kDegree) * at.palm +
                       std::sin(angle * geometry::kDegree) * distal;
      points.push_back(site.point + x * breadth * site.axis + (radius(out) + 9.0) * out);
    }
  }
  std::vector<geometry::DistanceSample> samples(points.size());
  scene.product->distance->sample(points, 2.0 * kSkinRoom, samples);
  double palm = 0.0, fingers = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double taken = std::clamp((kSkinRoom - samples[k].distance) / kSkinRoom, 0.0, 2.0) / 2.0;
    (k < palm_points ? palm : fingers) += taken;
  }
  palm /= static_cast<double>(palm_points);
  fingers /= static_cast<double>(samples.size() - palm_points);
  const double share = 0.5 * (palm + fingers);
  return {"room for the hand", share, "", -kBlocked * share,
          share < 0.1 ? "room for palm and fingers" : "something is in the hand's way"};
}

// Less what a hand would have at best: thumb's side and wrist are across each other.
double score_on_table(const HoldWeights& weights, const TableFeatures& features) {
  const TableFeatures slope = weights.table_slope();
  return slope.dot(features) - std::hypot(slope[0], slope[1]);
}

}  // namespace

double weight_of(std::string_view term) {
  const auto found = std::find_if(kWeights.begin(), kWeights.end(),
                                  [&](const TermWeight& one) { return one.name == term; });
  return found == kWeights.end() ? 1.0 : found->weight;
}

HoldTerm handle_term(const HoldScene& scene, int part) {
  const bool is_handle = scene.is_handle(part);
  const double passed_over = scene.passed_over(part);
  return {"handle", scene.handle[static_cast<std::size_t>(part) - 1], "",
          weight_of("handle") * std::log(kBesideHandle) * passed_over,
          passed_over > 0.5 ? "beside the handle"
          : is_handle       ? "by the handle"
                            : "no handle is passed over"};
}

HoldTerm table_term(const HoldScene& scene, const HoldWeights& weights, const Grasp& grasp) {
  const TableFeatures features =
      table_features(palm_place(*scene.hand, grasp.product_from_hand), *scene.lay);
  const double up = features[0], below = features[2];
  constexpr double kWorthTelling = 0.5;
  return {"as it lies", up, "", score_on_table(weights, features),
          below > kWorthTelling ? std::string(words_of(HoldFeature::kBelowTable, true))
          : up > kWorthTelling  ? "thumb's side up"
          : up < -kWorthTelling ? "thumb's side down"
                                : "thumb's side neither up nor down"};
}

double rough_table_score(const HoldScene& scene, const HoldSite& at) {
  if (!scene.lay) return 0.0;
  const hand::Hand& hand = *scene.hand;
  const double length = hand.dimensions.hand_length;
  // The palm faces the axis; the hand's frame has z out of the palm and y along the fingers.
  const Vec3 radial = hand.side == hand::Side::kRight ? at.site.axis : Vec3(-at.site.axis);
  const Vec3 distal = radial.cross(at.palm);
  Eigen::Matrix3d axes;
  axes << radial, distal, -at.palm;
  const geometry::Rigid3 product_from_hand{
      Quat(axes), at.site.point + length * (kWristOut * at.palm - kWristBack * distal)};
  return score_on_table(hand_over_weights(),
                        table_features(palm_place(hand, product_from_hand), *scene.lay));
}

std::vector<HoldTerm> shape_terms(const HoldScene& scene, const Hold& hold, const HoldSite& at) {
  const product::ProductPart& part = part_of(hold, *scene.parts);
  std::vector<HoldTerm> terms = {girth_term(scene, part, at.site), room_term(scene, part, at)};
  if (!hold.is_over_end) {
    const product::PartTrigger* trigger = trigger_of(scene, part);
    if (trigger != nullptr) terms.push_back(trigger_term(scene, *trigger, at));
    terms.push_back(place_term(scene, part, at));
    if (trigger == nullptr && !(scene.is_up_given && part.kind != product::PartKind::kBar)) {
      terms.push_back(thumb_side_term(scene, part, hold.toward, at.site));
    }
    if (part.kind != product::PartKind::kLoop) terms.push_back(palm_term(scene, part, at));
  }
  for (HoldTerm& term : terms) term.score *= weight_of(term.name);
  terms.push_back(handle_term(scene, hold.part));
  return terms;
}

double sum_of(const std::vector<HoldTerm>& terms) {
  double sum = 0.0;
  for (const HoldTerm& term : terms) sum += term.score;
  return sum;
}

}  // namespace palmar::grasp
