// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_pictures.h"

#include <utility>

#include "palmar/core/error.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/picture/stroke_text.h"
#include "palmar/report/picture/thumb_inset.h"
#include "palmar/report/study/study_scene.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

constexpr Rgb kBorderColour{110, 118, 126};

/// A surface with a field in the colours of a scale.
SceneObject painted(const geometry::TriangleMesh& mesh, const std::vector<double>& field,
                    const ColourScale& scale, Rgb colour) {
  SceneObject object;
  object.mesh = mesh;
  object.colour = colour;
  object.field = field;
  object.field_upper = scale.upper;
  object.map = scale.map;
  return object;
}

/// Borders of the product's faces as dark threads; empty if it has none.
Scene threads_on_borders(const product::Product& product) {
  if (product.faces == nullptr) return {};
  Box3 box;
  for (const Vec3& v : product.mesh.vertices) box.extend(v);
  const double radius = 0.0016 * box.diagonal().norm();
  SceneObject threads;
  threads.colour = kBorderColour;
  for (const auto& [a, b] : product::border_edges(product.mesh, product.faces->face_of_triangle)) {
    const Vec3 &start = product.mesh.vertices[static_cast<std::size_t>(a)],
               &end = product.mesh.vertices[static_cast<std::size_t>(b)];
    if (!((end - start).norm() > 0.0)) continue;
    const Vec3 along = (end - start).normalized();
    const Vec3 across = along.unitOrthogonal() * radius;
    const Vec3 third = along.cross(across);
    const int first = threads.mesh.vertex_count();
    for (const Vec3& at : {start, end}) {
      threads.mesh.vertices.push_back(at + across);
      threads.mesh.vertices.push_back(at - 0.5 * across + 0.866 * third);
      threads.mesh.vertices.push_back(at - 0.5 * across - 0.866 * third);
    }
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      threads.mesh.triangles.push_back({first + k, first + next, first + 3 + next});
      threads.mesh.triangles.push_back({first + k, first + 3 + next, first + 3 + k});
    }
  }
  if (threads.mesh.triangles.empty()) return {};
  return {std::move(threads)};
}

struct ProductView {
  std::string name, title, alt;
  Vec3 direction, up;  ///< into the scene
};

Picture picture_of(const Scene& scene, const ProductView& view, const std::string& product,
                   const std::string& subtitle, const ColourScale& scale,
                   const PictureOptions& options, const Progress& progress) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const double bar = static_cast<double>(colour_bar_width(options.height)) / options.width;
  Camera camera =
      fit_camera(scene, view.direction, view.up, {.aspect = aspect * (1.0 - bar), .margin = 0.12});
  const Vec3 right = camera.direction.cross(camera.up).normalized();
  camera.position += 0.035 * camera.view_height * right.cross(camera.direction);
  camera.position += 0.5 * bar * camera.view_height * aspect * right;
  Picture picture{view.name, view.title, view.alt, {}};
  picture.image = std::move(
      render_views(scene, {camera}, {.width = options.width, .height = options.height}, progress)
          .front());
  const double s = options.height / 700.0;
  draw_text(picture.image, 24 * s, 40 * s, product, {.cap_height = 14 * s, .weight = 0.15});
  draw_text(picture.image, 24 * s, 64 * s, Phrases(options.language)(subtitle),
            {.cap_height = 10.5 * s, .colour = Rgb{96, 102, 110}});
  draw_colour_bar(picture.image, scale);
  return picture;
}

}  // namespace

