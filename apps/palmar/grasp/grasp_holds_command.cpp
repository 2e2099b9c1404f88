// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_holds_command.h"

#include <fmt/format.h>

#include "grasp/hold_arguments.h"
#include "output_guard.h"
#include "palmar/core/error.h"
#include "palmar/records/hold/hold_json.h"
#include "palmar/workflow/grasp/grasp_holds.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct HoldsArguments {
  std::string product, unit, hand = "template", grip = "any", png, out;
  HoldArguments holds;
  grasp::HoldOptions options;
};

workflow::GraspHoldsRequest holds_request(const HoldsArguments& o, const Context& context) {
  grasp::GraspSettings settings;
  settings.grip = workflow::parse_grip(o.grip);
  settings.is_power_only = o.grip == "power";
  settings.holding = o.holds.request();
  workflow::GraspHoldsRequest request;
  request.options = settings.options().holds;
  request.options.most = o.options.most;
  request.options.mass = o.options.mass;
  request.product = {o.product, {.unit = parse_unit(o.unit)}};
  request.hand.name = o.hand;
  request.picture = o.png;
  request.out = o.out;
  request.note = [&context](const std::string& text) { note(context.common, text); };
  return request;
}

std::string column(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

std::string holds_text(const workflow::GraspHoldsOutcome& outcome) {
  const grasp::RankedHolds& ranked = outcome.ranked;
  std::string text = fmt::format(
      "{}: {} hold{} ({} considered, {} tried with the hand)\n", outcome.product.name,
      ranked.holds.size(), ranked.holds.size() == 1 ? "" : "s", ranked.considered, ranked.closed);
  if (ranked.holds.empty()) return text;
  std::size_t part_width = 4, grip_width = 4;
  for (const grasp::RankedHold& one : ranked.holds) {
    part_width = std::max(part_width, one.hold.part_name.size() + 3);
    grip_width = std::max(grip_width, name_of(one.hold.grip).size());
  }
  text +=
      fmt::format("{:>2}  {}  {}  {:>5}  {:<16} {:>6}  {}\n", "", column("part", part_width),
                  column("grip", grip_width), "along", "thumb's side to", "score", "against it");
  for (std::size_t k = 0; k < ranked.holds.size(); ++k) {
    const grasp::RankedHold& one = ranked.holds[k];
    text += fmt::format(
        "{:>2}  {}  {}  {:>5}  {:<16} {:>6.1f}  {}\n", k + 1,
        column(fmt::format("{} {}", one.hold.part, one.hold.part_name), part_width),
        column(std::string(name_of(one.hold.grip)), grip_width),
        fmt::format("{:.0f} %", 100.0 * one.hold.along),
        records::direction_words(records::thumb_direction(one.grasp, outcome.hand->side)),
        one.score, one.against);
  }
  return text +
         "score: 0 at best; each 0.7 less is a hold that half as many people would choose. Less "
         "than "
         "0.2 is no\ndifference: number 1 may score that much less than number 2\n";
}

int run_holds(const HoldsArguments& o, const Context& context) {
  if (!o.png.empty()) refuse_same_file(o.product, o.png);
  const workflow::GraspHoldsOutcome outcome =
      workflow::find_holds(holds_request(o, context), make_progress(context.common));
  finish_progress();
  print(context.common.json
            ? records::ranked_holds_json(outcome.ranked, outcome.product.name, outcome.hand->side) +
                  "\n"
            : holds_text(outcome));
  for (const std::string& file : outcome.files) note(context.common, "wrote " + file);
  return outcome.ranked.holds.empty() ? 5 : 0;
}

}  // namespace

void add_grasp_holds(CLI::App& grasp, Context& context) {
  const auto o = std::make_shared<HoldsArguments>();
  CLI::App* verb = add_verb(grasp, "holds", "Show the ways in which people would hold a product",
                            "palmar grasp holds handle.step --png sheet.png");
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  verb->add_option("--hand", o->hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb->add_option("--grip", o->grip, "Only holds of this grip: " + workflow::grip_list())
      ->capture_default_str();
  o->holds.add_to(*verb);
  verb->add_option("--mass-kg", o->options.mass,
                   "Mass of the product, kg; from its volume at 1 g/cm3 if not given");
  verb->add_option("--most", o->options.most, "Number of holds to show")->capture_default_str();
  verb->add_option("--unit", o->unit,
                   "Unit of files that carry none (STL, OBJ, PLY): mm, cm, m, "
                   "inch");
  verb->add_option("--png", o->png, "Picture sheet to write: the best eight, numbered");
  verb->add_option("--out", o->out,
                   "Folder to write: hold-1.toml, hold-2.toml, ... for --hold, and sheet.png");
  verb->callback([&context, o] {
    context.setting_options["picture"] = "--png";
    context.run = [&context, o] { return run_holds(*o, context); };
  });
}

}  // namespace palmar::cli
