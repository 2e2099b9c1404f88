// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/fitness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::grasp {
namespace {

struct NearVertex {
  double gap = 0.0;    ///< mm
  double area = 0.0;   ///< mm^2
  double angle = 0.0;  ///< rad
};

GapStatistics statistics(std::vector<NearVertex> near) {
  GapStatistics result;
  for (const NearVertex& one : near) result.area += one.area;
  if (!(result.area > 0.0)) return result;
  double square = 0.0;
  for (const NearVertex& one : near) {
    const double weight = one.area / result.area;
    result.mean += weight * one.gap;
    square += weight * one.gap * one.gap;
    result.normal_angle += weight * one.angle;
  }
  result.rms = std::sqrt(square);
  double spread = 0.0;
  for (const NearVertex& one : near) {
    const double weight = one.area / result.area;
    const double away = std::abs(one.gap - result.mean);
    spread += weight * away * away;
    if (away <= 1.0) result.within_1_mm += weight;
    if (away <= 2.0) result.within_2_mm += weight;
  }
  result.deviation = std::sqrt(spread);
  std::sort(near.begin(), near.end(),
            [](const NearVertex& a, const NearVertex& b) { return a.gap < b.gap; });
  double below = 0.0;
  for (const NearVertex& one : near) {
    below += one.area;
    result.median = one.gap;
    if (below >= 0.5 * result.area) break;
  }
  return result;
}

GraspIndex row(const std::string& key, const std::string& name, const std::string& unit,
               Better better, const FitnessResult& result, double value) {
  GraspIndex index;
  index.key = key;
  index.name = name;
  index.group = "fitness";
  index.unit = unit;
  index.better = better;
  index.source = "after Endo et al. 2007 (Digital Hand)";
  char text[96];
  if (result.total.area > 0.0) {
    index.value = value;
    std::snprintf(text, sizeof text,
                  "palmar skin within %g mm that faces the product within %.0f deg", result.reach,
                  result.facing * geometry::kDegreesPerRadian);
  } else {
    std::snprintf(text, sizeof text, "no palmar skin within %g mm of the product", result.reach);
  }
  index.remark = text;
  return index;
}

}  // namespace

void FitnessOptions::check() const {
  if (!(reach > 0.0 && reach <= 50.0)) {
    throw UsageError("fitness: reach is " + std::to_string(reach) +
                     " mm; more than 0 and at most 50 mm is required");
  }
  if (!(facing > 0.0 && facing <= 0.5 * std::numbers::pi)) {
    throw UsageError("fitness: facing angle is " + std::to_string(facing) +
                     " rad; more than 0 and at most pi / 2 is required");
  }
}

FitnessResult assess_fitness(const hand::Hand& hand, const std::vector<Vec3>& posed_skin,
                             const geometry::Rigid3& product_from_hand,
                             const geometry::DistanceField& product,
                             const FitnessOptions& options) {
  options.check();
  if (posed_skin.size() != hand.skin.vertices.size()) {
    throw UsageError("fitness: " + std::to_string(posed_skin.size()) + " posed points for " +
                     std::to_string(hand.skin.vertices.size()) + " skin vertices");
  }
  FitnessResult result;
  result.reach = options.reach;
  result.facing = options.facing;
  std::vector<Vec3> points;
  points.reserve(posed_skin.size());
  for (const Vec3& p : posed_skin) points.push_back(product_from_hand * p);
  const std::vector<double> areas = geometry::vertex_areas(hand.skin);
  const std::vector<Vec3> normals = geometry::vertex_normals(points, hand.skin.triangles);
  std::vector<geometry::DistanceSample> samples(points.size());
  product.sample(points, options.reach, samples);

  std::array<std::vector<NearVertex>, hand::kRegionCount> near;
  std::array<double, hand::kRegionCount> skin_area{};
  double palmar = 0.0, touching = 0.0;
  const double least = std::cos(options.facing);
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (hand.region[v] == hand::Region::kDorsum) continue;
    const std::size_t r = index_of(hand.region[v]);
    skin_area[r] += areas[v];
    palmar += areas[v];
    const double facing = -normals[v].dot(samples[v].normal);
    // Samples out of range come back at +-range.
    if (std::abs(samples[v].distance) >= options.reach || !(facing > least)) continue;
    near[r].push_back({samples[v].distance, areas[v], std::acos(std::clamp(facing, -1.0, 1.0))});
    if (samples[v].distance <= 0.0) touching += areas[v];
  }
  std::vector<NearVertex> all;
  for (std::size_t r = 0; r < near.size(); ++r) {
    if (near[r].empty()) continue;
    RegionFitness one{static_cast<hand::Region>(r), statistics(near[r])};
    one.gap.skin_area = skin_area[r];
    result.regions.push_back(one);
    all.insert(all.end(), near[r].begin(), near[r].end());
  }
  result.total = statistics(std::move(all));
  result.total.skin_area = palmar;
  if (palmar > 0.0) result.contact_share = result.total.area / palmar;
  if (result.total.area > 0.0) result.touching_share = touching / result.total.area;
  return result;
}

