// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan/hand_scan_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "palmar/formats/file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/bones/bone_shape.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/records/capture/hand_from_scan_json.h"
#include "palmar/records/capture/mark_label_file.h"
#include "palmar/report/page/html_page.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/scan/scan_tables.h"

namespace palmar {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
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
  SceneObject surface{.mesh = scan.surface.mesh, .colour = kSkinColour};
  for (Vec3& v : surface.mesh.vertices) v = hand_from_scan * v;
  for (const Srgb& c : scan.surface.colour) {
    const auto byte = [](float x) {
      return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(x, 0.0F, 1.0F)));
    };
    surface.vertex_colours.push_back({byte(c[0]), byte(c[1]), byte(c[2])});
  }
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
                   "Scan of the posture " + words_of(posture) + ", ",
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

std::string dots_section(const HandFromScan& made) {
  if (made.joints.empty()) return {};
  std::string rows;
  for (const DottedJoint& joint : made.joints) {
    rows += "<tr>" + row_head(plain_words(joint.segment)) + "<td>" +
            html_escaped(words_of(joint.posture)) + "</td>" +
            number_cell(joint.turn * kDegrees, 1) + number_cell(joint.residual) +
            number_cell(joint.axis_change * kDegrees, 1) + number_cell(joint.centre_change, 1) +
            number_cell(joint.dots, 0) + "</tr>";
  }
  return "<h2>Joints by the dots</h2>\n<p>How far the joint before each segment turned between the "
         "reference scan and another, and what the dots changed of the axis that the skin told. "
         "Dots that a hinge leaves more than 1.5 mm off slid with the skin.</p>\n" +
         html_table("Joints",
                    {"Joint before", "Scan", "Turn, deg", "Dots off, mm", "Axis moved, deg",
                     "Centre moved, mm", "Dots"},
                    rows, 2);
}

std::string crease_section(const HandFromScan& made) {
  if (made.creases.shift.empty()) return {};
  std::string rows;
  for (const auto& [segment, shift] : made.creases.shift) {
    rows += "<tr>" +
            row_head(segment == Segment::kPalm ? "wrist" : "before " + plain_words(segment)) +
            number_cell(shift, 1) + "</tr>";
  }
  return "<h2>Creases</h2>\n" +
         html_table("Drawn creases against where the skin's shape suggests them",
                    {"Crease", "Distal of it, mm"}, rows);
}

/// Xie 2014: 4.5 and tables 4-1, 4-2 of this hand.
std::string truth_section(const ScanErrors& errors) {
  const auto row = [](const std::string& head, std::initializer_list<std::optional<double>> values,
                      int decimals) {
    std::string cells;
    for (const auto& value : values) cells += number_cell(value, decimals);
    return "<tr>" + row_head(head) + cells + "</tr>";
  };
  const auto mm = [](const std::optional<MeanPlaceError>& e) {
    return e ? std::optional(e->place) : std::nullopt;
  };
  const auto degrees = [](const std::optional<MeanPlaceError>& e) {
    return e && e->axis ? std::optional(*e->axis * kDegrees) : std::nullopt;
  };
  std::string rows;
  for (const auto& [posture, words] :
       {std::pair{ScanPosture::kReference, "Natural extended posture"},
        std::pair{ScanPosture::kFingerFlexion, "Limit bended posture, full flexion"},
        std::pair{ScanPosture::kFingerAbduction, "Limit bended posture, full abduction"}}) {
    const auto pip = mean_error(errors, posture, FingerPlace::kPip);
    const auto dip = mean_error(errors, posture, FingerPlace::kDip);
    const auto tip = mean_error(errors, posture, FingerPlace::kTip);
    if (!pip) continue;
    rows += row(words, {mm(pip), degrees(pip), mm(dip), degrees(dip), mm(tip)}, 1);
  }
  std::string limits;
  for (const PlaceError& e : errors.places) {
    if (!is_thumb_limit(e.posture) || e.segment != Segment::kThumbProximal) continue;
    limits += row(words_of(e.posture), {e.place, *e.axis * kDegrees}, 1);
  }
  return "<h2>Against the truth</h2>\n" +
         html_table("Dimensions of the 15 segments: differences (Xie 2014: 1.2, 1.1, 1.0 mm)",
                    {"", "Mean, mm", "Largest, mm"},
                    row("x (breadth)", {errors.x.mean, errors.x.largest}, 2) +
                        row("y (length)", {errors.y.mean, errors.y.largest}, 2) +
                        row("z (thickness)", {errors.z.mean, errors.z.largest}, 2)) +
         html_table("Fingers II to V in the mean (Xie 2014, tables 4-1 and 4-2)",
                    {"", "PIP, mm", "PIP axis, deg", "DIP, mm", "DIP axis, deg", "Fingertip, mm"},
                    rows) +
         (limits.empty() ? std::string()
                         : html_table("MP joint of the thumb where its metacarpal carries it",
                                      {"", "Place, mm", "Axis, deg"}, limits)) +
         (errors.skin_p95 > 0.0
              ? fmt::format("<p>Skin: {:.2f} mm from the true one in the mean, 95 % within {:.2f} "
                            "mm.</p>\n",
                            errors.skin_mean, errors.skin_p95)
              : std::string());
}

