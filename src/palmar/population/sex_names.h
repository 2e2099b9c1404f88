// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "palmar/grasp/joint_strength.h"

namespace palmar::population {

std::string name_of(grasp::Sex sex);    ///< "male", "female"
std::string people_of(grasp::Sex sex);  ///< "men", "women"
std::optional<grasp::Sex> sex_named(std::string_view name);

/// Sex from a cell's text: "M", "male", "men", "F", "women" ...; nothing if it is no such word.
std::optional<grasp::Sex> sex_of_text(std::string_view text);

}  // namespace palmar::population
