// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/joints/measured_joints.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "hands/images/dicom.h"
#include "palmar/core/progress.h"

namespace palmar::person_workflow {

// Single steps of make_hand_from_mri(): what is in an image, its surfaces, how bones moved.

/// An image and what its intensities show.
struct MriImageInfo {
  images::ImageFile file;
  float least = 0.0F, most = 0.0F;  ///< intensities of the file
  /// Up to which a voxel is taken for air, and the noise's standard deviation: those that
  /// find_mri_surfaces() uses. Nothing if the image shows no hand, or two.
  std::optional<double> air_threshold, noise;
  std::string no_hand;         ///< why they lack
  Vec3 centre = Vec3::Zero();  ///< of the image, patient frame, mm
};

/// Reads a folder of DICOM files or an image file. Throws as read_image(); Cancelled.
MriImageInfo describe_mri_image(const std::string& image, const images::SeriesChoice& choice = {},
                                const Progress& progress = {});

struct MriSurfacesRequest {
  std::string image;               ///< folder of DICOM files, one of several frames, NIfTI file
  images::SeriesChoice choice;     ///< which of the folder's series, if there are several
  std::string out;                 ///< folder to write: skin.ply, bones/*.ply, scan.json
  std::string labels;              ///< file with names for bones; empty: none
  std::string model = "template";  ///< hand whose bones give the names; any person's will do
  capture::SurfaceOptions surfaces;
  bool accepts_odd_slices = false;  ///< a damaged slice spoils the surfaces near it, so going on is
                                    ///< a choice
  void check() const;               ///< throws UsageError: setting, value, what is allowed
};

struct MriSurfacesOutcome {
  capture::ScanSurfaces surfaces;
  std::vector<std::string> notes;  ///< of the image, of odd slices, of what was found: sentences
};

/// Skin, bones and markers of one image as meshes, written to a folder. Throws UsageError,
/// InputError naming image or slice, OutputError, Cancelled.
MriSurfacesOutcome find_mri_surfaces(const MriSurfacesRequest& request,
                                     const Progress& progress = {});

struct BoneMotionRequest {
  std::string reference, posture;  ///< folders that find_mri_surfaces() made
  /// Images of both: bones are aligned with their intensities, which is more accurate than with
  /// their surfaces alone.
  std::optional<std::array<std::string, 2>> images;
  void check() const;  ///< throws UsageError: setting, what is allowed
};

/// How every bone moved from one scan to another. Throws UsageError, InputError naming folder or
/// image, Cancelled.
std::vector<capture::BoneMotion> find_bone_motions(const BoneMotionRequest& request,
                                                   const Progress& progress = {});

}  // namespace palmar::person_workflow