std::vector<Picture> study_pictures(const hand::Hand& base, const product::Product& product,
                                    const std::string& name, const study::StudyMaps& maps,
                                    const geometry::Rigid3& product_from_hand,
                                    const StudyScales& scales, double threshold,
                                    const PictureOptions& options, const Progress& progress) {
  const double mirror = base.side == hand::Side::kLeft ? -1.0 : 1.0;
  const std::string hands = std::to_string(maps.hands) + (maps.hands == 1 ? " hand" : " hands");
  const std::string limit = short_number(1000.0 * threshold) + " kPa";
  const Vec3 palm(mirror * 0.12, -0.10, -1.0);
  const geometry::TriangleMesh surface = study::product_map(product.mesh);
  const Quat& turn = product_from_hand.rotation;
  // The bar has room for short words only; titles say which pressure.
  ColourScale mean = scales.mean, percent = scales.above;
  const Phrases phrases(options.language);
  mean.quantity = phrases("Pressure");
  percent.quantity = phrases("Hands");
  const std::string pad = phrases("the thumb's pad");
  ColourScale share = scales.above;
  share.upper = 1.0;  // the field counts from 0 to 1, the bar in per cent
  std::vector<Picture> pictures;
  try {
    pictures.push_back(
        picture_of({painted(base.skin, maps.skin.mean, scales.mean, kSkinColour)},
                   {"mean_hand", "Mean pressure over " + hands + ", on the open hand",
                    name + ": mean pressure over hands on the skin of the open hand, palm side.",
                    palm, Vec3::UnitY()},
                   name, "Mean pressure over " + hands, mean, options, progress));
    add_thumb_inset(pictures.back().image, base,
                    {painted(base.skin, maps.skin.mean, scales.mean, kSkinColour)}, pad, progress);
    pictures.push_back(picture_of(
        {painted(base.skin, maps.skin.above, share, kSkinColour)},
        {"above_hand", "Share of " + hands + " above " + limit + ", on the open hand",
         name + ": share of hands whose pressure is above " + limit + ", on the open hand.", palm,
         Vec3::UnitY()},
        name, "Share of " + hands + " above " + limit, percent, options, progress));
    add_thumb_inset(pictures.back().image, base,
                    {painted(base.skin, maps.skin.above, share, kSkinColour)}, pad, progress);
    Scene held = {painted(surface, maps.on_product.mean, scales.mean, kProductColour)};
    for (SceneObject& threads : threads_on_borders(product)) held.push_back(std::move(threads));
    pictures.push_back(picture_of(
        held,
        {"mean_product_palm", "Mean pressure on the product, side in the palm",
         name + ": mean pressure on the product, side in the palm.",
         turn * Vec3(mirror * 0.25, -0.2, 1.0), turn * Vec3::UnitY()},
        name, "Mean pressure over " + hands + ", side in the palm", mean, options, progress));
    pictures.push_back(
        picture_of(held,
                   {"mean_product_fingers", "Mean pressure on the product, side under the fingers",
                    name + ": mean pressure on the product, side under the fingers.",
                    turn * Vec3(mirror * 0.25, -0.2, -1.0), turn * Vec3::UnitY()},
                   name, "Mean pressure over " + hands + ", side under the fingers", scales.mean,
                   options, progress));
  } catch (const Cancelled&) {
    // What is finished stands.
  }
  return pictures;
}

Picture study_hold_picture(const hand::Hand& hand, const study::StudyRecord& record,
                           const product::Product& product, const std::string& name,
                           const std::string& whose, const PictureOptions& options,
                           const Progress& progress) {
  const double mirror = hand.side == hand::Side::kLeft ? -1.0 : 1.0;
  const Quat& turn = record.product_from_hand.rotation;
  SceneObject skin, held;
  skin.mesh = {displayed_skin(hand, record, product), hand.skin.triangles};
  skin.colour = kSkinColour;
  held.mesh = product.mesh;
  held.colour = kProductColour;
  const Scene scene = {std::move(skin), std::move(held)};
  const Camera camera =
      fit_camera(scene, turn * Vec3(mirror * 0.25, -0.2, -1.0), turn * Vec3::UnitY(),
                 {.aspect = static_cast<double>(options.width) / options.height, .margin = 0.12});
  Picture picture{"hold", "How it is held: " + whose, name + ": how it is held, palm side.", {}};
  picture.image = std::move(
      render_views(scene, {camera}, {.width = options.width, .height = options.height}, progress)
          .front());
  const double s = options.height / 700.0;
  draw_text(picture.image, 24 * s, 40 * s, name, {.cap_height = 14 * s, .weight = 0.15});
  draw_text(picture.image, 24 * s, 64 * s, Phrases(options.language)(whose),
            {.cap_height = 10.5 * s, .colour = Rgb{96, 102, 110}});
  return picture;
}

}  // namespace palmar::report
