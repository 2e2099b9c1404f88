// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "redesign_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palmar::cli {
namespace {

std::string named(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + ", " + unit;
}

}  // namespace

std::string press_text(const workflow::RedesignPressOutcome& outcome) {
  const redesign::PressedShape& shape = outcome.shape;
  std::string text = fmt::format(
      "{}: pressed over {} hand{}: deepest {:.2f} mm at ({:.1f}, {:.1f}, {:.1f}), {:.0f} mm2 "
      "pressed, {:.0f} mm3 removed ({:.2f} %)\n",
      outcome.file.string(), shape.hands, shape.hands == 1 ? "" : "s", shape.deepest,
      shape.deepest_at.x(), shape.deepest_at.y(), shape.deepest_at.z(), shape.pressed_area,
      shape.removed_volume,
      100.0 * shape.removed_volume / std::max(1e-9, std::abs(outcome.volume_before)));
  if (std::isfinite(shape.thinnest_wall)) {
    text += fmt::format("thinnest wall under it {:.1f} mm\n", shape.thinnest_wall);
  }
  if (outcome.solid) {
    const workflow::PressedSolid& solid = *outcome.solid;
    text += fmt::format(
        "{}: a valid solid, its handle one surface of {} poles, {:.2f} mm from the mesh (root mean "
        "square; at most {:.2f} mm{})\n",
        solid.file.string(), solid.poles, solid.deviation, solid.largest_deviation,
        solid.end_radius > 0.0
            ? fmt::format(", but for its ends' edges, which are rounded with {:.1f} mm",
                          solid.end_radius)
            : "");
  }
  for (const auto& [area, what] :
       {std::pair{shape.limited_by_depth, "the depth limit"},
        {shape.limited_by_wall, "the wall that must remain"},
        {shape.limited_by_keep_out, "the keep-out"},
        {shape.limited_by_crossing, "the surface, which would have folded or crossed itself"}}) {
    if (area > 0.0) text += fmt::format("held back on {:.0f} mm2 by {}\n", area, what);
  }
  if (!shape.shift.empty()) {
    const auto [low, high] = std::minmax_element(shape.shift.begin(), shape.shift.end());
    text += fmt::format("hands shifted by {:+.1f} to {:+.1f} mm onto each other\n", *low, *high);
  }
  return text;
}

std::string region_text(const workflow::RedesignRegionOutcome& outcome) {
  const workflow::RegionFindings& findings = outcome.findings;
  const product::Product& product = *outcome.product;
  std::string text;
  for (const redesign::ContactRegion& region : findings.regions) {
    text +=
        fmt::format("{}{}: {:.0f} mm2 in {} patch{}\n", region.part ? "" : "hand, ", region.title,
                    region.area, region.patches.size(), region.patches.size() == 1 ? "" : "es");
    if (region.part || product.faces == nullptr || findings.map.face_of_triangle.empty()) continue;
    int shown = 0;
    for (const redesign::FaceShare& share : redesign::face_shares(
             findings.map.mesh, findings.map.face_of_triangle,
             static_cast<int>(product.faces->face.size()), findings.count, region)) {
      if (++shown > 12) break;
      text += fmt::format("  {}: {:.0f} % of its area, {:.0f} mm2\n",
                          title_of(product.faces->face[static_cast<std::size_t>(share.face)]),
                          100.0 * share.share, share.area);
    }
  }
  for (const workflow::FittedPatch& one : findings.patches) {
    text +=
        fmt::format("{}: {} (rms {:.2f} mm); pressed {} (rms {:.2f} mm)\n", name_of(findings, one),
                    title_of(one.product.best().surface), one.product.best().rms,
                    title_of(one.target.best().surface), one.target.best().rms);
  }
  if (findings.plan) {
    for (const redesign::RidgeRelief& one : findings.plan->reliefs) {
      text += fmt::format(
          "{}: ridge of r {:.1f} mm becomes r {:.1f} mm over {:.0f} mm, {:.2f} mm deep\n", one.name,
          one.radius_before, one.radius, (one.end - one.start).norm(), one.depth);
    }
  }
  return text;
}

std::string shape_text(const workflow::RedesignShapeOutcome& outcome) {
  std::string text = outcome.file.string() + ":";
  const redesign::HandleFeatures nothing{.width = 0.0, .depth = 0.0};
  for (const redesign::HandleFeature& one : redesign::handle_features()) {
    const double value = outcome.shape.features.*one.value;
    if (value == nothing.*one.value) continue;
    text += fmt::format(" {} {:.3g}{}{},", one.name, one.scale * value, one.unit.empty() ? "" : " ",
                        one.unit);
  }
  text.back() = '\n';
  text += fmt::format(
      "  largest change {:.1f} mm, volume {:.0f} % of the original's, smallest radius round it "
      "{:.1f} mm; a valid solid of {} faces, {} poles at most\n",
      outcome.change.largest, 100 * outcome.change.volume_ratio, outcome.change.smallest_radius,
      outcome.faces, outcome.poles);
  if (outcome.kept_deviation) {
    text += fmt::format("  what is kept lies within {:.2f} mm of the original\n",
                        *outcome.kept_deviation);
  }
  return text;
}

