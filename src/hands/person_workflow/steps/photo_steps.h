// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/photo/board_pattern.h"
#include "hands/person_records/photo_set.h"
#include "hands/person_workflow/steps/photo_mesh.h"
#include "palmar/core/progress.h"
#include "palmar/core/setting_names.h"
#include "palmar/workflow/note/note.h"

namespace palmar::person_workflow {

// Single steps of make_hand_from_photos(): the board to print, lenses, the mesh.

struct PhotoBoardRequest {
  std::string out;              ///< the drawing, .svg in millimetres
  capture::BoardPattern board;  ///< squares and markers; fits on A2 as it is
  void check() const;           ///< throws UsageError: setting, value, what is allowed
};

/// Draws the board that the hand stands on, with a ruler to check the print with. Throws
/// UsageError, OutputError.
void draw_photo_board(const PhotoBoardRequest& request);

struct PhotoLensesRequest {
  std::string folder;  ///< about 12 photographs per camera of the board, tilted every way; focus
                       ///< and zoom as for the hand. Names like p3_c2.jpg say the camera
  std::string out;     ///< lenses, JSON
  void check() const;  ///< throws UsageError: setting, what is allowed
};

struct PhotoLensesOutcome {
  person_records::PhotoLenses lenses;
  std::vector<std::string> notes;  ///< cameras that photographs showed little of
};

/// Lenses of cameras, written to a file. Throws InputError naming camera or photograph,
/// OutputError, Cancelled.
PhotoLensesOutcome calibrate_photo_lenses(const PhotoLensesRequest& request,
                                          const Progress& progress = {});

struct PhotoMeshRequest {
  std::string folder;  ///< photographs of a hand on the middle of the board, from all round
  std::string out;     ///< the mesh, .ply; its report goes beside it, .json
  PhotoMeshOptions options;
  workflow::NoteSink note;  ///< gets how long it takes; may be empty
  void check() const;       ///< throws UsageError: setting, value, what is allowed
};

struct PhotoMeshOutcome {
  PhotoMeshReport report;
  std::string report_file;
};

/// A coloured mesh from photographs, mm, in the board's frame; about 3 s of one core per
/// photograph. Nothing is done if the mesh of the same photographs is there already. Throws
/// UsageError, InputError naming folder or photograph, OutputError, Cancelled.
PhotoMeshOutcome make_mesh_from_photos(const PhotoMeshRequest& request,
                                       const Progress& progress = {});

}  // namespace palmar::person_workflow
