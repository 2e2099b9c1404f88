// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "grasp_evaluate_command.h"
#include "grasp_options.h"
#include "grasp_reach_command.h"
#include "palmar/io/assessment_json.h"
#include "palmar/io/file.h"
#include "palmar/io/product_file.h"
#include "text.h"

namespace palmar::cli {

namespace {

struct PlaceOptions {
  std::string product, out;
  GraspArguments grasp;
};

void add_place(CLI::App& grasp, Context& context) {
  const auto o = std::make_shared<PlaceOptions>();
  CLI::App* verb = add_verb(grasp, "place", "List the best ways of holding a product, best first",
                            "palmar grasp place marker.stl --unit mm --grip tripod");
  verb->add_option("PRODUCT", o->product, "Mesh file")->required();
  o->grasp.add_to(*verb);
  verb->add_option("--out", o->out, "JSON file to write: the list with postures and placements");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      const GraspOptions options = o->grasp.options();
      const Product product = load_product(o->product, {.unit = parse_unit(o->grasp.unit)});
      for (const std::string& text : product.notes) note(context.common, text);
      const auto hand = load_hand(o->grasp.hand);
      const Grasp best = find_grasp(*hand, product, options, make_progress(context.common));
      finish_progress();
      if (!o->out.empty()) write_file(o->out, placements_json(best) + "\n");
      print(context.common.json ? placements_json(best) + "\n" : placements_text(best));
      return 0;
    };
  });
}

}  // namespace

void add_grasp_commands(CLI::App& app, Context& context) {
  CLI::App* grasp = app.add_subcommand("grasp", "Grasps without contact simulation");
  grasp->require_subcommand(1);
  grasp->fallthrough();

  struct Options {
    std::string product, out;
    GraspArguments grasp;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(*grasp, "close", "Close a hand on a product",
                            "palmar grasp close handle.stl --unit mm --out grasp.json");
  verb->add_option("PRODUCT", o->product, "Mesh file")->required();
  o->grasp.add_to(*verb);
  verb->add_option("--out", o->out, "JSON file to write: posture, placement, what stopped it");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      const GraspOptions options = o->grasp.options();
      const Product product = load_product(o->product, {.unit = parse_unit(o->grasp.unit)});
      for (const std::string& text : product.notes) note(context.common, text);
      const auto hand = load_hand(o->grasp.hand);
      const Grasp closed = find_grasp(*hand, product, options, make_progress(context.common));
      finish_progress();
      if (!o->out.empty()) write_file(o->out, grasp_json(closed) + "\n");
      print(context.common.json ? grasp_json(closed) + "\n" : grasp_text(closed));
      return 0;
    };
  });
  add_place(*grasp, context);
  add_grasp_evaluate(*grasp, context);
  add_grasp_reach(*grasp, context);
}

}  // namespace palmar::cli
