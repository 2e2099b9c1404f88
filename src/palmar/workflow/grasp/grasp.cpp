// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/grasp.h"

#include "palmar/core/error.h"
#include "palmar/grasp/given_grasp.h"
#include "palmar/records/posture/posture_file.h"
#include "palmar/workflow/grasp/hold_product.h"

namespace palmar::workflow {

void GraspRequest::check() const {
  product.check();
  grasp.check();
}

GraspOutcome grasp_product(const GraspRequest& request, const Progress& progress) {
  request.check();
  GraspOutcome outcome;
  outcome.product = load_product(request.product);
  const grasp::GraspOptions options = options_for(request.grasp, outcome.product);
  for (const std::string& text : outcome.product.notes) note_to(request.note, text);
  outcome.hand = load_hand(request.hand);
  outcome.grasp =
      request.grasp_file.empty()
          ? hold_product(outcome.hand, outcome.product, request.grasp, options, progress)
          : read_grasp(request.grasp_file, *outcome.hand, outcome.product);
  return outcome;
}

grasp::Grasp read_grasp(const std::string& file, const hand::Hand& hand,
                        const product::Product& product) {
  const records::PostureFile postures = records::read_postures(file, hand.skeleton);
  const records::PostureFrame frame = records::frame_of(postures, file, std::nullopt);
  if (!frame.product_from_hand) {
    throw UsageError(file + " doesn't say where the product is (product_from_hand)");
  }
  grasp::Grasp grasp = grasp::given_grasp(hand, product, frame.posture, *frame.product_from_hand);
  if (frame.grip) grasp.grip = *frame.grip;
  return grasp;
}

}  // namespace palmar::workflow
