// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/scan/scan_record.h"
#include "palmar/records/csv.h"

namespace palmar::person_records {

/// What became of a person's scans as JSON; keys carry the unit. Axes and centres of joints stand
/// in the hand frame and in the patient frame of the reference scan.
std::string scan_record_json(const capture::ScanRecord& record);

/// What was found in scans that no hand came of, and why: {"refusal", "side", "scans",
/// "bone_motions", "notes"}, each as scan_record_json() has it.
std::string refused_scans_json(const capture::ScanRecord& record,
                               const capture::ScanRefusal& refusal);

/// {"motions": [...]}: turn, shift and fit of each bone from one scan to another; patient frames,
/// mm.
std::string bone_motions_json(const std::vector<capture::BoneMotion>& motions);

/// One row per posture and bone: mean distance of free registration, of joints with a fixed axis,
/// of the interpolated CMC joint, mm (Xie 2014, tables 2-2 to 2-4, before averaging).
records::CsvTable bone_error_table(const capture::ScanRecord& record);

/// One row per limit posture of the thumb: skinning alone, corrected by markers alone, corrected as
/// the hand is, mm (table 2-5).
records::CsvTable skin_error_table(const capture::ScanRecord& record);

/// One row: contact areas of hand and scan with what the grasp holds.
records::CsvTable grasp_contact_table(const capture::ScanContact& contact);

}  // namespace palmar::person_records
