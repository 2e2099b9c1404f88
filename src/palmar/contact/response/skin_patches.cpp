// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/skin_patches.h"

namespace palmar::contact {

SkinPatches skin_patches(const SkinGeometry& skin, int size) {
  SkinPatches result;
  const int n = skin.vertex_count();
  result.patch.assign(n, -1);
  std::vector<int> front;
  for (int seed = 0; seed < n; ++seed) {
    if (result.patch[seed] >= 0) continue;
    front.assign(1, seed);
    result.patch[seed] = result.count;
    for (std::size_t k = 0; k < front.size() && static_cast<int>(front.size()) < size; ++k) {
      for (const int w : skin.neighbours(front[k])) {
        int& patch = result.patch[w];
        if (patch >= 0 || static_cast<int>(front.size()) >= size) continue;
        patch = result.count;
        front.push_back(w);
      }
    }
    ++result.count;
  }
  return result;
}

std::vector<Vec3> patch_centres(const SkinGeometry& skin, const SkinPatches& patches) {
  std::vector<Vec3> centre(patches.count, Vec3::Zero());
  std::vector<double> members(centre.size(), 0.0);
  for (std::size_t v = 0; v < patches.patch.size(); ++v) {
    const int s = patches.patch[v];
    centre[s] += skin.position[v];
    members[s] += 1.0;
  }
  for (std::size_t s = 0; s < centre.size(); ++s) centre[s] /= members[s];
  return centre;
}

}  // namespace palmar::contact
