// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// An Embree 3 scene of one mesh, in float, shifted so that the middle of its box is the origin
/// (that keeps the rounding of float small). For sources of this module only: no header that others
/// include names Embree. Throws InputError on corners outside the vertex list and on coordinates
/// that are not finite.
class EmbreeMesh {
 public:
  explicit EmbreeMesh(const TriangleMesh& mesh);
  ~EmbreeMesh();
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;

  RTCScene scene() const { return scene_; }
  const Vec3& origin() const { return origin_; }
  const Box3& box() const { return box_; }

 private:
  RTCScene scene_ = nullptr;
  Vec3 origin_ = Vec3::Zero();
  Box3 box_;
};

}  // namespace palmar::geometry
