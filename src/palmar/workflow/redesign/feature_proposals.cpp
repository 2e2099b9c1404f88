// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/feature_proposals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/records/csv.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/workflow/redesign/proposal_list.h"

namespace palmar::workflow {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kCertain = 1.96;  // standard errors: 95 %

/// One proposal, made and held.
void try_one(FeatureRun& run, const redesign::GoalFigure& before, TriedProposal& one,
             const Progress& progress) {
  run.settings = {feature_setting(one.words)};
  SearchStory::Beside beside;
  try {
    one.outcome = run.assess({}, beside, progress);
  } catch (const NumericalError& error) {
    one.outcome.failure = error.what();
    one.verdict = ProposalVerdict::kImpossible;
    return;
  }
  one.grip_force_ratio = beside.grip_force_ratio;
  one.largest_change = beside.largest_change;
  const redesign::GoalChange change = redesign::goal_change(before, beside.figure);
  one.gain = run.goal.is_lower_better ? -change.share : change.share;
  one.gain_error = change.error;
  one.verdict = verdict_on(one.gain, one.gain_error);
  const std::vector<redesign::SearchConstraint> constraints = run.constraints();
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    if (redesign::excess(constraints[k], one.outcome.constraint[k]) > 1e-9) {
      one.verdict = ProposalVerdict::kNotAllowed;
    }
  }
}

}  // namespace

std::string name_of(ProposalVerdict verdict) {
  switch (verdict) {
    case ProposalVerdict::kChange:
      return "change";
    case ProposalVerdict::kLeave:
      return "leave";
    case ProposalVerdict::kWorse:
      return "worse";
    case ProposalVerdict::kNotAllowed:
      return "not allowed";
    case ProposalVerdict::kImpossible:
      return "impossible";
  }
  return "";
}

ProposalVerdict verdict_on(double gain, double gain_error) {
  if (gain > kCertain * gain_error && gain > 0.0) return ProposalVerdict::kChange;
  if (gain < -kCertain * gain_error && gain < 0.0) return ProposalVerdict::kWorse;
  return ProposalVerdict::kLeave;
}

std::vector<TriedProposal> try_proposals(FeatureRun& run, const Progress& progress) {
  const product::Product& product = run.original->product();
  if (!product.faces) {
    throw UsageError(run.request.product + ": its faces aren't known; a CAD file is needed");
  }
  const std::vector<study::FaceStatistics> statistics =
      study::face_statistics(run.original->study.plan, {product}, run.original->source());
  std::vector<study::FaceSummary> touched;
  if (!statistics.empty()) touched = statistics.front().faces;
  const std::vector<Proposal> proposals = proposals_for(*product.faces, touched, run.limits);
  // What the original's CAD gives as it is: gains are reported from it.
  const redesign::GoalFigure before = run.as_it_is(progress).figure;
  std::vector<TriedProposal> tried;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(proposals.size()),
                    proposals[i].words);
    TriedProposal one;
    one.words = proposals[i].words;
    one.reason = proposals[i].reason;
    try_one(run, before, one, progress);
    tried.push_back(std::move(one));
  }
  std::stable_sort(tried.begin(), tried.end(), [](const TriedProposal& a, const TriedProposal& b) {
    if (a.verdict != b.verdict) return a.verdict < b.verdict;
    return a.gain_per_mm() > b.gain_per_mm();
  });
  return tried;
}

std::string proposals_csv(const std::vector<TriedProposal>& tried) {
  records::CsvTable table;
  table.header = {"vary",
                  "verdict",
                  "goal",
                  "gain_percent",
                  "gain_error_percent",
                  "largest_change_mm",
                  "gain_percent_per_mm",
                  "grip_force_ratio",
                  "failure",
                  "reason"};
  for (const TriedProposal& one : tried) {
    const auto number = [&](const char* format, double value) {
      return one.outcome.failure.empty() ? fmt::format(fmt::runtime(format), value) : std::string();
    };
    table.rows.push_back({one.words, name_of(one.verdict), number("{:.6g}", one.outcome.goal),
                          number("{:.2f}", 100 * one.gain), number("{:.2f}", 100 * one.gain_error),
                          number("{:.3f}", one.largest_change),
                          number("{:.2f}", 100 * one.gain_per_mm()),
                          number("{:.4f}", one.grip_force_ratio), one.outcome.failure, one.reason});
  }
  return records::format_csv(table);
}

std::string proposals_json(const std::vector<TriedProposal>& tried,
                           const redesign::FeatureGoal& goal) {
  Json list = Json::array();
  for (const TriedProposal& one : tried) {
    Json json = {{"vary", one.words}, {"reason", one.reason}, {"verdict", name_of(one.verdict)}};
    if (one.outcome.failure.empty()) {
      json["goal"] = one.outcome.goal;
      json["gain_share"] = one.gain;
      json["gain_error_share"] = one.gain_error;
      json["largest_change_mm"] = one.largest_change;
      json["gain_share_per_mm"] = one.gain_per_mm();
      json["grip_force_ratio"] = one.grip_force_ratio;
    } else {
      json["failure"] = one.outcome.failure;
    }
    list.push_back(std::move(json));
  }
  const Json json = {{"goal", goal.name}, {"unit", goal.unit}, {"proposals", std::move(list)}};
  return json.dump();
}

}  // namespace palmar::workflow