std::string search_text(const workflow::SearchStory& story) {
  const redesign::SearchResult& result = story.result;
  const std::string unit = story.goal.unit.empty() ? "" : " " + story.goal.unit;
  int failed = 0;
  for (const redesign::SearchTrial& trial : result.history)
    failed += trial.outcome.failure.empty() ? 0 : 1;
  std::string text = fmt::format("{}: {} candidates, {}, {}\n", story.goal.name,
                                 result.history.size(), result.method, result.ending);
  text += "  candidate";
  for (const redesign::SearchVariable& variable : story.problem.variables) {
    text += "  " + named(variable.name, variable.unit);
  }
  text += fmt::format("  goal{}  within constraints\n", unit.empty() ? "" : "," + unit);
  for (size_t i = 0; i < result.history.size(); ++i) {
    const redesign::SearchTrial& trial = result.history[i];
    text += fmt::format("  {:<9}", i + 1);
    for (size_t k = 0; k < trial.values.size(); ++k) {
      const redesign::SearchVariable& variable = story.problem.variables[k];
      text +=
          fmt::format("  {:<{}.4g}", trial.values[k], named(variable.name, variable.unit).size());
    }
    if (!trial.outcome.failure.empty()) {
      text += "  " + trial.outcome.failure + "\n";
      continue;
    }
    text += fmt::format("  {:.4f}  {}", trial.outcome.goal, trial.is_feasible ? "yes" : "no:");
    for (size_t k = 0; k < story.problem.constraints.size() && !trial.is_feasible; ++k) {
      const redesign::SearchConstraint& constraint = story.problem.constraints[k];
      if (redesign::excess(constraint, trial.outcome.constraint[k]) <= 0.0) continue;
      text += fmt::format(" {} {:.4g} {}", constraint.name, trial.outcome.constraint[k],
                          constraint.unit);
    }
    if (trial.outcome.is_rough()) {
      text += fmt::format(", broken off after {} hands", story.beside[i].hands);
    }
    text += result.best && *result.best == static_cast<int>(i) ? "  best\n" : "\n";
  }
  if (failed > 0) text += fmt::format("{} candidates can't be made or held\n", failed);
  if (!result.best) return text + "no candidate is within the constraints\n";
  const auto best = static_cast<size_t>(*result.best);
  const redesign::SearchTrial& trial = result.history[best];
  text += fmt::format("best: {}{:.4f}{}",
                      story.settings.empty() ? "" : words_of(story.settings, trial.values) + ": ",
                      trial.outcome.goal, unit);
  if (trial.outcome.goal_error > 0.0) text += fmt::format(" (SE {:.4f})", trial.outcome.goal_error);
  if (story.original.value != 0.0) {
    text += fmt::format("; the original {:.4f}{}: {:+.1f} %", story.original.value, unit,
                        100 * (trial.outcome.goal / story.original.value - 1));
  }
  text += "\n";
  for (size_t k = 0; k < story.problem.constraints.size(); ++k) {
    const redesign::SearchConstraint& constraint = story.problem.constraints[k];
    text += fmt::format("  {}: {:.4g} {} ({} {:.4g})\n", constraint.name,
                        trial.outcome.constraint[k], constraint.unit,
                        constraint.is_highest ? "at most" : "at least", constraint.limit);
  }
  const workflow::SearchStory::Beside& beside = story.beside[best];
  text += fmt::format(
      "  grip force {:.0f} % and volume {:.1f} % of the original's, {} of {} hands "
      "lose hold\n",
      100 * beside.grip_force_ratio, 100 * beside.volume_ratio, beside.lost, beside.hands);
  return text;
}

std::string proposals_text(const std::vector<workflow::TriedProposal>& tried,
                           const redesign::FeatureGoal& goal) {
  if (tried.empty()) return "no face is touched by a tenth of hands or more\n";
  std::string text = goal.name + ", each change tried once, best per millimetre first:\n";
  bool says_leave = false;
  for (const workflow::TriedProposal& one : tried) {
    if (one.verdict != workflow::ProposalVerdict::kChange && !says_leave) {
      says_leave = true;
      text += &one == &tried.front() ? "no change shows a gain in these hands; nothing should "
                                       "change for it:\n"
                                     : "no gain is shown of these; they should stay as they are:\n";
    }
    if (!one.outcome.failure.empty()) {
      text += fmt::format("  {:<28} {}\n", one.words, one.outcome.failure);
      continue;
    }
    text += fmt::format(
        "  {:<28} {:+6.1f} % (SE {:.1f}) for {:.2f} mm, {:+.1f} % per mm{}; {}\n", one.words,
        100 * one.gain, 100 * one.gain_error, one.largest_change, 100 * one.gain_per_mm(),
        one.verdict == workflow::ProposalVerdict::kNotAllowed ? ", beyond the constraints" : "",
        one.reason);
  }
  return text +
         "+ is better; --vary takes these words; give a range instead of the value to search it\n";
}

}  // namespace palmar::cli
