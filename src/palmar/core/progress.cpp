// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/progress.h"

#include "palmar/core/error.h"

namespace palmar {

void Progress::throw_if_cancelled() const {
  if (is_cancelled()) throw Cancelled("cancelled; what was finished has been kept");
}

}  // namespace palmar
