// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/comfort.h"

#include <array>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar {
namespace {

constexpr const char* kFilmSource = "ISO/TS 15066:2016, Table A.2";
constexpr const char* kFilmDiscomfortSource =
    "ISO/TS 15066:2016, Table A.2, times the ratios of Johansson et al. 1999";
constexpr const char* kAlgometerSource = "range quoted by Harih and Tada 2015";
constexpr const char* kAlgometerDiscomfortSource =
    "range quoted by Harih and Tada 2015, times the ratios of Johansson et al. 1999";
constexpr const char* kFlowSource = "Chalmers thesis 2004, publication 208";

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
    if (unit == "%" && key.find("_of_") == key.npos) index.highest = 100.0;
    index.better = Better::kDown;
    index.definition = definition;
    index.source = source;
    rows.push_back(index);
    return rows.back();
  }

  GraspIndices rows;

 private:
  bool has_contact_;
};

}  // namespace

ComfortResult assess_comfort(const Hand& hand, const ContactResult& contact) {
  if (!contact.force.empty() && (contact.force.size() != hand.region.size() ||
                                 contact.pressure.size() != hand.region.size())) {
    throw UsageError("comfort: contact of " + std::to_string(contact.force.size()) +
                     " vertices for a hand of " + std::to_string(hand.region.size()));
  }
  ComfortResult result;
  std::array<int, kRegionCount> place{};
  for (const RegionContact& region : contact.regions) {
    RegionComfort one;
    one.region = region.region;
    one.peak_pressure = region.peak_pressure_cells;
    one.film_pain = pain_onset_film(region.region);
    one.film_discomfort = one.film_pain * discomfort_over_pain(region.region);
    one.mean_pressure = region.mean_pressure;
    one.algometer_pain = kPainOnsetAlgometerLow;
    one.algometer_discomfort = one.algometer_pain * discomfort_over_pain(region.region);
    result.regions.push_back(one);
    place[index_of(region.region)] = static_cast<int>(result.regions.size());
  }
  double film_discomfort = 0.0, film_pain = 0.0;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    const int at = place[index_of(hand.region[v])];
    if (!(contact.force[v] > 0.0 && contact.pressure[v] > 0.0) || at == 0) continue;
    RegionComfort& one = result.regions[at - 1];
    const double area = contact.force[v] / contact.pressure[v];
    one.area += area;
    if (contact.pressure[v] > kBloodFlowStop) one.sustained_area += area;
    if (contact.pressure[v] > one.film_discomfort) film_discomfort += area;
    if (contact.pressure[v] > one.film_pain) film_pain += area;
  }
  double algometer_discomfort = 0.0, algometer_pain = 0.0;
  for (std::size_t k = 0; k < result.regions.size(); ++k) {
    const RegionComfort& one = result.regions[k];
    result.area += one.area;
    result.sustained_area += one.sustained_area;
    if (one.mean_pressure > one.algometer_discomfort) algometer_discomfort += one.area;
    if (one.mean_pressure > one.algometer_pain) algometer_pain += one.area;
    if (!result.most_at_risk_film ||
        one.film_share() > result.regions[*result.most_at_risk_film].film_share()) {
      result.most_at_risk_film = k;
    }
    // Discomfort, as its onset differs from region to region while that of pain isn't known to.
    const auto risk = [&](const RegionComfort& r) {
      return r.mean_pressure / r.algometer_discomfort;
    };
    if (!result.most_at_risk_algometer ||
        risk(one) > risk(result.regions[*result.most_at_risk_algometer])) {
      result.most_at_risk_algometer = k;
    }
  }
  if (result.area > 0.0) {
    result.sustained_share = result.sustained_area / result.area;
    result.film_discomfort_share = film_discomfort / result.area;
    result.film_pain_share = film_pain / result.area;
    result.algometer_discomfort_share = algometer_discomfort / result.area;
    result.algometer_pain_share = algometer_pain / result.area;
  }
  return result;
}

GraspIndices to_indices(const ComfortResult& result) {
  Rows rows(result);
  const RegionComfort none;
  const RegionComfort& film =
      result.most_at_risk_film ? result.regions[*result.most_at_risk_film] : none;
  const RegionComfort& algometer =
      result.most_at_risk_algometer ? result.regions[*result.most_at_risk_algometer] : none;

  GraspIndex& peak = rows.add(
      "film_peak_of_pain_onset_percent", "film family: largest peak over onset of pain", "%",
      100.0 * film.film_share(),
      "largest of all regions: peak pressure on a sensor cell over the film peak pressure at which "
      "pain begins there (3.0 fingers, 2.6 palm, 2.0 MPa thenar)",
      kFilmSource);
  if (result.most_at_risk_film) {
    peak.remark = "in " + std::string(name_of(film.region)) + ": " +
                  significant(film.peak_pressure, 3) + " of " + significant(film.film_pain, 3) +
                  " MPa";
  }
  rows.add("film_area_above_discomfort_percent", "film family: skin above the onset of discomfort",
           "%", 100.0 * result.film_discomfort_share,
           "share of the contact area whose pressure is above 0.38 (fingers), 0.40 (palm) or 0.22 "
           "(thenar) of the film peak pressure at which pain begins",
           kFilmDiscomfortSource);
  rows.add("film_area_above_pain_percent", "film family: skin above the onset of pain", "%",
           100.0 * result.film_pain_share,
           "share of the contact area whose pressure is above the film peak pressure at which pain "
           "begins",
           kFilmSource);
  GraspIndex& mean = rows.add(
      "algometer_mean_of_discomfort_onset_percent",
      "algometer family: largest mean over onset of discomfort", "%",
      result.most_at_risk_algometer
          ? 100.0 * algometer.mean_pressure / algometer.algometer_discomfort
          : 0.0,
      "largest of all regions: mean pressure over 0.38 (fingers), 0.40 (palm) or 0.22 (thenar) of "
      "0.1 MPa, the lower end of the mean pressures under an algometer at which pain begins",
      kAlgometerDiscomfortSource);
  if (result.most_at_risk_algometer) {
    mean.remark =
        "in " + std::string(name_of(algometer.region)) + ": mean " +
        significant(algometer.mean_pressure, 3) + " MPa, discomfort from " +
        significant(algometer.algometer_discomfort, 3) + " to " +
        significant(
            algometer.algometer_discomfort * kPainOnsetAlgometerHigh / kPainOnsetAlgometerLow, 3) +
        " MPa";
  }
  rows.add("algometer_area_above_discomfort_percent",
           "algometer family: skin of regions above the onset of discomfort", "%",
           100.0 * result.algometer_discomfort_share,
           "share of the contact area in regions whose mean pressure is above that onset of "
           "discomfort (lower end)",
           kAlgometerDiscomfortSource);
  rows.add("algometer_area_above_pain_percent",
           "algometer family: skin of regions above the onset of pain", "%",
           100.0 * result.algometer_pain_share,
           "share of the contact area in regions whose mean pressure is above 0.1 MPa, the lower "
           "end of the mean pressures under an algometer at which pain begins",
           kAlgometerSource);
  rows.add("skin_above_50_kpa_mm2", "held long: skin without blood flow", "mm2",
           result.sustained_area,
           "area of skin under more than 50 kPa, at which its blood flow stops; counts for grips "
           "held long",
           kFlowSource);
  rows.add("skin_above_50_kpa_percent", "held long: share of the contact without blood flow", "%",
           100.0 * result.sustained_share, "the same as a share of the contact area", kFlowSource);
  return rows.rows;
}

}  // namespace palmar
