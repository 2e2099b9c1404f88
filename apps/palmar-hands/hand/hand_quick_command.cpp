// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_quick_command.h"

#include <fmt/format.h>

#include <optional>

#include "hand/side_argument.h"
#include "hands/person_workflow/hand_quick.h"
#include "palmar/core/error.h"

namespace palmar::cli {
namespace {

struct QuickArguments {
  person_workflow::HandQuickRequest request;
  std::string side;
  std::optional<double> length, circumference, width;  // mm
  std::vector<std::string> dimensions;
};

std::vector<hand::SizedDimension> measured_sizes(const QuickArguments& arguments) {
  std::vector<hand::SizedDimension> sizes;
  const auto add = [&](hand::HandDimension dimension, const std::optional<double>& value) {
    if (value) sizes.push_back({dimension, *value});
  };
  add({hand::DimensionKind::kHandLength}, arguments.length);
  add({hand::DimensionKind::kHandCircumference}, arguments.circumference);
  add({hand::DimensionKind::kHandWidth}, arguments.width);
  for (const std::string& setting : arguments.dimensions) {
    const std::size_t equals = setting.find('=');
    const auto dimension = hand::hand_dimension_named(setting.substr(0, equals));
    if (equals == std::string::npos || !dimension) {
      throw UsageError("--dimension: \"" + setting +
                       "\" is not of the form index_distal_width=14 "
                       "(mm); palmar hand measure lists the names");
    }
    add(*dimension, workflow::parse_list("--dimension", setting.substr(equals + 1)).front());
  }
  return sizes;
}

std::string text_of(const population::PersonEstimate& estimate,
                    const population::Population& population) {
  std::string text = fmt::format("{:<26} {:>8} {:>8}  (mm; 95 of 100 such hands are within +-)\n",
                                 "dimension", "value", "+-");
  for (const population::EstimatedDimension& one : estimate.dimensions) {
    text += fmt::format("{:<26} {:8.1f} {:8.1f}  {}\n", name_of(one.dimension), one.value,
                        1.96 * one.sd, person_workflow::how_known(one));
  }
  if (population.strata.size() > 1) {
    text += "as among";
    for (std::size_t s = 0; s < population.strata.size(); ++s) {
      text +=
          fmt::format(" {} {:.0f} %", population.strata[s].name, 100.0 * estimate.stratum_share[s]);
    }
    text += "\n";
  }
  return text;
}

int run_quick(const QuickArguments& arguments, const Context& context) {
  person_workflow::HandQuickRequest request = arguments.request;
  request.sizes = measured_sizes(arguments);
  if (!arguments.side.empty()) request.side = parse_side(arguments.side);
  request.note = [&context](const std::string& text) { note(context.common, text); };
  const person_workflow::HandQuickOutcome outcome = person_workflow::make_hand_quick(request);
  print(context.common.json ? person_workflow::hand_quick_json(outcome)
                            : text_of(outcome.person.estimate, outcome.population));
  return 0;
}

}  // namespace

void add_hand_quick(CLI::App& hand, Context& context) {
  const auto o = std::make_shared<QuickArguments>();
  CLI::App* verb =
      add_verb(hand, "quick",
               "A hand from a few measurements, or from one photograph of it flat on a sheet of A4 "
               "or beside a bank card, and a population; says how well each dimension is known",
               "palmar hand quick --hand-length-mm 181 --circumference-mm 190 --out anna.hand.glb");
  verb->add_option(
      "PHOTO", o->request.photo,
      "PNG or JPEG: the hand palm down on a white sheet, fingers spread, the crease of "
      "the wrist over the sheet's edge; or on a plain table, an edge of a bank card beside it "
      "level "
      "with that crease (--sheet card)");
  verb->add_option("--hand-length-mm", o->length, "Wrist crease to tip of the middle finger");
  verb->add_option("--circumference-mm", o->circumference, "Girth over the metacarpal heads");
  verb->add_option("--width-mm", o->width, "Breadth over the metacarpal heads");
  verb->add_option("--dimension", o->dimensions,
                   "Any other dimension, NAME=MM; may be given several times")
      ->allow_extra_args(false);
  verb->add_option("--known", o->request.known,
                   "TOML file of what is known of the person: side, measures");
  verb->add_option("--error-mm", o->request.error, "Standard error of what you measured by hand")
      ->capture_default_str();
  verb->add_option("--population", o->request.population,
                   "Population that the person belongs to: a name or a .toml file")
      ->capture_default_str();
  verb->add_option("--sheet", o->request.sheet,
                   "a4, letter or card; default: a sheet, recognised by its shape");
  verb->add_option(
          "--wrist-inside-mm", o->request.wrist_inside,
          "How far inside the sheet's edge the crease of the wrist is, or beyond the card's")
      ->capture_default_str();
  verb->add_flag("--palm-up", o->request.palm_up, "The palm faces the camera");
  verb->add_option("--side", o->side, "right or left; with a photograph only checked");
  verb->add_option("--picture", o->request.picture,
                   "PNG to write: the photograph with what was found drawn on it");
  verb->add_option("--out", o->request.out, "File to write, *.hand.glb");
  verb->callback([&context, o] { context.run = [&context, o] { return run_quick(*o, context); }; });
}

}  // namespace palmar::cli
