// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "hands/capture/skin_registration.h"
#include "hands/person_report/scan_report.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/bones/bone_shape.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::person_report {
namespace {

/// A bone whose name isn't known stands out.
constexpr report::Rgb kUnnamedColour{204, 121, 167};
constexpr report::Rgb kMarkerColour{0, 114, 178};

struct ScanView {
  const char* name;
  const char* words;
  Vec3 direction;  ///< hand frame
};
const std::array<ScanView, 2> kViews = {
    {{"palm", "palm side", {0.0, 0.0, -1.0}}, {"thumb", "thumb side", {-1.0, 0.0, 0.0}}}};

report::Image picture_of(const report::Scene& scene, const Vec3& direction, const Vec3& up,
                         const report::PictureOptions& options, const Progress& progress) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const report::Camera camera = report::fit_camera(scene, direction, up, {.aspect = aspect});
  report::RenderOptions render;
  render.width = options.width;
  render.height = options.height;
  return report::render_views(scene, {camera}, render, progress).front();
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const geometry::Rigid3& by) {
  for (Vec3& vertex : mesh.vertices) vertex = by * vertex;
  return mesh;
}

report::Scene hand_scene(const hand::Hand& hand) {
  report::Scene scene;
  scene.push_back({.mesh = hand.skin, .colour = report::kSkinColour, .opacity = 0.35});
  for (const hand::Bone& bone : hand.bones) {
    scene.push_back({.mesh = bone.mesh, .colour = report::kBoneColour});
  }
  return scene;
}

report::Scene scan_scene(const capture::ScanSurfaces& surfaces,
                         const geometry::Rigid3& shown_from_patient) {
  report::Scene scene;
  if (surfaces.skin.triangle_count() > 0) {
    scene.push_back({.mesh = moved(surfaces.skin, shown_from_patient),
                     .colour = report::kSkinColour,
                     .opacity = 0.35});
  }
  for (const capture::ScannedBone& bone : surfaces.bones) {
    scene.push_back({.mesh = moved(bone.mesh, shown_from_patient),
                     .colour = bone.name.empty() ? kUnnamedColour : report::kBoneColour});
  }
  for (const Vec3& marker : surfaces.markers) {
    geometry::TriangleMesh ball = hand::ellipsoid_mesh(
        shown_from_patient * marker, Eigen::Matrix3d::Identity(), Vec3::Constant(2.5), 8, 16);
    scene.push_back({.mesh = std::move(ball), .colour = kMarkerColour});
  }
  return scene;
}

/// Where the palm of a scan is, in the hand frame: by the motion of a bone of the palm.
geometry::Rigid3 hand_from_scan(const capture::ScanRecord& record, hand::ScanPosture posture) {
  const geometry::Rigid3 hand_from_reference = record.made.patient_from_hand.inverse();
  const auto motions = record.motions.find(posture);
  if (motions == record.motions.end()) return hand_from_reference;
  for (const char* bone : {"middle_metacarpal", "index_metacarpal", "capitate"}) {
    for (const capture::BoneMotion& motion : motions->second) {
      if (motion.bone == bone) {
        return hand_from_reference * motion.posture_from_reference.inverse();
      }
    }
  }
  return hand_from_reference;
}

/// The middle of a bone, if it was found.
std::optional<Vec3> middle_of(const capture::ScanSurfaces& surfaces, const std::string& name) {
  for (const capture::ScannedBone& bone : surfaces.bones) {
    if (bone.name != name || bone.mesh.vertices.empty()) continue;
    Vec3 sum = Vec3::Zero();
    for (const Vec3& vertex : bone.mesh.vertices) sum += vertex;
    return sum / static_cast<double>(bone.mesh.vertices.size());
  }
  return {};
}

/// Axes of the hand frame by metacarpals and first phalanges of a scan: y towards the fingers, x
/// towards the thumb of a right hand, away from that of a left one. The patient's where they lack.
geometry::Rigid3 upright_from_scan(const capture::ScanSurfaces& surfaces) {
  geometry::Rigid3 upright;
  std::optional<Vec3> first, last;
  Vec3 distal = Vec3::Zero();
  for (const char* finger : {"index", "middle", "ring", "little"}) {
    const auto metacarpal = middle_of(surfaces, std::string(finger) + "_metacarpal");
    const auto phalanx = middle_of(surfaces, std::string(finger) + "_proximal_phalanx");
    if (metacarpal && !first) first = metacarpal;
    if (metacarpal) last = metacarpal;
    if (metacarpal && phalanx) distal += *phalanx - *metacarpal;
  }
  if (!first || (*first - *last).norm() < 1.0 || distal.norm() < 1.0) return upright;
  const Vec3 y = distal.normalized();
  Vec3 x = surfaces.side == hand::Side::kLeft ? *last - *first : *first - *last;
  x = (x - x.dot(y) * y).normalized();
  Eigen::Matrix3d axes;
  axes << x, y, x.cross(y);
  upright.rotation = Quat(Eigen::Matrix3d(axes.transpose()));
  return upright;
}

