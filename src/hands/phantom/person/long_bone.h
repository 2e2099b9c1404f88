// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/geometry/types.h"
#include "palmar/hand/bones/bone_shape.h"

namespace palmar::phantom {

/// Joint surface that a flexion axis turns into itself: points at distance
///   r(w) = (radius - groove exp(-(w / 0.3 W)^2)) (1 - |w / W|^5)^(1/3)
/// from the axis, w along the axis from the joint's centre, W = half_width: a pulley with two
/// condyles, or nearly a ball. mm.
struct JointSurface {
  double radius = 5.0, half_width = 5.0, groove = 0.0;
  double at(double w) const;
};

/// A tubular bone between two joints: hollow base on the next more proximal head, waist, head.
struct LongBoneShape {
  Vec3 base = Vec3::Zero(), head = Vec3::UnitY();  ///< centres of both joints
  Vec3 lateral = Vec3::UnitX();                    ///< flexion axis; palmar = lateral x along
  std::optional<JointSurface> socket;  ///< head of the next more proximal bone; none: a flat base
  double gap = 1.4;                    ///< joint space; with a flat base where it begins, mm
  JointSurface condyles;               ///< own head
  double base_half_width = 6.0, base_half_depth = 5.0;    ///< rim of the base, mm
  double waist_half_width = 4.0, waist_half_depth = 3.5;  ///< mm
  double bow = 0.8;     ///< how far the middle of the shaft lies dorsal of the chord, mm
  double twist = 0.0;   ///< of the shaft's ridges, rad
  double ripple = 0.0;  ///< share by which ridges stand out
};

/// Closed mesh, triangles outward, of about 0.8 mm edges.
geometry::TriangleMesh long_bone_mesh(const LongBoneShape& shape);

}  // namespace palmar::phantom
