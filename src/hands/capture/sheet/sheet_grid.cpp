// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/sheet_grid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/photo/photo_view.h"
#include "hands/capture/picture_vectors.h"
#include "palmar/core/parallel.h"

namespace palmar::capture {
namespace {

constexpr double kBlurredBorder = 1.5;  // mm
constexpr double kBeside = 270.0;       // mm: as far as a hand beside a card reaches to either side
constexpr double kAbove = 270.0;        // and from the line under its wrist

RectifiedSheet drawn(const geometry::RgbImage& image, const SheetView& sheet,
                     const SheetGrid& grid) {
  RectifiedSheet result{grid, {}, {}};
  result.light.resize(grid.count());
  result.is_seen.resize(grid.count());
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 256; ++i) table[i] = linear_light(static_cast<double>(i));
  parallel_for(grid.height, [&](int y) {
    for (int x = 0; x < grid.width; ++x) {
      Vec3f sum = Vec3f::Zero();
      constexpr int kSide = 3;
      for (int v = 0; v < kSide; ++v) {
        for (int u = 0; u < kSide; ++u) {
          const Vec2 pixel =
              sheet.pixel_of(grid.sheet(x + (u + 0.5) / kSide - 0.5, y + (v + 0.5) / kSide - 0.5));
          const Vec3f colour = pixel_colour(image, pixel);
          for (int c = 0; c < 3; ++c) {
            sum[c] += table[static_cast<std::size_t>(std::clamp(colour[c] + 0.5F, 0.0F, 255.0F))];
          }
        }
      }
      const Vec2 middle = sheet.pixel_of(grid.sheet(x, y));
      result.is_seen[grid.at(x, y)] = middle.x() >= 0.0 && middle.y() >= 0.0 &&
                                              middle.x() <= image.width - 1.0 &&
                                              middle.y() <= image.height - 1.0
                                          ? 1
                                          : 0;
      result.light[grid.at(x, y)] = sum / (kSide * kSide);
    }
  });
  return result;
}

/// The value below which a share of values lies.
float quantile(std::vector<float> values, double share) {
  if (values.empty()) return 1.0F;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[place];
}

}  // namespace

double SheetGrid::to_edge(const Eigen::Vector2d& p) const {
  const Vec2 middle = corner + 0.5 * cell * Vec2(width - 1, 1 - height);
  const Vec2 inside = 0.5 * cell * Vec2(width, height) - (p - middle).cwiseAbs();
  return inside.minCoeff();
}

imaging::VolumeGrid SheetGrid::volume() const {
  return {{width, height, 1}, Vec3(cell, cell, cell), Eigen::Matrix3d::Identity(), Vec3::Zero()};
}

SheetGrid grid_of_sheet(const SheetView& sheet, double cell) {
  SheetGrid grid;
  grid.cell = cell;
  grid.border = kBlurredBorder;
  grid.width = static_cast<int>((sheet.format.width - 2.0 * kBlurredBorder) / cell);
  grid.height = static_cast<int>((sheet.format.height - 2.0 * kBlurredBorder) / cell);
  grid.corner = 0.5 * cell * Vec2(-(grid.width - 1), grid.height - 1);
  return grid;
}

SheetGrid grid_beside_card(const SheetView& card, double cell) {
  SheetGrid grid;
  grid.cell = cell;
  grid.width = static_cast<int>(2.0 * kBeside / cell);
  grid.height = static_cast<int>(kAbove / cell);
  grid.corner = {-0.5 * cell * (grid.width - 1),
                 -0.5 * card.format.height + cell * (grid.height - 0.5)};
  return grid;
}

float linear_light(double srgb) {
  const double c = srgb / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

std::vector<Vec3f> level_light(RectifiedSheet& drawn, Ground ground) {
  using Six = Eigen::Matrix<double, 6, 1>;
  const SheetGrid& grid = drawn.grid;
  const auto terms = [&](int x, int y) {
    const double u = 2.0 * x / grid.width - 1.0, v = 2.0 * y / grid.height - 1.0;
    Six t;
    t << 1.0, u, v, u * u, u * v, v * v;
    return t;
  };
  Eigen::Matrix<double, 6, 3> base = Eigen::Matrix<double, 6, 3>::Zero();
  if (ground == Ground::kPaper) {
    std::vector<float> brightness;
    for (std::size_t p = 0; p < drawn.light.size(); p += 7) {
      brightness.push_back(drawn.light[p].sum());
    }
    base.row(0).setConstant(quantile(std::move(brightness), 0.85) / 3.0);
  } else {
    for (int c = 0; c < 3; ++c) {
      std::vector<float> channel;
      for (std::size_t p = 0; p < drawn.light.size(); p += 7) {
        if (drawn.is_seen[p] != 0) channel.push_back(drawn.light[p][c]);
      }
      base(0, c) = quantile(std::move(channel), 0.5);
    }
  }
  constexpr double kNear = 0.82;  // of the ground's light; shadows are darker
  for (int round = 0; round < 4; ++round) {
    Eigen::MatrixXd normal = 1e-6 * Eigen::MatrixXd::Identity(6, 6);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(6, 3);
    const double near = round == 0 ? 0.6 : kNear, most = round == 0 ? 1.6 : 1.25;
    for (int y = 0; y < grid.height; y += 4) {
      for (int x = 0; x < grid.width; x += 4) {
        if (drawn.is_seen[grid.at(x, y)] == 0) continue;
        const Six t = terms(x, y);
        const Eigen::Vector3d light = drawn.light[grid.at(x, y)].cast<double>();
        const Eigen::Vector3d ratio = light.cwiseQuotient((base.transpose() * t).cwiseMax(1e-4));
        if (ratio.minCoeff() < near || ratio.maxCoeff() > most) continue;
        normal += t * t.transpose();
        right += t * light.transpose();
      }
    }
    base = Eigen::LDLT<Eigen::MatrixXd>(normal).solve(right);
  }
  std::vector<Vec3f> ground_light(grid.count());
  parallel_for(grid.height, [&](int y) {
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t p = grid.at(x, y);
      ground_light[p] = (base.transpose() * terms(x, y)).cwiseMax(1e-3).cast<float>();
      drawn.light[p] = drawn.is_seen[p] == 0 ? Vec3f(Vec3f::Ones())
                                             : drawn.light[p].cwiseQuotient(ground_light[p]);
    }
  });
  return ground_light;
}

RectifiedSheet draw_sheet(const geometry::RgbImage& image, const SheetView& sheet,
                          const SheetGrid& grid, Ground ground) {
  RectifiedSheet result = drawn(image, sheet, grid);
  level_light(result, ground);
  return result;
}

}  // namespace palmar::capture
