// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "mri/mri_step_commands.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "assess/surface_arguments.h"
#include "palmar/capture/mri/bones/bone_plausibility.h"
#include "palmar/capture/mri/measured_joints.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/image/dicom.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/records/capture/bone_label_file.h"
#include "palmar/records/capture/scan_record_json.h"
#include "palmar/records/capture/scan_surfaces_file.h"
#include "palmar/records/json_values.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct SurfacesArguments {
  std::string image, out, labels, model = "template", description;
  std::optional<int> number;
  SurfaceArguments surfaces;
  bool accepts_odd_slices = false;
};

/// A damaged slice spoils the surfaces near it.
void require_sound_slices(const std::vector<std::string>& odd, bool is_accepted) {
  if (odd.empty() || is_accepted) return;
  throw InputError(
      fmt::format("{}\nrestore them, or go on with --accept-odd-slices if they look right",
                  fmt::join(odd, "\n")));
}

std::string name_or_dash(const ScannedBone& bone) { return bone.name.empty() ? "-" : bone.name; }

std::string text_of(const ScanSurfaces& surfaces) {
  std::string text = fmt::format(
      "{} hand; thresholds: air {:.1f}, bone {:.1f}; noise {:.1f}; expected error of a "
      "bone's surface {:.2f} mm; {} markers\n  {:<26} {:>11}  {}\n",
      name_of(surfaces.side), surfaces.air_threshold, surfaces.bone_threshold, surfaces.noise,
      surfaces.bone_error_estimate, surfaces.markers.size(), "bone", "volume, mm3", "at, mm");
  for (const ScannedBone& bone : surfaces.bones) {
    const Vec3 centre = centre_of_volume(bone.mesh);
    text += fmt::format("  {:<26} {:>11.0f}  {:.1f}, {:.1f}, {:.1f}{}\n", name_or_dash(bone),
                        signed_volume(bone.mesh), centre.x(), centre.y(), centre.z(),
                        bone.is_cut ? "  (cut by the image)" : "");
  }
  return text;
}

Json json_of(const ScanSurfaces& surfaces) {
  Json bones = Json::array();
  for (const ScannedBone& bone : surfaces.bones) {
    const Vec3 centre = centre_of_volume(bone.mesh);
    bones.push_back({{"name", bone.name},
                     {"volume_mm3", signed_volume(bone.mesh)},
                     {"centre_mm", vector3(centre)},
                     {"triangles", bone.mesh.triangle_count()},
                     {"is_cut", bone.is_cut}});
  }
  Json markers = Json::array();
  for (const Vec3& marker : surfaces.markers) markers.push_back(vector3(marker));
  return {{"side", std::string(name_of(surfaces.side))},
          {"air_threshold", surfaces.air_threshold},
          {"bone_threshold", surfaces.bone_threshold},
          {"noise", surfaces.noise},
          {"bone_error_estimate_mm", surfaces.bone_error_estimate},
          {"bones", std::move(bones)},
          {"markers_mm", std::move(markers)},
          {"notes", surfaces.notes}};
}

int run_surfaces(const SurfacesArguments& a, const Context& context) {
  const Progress progress = make_progress(context.common);
  const auto model = load_hand(a.model);
  const SurfaceOptions options = a.surfaces.options();
  std::vector<BoneLabel> labels;
  if (!a.labels.empty()) labels = read_bone_labels(a.labels);
  const ImageFile file =
      read_image(a.image, {a.number, a.description}, part_of(progress, 0.0, 0.1));
  require_sound_slices(file.odd_slices, a.accepts_odd_slices);
  ScanSurfaces surfaces =
      find_surfaces(file.image, a.image, *model, options, part_of(progress, 0.1, 1.0));
  if (const auto side = a.surfaces.chosen_side()) surfaces.side = *side;
  if (!labels.empty()) apply_bone_labels(surfaces, labels, *model);
  write_scan_surfaces(a.out, surfaces, "");
  finish_progress();
  for (const std::string& text : file.notes) note(context.common, text);
  for (const std::string& text : file.odd_slices) note(context.common, text);
  for (const std::string& text : surfaces.notes) note(context.common, text);
  const std::vector<std::string> doubts = doubtful_bones(surfaces, *model);
  if (!doubts.empty()) {
    note(context.common, fmt::format("look at these bones, which may be found wrongly or bear a "
                                     "wrong name: {}",
                                     fmt::join(doubts, "; ")));
  }
  print(context.common.json ? json_of(surfaces).dump(2) + "\n" : text_of(surfaces));
  note(context.common, "wrote " + a.out);
  return 0;
}

