// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"

namespace palmar {

/// The usual options, with results for soft and stiff tissue beside the nominal ones.
inline ContactOptions contact_with_band() {
  ContactOptions options;
  options.error_band = true;
  return options;
}

}  // namespace palmar
