// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_feature.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

records::CadSource source_of(const RedesignRequest& request) {
  const std::optional<records::CadSource> source = cad_source_of(request);
  if (source) return *source;
  throw UsageError(
      request.product +
      ": a mesh; features change in CAD files (STEP, IGES) and in products made from parameters "
      "(\"made: prism fillet_mm=3\")");
}

std::vector<FeatureSetting> settings_of(const RedesignFeatureRequest& request,
                                        const records::CadSource& source) {
  std::vector<FeatureSetting> settings;
  for (const std::string& words : request.vary) {
    settings.push_back(feature_setting(words, request.grooves));
    FeatureSetting& setting = settings.back();
    if (!setting.parameter.empty() && !source.made) {
      throw UsageError(
          fmt::format("setting \"vary\" \"{}\": only products made from parameters have them; "
                      "fillet:EDGES, offset:FACES, taper:FACES and groove:... change a CAD file",
                      words));
    }
    if (setting.feature.feature == "fillet" && setting.varies()) {
      setting.lowest =
          std::max(setting.lowest, std::min(request.limits.smallest_radius, setting.highest));
    }
    if (setting.feature.feature == "groove" &&
        request.grooves.radius < request.smallest_groove_radius) {
      throw UsageError(
          fmt::format("setting \"groove radius\" is {:g} mm; at least setting \"smallest groove "
                      "radius\", {:g} mm, can be made",
                      request.grooves.radius, request.smallest_groove_radius));
    }
  }
  return settings;
}

void write_story(const RedesignFeatureRequest& request, const SearchStory& story) {
  const fs::path& folder = request.redesign.out;
  formats::write_file(folder / "history.csv", history_csv(story));
  formats::write_file(folder / "history.svg", history_svg(story));
  Json json = Json::parse(history_json(story));
  json["product"] = request.redesign.product;
  json["command"] = request.redesign.command;
  json["seed"] = request.redesign.seed;
  json["population"] = request.redesign.populations;
  json["posture"] = name_of(request.redesign.posture);
  formats::write_file(folder / "search.json", json.dump(2) + "\n");
}

}  // namespace

void RedesignFeatureRequest::check() const {
  redesign.check();
  search.check();
  limits.check();
  if (vary.empty() && !proposes) {
    throw UsageError(
        "setting \"vary\" is needed: which feature may change, as fillet:long=1:15; or setting "
        "\"proposes\"");
  }
}

RedesignFeatureOutcome redesign_features(const RedesignFeatureRequest& asked,
                                         const Progress& progress) {
  asked.check();
  progress.throw_if_cancelled();
  RedesignFeatureRequest request = asked;
  request.redesign.goal_key = redesign::feature_goal(asked.goal).key;
  const records::CadSource source = source_of(request.redesign);
  RedesignFeatureOutcome outcome;
  outcome.goal = redesign::feature_goal(request.goal);
  const auto note = [&](const std::string& text) { outcome.add_note(request.redesign, text); };
  FeatureRun run{.request = request.redesign,
                 .source = source,
                 .settings = settings_of(request, source),
                 .limits = request.limits,
                 .goal = outcome.goal,
                 .original = nullptr,
                 .start = {}};
  // The original's features first, so that an unknown edge is reported at once.
  run.find_starts(progress);
  const HeldOriginal original = grasp_original(request.redesign, progress);
  outcome.notes = original.study.notes;
  run.original = &original;

  const fs::path& folder = request.redesign.out;
  formats::create_folder(folder);
  if (request.proposes) {
    outcome.proposals = try_proposals(run, progress);
    formats::write_file(folder / "proposals.csv", proposals_csv(outcome.proposals));
    if (request.on_search) request.on_search(outcome);
    outcome.json = proposals_json(outcome.proposals, outcome.goal);
    return outcome;
  }
  outcome.story = run.search(request.step, request.search, progress);
  const SearchStory& story = *outcome.story;
  write_story(request, story);
  if (request.on_search) request.on_search(outcome);
  if (!story.result.best) {
    const redesign::SearchTrial& last = story.result.history.back();
    throw NumericalError(
        fmt::format("{}: no candidate is within the constraints{}; {} has all that were tried",
                    request.redesign.product,
                    last.outcome.failure.empty() ? "" : " (" + last.outcome.failure + ")",
                    (folder / "history.csv").string()));
  }

  const std::vector<double>& values =
      story.result.history[static_cast<size_t>(*story.result.best)].values;
  const records::ChangedCad made = run.make(values, true, true, progress);
  Json json = Json::parse(history_json(story));
  json["redesign"] = nullptr;
  if (!is_better_than_original(story)) {
    note(request.redesign.product + ": no change within the limits is better than the original");
  }
  if (made.largest_change < kUnchanged) {
    note("nothing changes: there is no redesign to write or compare");
    outcome.json = json.dump();
    return outcome;
  }
  outcome.redesign = MadeRedesign{.name = words_of(run.settings, run.all_values(values)),
                                  .step = folder / "redesign.step",
                                  .volume = made.volume,
                                  .volume_before = made.volume_before,
                                  .largest_change = made.largest_change};
  const MadeRedesign& redesign = *outcome.redesign;
  formats::write_file(redesign.step, made.step);
  const product::Product product = run.product_of(made, redesign.name, redesign.step.string());
  formats::write_mesh(folder / "redesign.stl", product.mesh);
  for (const std::string& text : made.notes) note(text);
  note(
      fmt::format("{}: a valid closed solid of {:.0f} mm3 (before: {:.0f} mm3), "
                  "read back; largest change {:.2f} mm",
                  redesign.step.string(), made.volume, made.volume_before, made.largest_change));
  json["redesign"] = {{"name", redesign.name},
                      {"step", redesign.step.string()},
                      {"volume_mm3", made.volume},
                      {"volume_before_mm3", made.volume_before},
                      {"largest_change_mm", made.largest_change}};
  outcome.json = json.dump();
  if (request.compares) {
    outcome.judge(request.redesign, original, {product, redesign.name, redesign.step.string()},
                  progress);
  }
  return outcome;
}

}  // namespace palmar::workflow
