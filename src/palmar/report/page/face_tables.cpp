// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/face_tables.h"

#include <algorithm>

#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/study/study_csv.h"
#include "palmar/report/study/study_sections.h"
#include "palmar/report/study/study_words.h"

namespace palmar {
namespace {

constexpr std::size_t kMostRows = 12;  // in the page; faces.csv holds all

std::size_t at(int i) { return static_cast<std::size_t>(i); }

const ProductFace& face_at(const Product& product, int face) {
  return product.faces->face[at(face)];
}

std::string row_head(const ProductFace& face) {
  const std::string part = face.part.empty() ? "" : html_escaped(face.part);
  return "<th scope=\"row\">" + html_escaped(capitalised(title_of(face))) +
         (part.empty() ? "" : "<br><span class=\"range\">" + part + "</span>") + "</th>";
}

std::string heads(const std::vector<std::string>& numbers) {
  std::string html = "<thead><tr><th scope=\"col\">Face</th>";
  for (const std::string& one : numbers) {
    html += "<th scope=\"col\" class=\"n\">" + html_escaped(one) + "</th>";
  }
  return html + "</tr></thead>";
}

std::string table(const std::string& caption, const std::string& head, const std::string& rows) {
  return "<div class=\"wide\"><table><caption>" + html_escaped(caption) + "</caption>" + head +
         "<tbody>" + rows + "</tbody></table></div>\n";
}

std::string percent(double share, int significant = 2) {
  return short_number(100.0 * share, significant) + " %";
}

std::string share_cell(const Proportion& one) {
  return "<td class=\"n\" data-value=\"" + exact_number(one.share) + "\">" + percent(one.share, 3) +
         "<br><span class=\"range\">" + short_number(100.0 * one.interval.low, 2) + " to " +
         short_number(100.0 * one.interval.high, 2) + " %</span></td>";
}

std::string peak_cell(const FaceSummary& one) {
  return "<td class=\"n\" data-value=\"" + exact_number(one.peak.mean) + "\">" +
         short_number(one.peak.mean) +
         (one.peak.n > 1 ? "<br><span class=\"range\">± " + short_number(one.peak.sd, 2) + "</span>"
                         : "") +
         "</td>";
}

/// Those with the product's peak in most hands first; among equals the higher peak.
std::vector<FaceSummary> by_peak(std::vector<FaceSummary> faces) {
  std::stable_sort(faces.begin(), faces.end(), [](const FaceSummary& a, const FaceSummary& b) {
    if (a.has_peak.count != b.has_peak.count) return a.has_peak.count > b.has_peak.count;
    return a.peak.mean > b.peak.mean;
  });
  return faces;
}

}  // namespace

std::string face_contact_table(const AssessedProduct& assessed) {
  const Product& product = assessed.product;
  if (product.faces == nullptr || assessed.assessment.faces.empty()) return {};
  std::string rows, words;
  for (const FaceContact& one : assessed.assessment.faces) {
    const ProductFace& face = face_at(product, one.face);
    if (one.has_peak) {
      words = "<p>Highest pressure on the product: " + html_escaped(title_of(face)) + ", " +
              short_number(one.peak_pressure, 2) + " MPa.</p>\n";
    }
    rows += "<tr>" + row_head(face) + number_cell(one.force) + number_cell(one.area) +
            number_cell(face.area) + number_cell(one.peak_pressure) +
            number_cell(one.mean_pressure) + "</tr>\n";
  }
  return "<h3>Faces of the product</h3>" + words +
         table(
             "What the hand does to each face. Pressures count per area of the product, where skin "
             "that bends covers less than when it is flat, so they can differ by some ten per cent "
             "from those on the skin.",
             heads({"Force, N", "Area under pressure, mm²", "Area of the face, mm²",
                    "Peak pressure, MPa", "Mean pressure, MPa"}),
             rows);
}

std::string face_words(const ProductFace& face, const FaceSummary* summary) {
  if (summary == nullptr) return title_of(face) + ": nobody touches it";
  return title_of(face) + ": peak " + short_number(summary->peak.mean, 2) + " MPa" +
         (summary->peak.n > 1 ? " in the mean" : "") + ", highest of the product in " +
         percent(summary->has_peak.share) + " of " + counted(summary->has_peak.n, "hand");
}

std::string face_words(const StudyPlan& plan, const Product& product,
                       const FaceStatistics& statistics) {
  const FaceSummary* hottest = hottest_face(statistics);
  if (hottest == nullptr || product.faces == nullptr) return {};
  return capitalised(plan.products[at(statistics.product)].name) + ": " +
         face_words(face_at(product, hottest->face), hottest) + ".";
}

std::vector<std::string> face_sentences(const StudyPlan& plan, const std::vector<Product>& products,
                                        const std::vector<FaceStatistics>& faces,
                                        const StudyCondition& condition) {
  std::vector<std::string> sentences;
  for (const FaceStatistics& one : faces) {
    if (!is_same(one.condition, condition)) continue;
    std::string words = face_words(plan, products[at(one.product)], one);
    if (!words.empty()) sentences.push_back(std::move(words));
  }
  return sentences;
}

std::string face_statistics_section(const StudyPlan& plan, const std::vector<Product>& products,
                                    const std::vector<FaceStatistics>& faces,
                                    const StudyCondition& condition, double threshold) {
  std::string html;
  for (const FaceStatistics& one : faces) {
    if (!is_same(one.condition, condition) || one.faces.empty()) continue;
    const Product& product = products[at(one.product)];
    std::string rows;
    std::size_t shown = 0;
    for (const FaceSummary& face : by_peak(one.faces)) {
      if (++shown > kMostRows) break;
      rows += "<tr>" + row_head(face_at(product, face.face)) + share_cell(face.has_peak) +
              share_cell(face.touched) + peak_cell(face) + number_cell(face.peak_p95) +
              number_cell(face.peak.max) + share_cell(face.above) +
              "<td class=\"n\" data-value=\"" + exact_number(face.force_share) + "\">" +
              percent(face.force_share, 3) + "</td></tr>\n";
    }
    const std::size_t rest = one.faces.size() - std::min(one.faces.size(), kMostRows);
    const std::size_t untouched = product.faces->face.size() - one.faces.size();
    std::string below;
    if (rest > 0) below += "Another " + std::to_string(rest) + " stand in faces.csv. ";
    if (untouched > 0) {
      below += "Of " + std::to_string(product.faces->face.size()) + " faces nobody touches " +
               std::to_string(untouched) + ".";
    }
    html +=
        "<p>" + html_escaped(face_words(plan, product, one)) + "</p>" +
        table("Faces of " + plan.products[at(one.product)].name + " over " +
                  counted(one.hands, "hand") +
                  " that hold it. Peaks: mean ± standard "
                  "deviation over the hands that touch the face. " +
                  below,
              heads({"Highest of the product in", "Touched by", "Peak, MPa", "95th percentile, MPa",
                     "Largest, MPa", "Peak above " + short_number(1000.0 * threshold, 2) + " kPa",
                     "Share of the force"}),
              rows);
  }
  return html.empty() ? html : "<h3>Faces of the products</h3>" + html;
}

CsvTable face_statistics_csv(const StudyPlan& plan, const std::vector<Product>& products,
                             const std::vector<FaceStatistics>& faces, double threshold) {
  CsvTable table;
  table.header = {"population",
                  "profile",
                  "setting",
                  "grip",
                  "product",
                  "face",
                  "title",
                  "name",
                  "part",
                  "kind",
                  "is_fillet",
                  "radius_mm",
                  "face_area_mm2",
                  "hands",
                  "touching",
                  "touched_share",
                  "touched_low_95",
                  "touched_high_95",
                  "has_peak",
                  "has_peak_share",
                  "has_peak_low_95",
                  "has_peak_high_95",
                  "threshold_mpa",
                  "above",
                  "above_share",
                  "above_low_95",
                  "above_high_95",
                  "peak_mean_mpa",
                  "peak_sd_mpa",
                  "peak_p95_mpa",
                  "peak_max_mpa",
                  "force_mean_n",
                  "force_share_mean",
                  "area_mean_mm2"};
  for (const FaceStatistics& one : faces) {
    const Product& product = products[at(one.product)];
    for (const FaceSummary& summary : one.faces) {
      const ProductFace& face = face_at(product, summary.face);
      std::vector<std::string> row = condition_cells(plan, one.condition);
      row.insert(row.end(),
                 {plan.products[at(one.product)].name, std::to_string(face.number), title_of(face),
                  face.name, face.part, name_of(face.kind), face.is_fillet ? "1" : "0",
                  exact_number(face.radius), exact_number(face.area), std::to_string(one.hands)});
      const auto add = [&](const Proportion& share) {
        row.insert(row.end(),
                   {std::to_string(share.count), exact_number(share.share),
                    exact_number(share.interval.low), exact_number(share.interval.high)});
      };
      add(summary.touched);
      add(summary.has_peak);
      row.push_back(exact_number(threshold));
      add(summary.above);
      for (const double value :
           {summary.peak.mean, summary.peak.sd, summary.peak_p95, summary.peak.max, summary.force,
            summary.force_share, summary.area}) {
        row.push_back(exact_number(value));
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace palmar
