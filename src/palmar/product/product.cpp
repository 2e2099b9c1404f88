// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/product.h"

namespace palmar::product {

std::string name_of(UnitSource source) {
  switch (source) {
    case UnitSource::kFile:
      return "file";
    case UnitSource::kUser:
      return "user";
    case UnitSource::kProposed:
      return "proposed";
    case UnitSource::kMade:
      return "made";
  }
  return "";
}

}  // namespace palmar::product
