// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_evaluate_command.h"

#include "assess/balance_arguments.h"
#include "assess/friction_arguments.h"
#include "grasp/grasp_options.h"
#include "hand/posture_notes.h"
#include "palmar/core/error.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/records/assessment/index_json.h"
#include "palmar/workflow/grasp/grasp_evaluate.h"
#include "plain_names.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct EvaluateArguments {
  std::string product, unit, hand = "template", posture, grasp, placement, measured_from_product,
                             natural_postures, out;
  std::optional<int> frame;
  ContactArguments contact;
  FrictionArguments friction;
  std::string person;
  bool left = false;
  bool no_pictures = false;
};

workflow::EvaluateRequest request_of(const EvaluateArguments& arguments, const Context& context) {
  if (arguments.posture.empty() == arguments.grasp.empty()) {
    throw UsageError("grasp evaluate: --posture FILE or --grasp FILE is needed, and not both");
  }
  workflow::EvaluateRequest request;
  request.contact = arguments.contact.options();
  request.model = arguments.contact.model();
  request.friction = arguments.friction.settings();
  request.product = {arguments.product, {.unit = parse_unit(arguments.unit)}};
  request.hand = {.name = arguments.hand,
                  .tissue = arguments.contact.tissue,
                  .value = nullptr,
                  .person = workflow::parse_person_size(arguments.person),
                  .is_left = arguments.left};
  request.posture_file = arguments.grasp.empty() ? arguments.posture : arguments.grasp;
  request.frame = arguments.frame;
  if (!arguments.placement.empty()) {
    request.product_from_hand = parse_placement("--placement", arguments.placement);
  }
  if (!arguments.measured_from_product.empty()) {
    request.measured_from_product =
        parse_placement("--measured-from-product", arguments.measured_from_product);
  }
  request.natural_postures = arguments.natural_postures;
  request.out = arguments.out;
  request.pictures = !arguments.no_pictures;
  request.seed = context.common.seed;
  request.command_line = context.command_line;
  request.note = [&context](const std::string& text) { note(context.common, text); };
  return request;
}

int run_evaluate(const EvaluateArguments& arguments, const Context& context) {
  const workflow::EvaluateRequest request = request_of(arguments, context);
  const workflow::EvaluateOutcome outcome =
      workflow::evaluate_grasp(request, make_progress(context.common));
  finish_progress();
  const study::Assessment& assessment = outcome.set.assessments.front().assessment;
  if (context.common.json) {
    print(records::assessment_json(outcome.set) + "\n");
  } else {
    print(grasp_text(assessment.grasp) + contact_text(assessment.contact) +
          friction_text(*outcome.set.hand, assessment) +
          with_plain_names(records::index_text(assessment.indices)));
    if (!arguments.out.empty()) print("Report: " + arguments.out + "/report.html\n");
  }
  if (outcome.has_converged) return 0;
  note(context.common, assessment.contact.message);
  return 4;
}

}  // namespace

void add_grasp_evaluate(CLI::App& grasp, Context& context) {
  const auto o = std::make_shared<EvaluateArguments>();
  CLI::App* verb = add_verb(grasp, "evaluate",
                            "Contact and indices of a given posture and placement (no search)",
                            "palmar grasp evaluate handle.step --grasp grasp.json");
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  verb->add_option("--unit", o->unit, "Unit of the product's file: mm, cm, m or inch");
  verb->add_option("--hand", o->hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb->add_option("--person", o->person,
                   "To whose size the hand is scaled: woman or man with a percentile of hand size "
                   "(ANSUR II), as woman:P5");
  verb->add_flag("--left", o->left, "A left hand");
  verb->add_option("--posture", o->posture,
                   "Joint angles, JSON or CSV, as `palmar hand pose --out` writes them");
  verb->add_option("--grasp", o->grasp,
                   "Posture and placement: JSON of `palmar grasp close` or `palmar assess`");
  verb->add_option("--frame", o->frame, "Posture of a file that has several, counted from 1");
  verb->add_option(
      "--placement", o->placement,
      "product_from_hand: X,Y,Z in mm and a unit quaternion W,X,Y,Z; replaces that of the file");
  verb->add_option("--measured-from-product", o->measured_from_product,
                   "Where the product is in the frame of the recording (or mesh) that the posture "
                   "was found from, as seven numbers like the placement");
  o->contact.add_to(*verb);
  o->friction.add_to(*verb);
  verb->add_option("--natural-postures", o->natural_postures,
                   "CSV of measured grasp postures: basis of the index of ease");
  verb->add_option("--out", o->out, "Folder of the report; none by default");
  verb->add_flag("--no-pictures", o->no_pictures, "Leave out the PNG pictures");
  verb->callback([&context, o] {
    context.setting_options = {{"product from hand", "--placement"}};
    context.run = [&context, o] { return run_evaluate(*o, context); };
  });
}

}  // namespace palmar::cli
