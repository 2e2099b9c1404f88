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

#include "hands/person_records/hand_from_scan_json.h"
#include "hands/person_records/mark_label_file.h"
#include "hands/person_report/found_sheet.h"
#include "hands/person_report/scan_report.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/coloured_mesh_file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/bones/bone_shape.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::person_report {
namespace {

constexpr report::Rgb kDotColour{230, 30, 30};
constexpr int kWidth = 700, kHeight = 620;

report::Image picture_of(const report::Scene& scene, const Vec3& direction) {
  const report::Camera camera =
      report::fit_camera(scene, direction, Vec3::UnitY(), {.aspect = double{kWidth} / kHeight});
  report::RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  return report::render_scene(scene, camera, options);
}

report::SceneObject ball(const Vec3& centre, double radius, report::Rgb colour) {
  return {.mesh = hand::ellipsoid_mesh(centre, Eigen::Matrix3d::Identity(), Vec3::Constant(radius),
                                       8, 16),
          .colour = colour};
}

/// The scan with its colours; found dots ringed by a small ball.
report::Scene scan_scene(const ShownScan& scan, const geometry::Rigid3& hand_from_scan) {
  report::SceneObject surface = coloured_surface(scan);
  for (Vec3& v : surface.mesh.vertices) v = hand_from_scan * v;
  report::Scene scene{std::move(surface)};
  for (const capture::InkDot& dot : scan.marks.dots) {
    scene.push_back(ball(hand_from_scan * dot.point, 0.9, kDotColour));
  }
  return scene;
}

report::ColourScale distance_scale() {
  return {.map = report::Colormap::kFern,
          .upper = 1.0,
          .quantity = "Distance",
          .unit = "mm",
          .is_open_ended = true};
}

report::Scene distance_scene(const capture::HandFromScan& made) {
  std::vector<double> field = made.distance;
  for (double& d : field) d = d < 0.0 ? 0.0 : std::max(d, 0.01 * distance_scale().upper);
  return {{.mesh = made.scanned.hand.skin,
           .colour = report::kNeutralColour,
           .field = std::move(field),
           .field_upper = distance_scale().upper,
           .map = distance_scale().map}};
}

report::Scene joint_scene(const hand::Hand& hand) {
  report::Scene scene;
  scene.push_back({.mesh = hand.skin, .colour = report::kSkinColour, .opacity = 0.35});
  for (const hand::Bone& bone : hand.bones) {
    scene.push_back({.mesh = bone.mesh, .colour = report::kBoneColour});
  }
  for (const hand::Joint& joint : hand.skeleton.joints) {
    if (joint.id == hand::JointId::kWrist || joint.dofs.empty()) continue;
    // The flexion axis as a thin rod.
    const Vec3& axis = joint.dofs.back().axis;
    Eigen::Matrix3d frame;
    const Vec3 a = axis.unitOrthogonal();
    frame << axis, a, axis.cross(a);
    scene.push_back(
        {.mesh = hand::ellipsoid_mesh(joint.centre, frame, Vec3(14.0, 0.7, 0.7), 12, 12),
         .colour = kDotColour});
  }
  return scene;
}

std::vector<report::Picture> pictures_of(const capture::HandFromScan& made,
                                         const std::map<hand::ScanPosture, ShownScan>& scans,
                                         const Progress& progress) {
  struct Shown {
    std::string name, title, alt;
    report::Scene scene;
    std::optional<report::ColourScale> scale;
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
  std::vector<report::Picture> pictures;
  for (const Shown& shown : all) {
    for (const auto& [view, z] : views) {
      progress.update(
          static_cast<double>(pictures.size()) / (2.0 * static_cast<double>(all.size())),
          "pictures");
      report::Image image = picture_of(shown.scene, Vec3(0.0, 0.0, z));
      if (shown.scale) report::draw_colour_bar(image, *shown.scale);
      const std::string words = std::string(view) + " side";
      pictures.push_back(
          {shown.name + view, shown.title + words, shown.alt + words + ".", std::move(image)});
    }
  }
  return pictures;
}

report::PageJson place_json(const std::optional<capture::MeanPlaceError>& error) {
  if (!error) return nullptr;
  report::PageJson axis = nullptr;
  if (error->axis) axis = *error->axis * geometry::kDegreesPerRadian;
  return {{"place_mm", error->place}, {"axis_deg", std::move(axis)}};
}

report::PageJson truth_json(const std::optional<capture::ScanErrors>& errors) {
  if (!errors) return nullptr;
  report::PageJson dimensions = report::PageJson::array();
  for (const auto& [axis, error] :
       {std::pair{"x", errors->x}, std::pair{"y", errors->y}, std::pair{"z", errors->z}}) {
    dimensions.push_back({{"axis", axis}, {"mean_mm", error.mean}, {"largest_mm", error.largest}});
  }
  report::PageJson fingers = report::PageJson::array();
  for (const hand::ScanPosture posture :
       {hand::ScanPosture::kReference, hand::ScanPosture::kFingerFlexion,
        hand::ScanPosture::kFingerAbduction}) {
    const auto pip = capture::mean_error(*errors, posture, capture::FingerPlace::kPip);
    if (!pip) continue;
    fingers.push_back(
        {{"posture", name_of(posture)},
         {"pip", place_json(pip)},
         {"dip", place_json(capture::mean_error(*errors, posture, capture::FingerPlace::kDip))},
         {"tip", place_json(capture::mean_error(*errors, posture, capture::FingerPlace::kTip))}});
  }
  report::PageJson limits = report::PageJson::array();
  for (const capture::PlaceError& e : errors->places) {
    if (!capture::is_thumb_limit(e.posture) || e.segment != hand::Segment::kThumbProximal) continue;
    limits.push_back({{"posture", name_of(e.posture)},
                      {"place_mm", e.place},
                      {"axis_deg", *e.axis * geometry::kDegreesPerRadian}});
  }
  report::PageJson skin = nullptr;
  if (errors->skin_p95 > 0.0) {
    skin = {{"mean_mm", errors->skin_mean}, {"p95_mm", errors->skin_p95}};
  }
  return {{"dimensions", std::move(dimensions)},
          {"fingers", std::move(fingers)},
          {"thumb_limits", std::move(limits)},
          {"skin", std::move(skin)}};
}

std::string page_of(const capture::HandFromScan& made,
                    const std::map<hand::ScanPosture, ShownScan>& scans,
                    const std::optional<capture::ScanErrors>& errors,
                    const std::vector<report::Picture>& pictures, const std::string& json,
                    Language language) {
  const hand::Hand& hand = made.scanned.hand;
  report::PageJson segments = report::PageJson::object();
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions& size = hand.dimensions.segment[static_cast<std::size_t>(s)];
    segments[std::string(name_of(static_cast<hand::Segment>(s)))] = {
        {"length_mm", size.length}, {"width_mm", size.width}, {"thickness_mm", size.thickness}};
  }
  report::PageJson shown = report::PageJson::array();
  for (const auto& [posture, scan] : scans) {
    shown.push_back({{"posture", name_of(posture)},
                     {"file", scan.file},
                     {"triangles", scan.surface.mesh.triangle_count()},
                     {"dots", scan.marks.dots.size()},
                     {"lines", scan.marks.lines.size()}});
  }
  report::Attachments attachments;
  const report::PageJson view = {{"maker", report::maker_json()},
                                 {"language", name_of(language)},
                                 {"vocabulary", report::vocabulary_json(hand)},
                                 {"segments", std::move(segments)},
                                 {"scans", std::move(shown)},
                                 {"truth", truth_json(errors)},
                                 {"pictures", report::pictures_json(pictures, attachments)}};
  return report::render_page("hand_from_scan", json, view, std::move(attachments));
}

}  // namespace

