// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/parts_picture.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {
namespace {

// Okabe, Ito 2008, "Color universal design", lightened where shading needs it.
constexpr std::array<Rgb, 8> kPartColours = {{{86, 180, 233},
                                              {230, 159, 0},
                                              {0, 158, 115},
                                              {204, 121, 167},
                                              {240, 228, 66},
                                              {213, 94, 0},
                                              {60, 120, 190},
                                              {160, 160, 160}}};
constexpr double kTilt = 0.45;  // rad; a product is seen a little from above
constexpr Rgb kInk{34, 40, 46};

struct PartsView {
  Camera camera;
  int left = 0, top = 0, width = 0, height = 0;

  Eigen::Vector2d project(const Vec3& p) const {
    const Vec3 right = camera.direction.cross(camera.up).normalized();
    const Vec3 up = right.cross(camera.direction);
    const double scale = height / camera.view_height;
    const Vec3 q = p - camera.position;
    return {left + 0.5 * width + scale * right.dot(q), top + 0.5 * height - scale * up.dot(q)};
  }
};

// Directions of the most and the least extent of a cloud of points.
Eigen::Matrix3d axes_of(const geometry::TriangleMesh& mesh) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : mesh.vertices) mean += p;
  mean /= static_cast<double>(mesh.vertices.size());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Vec3& p : mesh.vertices) sum += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  Eigen::Matrix3d axes;
  for (int k = 0; k < 3; ++k) {
    axes.col(k) = solver.eigenvectors().col(2 - k);
    int largest = 0;
    axes.col(k).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, k) < 0.0) axes.col(k) = -axes.col(k);
  }
  return axes;
}

void draw_disc(Image& image, const Eigen::Vector2d& centre, double radius, Rgb colour) {
  for (int y = static_cast<int>(centre.y() - radius); y <= centre.y() + radius; ++y) {
    for (int x = static_cast<int>(centre.x() - radius); x <= centre.x() + radius; ++x) {
      if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
      if ((Eigen::Vector2d(x + 0.5, y + 0.5) - centre).norm() <= radius) image.at(x, y) = colour;
    }
  }
}

void draw_line(Image& image, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width,
               Rgb colour) {
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm())));
  for (int i = 0; i <= steps; ++i) {
    draw_disc(image, a + (b - a) * (static_cast<double>(i) / steps), 0.5 * width, colour);
  }
}

Scene scene_of(const geometry::TriangleMesh& mesh, const product::ProductParts& parts) {
  Scene scene(std::max<std::size_t>(1, parts.parts.size()));
  std::vector<std::vector<int>> index(scene.size(), std::vector<int>(mesh.vertices.size(), -1));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t part = parts.parts.empty() ? 0 : parts.part_of_triangle[t];
    geometry::TriangleMesh& piece = scene[part].mesh;
    Triangle corner = mesh.triangles[t];
    for (int& i : corner) {
      int& at = index[part][i];
      if (at < 0) {
        at = piece.vertex_count();
        piece.vertices.push_back(mesh.vertices[i]);
      }
      i = at;
    }
    piece.triangles.push_back(corner);
  }
  for (std::size_t k = 0; k < scene.size(); ++k) {
    scene[k].colour = part_colour(static_cast<int>(k) + 1);
  }
  std::erase_if(scene, [](const SceneObject& o) { return o.mesh.triangles.empty(); });
  return scene;
}

std::string line_of(const product::ProductPart& part) {
  std::string text =
      fmt::format("{} {}: {:.0f} mm long, girth {:.0f} mm, {:.0f} x {:.0f} mm", part.number,
                  part.name, part.length, part.girth, part.width, part.thickness);
  if (part.opening) {
    text += fmt::format(", opening {:.0f} x {:.0f} mm", part.opening->width, part.opening->height);
  }
  return text;
}

}  // namespace

Rgb part_colour(int number) {
  return kPartColours[static_cast<std::size_t>(std::max(1, number) - 1) % kPartColours.size()];
}

