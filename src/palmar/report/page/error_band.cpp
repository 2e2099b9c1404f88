// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/error_band.h"

#include <algorithm>
#include <vector>

#include "palmar/report/chart/svg_chart.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/page/pressure_limits.h"
#include "palmar/report/picture/colormap.h"

namespace palmar {

namespace {

constexpr double kStiffer = 0.1;  // 10 %, the change in which sensitivities are told

std::string shown(double value, bool is_known) { return is_known ? short_number(value) : "–"; }

std::string cell(double value, bool is_known) {
  if (!is_known) return "<td class=\"n\">–</td>";
  return "<td class=\"n\" data-value=\"" + exact_number(value) + "\">" + short_number(value) +
         "</td>";
}

std::string row(const std::string& name, const ContactBandRow& band, const RegionContact& nominal,
                bool is_low, bool is_high) {
  return "<th scope=\"row\">" + html_escaped(name) + "</th>" + cell(band.force_low, is_low) +
         cell(nominal.force, true) + cell(band.force_high, is_high) + cell(band.area_low, is_low) +
         cell(nominal.area, true) + cell(band.area_high, is_high) +
         cell(band.peak_pressure_cells_low, is_low) + cell(nominal.peak_pressure_cells, true) +
         cell(band.peak_pressure_cells_high, is_high) +
         cell(kStiffer * band.force_per_modulus, true) + "</tr>";
}

std::string band_table(const ContactResult& contact, const ContactBand& band) {
  std::string html =
      "<div class=\"wide\"><table id=\"error-band\"><caption>Soft, middle and stiff "
      "tissue</caption>"
      "<thead><tr><th rowspan=\"2\" scope=\"col\">Region</th><th colspan=\"3\" "
      "scope=\"colgroup\">Force, N</th><th colspan=\"3\" scope=\"colgroup\">Area, mm²</th><th "
      "colspan=\"3\" scope=\"colgroup\">Peak on cells, MPa</th><th rowspan=\"2\" class=\"n\" "
      "scope=\"col\">10 % stiffer skin here adds to the hand's force, N</th></tr><tr>";
  for (int i = 0; i < 3; ++i) {
    for (const char* words : {"soft", "middle", "stiff"}) {
      html += std::string("<th class=\"n\" scope=\"col\">") + words + "</th>";
    }
  }
  html += "</tr></thead><tbody>";
  for (std::size_t i = 0; i < contact.regions.size() && i < band.regions.size(); ++i) {
    const RegionContact& region = contact.regions[i];
    html += "<tr data-band-region=\"" + std::string(name_of(region.region)) + "\">" +
            row(plain_words(region.region), band.regions[i], region, has_low(band), has_high(band));
  }
  html += "<tr class=\"total\" data-band-region=\"total\">" +
          row("Whole hand", band.total, contact.total, has_low(band), has_high(band));
  return html + "</tbody></table></div>\n";
}

std::vector<ContactBandRow> sorted_rows(const ContactBand& band) {
  std::vector<ContactBandRow> rows = band.regions;
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.force_per_modulus > b.force_per_modulus;
  });
  return rows;
}

/// By how much a 10 % stiffer sleeve presses harder: force is homogeneous of degree one in all
/// moduli (Euler), so what the skin's sensitivities leave of it is the sleeve's.
double sleeve_effect(const ContactResult& contact, const ContactBand& band) {
  return kStiffer * (contact.total.force - band.total.force_per_modulus);
}

std::string sensitivities(const Assessment& assessment, const ContactBand& band) {
  const std::vector<ContactBandRow> rows = sorted_rows(band);
  BarChart chart{"Force that 10 % stiffer skin in one region adds, N", {}};
  for (const ContactBandRow& one : rows) {
    chart.bars.push_back({plain_words(one.region), kStiffer * std::max(one.force_per_modulus, 0.0),
                          region_colour(one.region)});
  }
  // The fewest regions that make up half of it.
  double sum = 0.0;
  std::size_t half = 0;
  while (half < rows.size() && sum < 0.5 * band.total.force_per_modulus) {
    sum += rows[half++].force_per_modulus;
  }
  std::string words = "<p><strong>What matters most.</strong> If only the skin of the " +
                      html_escaped(plain_words(rows.front().region)) +
                      " were 10 % stiffer, the hand would press with " +
                      short_number(kStiffer * rows.front().force_per_modulus, 2) + " N more. ";
  if (half > 1) {
    words += "The first " + std::to_string(half) + " of the " + std::to_string(rows.size()) +
             " regions below make up half of the effect: ";
  } else {
    words += "That region alone makes up half of the effect of all: ";
  }
  words += "measure the skin there if you need a surer force.";
  if (!assessment.options.contact.coatings.empty()) {
    words += " A sleeve that is 10 % stiffer would add " +
             short_number(sleeve_effect(assessment.contact, band), 2) + " N.";
  }
  return words + "</p>\n<div class=\"charts\">" + svg_chart(chart) + "</div>\n";
}

