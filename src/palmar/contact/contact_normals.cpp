// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/contact_normals.h"

namespace palmar::contact {

std::vector<Vec3> contact_normals(const ContactResult& contact,
                                  const geometry::DistanceField& product,
                                  const std::vector<int>& loaded) {
  constexpr double kClear = 0.05;  // mm; a direction over less than this is unsure
  std::vector<Vec3> normals(loaded.size());
  std::vector<Vec3> points;  // of those that hardly moved
  std::vector<std::size_t> place;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const int v = loaded[k];
    const Vec3 way = contact.deformed[v] - contact.undeformed[v];
    if (way.norm() > kClear) {
      normals[k] = way.normalized();
      continue;
    }
    points.push_back(contact.deformed[v]);
    place.push_back(k);
  }
  std::vector<geometry::DistanceSample> samples(points.size());
  product.sample(points, 1.0, samples);
  for (std::size_t i = 0; i < place.size(); ++i) normals[place[i]] = samples[i].normal;
  return normals;
}

std::vector<int> loaded_vertices(const ContactResult& contact) {
  std::vector<int> loaded;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (contact.force[v] > 0.0) loaded.push_back(static_cast<int>(v));
  }
  return loaded;
}

}  // namespace palmar::contact
