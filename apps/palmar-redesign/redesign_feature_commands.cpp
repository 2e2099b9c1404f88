// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Redesign 3: sizes of CAD features, chosen by what the hands feel.
#include <memory>

#include "redesign_arguments.h"
#include "redesign_text.h"

namespace palmar::cli {
namespace {

struct FeatureArguments {
  RedesignArguments redesign;
  workflow::RedesignFeatureRequest request;
  std::string optimiser = name_of(redesign::SearchOptions{}.method);
  std::string edges = "long", radius = "1:15";  // of the verb fillet
  bool no_compare = false;
};

int run_features(const FeatureArguments& a, const Context& context) {
  workflow::RedesignFeatureRequest request = a.request;
  request.search.method = redesign::search_method(a.optimiser);
  request.redesign = a.redesign.read(context);
  request.compares = !a.no_compare;
  request.on_search = [&context](const workflow::RedesignFeatureOutcome& outcome) {
    finish_progress();
    if (context.common.json) return;
    print(outcome.story ? search_text(*outcome.story)
                        : proposals_text(outcome.proposals, outcome.goal));
  };
  const workflow::RedesignFeatureOutcome outcome =
      workflow::redesign_features(request, make_progress(context.common));
  print_redesign(outcome, context);
  return 0;
}

void add_common(CLI::App& verb, FeatureArguments& a) {
  a.redesign.add_to(verb);
  verb.add_option(
          "--goal", a.request.goal,
          "What is made better, mean over hands: peak (pressure on sensor cells), mean "
          "(pressure), stability, discomfort or a quantity's key; peak:p95, "
          "peak:above=0.3 (share of hands above 0.3 of its unit, MPa) for other figures over hands")
      ->capture_default_str();
  verb.add_option("--largest-offset-mm", a.request.limits.largest_offset,
                  "Most that any point of the surface may move, mm");
  verb.add_option("--keep-face", a.request.limits.keep_out,
                  "Faces that must stay as they are: face=3+5, name=grip, ends");
  verb.add_option("--smallest-radius-mm", a.request.limits.smallest_radius,
                  "Smallest radius of fillets, mm")
      ->capture_default_str();
  verb.add_option("--smallest-volume", a.request.limits.smallest_volume,
                  "Least volume as a share of the original's");
  verb.add_option("--largest-volume", a.request.limits.largest_volume,
                  "Most volume as a share of the original's");
  verb.add_option("--least-grip-force", a.request.limits.least_grip_force,
                  "Least grip force as a share of the original's (a kept posture on a smaller "
                  "product holds with less force)");
  verb.add_option("--lost-hands", a.request.limits.lost_hands,
                  "Largest share of hands that may no longer hold the product, out of those that "
                  "hold the original")
      ->capture_default_str();
  verb.add_option("--evaluations", a.request.search.evaluations,
                  "Largest number of candidates that are made and held")
      ->capture_default_str();
  verb.add_option("--step-mm", a.request.step, "Sizes are rounded to this step, mm")
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
                              "palmar redesign fillet handle.step --edges long --radius-mm 1:15 "
                              "--largest-offset-mm 3 --hands 30 --seed 2014 --out fillet");
    add_common(*verb, *a);
    verb->add_option("--edges", a->edges,
                     "long, convex, concave, edge=3+5, face=7 (a fillet) or name=grip, joined by +")
        ->capture_default_str();
    verb->add_option("--radius-mm", a->radius,
                     "Range as 1:15, or one radius that is made without a search")
        ->capture_default_str();
    verb->callback([a, &context] {
      context.setting_options = {{"vary", "--edges with --radius-mm"}};
      context.run = [a, &context] {
        a->request.vary = {"fillet:" + a->edges + "=" + a->radius};
        return run_features(*a, context);
      };
    });
  }
  const auto a = std::make_shared<FeatureArguments>();
  CLI::App* verb = add_verb(
      noun, "features", "Sizes of features with the best goal over hands; proposals of which",
      "palmar redesign features \"made: cylinder diameter_mm=30 length_mm=130\" --vary "
      "diameter_mm=25:45 --hands 30 --out handle");
  add_common(*verb, *a);
  verb->add_option(
          "--vary", a->request.vary,
          "Feature and its range, or one value that is made without a search: fillet:EDGES=1:15, "
          "offset:FACES=-2:2, taper:FACES=0:4 (deg), groove:at=40=0:2 (ring 40 mm from the middle, "
          "depth), groove:LINE.csv=1.5, PARAMETER=25:45 of a made product; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--groove-radius-mm", a->request.grooves.radius,
                   "Radius of a groove's section, that of the cutter, mm")
      ->capture_default_str();
  verb->add_option("--groove-rim-mm", a->request.grooves.rim,
                   "Radius along the edges of a groove, mm")
      ->capture_default_str();
  verb->add_option("--smallest-groove-radius-mm", a->request.smallest_groove_radius,
                   "Smallest cutter radius that can be used, mm")
      ->capture_default_str();
  verb->add_flag("--propose", a->request.proposes,
                 "Don't search: list the features that carry the peaks, try one change of each, "
                 "and rank the changes by their gain");
  verb->callback(
      [a, &context] { context.run = [a, &context] { return run_features(*a, context); }; });
}

}  // namespace palmar::cli
