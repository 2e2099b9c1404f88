// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/product_faces.h"

#include <cstdio>

namespace palmar {

std::string name_of(FaceKind kind) {
  switch (kind) {
    case FaceKind::kPlane:
      return "plane";
    case FaceKind::kCylinder:
      return "cylinder";
    case FaceKind::kCone:
      return "cone";
    case FaceKind::kSphere:
      return "sphere";
    case FaceKind::kTorus:
      return "torus";
    case FaceKind::kFreeform:
      break;
  }
  return "freeform";
}

std::string title_of(const ProductFace& face) {
  std::string text = "face " + std::to_string(face.number);
  if (!face.name.empty()) text += " \"" + face.name + "\"";
  text += " (" + (face.is_fillet ? "fillet" : name_of(face.kind));
  if (face.radius > 0.0) {
    char radius[32];
    std::snprintf(radius, sizeof radius, " r %.3g", face.radius);
    text += radius;
  }
  return text + ")";
}

}  // namespace palmar
