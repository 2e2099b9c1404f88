// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/contact.h"

namespace palmar::contact {

ContactModel palmar_model() { return {.tissue = TissueModel::kBone}; }

ContactModel with_permitted_tissue(ContactModel model) {
  const bool is_one_body =
      model.kernel == Kernel::kPatch && model.coupling == RegionCoupling::kCoupled;
  if (model.tissue == TissueModel::kBone && !is_one_body) model.tissue = TissueModel::kHalfSpace;
  return model;
}

ContactModel xie2014_model() {
  return {.kernel = Kernel::kPoint,
          .tissue = TissueModel::kHalfSpace,
          .coupling = RegionCoupling::kIndependent,
          .distance = SkinDistance::kIsomap,
          .bulge = BulgeLaw::kPrinted};
}

std::optional<ContactModel> contact_model_named(const std::string& preset) {
  if (preset == "palmar") return palmar_model();
  if (preset == "xie2014") return xie2014_model();
  return std::nullopt;
}

std::string_view name_of(Kernel kernel) { return kernel == Kernel::kPatch ? "patch" : "point"; }

std::string_view name_of(TissueModel tissue) {
  if (tissue == TissueModel::kHalfSpace) return "halfspace";
  return tissue == TissueModel::kLayered ? "layered" : "bone";
}

std::string_view name_of(RegionCoupling coupling) {
  return coupling == RegionCoupling::kCoupled ? "coupled" : "independent";
}

std::string_view name_of(SkinDistance distance) {
  return distance == SkinDistance::kSurface ? "surface" : "isomap";
}

std::string_view name_of(BulgeLaw bulge) { return bulge == BulgeLaw::kHeld ? "held" : "printed"; }

std::string name_of(const ContactModel& model) {
  const ContactModel palmar = palmar_model();
  if (model == xie2014_model()) return "xie2014";
  std::string name = "palmar";
  const auto add = [&](bool differs, std::string_view what) {
    if (differs) name += ", " + std::string(what);
  };
  add(model.kernel != palmar.kernel, name_of(model.kernel));
  add(model.tissue != palmar.tissue, name_of(model.tissue));
  add(model.coupling != palmar.coupling, name_of(model.coupling));
  add(model.distance != palmar.distance, std::string(name_of(model.distance)) + " distances");
  add(model.bulge != palmar.bulge, std::string(name_of(model.bulge)) + " bulge");
  return name;
}

}  // namespace palmar::contact
