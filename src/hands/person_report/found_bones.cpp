// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_report/found_bones.h"

#include <algorithm>
#include <vector>

#include "hands/person_report/sheet_view.h"
#include "palmar/core/progress_part.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/records/person/person_file.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::person_report {
namespace {

constexpr report::Rgb kNameInk{10, 70, 170}, kNoNameInk{190, 20, 20};
constexpr report::Rgb kNoNameColour{204, 121, 167};
constexpr int kListWidth = 420, kListRow = 34;  // pixels

Vec3 mean_of(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The point that is nearest to the mean of all.
Vec3 middle_of(const std::vector<Vec3>& points) {
  const Vec3 mean = mean_of(points);
  return *std::min_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

/// A point in a bone; on it, if it is so bent that its middle lies outside.
Vec3 point_in(const geometry::TriangleMesh& bone) {
  const Vec3 mean = mean_of(bone.vertices);
  return geometry::exact_winding_number(bone, mean) > 0.5 ? mean : middle_of(bone.vertices);
}

report::Rgb ink_of(const capture::ScannedBone& bone) {
  return bone.name.empty() ? kNoNameInk : kNameInk;
}

/// A number in the middle of what is seen of each bone from there.
std::vector<SheetNumber> seen_bones(const std::vector<capture::ScannedBone>& bones,
                                    const geometry::RayQuery& all, const Vec3& direction) {
  std::vector<SheetNumber> numbers;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    std::vector<Vec3> seen;
    for (const Vec3& v : bones[b].mesh.vertices) {
      constexpr double kLift = 0.3;  // mm; the bone's own surface hides nothing
      if (!all.first_hit(v - kLift * direction, -direction)) seen.push_back(v);
    }
    if (seen.empty()) continue;
    numbers.push_back({static_cast<int>(b) + 1, middle_of(seen), ink_of(bones[b])});
  }
  return numbers;
}

void draw_list(report::Image& sheet, int left, const std::vector<capture::ScannedBone>& bones) {
  double y = 2.0 * kSheetHead;
  for (std::size_t b = 0; b < bones.size(); ++b, y += kListRow) {
    const report::TextStyle style{.cap_height = 14.0, .colour = ink_of(bones[b])};
    const std::string name = bones[b].name.empty() ? "no name" : bones[b].name;
    report::TextStyle number = style;
    number.align = report::Align::kRight;
    report::draw_text(sheet, left + 40, y, std::to_string(b + 1), number);
    report::draw_text(sheet, left + 54, y, name, style);
  }
}

}  // namespace

report::Image found_bones_sheet(const capture::ScanSurfaces& surfaces, const Progress& progress) {
  const std::vector<capture::ScannedBone>& bones = surfaces.bones;
  report::Scene scene = {{.mesh = surfaces.skin, .colour = report::kSkinColour, .opacity = 0.2}};
  geometry::TriangleMesh all;
  for (const capture::ScannedBone& bone : bones) {
    scene.push_back(
        {.mesh = bone.mesh, .colour = bone.name.empty() ? kNoNameColour : report::kBoneColour});
    const int first = all.vertex_count();
    all.vertices.insert(all.vertices.end(), bone.mesh.vertices.begin(), bone.mesh.vertices.end());
    for (const Triangle& t : bone.mesh.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  const int list_rows = (static_cast<int>(bones.size()) + 2) * kListRow;
  report::Image sheet(2 * kSheetViewWidth + kListWidth,
                      std::max(kSheetViewHeight, list_rows) + kSheetHead);
  const auto named =
      std::count_if(bones.begin(), bones.end(),
                    [](const capture::ScannedBone& bone) { return !bone.name.empty(); });
  report::draw_text(sheet, 16, 30,
                    "reference: " + std::to_string(named) + " bones with a name, " +
                        std::to_string(static_cast<long>(bones.size()) - named) + " without",
                    {.cap_height = 16.0});
  const HandAxes axes = hand_axes(surfaces.skin);
  for (int view = 0; view < 2; ++view) {
    const Vec3 direction = view == 0 ? Vec3(-axes.across) : axes.across;
    const auto numbers = all.triangles.empty()
                             ? std::vector<SheetNumber>()
                             : seen_bones(bones, geometry::RayQuery(all), direction);
    paste(sheet,
          numbered_view(scene, direction, axes.along, numbers,
                        part_of(progress, 0.5 * view, 0.5 * view + 0.5, "drawing what was found")),
          view * kSheetViewWidth, kSheetHead);
  }
  draw_list(sheet, 2 * kSheetViewWidth, bones);
  return sheet;
}

std::string found_bones_toml(const capture::ScanSurfaces& surfaces) {
  std::string text =
      "# Bones that were found in the reference image, by the numbers on found.png. Keep those "
      "whose "
      "names\n# are wrong or missing, write their names, and give the file with --known. Points "
      "are "
      "in the\n# patient's frame.\n";
  int number = 0;
  for (const capture::ScannedBone& bone : surfaces.bones) {
    text += "\n" + records::format_person_bone({bone.name, written_place(point_in(bone.mesh)), {}},
                                               std::to_string(++number));
  }
  return text;
}

}  // namespace palmar::person_report
