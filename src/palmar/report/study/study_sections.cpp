// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_sections.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "palmar/report/chart/study_charts.h"
#include "palmar/report/page/face_tables.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/study/study_words.h"

namespace palmar {
namespace {

std::string head(const std::vector<std::pair<std::string, bool>>& cells) {
  std::string html = "<thead><tr>";
  for (const auto& [text, is_number] : cells) {
    html += std::string("<th scope=\"col\"") + (is_number ? " class=\"n\">" : ">") + text + "</th>";
  }
  return html + "</tr></thead>\n";
}

std::string table(const std::string& caption, const std::string& heading, const std::string& rows) {
  return "<div class=\"wide\"><table><caption>" + caption + "</caption>" + heading + "<tbody>" +
         rows + "</tbody></table></div>\n";
}

std::string cell(const std::string& text) { return "<td>" + html_escaped(text) + "</td>"; }
std::string count_cell(int count) { return "<td class=\"n\">" + std::to_string(count) + "</td>"; }

std::string product_head(const StudyPlan& plan, int product) {
  return "<th scope=\"row\"><span class=\"swatch\" style=\"background:" +
         hex_colour(product_colour(product)) + "\"></span>" +
         html_escaped(plan.products[static_cast<std::size_t>(product)].name) + "</th>";
}

std::string share_cell(const Proportion& one) {
  if (one.n == 0) return "<td class=\"n\">–</td>";
  return "<td class=\"n\" data-value=\"" + exact_number(one.share) + "\">" +
         short_number(100.0 * one.share) + " %<br><span class=\"range\">" +
         short_number(100.0 * one.interval.low, 2) + " to " +
         short_number(100.0 * one.interval.high, 2) + " %</span></td>";
}

std::string interval_cell(double value, const Interval& interval) {
  return "<td class=\"n\" data-value=\"" + exact_number(value) + "\">" + short_number(value) +
         "<br><span class=\"range\">" + short_number(interval.low) + " to " +
         short_number(interval.high) + "</span></td>";
}

std::string mean_cell(const QuantitySummary* one) {
  if (one == nullptr) return "<td class=\"n\">–</td>";
  return "<td class=\"n\" data-value=\"" + exact_number(one->summary.mean) + "\">" +
         short_number(one->summary.mean) + "<br><span class=\"range\">± " +
         short_number(one->summary.sd, 2) + "</span></td>";
}

std::string heading_of(const StudyQuantity& quantity) {
  return html_escaped(capitalised(quantity.name) +
                      (quantity.unit.empty() ? "" : ", " + quantity.unit));
}

std::string badge(DifferenceVerdict verdict) {
  switch (verdict) {
    case DifferenceVerdict::kShown:
      return "<span class=\"badge good\">differ</span>";
    case DifferenceVerdict::kNotShown:
      return "<span class=\"badge fair\">not shown</span>";
    case DifferenceVerdict::kNone:
      return "<span class=\"badge fair\">no difference</span>";
    case DifferenceVerdict::kTooFewPairs:
      break;
  }
  return "<span class=\"badge bad\">too few hands</span>";
}

std::string comparison_table(const StudyPage& page, const ConditionAnalysis& one) {
  const StudyPlan& plan = page.results.plan;
  if (plan.products.size() < 2) return {};
  std::string rows;
  for (const std::string& key : main_quantities()) {
    const QuantityComparison* comparison = comparison_of(one, key);
    if (comparison == nullptr) continue;
    for (const ProductPair& pair : comparison->pairs) {
      const std::string left_out = left_out_words(plan, pair);
      rows +=
          "<tr><th scope=\"row\">" + heading_of(comparison->quantity) + "</th>" +
          cell(plan.products[static_cast<std::size_t>(pair.second)].name + " − " +
               plan.products[static_cast<std::size_t>(pair.first)].name) +
          "<td class=\"n\">" + std::to_string(pair.pairs) + " of " + std::to_string(pair.hands) +
          (left_out.empty() ? ""
                            : "<br><span class=\"range\">" + html_escaped(left_out) + "</span>") +
          "</td>";
      if (pair.verdict == DifferenceVerdict::kTooFewPairs) {
        rows += "<td colspan=\"4\"></td><td>" + badge(pair.verdict) + "</td></tr>\n";
        continue;
      }
      rows += interval_cell(pair.t_test.difference, pair.t_test.interval) +
              interval_cell(pair.t_test.effect_size, pair.t_test.effect_interval) +
              "<td class=\"n\" data-value=\"" + exact_number(pair.t_p_holm) + "\">" +
              html_escaped(p_words(pair.t_p_holm)) + "</td><td class=\"n\" data-value=\"" +
              exact_number(pair.wilcoxon_p_holm) + "\">" +
              html_escaped(p_words(pair.wilcoxon_p_holm)) + "</td><td>" + badge(pair.verdict) +
              "</td></tr>\n";
    }
  }
  return table(
      "Products over the same hands. Differences are second minus first, with 95 % "
      "intervals; p values are corrected after Holm over the pairs of a quantity.",
      head({{"Quantity", false},
            {"Pair", false},
            {"Hands", true},
            {"Difference", true},
            {"Cohen’s dz", true},
            {"t-test", true},
            {"Wilcoxon", true},
            {"Verdict", false}}),
      rows);
}

std::string region_table(const StudyPage& page, const ConditionAnalysis& one) {
  std::set<Region> regions;
  for (const ProductStatistics& product : one.products) {
    for (const RegionSummary& region : product.regions) regions.insert(region.region);
  }
  if (regions.empty()) return {};
  std::vector<std::pair<std::string, bool>> heads = {{"Region", false}};
  for (const StudyProduct& product : page.results.plan.products) {
    heads.emplace_back(html_escaped(product.name), true);
  }
  std::string rows;
  for (const Region region : regions) {
    rows += "<tr><th scope=\"row\">" + html_escaped(capitalised(plain_words(region))) + "</th>";
    for (const ProductStatistics& product : one.products) {
      const auto found =
          std::find_if(product.regions.begin(), product.regions.end(),
                       [&](const RegionSummary& summary) { return summary.region == region; });
      if (found == product.regions.end()) {
        rows += "<td class=\"n\">–</td>";
        continue;
      }
      rows += "<td class=\"n\" data-value=\"" + exact_number(found->force) + "\">" +
              short_number(found->force) + " N<br><span class=\"range\">" +
              short_number(found->area) + " mm², " + short_number(found->peak_pressure_cells) +
              " MPa, " + counted(found->touching, "hand") + "</span></td>";
    }
    rows += "</tr>\n";
  }
  return "<details><summary>Regions of the hand</summary>" +
         table(
             "Mean force; below: mean area, mean of the peaks on sensor cells, hands that touch. "
             "Hands that don’t touch with a region count with 0.",
             head(heads), rows) +
         "</details>\n";
}

std::string exclusion_words_of(const Exclusion& one) {
  std::string words;
  for (const auto& [cause, share] : one.causes) {
    if (cause == ExclusionCause::kNone || share.count == 0) continue;
    words += (words.empty() ? "" : ", ") + std::to_string(share.count) + " " + words_of(cause);
  }
  if (one.unknown > 0) {
    words += (words.empty() ? "" : ", ") + std::to_string(one.unknown) + " without an answer";
  }
  return words.empty() ? "nobody" : words;
}

std::string accommodation_table(const StudyPage& page, const ConditionAnalysis& one) {
  const StudyPlan& plan = page.results.plan;
  std::string rows;
  for (std::size_t p = 0; p < one.accommodation.size(); ++p) {
    const Accommodation& a = one.accommodation[p];
    std::string causes;
    for (const OutsideCause& cause : a.causes) {
      causes += (causes.empty() ? "" : ", ") + std::to_string(cause.hands) + " " +
                cause_words(cause.cause);
    }
    if (a.not_run > 0) {
      causes += (causes.empty() ? "" : ", ") + std::to_string(a.not_run) + " not run";
    }
    std::string lengths = "–";
    if (a.shortest_outside) {
      lengths = short_number(*a.shortest_outside) + " to " + short_number(*a.longest_outside);
    }
    rows += "<tr>" + product_head(plan, a.product) + share_cell(a.in_hand) + share_cell(a.inside) +
            cell(causes.empty() ? "nobody" : causes) + "<td class=\"n\">" + lengths + "</td>" +
            share_cell(one.exclusion[p].excluded) + cell(exclusion_words_of(one.exclusion[p])) +
            "</tr>\n";
  }
  std::string limits;
  for (const StudyLimit& limit : plan.limits) {
    limits += (limits.empty() ? "" : "; ") + words_of(page.results, limit);
  }
  std::string nails;
  if (plan.profiles[static_cast<std::size_t>(one.condition.profile)].nail_length > 0.0) {
    nails =
        "<p>Exclusion by nails is an upper bound: hands close as if they had no nails, and a "
        "person "
        "with long ones holds a product otherwise.</p>\n";
  }
  return "<h3>Who is left out</h3><p>Limits: " +
         html_escaped(limits.empty() ? "none stated, so inside means held" : limits) + ".</p>" +
         table(
             "Shares of hands with 95 % intervals after Wilson. Excluded: can’t hold the product "
             "by the person’s own range, strength and nails.",
             head({{"Product", false},
                   {"In the hand", true},
                   {"Inside the limits", true},
                   {"Outside because of", false},
                   {"Their hand length, mm", true},
                   {"Excluded", true},
                   {"Because of", false}}),
             rows) +
         nails;
}

std::string size_sections(const StudyPage& page, const ConditionAnalysis& one) {
  const StudyPlan& plan = page.results.plan;
  std::string html;
  for (const ProductSizes& family : one.sizes) {
    std::string rows;
    for (const SizeChoice& choice : family.choices) {
      std::string sizes;
      for (const ServedBySize& size : choice.sizes) {
        std::string who = "nobody by length alone";
        if (size.is_taken) {
          who = size.from && size.to
                    ? short_number(*size.from) + " to " + short_number(*size.to) + " mm"
                : size.from ? "from " + short_number(*size.from) + " mm"
                : size.to   ? "up to " + short_number(*size.to) + " mm"
                            : "everybody";
        }
        sizes += (sizes.empty() ? "" : "<br>") +
                 html_escaped(plan.products[static_cast<std::size_t>(size.product)].name) + ": " +
                 who + " <span class=\"range\">(serves " + std::to_string(size.inside) + ", " +
                 std::to_string(size.alone) + " of them alone)</span>";
      }
      rows += "<tr><th scope=\"row\">" + std::to_string(choice.sizes.size()) + "</th><td>" + sizes +
              "</td>" + share_cell(choice.served) + share_cell(choice.served_by_length) + "</tr>\n";
    }
    html += "<h3>Sizes of " + html_escaped(family.family) + "</h3>" +
            table("The best one, two and three sizes for " + counted(family.hands, "hand") +
                      ", and who takes which by hand length.",
                  head({{"Sizes", false},
                        {"Which, and for whom", false},
                        {"Served if all are tried on", true},
                        {"Served by hand length", true}}),
                  rows);
  }
  return html;
}

std::string dependence_table(const StudyPage& page, const ConditionAnalysis& one) {
  const StudyPlan& plan = page.results.plan;
  std::string rows;
  for (const std::string& key : main_quantities()) {
    const QuantityComparison* comparison = comparison_of(one, key);
    if (comparison == nullptr) continue;
    for (std::size_t p = 0; p < plan.products.size(); ++p) {
      for (const HandDimension dimension : {kHandLength, kHandCircumference}) {
        const auto found =
            size_dependence(page.results, one.condition, static_cast<int>(p), key, dimension);
        if (!found) continue;
        const Coefficient& slope = found->fit.slopes.front();
        rows += "<tr><th scope=\"row\">" + heading_of(comparison->quantity) + "</th>" +
                cell(plan.products[p].name) +
                cell(dimension == kHandLength ? "length" : "circumference") +
                number_cell(slope.estimate) + number_cell(found->fit.r2, 2) +
                number_cell(found->rank_correlation, 2) + "<td class=\"n\" data-value=\"" +
                exact_number(slope.p_value) + "\">" + html_escaped(p_words(slope.p_value)) +
                "</td>" + count_cell(found->fit.n) + "</tr>\n";
      }
    }
  }
  if (rows.empty()) return {};
  return "<details><summary>How it goes with the size of the hand</summary>" +
         table(
             "Linear regression of a quantity on hand length or circumference; not corrected for "
             "the number of tests.",
             head({{"Quantity", false},
                   {"Product", false},
                   {"Hand", false},
                   {"Slope per mm", true},
                   {"R²", true},
                   {"Rank correlation", true},
                   {"p of the slope", true},
                   {"Hands", true}}),
             rows) +
         "</details>\n";
}

}  // namespace

std::string number_cell(std::optional<double> value, int significant) {
  if (!value) return "<td class=\"n\">–</td>";
  return "<td class=\"n\" data-value=\"" + exact_number(*value) + "\">" +
         short_number(*value, significant) + "</td>";
}

std::string summary_section(const StudyPage& page) {
  const StudyPlan& plan = page.results.plan;
  std::string html = "<h2 class=\"first\" id=\"summary\">Verdict</h2>\n<ul class=\"plain\">";
  const ConditionAnalysis& first = page.analysis.conditions.front();
  for (const std::string& sentence : study_verdict(page.results, page.analysis)) {
    html += "<li>" + html_escaped(sentence) + "</li>";
  }
  for (const std::string& sentence :
       face_sentences(plan, page.products, page.faces, first.condition)) {
    html += "<li>" + html_escaped(sentence) + "</li>";
  }
  html += "</ul>\n";
  const auto outside = std::count_if(page.warnings.begin(), page.warnings.end(),
                                     [](const StudyWarning& one) { return one.is_outside; });
  if (!page.warnings.empty()) {
    html += std::string("<div class=\"note ") + (outside > 0 ? "bad" : "fair") + "\"><strong>" +
            (outside > 0 ? "Warning: partly outside what was checked, or hands are missing."
                         : "To be careful with.") +
            "</strong><ul class=\"plain\">";
    for (const StudyWarning& one : page.warnings) {
      html += "<li><strong>" + html_escaped(one.subject) + ":</strong> " + html_escaped(one.text) +
              "</li>";
    }
    html += "</ul></div>\n";
  }
  std::string rows;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    const ProductStatistics& one = first.products[p];
    rows += "<tr>" + product_head(plan, static_cast<int>(p)) + "<td class=\"n\">" +
            std::to_string(one.outcomes.in_hand()) + " of " + std::to_string(one.outcomes.hands()) +
            "</td>";
    for (const std::string& key : main_quantities()) rows += mean_cell(summary_of(one, key));
    rows += mean_cell(summary_of(one, "grip_force_n"));
    rows += share_cell(first.accommodation[p].inside) + "</tr>\n";
  }
  return html + table("Mean ± standard deviation over the hands that hold the product" +
                          std::string(page.analysis.conditions.size() > 1
                                          ? ": " + html_escaped(title_of(plan, first.condition))
                                          : "") +
                          ".",
                      head({{"Product", false},
                            {"Hands", true},
                            {"Peak on sensor cells, MPa", true},
                            {"Peak at a vertex, MPa", true},
                            {"Mean pressure, MPa", true},
                            {"Contact area, mm²", true},
                            {"Sum of normal forces, N", true},
                            {"Grip force, N", true},
                            {plan.limits.empty() ? "Held" : "Inside the limits", true}}),
                      rows);
}

