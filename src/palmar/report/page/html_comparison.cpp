// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/html_comparison.h"

#include <algorithm>
#include <map>

#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/page/error_band.h"
#include "palmar/report/page/html_tables.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/page/pressure_limits.h"
#include "palmar/report/picture/image.h"

namespace palmar {

namespace {

constexpr int kThumbnailWidth = 440;  // pixels; the full pictures stand further down

std::string thumbnail(const std::vector<EncodedPicture>& pictures, const std::string& name) {
  const auto found = std::find_if(pictures.begin(), pictures.end(),
                                  [&](const EncodedPicture& one) { return one.name == name; });
  if (found == pictures.end()) return {};
  const Image small = narrowed(decode_png(found->png), kThumbnailWidth);
  return "<img src=\"data:image/png;base64," + base64(encode_png(small, PngEffort::kSmall)) +
         "\" alt=\"" + html_escaped(found->alt) + "\">";
}

std::string figure(const std::string& name, double value, const std::string& unit) {
  return "<div><dt>" + name + "</dt><dd>" + short_number(value) + " " + unit + "</dd></div>";
}

std::string card(const AssessedProduct& one, const std::vector<EncodedPicture>& pictures,
                 std::size_t index) {
  const GraspStatus status = one.assessment.grasp.status;
  std::string html = "<div class=\"card\"><h4><a href=\"#product-" + std::to_string(index) + "\">" +
                     html_escaped(one.product.name) + "</a> <span class=\"badge " +
                     status_class(one.assessment) + "\">" + html_escaped(plain_words(status)) +
                     "</span></h4>";
  if (!is_in_hand(one.assessment)) {
    // Seen from the palm's side, what is too large would hide the hand.
    return html + thumbnail(pictures, "grasp_back") +
           "<p>Not in the hand: no forces or pressures to compare.</p></div>";
  }
  html += thumbnail(pictures, "map_open_hand") + thumbnail(pictures, "grasp_palm");
  const RegionContact& total = one.assessment.contact.total;
  return html + "<dl>" + figure("Force", total.force, "N") +
         figure("Contact area", total.area, "mm\u00b2") +
         figure("Peak on sensor cells", total.peak_pressure_cells, "MPa") +
         figure("Peak at one vertex", total.peak_pressure, "MPa") + "</dl></div>";
}

std::string difference_cells(double first, double second) {
  const double difference = second - first;
  return "<td class=\"n\">" + short_number(first) + "</td><td class=\"n\">" + short_number(second) +
         "</td><td class=\"n\" data-value=\"" + exact_number(difference) + "\">" +
         (difference > 0.0 ? "+" : "") + short_number(difference) + "</td>";
}

// Region by region: the first product, the second, and second minus first.
std::string difference_table(const AssessedProduct& first, const AssessedProduct& second) {
  struct Pair {
    RegionContact first, second;  // zeros where it isn't touched
  };
  std::map<Region, Pair> regions;
  for (const RegionContact& one : first.assessment.contact.regions) regions[one.region].first = one;
  for (const RegionContact& one : second.assessment.contact.regions) {
    regions[one.region].second = one;
  }
  const auto row = [](const std::string& name, const Pair& pair) {
    return "<th scope=\"row\">" + html_escaped(name) + "</th>" +
           difference_cells(pair.first.force, pair.second.force) +
           difference_cells(pair.first.area, pair.second.area) +
           difference_cells(pair.first.peak_pressure_cells, pair.second.peak_pressure_cells) +
           "</tr>";
  };
  std::string html =
      "<div class=\"wide\"><table id=\"difference\"><caption>Difference by region: A is " +
      html_escaped(first.product.name) + ", B is " + html_escaped(second.product.name) +
      "; B \u2212 A above 0 means that B presses more</caption><thead><tr><th rowspan=\"2\" "
      "scope=\"col\">Region</th><th colspan=\"3\" scope=\"colgroup\">Force, N</th><th "
      "colspan=\"3\" scope=\"colgroup\">Area, mm\u00b2</th><th colspan=\"3\" "
      "scope=\"colgroup\">Peak on cells, MPa</th></tr><tr>";
  for (int i = 0; i < 3; ++i) {
    html +=
        "<th class=\"n\" scope=\"col\">A</th><th class=\"n\" scope=\"col\">B</th><th class=\"n\" "
        "scope=\"col\">B \u2212 A</th>";
  }
  html += "</tr></thead><tbody>";
  for (const auto& [region, pair] : regions) {
    html += "<tr data-region=\"" + std::string(name_of(region)) + "\">" +
            row(plain_words(region), pair);
  }
  html += "<tr class=\"total\" data-region=\"total\">" +
          row("Whole hand", {first.assessment.contact.total, second.assessment.contact.total});
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string comparison(const AssessmentSet& set,
                       const std::vector<std::vector<EncodedPicture>>& pictures) {
  const auto& all = set.assessments;
  if (all.size() < 2) return {};
  std::string html = "<h3 id=\"comparison\">Side by side</h3>\n<div class=\"cards\">";
  for (std::size_t i = 0; i < all.size(); ++i) html += card(all[i], pictures.at(i), i);
  html += "</div>\n";
  if (all.size() == 2 && is_in_hand(all[0].assessment) && is_in_hand(all[1].assessment)) {
    html += difference_table(all[0], all[1]) + band_comparison(all[0], all[1]);
  }
  return html;
}

}  // namespace palmar
