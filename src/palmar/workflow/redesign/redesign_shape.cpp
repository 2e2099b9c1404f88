// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/grasp/grip.h"
#include "palmar/records/handle_file.h"
#include "palmar/redesign/contact_region.h"
#include "palmar/redesign/handle_ends.h"
#include "palmar/redesign/handle_wall.h"
#include "palmar/redesign/held_hand.h"
#include "palmar/workflow/redesign/shape_files.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<redesign::HandPressure> pressures_of(const redesign::HeldHand& held) {
  std::vector<redesign::HandPressure> pressures;
  for (std::size_t i = 0; i < held.pressure.size(); ++i) {
    if (held.pressure[i] > 0.0) pressures.push_back({held.skin.vertices[i], held.pressure[i]});
  }
  return pressures;
}

/// All uses with their hands on the original, weights as shares.
std::vector<ShapeUse> hold_originals(const RedesignShapeRequest& request,
                                     const Progress& progress) {
  std::vector<ShapeUseRequest> asked;
  for (const std::string& words : request.uses) asked.push_back(shape_use(words, request.redesign));
  if (asked.empty()) asked.push_back({.name = "", .asked = request.redesign});
  double sum = 0.0;
  for (const ShapeUseRequest& one : asked) sum += one.weight;
  std::vector<ShapeUse> uses;
  for (ShapeUseRequest& one : asked) {
    if (!uses.empty()) {
      // Files of its own; notes on product and populations were said.
      one.asked.out = request.redesign.out / fmt::format("use-{}", uses.size() + 1);
      one.asked.on_note = nullptr;
    }
    HeldOriginal original = grasp_original(one.asked, progress);
    uses.push_back({.name = one.name,
                    .weight = one.weight / sum,
                    .request = one.asked,
                    .original = std::move(original)});
  }
  return uses;
}

/// How the hands lie: by the hold, which is the same for all; thumb and breadth as means over them;
/// where they press it, in all uses.
redesign::HandsOnHandle hands_on_handle(const std::vector<ShapeUse>& uses, const grasp::Hold& hold,
                                        double spread, const Progress& progress) {
  const HeldOriginal& original = uses.front().original;
  redesign::HandsOnHandle result = hands_in_hold(original, hold);
  result.spread = spread;
  Vec3 thumb = Vec3::Zero();
  double pressed = 0.0, breadth = 0.0;
  int hands = 0;
  redesign::for_each_held_hand(
      original.study.plan, original.study.inputs, original.source(), {}, 0,
      [&](const redesign::HeldHand& held) {
        breadth += held.who->dimensions.hand_width;
        ++hands;
        result.pressures.push_back(pressures_of(held));
        for (std::size_t i = 0; i < held.pressure.size(); ++i) {
          if (!(held.pressure[i] > 0.0) ||
              redesign::part_of(held.who->region[i]) != redesign::HandPart::kThumb) {
            continue;
          }
          thumb += held.pressure[i] * held.skin.vertices[i];
          pressed += held.pressure[i];
        }
      },
      progress);
  for (std::size_t u = 1; u < uses.size(); ++u) {
    const records::LoadedStudy& study = uses[u].original.study;
    redesign::for_each_held_hand(
        study.plan, study.inputs, uses[u].original.source(), {}, 0,
        [&](const redesign::HeldHand& held) { result.pressures.push_back(pressures_of(held)); },
        progress);
  }
  result.breadth = breadth / hands;
  result.thumb = pressed > 0.0 ? Vec3(thumb / pressed)
                               : Vec3(result.place + 0.36 * result.breadth * result.thumb_side);
  return result;
}

/// The hold that a handle is shaped for. Throws UsageError if it is none of a whole hand round it.
grasp::Hold hold_for_shape(const HeldOriginal& original) {
  const std::optional<grasp::Hold> hold = original.hold();
  if (!hold) {
    throw UsageError(original.product().name +
                     ": held at given coordinates; a shape is made for a hold (setting \"part\", "
                     "setting \"along\" and setting \"toward\" say which)");
  }
  if (!grasp::is_power(hold->grip) || hold->is_over_end) {
    throw UsageError(fmt::format(
        "{}: held in a {} grip; a shape is made for a hand that closes round a handle (setting "
        "\"grips\" medium_wrap, for example)",
        original.product().name, name_of(hold->grip)));
  }
  return *hold;
}

