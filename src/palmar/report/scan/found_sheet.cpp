// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan/found_sheet.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/stroke_text.h"
#include "palmar/report/scan/scan_report.h"

namespace palmar {
namespace {

constexpr int kViewWidth = 1000, kViewHeight = 1300, kHead = 44;  // pixels
constexpr Rgb kDotInk{190, 20, 20}, kLineInk{10, 70, 170};
constexpr double kCapital = 12.0;  // pixels

/// From the eye into the scene, and what is up: across the broad side, along the long one.
struct Axes {
  Vec3 across, along;
};

Axes axes_of(const TriangleMesh& mesh) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) mean += v / static_cast<double>(mesh.vertices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& v : mesh.vertices) spread += (v - mean) * (v - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  Axes axes{solver.eigenvectors().col(0), solver.eigenvectors().col(2)};
  // Fingertips have less skin than the cut forearm: the end with less of it is up.
  double low = 1e9, high = -1e9;
  for (const Vec3& v : mesh.vertices) {
    low = std::min(low, v.dot(axes.along));
    high = std::max(high, v.dot(axes.along));
  }
  constexpr double kEnd = 15.0;  // mm
  double at_low = 0.0, at_high = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double at = axes.along.dot(a);
    if (at < low + kEnd) at_low += triangle_area(a, b, c);
    if (at > high - kEnd) at_high += triangle_area(a, b, c);
  }
  if (at_low < at_high) axes.along = -axes.along;
  return axes;
}

/// Middle of a line: the point of its ink that is nearest to the mean.
Vec3 middle_of(const InkLine& line) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : line.point) mean += p / static_cast<double>(line.point.size());
  return *std::min_element(line.point.begin(), line.point.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

/// A small square on the place, and the number beside it on white, on its left or right.
void write_number(Image& image, const Eigen::Vector2d& at, int number, Rgb colour, bool is_left) {
  const TextStyle style{.cap_height = kCapital, .colour = colour, .weight = 0.16};
  const std::string text = std::to_string(number);
  constexpr int kMark = 4, kGap = 4;
  const auto x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  fill_rectangle(image, x - kMark / 2, y - kMark / 2, kMark, kMark, colour);
  const auto width = static_cast<int>(std::ceil(text_width(text, style))) + 4;
  const auto height = static_cast<int>(kCapital);
  const int left = is_left ? x - kGap - width : x + kGap;
  fill_rectangle(image, left, y - height / 2 - 2, width, height + 4, kWhite);
  draw_text(image, left + 2, y + height / 2.0, text, style);
}

Image view_of(const ShownScan& scan, ScanPosture posture, const Axes& axes, double side,
              const std::vector<NumberedMark>& marks, const RayQuery& query) {
  const Scene scene{coloured_surface(scan)};
  const Camera camera = fit_camera(scene, side * axes.across, axes.along,
                                   {.aspect = double{kViewWidth} / kViewHeight});
  RenderOptions options;
  options.width = kViewWidth;
  options.height = kViewHeight;
  Image image = render_scene(scene, camera, options);
  const Vec3 right = camera.direction.cross(camera.up).normalized();
  const Vec3 up = right.cross(camera.direction);
  const double scale = kViewHeight / camera.view_height;  // pixels per mm
  std::vector<std::pair<const NumberedMark*, Eigen::Vector2d>> seen;
  for (const NumberedMark& mark : marks) {
    if (mark.posture != posture) continue;
    constexpr double kLift = 1.0;  // mm; the skin's own ripples hide nothing
    if (query.first_hit(mark.point - kLift * camera.direction, -camera.direction)) continue;
    const Vec3 q = mark.point - camera.position;
    seen.emplace_back(&mark, Eigen::Vector2d(0.5 * kViewWidth + scale * q.dot(right),
                                             0.5 * kViewHeight - scale * q.dot(up)));
  }
  for (const auto& [mark, at] : seen) {
    // Away from the nearest other one.
    double nearest = 1e9, aside = 0.0;
    for (const auto& [other, there] : seen) {
      const double distance = (there - at).norm();
      if (other == mark || distance >= nearest) continue;
      nearest = distance;
      aside = there.x() - at.x();
    }
    write_number(image, at, mark->number, mark->kind == MarkLabel::Kind::kDot ? kDotInk : kLineInk,
                 aside > 0.0);
  }
  return image;
}

void put(Image& sheet, const Image& image, int left, int top) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sheet.at(left + x, top + y) = image.at(x, y);
  }
}

std::string name_in_file(const NumberedMark& mark) {
  if (!mark.segment) return {};
  const bool is_wrist = mark.kind == MarkLabel::Kind::kCrease && *mark.segment == Segment::kPalm;
  return is_wrist ? "wrist" : std::string(name_of(*mark.segment));
}

}  // namespace

SceneObject coloured_surface(const ShownScan& scan) {
  SceneObject surface{.mesh = scan.surface.mesh, .colour = kSkinColour};
  for (const Srgb& c : scan.surface.colour) {
    const auto byte = [](float x) {
      return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(x, 0.0F, 1.0F)));
    };
    surface.vertex_colours.push_back({byte(c[0]), byte(c[1]), byte(c[2])});
  }
  return surface;
}

std::vector<NumberedMark> numbered_marks(const std::map<ScanPosture, ShownScan>& scans) {
  constexpr double kLeast = 2.0;  // mm^2
  std::vector<NumberedMark> marks;
  const auto next = [&marks] { return static_cast<int>(marks.size()) + 1; };
  for (const auto& [posture, scan] : scans) {
    for (const InkDot& dot : scan.marks.dots) {
      marks.push_back({next(), posture, MarkLabel::Kind::kDot, dot.point, dot.segment});
    }
    for (const InkLine& line : scan.marks.lines) {
      if (line.area < kLeast || line.point.empty()) continue;
      marks.push_back({next(), posture, MarkLabel::Kind::kCrease, middle_of(line), line.crease});
    }
  }
  return marks;
}

Image found_sheet(const std::map<ScanPosture, ShownScan>& scans,
                  const std::vector<NumberedMark>& marks, const Progress& progress) {
  const auto rows = static_cast<int>(scans.size());
  Image sheet(2 * kViewWidth, std::max(1, rows) * (kViewHeight + kHead));
  int row = 0;
  for (const auto& [posture, scan] : scans) {
    progress.update(static_cast<double>(row) / rows, "drawing what was found");
    const Axes axes = axes_of(scan.surface.mesh);
    const RayQuery query(scan.surface.mesh);
    const int top = row * (kViewHeight + kHead);
    int dots = 0, lines = 0;
    for (const NumberedMark& mark : marks) {
      if (mark.posture != posture) continue;
      ++(mark.kind == MarkLabel::Kind::kDot ? dots : lines);
    }
    draw_text(sheet, 16, top + 30,
              fmt::format("{}: {} dots, {} pieces of lines", plain_words(posture), dots, lines),
              {.cap_height = 16.0});
    for (int view = 0; view < 2; ++view) {
      put(sheet, view_of(scan, posture, axes, view == 0 ? -1.0 : 1.0, marks, query),
          view * kViewWidth, top + kHead);
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
    text += fmt::format(
        "\n[[mark]]  # {}\nposture = \"{}\"\nmark = \"{}\"\nname = \"{}\"\n"
        "at_mm = [{:.2f}, {:.2f}, {:.2f}]\n",
        mark.number, name_of(mark.posture), mark.kind == MarkLabel::Kind::kDot ? "dot" : "crease",
        name_in_file(mark), mark.point.x(), mark.point.y(), mark.point.z());
  }
  return text;
}

}  // namespace palmar
