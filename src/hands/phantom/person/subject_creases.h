// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hands/phantom/person/subject_person.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::phantom {

/// Where the creases of a synthetic person are: those that its joints suggest, elsewhere by
/// `crease` along the finger (0.8 mm; the wrist's half more; deviations; Bugbee and Botte 1993
/// found them to differ between people by as much) and turned by `crease_slope` in the plane of the
/// palm. `skin` and `skeleton` in one posture.
hand::HandCreases subject_creases(const geometry::TriangleMesh& skin,
                                  const hand::Skeleton& skeleton, std::uint64_t seed,
                                  const PersonDispersion& dispersion = {});

/// The person's joints, axes and fingertips where its bones have them in a posture.
hand::Skeleton subject_skeleton(const SubjectPerson& person, const hand::Posture& posture);

}  // namespace palmar::phantom
