// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace palmar::formats {

/// What the JSON library complains of, without its own name and number in front
/// ("[json.exception.parse_error.101] "): "parse error at line 1, column 8: ...".
std::string json_reason(const std::exception& error);

}  // namespace palmar::formats
