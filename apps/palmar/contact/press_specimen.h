// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/press/press.h"

namespace palmar::cli {

/// plane | ellipsoid:RX,RY | HAND:REGION; sets `hand` for the last. Throws UsageError naming
/// --specimen.
PressSpecimen parse_specimen(const std::string& text, std::string& hand);

/// sphere:R | punch:A | punches:A,DISTANCE | cylinder:R | plane. Throws UsageError naming
/// --indenter.
PressIndenter parse_indenter(const std::string& text);

}  // namespace palmar::cli