GraspIndices to_indices(const FitnessResult& result) {
  const GapStatistics& gap = result.total;
  GraspIndices rows;
  GraspIndex spread = row("gap_deviation_mm", "unevenness of the gap between hand and product",
                          "mm", Better::kDown, result, gap.deviation);
  spread.lowest = 0.0;
  spread.highest = result.reach;
  spread.definition =
      "standard deviation, by area, of the signed distance between undeformed palmar skin and "
      "product";
  rows.push_back(spread);
  GraspIndex within = row("gap_within_1_mm_percent", "skin that follows the product within 1 mm",
                          "%", Better::kUp, result, 100.0 * gap.within_1_mm);
  within.lowest = 0.0;
  within.highest = 100.0;
  within.definition = "share of that skin whose distance is within 1 mm of the mean distance";
  rows.push_back(within);
  GraspIndex within_2 = row("gap_within_2_mm_percent", "skin that follows the product within 2 mm",
                            "%", Better::kUp, result, 100.0 * gap.within_2_mm);
  within_2.lowest = 0.0;
  within_2.highest = 100.0;
  within_2.definition = "share of that skin whose distance is within 2 mm of the mean distance";
  rows.push_back(within_2);
  GraspIndex mean = row("gap_mean_mm", "mean gap", "mm", Better::kNeither, result, gap.mean);
  mean.lowest = -result.reach;
  mean.highest = result.reach;
  mean.definition =
      "mean, by area, of that distance; negative: the skin is pressed in. It follows how far the "
      "hand was closed";
  rows.push_back(mean);
  GraspIndex median =
      row("gap_median_mm", "median gap", "mm", Better::kNeither, result, gap.median);
  median.lowest = -result.reach;
  median.highest = result.reach;
  median.definition = "half of that skin, by area, is nearer";
  rows.push_back(median);
  GraspIndex rms = row("gap_rms_mm", "root mean square gap", "mm", Better::kDown, result, gap.rms);
  rms.lowest = 0.0;
  rms.highest = result.reach;
  rms.definition = "root mean square, by area, of that distance";
  rows.push_back(rms);
  GraspIndex angle = row("normal_angle_deg", "angle between skin and product", "deg", Better::kDown,
                         result, gap.normal_angle * geometry::kDegreesPerRadian);
  angle.lowest = 0.0;
  angle.highest = result.facing * 180.0 / std::numbers::pi;
  angle.definition = "mean, by area, of the angle between the surfaces of skin and product";
  rows.push_back(angle);
  GraspIndex share = row("skin_near_product_percent", "palmar skin near the product", "%",
                         Better::kUp, result, 100.0 * result.contact_share);
  share.lowest = 0.0;
  share.highest = 100.0;
  share.value = 100.0 * result.contact_share;
  share.definition = "share of all palmar skin that is so near to the product and faces it";
  rows.push_back(share);
  GraspIndex touching = row("near_skin_touching_percent", "share of the near skin that touches",
                            "%", Better::kUp, result, 100.0 * result.touching_share);
  touching.lowest = 0.0;
  touching.highest = 100.0;
  touching.definition = "share of the skin near the product that is on it or inside it";
  rows.push_back(touching);
  return rows;
}

}  // namespace palmar::grasp
