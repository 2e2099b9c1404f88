// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/scan/scan_truth.h"
#include "palmar/records/csv.h"

namespace palmar::person_records {

/// Everything that was measured on surface scans: side, dimensions, joints with axis and centre in
/// the hand's and in the reference scan's frame, angles of every scan, creases, dots, fits, notes.
/// mm, degrees.
std::string hand_from_scan_json(const capture::HandFromScan& made);

/// One row per dimension, straight ones first: name, value_mm.
records::CsvTable dimension_csv(const hand::HandDimensions& dimensions, const hand::HandTape& tape);

/// One row per joint and scan that dots showed: segment, posture, turn_deg, residual_mm,
/// axis_change_deg, axis_error_deg, centre_change_mm, dots.
records::CsvTable dotted_joint_csv(const capture::HandFromScan& made);

/// One row per dimension (found less true), joint (the one proximal of the segment) and fingertip
/// in each scan: what, posture, segment, difference_mm, axis_deg.
records::CsvTable truth_error_csv(const capture::ScanErrors& errors);

}  // namespace palmar::person_records
