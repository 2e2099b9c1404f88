// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "palmar/contact/contact.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/product/product_choice.h"

#include "arguments.h"

namespace palmar::python {

namespace py = pybind11;

// Each adds its part to the module.
void bind_values(py::module_& module);     ///< Product, Hand
void bind_assess(py::module_& module);     ///< assess, its outcome
void bind_products(py::module_& module);   ///< products read, checked, made
void bind_hands(py::module_& module);      ///< hands and populations
void bind_contact(py::module_& module);    ///< press, fit
void bind_effort(py::module_& module);     ///< grasp, capacity, fingertip
void bind_studies(py::module_& module);    ///< run, plan, status, report, tables ...
void bind_redesigns(py::module_& module);  ///< shape, press, region, features

/// What Python holds of a product, a hand, an outcome: pybind11 knows no pointer to const, but
/// everything that it offers of them only reads.
template <typename Value>
std::shared_ptr<Value> for_python(std::shared_ptr<const Value> value) {
  return std::const_pointer_cast<Value>(std::move(value));
}
template <typename Value>
std::shared_ptr<Value> for_python(Value value) {
  return std::make_shared<Value>(std::move(value));
}

// Arguments that several tasks share.

/// A Product, or the path of a file with `unit`, `chordal_error_mm`, `time_limit_s` and
/// `memory_limit_mb`.
workflow::ProductChoice product_choice(py::handle product,
                                       const records::LoadProductOptions& reading);
records::LoadProductOptions reading_of(Arguments& arguments);
/// `hand` (a Hand, "template" or a path), `tissue`, `left` and, of `person`, the size.
workflow::HandChoice hand_choice(Arguments& arguments, const std::string& person = {});
/// `hold`, `part`, `along`, `toward`, `up`, `purpose`.
grasp::HoldRequest holding_of(Arguments& arguments);
/// How the hand is placed and closed: `grip` and the depths, `at`, `axis` ... and holding_of().
grasp::GraspSettings grasp_of(Arguments& arguments);
/// `preset`, `kernel`, `tissue_model`, `coupling`.
contact::ContactModel model_of(Arguments& arguments);
/// `swelling`, `shear_modulus_kpa`, `coating` ..., over `usual`.
contact::ContactOptions contact_of(Arguments& arguments, contact::ContactOptions usual);
/// `friction`, `mass_kg`, `weight_n`, `density_g_cm3`, `acceleration_g`, `gravity`, loads.
grasp::FrictionSettings friction_of(Arguments& arguments);
/// `balance`, `limit_depths`, `grip_force_n`, `strength_share`, `strength_n`, and the person's own.
grasp::RestSettings rest_of(Arguments& arguments, const std::string& person);

}  // namespace palmar::python