std::string found_section(const HandFromScan& made, const std::map<ScanPosture, ShownScan>& scans) {
  std::string rows;
  for (const auto& [posture, scan] : scans) {
    const auto fit = made.fits.find(posture);
    const bool is_reference = posture == ScanPosture::kReference;
    std::optional<double> mean, share;
    if (is_reference) mean = made.scanned.registration_mean;
    if (fit != made.fits.end()) {
      mean = fit->second.mean;
      share = 100.0 * fit->second.partner_share;
    }
    rows += "<tr>" + row_head(words_of(posture)) + "<td>" + html_escaped(scan.file) + "</td>" +
            number_cell(scan.surface.mesh.triangle_count(), 0) +
            number_cell(static_cast<double>(scan.marks.dots.size()), 0) +
            number_cell(static_cast<double>(scan.marks.lines.size()), 0) + number_cell(mean) +
            number_cell(share, 0) + "</tr>";
  }
  return "<h2>Scans</h2>\n" + html_table("What was found in each scan",
                                         {"Posture", "File", "Triangles", "Dots", "Pieces of lines",
                                          "Skin to scan, mm", "Skin seen, %"},
                                         rows, 2);
}

}  // namespace

void write_hand_scan_report(const std::string& folder, const HandFromScan& made,
                            const std::map<ScanPosture, ShownScan>& scans,
                            const std::optional<ScanErrors>& errors, const Progress& progress) {
  const std::filesystem::path base(folder);
  create_folder(base);
  write_file(base / "scan.json", hand_from_scan_json(made) + "\n");
  write_file(base / "dimensions.csv",
             format_csv(dimension_csv(made.scanned.hand.dimensions, made.tape)));
  if (errors) write_file(base / "truth_errors.csv", format_csv(truth_error_csv(*errors)));
  write_file(base / "marks.csv", format_csv(mark_table(made.marks)));
  write_file(base / "joints_by_dots.csv", format_csv(dotted_joint_csv(made)));
  const std::vector<Picture> pictures = pictures_of(made, scans, progress);
  const Hand& hand = made.scanned.hand;
  const HandDimensions& d = hand.dimensions;
  const std::string summary = fmt::format(
      "<p>{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm, thickness {:.1f} "
      "mm; "
      "skin {:.2f} mm from the scan in the mean, 95 % within {:.2f} mm.</p>",
      hand.side == Side::kLeft ? "Left" : "Right", d.hand_length, d.hand_circumference,
      d.hand_width, d.hand_thickness, made.scanned.registration_mean,
      made.scanned.registration_p95);
  write_file(base / "report.html",
             html_page("Hand from a scan: " + hand.name, summary,
                       pictures_html(pictures, {"hand_", "distance_"}) +
                           (errors ? truth_section(*errors) : std::string()) +
                           notes_section("What to know about this hand", made.notes) +
                           found_section(made, scans) + dimensions_section(hand, made.tape) +
                           crease_section(made) + dots_section(made) +
                           titled("Every scan", pictures_html(pictures, {"scan_"}))));
}

}  // namespace palmar
