// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/hold_gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/records/csv.h"
#include "palmar/redesign/feature_goal.h"
#include "palmar/report/chart/scatter_chart.h"
#include "palmar/statistics/distributions.h"
#include "palmar/statistics/summary.h"

namespace palmar::workflow {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kOffsets[] = {-12.0, -8.0, -5.0, 5.0, 8.0, 12.0};  // mm
constexpr int kMostHands = 15;                                      // at offsets
constexpr std::size_t kSizes = 3;
constexpr double kLevel = 0.975;

std::vector<HoldGain> gains_in(const study::StudyResults& results,
                               const std::vector<study::StudyQuantity>& quantities,
                               const std::vector<int>& hands) {
  std::vector<HoldGain> gains;
  for (const study::StudyQuantity& one : quantities)
    gains.push_back(gain_of(results, one.key, hands));
  return gains;
}

/// Below 0 if it is a gain.
double sense(const study::StudyQuantity& quantity) {
  return quantity.better == grasp::Better::kUp ? -1.0 : 1.0;
}

std::string words_of(const HoldGain& gain) {
  if (gain.hands == 0) return "-";
  return fmt::format("{:+.0f} % ({:+.0f} to {:+.0f})", 100 * gain.change, 100 * gain.low,
                     100 * gain.high);
}

}  // namespace

HoldGain gain_of(const study::StudyResults& results, const std::string& key,
                 const std::vector<int>& hands) {
  const study::StudyCondition condition = study::conditions_of(results.plan).front();
  std::vector<double> differences;
  double before = 0.0;
  for (const int hand : hands) {
    const study::StudyRecord* const first = study::record_of(results, condition, 0, hand);
    const study::StudyRecord* const second = study::record_of(results, condition, 1, hand);
    if (first == nullptr || second == nullptr) continue;
    const std::optional<double> was = study::quantity_of(*first, key),
                                is = study::quantity_of(*second, key);
    if (!was || !is || !std::isfinite(*was) || !std::isfinite(*is)) continue;
    before += *was;
    differences.push_back(*is - *was);
  }
  HoldGain gain{.hands = static_cast<int>(differences.size())};
  if (differences.empty() || before == 0.0) return gain;
  const double mean = before / gain.hands;
  const statistics::Summary summary = statistics::summarise(differences);
  gain.change = gain.low = gain.high = summary.mean / mean;
  if (gain.hands > 1) {
    const double half = statistics::student_quantile(kLevel, gain.hands - 1.0) *
                        summary.standard_error / std::abs(mean);
    gain.low -= half;
    gain.high += half;
  }
  return gain;
}

std::optional<double> gone_at(const HoldGains& gains, std::size_t quantity, int direction) {
  std::vector<std::pair<double, double>> way;  // distance from the hold, change
  for (const HoldGains::AtOffset& one : gains.offsets) {
    if (one.along * direction < 0.0 || one.gains[quantity].hands == 0) continue;
    way.emplace_back(std::abs(one.along),
                     sense(gains.quantities[quantity]) * one.gains[quantity].change);
  }
  std::sort(way.begin(), way.end());
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (way[i].second < 0.0) continue;
    if (i == 0) return 0.0;
    const auto& [near, gain] = way[i - 1];
    return near + (way[i].first - near) * gain / (gain - way[i].second);
  }
  return std::nullopt;
}

HoldGains hold_gains(const JudgingHands& judges, const product::Product& redesign,
                     const RedesignComparison& comparison, const Progress& progress) {
  HoldGains result;
  result.quantities = comparison.quantities;
  const study::StudyResults& judged = comparison.results;
  std::vector<int> all = study::hands_of(judged.plan, study::conditions_of(judged.plan).front());
  result.offsets.push_back({0.0, gains_in(judged, result.quantities, all)});
  const int every = std::max(1, (static_cast<int>(all.size()) + kMostHands - 1) / kMostHands);
  std::vector<HoldOffset> offsets;
  for (const double along : kOffsets) offsets.push_back({along, 0.0});
  OffsetGrasps grasps(
      {.original = judges.original,
       .shapes = {{judges.original.product(), 0}, {redesign, 1}},
       .offsets = offsets,
       .with_indices = std::any_of(
           result.quantities.begin(), result.quantities.end(),
           [](const study::StudyQuantity& one) { return redesign::is_index(one.key); })});
  auto records = grasps.of([&](int hand, std::size_t) { return hand % every == 0; }, progress);
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const study::StudyResults at{.plan = plan_of_two(judges.original),
                                 .records = std::move(records[k])};
    result.offsets.push_back({offsets[k].along, gains_in(at, result.quantities, all)});
  }
  std::sort(result.offsets.begin(), result.offsets.end(),
            [](const auto& a, const auto& b) { return a.along < b.along; });

  const hand::HandDimension length{hand::DimensionKind::kHandLength};
  const auto length_of = [&](int hand) {
    return study::size_of(judged.plan.hands[static_cast<std::size_t>(hand)], length).value_or(0.0);
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](int a, int b) { return length_of(a) < length_of(b); });
  if (all.size() < 2 * kSizes) return result;
  for (std::size_t k = 0; k < kSizes; ++k) {
    const std::vector<int> third(
        all.begin() + static_cast<std::ptrdiff_t>(k * all.size() / kSizes),
        all.begin() + static_cast<std::ptrdiff_t>((k + 1) * all.size() / kSizes));
    result.sizes.push_back({length_of(third.front()), length_of(third.back()),
                            gains_in(judged, result.quantities, third)});
  }
  return result;
}

