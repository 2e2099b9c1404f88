// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/side_argument.h"

#include "palmar/core/error.h"

namespace palmar::cli {

hand::Side parse_side(const std::string& text) {
  if (text != "right" && text != "left") {
    throw UsageError("--side: \"" + text + "\" is neither right nor left");
  }
  return text == "left" ? hand::Side::kLeft : hand::Side::kRight;
}

}  // namespace palmar::cli
