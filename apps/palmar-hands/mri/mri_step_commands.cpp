// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "mri/mri_step_commands.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hands/person_records/scan_record_json.h"
#include "hands/person_workflow/steps/mri_steps.h"
#include "mri/surface_arguments.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/records/json_values.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct SurfacesArguments {
  person_workflow::MriSurfacesRequest request;
  SurfaceArguments surfaces;
};

std::string name_or_dash(const capture::ScannedBone& bone) {
  return bone.name.empty() ? "-" : bone.name;
}

std::string text_of(const capture::ScanSurfaces& surfaces) {
  std::string text = fmt::format(
      "{} hand; thresholds: air {:.1f}, bone {:.1f}; noise {:.1f}; expected error of a "
      "bone's surface {:.2f} mm; {} markers\n  {:<26} {:>11}  {}\n",
      name_of(surfaces.side), surfaces.air_threshold, surfaces.bone_threshold, surfaces.noise,
      surfaces.bone_error_estimate, surfaces.markers.size(), "bone", "volume, mm3", "at, mm");
  for (const capture::ScannedBone& bone : surfaces.bones) {
    const Vec3 centre = geometry::centre_of_volume(bone.mesh);
    text += fmt::format("  {:<26} {:>11.0f}  {:.1f}, {:.1f}, {:.1f}{}\n", name_or_dash(bone),
                        geometry::signed_volume(bone.mesh), centre.x(), centre.y(), centre.z(),
                        bone.is_cut ? "  (cut by the image)" : "");
  }
  return text;
}

Json json_of(const capture::ScanSurfaces& surfaces) {
  Json bones = Json::array();
  for (const capture::ScannedBone& bone : surfaces.bones) {
    const Vec3 centre = geometry::centre_of_volume(bone.mesh);
    bones.push_back({{"name", bone.name},
                     {"volume_mm3", geometry::signed_volume(bone.mesh)},
                     {"centre_mm", records::vector3(centre)},
                     {"triangles", bone.mesh.triangle_count()},
                     {"is_cut", bone.is_cut}});
  }
  Json markers = Json::array();
  for (const Vec3& marker : surfaces.markers) markers.push_back(records::vector3(marker));
  return {{"side", std::string(name_of(surfaces.side))},
          {"air_threshold", surfaces.air_threshold},
          {"bone_threshold", surfaces.bone_threshold},
          {"noise", surfaces.noise},
          {"bone_error_estimate_mm", surfaces.bone_error_estimate},
          {"fat_shift_mm", records::vector3(surfaces.fat_shift)},
          {"bones", std::move(bones)},
          {"markers_mm", std::move(markers)},
          {"notes", surfaces.notes}};
}

int run_surfaces(const SurfacesArguments& a, const Context& context) {
  person_workflow::MriSurfacesRequest request = a.request;
  request.surfaces = a.surfaces.options();
  const person_workflow::MriSurfacesOutcome outcome =
      person_workflow::find_mri_surfaces(request, make_progress(context.common));
  finish_progress();
  for (const std::string& text : outcome.notes) note(context.common, text);
  const capture::ScanSurfaces& surfaces = outcome.surfaces;
  print(context.common.json ? json_of(surfaces).dump(2) + "\n" : text_of(surfaces));
  note(context.common, "wrote " + request.out);
  return 0;
}

void add_surfaces(CLI::App& mri, Context& context) {
  const auto a = std::make_shared<SurfacesArguments>();
  CLI::App* verb =
      add_verb(mri, "surfaces", "Skin, bones and markers of one MR image as meshes",
               "palmar mri surfaces subject3/mri --description reference --out reference");
  verb->add_option("IMAGE", a->request.image,
                   "Folder of DICOM files, DICOM file of several frames, NIfTI file")
      ->required();
  verb->add_option("--out", a->request.out, "Folder to write: skin.ply, bones/*.ply, scan.json")
      ->required();
  verb->add_option("--series", a->request.choice.number,
                   "Number of the series, if the folder has several");
  verb->add_option("--description", a->request.choice.description,
                   "Part of the series' description, instead of the number");
  verb->add_option("--labels", a->request.labels,
                   "Names for bones: CSV with name, x_mm, y_mm, z_mm");
  verb->add_option("--start-hand", a->request.model, "Hand that names the bones")
      ->capture_default_str();
  a->surfaces.add_to(*verb);
  verb->add_flag("--accept-odd-slices", a->request.accepts_odd_slices,
                 "Continue although a slice doesn't fit between its neighbours");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_surfaces(*a, context); }; });
}

struct MotionArguments {
  person_workflow::BoneMotionRequest request;
  std::vector<std::string> images;  ///< none or two
};

int run_motion(const MotionArguments& a, const Context& context) {
  person_workflow::BoneMotionRequest request = a.request;
  if (!a.images.empty()) request.images = {a.images.at(0), a.images.at(1)};
  const std::vector<capture::BoneMotion> motions =
      person_workflow::find_bone_motions(request, make_progress(context.common));
  finish_progress();
  if (!context.common.json) {
    std::string text =
        fmt::format("{:<26} {:>10} {:>12} {:>9} {:>12} {:>11}\n", "bone", "turn, deg",
                    "distance, mm", "overlap", "correlation", "error, deg");
    for (const capture::BoneMotion& motion : motions) {
      const Eigen::AngleAxisd turn(motion.posture_from_reference.rotation);
      text +=
          fmt::format("{:<26} {:>10.1f} ", motion.bone, turn.angle() * geometry::kDegreesPerRadian);
      text += motion.is_cut_out
                  ? fmt::format("{:>12.2f} {:>9.2f} ", motion.fit.mean, motion.fit.overlap)
                  : fmt::format("{:>12} {:>9} ", "-", "-");
      text += motion.image ? fmt::format("{:>12.3f} {:>11.2f}\n", motion.image->correlation,
                                         motion.image->turn_error * geometry::kDegreesPerRadian)
                           : fmt::format("{:>12} {:>11}\n", "-", "-");
    }
    print(text);
    return 0;
  }
  print(person_records::bone_motions_json(motions) + "\n");
  return 0;
}

void add_motion(CLI::App& mri, Context& context) {
  const auto a = std::make_shared<MotionArguments>();
  CLI::App* verb = add_verb(mri, "motion", "How bones moved from one scan to another",
                            "palmar mri motion reference thumb_flexion");
  verb->add_option("REFERENCE", a->request.reference, "Folder that palmar mri surfaces made")
      ->required();
  verb->add_option("POSTURE", a->request.posture, "Another one, of another posture")->required();
  verb->add_option("--images", a->images,
                   "Images of both (DICOM or NIfTI): bones are aligned by their "
                   "intensities, which is more accurate than by their surfaces")
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
