// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_reach_command.h"

#include <fmt/format.h>

#include "grasp/grasp_options.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/reach_json.h"
#include "palmar/workflow/grasp/grasp_reach.h"
#include "plain_names.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct ReachArguments {
  std::string product, out, map, grasp_file;
  std::vector<std::string> buttons;
  int map_points = workflow::ReachRequest{}.map_points;
  GraspArguments grasp;
};

/// NAME:X,Y,Z[:FX,FY,FZ]
grasp::Button parse_button(const std::string& text) {
  const std::size_t first = text.find(':');
  if (first == text.npos || first == 0) {
    throw UsageError("--button: \"" + text +
                     "\" is not understood; NAME:X,Y,Z or NAME:X,Y,Z:FX,FY,FZ is required "
                     "(mm and N, the product's frame)");
  }
  const std::size_t second = text.find(':', first + 1);
  grasp::Button button;
  button.name = text.substr(0, first);
  button.point = workflow::parse_vector("--button", text.substr(first + 1, second - first - 1));
  if (second != text.npos)
    button.force = workflow::parse_vector("--button", text.substr(second + 1));
  return button;
}

std::string reach_text(const grasp::Grasp& grasp, const std::vector<grasp::ButtonReach>& buttons) {
  std::string text = status_text(grasp);
  for (const grasp::ButtonReach& reach : buttons) {
    text += fmt::format(
        "\n{}: {}\n  finger        reached  miss (mm)  pad tilt (deg)  margin (deg)  "
        "grip kept\n",
        reach.button.name, with_plain_names(reach.message));
    for (const grasp::FingerReach& one : reach.fingers) {
      const char* words = one.is_reached   ? one.is_awkward ? "awkward" : "yes"
                          : one.is_blocked ? "blocked"
                                           : "no";
      text += one.miss > 50.0
                  ? fmt::format("  {:<13} {:<8}    > 50\n", finger_words(one.finger), words)
                  : fmt::format("  {:<13} {:<8} {:9.1f} {:14.0f} {:13.0f}    {}\n",
                                finger_words(one.finger), words, one.miss, degrees(one.tilt),
                                degrees(one.margin), one.is_grip_kept ? "yes" : "no");
    }
  }
  return text;
}

workflow::ReachRequest request_of(const ReachArguments& o, const Context& context) {
  if (o.buttons.empty() && o.map.empty()) {
    throw UsageError("grasp reach: --button NAME:X,Y,Z or --map FILE.vtp is needed");
  }
  workflow::ReachRequest request;
  for (const std::string& text : o.buttons) request.buttons.push_back(parse_button(text));
  request.map = o.map;
  request.map_points = o.map_points;
  request.grasp.grasp = o.grasp.settings();
  request.grasp.product = {o.product, {.unit = parse_unit(o.grasp.unit)}};
  request.grasp.hand.name = o.grasp.hand;
  request.grasp.grasp_file = o.grasp_file;
  request.grasp.note = [&context](const std::string& text) { note(context.common, text); };
  return request;
}

int run_reach(const ReachArguments& o, const Context& context) {
  const workflow::ReachOutcome outcome =
      workflow::reach_of_grasp(request_of(o, context), make_progress(context.common));
  finish_progress();
  const grasp::Grasp& grasp = outcome.held.grasp;
  const std::string json =
      records::reach_json(grasp, outcome.buttons, outcome.map ? &*outcome.map : nullptr,
                          outcome.surface_area) +
      "\n";
  if (!o.out.empty()) formats::write_file(o.out, json);
  std::string text = reach_text(grasp, outcome.buttons);
  if (outcome.map) {
    text += fmt::format("\nmap: {:.0f} of {:.0f} mm2 of the surface reached, written to {}\n",
                        outcome.map->reached_area, outcome.surface_area, o.map);
  }
  print(context.common.json ? json : text);
  return 0;
}

}  // namespace

void add_grasp_reach(CLI::App& grasp, Context& context) {
  const auto o = std::make_shared<ReachArguments>();
  CLI::App* verb = add_verb(grasp, "reach", "Which fingers reach buttons while the product is held",
                            "palmar grasp reach handle.step --button trigger:20,0,-50");
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  verb->add_option("--button", o->buttons,
                   "Point that is pressed, may be given several times: NAME:X,Y,Z in mm, or "
                   "NAME:X,Y,Z:FX,FY,FZ with the finger's force on the product in N; default: "
                   "straight into the surface")
      ->allow_extra_args(false);
  o->grasp.add_to(*verb);
  verb->add_option("--grasp", o->grasp_file,
                   "JSON of a grasp to start from, as grasp close writes it, instead of searching");
  verb->add_option(
      "--map", o->map,
      "VTP file to write: which finger reaches each point of the surface, and with what margin");
  verb->add_option("--map-points", o->map_points,
                   "Number of points of the surface that the map tries")
      ->capture_default_str();
  verb->add_option("--out", o->out, "JSON file to write");
  verb->callback([&context, o] { context.run = [&context, o] { return run_reach(*o, context); }; });
}

}  // namespace palmar::cli
