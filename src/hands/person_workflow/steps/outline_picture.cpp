// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/outline_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/photo/photo_view.h"
#include "palmar/formats/mesh/texture_file.h"

namespace palmar::person_workflow {
namespace {

using OutlineInk = std::array<std::uint8_t, 3>;

void dab(geometry::RgbImage& image, const Eigen::Vector2d& at, int radius, const OutlineInk& ink) {
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const int u = static_cast<int>(std::lround(at.x())) + x,
                v = static_cast<int>(std::lround(at.y())) + y;
      if (u < 0 || v < 0 || u >= image.width || v >= image.height) continue;
      std::copy(
          ink.begin(), ink.end(),
          image.rgb.begin() + static_cast<std::ptrdiff_t>(capture::pixel_offset(image, u, v)));
    }
  }
}

void stroke(geometry::RgbImage& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
            int radius, const OutlineInk& ink) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm())));
  for (int i = 0; i <= steps; ++i) {
    dab(image, from + static_cast<double>(i) / steps * (to - from), radius, ink);
  }
}

}  // namespace

std::string outline_picture(const geometry::RgbImage& photograph, const capture::SheetView& sheet,
                            const capture::HandOutline& outline,
                            const capture::HandOutline* model) {
  constexpr OutlineInk kSheet{20, 140, 255}, kSkin{255, 40, 200}, kMiddle{20, 180, 60},
      kModel{250, 220, 30};
  geometry::RgbImage image = photograph;
  const int thin = std::max(1, image.width / 1200), thick = 3 * thin;
  for (std::size_t c = 0; c < 4; ++c) {
    stroke(image, sheet.corner[c], sheet.corner[(c + 1) % 4], thin, kSheet);
  }
  const auto contour = [&](const capture::HandOutline& of, const OutlineInk& ink) {
    for (std::size_t i = 0; i + 1 < of.contour.size(); ++i) {
      stroke(image, sheet.pixel_of(of.contour[i]), sheet.pixel_of(of.contour[i + 1]), thin, ink);
    }
  };
  if (model != nullptr) contour(*model, kModel);
  contour(outline, kSkin);
  for (const capture::OutlineFinger& finger : outline.finger) {
    stroke(image, sheet.pixel_of(finger.seen_base), sheet.pixel_of(finger.seen_tip), thin, kMiddle);
    dab(image, sheet.pixel_of(finger.seen_tip), thick, kMiddle);
    dab(image, sheet.pixel_of(finger.seen_base), thick, kMiddle);
  }
  for (const Eigen::Vector2d& web : outline.seen_web)
    dab(image, sheet.pixel_of(web), thick, kSheet);
  dab(image, sheet.pixel_of(outline.wrist), thick, kSheet);
  stroke(image, sheet.pixel_of(outline.wrist), sheet.pixel_of(outline.finger[2].seen_tip), thin,
         kSheet);
  return formats::format_png(image);
}

}  // namespace palmar::person_workflow
