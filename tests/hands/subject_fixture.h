// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/phantom/mri/mri_subject.h"

namespace palmar::tests {

/// The synthetic person that several tests look at, made once.
inline const phantom::MriSubject& test_subject(const hand::Hand& base) {
  static const phantom::MriSubject made =
      phantom::make_mri_subject(base, {.seed = 1, .has_fixture = false});
  return made;
}

}  // namespace palmar::tests