std::string condition_tables(const StudyPage& page, const ConditionAnalysis& one) {
  return comparison_table(page, one) + accommodation_table(page, one) + size_sections(page, one) +
         dependence_table(page, one) + region_table(page, one) + quantity_table(page, one);
}

std::string quantity_table(const StudyPage& page, const ConditionAnalysis& one) {
  std::vector<std::pair<std::string, bool>> heads = {{"Quantity", false}};
  for (const StudyProduct& product : page.results.plan.products) {
    heads.emplace_back(html_escaped(product.name), true);
  }
  std::string rows;
  for (const StudyQuantity& quantity : page.analysis.quantities) {
    rows += "<tr><th scope=\"row\">" + heading_of(quantity) + "<br><code>" +
            html_escaped(quantity.key) + "</code></th>";
    for (const ProductStatistics& product : one.products) {
      const QuantitySummary* summary = summary_of(product, quantity.key);
      if (summary == nullptr) {
        rows += "<td class=\"n\">–</td>";
        continue;
      }
      rows += "<td class=\"n\" data-value=\"" + exact_number(summary->summary.mean) + "\">" +
              short_number(summary->summary.mean) + " ± " + short_number(summary->summary.sd, 2) +
              "<br><span class=\"range\">" +
              (has_percentiles(*summary) ? short_number(summary->p5) + " · " : "") +
              short_number(summary->summary.median) +
              (has_percentiles(*summary) ? " · " + short_number(summary->p95) : "") + " (" +
              std::to_string(summary->summary.n) + ")</span></td>";
    }
    rows += "</tr>\n";
  }
  return "<details><summary>All quantities and indices</summary>" +
         table(
             "Mean ± standard deviation; below: 5th percentile, median, 95th percentile "
             "(hands); below five hands the median alone.",
             head(heads), rows) +
         "</details>\n";
}

}  // namespace palmar