void write_hand_scan_report(const std::string& folder, const capture::HandFromScan& made,
                            const std::map<hand::ScanPosture, ShownScan>& scans,
                            const std::optional<capture::ScanErrors>& errors, Language language,
                            const Progress& progress) {
  const std::filesystem::path base(folder);
  formats::create_folder(base);
  const std::string json = person_records::hand_from_scan_json(made);
  formats::write_file(base / "scan.json", json + "\n");
  formats::write_file(base / "dimensions.csv", records::format_csv(person_records::dimension_csv(
                                                   made.scanned.hand.dimensions, made.tape)));
  if (errors)
    formats::write_file(base / "truth_errors.csv",
                        records::format_csv(person_records::truth_error_csv(*errors)));
  formats::write_file(base / "marks.csv",
                      records::format_csv(person_records::mark_table(made.marks)));
  formats::write_file(base / "joints_by_dots.csv",
                      records::format_csv(person_records::dotted_joint_csv(made)));
  for (const auto& [posture, scan] : scans) {
    const std::filesystem::path shown = base / ("scan_" + std::string(name_of(posture)) + ".ply");
    if (scan.surface.colour.empty()) {
      formats::write_mesh(shown, scan.surface.mesh);
    } else {
      formats::write_coloured_mesh(shown, scan.surface);
    }
  }
  const std::vector<report::Picture> pictures = pictures_of(made, scans, progress);
  formats::write_file(base / "report.html", page_of(made, scans, errors, pictures, json, language));
}

}  // namespace palmar::person_report