std::string gains_text(const HoldGains& gains) {
  std::string text = "change against the original, both held alike (95 % interval):\n";
  const auto line = [&](const std::string& label, const std::vector<HoldGain>& those) {
    text += fmt::format("  {:<34}", label);
    for (const HoldGain& one : those) text += fmt::format("  {:<26}", words_of(one));
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  };
  text += fmt::format("  {:<34}", "");
  for (const study::StudyQuantity& one : gains.quantities)
    text += fmt::format("  {:<26}", one.name);
  text.erase(text.find_last_not_of(' ') + 1);
  text += "\n";
  for (const HoldGains::AtOffset& one : gains.offsets) {
    line(one.along == 0.0 ? "where the hold says"
                          : fmt::format("hand {:.0f} mm {} the thumb", std::abs(one.along),
                                        one.along > 0.0 ? "towards" : "away from"),
         one.gains);
  }
  for (const HoldGains::OfSize& one : gains.sizes) {
    line(fmt::format("hands of {:.0f} to {:.0f} mm", one.shortest, one.longest), one.gains);
  }
  for (std::size_t q = 0; q < gains.quantities.size(); ++q) {
    if (gains.quantities[q].better == grasp::Better::kNeither) continue;
    const auto words = [&](int direction) {
      const std::optional<double> gone = gone_at(gains, q, direction);
      return gone ? fmt::format("{:.0f} mm", *gone) : std::string("beyond 12 mm");
    };
    text += fmt::format("the gain of {} is gone at {} towards the thumb and {} away from it\n",
                        gains.quantities[q].name, words(1), words(-1));
  }
  return text;
}

std::string gains_csv(const HoldGains& gains) {
  records::CsvTable table;
  table.header = {"offset_mm",      "shortest_hand_mm", "longest_hand_mm", "quantity",
                  "change_percent", "low_percent",      "high_percent",    "hands"};
  const auto add = [&](const std::string& offset, const std::string& shortest,
                       const std::string& longest, const std::vector<HoldGain>& those) {
    for (std::size_t q = 0; q < those.size(); ++q) {
      const HoldGain& one = those[q];
      table.rows.push_back({offset, shortest, longest, gains.quantities[q].key,
                            fmt::format("{:.2f}", 100 * one.change),
                            fmt::format("{:.2f}", 100 * one.low),
                            fmt::format("{:.2f}", 100 * one.high), fmt::format("{}", one.hands)});
    }
  };
  for (const HoldGains::AtOffset& one : gains.offsets) {
    add(fmt::format("{:g}", one.along), "", "", one.gains);
  }
  for (const HoldGains::OfSize& one : gains.sizes) {
    add("0", fmt::format("{:.1f}", one.shortest), fmt::format("{:.1f}", one.longest), one.gains);
  }
  return records::format_csv(table);
}

std::string gains_json(const HoldGains& gains) {
  const auto list = [&](const std::vector<HoldGain>& those) {
    Json json = Json::object();
    for (std::size_t q = 0; q < those.size(); ++q) {
      json[gains.quantities[q].key] = {{"change_share", those[q].change},
                                       {"low_share", those[q].low},
                                       {"high_share", those[q].high},
                                       {"hands", those[q].hands}};
    }
    return json;
  };
  Json json = {{"offsets", Json::array()}, {"sizes", Json::array()}, {"gone", Json::object()}};
  for (const HoldGains::AtOffset& one : gains.offsets) {
    json["offsets"].push_back({{"offset_mm", one.along}, {"changes", list(one.gains)}});
  }
  for (const HoldGains::OfSize& one : gains.sizes) {
    json["sizes"].push_back({{"shortest_hand_mm", one.shortest},
                             {"longest_hand_mm", one.longest},
                             {"changes", list(one.gains)}});
  }
  for (std::size_t q = 0; q < gains.quantities.size(); ++q) {
    if (gains.quantities[q].better == grasp::Better::kNeither) continue;
    const auto value = [&](int direction) {
      const std::optional<double> gone = gone_at(gains, q, direction);
      return gone ? Json(*gone) : Json();
    };
    json["gone"][gains.quantities[q].key] = {{"towards_thumb_mm", value(1)},
                                             {"away_from_thumb_mm", value(-1)}};
  }
  return json.dump();
}

std::string gains_svg(const HoldGains& gains) {
  report::ScatterChart chart{.title = "Change where the hand lies elsewhere",
                             .x_label = "hand off its place, towards the thumb, mm",
                             .y_label = "change against the original there, %",
                             .series = {},
                             .notes = {"shaded: 95 % interval of the mean over hands"}};
  for (std::size_t q = 0; q < gains.quantities.size(); ++q) {
    if (gains.quantities[q].better == grasp::Better::kNeither) continue;
    report::ScatterSeries series{.name = gains.quantities[q].name, .points = {}, .line = {}};
    series.colour = report::series_colour(chart.series.size());
    for (const HoldGains::AtOffset& one : gains.offsets) {
      const HoldGain& gain = one.gains[q];
      if (gain.hands == 0) continue;
      series.points.emplace_back(one.along, 100 * gain.change);
      series.line.x.push_back(one.along);
      series.line.value.push_back(100 * gain.change);
      series.line.low.push_back(100 * gain.low);
      series.line.high.push_back(100 * gain.high);
    }
    chart.series.push_back(std::move(series));
  }
  return report::to_svg(report::scatter_chart(chart));
}

}  // namespace palmar::workflow
