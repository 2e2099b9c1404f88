// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/grasp_evaluate.h"

#include "palmar/core/error.h"
#include "palmar/grasp/given_grasp.h"
#include "palmar/records/posture/coordination_file.h"
#include "palmar/records/posture/posture_file.h"
#include "palmar/report/page/assessment_report.h"
#include "palmar/workflow/hand/posture_notes.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {
namespace {

grasp::Grasp given_in(const EvaluateRequest& request, const hand::Hand& hand,
                      const product::Product& product) {
  const std::string& path = request.posture_file;
  const records::PostureFile file = records::read_postures(path, hand.skeleton);
  for (const std::string& text : file.notes) note_to(request.note, path + ": " + text);
  const records::PostureFrame frame = records::frame_of(file, path, request.frame);
  for (const std::string& text : frame_notes(frame)) note_to(request.note, text);
  std::optional<geometry::Rigid3> product_from_hand =
      request.product_from_hand ? request.product_from_hand : frame.product_from_hand;
  if (request.measured_from_product) {
    if (!frame.measured_from_hand) {
      throw UsageError("setting \"measured from product\": " + path +
                       " doesn't say where the hand is (measured_from_hand)");
    }
    product_from_hand = request.measured_from_product->inverse() * *frame.measured_from_hand;
  }
  if (!product_from_hand) {
    throw UsageError(path +
                     " doesn't say where the product is (product_from_hand); setting "
                     "\"product from hand\" or setting \"measured from product\" is needed");
  }
  grasp::Grasp grasp = grasp::given_grasp(hand, product, frame.posture, *product_from_hand);
  if (frame.grip) grasp.grip = *frame.grip;
  return grasp;
}

}  // namespace

void EvaluateRequest::check() const {
  product.check();
  if (posture_file.empty()) {
    throw UsageError("setting \"posture file\" is empty; a file is required");
  }
  if (product_from_hand && measured_from_product) {
    throw UsageError(
        "setting \"product from hand\" and setting \"measured from product\" exclude each other");
  }
  contact.check();
  friction.check();
}

EvaluateOutcome evaluate_grasp(const EvaluateRequest& request, const Progress& progress) {
  request.check();
  if (!request.out.empty()) report::check_report_folder(request.out);
  const product::Product product = load_product(request.product);
  study::AssessOptions options;
  options.contact = request.contact;
  options.friction = request.friction.options_for(product);
  options.seed = request.seed;
  for (const std::string& text : product.notes) {
    note_to(request.note, request.product.name() + ": " + text);
  }
  const auto hand = load_hand(request.hand);
  const grasp::Grasp grasp = given_in(request, *hand, product);
  if (!request.natural_postures.empty()) {
    options.indices.coordination =
        records::read_coordination(request.natural_postures, hand->skeleton);
  }
  if (progress.report) progress.report(0.0, "preparing the hand");
  const contact::PreparedHand prepared =
      prepared_hand(request.hand, hand, request.model, request.note);
  EvaluateOutcome outcome;
  outcome.set = {.hand = hand, .assessments = {}, .command_line = request.command_line};
  outcome.set.assessments.push_back(
      {product, study::evaluate(prepared, product, grasp, options, progress)});
  const contact::ContactResult& contact = outcome.set.assessments.front().assessment.contact;
  outcome.has_converged = contact.status != contact::ContactStatus::kNotConverged;
  if (!request.out.empty()) {
    report::write_report(request.out, outcome.set, {.pictures = request.pictures}, progress);
  }
  return outcome;
}

}  // namespace palmar::workflow