/// Index of the candidate that was asked for.
int picked(int number, const redesign::SearchResult& found) {
  const auto count = static_cast<int>(found.history.size());
  if (number > count ||
      !found.history[static_cast<std::size_t>(number - 1)].outcome.failure.empty()) {
    throw UsageError(fmt::format(
        "setting \"pick\" is {}; the number of a candidate that could be made is allowed, 1 to {}",
        number, count));
  }
  return number - 1;
}

std::vector<ShapeVariable> variables_of(const RedesignShapeRequest& request,
                                        const redesign::HandleFeatures& start) {
  std::vector<ShapeVariable> variables;
  if (!request.features.empty()) return variables;
  std::vector<std::string> words = request.vary;
  if (words.empty()) words = usual_variables(request.limits.suits_both_hands);
  for (const std::string& one : words) {
    variables.push_back(shape_variable(one, start));
    const redesign::HandleFeature& feature = *variables.back().feature;
    if (request.limits.suits_both_hands && feature.is_one_sided) {
      throw UsageError(fmt::format(
          "setting \"vary\" \"{}\": a {} suits one hand only, and setting \"suits both hands\" "
          "is on",
          one, feature.name));
    }
  }
  return variables;
}

/// How much of flat ends keeps its outline, mm.
std::array<double, 2> kept_ends_of(const RedesignShapeRequest& request,
                                   const redesign::HandleBody& body) {
  if (!body.is_whole) return {0.0, 0.0};
  if (const auto asked = request.limits.kept_ends) return {*asked, *asked};
  return redesign::kept_lengths(body);
}

/// Where the search begins: what is `given`, or else nearest to the original, within what a search
/// may vary.
redesign::HandleShape start_of(const RedesignShapeRequest& request, const product::Product& product,
                               const redesign::HandleBody& body,
                               const redesign::FittedFeatures& fitted,
                               const std::optional<records::HandleFile>& given) {
  redesign::HandleShape start{.body = body, .features = fitted.features};
  start.kept_ends = kept_ends_of(request, body);
  start.kept_boxes = request.limits.kept_boxes;
  start.kept_faces = request.limits.kept_faces;
  if (body.is_whole) {
    // Ends that are kept sharp stay so.
    const bool keeps_ends = start.kept_ends[0] > 0.0 || start.kept_ends[1] > 0.0;
    start.end_radius =
        request.end_radius.value_or(keeps_ends && body.end_radius == 0.0
                                        ? 0.0
                                        : std::max(redesign::kLeastEndRadius, body.end_radius));
  }
  if (given) {
    start.features = given->features;
    start.kept_ends = given->kept_ends;
    start.kept_boxes = given->kept_boxes;
    start.kept_faces = given->kept_faces;
    if (body.is_whole) start.end_radius = given->end_radius;
  } else if (request.limits.suits_both_hands) {
    for (const redesign::HandleFeature& one : redesign::handle_features()) {
      if (one.is_one_sided) start.features.*one.value = 0.0;
    }
  }
  redesign::KeepOut faces;
  for (const std::string& one : start.kept_faces) faces.add_face(one);
  start.to_kept_faces = redesign::distances_to_faces(body, product, faces);
  return start;
}

}  // namespace

std::vector<std::string> usual_variables(bool suits_both_hands) {
  std::vector<std::string> all = {"width", "depth", "squareness", "taper",
                                  "swell", "waist", "egg",        "palm_swell"};
  if (!suits_both_hands) all.push_back("turn");
  return all;
}

void RedesignShapeRequest::check() const {
  redesign.check();
  search.check();
  limits.check();
  spread.check();
  if (redesign.keeps_posture()) {
    throw UsageError(
        "setting \"posture\" kept: a shape is made for hands that take it in hand; new is "
        "allowed");
  }
  for (const std::string& words : uses) shape_use(words, redesign).asked.check();
  for (const std::string& words : vary) redesign::handle_feature(words.substr(0, words.find('=')));
  if (pick && *pick < 1) {
    throw UsageError(fmt::format("setting \"pick\" is {}; 1 or more is allowed", *pick));
  }
  if (end_radius && !(*end_radius >= 0.0 && *end_radius <= 30.0)) {
    throw UsageError(
        fmt::format("setting \"end radius\" is {:g} mm; 0 to 30 mm are allowed", *end_radius));
  }
  if (!features.empty() && !vary.empty()) {
    throw UsageError("setting \"features\" is made as it is; it doesn't go with setting \"vary\"");
  }
}

