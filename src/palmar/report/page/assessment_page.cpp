// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/assessment_page.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/records/json_values.h"
#include "palmar/report/chart/bar_chart.h"
#include "palmar/report/chart/sensor_chart.h"
#include "palmar/report/page/desk_json.h"
#include "palmar/report/page/friction_words.h"
#include "palmar/report/page/scene_data.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/holds_picture.h"
#include "palmar/report/words/html_text.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

constexpr double kStiffer = 0.1;  // 10 %, the change in which sensitivities are given

/// A value of each region as bars, with the range from soft to stiff tissue where both are known.
BarChart region_chart(const contact::ContactResult& contact, const std::string& title,
                      double contact::RegionContact::*value, double contact::ContactBandRow::*low,
                      double contact::ContactBandRow::*high) {
  const bool has_range = contact.band && contact.band->total.force_low > 0.0 &&
                         contact.band->total.force_high > 0.0 &&
                         contact.band->regions.size() == contact.regions.size();
  BarChart chart{title + (has_range ? " (lines: soft to stiff tissue)" : ""), {}, "No contact."};
  for (std::size_t i = 0; i < contact.regions.size(); ++i) {
    const contact::RegionContact& one = contact.regions[i];
    Bar bar{plain_words(one.region), one.*value, region_colour(one.region)};
    if (has_range) {
      const contact::ContactBandRow& band = contact.band->regions[i];
      bar.range = BarRange{band.*low, band.*high};
    }
    chart.bars.push_back(std::move(bar));
  }
  return chart;
}

BarChart sensitivity_chart(const contact::ContactBand& band) {
  std::vector<contact::ContactBandRow> rows = band.regions;
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.force_per_modulus > b.force_per_modulus;
  });
  BarChart chart{"Force that 10 % stiffer skin in one region adds, N", {}, "No contact."};
  for (const contact::ContactBandRow& one : rows) {
    chart.bars.push_back({plain_words(one.region), kStiffer * std::max(one.force_per_modulus, 0.0),
                          region_colour(one.region)});
  }
  return chart;
}

PageJson charts_json(const contact::ContactResult& contact, const std::string& name,
                     const Phrases& phrases, Attachments& attachments) {
  PageJson list = PageJson::array();
  for (const BarChart& chart :
       {region_chart(contact, "Force, N", &contact::RegionContact::force,
                     &contact::ContactBandRow::force_low, &contact::ContactBandRow::force_high),
        region_chart(contact, "Peak pressure, MPa", &contact::RegionContact::peak_pressure,
                     &contact::ContactBandRow::peak_pressure_low,
                     &contact::ContactBandRow::peak_pressure_high)}) {
    Figure figure = bar_figure(chart);
    figure.say(phrases);
    const std::string svg = to_svg(figure);
    list.push_back(
        {{"title", chart.title},
         {"svg", attached(attachments, name + "-chart-" + std::to_string(list.size()), svg)}});
  }
  return list;
}

/// Ways to hold the product, as many as the sheet shows.
PageJson ways_json(const study::AssessedProduct& one) {
  PageJson list = PageJson::array();
  if (one.ways == nullptr) return list;
  for (const grasp::RankedHold& way : one.ways->holds) {
    if (list.size() == static_cast<std::size_t>(HoldsPictureOptions{}.most)) break;
    list.push_back({{"number", list.size() + 1},
                    {"words", way.words},
                    {"score", records::finite_or_null(way.score)},
                    {"against", way.against}});
  }
  return list;
}

PageJson product_json(const hand::Hand& hand, const study::AssessedProduct& one,
                      const ColourScale& scale, const std::vector<EncodedPicture>& pictures,
                      const std::string& name, Language language, Attachments& attachments) {
  const contact::ContactResult& contact = one.assessment.contact;
  const Phrases phrases(language);
  PageJson sensitivity = nullptr;
  if (contact.band && !contact.band->regions.empty()) {
    Figure figure = bar_figure(sensitivity_chart(*contact.band));
    figure.say(phrases);
    sensitivity = attached(attachments, name + "-sensitivity", to_svg(figure));
  }
  PageJson sensors = nullptr;
  if (one.assessment.sensors) {
    Figure figure = sensor_figure(*one.assessment.sensors, one.assessment.measured);
    figure.say(phrases);
    sensors = attached(attachments, name + "-sensors", to_svg(figure));
  }
  return {{"charts", charts_json(contact, name, phrases, attachments)},
          {"sensor_map", std::move(sensors)},
          {"sensitivity_chart", std::move(sensitivity)},
          {"friction_words", friction_verdict(hand, one.assessment)},
          {"pictures", pictures_json(pictures, name, attachments)},
          {"ways", ways_json(one)},
          {"way_taken", one.ways ? PageJson(one.ways->taken) : nullptr},
          {"why_taken", one.ways ? one.ways->why_taken : std::string()},
          {"scene", attached(attachments, name + "-scene",
                             script_escaped(scene_data_json(hand, one, scale, language)))}};
}

}  // namespace

std::string assessment_page(const study::AssessmentSet& set,
                            const std::vector<std::vector<EncodedPicture>>& pictures,
                            const ColourScale& scale, const std::string& json,
                            const AssessmentPageOptions& options) {
  if (!set.hand) throw UsageError("report: the set has no hand");
  if (set.assessments.empty()) throw UsageError("report: the set has no assessment");
  if (pictures.size() != set.assessments.size()) {
    throw UsageError("report: pictures of " + std::to_string(pictures.size()) + " products for " +
                     std::to_string(set.assessments.size()) + " assessments");
  }
  Attachments attachments;
  PageJson products = PageJson::array();
  for (std::size_t i = 0; i < set.assessments.size(); ++i) {
    products.push_back(product_json(*set.hand, set.assessments[i], scale, pictures[i],
                                    "product-" + std::to_string(i), options.language, attachments));
  }
  const PageJson view = {{"maker", maker_json()},
                         {"language", name_of(options.language)},
                         {"desk", desk_json(options.extras, attachments)},
                         {"is_cut_short", options.is_cut_short},
                         {"vocabulary", vocabulary_json(*set.hand)},
                         {"scale", colour_bar_json(scale)},
                         {"products", std::move(products)}};
  return render_page("assessment", json, view, std::move(attachments));
}

}  // namespace palmar::report
