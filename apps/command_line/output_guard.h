// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palmar::cli {

/// Refuses an output that is the input itself, also by another spelling or through links: the
/// original stays as it is. Throws UsageError.
void refuse_same_file(const std::string& input, const std::string& out);

/// Refuses, before anything is read, what no mesh can be written to: a folder, or a suffix other
/// than .stl, .obj and .ply (and .step, .stp where `allows_step`). Throws UsageError naming both.
void check_shape_output(const std::string& out, bool allows_step);

}  // namespace palmar::cli
