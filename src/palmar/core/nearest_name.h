// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palmar {

/// The candidate with the smallest edit distance to `name`, or "" if none is near (more than a
/// third of its letters differ). The first one wins a tie.
std::string nearest_name(const std::string& name, const std::vector<std::string>& candidates);

/// For a message: "did you mean x?" with the nearest candidate, or `otherwise` if none is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates,
                         const std::string& otherwise);

}  // namespace palmar
