// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/feature_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/parametric_kinds.h"

namespace palmar::workflow {
namespace {

constexpr double kChordalError = 0.01;  // mm; finer than skin feels, the same for all candidates
constexpr double kKept = 0.05;          // mm; surfaces are measured to about 0.02 mm

}  // namespace

void FeatureLimits::check() const {
  CandidateLimits::check();
  if (largest_offset) {
    require_setting(*largest_offset > 0.0, "largest offset", *largest_offset, "above 0");
  }
  require_setting(smallest_radius >= 0.0, "smallest radius", smallest_radius, "0 or more");
  if (least_grip_force) {
    require_setting(*least_grip_force >= 0.0 && *least_grip_force <= 1.0, "least grip force",
                    *least_grip_force, "0 to 1");
  }
}

void FeatureRun::find_starts(const Progress& progress) {
  records::CadFeatureRequest asked{
      .source = source, .reference = {}, .features = {}, .keep_out = limits.keep_out};
  for (const FeatureSetting& setting : settings) {
    if (setting.parameter.empty()) asked.features.push_back(setting.feature);
  }
  const std::vector<records::ChosenEdges> fillets =
      records::describe_features(asked, {}, silent(progress));
  product::KindValues values;
  if (source.made)
    values =
        product::complete_values(product::parametric_kind(source.made->kind), source.made->given);
  start.clear();
  size_t fillet = 0;
  for (const FeatureSetting& setting : settings) {
    double now = 0.0;
    if (!setting.parameter.empty()) {
      const auto at = values.find(setting.parameter);
      if (at == values.end()) {
        throw UsageError(fmt::format("a {} has no parameter {}; see `palmar product make {} -h`",
                                     source.made->kind, setting.parameter, source.made->kind));
      }
      now = at->second;
    } else if (setting.feature.feature == "fillet") {
      now = fillets.at(fillet++).radius;
    }
    start.push_back(std::clamp(now, setting.lowest, setting.highest));
  }
}

std::vector<double> FeatureRun::all_values(const std::vector<double>& varying) const {
  std::vector<double> values;
  size_t next = 0;
  for (const FeatureSetting& setting : settings) {
    values.push_back(setting.varies() ? varying.at(next++) : setting.lowest);
  }
  return values;
}

records::ChangedCad FeatureRun::make(const std::vector<double>& varying, bool mesh, bool step,
                                     const Progress& progress) const {
  records::CadFeatureRequest asked = request_for(source, settings, all_values(varying));
  asked.keep_out = limits.keep_out;
  asked.mesh = mesh;
  asked.step = step;
  asked.chordal_error = kChordalError;
  try {
    return records::change_features(asked, {}, silent(progress));
  } catch (const UsageError& error) {
    // Parameters that don't go together: a candidate that can't be made.
    if (!source.made) throw;
    throw NumericalError(error.what());
  }
}

product::Product FeatureRun::product_of(const records::ChangedCad& made, const std::string& name,
                                        const std::string& source_name) const {
  return product::make_product(name, made.mesh.mesh,
                               {.unit = geometry::LengthUnit::kMillimetre,
                                .source = product::UnitSource::kMade,
                                .explanation = ""},
                               source_name, &made.mesh.faces);
}

std::vector<redesign::SearchConstraint> FeatureRun::constraints() const {
  std::vector<redesign::SearchConstraint> all;
  if (limits.largest_offset) {
    all.push_back({"largest change of the surface", "mm", *limits.largest_offset, true});
  }
  if (!limits.keep_out.empty()) all.push_back({"change of the faces to keep", "mm", kKept, true});
  for (const redesign::SearchConstraint& one : limits.on_volume()) all.push_back(one);
  if (limits.least_grip_force) {
    all.push_back({"grip force by the original's", "", *limits.least_grip_force, false});
  }
  all.push_back(limits.on_lost_hands());
  return all;
}

JudgedShape FeatureRun::judge(const records::ChangedCad& made, const Progress& progress) const {
  const study::StudyResults results =
      assess_candidate(request, *original, product_of(made, "candidate", "candidate"),
                       redesign::needs_indices(goal), silent(progress));
  return {.figure = redesign::goal_of(results, goal, 1),
          .grip_force_ratio = redesign::mean_ratio(results, "grip_force_n", 1)};
}

const JudgedShape& FeatureRun::as_it_is(const Progress& progress) const {
  if (!kept_as_it_is) {
    FeatureRun unchanged = *this;
    unchanged.settings.clear();
    kept_as_it_is = judge(unchanged.make({}, true, false, progress), progress);
  }
  return *kept_as_it_is;
}

redesign::SearchOutcome FeatureRun::assess(const std::vector<double>& varying,
                                           SearchStory::Beside& beside,
                                           const Progress& progress) const {
  const records::ChangedCad made = make(varying, true, false, progress);
  const JudgedShape judged =
      made.largest_change < kUnchanged ? as_it_is(progress) : judge(made, progress);
  const redesign::GoalFigure& figure = judged.figure;
  beside.hands = figure.hands;
  beside.lost = figure.lost;
  beside.grip_force_ratio = judged.grip_force_ratio;
  beside.figure = figure;
  beside.largest_change = made.largest_change;
  beside.volume_ratio = made.volume_before > 0.0 ? made.volume / made.volume_before : 0.0;
  redesign::SearchOutcome outcome{
      .failure = "", .goal = figure.value, .goal_error = figure.error, .constraint = {}};
  outcome.constraint =
      values_of(made, beside.grip_force_ratio, static_cast<double>(figure.lost) / figure.hands);
  return outcome;
}

redesign::SearchOutcome FeatureRun::measure(const std::vector<double>& varying,
                                            const Progress& progress) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return {.failure = "",
          .constraint = values_of(make(varying, false, false, progress), kUnknown, kUnknown)};
}

std::vector<double> FeatureRun::values_of(const records::ChangedCad& made, double grip_force_ratio,
                                          double lost_share) const {
  const double volume_ratio = made.volume_before > 0.0 ? made.volume / made.volume_before : 0.0;
  std::vector<double> values;
  if (limits.largest_offset) values.push_back(made.largest_change);
  if (!limits.keep_out.empty()) values.push_back(made.keep_out_change);
  for (const double ratio : limits.volumes(volume_ratio)) values.push_back(ratio);
  if (limits.least_grip_force) values.push_back(grip_force_ratio);
  values.push_back(lost_share);
  return values;
}

SearchStory FeatureRun::search(double step, const redesign::SearchOptions& options,
                               const Progress& progress) const {
  SearchStory story{
      .settings = {}, .problem = {}, .goal = goal, .result = {}, .original = {}, .beside = {}};
  for (size_t i = 0; i < settings.size(); ++i) {
    if (!settings[i].varies()) continue;
    story.settings.push_back(settings[i]);
    story.problem.variables.push_back({settings[i].name, settings[i].unit, settings[i].lowest,
                                       settings[i].highest, start[i], step});
  }
  story.problem.constraints = constraints();
  story.problem.is_lower_better = goal.is_lower_better;
  story.problem.measure = [&](const std::vector<double>& values) {
    return measure(values, progress);
  };
  run_search(
      story,
      [&](const std::vector<double>& values, SearchStory::Beside& beside) {
        return assess(values, beside, progress);
      },
      options, progress);
  story.original = as_it_is(progress).figure;
  return story;
}

}  // namespace palmar::workflow
