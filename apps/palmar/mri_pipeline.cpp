// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "mri_pipeline.h"

#include <fmt/format.h>

#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"
#include "palmar/hand/template_hand.h"
#include "palmar/io/dicom.h"
#include "palmar/io/file.h"
#include "palmar/io/scan_surfaces_file.h"
#include "palmar/io/sha256.h"

namespace palmar::cli {
namespace {

/// Digest of all that the surfaces of a scan depend on.
std::string key_of(const SelectedScan& selected, const SurfaceOptions& options) {
  Sha256 digest;
  for (const std::string& file : selected.files) {
    const std::string bytes = read_file(file);
    digest.add(fmt::format("{}:", bytes.size()));
    digest.add(bytes);
  }
  digest.add(fmt::format("{} {} {} {} {} {} {}", build_description(), options.air_threshold,
                         options.bone_threshold, options.corrects_bias, options.edge_length,
                         options.marker_diameter, selected.choice.number.value_or(-1)));
  return digest.hex();
}

std::string folder_of(ScanPosture posture, const std::string& work) {
  return (std::filesystem::path(work) / name_of(posture)).string();
}

/// What the tag says about the side, held against the anatomy.
void check_laterality(const RecordedScan& scan, std::vector<std::string>& notes) {
  if (scan.laterality.empty()) return;
  const bool says_left = scan.laterality == "L";
  if (says_left == (scan.surfaces.side == Side::kLeft)) return;
  notes.push_back(
      fmt::format("{}: its tag Laterality says {}, but the hand is a {} one; the anatomy counts "
                  "(--side decides)",
                  scan.title, scan.laterality, name_of(scan.surfaces.side)));
}

/// What the user says about a scan counts over what was found.
RecordedScan finished(RecordedScan scan, const Hand& model, const MriPipelineOptions& options) {
  if (options.side) scan.surfaces.side = *options.side;
  if (scan.posture == ScanPosture::kReference) {
    apply_bone_labels(scan.surfaces, options.labels, model);
  }
  return scan;
}

}  // namespace

RecordedScan surfaces_of(const SelectedScan& selected, const Hand& model,
                         const MriPipelineOptions& options, const Progress& progress) {
  RecordedScan scan;
  scan.posture = selected.posture;
  scan.title = selected.title;
  if (selected.has_surfaces) {
    scan.surfaces = read_scan_surfaces(selected.path);
    scan.was_kept = true;
    return finished(std::move(scan), model, options);
  }
  const std::string folder = folder_of(selected.posture, options.work);
  progress.update(0.0, "looking for what is there");
  const std::string key = key_of(selected, options.surfaces);
  if (key_of_scan_surfaces(folder) == key) {
    scan.surfaces = read_scan_surfaces(folder);
    scan.was_kept = true;
  } else {
    const ImageFile file = read_image(selected.path, selected.choice, part_of(progress, 0.0, 0.1));
    scan.laterality = file.laterality;
    scan.surfaces = find_surfaces(file.image, selected.title, model, options.surfaces,
                                  part_of(progress, 0.1, 0.95));
    scan.surfaces.notes.insert(scan.surfaces.notes.begin(), file.notes.begin(), file.notes.end());
    check_laterality(scan, scan.surfaces.notes);
    write_scan_surfaces(folder, scan.surfaces, key);
  }
  return finished(std::move(scan), model, options);
}

ScanRecord run_mri_pipeline(const std::vector<SelectedScan>& scans, const Hand& model,
                            const MriPipelineOptions& options, const Progress& progress) {
  constexpr double kSurfaces = 0.8, kMotions = 0.9;  // shares of the time
  ScanRecord result;
  const double step = kSurfaces / static_cast<double>(scans.size());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const double begin = step * static_cast<double>(k);
    result.scans.push_back(surfaces_of(
        scans[k], model, options,
        part_of(progress, begin, begin + step, std::string(name_of(scans[k].posture)))));
  }
  const ScanSurfaces& reference = result.scans.front().surfaces;
  for (std::size_t k = 1; k < result.scans.size(); ++k) {
    const RecordedScan& scan = result.scans[k];
    if (scan.surfaces.side != reference.side) {
      throw InputError(scan.title + ": shows a " + std::string(name_of(scan.surfaces.side)) +
                       " hand, but the reference is a " + std::string(name_of(reference.side)) +
                       " one; leave it out with --skip, or say --side if one of them is wrong");
    }
    const double width = (kMotions - kSurfaces) / static_cast<double>(result.scans.size());
    const double begin = kSurfaces + width * static_cast<double>(k);
    result.motions[scan.posture] =
        track_bones(reference, scan.surfaces,
                    part_of(progress, begin, begin + width, std::string(name_of(scan.posture))));
  }
  progress.update(kMotions, "joints");
  const Hand sided = reference.side == model.side ? model : mirrored(model);
  std::map<ScanPosture, ScanSurfaces> surfaces;
  for (const RecordedScan& scan : result.scans) surfaces[scan.posture] = scan.surfaces;
  result.joints = measure_joints(surfaces, result.motions, sided);
  result.made = make_scanned_hand(sided, surfaces, result.joints, part_of(progress, kMotions, 1.0));
  for (const RecordedScan& scan : result.scans) {
    for (const std::string& note : scan.surfaces.notes) {
      result.notes.push_back(std::string(name_of(scan.posture)) + ": " + note);
    }
  }
  result.notes.insert(result.notes.end(), result.joints.notes.begin(), result.joints.notes.end());
  result.notes.insert(result.notes.end(), result.made.notes.begin(), result.made.notes.end());
  return result;
}

}  // namespace palmar::cli
