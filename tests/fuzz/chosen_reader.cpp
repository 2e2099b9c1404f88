// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Which reader a fuzz target reads with.
#include <string_view>

namespace palmar::fuzz {

void PALMAR_READER(std::string_view bytes);

void read(std::string_view bytes) { PALMAR_READER(bytes); }

}  // namespace palmar::fuzz
