// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_report/found_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hands/person_report/scan_report.h"
#include "hands/person_report/sheet_view.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/records/person/person_file.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::person_report {
namespace {

constexpr report::Rgb kDotInk{190, 20, 20}, kLineInk{10, 70, 170};

/// Middle of a line: the point of its ink that is nearest to the mean.
Vec3 middle_of(const capture::InkLine& line) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : line.point) mean += p / static_cast<double>(line.point.size());
  return *std::min_element(line.point.begin(), line.point.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

/// Those of the marks that are seen from there.
std::vector<SheetNumber> seen_marks(const std::vector<NumberedMark>& marks,
                                    hand::ScanPosture posture, const Vec3& direction,
                                    const geometry::RayQuery& query) {
  std::vector<SheetNumber> seen;
  for (const NumberedMark& mark : marks) {
    if (mark.posture != posture) continue;
    constexpr double kLift = 1.0;  // mm; the skin's own ripples hide nothing
    if (query.first_hit(mark.point - kLift * direction, -direction)) continue;
    seen.push_back(
        {mark.number, mark.point, mark.kind == hand::MarkLabel::Kind::kDot ? kDotInk : kLineInk});
  }
  return seen;
}

}  // namespace

report::SceneObject coloured_surface(const ShownScan& scan) {
  report::SceneObject surface{.mesh = scan.surface.mesh, .colour = report::kSkinColour};
  for (const geometry::Srgb& c : scan.surface.colour) {
    const auto byte = [](float x) {
      return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(x, 0.0F, 1.0F)));
    };
    surface.vertex_colours.push_back({byte(c[0]), byte(c[1]), byte(c[2])});
  }
  return surface;
}

std::vector<NumberedMark> numbered_marks(const std::map<hand::ScanPosture, ShownScan>& scans) {
  constexpr double kLeast = 2.0;  // mm^2
  std::vector<NumberedMark> marks;
  const auto next = [&marks] { return static_cast<int>(marks.size()) + 1; };
  for (const auto& [posture, scan] : scans) {
    for (const capture::InkDot& dot : scan.marks.dots) {
      marks.push_back({next(), posture, hand::MarkLabel::Kind::kDot, dot.point, dot.segment});
    }
    for (const capture::InkLine& line : scan.marks.lines) {
      if (line.area < kLeast || line.point.empty()) continue;
      marks.push_back(
          {next(), posture, hand::MarkLabel::Kind::kCrease, middle_of(line), line.crease});
    }
  }
  return marks;
}

report::Image found_sheet(const std::map<hand::ScanPosture, ShownScan>& scans,
                          const std::vector<NumberedMark>& marks, const Progress& progress) {
  const auto rows = static_cast<int>(scans.size());
  report::Image sheet(2 * kSheetViewWidth, std::max(1, rows) * (kSheetViewHeight + kSheetHead));
  int row = 0;
  for (const auto& [posture, scan] : scans) {
    progress.update(static_cast<double>(row) / rows, "drawing what was found");
    const HandAxes axes = hand_axes(scan.surface.mesh);
    const geometry::RayQuery query(scan.surface.mesh);
    const int top = row * (kSheetViewHeight + kSheetHead);
    int dots = 0, lines = 0;
    for (const NumberedMark& mark : marks) {
      if (mark.posture != posture) continue;
      ++(mark.kind == hand::MarkLabel::Kind::kDot ? dots : lines);
    }
    report::draw_text(
        sheet, 16, top + 30,
        fmt::format("{}: {} dots, {} pieces of lines", plain_words(posture), dots, lines),
        {.cap_height = 16.0});
    for (int view = 0; view < 2; ++view) {
      const Vec3 direction = view == 0 ? Vec3(-axes.across) : axes.across;
      paste(sheet,
            numbered_view({coloured_surface(scan)}, direction, axes.along,
                          seen_marks(marks, posture, direction, query)),
            view * kSheetViewWidth, top + kSheetHead);
    }
    ++row;
  }
  return sheet;
}

std::string found_toml(const std::vector<NumberedMark>& marks) {
  std::string text =
      "# What was found on the scans, by the numbers on found.png. Keep the marks that are wrong,\n"
      "# write their names (a segment; of a crease the one distal of it, or wrist; of a dot on "
      "the\n"
      "# back of the hand palm; none: no mark), and give the file with --known.\n";
  for (const NumberedMark& mark : marks) {
    text += "\n" + records::format_person_mark(
                       {.posture = std::string(name_of(mark.posture)),
                        .mark = mark.kind == hand::MarkLabel::Kind::kDot ? "dot" : "crease",
                        .name = records::mark_name(mark.kind, mark.segment),
                        .point = written_place(mark.point),
                        .place = {}},
                       std::to_string(mark.number));
  }
  return text;
}

}  // namespace palmar::person_report
