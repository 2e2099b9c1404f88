// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palmar/hand/skin/creases.h"
#include "hands/phantom/person/subject_person.h"

namespace palmar {

/// Where the creases of a synthetic person are: those that its joints suggest, elsewhere by
/// `crease` along the finger (0.8 mm; the wrist's half more; deviations; Bugbee and Botte 1993
/// found them to differ between people by as much) and turned by `crease_slope` in the plane of the
/// palm. `skin` and `skeleton` in one posture.
HandCreases subject_creases(const TriangleMesh& skin, const Skeleton& skeleton, std::uint64_t seed,
                            const PersonDispersion& dispersion = {});

/// The person's joints, axes and fingertips where its bones have them in a posture.
Skeleton subject_skeleton(const SubjectPerson& person, const Posture& posture);

}  // namespace palmar
