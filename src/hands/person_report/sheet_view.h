// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/report/picture/image.h"
#include "palmar/report/picture/render.h"

namespace palmar::person_report {

// A sheet of what was found of a hand, which people look at before anything is computed on it:
// views in rows, with numbers that a file lists.

inline constexpr int kSheetViewWidth = 1000, kSheetViewHeight = 1300;  ///< pixels
inline constexpr int kSheetHead = 44;                                  ///< pixels, above a row

/// Unit vectors by a hand's shape: across its broad side, along it towards the fingertips.
struct HandAxes {
  Vec3 across, along;
};
HandAxes hand_axes(const geometry::TriangleMesh& skin);

struct SheetNumber {
  int number = 0;
  Vec3 point = Vec3::Zero();  ///< mm; a small square stands on it, the number beside it
  report::Rgb colour;
};

/// The scene along `direction`, `up` upwards, with those numbers; each stands away from the nearest
/// other one.
report::Image numbered_view(const report::Scene& scene, const Vec3& direction, const Vec3& up,
                            const std::vector<SheetNumber>& numbers, const Progress& progress = {});

/// To 0.01 mm, as files of what was found have it.
Vec3 written_place(const Vec3& point);

/// Copies a picture into the sheet, which holds it.
void paste(report::Image& sheet, const report::Image& picture, int left, int top);

}  // namespace palmar::person_report
