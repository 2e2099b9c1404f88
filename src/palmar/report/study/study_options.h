// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/study_plan.h"

namespace palmar::report {

// The options of a command that asks the same of a study's products again.

/// Whether the product's file is a mesh without a unit: STL, OBJ, PLY.
bool is_mesh_file(const study::StudyProduct& product);
/// Whether it can be given to a command again as it is: a file or the words of a made product,
/// neither resized nor in another product's posture.
bool is_plain_product(const study::StudyProduct& product);
/// "--product a.stl --product b.stl --unit mm"; empty if one is no plain product.
std::string product_options(const study::StudyPlan& plan);
/// " --mass-kg 0.4" if all products have the same; else empty.
std::string mass_option(const study::StudyPlan& plan);

}  // namespace palmar::report
