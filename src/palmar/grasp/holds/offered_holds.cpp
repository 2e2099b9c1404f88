// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/offered_holds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/geometry/degrees.h"
#include "palmar/grasp/holds/hold_candidates.h"
#include "palmar/grasp/holds/hold_weights.h"
#include "palmar/grasp/precision/precision_shape.h"

namespace palmar::grasp {
namespace {

// Of the density's modes so many more than holds are wanted are closed: fingertips may not reach.
constexpr std::size_t kSpareModes = 4;
constexpr double kPartlyHeld = -3.0, kNotHeld = -8.0;  // as precision_holds() has them; choice
const double kTowardLimit = std::cos(60.0 * geometry::kDegree);  // as power holds have it

bool is_asked(const OpposedHold& hold, const HoldScene& scene, const HoldOptions& options) {
  if (options.toward) {
    const Vec3 row = (hold.points.tip(1) - hold.points.tip(4)).normalized();
    if (row.dot(options.toward->normalized()) < kTowardLimit) return false;
  }
  if (!options.part && options.part_name.empty()) return true;
  const Vec3 middle = 0.5 * (hold.place.thumb + hold.place.others);
  const int part = scene.parts->nearest(*scene.product, middle);
  return is_part_asked(scene.parts->parts[static_cast<std::size_t>(part)], options);
}

RankedHold closed_hold(const HoldScene& scene, const Grasp& grasp) {
  RankedHold ranked;
  ranked.grasp = grasp;
  Hold& hold = ranked.hold;
  hold.grip = grasp.grip;
  Vec3 others = Vec3::Zero();
  for (std::size_t k = 1; k < grasp.fingertips.size(); ++k) others += grasp.fingertips[k].reached;
  others /= static_cast<double>(grasp.fingertips.size() - 1);
  const Vec3 middle = 0.5 * (grasp.fingertips[0].reached + others);
  hold.part = scene.parts->nearest(*scene.product, middle) + 1;
  const product::ProductPart& part = scene.parts->parts[static_cast<std::size_t>(hold.part) - 1];
  hold.part_name = part.name;
  hold.along = std::clamp(product::place_of(part, middle).along, 0.0, 1.0);
  for (const FingertipContact& tip : grasp.fingertips) {
    hold.fingertips.push_back({tip.finger, product::place_of(part, tip.reached)});
  }
  hold.wrist = (grasp.product_from_hand.translation - middle).normalized();
  return ranked;
}

}  // namespace

bool are_offered(const HoldOptions& options) {
  return options.purpose == HoldPurpose::kHandOver && !options.is_power_only && !options.along &&
         (!options.grip || is_opposed(*options.grip));
}

std::vector<RankedHold> offered_holds(const HoldScene& scene, const HoldOptions& options,
                                      int& considered, const Progress& progress) {
  if (scene.parts->parts.empty()) return {};
  progress.update(0.1, "finding ways to hand over " + scene.product->name);
  OpenedHand hand(*scene.hand);
  const std::vector<Grip> grips = options.grip
                                      ? std::vector{*options.grip}
                                      : std::vector(kOpposedGrips.begin(), kOpposedGrips.end());
  std::vector<OpposedHold> all = opposed_holds(hand, *scene.product, grips, progress);
  considered += static_cast<int>(all.size());
  std::erase_if(all, [&](const OpposedHold& hold) { return !is_asked(hold, scene, options); });
  if (all.empty()) return {};
  const HoldWeights& weights = options.weights ? *options.weights : hand_over_weights();
  const std::vector<HoldMode> modes = modes_of(
      all, chances(weights, all, scene.lay), static_cast<std::size_t>(options.most) + kSpareModes);
  // Reasons are told against the likeliest hold. The modes' order is by the density of like holds,
  // so what its own features leave of its score is the neighbours' part.
  const ShapeFeatures slope = weights.shape_slope(scene.lay.has_value());
  const ShapeFeatures& likeliest = all[modes.front().hold].features;
  const auto on_table = [&](const OpposedHold& hold) {
    return weights.table_slope().dot(table_features(hold.palm, *scene.lay));
  };
  std::vector<RankedHold> found;
  for (const HoldMode& mode : modes) {
    progress.throw_if_cancelled();
    const OpposedHold& hold = all[mode.hold];
    PrecisionGripOptions precision;
    precision.grip = hold.grip;
    precision.from = hold.place;
    const Grasp grasp = close_precision_grip(hand, *scene.product, precision, progress);
    if (grasp.fingertips.empty()) continue;
    RankedHold ranked = closed_hold(scene, grasp);
    const ShapeFeatures share = slope.cwiseProduct(hold.features - likeliest);
    for (int k = 0; k < kShapeFeatureCount; ++k) {
      const auto feature = static_cast<HoldFeature>(k);
      std::string name(name_of(feature));
      std::replace(name.begin(), name.end(), '_', ' ');
      const double compared = share[k] == 0.0 ? weights.mean[k] : likeliest[k];
      ranked.terms.push_back({std::move(name), hold.features[k], "", share[k],
                              std::string(words_of(feature, hold.features[k] > compared))});
    }
    double told = share.sum();
    if (scene.lay) {
      ranked.terms.push_back(table_term(scene, weights, grasp));
      ranked.terms.back().score = on_table(hold) - on_table(all[modes.front().hold]);
      told += ranked.terms.back().score;
    }
    ranked.terms.push_back(
        {"like holds", mode.score, "", mode.score - told, "few of people's holds are like it"});
    const double held = grasp.status == GraspStatus::kHeld         ? 0.0
                        : grasp.status == GraspStatus::kPartlyHeld ? kPartlyHeld
                                                                   : kNotHeld;
    ranked.terms.push_back({"closing", 0.0, "", held, grasp.message});
    found.push_back(std::move(ranked));
  }
  return found;
}

}  // namespace palmar::grasp
