// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/contact_normals.h"

namespace palmar {

std::vector<Vec3> contact_normals(const ContactResult& contact, const DistanceField& product,
                                  const std::vector<int>& loaded) {
  constexpr double kClear = 0.05;  // mm; a direction over less than this is unsure
  std::vector<Vec3> points, normals;
  for (const int v : loaded) points.push_back(contact.deformed[static_cast<std::size_t>(v)]);
  std::vector<DistanceSample> samples(points.size());
  product.sample(points, 1.0, samples);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const auto v = static_cast<std::size_t>(loaded[k]);
    const Vec3 way = contact.deformed[v] - contact.undeformed[v];
    normals.push_back(way.norm() > kClear ? Vec3(way.normalized()) : samples[k].normal);
  }
  return normals;
}

std::vector<int> loaded_vertices(const ContactResult& contact) {
  std::vector<int> loaded;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (contact.force[v] > 0.0) loaded.push_back(static_cast<int>(v));
  }
  return loaded;
}

}  // namespace palmar
