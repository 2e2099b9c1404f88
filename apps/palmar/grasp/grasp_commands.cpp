// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "grasp/grasp_evaluate_command.h"
#include "grasp/grasp_fit_holds_command.h"
#include "grasp/grasp_holds_command.h"
#include "grasp/grasp_options.h"
#include "grasp/grasp_reach_command.h"
#include "palmar/formats/file.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/workflow/grasp/grasp.h"
#include "text.h"

namespace palmar::cli {

namespace {

struct GraspVerb {
  const char *name, *about, *example, *out;
  std::string (*json)(const grasp::Grasp&);
  std::string (*text)(const grasp::Grasp&);
};

// A verb that finds a grasp of a product and describes it.
void add_grasp_verb(CLI::App& grasp, Context& context, const GraspVerb& kind) {
  struct Options {
    std::string product, out;
    GraspArguments grasp;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(grasp, kind.name, kind.about, kind.example);
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  o->grasp.add_to(*verb);
  verb->add_option("--out", o->out, kind.out);
  verb->callback([&context, o, kind] {
    context.run = [&context, o, kind] {
      workflow::GraspRequest request;
      request.grasp = o->grasp.settings();
      request.product = {o->product, {.unit = parse_unit(o->grasp.unit)}};
      request.hand.name = o->grasp.hand;
      request.note = [&context](const std::string& text) { note(context.common, text); };
      const grasp::Grasp found =
          workflow::grasp_product(request, make_progress(context.common)).grasp;
      finish_progress();
      if (!o->out.empty()) formats::write_file(o->out, kind.json(found) + "\n");
      print(context.common.json ? kind.json(found) + "\n" : kind.text(found));
      return 0;
    };
  });
}

}  // namespace

void add_grasp_commands(CLI::App& app, Context& context) {
  CLI::App* grasp = app.add_subcommand("grasp", "Grasps without contact simulation");
  grasp->require_subcommand(1);
  grasp->fallthrough();
  add_grasp_verb(*grasp, context,
                 {.name = "close",
                  .about = "Close a hand on a product",
                  .example = "palmar grasp close handle.step --out grasp.json",
                  .out = "JSON file to write: posture, placement, what stopped each segment",
                  .json = records::grasp_json,
                  .text = grasp_text});
  add_grasp_verb(*grasp, context,
                 {.name = "place",
                  .about = "List the best placements of a product in the hand, best first",
                  .example = "palmar grasp place handle.step --grip tripod",
                  .out = "JSON file to write: the list with postures and placements",
                  .json = records::placements_json,
                  .text = placements_text});
  add_grasp_holds(*grasp, context);
  add_grasp_fit_holds(*grasp, context);
  add_grasp_evaluate(*grasp, context);
  add_grasp_reach(*grasp, context);
}

}  // namespace palmar::cli
