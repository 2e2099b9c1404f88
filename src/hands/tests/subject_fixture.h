// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/phantom/mri/mri_subject.h"

namespace palmar {

/// The synthetic person that several tests look at, made once.
inline const MriSubject& test_subject(const Hand& base) {
  static const MriSubject made = make_mri_subject(base, {.seed = 1, .has_fixture = false});
  return made;
}

}  // namespace palmar
