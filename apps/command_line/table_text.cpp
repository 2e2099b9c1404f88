// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "table_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace palmar::cli {
namespace {

template <typename Result>
std::string heading(const records::TableResults<Result>& results,
                    const typename records::TableResults<Result>::Group& group) {
  const std::string people =
      fmt::format("{} {}", group.subjects, group.subjects == 1 ? "subject" : "subjects");
  if (results.by.empty()) return people + "\n";
  return fmt::format("{} {}: {}\n", results.by, group.name, people);
}

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// 1.234 + 0.567 hand_length - 0.01 hand_width
std::string equation(const population::TableRegression& r) {
  std::string text = fmt::format("{:.3f}", r.fit.intercept.estimate);
  for (std::size_t k = 0; k < r.predictors.size(); ++k) {
    const double slope = r.fit.slopes[k].estimate;
    text += fmt::format(" {} {:.5f} {}", slope < 0.0 ? "-" : "+", std::abs(slope), r.predictors[k]);
  }
  return text;
}

}  // namespace

std::string descriptions_text(const records::Descriptions& descriptions) {
  std::string text;
  for (const auto& group : descriptions.groups) {
    std::size_t width = 10;
    for (const population::ColumnDescription& d : group.result) {
      width = std::max(width, d.name.size() + d.unit.size() + 2);
    }
    text += (text.empty() ? "" : "\n") + heading(descriptions, group);
    text += fmt::format("{:<{}} {:>6} {:>7} {:>8} {:>7}", "dimension", width, "n", "missing",
                        "mean", "sd");
    text += fmt::format(" {:>7}", "min");
    for (const double p : population::kTablePercentiles)
      text += fmt::format(" {:>7}", fmt::format("P{:g}", p));
    text += fmt::format(" {:>7}\n", "max");
    for (const population::ColumnDescription& d : group.result) {
      const std::string name = d.unit.empty() ? d.name : d.name + ", " + d.unit;
      text +=
          fmt::format("{:<{}} {:>6} {:>7}", name, width, d.summary ? d.summary->n : 0, d.missing);
      if (d.summary) {
        text += fmt::format(" {:>8.2f} {:>7} {:>7.1f}", d.summary->mean,
                            d.summary->n > 1 ? fmt::format("{:.2f}", d.summary->sd) : "-",
                            d.summary->min);
        for (const double p : d.percentiles) text += fmt::format(" {:>7.1f}", p);
        text += fmt::format(" {:>7.1f}", d.summary->max);
      }
      text += "\n";
    }
  }
  return text;
}

std::string correlations_text(const records::Correlations& correlations) {
  std::string text;
  for (const auto& group : correlations.groups) {
    const population::TableCorrelation& c = group.result;
    const std::vector<double> adjusted = records::adjusted_p_values(c);
    std::size_t width = 10;
    for (const std::string& name : c.names) width = std::max(width, name.size());
    text += (text.empty() ? "" : "\n") + heading(correlations, group);
    text += fmt::format("{:<{}} {:<{}} {:>6} {:>7}   {:<18} {:>10} {:>12}\n", "", width, "", width,
                        "n", "r", fmt::format("{:g} % interval", 100.0 * correlations.level), "p",
                        "Spearman rho");
    for (std::size_t i = 0; i < c.pairs.size(); ++i) {
      const auto& pair = c.pairs[i];
      const statistics::Correlation& r = pair.pearson;
      const std::string ends =
          r.interval ? fmt::format("{:6.3f} to {:6.3f}", r.interval->low, r.interval->high) : "";
      text += fmt::format("{:<{}} {:<{}} {:>6} {:>7.3f}   {:<18} {:>10}{:<2} {:>10.3f}\n",
                          c.names[static_cast<std::size_t>(pair.a)], width,
                          c.names[static_cast<std::size_t>(pair.b)], width, r.n, r.r, ends,
                          records::p_text(r.p_value),
                          adjusted[i] < 0.05 ? "**"
                          : r.p_value < 0.05 ? "*"
                                             : "",
                          pair.spearman.r);
    }
  }
  return text +
         "\n*  significant at 0.05; ** also after Holm's adjustment for all pairs of the group\n";
}

std::string regressions_text(const records::Regressions& regressions) {
  std::string text;
  for (const auto& group : regressions.groups) {
    text += (text.empty() ? "" : "\n") + heading(regressions, group);
    const auto& all = group.result;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const population::TableRegression& r = all[i];
      if (i == 0 || all[i - 1].name != r.name) {
        text += fmt::format("\n{}{}\n", r.name, r.unit.empty() ? "" : ", " + r.unit);
      }
      const bool is_best = population::best_predictor(all, r.name) == static_cast<int>(i);
      const bool has_rival =
          std::count_if(all.begin(), all.end(), [&](const population::TableRegression& o) {
            return o.name == r.name && o.predictors.size() == 1;
          }) > 1;
      text += fmt::format("  on {}: {}\n    n {}, R2 {:.4f}, residual sd {:.3f}, p {}{}\n",
                          joined(r.predictors), equation(r), r.fit.n, r.fit.r2, r.fit.residual_sd,
                          records::p_text(r.fit.f_p_value),
                          is_best && has_rival ? "   (the better predictor)" : "");
    }
  }
  return text;
}

}  // namespace palmar::cli
