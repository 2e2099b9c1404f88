// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/report/picture/assessment_pictures.h"
#include "palmar/report/study/study_scene.h"

namespace palmar::report {

/// Pictures of a product's maps over hands, made without a display:
///
///     mean_hand, above_hand   on the template's open hand, palm side
///     mean_product            on the product, from the side of the palm and of the fingers; the
///                             borders of its faces drawn, if it has any
///
/// `product_from_hand` is how a typical hand holds it. When cancelled, those that are finished.
std::vector<Picture> study_pictures(const hand::Hand& base, const product::Product& product,
                                    const std::string& name, const study::StudyMaps& maps,
                                    const geometry::Rigid3& product_from_hand,
                                    const StudyScales& scales, double threshold,
                                    const PictureOptions& options = {},
                                    const Progress& progress = {});

/// How one hand holds the product, seen from the palm's side: the picture "hold".
Picture study_hold_picture(const hand::Hand& hand, const study::StudyRecord& record,
                           const product::Product& product, const std::string& name,
                           const std::string& whose, const PictureOptions& options,
                           const Progress& progress = {});

}  // namespace palmar::report
