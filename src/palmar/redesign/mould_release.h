// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/redesign/handle_shape.h"

namespace palmar::redesign {

/// How a handle leaves a mould of two halves that open along +pull and -pull and part where the
/// handle is widest across it. Of the sections in which the features are all there; what is kept of
/// the original isn't looked at.
struct MouldRelease {
  /// Most by which an outline, seen along the pull, goes back inwards on its way from the widest
  /// place of one side to that of the other, mm: 0 comes out, more needs a slide.
  double undercut = 0.0;
  /// Largest height along the pull of a piece of the surface that leans less than the draft angle
  /// against it, mm: the walls that drag. Round a parting line there always is one: on a circle of
  /// radius r it is 2 r sin(draft).
  double steep_height = 0.0;
};

/// `pull`: product frame, any length; `draft`: rad. Throws UsageError if the pull is more than 15
/// degrees off the planes of the sections: a mould parts along a handle, not across it.
MouldRelease mould_release(const HandleShape& shape, const Vec3& pull, double draft);

}  // namespace palmar::redesign