/// Colours of the distance from posed to scanned skin.
report::ColourScale error_scale() {
  return {.map = report::Colormap::kFern,
          .upper = 3.0,
          .quantity = "Distance",
          .unit = "mm",
          .is_open_ended = true};
}

/// The hand in a posture as its joints make it, coloured by its distance to the scan. Skin that has
/// no scanned skin near (touching fingers, markers, the cut) stays grey.
report::Scene error_scene(const capture::ScanRecord& record, const capture::RecordedScan& scan,
                          const hand::Posture& posture) {
  const hand::Hand& hand = record.made.hand;
  const geometry::Rigid3 hand_from_patient = hand_from_scan(record, scan.posture);
  capture::SkinScan scanned;
  scanned.skin = moved(scan.surfaces.skin, hand_from_patient);
  for (const Vec3& marker : scan.surfaces.markers) {
    scanned.markers.push_back(hand_from_patient * marker);
  }
  constexpr double kReach = 15.0;  // mm
  const geometry::TriangleMesh posed{hand::pose_skin(hand, posture), hand.skin.triangles};
  std::vector<double> distance = capture::distances_to_scan(
      posed.vertices, geometry::vertex_normals(posed), scanned, hand.skeleton, kReach);
  const double least = 0.01 * error_scale().upper;  // less would look as if nothing was measured
  for (double& d : distance) d = d < 0.0 ? 0.0 : std::max(d, least);
  report::Scene scene;
  scene.push_back({.mesh = posed,
                   .colour = report::kNeutralColour,
                   .field = std::move(distance),
                   .field_upper = error_scale().upper,
                   .map = error_scale().map});
  return scene;
}

/// One thing to be shown from every side.
struct Shown {
  std::string name, title, alt;
  report::Scene scene;
  std::optional<report::ColourScale> scale;
};

Shown shown_scan(const capture::RecordedScan& scan, const geometry::Rigid3& shown_from_patient) {
  return {"scan_" + std::string(name_of(scan.posture)) + "_",
          "Scan of the posture " + plain_words(scan.posture) + ", ",
          "What was found in the scan: skin, bones, markers; seen from the ",
          scan_scene(scan.surfaces, shown_from_patient),
          {}};
}

/// When cancelled, those that are finished.
std::vector<report::Picture> drawn(const std::vector<Shown>& all, hand::Side side,
                                   const report::PictureOptions& options,
                                   const Progress& progress) {
  const double sign = side == hand::Side::kLeft ? -1.0 : 1.0;
  std::vector<report::Picture> pictures;
  const double step = 1.0 / static_cast<double>(kViews.size() * all.size());
  try {
    for (const Shown& shown : all) {
      for (const ScanView& view : kViews) {
        const double done = step * static_cast<double>(pictures.size());
        progress.update(done, "pictures");
        const Vec3 direction(sign * view.direction.x(), view.direction.y(), view.direction.z());
        report::Image image = picture_of(shown.scene, direction, Vec3::UnitY(), options,
                                         part_of(progress, done, done + step, "pictures"));
        if (shown.scale) report::draw_colour_bar(image, *shown.scale);
        pictures.push_back({shown.name + view.name, shown.title + view.words,
                            shown.alt + view.words + ".", std::move(image)});
      }
    }
  } catch (const Cancelled&) {
  }
  return pictures;
}

}  // namespace

std::vector<report::Picture> scan_pictures(const capture::ScanRecord& record,
                                           const report::PictureOptions& options,
                                           const Progress& progress) {
  std::vector<Shown> all;
  all.push_back({"hand_",
                 "The new hand, ",
                 "Skin, see-through, with the bones of the scan inside, seen from the ",
                 hand_scene(record.made.hand),
                 {}});
  for (const capture::RecordedScan& scan : record.scans) {
    const auto posed = record.joints.postures.find(scan.posture);
    if (scan.posture == hand::ScanPosture::kReference || posed == record.joints.postures.end())
      continue;
    const std::string words = plain_words(scan.posture);
    all.push_back(
        {"error_" + std::string(name_of(scan.posture)) + "_",
         "Posed skin, distance to the scan: " + words + ", ",
         "The hand in the posture " + words +
             ", coloured by the distance of its skin from the scanned one, seen from the ",
         error_scene(record, scan, posed->second), error_scale()});
  }
  for (const capture::RecordedScan& scan : record.scans) {
    all.push_back(shown_scan(scan, hand_from_scan(record, scan.posture)));
  }
  return drawn(all, record.made.hand.side, options, progress);
}

std::vector<report::Picture> found_pictures(const capture::ScanRecord& record,
                                            const report::PictureOptions& options,
                                            const Progress& progress) {
  std::vector<Shown> all;
  for (const capture::RecordedScan& scan : record.scans) {
    all.push_back(shown_scan(scan, upright_from_scan(scan.surfaces)));
  }
  return drawn(all, record.scans.front().surfaces.side, options, progress);
}

}  // namespace palmar::person_report
