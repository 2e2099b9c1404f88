// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/pressed_shape.h"
#include "palmar/workflow/redesign/pressed_solid.h"
#include "palmar/workflow/redesign/redesign_outcome.h"
#include "palmar/workflow/redesign/redesign_request.h"

namespace palmar::workflow {

struct RedesignPressOutcome;

/// Redesign 1: the product's surface pressed in where hands reach into it.
struct RedesignPressRequest {
  RedesignRequest redesign;
  redesign::PressedShapeOptions shape;  ///< align_along and the faces of keep_out are filled in
                                        ///< here
  bool aligns = false;  ///< shifts every hand along the handle before they are combined
  /// CAD faces that must stay as they are: numbers or names.
  std::vector<std::string> keep_faces;
  std::vector<std::string> formats = {"stl"};  ///< files of the shape: stl, obj, ply
  bool draws = true;                           ///< pictures
  bool compares = true;  ///< in the end the same hands hold original and redesign
  /// Called when the shape stands and is written, before it is held again; json and comparison of
  /// the outcome are still empty.
  std::function<void(const RedesignPressOutcome&)> on_shape;

  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
};

/// `json` is what pressed.json holds.
struct RedesignPressOutcome : RedesignOutcome {
  redesign::PressedShape shape;
  double volume_before = 0.0;         ///< mm^3, of the original
  std::filesystem::path file;         ///< the shape in the first of the formats
  std::optional<PressedSolid> solid;  ///< of its handle, if one could be made
};

/// "mean", "75" (percentile), "mean-of-touching", "75-of-touching".
std::string name_of(const redesign::CombineOptions& combine);
/// Throws UsageError.
redesign::CombineOptions combine_options(const std::string& words);

/// Hands hold the product, press its surface in and hold the redesign. Writes to OUT: pressed.stl
/// (and the other formats), pressed.step or pressed-handle.step (PressedSolid), pressed.json,
/// pictures, and what compare_redesigns() writes. Throws UsageError, InputError, NumericalError if
/// no hand holds the original, Cancelled.
RedesignPressOutcome redesign_press(const RedesignPressRequest& request,
                                    const Progress& progress = {});

}  // namespace palmar::workflow
