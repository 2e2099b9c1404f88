// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/mri_steps.h"

#include <fmt/format.h>

#include <algorithm>

#include "hands/capture/mri/bones/bone_labels.h"
#include "hands/capture/mri/bones/bone_plausibility.h"
#include "hands/capture/mri/bones/find_surfaces.h"
#include "hands/capture/mri/scan_image.h"
#include "hands/imaging/noise_floor.h"
#include "hands/person_records/bone_label_file.h"
#include "hands/person_records/scan_surfaces_file.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

void require_named(const std::string& value, const char* setting, const char* what) {
  if (!value.empty()) return;
  throw UsageError(fmt::format("setting \"{}\" is empty; {} is required", setting, what));
}

/// A damaged slice spoils the surfaces near it.
void require_sound_slices(const std::vector<std::string>& odd, bool is_accepted) {
  if (odd.empty() || is_accepted) return;
  throw InputError(fmt::format(
      "{}\nrestore them, or continue with setting \"accept odd slices\" if they look right",
      fmt::join(odd, "\n")));
}

}  // namespace

MriImageInfo describe_mri_image(const std::string& image, const images::SeriesChoice& choice,
                                const Progress& progress) {
  MriImageInfo info;
  info.file = images::read_image(image, choice, part_of(progress, 0.0, 0.3));
  const imaging::Volume& volume = info.file.image;
  const imaging::VolumeGrid& grid = volume.grid;
  const auto [least, most] = std::minmax_element(volume.value.begin(), volume.value.end());
  info.least = *least;
  info.most = *most;
  try {
    const capture::ScanLevels levels =
        capture::scan_levels(volume, image, {}, part_of(progress, 0.3, 1.0));
    info.air_threshold = imaging::with_noise_floor(levels.air_threshold, levels.floor);
    info.noise = levels.noise;
  } catch (const InputError& error) {
    info.no_hand = error.what();
  }
  info.centre =
      grid.to_patient(0.5 * Vec3(grid.size[0] - 1.0, grid.size[1] - 1.0, grid.size[2] - 1.0));
  return info;
}

void MriSurfacesRequest::check() const {
  require_named(image, "image", "an MR image of the hand");
  require_named(out, "out", "a folder to write to");
  surfaces.check();
}

MriSurfacesOutcome find_mri_surfaces(const MriSurfacesRequest& request, const Progress& progress) {
  request.check();
  const auto model = workflow::load_hand(request.model);
  std::vector<hand::BoneLabel> labels;
  if (!request.labels.empty()) labels = person_records::read_bone_labels(request.labels);
  const images::ImageFile file =
      images::read_image(request.image, request.choice, part_of(progress, 0.0, 0.1));
  require_sound_slices(file.odd_slices, request.accepts_odd_slices);
  MriSurfacesOutcome outcome;
  capture::ScanSurfaces& surfaces = outcome.surfaces;
  capture::SurfaceOptions how = request.surfaces;
  how.fat_shift = file.fat_shift;
  surfaces =
      capture::find_surfaces(file.image, request.image, *model, how, part_of(progress, 0.1, 1.0));
  if (request.surfaces.side) surfaces.side = *request.surfaces.side;
  if (!labels.empty()) capture::apply_bone_labels(surfaces, labels, *model);
  person_records::write_scan_surfaces(request.out, surfaces, "");
  outcome.notes = file.notes;
  const auto add = [&](const std::vector<std::string>& notes) {
    outcome.notes.insert(outcome.notes.end(), notes.begin(), notes.end());
  };
  add(file.odd_slices);
  add(surfaces.notes);
  const std::vector<std::string> doubts = capture::doubtful_bones(surfaces, *model);
  if (!doubts.empty()) {
    outcome.notes.push_back(
        fmt::format("look at these bones, which may be found wrongly or bear a wrong name: {}",
                    fmt::join(doubts, "; ")));
  }
  return outcome;
}

void BoneMotionRequest::check() const {
  require_named(reference, "reference", "a folder of surfaces");
  require_named(posture, "posture", "a folder of surfaces of another posture");
}

std::vector<capture::BoneMotion> find_bone_motions(const BoneMotionRequest& request,
                                                   const Progress& progress) {
  request.check();
  const capture::ScanSurfaces reference = person_records::read_scan_surfaces(request.reference);
  const capture::ScanSurfaces posture = person_records::read_scan_surfaces(request.posture);
  if (!request.images) return capture::track_bones(reference, posture, progress);
  const auto& [one, other] = *request.images;
  const capture::BoneImages bones = capture::images_of_bones(
      reference,
      capture::blurred_levels(images::read_image(one, {}, part_of(progress, 0.0, 0.1)).image));
  const capture::ImageLevels levels =
      capture::blurred_levels(images::read_image(other, {}, part_of(progress, 0.1, 0.2)).image);
  return capture::track_bones(reference, posture, {&bones, &levels}, part_of(progress, 0.2, 1.0));
}

}  // namespace palmar::person_workflow
