// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/feature_proposals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/records/csv.h"
#include "palmar/study/statistics/face_statistics.h"

namespace palmar {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastShare = 0.1;  // of hands; rarer peaks aren't worth a change of the product
constexpr size_t kMostFaces = 6;
constexpr double kFirstRadius = 3.0;  // mm; of an edge that is sharp
constexpr double kMove = 1.0;         // mm; of a face

struct Proposal {
  std::string words, reason;
};

std::string share_words(const ProductFaces& faces, const FaceSummary& face) {
  return fmt::format("{} has the highest pressure in {:.0f} % of hands",
                     title_of(faces.face[static_cast<size_t>(face.face)]),
                     100 * face.has_peak.share);
}

/// Radius that a budget of change allows: between faces at right angles the surface of a fillet
/// moves by (sqrt 2 - 1) of the change of its radius.
double radius_within(double from, double wanted, const FeatureLimits& limits) {
  if (!limits.largest_offset) return wanted;
  const double most = from + *limits.largest_offset / (std::numbers::sqrt2 - 1);
  return std::floor(std::min(wanted, most) * 20) / 20;
}

bool rounds(const ProductFace& face) { return face.is_fillet && face.radius > 0.0; }

/// A face and those that it runs into smoothly, fillets aside: they move together. "3+4".
std::string faces_with(const ProductFaces& faces, int face) {
  std::vector<int> group = {face};
  for (size_t i = 0; i < group.size(); ++i) {
    for (const ProductEdge& edge : faces.edge) {
      if (!edge.is_smooth || edge.faces[0] < 0 || edge.faces[1] < 0) continue;
      if (edge.faces[0] != group[i] && edge.faces[1] != group[i]) continue;
      const int beyond = edge.faces[0] == group[i] ? edge.faces[1] : edge.faces[0];
      if (rounds(faces.face[static_cast<size_t>(beyond)])) continue;
      if (std::find(group.begin(), group.end(), beyond) == group.end()) group.push_back(beyond);
    }
  }
  std::vector<int> numbers;
  for (const int one : group) numbers.push_back(faces.face[static_cast<size_t>(one)].number);
  std::sort(numbers.begin(), numbers.end());
  return fmt::format("{}", fmt::join(numbers, "+"));
}

std::vector<Proposal> proposals_for(const ProductFaces& faces, const std::vector<FaceSummary>& hot,
                                    const FeatureLimits& limits) {
  std::vector<Proposal> all;
  std::vector<int> fillets;
  double radius = 0.0;
  for (const FaceSummary& face : hot) {
    const ProductFace& own = faces.face[static_cast<size_t>(face.face)];
    const std::string reason = share_words(faces, face);
    if (rounds(own) && !own.is_concave) {
      const double wider = radius_within(own.radius, 2 * own.radius, limits);
      all.push_back({fmt::format("fillet:face={}={:g}", own.number, wider), reason});
      fillets.push_back(own.number);
      radius = std::max(radius, wider);
      continue;
    }
    std::vector<int> edges;
    for (const ProductEdge& edge : faces.edge) {
      if (edge.is_convex && !edge.is_smooth && edge.faces[0] >= 0 && edge.faces[1] >= 0 &&
          (edge.faces[0] == face.face || edge.faces[1] == face.face)) {
        edges.push_back(edge.number);
      }
    }
    if (!edges.empty()) {
      all.push_back({fmt::format("fillet:edge={}={:g}", fmt::join(edges, "+"),
                                 radius_within(0, kFirstRadius, limits)),
                     reason + "; its sharp edges"});
    }
    const double move = std::min(kMove, limits.largest_offset.value_or(kMove));
    for (const double by : {-move, move}) {
      const std::string words =
          fmt::format("offset:face={}={:g}", faces_with(faces, face.face), by);
      const bool is_there = std::any_of(all.begin(), all.end(),
                                        [&](const Proposal& one) { return one.words == words; });
      if (!is_there) all.push_back({words, reason});
    }
  }
  if (fillets.size() > 1) {
    all.push_back({fmt::format("fillet:face={}={:g}", fmt::join(fillets, "+"), radius),
                   "these fillets together"});
  }
  return all;
}

}  // namespace

