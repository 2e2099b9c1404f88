// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What ContactSolver tells of where the skin goes, for the refinement.
#include "palmar/contact/prepared/contact_solver.h"

namespace palmar::contact {

std::vector<Vec3> ContactSolver::Impl::motion_on_bone(const ContactResult& result,
                                                      const std::vector<int>& at) const {
  const BlockRoots roots(stiffening_);
  std::vector<double> share;
  for (const int v : loaded_->vertices()) {
    share.push_back(result.force[v] / bone_root_modulus(hand::TissueLevel::kNominal, roots, v));
  }
  std::vector<Vec3> motion = loaded_->motion(share, at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    motion[k] = to_reference(skin_, at[k]).transpose() * motion[k] /
                bone_root_modulus(hand::TissueLevel::kNominal, roots, at[k]);
  }
  return motion;
}

}  // namespace palmar::contact
