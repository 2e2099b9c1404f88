// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/hand/hand_contact.h"

#include <array>
#include <cmath>
#include <string>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/contact/refine/refine_contact.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

void require(bool holds, const std::string& what, double value, const std::string& allowed) {
  if (holds) return;
  throw UsageError(what + " is " + std::to_string(value) + "; " + allowed + " is required");
}

/// The point kernel is no pressure that a cover could pass on; the thesis has no cover.
void check_kernel(const ContactModel& model, const ContactOptions& options) {
  if (model.kernel == Kernel::kPoint && !options.coatings.empty()) {
    throw UsageError(
        "kernel \"point\" knows no soft cover; kernel \"patch\" is required with a coating");
  }
  if (model.bulge == BulgeLaw::kPrinted && !options.coatings.empty()) {
    throw UsageError(
        "the equations of xie2014 know no soft cover; the preset palmar is required with a "
        "coating");
  }
}

}  // namespace

void ContactOptions::check() const {
  require(cell_area > 0.0 && cell_area <= 1000.0, "cell_area", cell_area,
          "more than 0 and at most 1000 mm^2");
  if (shear_modulus) {
    require(*shear_modulus > 0.0 && std::isfinite(*shear_modulus), "shear_modulus", *shear_modulus,
            "a finite value above 0");
  }
  for (const Coating& coating : coatings) {
    require(coating.thickness >= 0.05 && coating.thickness <= 50.0, "coating: thickness",
            coating.thickness, "0.05 to 50 mm");
    require(coating.shear_modulus >= 1e-4 && coating.shear_modulus <= 1e5, "coating: shear modulus",
            coating.shear_modulus, "0.0001 to 100000 MPa");
    require(coating.poisson >= 0.0 && coating.poisson <= 0.5, "coating: Poisson's ratio",
            coating.poisson, "0 to 0.5");
  }
}

ContactResult solve_region_contact(const PreparedHand& hand, const std::vector<Vec3>& posed_skin,
                                   const geometry::Rigid3& product_from_hand,
                                   const geometry::DistanceField& product,
                                   const ContactOptions& options,
                                   std::optional<hand::Region> only) {
  options.check();
  check_kernel(hand.model(), options);
  ContactSolver::Impl solver(hand, options);
  ContactResult result;
  solver.solve(posed_skin, product_from_hand, product, only, result);
  return result;
}

ContactResult solve_hand_contact(const PreparedHand& prepared, const std::vector<Vec3>& posed_skin,
                                 const geometry::Rigid3& product_from_hand,
                                 const geometry::DistanceField& product,
                                 const ContactOptions& options) {
  options.check();
  check_kernel(prepared.model(), options);
  ContactSolver::Impl solver(prepared, options);
  ContactResult result;
  solver.solve(posed_skin, product_from_hand, product, std::nullopt, result);
  refine_contact(solver, product, result);
  return result;
}

ContactSolver::ContactSolver(const PreparedHand& prepared, const ContactOptions& options)
    : impl_(std::make_unique<Impl>(prepared, options)) {
  options.check();
  check_kernel(prepared.model(), options);
}
ContactSolver::~ContactSolver() = default;
ContactSolver::ContactSolver(ContactSolver&&) noexcept = default;
ContactSolver& ContactSolver::operator=(ContactSolver&&) noexcept = default;

void ContactSolver::solve(const std::vector<Vec3>& posed_skin,
                          const geometry::Rigid3& product_from_hand,
                          const geometry::DistanceField& product, ContactResult& result) {
  impl_->solve(posed_skin, product_from_hand, product, std::nullopt, result);
}

}  // namespace palmar::contact