Image parts_picture(const product::Product& product, const product::ProductParts& parts,
                    const PartsPictureOptions& options, const Progress& progress) {
  if (options.width < 200 || options.width > 8000 || options.height < 100 ||
      options.height > 4000) {
    throw UsageError(fmt::format("picture of {} x {} pixels; 200 x 100 to 8000 x 4000 are allowed",
                                 options.width, options.height));
  }
  const double s = options.height / 800.0;
  const double row = 26.0 * s;
  const int rows = static_cast<int>(std::max<std::size_t>(1, (parts.parts.size() + 1) / 2));
  const int top = static_cast<int>(56 * s);
  const int bottom = std::min(options.height / 2, static_cast<int>(24 * s + rows * row));
  const int width = options.width / 2, height = options.height - top - bottom;
  const Scene scene = scene_of(product.mesh, parts);
  const Eigen::Matrix3d axes = axes_of(product.mesh);
  std::vector<PartsView> views(2);
  std::vector<Camera> cameras;
  for (int k = 0; k < 2; ++k) {
    // From the broad side and from the narrow side, the longest axis across the picture.
    const Vec3 face = axes.col(2 - k), other = axes.col(1 + k);
    const Vec3 eye = std::cos(kTilt) * face + std::sin(kTilt) * other;
    const Vec3 up = std::cos(kTilt) * other - std::sin(kTilt) * face;
    views[k].left = k * width;
    views[k].top = top;
    views[k].width = width;
    views[k].height = height;
    views[k].camera = fit_camera(scene, -eye, up, {.aspect = static_cast<double>(width) / height});
    cameras.push_back(views[k].camera);
  }
  const std::vector<Image> rendered =
      render_views(scene, cameras, {.width = width, .height = height}, progress);
  Image picture(options.width, options.height);
  for (int k = 0; k < 2; ++k) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) picture.at(k * width + x, top + y) = rendered[k].at(x, y);
    }
    for (const product::ProductPart& part : parts.parts) {
      for (std::size_t i = 0; i + 1 < part.line.size(); ++i) {
        draw_line(picture, views[k].project(part.line[i].centre),
                  views[k].project(part.line[i + 1].centre), 2.0 * s, kInk);
      }
    }
    for (const product::ProductPart& part : parts.parts) {
      if (part.line.empty()) continue;
      // A ring's number stands on its line, beside the opening.
      const Eigen::Vector2d at = views[k].project(part.line[part.line.size() / 2].centre);
      draw_disc(picture, at, 15.0 * s, kInk);
      draw_disc(picture, at, 13.0 * s, kWhite);
      draw_text(picture, at.x(), at.y() + 6.5 * s, std::to_string(part.number),
                {.cap_height = 13 * s, .colour = kInk, .align = Align::kCentre, .weight = 0.16});
    }
  }
  draw_text(picture, 24 * s, 36 * s, "parts of " + product.name, {.cap_height = 15 * s});
  for (std::size_t i = 0; i < parts.parts.size(); ++i) {
    const double x = 24 * s + static_cast<double>(i % 2) * 0.5 * options.width;
    const double y = top + height + (static_cast<double>(i) / 2 - 0.5 * (i % 2)) * row + 22 * s;
    if (y > options.height) break;
    fill_rectangle(picture, static_cast<int>(x), static_cast<int>(y - 12 * s),
                   static_cast<int>(14 * s), static_cast<int>(14 * s),
                   part_colour(parts.parts[i].number));
    draw_text(picture, x + 22 * s, y, line_of(parts.parts[i]), {.cap_height = 11 * s});
  }
  return picture;
}

std::string picture_svg(const Image& image) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
      "<image width=\"{0}\" height=\"{1}\" xlink:href=\"data:image/png;base64,{2}\"/>\n</svg>\n",
      image.width, image.height, formats::base64(encode_png(image, PngEffort::kSmall)));
}

}  // namespace palmar::report
