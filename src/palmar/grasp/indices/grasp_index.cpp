// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/grasp_index.h"

namespace palmar::grasp {

std::string name_of(Better better) {
  switch (better) {
    case Better::kUp:
      return "up";
    case Better::kDown:
      return "down";
    case Better::kNeither:
      return "neither";
  }
  return "neither";
}

}  // namespace palmar::grasp
