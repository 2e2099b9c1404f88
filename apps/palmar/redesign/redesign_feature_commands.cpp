// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Redesign 3: sizes of CAD features, chosen by what the hands feel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/product/make_product.h"
#include "palmar/product/parametric_kinds.h"
#include "palmar/records/product/cad_format.h"
#include "redesign/feature_proposals.h"
#include "redesign/feature_search_output.h"
#include "redesign/feature_settings.h"
#include "redesign/redesign_arguments.h"
#include "redesign/redesign_feature_run.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct FeatureArguments {
  RedesignArguments redesign;
  FeatureLimits limits;
  SearchOptions search;
  GrooveSettings grooves;
  std::string goal = "peak", optimiser = "auto";
  std::vector<std::string> vary;
  std::string edges = "long", radius = "1:15";  // of the verb fillet
  double step = 0.05, smallest_groove_radius = 3.0;
  bool proposes = false, no_compare = false;
};

CadSource source_of(const RedesignArguments& arguments) {
  CadSource source;
  if (is_made(arguments.product)) {
    source.made = made_from(arguments.product);
    return source;
  }
  source.file = arguments.product;
  read_file(source.file);  // says what is wrong with it, if anything
  if (!is_cad_file(source.file)) {
    throw UsageError(
        arguments.product +
        ": a mesh; features change in CAD files (STEP, IGES) and in products made from "
        "parameters (\"made: prism fillet_mm=3\")");
  }
  if (const auto unit = parse_unit(arguments.unit)) {
    source.millimetres_per_unit = millimetres_per(*unit);
  }
  return source;
}

/// Checks what was typed before hands are made.
std::vector<FeatureSetting> settings_of(const FeatureArguments& a, const CadSource& source) {
  std::vector<FeatureSetting> settings;
  for (const std::string& words : a.vary) {
    settings.push_back(feature_setting("--vary", words, a.grooves));
    FeatureSetting& setting = settings.back();
    if (!setting.parameter.empty() && !source.made) {
      throw UsageError(
          fmt::format("--vary \"{}\": only products made from parameters have them; "
                      "fillet:EDGES, offset:FACES, taper:FACES and groove:... change "
                      "a CAD file",
                      words));
    }
    if (setting.feature.feature == "fillet" && setting.varies()) {
      setting.lowest =
          std::max(setting.lowest, std::min(a.limits.smallest_radius, setting.highest));
    }
    if (setting.feature.feature == "groove" && a.grooves.radius < a.smallest_groove_radius) {
      throw UsageError(fmt::format(
          "--groove-radius-mm is {:g} mm; at least --smallest-groove-radius-mm, {:g} mm, can be "
          "made",
          a.grooves.radius, a.smallest_groove_radius));
    }
  }
  return settings;
}

void write_story(const fs::path& folder, const SearchStory& story, const FeatureArguments& a,
                 const Context& context) {
  write_file(folder / "history.csv", history_csv(story));
  write_file(folder / "history.svg", history_svg(story));
  Json json = history_json(story);
  json["product"] = a.redesign.product;
  json["command"] = context.command_line;
  json["seed"] = context.common.seed;
  json["population"] = a.redesign.populations;
  json["posture"] = a.redesign.posture;
  write_file(folder / "search.json", json.dump(2) + "\n");
}

bool is_better_than_original(const SearchStory& story) {
  const double best = story.result.history[static_cast<size_t>(*story.result.best)].outcome.goal;
  return story.goal.is_lower_better ? best < story.original.value : best > story.original.value;
}

int run_features(const FeatureArguments& a, const Context& context) {
  const Progress progress = make_progress(context.common);
  const CadSource source = source_of(a.redesign);
  SearchOptions search = a.search;
  search.method = search_method(a.optimiser);
  search.check();
  a.limits.check();
  const FeatureGoal goal = feature_goal(a.goal);
  std::vector<FeatureSetting> settings = settings_of(a, source);
  if (settings.empty() && !a.proposes) {
    throw UsageError(
        "--vary is needed: which feature may change, as fillet:long=1:15; or "
        "--propose");
  }
  // The original's features, so that an unknown edge is told at once.
  FeatureRun run{a.redesign, context, source, settings, a.limits, goal, nullptr, {}};
  run.find_starts(progress);
  const HeldOriginal original = grasp_original(a.redesign, context, progress);
  run.original = &original;

  const fs::path folder = a.redesign.out;
  create_folder(folder);
  if (a.proposes) {
    const std::vector<TriedProposal> tried = try_proposals(run, progress);
    finish_progress();
    write_file(folder / "proposals.csv", proposals_csv(tried));
    print(context.common.json ? proposals_json(tried, goal).dump(2) + "\n"
                              : proposals_text(tried, goal));
    return 0;
  }
  const SearchStory story = run.search(a.step, search, progress);
  finish_progress();
  write_story(folder, story, a, context);
  if (!context.common.json) print(history_text(story));
  if (!story.result.best) {
    const SearchTrial& last = story.result.history.back();
    throw NumericalError(fmt::format(
        "{}: no candidate is within the constraints{}; {} has all that were tried",
        a.redesign.product, last.outcome.failure.empty() ? "" : " (" + last.outcome.failure + ")",
        (folder / "history.csv").string()));
  }

  const std::vector<double>& values =
      story.result.history[static_cast<size_t>(*story.result.best)].values;
  const std::string name = words_of(run.settings, run.all_values(values));
  const ChangedCad made = run.make(values, true, true, progress);
  Json json = history_json(story);
  if (!is_better_than_original(story)) {
    note(context.common,
         a.redesign.product + ": no change within the limits is better than the original");
  }
  if (made.largest_change < kUnchanged) {
    note(context.common, "nothing changes: there is no redesign to write or compare");
    json["redesign"] = nullptr;
    if (context.common.json) print(json.dump(2) + "\n");
    return 0;
  }
  const fs::path step = folder / "redesign.step";
  write_file(step, made.step);
  const Product product = run.product_of(made, name, step.string());
  write_mesh(folder / "redesign.stl", product.mesh);
  for (const std::string& text : made.notes) note(context.common, text);
  note(context.common,
       fmt::format("{}: a valid closed solid of {:.0f} mm3 (before: {:.0f} mm3), "
                   "read back; largest change {:.2f} mm",
                   step.string(), made.volume, made.volume_before, made.largest_change));
  json["redesign"] = {{"name", name},
                      {"step", step.string()},
                      {"volume_mm3", made.volume},
                      {"volume_before_mm3", made.volume_before},
                      {"largest_change_mm", made.largest_change}};
  if (!a.no_compare) {
    const std::string comparison = compare_redesigns(
        a.redesign, original, {{product, name, step.string()}}, context, progress);
    if (context.common.json) json["comparison"] = Json::parse(comparison);
  }
  if (context.common.json) print(json.dump(2) + "\n");
  return 0;
}

