// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/contact.h"
#include "palmar/grasp/grasp.h"
#include "palmar/hand/dimensions/tape_measures.h"
#include "palmar/hand/hand.h"

namespace palmar::cli {

// Values as people read them in a terminal; files are written by io and report.

/// Major and segment dimensions, joints with their ranges of motion.
std::string hand_text(const hand::Hand& hand);
/// Length, width and thickness of every segment, one line each, mm.
std::string segments_text(const hand::HandDimensions& dimensions);
/// Both tissue models per group of regions that share one, with ranges and sources.
std::string tissue_text(const hand::Tissue& tissue);
/// Dimensions as CSV, one row per quantity: quantity,segment,value_mm.
std::string dimensions_csv(const hand::Hand& hand, const hand::HandTape& tape);
/// Whether it is held and by what: "held by five fingers; ...", "too large for this hand: ...".
std::string status_text(const grasp::Grasp& grasp);
/// Status, what stopped each segment, angles.
std::string grasp_text(const grasp::Grasp& grasp);
/// The grasp and its runners-up, one line each: score, place, forearm's direction.
std::string placements_text(const grasp::Grasp& grasp);
/// The equations that ran: "palmar (patch kernel, halfspace, coupled regions)".
std::string equations_text(const contact::ContactModel& model);
/// Totals and one line per region; the error band and the equations that ran.
std::string contact_text(const contact::ContactResult& contact);

/// "1234 mm3"; small ones with three digits rather than as 0.
std::string volume_text(double volume, int digits = 0);

double degrees(double radians);
double radians(double degrees);

}  // namespace palmar::cli
