// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/words/contact_words.h"

#include "palmar/core/error.h"
#include "palmar/workflow/words/number_words.h"

namespace palmar::workflow {
namespace {

contact::Kernel parse_kernel(const std::string& text) {
  for (const contact::Kernel kernel : contact::kKernels) {
    if (name_of(kernel) == text) return kernel;
  }
  throw UsageError("setting \"kernel\": \"" + text + "\" is not known; patch or point is allowed");
}

contact::RegionCoupling parse_coupling(const std::string& text) {
  for (const contact::RegionCoupling coupling : contact::kRegionCouplings) {
    if (name_of(coupling) == text) return coupling;
  }
  throw UsageError("setting \"coupling\": \"" + text +
                   "\" is not known; coupled or independent is allowed");
}

}  // namespace

contact::TissueModel parse_tissue_model(const std::string& text) {
  for (const contact::TissueModel tissue : contact::kTissueModels) {
    if (name_of(tissue) == text) return tissue;
  }
  throw UsageError("setting \"tissue model\": \"" + text +
                   "\" is not known; halfspace, layered or bone is allowed");
}

contact::ContactModel contact_model(const ContactModelWords& words) {
  const auto named = contact::contact_model_named(words.preset);
  if (!named) {
    throw UsageError("setting \"preset\": \"" + words.preset +
                     "\" is not known; palmar or xie2014 is allowed");
  }
  contact::ContactModel result = *named;
  if (!words.kernel.empty()) result.kernel = parse_kernel(words.kernel);
  if (!words.tissue_model.empty()) result.tissue = parse_tissue_model(words.tissue_model);
  if (!words.coupling.empty()) result.coupling = parse_coupling(words.coupling);
  return words.tissue_model.empty() ? contact::with_permitted_tissue(result) : result;
}

contact::Coating parse_coating(const std::string& text) {
  const std::string what = "setting \"coating\"";
  const std::vector<double> values = parse_list(what, text);
  const std::size_t count = values.size();
  if (count != 2 && count != 3 && count != 9) {
    throw UsageError(what + ": \"" + text + "\" has " + std::to_string(count) +
                     (count == 1 ? " number" : " numbers") +
                     "; thickness in mm and shear modulus in kPa are needed, then "
                     "Poisson's ratio, then the two corners of a box in mm (2, 3 or 9 numbers)");
  }
  contact::Coating result;
  result.thickness = values[0];
  result.shear_modulus = values[1] / 1000.0;
  if (count > 2) result.poisson = values[2];
  if (count == 9) {
    const Vec3 first(values[3], values[4], values[5]);
    const Vec3 second(values[6], values[7], values[8]);
    result.where.extend(first).extend(second);
    if (!((first - second).cwiseAbs().minCoeff() > 0.0)) {
      throw UsageError(what + ": \"" + text +
                       "\": the box is flat; its corners have to differ in x, y and z");
    }
  }
  try {
    contact::ContactOptions only_this;
    only_this.coatings = {result};
    only_this.check();
  } catch (const UsageError& error) {
    const std::string found = error.what();
    throw UsageError(what + ": \"" + text + "\": " + found +
                     (found.find("MPa") == found.npos ? "" : " (1 MPa = 1000 kPa)"));
  }
  return result;
}

}  // namespace palmar::workflow
