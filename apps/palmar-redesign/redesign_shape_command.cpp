// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Redesign 4: the handle shaped anew by few named features.
#include <memory>

#include "palmar/geometry/degrees.h"
#include "redesign_arguments.h"
#include "redesign_text.h"

namespace palmar::cli {
namespace {

struct ShapeArguments {
  RedesignArguments redesign;
  workflow::RedesignShapeRequest request;
  std::string features;
  std::vector<std::string> keep_boxes;
  std::string pull;
  double draft_deg = 2.0;
  double spread_deg = workflow::HoldSpread{}.turn / geometry::kDegree;
  bool no_pictures = false;
  bool no_compare = false;
};

int run_shape(const ShapeArguments& a, const Context& context) {
  workflow::RedesignShapeRequest request = a.request;
  request.redesign = a.redesign.read(context);
  request.features = a.features;
  request.limits.kept_boxes = kept_boxes(a.keep_boxes);
  request.spread.turn = a.spread_deg * geometry::kDegree;
  if (!a.pull.empty()) request.limits.pull = workflow::parse_vector("--pull", a.pull);
  request.limits.draft = a.draft_deg * geometry::kDegree;
  request.draws = !a.no_pictures;
  request.compares = !a.no_compare;
  request.on_shape = [&context](const workflow::RedesignShapeOutcome& outcome) {
    finish_progress();
    if (!context.common.json) print(search_text(outcome.story) + shape_text(outcome));
  };
  const workflow::RedesignShapeOutcome outcome =
      workflow::redesign_shape(request, make_progress(context.common));
  std::vector<NamedOutcome> others;
  for (const workflow::JudgedUse& one : outcome.other_uses) {
    others.push_back({one.name, one.weight, one.outcome});
  }
  print_redesign(outcome, context, others);
  return 0;
}

}  // namespace

void add_redesign_shape_command(CLI::App& noun, Context& context) {
  const auto a = std::make_shared<ShapeArguments>();
  CLI::App* verb = add_verb(
      noun, "shape",
      "Shape the handle anew by few named features, for hands that lie a little differently",
      "palmar redesign shape handle.step --hands 30 --grip-force-n 60 --goal peak --out shaped");
  a->redesign.add_to(*verb);
  workflow::RedesignShapeRequest& r = a->request;
  verb->add_option("--vary", r.vary,
                   "Feature that may vary, its range (width=28:40) or its value (width=34): width, "
                   "depth, squareness, taper, swell, waist, egg, palm_swell, finger_swell, "
                   "thumb_rest, finger_grooves, turn, twist; may be repeated. Without it: the "
                   "first eight, and turn")
      ->allow_extra_args(false);
  verb->add_option("--features", a->features,
                   "A handle.toml that is made and judged as it is, without a search");
  verb->add_option(
          "--goal", r.goal,
          "What is made better, mean over hands: peak (pressure on sensor cells), mean "
          "(pressure), discomfort, torque (that friction holds), strength (needed), effort (of the "
          "muscles), stability or a quantity's key; peak:p95 for the worst hands")
      ->capture_default_str();
  verb->add_option("--spread-mm", r.spread.along,
                   "How far hands lie from their place along the handle: standard deviation, mm")
      ->capture_default_str();
  verb->add_option("--spread-deg", a->spread_deg, "The same about the handle, degrees")
      ->capture_default_str();
  verb->add_option(
          "--use", r.uses,
          "One of several uses, as \"hand=left weight=0.1\": weight=, grip-force-n=, grip=, "
          "population=, hands=, hand=left; what isn't said is as in the other options; may "
          "be repeated. The goal then is the mean over uses, by the original's")
      ->allow_extra_args(false);
  verb->add_option("--places", r.spread.places,
                   "Places that stand for these; every hand takes one of them")
      ->capture_default_str();
  verb->add_option("--largest-change-mm", r.limits.largest_change,
                   "Most that any point of the handle may move, mm");
  verb->add_option("--smallest-wall-mm", r.limits.smallest_wall,
                   "Of a hollow handle: least wall over the hollow as it is now, across the "
                   "handle, mm; 0: the shape must not cut into it");
  verb->add_option("--smallest-volume", r.limits.smallest_volume,
                   "Least volume of the handle as a share of the original's");
  verb->add_option("--largest-volume", r.limits.largest_volume,
                   "Most volume of the handle as a share of the original's");
  verb->add_option("--smallest-radius-mm", r.limits.smallest_radius,
                   "Smallest radius of curvature round the handle, mm")
      ->capture_default_str();
  verb->add_option(
      "--pull", a->pull,
      "Direction x,y,z along which a mould of two halves opens, product frame: nothing "
      "may be undercut against it, and walls must lean against it");
  verb->add_option("--draft-deg", a->draft_deg, "Angle by which walls must lean, with --pull")
      ->capture_default_str();
  verb->add_option("--draft-land-mm", r.limits.land,
                   "Height at the parting line over which they may lean less, mm")
      ->capture_default_str();
  verb->add_option("--lost-hands", r.limits.lost_hands,
                   "Largest share of hands that may no longer hold the product, out of those that "
                   "hold the original")
      ->capture_default_str();
  verb->add_flag("--both-hands", r.limits.suits_both_hands,
                 "The same shape for left and right hands: nothing one-sided");
  verb->add_option("--keep-ends-mm", r.limits.kept_ends,
                   "Length at both flat ends that keeps its outline, mm; without it what isn't "
                   "the handle (a foot, a tang, a neck) stays beyond where hands grip");
  verb->add_option("--keep-face", r.limits.kept_faces,
                   "CAD face that keeps its outline: its number or name; may be repeated")
      ->allow_extra_args(false);
  add_kept_boxes(*verb, a->keep_boxes);
  verb->add_option(
      "--end-radius-mm", r.end_radius,
      "Radius of the edges round flat ends, mm; without it as they are, and at least 3; ends that "
      "are kept sharp stay so");
  verb->add_option("--evaluations", r.search.evaluations,
                   "Largest number of candidates that are made and held")
      ->capture_default_str();
  verb->add_option("--pick", r.pick,
                   "Make this candidate of the search (its number in history.csv) instead of the "
                   "best; the same seed and options search alike");
  verb->add_flag("--no-pictures", a->no_pictures, "Leave out the pictures");
  verb->add_flag("--no-compare", a->no_compare, "Only make the shape, without a comparison");
  verb->callback([a, &context] {
    context.setting_options = {
        {"largest change", "--largest-change-mm"}, {"smallest wall", "--smallest-wall-mm"},
        {"kept ends", "--keep-ends-mm"},           {"draft", "--draft-deg"},
        {"draft land", "--draft-land-mm"},         {"spread along", "--spread-mm"},
        {"spread of the turn", "--spread-deg"},    {"suits both hands", "--both-hands"}};
    context.run = [a, &context] { return run_shape(*a, context); };
  });
}

}  // namespace palmar::cli
