// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/effort/effort.h"
#include "palmar/effort/fingertip_force.h"

namespace palmar::records {

/// What `palmar effort fingertip --json` prints of one tendon: {"finger", "tendon",
/// "tendon_force_n", "posture", "fingertip_force_n": [x, y, z] in the hand frame,
/// "fingertip_force_magnitude_n", "fingertip_force_distal_phalanx_n": {"radial", "distal",
/// "palmar"}, "fingertip_moment_n_mm", "fingertip_mm", "joints": [{"angle", "moment_arm_mm",
/// "moment_n_mm"}]}. Of several: {"tendons": [...]} of these.
std::string fingertip_json(const std::vector<effort::FingertipForce>& forces,
                           const hand::Posture& posture);

/// {"status", "message", "with_friction", "contact_force_n", "tendon_force_n", "indices": {key:
/// value}, "digits": [{"finger", "status", "contact_force_n", "joints": [{"angle",
/// "external_moment_n_mm", ...}], "tendons": [{"tendon", "force_n", "strength_n", "activation",
/// "moment_arms_mm"}], "kkt_residual", "iterations"}], "wrist": null or {"muscles": [{"muscle",
/// "force_n", "strength_n", "activation"}], "external_moment_n_mm", "digits_moment_n_mm",
/// "wrist_moment_n_mm", "missing_moment_n_mm"}}.
std::string effort_json(const effort::EffortResult& effort);

}  // namespace palmar::records
