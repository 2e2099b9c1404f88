// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palmar::capture {

/// A place in a picture (pixels) or on a sheet (mm).
using Vec2 = Eigen::Vector2d;

/// A colour, or a place that is projected for every pixel of a photograph: single precision does.
using Vec3f = Eigen::Vector3f;

}  // namespace palmar::capture