void add_surfaces(CLI::App& mri, Context& context) {
  const auto a = std::make_shared<SurfacesArguments>();
  CLI::App* verb = add_verb(mri, "surfaces", "Skin, bones and markers of one MR image as meshes",
                            "palmar mri surfaces scans/reference --out reference");
  verb->add_option("IMAGE", a->image, "Folder of DICOM files, NIfTI or NRRD file")->required();
  verb->add_option("--out", a->out, "Folder to write: skin.ply, bones/*.ply, scan.json")
      ->required();
  verb->add_option("--series", a->number, "Number of the series, if the folder has several");
  verb->add_option("--description", a->description, "Part of the series' description, likewise");
  verb->add_option("--labels", a->labels, "Names for bones: CSV with name, x_mm, y_mm, z_mm");
  verb->add_option("--model", a->model, "Hand that tells what bones there are")
      ->capture_default_str();
  a->surfaces.add_to(*verb);
  verb->add_flag("--accept-odd-slices", a->accepts_odd_slices,
                 "Go on though a slice doesn't belong between its neighbours");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_surfaces(*a, context); }; });
}

struct MotionArguments {
  std::string reference, posture;
  std::vector<std::string> images;
};

/// Motions from surfaces and, if they are given, images.
std::vector<BoneMotion> motions_of(const MotionArguments& a, const Progress& progress) {
  const ScanSurfaces reference = read_scan_surfaces(a.reference);
  const ScanSurfaces posture = read_scan_surfaces(a.posture);
  if (a.images.empty()) return track_bones(reference, posture, progress);
  const BoneImages bones = images_of_bones(
      reference, blurred_levels(read_image(a.images[0], {}, part_of(progress, 0.0, 0.1)).image));
  const ImageLevels other =
      blurred_levels(read_image(a.images[1], {}, part_of(progress, 0.1, 0.2)).image);
  return track_bones(reference, posture, {&bones, &other}, part_of(progress, 0.2, 1.0));
}

int run_motion(const MotionArguments& a, const Context& context) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const Progress progress = make_progress(context.common);
  const std::vector<BoneMotion> motions = motions_of(a, progress);
  finish_progress();
  if (!context.common.json) {
    std::string text =
        fmt::format("{:<26} {:>10} {:>12} {:>9} {:>12} {:>11}\n", "bone", "turn, deg",
                    "distance, mm", "overlap", "correlation", "error, deg");
    for (const BoneMotion& motion : motions) {
      const Eigen::AngleAxisd turn(motion.posture_from_reference.rotation);
      text += fmt::format("{:<26} {:>10.1f} ", motion.bone, turn.angle() * kDegrees);
      text += motion.is_cut_out
                  ? fmt::format("{:>12.2f} {:>9.2f} ", motion.fit.mean, motion.fit.overlap)
                  : fmt::format("{:>12} {:>9} ", "-", "-");
      text += motion.image ? fmt::format("{:>12.3f} {:>11.2f}\n", motion.image->correlation,
                                         motion.image->turn_error * kDegrees)
                           : fmt::format("{:>12} {:>11}\n", "-", "-");
    }
    print(text);
    return 0;
  }
  print(bone_motions_json(motions) + "\n");
  return 0;
}

void add_motion(CLI::App& mri, Context& context) {
  const auto a = std::make_shared<MotionArguments>();
  CLI::App* verb = add_verb(mri, "motion", "How bones moved from one scan to another",
                            "palmar mri motion reference thumb_flexion");
  verb->add_option("REFERENCE", a->reference, "Folder that palmar mri surfaces made")->required();
  verb->add_option("POSTURE", a->posture, "Another one, of another posture")->required();
  verb->add_option("--images", a->images,
                   "Images of both (DICOM folder, NIfTI or NRRD): bones are laid on their "
                   "intensities, which is more accurate than on their surfaces")
      ->expected(2);
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_motion(*a, context); }; });
}

}  // namespace

void add_mri_steps(CLI::App& mri, Context& context) {
  add_surfaces(mri, context);
  add_motion(mri, context);
}

}  // namespace palmar::cli
