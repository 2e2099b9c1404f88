// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/sensors/sensor_layout.h"

namespace palmar::records {

/// A built-in layout's name, or a TOML file (a name with a dot or a slash):
///
///     name = "grip mat"
///     kind = "mat"                  # or "glove", "free"
///     source = "data sheet"         # optional
///     pitch_mm = 5
///     rows = 32                     # of a mat
///     columns = 24                  # optional: as many as go round
///     origin_mm = [0, 0, 60]        # optional, all in the product's frame
///     axis = [0, 0, 1]
///     seam = [1, 0, 0]
///     [[patch]]                     # of a glove
///     region = "index_distal"
///     rows = 4
///     columns = 3
///     [[sensor]]                    # free
///     name = "trigger"
///     at_mm = [12, 0, 80]
///     area_mm2 = 71
///
/// Throws InputError naming file, line, key, value and what is allowed; UsageError for a name that
/// is neither.
study::SensorLayout read_sensor_layout(const std::string& name_or_file);

}  // namespace palmar::records
