// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/json_reason.h"

namespace palmar::formats {

std::string json_reason(const std::exception& error) {
  const std::string text = error.what();
  if (text.rfind("[json.exception.", 0) != 0) return text;
  const auto end = text.find("] ");
  return end == std::string::npos ? text : text.substr(end + 2);
}

}  // namespace palmar::formats
