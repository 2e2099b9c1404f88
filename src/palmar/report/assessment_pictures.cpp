// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/assessment_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/report/render.h"
#include "palmar/report/stroke_text.h"

namespace palmar {

namespace {

// Where the eye stands, in hand axes of a right hand (x radial, y distal, z palmar). Tilted a
// little from the axes, so that shapes read.
struct Viewpoint {
  const char* key;
  const char* words;
  Vec3 direction;  // into the scene
};

std::array<Viewpoint, 4> viewpoints() {
  return {{{"palm", "palm side", {0.12, -0.10, -1.0}},
           {"back", "back of the hand", {0.12, -0.15, 1.0}},
           {"thumb", "thumb side", {-1.0, -0.30, -0.35}},
           {"little", "little finger's side", {1.0, -0.30, -0.35}}}};
}

Camera camera_for(const Scene& scene, const Viewpoint& view, Side side, const Quat& scene_from_hand,
                  double aspect, double bar_share) {
  const double mirror = side == Side::kLeft ? -1.0 : 1.0;
  const Vec3 direction(mirror * view.direction.x(), view.direction.y(), view.direction.z());
  // The colour bar takes a strip at the right: fit to what is left, then shift by half of it.
  const double free = 1.0 - bar_share;
  Camera camera = fit_camera(scene, scene_from_hand * direction, scene_from_hand * Vec3::UnitY(),
                             {.aspect = aspect * free, .margin = 0.09});
  const Vec3 right = camera.direction.cross(camera.up).normalized();
  camera.position += 0.5 * bar_share * camera.view_height * aspect * right;
  return camera;
}

void decorate(Image& image, const std::string& title, const std::string& subtitle,
              const ColourScale* scale) {
  const double s = image.height / 700.0;
  draw_text(image, 24 * s, 40 * s, title, {.cap_height = 14 * s, .weight = 0.15});
  draw_text(image, 24 * s, 64 * s, subtitle, {.cap_height = 10.5 * s, .colour = Rgb{96, 102, 110}});
  if (scale != nullptr) draw_colour_bar(image, *scale);
}

struct Kind {
  std::string key;    // "pressure"
  std::string title;  // "Pressure on the skin"
  std::string alt;
  bool has_bar = true;
};

void add_views(std::vector<Picture>& pictures, const Kind& kind, const Scene& scene,
               const std::vector<Viewpoint>& views, Side side, const Quat& scene_from_hand,
               const std::string& product_name, const ColourScale& scale,
               const PictureOptions& options) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const double bar_share =
      kind.has_bar ? static_cast<double>(colour_bar_width(options.height)) / options.width : 0.0;
  std::vector<Camera> cameras;
  for (const Viewpoint& view : views) {
    cameras.push_back(camera_for(scene, view, side, scene_from_hand, aspect, bar_share));
  }
  std::vector<Image> images =
      render_views(scene, cameras, {.width = options.width, .height = options.height});
  for (std::size_t i = 0; i < views.size(); ++i) {
    Picture picture;
    picture.name = kind.key + "_" + views[i].key;
    picture.title = kind.title + ", " + views[i].words;
    picture.alt = product_name + ": " + kind.alt + ", seen from the " + views[i].words + ".";
    picture.image = std::move(images[i]);
    decorate(picture.image, product_name, picture.title, kind.has_bar ? &scale : nullptr);
    pictures.push_back(std::move(picture));
  }
}

}  // namespace

TriangleMesh undeformed_skin(const Hand& hand, const Assessment& assessment) {
  TriangleMesh mesh = hand.skin;
  const ContactResult& contact = assessment.contact;
  if (contact.undeformed.size() == mesh.vertices.size()) {
    mesh.vertices = contact.undeformed;
    return mesh;
  }
  if (assessment.posed_skin.size() == mesh.vertices.size()) mesh.vertices = assessment.posed_skin;
  for (Vec3& v : mesh.vertices) v = assessment.grasp.product_from_hand * v;
  return mesh;
}

TriangleMesh deformed_skin(const Hand& hand, const Assessment& assessment) {
  TriangleMesh mesh = undeformed_skin(hand, assessment);
  const ContactResult& contact = assessment.contact;
  if (contact.deformed.size() == mesh.vertices.size()) mesh.vertices = contact.deformed;
  return mesh;
}

std::vector<double> skin_pressure(const Hand& hand, const Assessment& assessment) {
  std::vector<double> pressure = assessment.contact.pressure;
  pressure.resize(hand.skin.vertices.size(), 0.0);
  return pressure;
}

ProductFootprint footprint_of(const AssessedProduct& assessed) {
  ProductFootprint footprint = assessed.assessment.footprint;
  if (footprint.surface.triangles.empty()) footprint = {assessed.product.mesh, {}};
  footprint.pressure.resize(footprint.surface.vertices.size(), 0.0);
  return footprint;
}

ColourScale pressure_scale(const AssessmentSet& set) {
  double peak = 0.0;
  for (const AssessedProduct& one : set.assessments) {
    peak = std::max(peak, one.assessment.contact.total.peak_pressure);
  }
  return {.map = Colormap::kEmber,
          .upper = peak > 0.0 && std::isfinite(peak) ? rounded_up(peak) : 0.1,
          .quantity = "Pressure",
          .unit = "MPa",
          .neutral = kNeutralColour};
}

std::vector<Picture> assessment_pictures(const Hand& hand, const AssessedProduct& assessed,
                                         const ColourScale& scale, const PictureOptions& options) {
  const Assessment& assessment = assessed.assessment;
  const auto views = viewpoints();
  const std::vector<Viewpoint> all(views.begin(), views.end());
  const Quat product_from_hand = assessment.grasp.product_from_hand.rotation;
  const std::vector<double> pressure = skin_pressure(hand, assessment);
  const auto coloured = [&](TriangleMesh mesh, const std::vector<double>& field) {
    return SceneObject{.mesh = std::move(mesh),
                       .colour = scale.neutral,
                       .vertex_colours = {},
                       .field = field,
                       .field_upper = scale.upper,
                       .map = scale.map};
  };

  std::vector<Picture> pictures;
  const auto add = [&](const Kind& kind, const Scene& scene, const std::vector<Viewpoint>& from,
                       const Quat& scene_from_hand) {
    add_views(pictures, kind, scene, from, hand.side, scene_from_hand, assessed.product.name, scale,
              options);
  };
  add({"map", "Pressure on the opened hand", "pressure drawn on the opened hand"},
      {coloured(hand.skin, pressure)}, {{"open_hand", "palm side", {0.0, 0.0, -1.0}}},
      Quat::Identity());
  add({"pressure", "Pressure on the skin", "hand with the product hidden, coloured by pressure"},
      {coloured(deformed_skin(hand, assessment), pressure)}, all, product_from_hand);
  add({"grasp", "Hand and product", "hand holding the product", false},
      {{.mesh = deformed_skin(hand, assessment), .colour = kSkinColour},
       {.mesh = assessed.product.mesh, .colour = kProductColour}},
      all, product_from_hand);
  ProductFootprint footprint = footprint_of(assessed);
  add({"footprint", "Pressure on the product", "product coloured by the pressure of the hand"},
      {coloured(std::move(footprint.surface), footprint.pressure)}, all, product_from_hand);
  return pictures;
}

}  // namespace palmar