void add_common(CLI::App& verb, FeatureArguments& a) {
  a.redesign.add_to(verb);
  verb.add_option("--goal", a.goal,
                  "What is made better, mean over hands: peak (pressure on sensor cells), mean "
                  "(pressure), stability, discomfort or a quantity's key; peak:p95, "
                  "peak:above=0.3 for other figures over hands")
      ->capture_default_str();
  verb.add_option("--largest-offset-mm", a.limits.largest_offset,
                  "Most that any point of the surface may move, mm");
  verb.add_option("--keep-out", a.limits.keep_out,
                  "Faces that must stay as they are: face=3+5, name=grip, ends");
  verb.add_option("--smallest-radius-mm", a.limits.smallest_radius, "Of fillets")
      ->capture_default_str();
  verb.add_option("--smallest-volume", a.limits.smallest_volume,
                  "Least volume as a share of the original's");
  verb.add_option("--largest-volume", a.limits.largest_volume,
                  "Most volume as a share of the original's");
  verb.add_option("--least-grip-force", a.limits.least_grip_force,
                  "Least grip force as a share of the original's (a kept posture on a smaller "
                  "product holds with less force)");
  verb.add_option("--lost-hands", a.limits.lost_hands,
                  "Most hands that may lose hold, as a share of those that hold the original")
      ->capture_default_str();
  verb.add_option("--evaluations", a.search.evaluations, "Most candidates that hands hold")
      ->capture_default_str();
  verb.add_option("--step-mm", a.step, "Sizes are rounded to this, as a machine keeps it")
      ->capture_default_str();
  verb.add_option("--optimiser", a.optimiser, "auto, cobyla, bobyqa, direct")
      ->capture_default_str();
  verb.add_flag("--no-compare", a.no_compare, "Only search and write; no comparison at the end");
}

}  // namespace

void add_redesign_feature_commands(CLI::App& noun, Context& context) {
  {
    const auto a = std::make_shared<FeatureArguments>();
    CLI::App* verb = add_verb(noun, "fillet", "The radius of edges with the best goal over hands",
                              "palmar redesign fillet prism.step --edges long --radius-mm 1:15 "
                              "--largest-offset-mm 3 --hands 30 --seed 2014 --out fillet");
    add_common(*verb, *a);
    verb->add_option("--edges", a->edges,
                     "long, convex, concave, edge=3+5, face=7 (a fillet) or name=grip, joined by +")
        ->capture_default_str();
    verb->add_option("--radius-mm", a->radius, "Range as 1:15, or one radius that is just made")
        ->capture_default_str();
    verb->callback([a, &context] {
      context.run = [a, &context] {
        a->vary = {"fillet:" + a->edges + "=" + a->radius};
        return run_features(*a, context);
      };
    });
  }
  const auto a = std::make_shared<FeatureArguments>();
  CLI::App* verb = add_verb(
      noun, "features", "Sizes of features with the best goal over hands; proposals of which",
      "palmar redesign features \"made: cylinder diameter_mm=30 length_mm=130\" --vary "
      "diameter_mm=25:45 --posture new --hands 30 --out handle");
  add_common(*verb, *a);
  verb->add_option("--vary", a->vary,
                   "Feature and its range, or one value that is just made: fillet:EDGES=1:15, "
                   "offset:FACES=-2:2, taper:FACES=0:4 (deg), groove:at=40=0:2 (ring 40 mm from "
                   "the middle, depth), groove:LINE.csv=1.5, PARAMETER=25:45 of a made product; "
                   "may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--groove-radius-mm", a->grooves.radius, "Of a groove's section: the cutter's")
      ->capture_default_str();
  verb->add_option("--groove-rim-mm", a->grooves.rim, "Radius along a groove's rims")
      ->capture_default_str();
  verb->add_option("--smallest-groove-radius-mm", a->smallest_groove_radius,
                   "Smallest cutter that can be used")
      ->capture_default_str();
  verb->add_flag("--propose", a->proposes,
                 "Don't search: say which features carry the peaks, try a change of each, and rank "
                 "them by what they gain");
  verb->callback(
      [a, &context] { context.run = [a, &context] { return run_features(*a, context); }; });
}

}  // namespace palmar::cli
