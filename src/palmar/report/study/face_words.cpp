// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/face_words.h"

#include "palmar/report/study/study_csv.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"

namespace palmar::report {
namespace {

std::size_t as_size(int i) { return static_cast<std::size_t>(i); }

const product::ProductFace& face_at(const product::Product& product, int face) {
  return product.faces->face[as_size(face)];
}

std::string percent(double share) { return short_number(100.0 * share, 2) + " %"; }

}  // namespace

std::string face_words(const product::ProductFace& face, const study::FaceSummary* summary) {
  if (summary == nullptr) return title_of(face) + ": nobody touches it";
  return title_of(face) + ": peak " + short_number(summary->peak.mean, 2) + " MPa" +
         (summary->peak.n > 1 ? " in the mean" : "") + ", highest of the product in " +
         percent(summary->has_peak.share) + " of " + counted(summary->has_peak.n, "hand");
}

std::string face_words(const study::StudyPlan& plan, const product::Product& product,
                       const study::FaceStatistics& statistics) {
  const study::FaceSummary* hottest = study::hottest_face(statistics);
  if (hottest == nullptr || product.faces == nullptr) return {};
  return capitalised(plan.products[as_size(statistics.product)].name) + ": " +
         face_words(face_at(product, hottest->face), hottest) + ".";
}

std::vector<std::string> face_sentences(const study::StudyPlan& plan,
                                        const std::vector<product::Product>& products,
                                        const std::vector<study::FaceStatistics>& faces,
                                        const study::StudyCondition& condition) {
  std::vector<std::string> sentences;
  for (const study::FaceStatistics& one : faces) {
    if (!study::is_same(one.condition, condition)) continue;
    std::string words = face_words(plan, products[as_size(one.product)], one);
    if (!words.empty()) sentences.push_back(std::move(words));
  }
  return sentences;
}

records::CsvTable face_statistics_csv(const study::StudyPlan& plan,
                                      const std::vector<product::Product>& products,
                                      const std::vector<study::FaceStatistics>& faces,
                                      double threshold) {
  records::CsvTable table;
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
  for (const study::FaceStatistics& one : faces) {
    const product::Product& product = products[as_size(one.product)];
    for (const study::FaceSummary& summary : one.faces) {
      const product::ProductFace& face = face_at(product, summary.face);
      std::vector<std::string> row = condition_cells(plan, one.condition);
      row.insert(row.end(), {plan.products[as_size(one.product)].name, std::to_string(face.number),
                             title_of(face), face.name, face.part, name_of(face.kind),
                             face.is_fillet ? "1" : "0", exact_number(face.radius),
                             exact_number(face.area), std::to_string(one.hands)});
      const auto add = [&](const statistics::Proportion& share) {
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

}  // namespace palmar::report
