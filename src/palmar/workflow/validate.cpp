// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/validate.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/validation_json.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {

void ValidateRequest::check() const {
  if (!out.empty() && (out.size() < 4 || !out.ends_with(".md")) &&
      (out.size() < 6 || !out.ends_with(".json"))) {
    throw UsageError("setting \"out\": \"" + out + "\" ends with none of .md, .json");
  }
  options.check();
}

validation::ValidationReport run_validation(const ValidateRequest& request,
                                            const Progress& progress) {
  request.check();
  const auto hand = load_hand(request.hand);
  validation::ValidationOptions options = request.options;
  options.compliance = tissue_on_bone(*hand, contact::palmar_model(), request.note);
  const validation::ValidationReport report = validation::validate(hand, options, progress);
  if (request.out.empty()) return report;
  formats::write_file(request.out, request.out.ends_with(".md")
                                       ? validation::validation_markdown(report)
                                       : records::validation_json(report) + "\n");
  return report;
}

}  // namespace palmar::workflow
