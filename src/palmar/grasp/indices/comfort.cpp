// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/comfort.h"

#include <array>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar::grasp {
namespace {

constexpr const char* kProbeSource =
    "Johansson et al. 1999: probe of about 1 cm2 on one place of the hand";
constexpr const char* kFilmSource = "ISO/TS 15066:2016, Table A.2";
constexpr const char* kFlowSource = "Chalmers thesis 2004, publication 208";

/// The region whose pressure is the largest share of its onset.
std::optional<WorstRegion> worst_by(const std::vector<RegionComfort>& regions,
                                    double RegionComfort::*onset) {
  std::optional<WorstRegion> worst;
  int above = 0;
  for (const RegionComfort& one : regions) {
    const WorstRegion this_one{one.region, one.peak_pressure, one.*onset, 0};
    if (one.peak_pressure > one.*onset) ++above;
    if (!worst || this_one.share() > worst->share()) worst = this_one;
  }
  if (worst) worst->above = above;
  return worst;
}

class Rows {
 public:
  explicit Rows(const ComfortResult& result) : has_contact_(!result.regions.empty()) {}

  GraspIndex& add(const std::string& key, const std::string& name, const std::string& unit,
                  double value, const std::string& definition, const std::string& source) {
    GraspIndex index;
    index.key = key;
    index.name = name;
    index.group = "comfort";
    if (has_contact_) {
      index.value = value;
    } else {
      index.remark = "nothing is touched";
    }
    index.unit = unit;
    index.lowest = 0.0;
    index.better = Better::kDown;
    index.definition = definition;
    index.source = source;
    rows.push_back(index);
    return rows.back();
  }

  /// A row of a share of an onset, in percent.
  void add_onset(const std::string& key, const std::string& name,
                 const std::optional<WorstRegion>& worst, const std::string& definition,
                 const std::string& source) {
    GraspIndex& row = add(key, name, "%", worst ? 100.0 * worst->share() : 0.0, definition, source);
    if (!worst) return;
    row.remark = "in " + std::string(name_of(worst->region)) + ": " +
                 significant(worst->pressure, 3) + " of " + significant(worst->onset, 3) + " MPa";
  }

  GraspIndices rows;

 private:
  bool has_contact_;
};

}  // namespace

OnsetLevel level_of(const WorstRegion& worst) {
  if (worst.share() >= 1.0) return OnsetLevel::kAbove;
  return worst.share() >= kNearOnset ? OnsetLevel::kNear : OnsetLevel::kBelow;
}

std::string_view name_of(OnsetLevel level) {
  switch (level) {
    case OnsetLevel::kAbove:
      return "above";
    case OnsetLevel::kNear:
      return "near";
    case OnsetLevel::kBelow:
      break;
  }
  return "below";
}

ComfortResult assess_comfort(const hand::Hand& hand, const contact::ContactResult& contact) {
  if (!contact.force.empty() && (contact.force.size() != hand.region.size() ||
                                 contact.pressure.size() != hand.region.size())) {
    throw UsageError("comfort: contact of " + std::to_string(contact.force.size()) +
                     " vertices for a hand of " + std::to_string(hand.region.size()));
  }
  ComfortResult result;
  std::array<int, hand::kRegionCount> place{};
  for (const contact::RegionContact& region : contact.regions) {
    RegionComfort one;
    one.region = region.region;
    one.peak_pressure = region.peak_pressure_cells;
    one.pain = pain_onset_probe(region.region);
    one.discomfort = discomfort_onset_probe(region.region);
    one.film_pain = pain_onset_film(region.region);
    result.regions.push_back(one);
    place[index_of(region.region)] = static_cast<int>(result.regions.size());
  }
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    const int at = place[index_of(hand.region[v])];
    if (!(contact.force[v] > 0.0 && contact.pressure[v] > 0.0) || at == 0) continue;
    RegionComfort& one = result.regions[at - 1];
    const double area = contact.force[v] / contact.pressure[v];
    one.area += area;
    if (contact.pressure[v] > kBloodFlowStop) one.sustained_area += area;
  }
  for (const RegionComfort& one : result.regions) {
    result.area += one.area;
    result.sustained_area += one.sustained_area;
  }
  if (result.area > 0.0) result.sustained_share = result.sustained_area / result.area;
  result.pain = worst_by(result.regions, &RegionComfort::pain);
  result.discomfort = worst_by(result.regions, &RegionComfort::discomfort);
  result.film = worst_by(result.regions, &RegionComfort::film_pain);
  return result;
}

GraspIndices to_indices(const ComfortResult& result) {
  Rows rows(result);
  rows.add_onset("pain_onset_percent", "a moment: pressure over the onset of pain", result.pain,
                 "largest of all regions: peak pressure on a sensor cell over the mean pressure "
                 "under a probe at which pain begins there (0.496 fingers, 0.494 palm, 0.447 MPa "
                 "thenar)",
                 kProbeSource);
  rows.add_onset("discomfort_onset_percent", "repeated: pressure over the onset of discomfort",
                 result.discomfort,
                 "largest of all regions: peak pressure on a sensor cell over the mean pressure "
                 "under a probe at which discomfort begins there (0.188 fingers, 0.200 palm, 0.100 "
                 "MPa thenar)",
                 kProbeSource);
  rows.add("regions_above_discomfort", "repeated: regions above the onset of discomfort", "",
           result.discomfort ? result.discomfort->above : 0,
           "number of regions whose peak pressure on a sensor cell is above that onset",
           kProbeSource)
      .highest = hand::kRegionCount;
  rows.add("skin_above_50_kpa_mm2", "minutes: skin without blood flow", "mm2",
           result.sustained_area,
           "area of skin under more than 50 kPa, at which its blood flow stops; counts for grips "
           "held for minutes",
           kFlowSource);
  rows.add("skin_above_50_kpa_percent", "minutes: share of the touched skin without blood flow",
           "%", 100.0 * result.sustained_share, "the same as a share of the contact area",
           kFlowSource)
      .highest = 100.0;
  rows.add_onset(
      "film_peak_of_pain_onset_percent", "clamped by a robot: peak over the onset of pain",
      result.film,
      "largest of all regions: peak pressure on a sensor cell over the peak on a film at "
      "which pain begins when a robot clamps that place (3.0 fingers, 2.6 palm, 2.0 MPa "
      "thenar); another instrument, so another scale, that the verdict doesn't use",
      kFilmSource);
  return rows.rows;
}

}  // namespace palmar::grasp