std::vector<TriedProposal> try_proposals(FeatureRun& run, const Progress& progress) {
  const Product& product = run.original->product();
  if (!product.faces) {
    throw UsageError(run.request.product + ": its faces aren't known; a CAD file is needed");
  }
  const std::vector<FaceStatistics> statistics =
      face_statistics(run.original->study.plan, {product}, run.original->source());
  std::vector<FaceSummary> hot;
  if (!statistics.empty()) hot = statistics.front().faces;
  std::erase_if(hot, [](const FaceSummary& face) { return face.has_peak.share < kLeastShare; });
  std::stable_sort(hot.begin(), hot.end(), [](const FaceSummary& a, const FaceSummary& b) {
    return a.has_peak.count > b.has_peak.count;
  });
  if (hot.size() > kMostFaces) hot.resize(kMostFaces);

  // What the original's CAD gives as it is: gains are reported from it.
  run.settings.clear();
  SearchStory::Beside beside;
  const SearchOutcome before = run.assess({}, beside, progress);
  const std::vector<Proposal> proposals = proposals_for(*product.faces, hot, run.limits);
  const std::vector<SearchConstraint> constraints = run.constraints();
  std::vector<TriedProposal> tried;
  for (size_t i = 0; i < proposals.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(proposals.size()),
                    proposals[i].words);
    TriedProposal one{proposals[i].words, proposals[i].reason, {}, 0.0, false, 0.0};
    run.settings = {feature_setting(one.words)};
    try {
      one.outcome = run.assess({}, beside, progress);
      one.is_feasible = true;
      one.grip_force_ratio = beside.grip_force_ratio;
      for (size_t k = 0; k < constraints.size(); ++k) {
        if (excess(constraints[k], one.outcome.constraint[k]) > 1e-9) one.is_feasible = false;
      }
      const double change = before.goal == 0.0 ? 0.0 : one.outcome.goal / before.goal - 1;
      one.gain = run.goal.is_lower_better ? -change : change;
    } catch (const NumericalError& error) {
      one.outcome.failure = error.what();
    }
    tried.push_back(std::move(one));
  }
  std::stable_sort(tried.begin(), tried.end(), [](const TriedProposal& a, const TriedProposal& b) {
    if (a.is_feasible != b.is_feasible) return a.is_feasible;
    return a.gain > b.gain;
  });
  return tried;
}

std::string proposals_csv(const std::vector<TriedProposal>& tried) {
  CsvTable table;
  table.header = {"vary",        "goal",    "gain_percent", "grip_force_ratio",
                  "is_feasible", "failure", "reason"};
  for (const TriedProposal& one : tried) {
    const bool is_made = one.outcome.failure.empty();
    table.rows.push_back({one.words, is_made ? fmt::format("{:.6g}", one.outcome.goal) : "",
                          is_made ? fmt::format("{:.2f}", 100 * one.gain) : "",
                          is_made ? fmt::format("{:.4f}", one.grip_force_ratio) : "",
                          one.is_feasible ? "yes" : "no", one.outcome.failure, one.reason});
  }
  return format_csv(table);
}

std::string proposals_json(const std::vector<TriedProposal>& tried, const FeatureGoal& goal) {
  Json list = Json::array();
  for (const TriedProposal& one : tried) {
    Json json = {{"vary", one.words}, {"reason", one.reason}, {"is_feasible", one.is_feasible}};
    if (one.outcome.failure.empty()) {
      json["goal"] = one.outcome.goal;
      json["gain_share"] = one.gain;
      json["grip_force_ratio"] = one.grip_force_ratio;
    } else {
      json["failure"] = one.outcome.failure;
    }
    list.push_back(std::move(json));
  }
  const Json json = {{"goal", goal.name}, {"unit", goal.unit}, {"proposals", std::move(list)}};
  return json.dump();
}

}  // namespace palmar