RedesignShapeOutcome redesign_shape(const RedesignShapeRequest& asked, const Progress& progress) {
  asked.check();
  RedesignShapeOutcome outcome;
  const redesign::FeatureGoal goal = redesign::feature_goal(asked.goal);
  RedesignShapeRequest request = asked;
  request.redesign.goal_key = goal.key;
  // Before anything is said of the hold.
  const std::optional<records::HandleFile> given =
      request.features.empty() ? std::nullopt
                               : std::optional(records::read_handle(request.features));
  ShapeRun run{.uses = hold_originals(request, progress),
               .goal = goal,
               .limits = request.limits,
               .start = {},
               .variables = {}};
  const HeldOriginal& original = run.uses.front().original;
  outcome.notes = original.study.notes;
  const product::Product& product = original.product();
  const grasp::Hold hold = hold_for_shape(original);
  const redesign::HandleBody body =
      redesign::measure_handle(product, original.part_of(hold),
                               hands_on_handle(run.uses, hold, request.spread.along, progress),
                               {.takes_all = request.limits.kept_ends.has_value()});
  outcome.wall_before = redesign::thinnest_wall(body);
  if (request.limits.smallest_wall && !outcome.wall_before) {
    throw UsageError(fmt::format(
        "setting \"smallest wall\": the handle of {} is solid; leave it out", product.name));
  }
  const redesign::FittedFeatures fitted = redesign::fit_features(body, kept_ends_of(request, body));
  outcome.fit_rms = fitted.rms;
  run.start = start_of(request, product, body, fitted, given);
  run.variables = variables_of(request, run.start.features);
  run.hold_original(request.spread, progress);
  outcome.story = run.search(request.search, progress);
  formats::create_folder(request.redesign.out);
  redesign::SearchResult& found = outcome.story.result;
  if (request.pick) found.best = picked(*request.pick, found);
  write_search(request, outcome);
  if (!found.best) {
    throw NumericalError(
        fmt::format("{}: no candidate is within the limits; {} has all that were "
                    "tried",
                    request.redesign.product, (request.redesign.out / "history.csv").string()));
  }
  outcome.shape = run.shape_of(found.history[static_cast<std::size_t>(*found.best)].values);
  outcome.change = redesign::shape_change(outcome.shape);
  outcome.wall = redesign::thinnest_wall(outcome.shape);
  const product::Product redesign = write_shape(request, product, outcome, progress);
  outcome.add_note(request.redesign, replaced_words(outcome.shape));
  if (!is_better_than_original(outcome.story)) {
    outcome.add_note(request.redesign,
                     product.name +
                         ": no gain was found: what is made is not better than the original in the "
                         "hands that it was made for");
  }
  if (outcome.wall) {
    outcome.add_note(request.redesign,
                     hollow_words(product.name, *outcome.wall_before, *outcome.wall));
  }
  if (!outcome.shape.body.is_whole) {
    outcome.add_note(
        request.redesign,
        fmt::format("{} goes on beyond its handle: {} has all of it, handle.step the handle alone",
                    product.name, outcome.file.filename().string()));
  }
  Json json = json_of(request, outcome);
  if (request.draws) write_shape_pictures(request, product, redesign, outcome.shape, progress);
  formats::write_file(request.redesign.out / "shape.json", json.dump(2) + "\n");
  if (request.on_shape) request.on_shape(outcome);
  outcome.json = json.dump();
  if (request.compares) {
    const RedesignedProduct judged{redesign, "shaped", outcome.file.string()};
    const std::vector<report::StudyFigure> figures = search_figures(outcome.story);
    outcome.judge(run.uses.front().request, original, judged, progress, figures);
    for (std::size_t u = 1; u < run.uses.size(); ++u) {
      const ShapeUse& use = run.uses[u];
      outcome.other_uses.push_back({.name = use.name, .weight = use.weight, .outcome = {}});
      outcome.other_uses.back().outcome.judge(use.request, use.original, judged, progress, figures);
    }
  }
  if (outcome.gains) {
    json["gains"] = Json::parse(gains_json(*outcome.gains));
    formats::write_file(request.redesign.out / "shape.json", json.dump(2) + "\n");
  }
  return outcome;
}

}  // namespace palmar::workflow
