// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_evaluate_command.h"

#include "assess/friction_arguments.h"
#include "grasp/grasp_options.h"
#include "hand/posture_notes.h"
#include "palmar/core/error.h"
#include "palmar/grasp/given_grasp.h"
#include "palmar/records/assessment_json.h"
#include "palmar/records/index_json.h"
#include "palmar/records/posture/coordination_file.h"
#include "palmar/records/posture/posture_file.h"
#include "palmar/records/product/product_file.h"
#include "palmar/report/page/assessment_report.h"
#include "palmar/study/assessment/assessment.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct EvaluateArguments {
  std::string product, unit, hand = "template", posture, grasp, placement, measured_from_product,
                             natural_postures, out;
  std::optional<int> frame;
  ContactArguments contact;
  FrictionArguments friction;
  bool no_pictures = false;
};

PostureFrame read_given(const EvaluateArguments& arguments, const Skeleton& skeleton,
                        const CommonOptions& common) {
  const bool is_grasp = !arguments.grasp.empty();
  const std::string& path = is_grasp ? arguments.grasp : arguments.posture;
  const PostureFile file = read_postures(path, skeleton);
  for (const std::string& text : file.notes) note(common, path + ": " + text);
  PostureFrame frame = frame_of(file, path, arguments.frame);
  note_frame(common, frame);
  if (!arguments.placement.empty()) {
    frame.product_from_hand = parse_placement("--placement", arguments.placement);
  }
  if (!arguments.measured_from_product.empty()) {
    if (!arguments.placement.empty()) {
      throw UsageError("--placement and --measured-from-product exclude each other");
    }
    if (!frame.measured_from_hand) {
      throw UsageError("--measured-from-product: " + path +
                       " doesn't say where the hand is (measured_from_hand)");
    }
    const Rigid3 measured_from_product =
        parse_placement("--measured-from-product", arguments.measured_from_product);
    frame.product_from_hand = measured_from_product.inverse() * *frame.measured_from_hand;
  }
  if (!frame.product_from_hand) {
    throw UsageError(path +
                     " doesn't say where the product is (product_from_hand); --placement "
                     "X,Y,Z,QW,QX,QY,QZ or --measured-from-product is needed");
  }
  return frame;
}

int run_evaluate(const EvaluateArguments& arguments, const Context& context) {
  if (arguments.posture.empty() == arguments.grasp.empty()) {
    throw UsageError("grasp evaluate: --posture FILE or --grasp FILE is needed, and not both");
  }
  AssessOptions options;
  options.contact = arguments.contact.options();
  options.seed = context.common.seed;
  const ContactModel model = arguments.contact.model();
  const Progress progress = make_progress(context.common);
  if (!arguments.out.empty()) check_report_folder(arguments.out);

  const Product product = load_product(arguments.product, {.unit = parse_unit(arguments.unit)});
  options.friction = arguments.friction.options_for(product);
  for (const std::string& text : product.notes) {
    note(context.common, arguments.product + ": " + text);
  }
  const auto hand = load_hand(arguments.hand, arguments.contact.tissue);
  const PostureFrame given = read_given(arguments, hand->skeleton, context.common);
  Grasp grasp = given_grasp(*hand, product, given.posture, *given.product_from_hand);
  if (given.grip) grasp.grip = *given.grip;

  if (!arguments.natural_postures.empty()) {
    options.indices.coordination = read_coordination(arguments.natural_postures, hand->skeleton);
  }
  if (progress.report) progress.report(0.0, "preparing the hand");
  const PreparedHand prepared(hand, model);
  AssessmentSet set{.hand = hand, .assessments = {}, .command_line = context.command_line};
  set.assessments.push_back({product, evaluate(prepared, product, grasp, options, progress)});
  const Assessment& assessment = set.assessments.front().assessment;
  if (!arguments.out.empty()) {
    write_report(arguments.out, set, {.pictures = !arguments.no_pictures}, progress);
  }
  finish_progress();
  if (context.common.json) {
    print(assessment_json(set) + "\n");
  } else {
    print(grasp_text(assessment.grasp) + contact_text(assessment.contact) +
          friction_text(*hand, assessment) + index_text(assessment.indices));
    if (!arguments.out.empty()) print("Report: " + arguments.out + "/report.html\n");
  }
  if (assessment.contact.status != ContactStatus::kNotConverged) return 0;
  note(context.common, assessment.contact.message);
  return 4;
}

}  // namespace

void add_grasp_evaluate(CLI::App& grasp, Context& context) {
  const auto o = std::make_shared<EvaluateArguments>();
  CLI::App* verb = add_verb(grasp, "evaluate",
                            "Contact and indices of a given posture and placement (no search)",
                            "palmar grasp evaluate handle.stl --grasp grasp.json");
  verb->add_option("PRODUCT", o->product, "Mesh file")->required();
  verb->add_option("--unit", o->unit, "Unit of the product's file: mm, cm, m or inch");
  verb->add_option("--hand", o->hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb->add_option("--posture", o->posture,
                   "Joint angles, JSON or CSV, as `palmar hand pose --out` writes them");
  verb->add_option("--grasp", o->grasp,
                   "Posture and placement: JSON of `palmar grasp close` or `palmar assess`");
  verb->add_option("--frame", o->frame, "Which posture of a file with several, from 1");
  verb->add_option("--placement", o->placement,
                   "product_from_hand: X,Y,Z in mm and a unit quaternion W,X,Y,Z; over the file's");
  verb->add_option("--measured-from-product", o->measured_from_product,
                   "Where the product is in the frame of the recording (or mesh) that the posture "
                   "was found from, as seven numbers likewise");
  o->contact.add_to(*verb);
  o->friction.add_to(*verb);
  verb->add_option("--natural-postures", o->natural_postures,
                   "CSV of measured grasp postures: basis of the index of ease");
  verb->add_option("--out", o->out, "Folder of the report; none by default");
  verb->add_flag("--no-pictures", o->no_pictures, "Leave out the PNG pictures");
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_evaluate(*o, context); }; });
}

}  // namespace palmar::cli
