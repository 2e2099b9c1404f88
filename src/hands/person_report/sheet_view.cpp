// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_report/sheet_view.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::person_report {
namespace {

constexpr double kCapital = 12.0;  // pixels

/// A small square on the place, and the number beside it on white, on its left or right.
void write_number(report::Image& image, const Eigen::Vector2d& at, const SheetNumber& one,
                  bool is_left) {
  const report::TextStyle style{.cap_height = kCapital, .colour = one.colour, .weight = 0.16};
  const std::string text = std::to_string(one.number);
  constexpr int kMark = 4, kGap = 4;
  const auto x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  report::fill_rectangle(image, x - kMark / 2, y - kMark / 2, kMark, kMark, one.colour);
  const auto width = static_cast<int>(std::ceil(report::text_width(text, style))) + 4;
  const auto height = static_cast<int>(kCapital);
  const int left = is_left ? x - kGap - width : x + kGap;
  report::fill_rectangle(image, left, y - height / 2 - 2, width, height + 4, report::kWhite);
  report::draw_text(image, left + 2, y + height / 2.0, text, style);
}

}  // namespace

HandAxes hand_axes(const geometry::TriangleMesh& skin) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : skin.vertices) mean += v / static_cast<double>(skin.vertices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& v : skin.vertices) spread += (v - mean) * (v - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  HandAxes axes{solver.eigenvectors().col(0), solver.eigenvectors().col(2)};
  // Fingertips have less skin than the cut forearm: the end with less of it is up.
  double low = 1e9, high = -1e9;
  for (const Vec3& v : skin.vertices) {
    low = std::min(low, v.dot(axes.along));
    high = std::max(high, v.dot(axes.along));
  }
  constexpr double kEnd = 15.0;  // mm
  double at_low = 0.0, at_high = 0.0;
  for (const Triangle& t : skin.triangles) {
    const Vec3 &a = skin.vertices[t[0]], &b = skin.vertices[t[1]], &c = skin.vertices[t[2]];
    const double at = axes.along.dot(a);
    if (at < low + kEnd) at_low += geometry::triangle_area(a, b, c);
    if (at > high - kEnd) at_high += geometry::triangle_area(a, b, c);
  }
  if (at_low < at_high) axes.along = -axes.along;
  return axes;
}

report::Image numbered_view(const report::Scene& scene, const Vec3& direction, const Vec3& up,
                            const std::vector<SheetNumber>& numbers, const Progress& progress) {
  const report::Camera camera = report::fit_camera(
      scene, direction, up, {.aspect = static_cast<double>(kSheetViewWidth) / kSheetViewHeight});
  report::RenderOptions options;
  options.width = kSheetViewWidth;
  options.height = kSheetViewHeight;
  report::Image image = report::render_views(scene, {camera}, options, progress).front();
  const Vec3 right = camera.direction.cross(camera.up).normalized();
  const Vec3 upwards = right.cross(camera.direction);
  const double scale = kSheetViewHeight / camera.view_height;  // pixels per mm
  std::vector<Eigen::Vector2d> places;
  for (const SheetNumber& one : numbers) {
    const Vec3 q = one.point - camera.position;
    places.emplace_back(0.5 * kSheetViewWidth + scale * q.dot(right),
                        0.5 * kSheetViewHeight - scale * q.dot(upwards));
  }
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    double nearest = 1e9, aside = 0.0;
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      const double distance = (places[j] - places[k]).norm();
      if (j == k || distance >= nearest) continue;
      nearest = distance;
      aside = places[j].x() - places[k].x();
    }
    write_number(image, places[k], numbers[k], aside > 0.0);
  }
  return image;
}

Vec3 written_place(const Vec3& point) {
  constexpr double kSteps = 100.0;  // per mm
  return ((kSteps * point).array().round() / kSteps + 0.0).matrix();
}

void paste(report::Image& sheet, const report::Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) sheet.at(left + x, top + y) = picture.at(x, y);
  }
}

}  // namespace palmar::person_report
