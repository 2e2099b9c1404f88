// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/coordination_file.h"

#include "palmar/core/error.h"
#include "palmar/records/posture/posture_file.h"

namespace palmar::records {

grasp::CoordinationBasis read_coordination(const std::string& path,
                                           const hand::Skeleton& skeleton) {
  const PostureFile file = read_postures(path, skeleton);
  if (static_cast<int>(file.frames.size()) < grasp::kLeastPostures) {
    throw InputError(path + ": it has " + std::to_string(file.frames.size()) +
                     " postures; at least " + std::to_string(grasp::kLeastPostures) +
                     " are needed for a basis of 20 joint angles");
  }
  std::vector<hand::Posture> postures;
  for (const PostureFrame& frame : file.frames) {
    for (const hand::Dof dof : frame.missing) {
      if (dof < grasp::digit_dof(0)) continue;
      throw InputError(path + ": " + (frame.name.empty() ? "the posture" : frame.name) +
                       " has no " + std::string(name_of(dof)) +
                       "_deg; a basis needs all 20 joint angles of the digits in every row");
    }
    postures.push_back(frame.posture);
  }
  return grasp::coordination_basis(postures, path);
}

}  // namespace palmar::records
