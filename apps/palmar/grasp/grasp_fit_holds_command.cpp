// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_fit_holds_command.h"

#include <fmt/format.h>

#include "palmar/records/hold/people_holds_file.h"
#include "palmar/workflow/grasp/fit_holds.h"
#include "text.h"

namespace palmar::cli {
namespace {

std::string fit_text(const grasp::HoldFit& fit) {
  std::string text = "feature                     weight  not knowing up\n";
  for (int k = 0; k < grasp::kHoldFeatureCount; ++k) {
    const std::string_view name = name_of(static_cast<grasp::HoldFeature>(k));
    text += fmt::format("{:<26} {:7.2f} {:15.2f}\n", name, fit.weights.weight[k],
                        fit.weights.unseen[k]);
  }
  text += fmt::format("log-likelihood per hold {:.3f}, of the holds that it was fitted to\n\n",
                      fit.likelihood);
  text +=
      "object left out           holds  log-likelihood  not knowing up  even chances  first hold  "
      "best of 8  "
      "nearest candidate\n";
  double likelihood = 0.0, unseen = 0.0, even = 0.0, holds = 0.0;
  for (const grasp::LeftOut& one : fit.left_out) {
    text += fmt::format(
        "{:<25} {:5d} {:15.2f} {:15.2f} {:13.2f} {:8.0f} mm {:7.0f} mm {:12.0f} mm\n", one.name,
        one.seen, one.likelihood, one.unseen, one.even, one.first, one.best_of_eight, one.nearest);
    likelihood += one.seen * one.likelihood;
    unseen += one.seen * one.unseen;
    even += one.seen * one.even;
    holds += one.seen;
  }
  return text + fmt::format("all                       {:5.0f} {:15.2f} {:15.2f} {:13.2f}\n", holds,
                            likelihood / holds, unseen / holds, even / holds);
}

int run_fit(const workflow::FitHoldsRequest& request, const Context& context) {
  const grasp::HoldFit fit = workflow::fit_holds(request, make_progress(context.common));
  finish_progress();
  print(context.common.json ? records::hold_fit_json(fit) + "\n" : fit_text(fit));
  if (!request.out.empty()) note(context.common, "wrote " + request.out);
  return 0;
}

}  // namespace

void add_grasp_fit_holds(CLI::App& grasp, Context& context) {
  const auto o = std::make_shared<workflow::FitHoldsRequest>();
  CLI::App* verb = add_verb(
      grasp, "fit-holds", "Fit the weights by which a hold is chosen to how people held objects",
      "palmar grasp fit-holds people.csv --products objects --out weights.toml");
  verb->add_option("TABLE", o->table,
                   "CSV file: object, wrist_x_mm, wrist_y_mm, wrist_z_mm, thumb_x_mm ... "
                   "little_z_mm, up_x, up_y, up_z, a row per hold in the object's frame")
      ->required();
  verb->add_option("--products", o->products,
                   "Folder with the objects' meshes in mm, named as in the table: OBJECT.obj, .stl "
                   "or .ply")
      ->required();
  verb->add_option("--hand", o->hand.name,
                   "\"template\" or a .hand.glb file: a right hand of the people's size")
      ->capture_default_str();
  verb->add_option("--out", o->out, "TOML file of the weights to write, for --hold-weights");
  verb->callback([&context, o] { context.run = [&context, o] { return run_fit(*o, context); }; });
}

}  // namespace palmar::cli
