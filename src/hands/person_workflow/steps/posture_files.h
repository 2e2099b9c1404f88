// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/hand/person/scan_posture.h"

namespace palmar::person_workflow {

/// The posture that a file's or folder's name gives: as for images, or in short ("natural",
/// "flexed", "spread"); nothing if it gives none.
std::optional<hand::ScanPosture> posture_in_name(const std::string& path);

/// Which file or folder of `paths` shows which posture: as `stated` or as its name gives; a single
/// one the reference. `what` they are stands in messages: "scan". Throws UsageError naming the
/// setting "posture": two show one posture, one names none, what is stated isn't among `paths`;
/// also if none is the reference.
std::map<hand::ScanPosture, std::string> files_by_posture(
    const std::vector<std::string>& paths, const std::map<std::string, hand::ScanPosture>& stated,
    const std::string& what);

}  // namespace palmar::person_workflow
