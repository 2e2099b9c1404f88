// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/anatomy.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::person_workflow {

/// In the order of the enumeration, each once; all of them if none is named.
std::vector<hand::ScanPosture> sorted_postures(const std::vector<hand::ScanPosture>& postures);

/// What a phantom made, beside its scans.
struct PhantomPerson {
  std::string name;
  hand::Side side = hand::Side::kRight;
  std::string truth;  ///< file with what is known of the person: subject.json
};

}  // namespace palmar::person_workflow
