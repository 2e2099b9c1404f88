// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/cad/model/cad_model.h"
#include "palmar/redesign/ridge_relief.h"

namespace palmar::cad {

/// A solid with its reliefs cut.
struct RelievedModel {
  CadModel model;
  double volume_before = 0.0, volume_after = 0.0;  ///< mm^3
  int rounded_junctions = 0;       ///< edges between relief and product that were rounded
  std::vector<std::string> notes;  ///< what couldn't be done
};

/// Cuts each relief (redesign/ridge_relief.h) by three bodies: the straight part, extruded along
/// the ridge, and both run-outs, turned about the centres of the cutter's path. New faces are
/// cylinders and tori; they get the relief's name. The edge in which a run-out leaves the surface
/// is rounded with `junction_radius` [mm] where OpenCASCADE can (0: left as it is).
///
/// Throws InputError if the model hasn't exactly one solid, NumericalError naming the relief whose
/// cut gives no valid closed solid, or takes nothing away.
RelievedModel cut_reliefs(const CadModel& model, const std::vector<redesign::RidgeRelief>& reliefs,
                          double junction_radius = 0.0);

}  // namespace palmar::cad
