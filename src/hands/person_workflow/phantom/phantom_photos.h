// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "hands/capture/photo/board_pattern.h"
#include "hands/phantom/photo/photographs.h"
#include "palmar/core/progress.h"
#include "palmar/hand/anatomy.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::person_workflow {

/// Photographs of a synthetic person's painted hand on the board, taken by a rig of cameras, with
/// the truth beside them (docs/method/phantom.md).
struct PhantomPhotosRequest {
  std::string out;  ///< folder; photos/, calibration/ and truth/ go into it
  hand::ScanPosture posture = hand::ScanPosture::kReference;
  hand::Side side = hand::Side::kRight;
  bool is_free = false;   ///< the person, by kFreePerson
  double restless = 0.0;  ///< see PaintedHandOptions::restless, take by position, mm
  phantom::PhotographsOptions photographs;  ///< its seed chooses the person, too
  capture::BoardPattern board;
  geometry::Srgb skin{0.80F, 0.60F, 0.50F};
  int calibration = 12;           ///< photographs of the tilted board per camera, 0 to 200
  int jpeg = 0;                   ///< JPEG of this quality (1 to 100) with what cameras say of
                                  ///< themselves; 0: PNG
  std::optional<Vec3> block;      ///< a cardboard box of these edges (mm) in the hand's place
  bool no_hand = false;           ///< the board alone
  std::string base = "template";  ///< whose skin's outline the person starts from: "template" or a
                                  ///< *.hand.glb file

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct PhantomPhotosOutcome {
  std::size_t photographs = 0, calibration = 0;  ///< how many
  std::string photo_folder, calibration_folder, truth_folder;
};

/// Makes the person, the photographs and the truth. What an earlier run left in photos/ and
/// calibration/ goes. Throws UsageError, InputError for `base`, OutputError, Cancelled; and as
/// draw_board() where Palmar was built without OpenCV.
PhantomPhotosOutcome make_phantom_photos(const PhantomPhotosRequest& request,
                                         const Progress& progress = {});

}  // namespace palmar::person_workflow
