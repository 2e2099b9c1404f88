// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/thumb_inset.h"

#include <algorithm>

#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {
namespace {

constexpr double kInsetWidth = 0.20, kInsetHeight = 0.42;  // of the picture
constexpr Rgb kInsetFrame{160, 168, 176};

Vec3 middle_of(const hand::Hand& hand, hand::Region region) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < hand.region.size(); ++i) {
    if (hand.region[i] != region) continue;
    sum += hand.skin.vertices[i];
    ++count;
  }
  return count > 0 ? Vec3(sum / count) : sum;
}

/// Mean direction that the skin of a region faces, outwards.
Vec3 facing_of(const hand::Hand& hand, hand::Region region) {
  Vec3 sum = Vec3::Zero();
  const std::vector<Vec3>& p = hand.skin.vertices;
  for (const Triangle& t : hand.skin.triangles) {
    if (!std::all_of(t.begin(), t.end(), [&](int v) { return hand.region[v] == region; })) continue;
    sum += (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
  }
  return sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
}

bool is_of_thumb(hand::Region region) {
  return region == hand::Region::kThumbDistal || region == hand::Region::kThumbProximal ||
         region == hand::Region::kThenar;
}

}  // namespace

Camera thumb_pad_camera(const hand::Hand& hand, double aspect) {
  SceneObject thumb;
  for (std::size_t i = 0; i < hand.region.size(); ++i) {
    const bool is_shown = is_of_thumb(hand.region[i]) ||
                          hand.segment[i] == hand::Segment::kThumbDistal ||
                          hand.segment[i] == hand::Segment::kThumbProximal;
    if (is_shown) thumb.mesh.vertices.push_back(hand.skin.vertices[i]);
  }
  if (thumb.mesh.vertices.empty()) thumb.mesh.vertices = hand.skin.vertices;
  for (int i = 0; i < thumb.mesh.vertex_count(); ++i) thumb.mesh.triangles.push_back({i, i, i});
  const Vec3 facing = facing_of(hand, hand::Region::kThumbDistal);
  Vec3 up =
      middle_of(hand, hand::Region::kThumbDistal) - middle_of(hand, hand::Region::kThumbProximal);
  up -= up.dot(facing) * facing;
  if (!(up.norm() > 1e-6)) up = facing.unitOrthogonal();
  return fit_camera({thumb}, -facing, up, {.aspect = aspect, .margin = 0.04});
}

void add_thumb_inset(Image& picture, const hand::Hand& hand, const Scene& open_hand,
                     const std::string& title, const Progress& progress) {
  const double s = picture.height / 700.0;
  const int width = static_cast<int>(kInsetWidth * picture.width);
  const int height = static_cast<int>(kInsetHeight * picture.height);
  if (width < 8 || height < 8) return;
  const Camera camera = thumb_pad_camera(hand, static_cast<double>(width) / height);
  const Image view =
      render_views(open_hand, {camera}, {.width = width, .height = height}, progress).front();
  const int left = static_cast<int>(24 * s);
  const int top = picture.height - height - static_cast<int>(24 * s);
  const int line = std::max(1, static_cast<int>(s));
  fill_rectangle(picture, left - line, top - line, width + 2 * line, height + 2 * line,
                 kInsetFrame);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) picture.at(left + x, top + y) = view.at(x, y);
  }
  draw_text(picture, left, top - 10 * s, title,
            {.cap_height = 14 * s, .colour = Rgb{96, 102, 110}});
}

}  // namespace palmar::report