std::string limits_words(const ContactResult& contact, const ContactBand& band) {
  int soft = 0;
  int stiff = 0;
  double share = 0.0;
  for (const ContactBandRow& one : band.regions) {
    soft += one.peak_pressure_cells_low > kBloodFlowStop ? 1 : 0;
    stiff += one.peak_pressure_cells_high > kBloodFlowStop ? 1 : 0;
    share = std::max(share, one.peak_pressure_high / pain_onset_film(one.region));
  }
  std::string words;
  if (has_high(band)) {
    words = " With stiff tissue the region nearest to pain reaches " +
            short_number(100.0 * share, 2) + " % of its limit.";
  }
  const int middle = regions_without_blood_flow(contact);
  if (!has_low(band) || !has_high(band)) return words;
  if (soft == middle && middle == stiff) {
    return words + " The number of regions short of blood in a long grip, " +
           std::to_string(middle) + ", is the same for all three.";
  }
  return words + " Regions short of blood in a long grip: " + std::to_string(soft) +
         " with soft, " + std::to_string(middle) + " with middle, " + std::to_string(stiff) +
         " with stiff tissue.";
}

}  // namespace

bool has_low(const ContactBand& band) { return band.total.force_low > 0.0; }
bool has_high(const ContactBand& band) { return band.total.force_high > 0.0; }

std::string range_words(double low, double high, bool is_low, bool is_high) {
  return shown(low, is_low) + " to " + shown(high, is_high);
}

std::string error_band_section(const Assessment& assessment) {
  const ContactResult& contact = assessment.contact;
  if (!contact.band || contact.band->regions.empty()) return {};
  const ContactBand& band = *contact.band;
  const bool is_low = has_low(band);
  const bool is_high = has_high(band);
  std::string html = "<h3>How sure are these numbers?</h3>\n";
  if (assessment.options.contact.shear_modulus) {
    html +=
        "<p>One stiffness was given for all skin, so soft, middle and stiff tissue are the "
        "same here.</p>\n";
  } else {
    const ContactBandRow& all = band.total;
    html +=
        "<p>Other people's skin is softer or stiffer than the middle values used above. Between "
        "the soft and the stiff end of the tissue's range, in the same posture, the hand presses "
        "with " +
        range_words(all.force_low, all.force_high, is_low, is_high) + " N (middle " +
        short_number(contact.total.force) + " N), and the peak on sensor cells is " +
        range_words(all.peak_pressure_cells_low, all.peak_pressure_cells_high, is_low, is_high) +
        " MPa (middle " + short_number(contact.total.peak_pressure_cells) + " MPa)." +
        limits_words(contact, band) +
        " The lines on the bars above show the same per region. The shape of the hand, posture and "
        "depth have ranges of their own that are not in these.</p>\n";
    if (!is_low || !is_high) {
      html +=
          "<p class=\"note fair\">For one end of the range the contact could not be solved; its "
          "place holds a dash.</p>\n";
    }
  }
  return html + sensitivities(assessment, band) +
         "<details><summary>Every region with soft, middle and stiff tissue</summary>" +
         band_table(contact, band) + "</details>\n";
}

std::string band_comparison(const AssessedProduct& first, const AssessedProduct& second) {
  const ContactResult& a = first.assessment.contact;
  const ContactResult& b = second.assessment.contact;
  if (!a.band || !b.band || !has_low(*a.band) || !has_low(*b.band) || !has_high(*a.band) ||
      !has_high(*b.band)) {
    return {};
  }
  const auto sentence = [](const std::string& what, const std::string& unit, double low,
                           double middle, double high) {
    const auto sign = [](double value) { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; };
    const auto shown_signed = [](double value) {
      return (value > 0.0 ? "+" : "") + short_number(value, 2);
    };
    const bool is_sure = sign(low) == sign(middle) && sign(middle) == sign(high);
    return what + " B \u2212 A is " + shown_signed(low) + " " + unit + " with soft, " +
           shown_signed(middle) + " with middle and " + shown_signed(high) + " with stiff tissue" +
           (is_sure ? ": the order does not depend on the skin."
                    : ": which is higher depends on the skin.");
  };
  const ContactBandRow& p = a.band->total;
  const ContactBandRow& q = b.band->total;
  return "<p><strong>Does the skin change the order?</strong> Both products meet the same skin. " +
         sentence("Force:", "N", q.force_low - p.force_low, b.total.force - a.total.force,
                  q.force_high - p.force_high) +
         " " +
         sentence("Peak on sensor cells:", "MPa",
                  q.peak_pressure_cells_low - p.peak_pressure_cells_low,
                  b.total.peak_pressure_cells - a.total.peak_pressure_cells,
                  q.peak_pressure_cells_high - p.peak_pressure_cells_high) +
         "</p>\n";
}

}  // namespace palmar
