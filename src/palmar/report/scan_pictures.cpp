// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/hand/bone_shape.h"
#include "palmar/report/colormap.h"
#include "palmar/report/render.h"
#include "palmar/report/scan_report.h"

namespace palmar {
namespace {

/// A bone whose name isn't known stands out.
constexpr Rgb kUnnamedColour{204, 121, 167};
constexpr Rgb kMarkerColour{0, 114, 178};

struct View {
  const char* name;
  const char* words;
  Vec3 direction;  ///< hand frame
};
const std::array<View, 2> kViews = {
    {{"palm", "palm side", {0.0, 0.0, -1.0}}, {"thumb", "thumb side", {-1.0, 0.0, 0.0}}}};

Image picture_of(const Scene& scene, const Vec3& direction, const Vec3& up,
                 const PictureOptions& options, const Progress& progress) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const Camera camera = fit_camera(scene, direction, up, {.aspect = aspect});
  RenderOptions render;
  render.width = options.width;
  render.height = options.height;
  return render_views(scene, {camera}, render, progress).front();
}

TriangleMesh moved(TriangleMesh mesh, const Rigid3& by) {
  for (Vec3& vertex : mesh.vertices) vertex = by * vertex;
  return mesh;
}

Scene hand_scene(const Hand& hand) {
  Scene scene;
  scene.push_back({.mesh = hand.skin, .colour = kSkinColour, .opacity = 0.35});
  for (const Bone& bone : hand.bones) {
    scene.push_back({.mesh = bone.mesh, .colour = kBoneColour});
  }
  return scene;
}

Scene scan_scene(const ScanSurfaces& surfaces, const Rigid3& shown_from_patient) {
  Scene scene;
  if (surfaces.skin.triangle_count() > 0) {
    scene.push_back(
        {.mesh = moved(surfaces.skin, shown_from_patient), .colour = kSkinColour, .opacity = 0.35});
  }
  for (const ScannedBone& bone : surfaces.bones) {
    scene.push_back({.mesh = moved(bone.mesh, shown_from_patient),
                     .colour = bone.name.empty() ? kUnnamedColour : kBoneColour});
  }
  for (const Vec3& marker : surfaces.markers) {
    TriangleMesh ball = ellipsoid_mesh(shown_from_patient * marker, Eigen::Matrix3d::Identity(),
                                       Vec3::Constant(2.5), 8, 16);
    scene.push_back({.mesh = std::move(ball), .colour = kMarkerColour});
  }
  return scene;
}

/// Where the palm of a scan is, in the hand frame: by the motion of a bone of the palm.
Rigid3 hand_from_scan(const ScanRecord& record, ScanPosture posture) {
  const Rigid3 hand_from_reference = record.made.patient_from_hand.inverse();
  const auto motions = record.motions.find(posture);
  if (motions == record.motions.end()) return hand_from_reference;
  for (const char* bone : {"middle_metacarpal", "index_metacarpal", "capitate"}) {
    for (const BoneMotion& motion : motions->second) {
      if (motion.bone == bone) {
        return hand_from_reference * motion.posture_from_reference.inverse();
      }
    }
  }
  return hand_from_reference;
}

}  // namespace

std::vector<Picture> scan_pictures(const ScanRecord& record, const PictureOptions& options,
                                   const Progress& progress) {
  std::vector<Picture> pictures;
  const double sign = record.made.hand.side == Side::kLeft ? -1.0 : 1.0;
  const auto direction_of = [&](const View& view) {
    return Vec3(sign * view.direction.x(), view.direction.y(), view.direction.z());
  };
  const double step = 1.0 / static_cast<double>(kViews.size() * (record.scans.size() + 1));
  // Told before each picture: how far the work is.
  const auto next = [&] {
    const double done = step * static_cast<double>(pictures.size());
    progress.update(done, "pictures");
    return part_of(progress, done, done + step, "pictures");
  };
  try {
    const Scene hand = hand_scene(record.made.hand);
    for (const View& view : kViews) {
      const Progress part = next();
      pictures.push_back({"hand_" + std::string(view.name),
                          "The new hand, " + std::string(view.words),
                          "Skin, see-through, with the bones of the scan inside, seen from the " +
                              std::string(view.words) + ".",
                          picture_of(hand, direction_of(view), Vec3::UnitY(), options, part)});
    }
    for (const RecordedScan& scan : record.scans) {
      const Scene scene = scan_scene(scan.surfaces, hand_from_scan(record, scan.posture));
      if (scene.empty()) continue;
      std::string words(name_of(scan.posture));
      for (char& c : words) c = c == '_' ? ' ' : c;
      for (const View& view : kViews) {
        const Progress part = next();
        pictures.push_back({std::string(name_of(scan.posture)) + "_" + view.name,
                            "Scan of the posture " + words + ", " + view.words,
                            "What was found in the scan: skin, bones, markers; seen from the " +
                                std::string(view.words) + ".",
                            picture_of(scene, direction_of(view), Vec3::UnitY(), options, part)});
      }
    }
  } catch (const Cancelled&) {
  }
  return pictures;
}

}  // namespace palmar
