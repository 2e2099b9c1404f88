// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"

namespace palmar::workflow {

/// The usual options, with results for soft and stiff tissue beside the nominal ones.
inline contact::ContactOptions contact_with_band() {
  contact::ContactOptions options;
  options.error_band = true;
  return options;
}

/// The same, with the skin refined on sharp edges of the product.
inline contact::ContactOptions refined_contact_with_band() {
  contact::ContactOptions options = contact_with_band();
  options.refine = true;
  return options;
}

}  // namespace palmar::workflow
