// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/photo/surface/photo_model.h"
#include "palmar/core/progress.h"

namespace palmar::capture {

/// Masks of a hand whose colour doesn't distinguish it from what is behind it, narrowed by where
/// things are: stereo in the photographs reduced to three times the pixels of the fine one, all
/// through the box; what lies behind the hand is far off or agrees nowhere. Throws InputError if
/// hardly anything in the box agrees.
void narrow_by_depth(const std::vector<Photograph>& photographs,
                     const std::vector<PhotoView>& views, const PhotoModelOptions& options,
                     std::vector<PhotoMask>& masks, const Progress& progress = {});

/// Keeps of the masks what is near the outline of the points: of cells of 3 mm with enough of them,
/// the largest group whose cells lie no more than one cell apart, as balls of `radius` mm with
/// their gaps closed. False if that group is smaller than a hand's.
bool narrow_to_points(const std::vector<SurfacePoint>& points, const std::vector<PhotoView>& views,
                      double radius, std::vector<PhotoMask>& masks);

}  // namespace palmar::capture
