// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/scan/scan_record.h"

namespace palmar::capture {

/// Contact of the scanned grasp with what was held, beside that of the new hand in the same posture
/// (Xie 2014, 2.4; contact is skin within 2 mm of the product). `product`: closed, where it was in
/// the scan of the grasp (patient frame, mm).
///
/// Throws InputError naming `name` if the product doesn't touch the scanned hand (reported, too, if
/// it would with x and y negated: a file in the axes of NIfTI), or if record has no grasp or the
/// palm of its scan isn't seen.
ScanContact grasp_contact(const ScanRecord& record, const geometry::TriangleMesh& product,
                          const std::string& name);

}  // namespace palmar::capture
