// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_csv.h"

#include "palmar/geometry/degrees.h"
#include "palmar/report/chart/study_figures.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"
#include "palmar/study/statistics/study_holds.h"

namespace palmar::report {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::string text(double value) { return exact_number(value); }
std::string text(const std::optional<double>& value) { return value ? exact_number(*value) : ""; }
std::string count(int value) { return std::to_string(value); }

using Row = std::vector<std::string>;

/// The columns that every table begins with.
const Row kConditionHeader = {"population", "profile", "setting", "grip"};
Row joined(Row first, const Row& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

template <class Visit>
records::CsvTable table_of(const study::StudyResults& results, const study::StudyAnalysis& analysis,
                           const Row& header, Visit&& visit) {
  records::CsvTable table{joined(kConditionHeader, header), {}};
  for (const study::ConditionAnalysis& one : analysis.conditions) {
    const Row cells = condition_cells(results.plan, one.condition);
    visit(one, [&](const Row& row) { table.rows.push_back(joined(cells, row)); });
  }
  return table;
}

records::CsvTable statistics_table(const study::StudyResults& results,
                                   const study::StudyAnalysis& analysis) {
  return table_of(
      results, analysis,
      {"product", "quantity", "unit", "n", "mean", "sd", "mean_low_95", "mean_high_95", "min", "p5",
       "p25", "median", "p75", "p95", "max"},
      [&](const study::ConditionAnalysis& one, const auto& add) {
        for (const study::ProductStatistics& product : one.products) {
          for (const study::QuantitySummary& q : product.quantities) {
            const statistics::Summary& s = q.summary;
            const auto& ci = s.mean_interval;
            add({results.plan.products[at(product.product)].name, q.quantity.key, q.quantity.unit,
                 count(s.n), text(s.mean), text(s.sd), ci ? text(ci->low) : "",
                 ci ? text(ci->high) : "", text(s.min), text(q.p5), text(s.lower_quartile),
                 text(s.median), text(s.upper_quartile), text(q.p95), text(s.max)});
          }
        }
      });
}

records::CsvTable outcome_table(const study::StudyResults& results,
                                const study::StudyAnalysis& analysis) {
  Row header = {"product"};
  for (int k = 0; k < study::kStudyOutcomes; ++k) {
    header.push_back(name_of(static_cast<study::StudyOutcome>(k)));
  }
  header.insert(header.end(), {"not_run", "not_at_rest"});
  return table_of(results, analysis, header,
                  [&](const study::ConditionAnalysis& one, const auto& add) {
                    for (const study::ProductStatistics& product : one.products) {
                      Row row = {results.plan.products[at(product.product)].name};
                      for (const int hands : product.outcomes.of) row.push_back(count(hands));
                      row.push_back(count(product.outcomes.not_run));
                      row.push_back(count(product.unbalanced));
                      add(row);
                    }
                  });
}

records::CsvTable holds_table(const study::StudyResults& results,
                              const study::StudyAnalysis& analysis) {
  return table_of(results, analysis,
                  {"product", "hands", "part", "part_name", "part_kind", "held_in", "along",
                   "toward", "turn_deg", "hold"},
                  [&](const study::ConditionAnalysis& one, const auto& add) {
                    for (const study::ProductStatistics& product : one.products) {
                      const std::string& name = results.plan.products[at(product.product)].name;
                      for (const study::HandsByHold& held :
                           study::holds_of(results, one.condition, product.product)) {
                        if (!held.hold) {
                          add({name, count(held.hands), "", "", "", "", "", "", "", ""});
                          continue;
                        }
                        const grasp::Hold& hold = held.hold->hold;
                        add({name, count(held.hands), count(hold.part), hold.part_name,
                             held.hold->kind ? name_of(*held.hold->kind) : "",
                             std::string(name_of(hold.grip)), text(hold.along), count(hold.toward),
                             text(hold.turn * geometry::kDegreesPerRadian), held.hold->words});
                      }
                    }
                  });
}

records::CsvTable accommodation_table(const study::StudyResults& results,
                                      const study::StudyAnalysis& analysis) {
  return table_of(
      results, analysis,
      {"product", "criterion", "hands", "of", "share", "share_low_95", "share_high_95", "causes"},
      [&](const study::ConditionAnalysis& one, const auto& add) {
        for (std::size_t p = 0; p < one.accommodation.size(); ++p) {
          const study::Accommodation& a = one.accommodation[p];
          const std::string& product = results.plan.products[p].name;
          const auto row = [&](const std::string& criterion, const statistics::Proportion& share,
                               const std::string& causes) {
            add({product, criterion, count(share.count), count(share.n), text(share.share),
                 text(share.interval.low), text(share.interval.high), causes});
          };
          std::string causes;
          for (const study::OutsideCause& cause : a.causes) {
            causes += (causes.empty() ? "" : "; ") + count(cause.hands) + " " + cause.cause;
          }
          row("in the hand", a.in_hand, "");
          for (std::size_t k = 0; k < a.inside_limit.size(); ++k) {
            row(words_of(results, results.plan.limits[k]), a.inside_limit[k], "");
          }
          row("inside all limits", a.inside, causes);
          const study::Exclusion& exclusion = one.exclusion[p];
          row("excluded", exclusion.excluded, "");
          for (const auto& [cause, share] : exclusion.causes) {
            if (cause != study::ExclusionCause::kNone)
              row("excluded by " + name_of(cause), share, "");
          }
        }
      });
}

records::CsvTable region_table_of(const study::StudyResults& results,
                                  const study::StudyAnalysis& analysis) {
  return table_of(results, analysis,
                  {"product", "region", "hands", "touching", "force_mean_n", "force_sd_n",
                   "area_mean_mm2", "peak_pressure_cells_mean_mpa", "peak_pressure_cells_max_mpa"},
                  [&](const study::ConditionAnalysis& one, const auto& add) {
                    for (const study::ProductStatistics& product : one.products) {
                      for (const study::RegionSummary& r : product.regions) {
                        add({results.plan.products[at(product.product)].name,
                             std::string(name_of(r.region)), count(product.outcomes.in_hand()),
                             count(r.touching), text(r.force), text(r.force_sd), text(r.area),
                             text(r.peak_pressure_cells), text(r.largest_peak_cells)});
                      }
                    }
                  });
}

records::CsvTable dependence_table(const study::StudyResults& results,
                                   const study::StudyAnalysis& analysis) {
  return table_of(
      results, analysis,
      {"product", "quantity", "unit", "size", "n", "intercept", "slope_per_mm", "slope_p", "r2",
       "residual_sd", "rank_correlation"},
      [&](const study::ConditionAnalysis& one, const auto& add) {
        for (const study::ProductStatistics& product : one.products) {
          for (const study::StudyQuantity& q : analysis.quantities) {
            for (const hand::HandDimension dimension :
                 {study::kHandLength, study::kHandCircumference}) {
              const auto found =
                  study::size_dependence(results, one.condition, product.product, q.key, dimension);
              if (!found) continue;
              const statistics::LinearFit& fit = found->fit;
              add({results.plan.products[at(product.product)].name, q.key, q.unit,
                   name_of(dimension) + "_mm", count(fit.n), text(fit.intercept.estimate),
                   text(fit.slopes.front().estimate), text(fit.slopes.front().p_value),
                   text(fit.r2), text(fit.residual_sd), text(found->rank_correlation)});
            }
          }
        }
      });
}

records::CsvTable size_table(const study::StudyResults& results,
                             const study::StudyAnalysis& analysis) {
  return table_of(
      results, analysis,
      {"family", "sizes", "product", "hand_length_from_mm", "hand_length_to_mm", "taken_by_length",
       "inside", "inside_alone", "hands", "share_served", "share_served_low_95",
       "share_served_high_95", "share_served_by_length"},
      [&](const study::ConditionAnalysis& one, const auto& add) {
        for (const study::ProductSizes& family : one.sizes) {
          for (const study::SizeChoice& choice : family.choices) {
            for (const study::ServedBySize& size : choice.sizes) {
              add({family.family, count(static_cast<int>(choice.sizes.size())),
                   results.plan.products[at(size.product)].name, text(size.from), text(size.to),
                   size.is_taken ? "1" : "0", count(size.inside), count(size.alone),
                   count(family.hands), text(choice.served.share), text(choice.served.interval.low),
                   text(choice.served.interval.high), text(choice.served_by_length.share)});
            }
          }
        }
      });
}

}  // namespace

std::vector<std::string> condition_cells(const study::StudyPlan& plan,
                                         const study::StudyCondition& one) {
  const std::optional<grasp::Grip>& grip = plan.grips[at(one.grip)];
  return {one.population ? plan.populations[at(*one.population)].population.name : "all",
          plan.profiles[at(one.profile)].name, plan.settings[at(one.setting)].name,
          grip ? std::string(name_of(*grip)) : "auto"};
}

records::CsvTable comparison_csv(const study::StudyResults& results,
                                 const study::StudyAnalysis& analysis, const std::string& key) {
  const study::StudyPlan& plan = results.plan;
  return table_of(
      results, analysis,
      {"quantity",
       "unit",
       "first",
       "second",
       "hands",
       "pairs",
       "left_out",
       "mean_first",
       "mean_second",
       "difference",
       "difference_low_95",
       "difference_high_95",
       "t",
       "df",
       "t_p",
       "t_p_holm",
       "wilcoxon_v",
       "wilcoxon_p",
       "wilcoxon_p_holm",
       "cohen_dz",
       "cohen_dz_low_95",
       "cohen_dz_high_95",
       "verdict"},
      [&](const study::ConditionAnalysis& one, const auto& add) {
        for (const study::QuantityComparison& comparison : one.comparisons) {
          if (!key.empty() && comparison.quantity.key != key) continue;
          for (const study::ProductPair& pair : comparison.pairs) {
            const bool is_tested = pair.verdict != study::DifferenceVerdict::kTooFewPairs;
            const auto tested = [&](double value) { return is_tested ? text(value) : ""; };
            const statistics::PairedTest& t = pair.t_test;
            add({comparison.quantity.key,
                 comparison.quantity.unit,
                 plan.products[at(pair.first)].name,
                 plan.products[at(pair.second)].name,
                 count(pair.hands),
                 count(pair.pairs),
                 left_out_words(plan, pair),
                 pair.pairs > 0 ? text(pair.mean_first) : "",
                 pair.pairs > 0 ? text(pair.mean_second) : "",
                 tested(t.difference),
                 tested(t.interval.low),
                 tested(t.interval.high),
                 tested(t.t),
                 tested(t.df),
                 tested(t.p_value),
                 tested(pair.t_p_holm),
                 tested(pair.wilcoxon.v),
                 tested(pair.wilcoxon.p_value),
                 tested(pair.wilcoxon_p_holm),
                 tested(t.effect_size),
                 tested(t.effect_interval.low),
                 tested(t.effect_interval.high),
                 name_of(pair.verdict)});
          }
        }
      });
}

std::vector<NamedTable> study_csv(const study::StudyResults& results,
                                  const study::StudyAnalysis& analysis) {
  return {{"statistics.csv", statistics_table(results, analysis),
           "One quantity of one product under one condition, over the hands that hold it."},
          {"comparison.csv", comparison_csv(results, analysis),
           "One quantity of two products over the same hands."},
          {"accommodation.csv", accommodation_table(results, analysis),
           "How many hands a product suits, and whom it leaves out."},
          {"outcomes.csv", outcome_table(results, analysis), "How the grasps of a product ended."},
          {"holds.csv", holds_table(results, analysis), "By which part and how a product is held."},
          {"regions.csv", region_table_of(results, analysis),
           "One region of the hand, mean over the hands that hold the product."},
          {"size_dependence.csv", dependence_table(results, analysis),
           "How a quantity depends on the size of the hand."},
          {"sizes.csv", size_table(results, analysis),
           "Which sizes of a product serve how many hands."}};
}

}  // namespace palmar::report
