// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/person/scan_posture.h"
#include "palmar/hand/anatomy.h"

namespace palmar {

/// In the order of the enumeration, each once; all of them if none is named.
std::vector<ScanPosture> sorted_postures(const std::vector<ScanPosture>& postures);

/// What a phantom made, beside its scans.
struct PhantomPerson {
  std::string name;
  Side side = Side::kRight;
  std::string truth;  ///< file with what is known of the person: subject.json
};

}  // namespace palmar
