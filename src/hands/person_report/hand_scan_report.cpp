// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_report/hand_scan_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "palmar/formats/file.h"
#include "palmar/formats/mesh/coloured_mesh_file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/bones/bone_shape.h"
#include "palmar/hand/skin/skinning.h"
#include "hands/person_records/hand_from_scan_json.h"
#include "hands/person_records/mark_label_file.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/report/picture/render.h"
#include "hands/person_report/found_sheet.h"
#include "hands/person_report/scan_report.h"
#include "palmar/report/words/plain_words.h"

namespace palmar {
namespace {

constexpr Rgb kDotColour{230, 30, 30};
constexpr int kWidth = 700, kHeight = 620;

Image picture_of(const Scene& scene, const Vec3& direction) {
  const Camera camera =
      fit_camera(scene, direction, Vec3::UnitY(), {.aspect = double{kWidth} / kHeight});
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  return render_scene(scene, camera, options);
}

SceneObject ball(const Vec3& centre, double radius, Rgb colour) {
  return {
      .mesh = ellipsoid_mesh(centre, Eigen::Matrix3d::Identity(), Vec3::Constant(radius), 8, 16),
      .colour = colour};
}

/// The scan with its colours; found dots ringed by a small ball.
Scene scan_scene(const ShownScan& scan, const Rigid3& hand_from_scan) {
  SceneObject surface = coloured_surface(scan);
  for (Vec3& v : surface.mesh.vertices) v = hand_from_scan * v;
  Scene scene{std::move(surface)};
  for (const InkDot& dot : scan.marks.dots) {
    scene.push_back(ball(hand_from_scan * dot.point, 0.9, kDotColour));
  }
  return scene;
}

ColourScale distance_scale() {
  return {.map = Colormap::kFern,
          .upper = 1.0,
          .quantity = "Distance",
          .unit = "mm",
          .is_open_ended = true};
}

Scene distance_scene(const HandFromScan& made) {
  std::vector<double> field = made.distance;
  for (double& d : field) d = d < 0.0 ? 0.0 : std::max(d, 0.01 * distance_scale().upper);
  return {{.mesh = made.scanned.hand.skin,
           .colour = kNeutralColour,
           .field = std::move(field),
           .field_upper = distance_scale().upper,
           .map = distance_scale().map}};
}

Scene joint_scene(const Hand& hand) {
  Scene scene;
  scene.push_back({.mesh = hand.skin, .colour = kSkinColour, .opacity = 0.35});
  for (const Bone& bone : hand.bones) {
    scene.push_back({.mesh = bone.mesh, .colour = kBoneColour});
  }
  for (const Joint& joint : hand.skeleton.joints) {
    if (joint.id == JointId::kWrist || joint.dofs.empty()) continue;
    // The flexion axis as a thin rod.
    const Vec3& axis = joint.dofs.back().axis;
    Eigen::Matrix3d frame;
    const Vec3 a = axis.unitOrthogonal();
    frame << axis, a, axis.cross(a);
    scene.push_back({.mesh = ellipsoid_mesh(joint.centre, frame, Vec3(14.0, 0.7, 0.7), 12, 12),
                     .colour = kDotColour});
  }
  return scene;
}

std::vector<Picture> pictures_of(const HandFromScan& made,
                                 const std::map<ScanPosture, ShownScan>& scans,
                                 const Progress& progress) {
  struct Shown {
    std::string name, title, alt;
    Scene scene;
    std::optional<ColourScale> scale;
  };
  std::vector<Shown> all;
  all.push_back({"hand_",
                 "The new hand, ",
                 "Skin, see-through, with bones and flexion axes inside, seen from the ",
                 joint_scene(made.scanned.hand),
                 {}});
  all.push_back({"distance_", "Distance of the hand's skin to the scan, ",
                 "The new hand's skin coloured by its distance to the scan, seen from the ",
                 distance_scene(made), distance_scale()});
  for (const auto& [posture, scan] : scans) {
    const auto place = made.scan_from_hand.find(posture);
    if (place == made.scan_from_hand.end()) continue;
    all.push_back({"scan_" + std::string(name_of(posture)) + "_",
                   "Scan of the posture " + plain_words(posture) + ", ",
                   "The scanned surface in its colours, found dots in red, seen from the ",
                   scan_scene(scan, place->second.inverse()),
                   {}});
  }
  const std::array<std::pair<const char*, double>, 2> views{{{"palm", -1.0}, {"back", 1.0}}};
  std::vector<Picture> pictures;
  for (const Shown& shown : all) {
    for (const auto& [view, z] : views) {
      progress.update(
          static_cast<double>(pictures.size()) / (2.0 * static_cast<double>(all.size())),
          "pictures");
      Image image = picture_of(shown.scene, Vec3(0.0, 0.0, z));
      if (shown.scale) draw_colour_bar(image, *shown.scale);
      const std::string words = std::string(view) + " side";
      pictures.push_back(
          {shown.name + view, shown.title + words, shown.alt + words + ".", std::move(image)});
    }
  }
  return pictures;
}

PageJson place_json(const std::optional<MeanPlaceError>& error) {
  if (!error) return nullptr;
  PageJson axis = nullptr;
  if (error->axis) axis = *error->axis * kDegreesPerRadian;
  return {{"place_mm", error->place}, {"axis_deg", std::move(axis)}};
}

PageJson truth_json(const std::optional<ScanErrors>& errors) {
  if (!errors) return nullptr;
  PageJson dimensions = PageJson::array();
  for (const auto& [axis, error] :
       {std::pair{"x", errors->x}, std::pair{"y", errors->y}, std::pair{"z", errors->z}}) {
    dimensions.push_back({{"axis", axis}, {"mean_mm", error.mean}, {"largest_mm", error.largest}});
  }
  PageJson fingers = PageJson::array();
  for (const ScanPosture posture :
       {ScanPosture::kReference, ScanPosture::kFingerFlexion, ScanPosture::kFingerAbduction}) {
    const auto pip = mean_error(*errors, posture, FingerPlace::kPip);
    if (!pip) continue;
    fingers.push_back({{"posture", name_of(posture)},
                       {"pip", place_json(pip)},
                       {"dip", place_json(mean_error(*errors, posture, FingerPlace::kDip))},
                       {"tip", place_json(mean_error(*errors, posture, FingerPlace::kTip))}});
  }
  PageJson limits = PageJson::array();
  for (const PlaceError& e : errors->places) {
    if (!is_thumb_limit(e.posture) || e.segment != Segment::kThumbProximal) continue;
    limits.push_back({{"posture", name_of(e.posture)},
                      {"place_mm", e.place},
                      {"axis_deg", *e.axis * kDegreesPerRadian}});
  }
  PageJson skin = nullptr;
  if (errors->skin_p95 > 0.0) {
    skin = {{"mean_mm", errors->skin_mean}, {"p95_mm", errors->skin_p95}};
  }
  return {{"dimensions", std::move(dimensions)},
          {"fingers", std::move(fingers)},
          {"thumb_limits", std::move(limits)},
          {"skin", std::move(skin)}};
}

std::string page_of(const HandFromScan& made, const std::map<ScanPosture, ShownScan>& scans,
                    const std::optional<ScanErrors>& errors, const std::vector<Picture>& pictures,
                    const std::string& json, Language language) {
  const Hand& hand = made.scanned.hand;
  PageJson segments = PageJson::object();
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentDimensions& size = hand.dimensions.segment[static_cast<std::size_t>(s)];
    segments[std::string(name_of(static_cast<Segment>(s)))] = {
        {"length_mm", size.length}, {"width_mm", size.width}, {"thickness_mm", size.thickness}};
  }
  PageJson shown = PageJson::array();
  for (const auto& [posture, scan] : scans) {
    shown.push_back({{"posture", name_of(posture)},
                     {"file", scan.file},
                     {"triangles", scan.surface.mesh.triangle_count()},
                     {"dots", scan.marks.dots.size()},
                     {"lines", scan.marks.lines.size()}});
  }
  Attachments attachments;
  const PageJson view = {{"maker", maker_json()},
                         {"language", name_of(language)},
                         {"vocabulary", vocabulary_json(hand)},
                         {"segments", std::move(segments)},
                         {"scans", std::move(shown)},
                         {"truth", truth_json(errors)},
                         {"pictures", pictures_json(pictures, attachments)}};
  return render_page("hand_from_scan", json, view, std::move(attachments));
}

}  // namespace

