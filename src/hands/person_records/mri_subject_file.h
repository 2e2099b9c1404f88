// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "hands/phantom/mri/mri_subject.h"

namespace palmar::person_records {

/// What is known of a synthetic subject, to hold measurements against: FOLDER/subject.json (bone
/// poses, axes, angles, dimensions, markers; keys carry units), FOLDER/POSTURE/skin.ply and
/// FOLDER/POSTURE/bones/NAME.ply, FOLDER/grasp/product.ply (what it holds). Patient frame of DICOM,
/// mm. `series`: folder of each posture's series, as it shall be named in the file. Throws
/// OutputError.
void write_mri_subject(const std::string& folder, const phantom::MriSubject& subject,
                       const std::map<hand::ScanPosture, std::string>& series, std::uint64_t seed);

}  // namespace palmar::person_records
