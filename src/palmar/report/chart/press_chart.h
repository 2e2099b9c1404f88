// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/contact/press/press.h"

namespace palmar::report {

/// The curve of an indentation test as an SVG picture: force, contact area, and peak and mean
/// pressure against depth.
std::string press_chart(const std::vector<contact::PressStep>& steps, const std::string& title);

}  // namespace palmar::report