void write_hand_scan_report(const std::string& folder, const HandFromScan& made,
                            const std::map<ScanPosture, ShownScan>& scans,
                            const std::optional<ScanErrors>& errors, Language language,
                            const Progress& progress) {
  const std::filesystem::path base(folder);
  create_folder(base);
  const std::string json = hand_from_scan_json(made);
  write_file(base / "scan.json", json + "\n");
  write_file(base / "dimensions.csv",
             format_csv(dimension_csv(made.scanned.hand.dimensions, made.tape)));
  if (errors) write_file(base / "truth_errors.csv", format_csv(truth_error_csv(*errors)));
  write_file(base / "marks.csv", format_csv(mark_table(made.marks)));
  write_file(base / "joints_by_dots.csv", format_csv(dotted_joint_csv(made)));
  for (const auto& [posture, scan] : scans) {
    const std::filesystem::path shown = base / ("scan_" + std::string(name_of(posture)) + ".ply");
    if (scan.surface.colour.empty()) {
      write_mesh(shown, scan.surface.mesh);
    } else {
      write_coloured_mesh(shown, scan.surface);
    }
  }
  const std::vector<Picture> pictures = pictures_of(made, scans, progress);
  write_file(base / "report.html", page_of(made, scans, errors, pictures, json, language));
}

}  // namespace palmar
