// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/assessment_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/picture/stroke_text.h"
#include "palmar/report/picture/thumb_inset.h"
#include "palmar/report/words/phrases.h"
#include "palmar/study/assessment/verdict.h"

namespace palmar::report {

namespace {

// Where the eye stands, in hand axes of a right hand (x radial, y distal, z palmar). Tilted a
// little from the axes, so that shapes read.
struct Viewpoint {
  const char* key;
  const char* words;
  Vec3 direction;  // into the scene
  Vec3 up = Vec3::UnitY();
};

std::array<Viewpoint, 4> viewpoints() {
  return {{{"palm", "palm side", {0.12, -0.10, -1.0}},
           {"back", "back of the hand", {0.12, -0.15, 1.0}},
           {"thumb", "thumb side", {-1.0, -0.30, -0.35}},
           {"little", "little finger's side", {1.0, -0.30, -0.35}}}};
}

// The same eyes in scene axes.
std::vector<Viewpoint> hand_viewpoints(hand::Side side, const Quat& scene_from_hand) {
  const double mirror = side == hand::Side::kLeft ? -1.0 : 1.0;
  std::vector<Viewpoint> views;
  for (Viewpoint view : viewpoints()) {
    view.direction.x() *= mirror;
    view.direction = scene_from_hand * view.direction;
    view.up = scene_from_hand * Vec3::UnitY();
    views.push_back(view);
  }
  return views;
}

// Four sides of the product about the grip axis, which stands upright with the thumb above: what
// lies in the palm, under the fingers, and between the two.
std::vector<Viewpoint> product_viewpoints(const grasp::Grasp& grasp) {
  const Quat& product_from_hand = grasp.product_from_hand.rotation;
  const Vec3 axis = grasp.grip_axis.normalized();
  const Vec3 palmar = product_from_hand * Vec3::UnitZ();
  Vec3 outwards = palmar - palmar.dot(axis) * axis;
  // A grip axis along the palm's normal leaves no such direction: any will do.
  outwards = outwards.norm() > 1e-6 ? Vec3(outwards.normalized()) : Vec3(axis.unitOrthogonal());
  const Vec3 distal = product_from_hand * Vec3::UnitY();
  Vec3 onwards = outwards.cross(axis);
  if (onwards.dot(distal) < 0.0) onwards = -onwards;
  return {{"in_palm", "side in the palm", outwards, axis},
          {"under_fingers", "side under the fingers", -outwards, axis},
          {"under_knuckles", "side under the knuckles", -onwards, axis},
          {"under_fingertips", "side under the fingertips", onwards, axis}};
}

Camera camera_for(const Scene& scene, const Viewpoint& view, double aspect, double bar_share) {
  // The colour bar takes a strip at the right: fit to what is left, then shift by half of it.
  const double free = 1.0 - bar_share;
  Camera camera =
      fit_camera(scene, view.direction, view.up, {.aspect = aspect * free, .margin = 0.12});
  const Vec3 right = camera.direction.cross(camera.up).normalized();
  camera.position += 0.035 * camera.view_height * right.cross(camera.direction);  // room for titles
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
               const std::vector<Viewpoint>& views, const std::string& product_name,
               const ColourScale& scale, const PictureOptions& options, const Progress& progress) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const double bar_share =
      kind.has_bar ? static_cast<double>(colour_bar_width(options.height)) / options.width : 0.0;
  std::vector<Camera> cameras;
  for (const Viewpoint& view : views) {
    cameras.push_back(camera_for(scene, view, aspect, bar_share));
  }
  std::vector<Image> images;
  try {
    images =
        render_views(scene, cameras, {.width = options.width, .height = options.height}, progress);
  } catch (const Cancelled&) {
    return;
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    Picture picture;
    picture.name = kind.key + "_" + views[i].key;
    picture.title = kind.title + ", " + views[i].words;
    picture.alt = product_name + ": " + kind.alt + ", seen from the " + views[i].words + ".";
    picture.image = std::move(images[i]);
    decorate(picture.image, product_name, Phrases(options.language)(picture.title),
             kind.has_bar ? &scale : nullptr);
    pictures.push_back(std::move(picture));
  }
}

/// The pad of the thumb in the last picture, which shows the opened hand; cancelled: without it.
void add_thumb(std::vector<Picture>& pictures, const hand::Hand& hand, const Scene& open_hand,
               const PictureOptions& options, const Progress& progress) {
  if (pictures.empty() || progress.is_cancelled()) return;
  try {
    add_thumb_inset(pictures.back().image, hand, open_hand,
                    Phrases(options.language)("the thumb's pad"), progress);
  } catch (const Cancelled&) {
    pictures.pop_back();
  }
}

/// Skin coloured by the share of friction in use. Unlike pressure it doesn't fade towards the edge
/// of the contact, where it is often largest; so contact and other skin are two meshes. Triangles
/// with a loaded corner belong to the contact, and corners without load take the mean of those
/// beside them.
Scene friction_scene(const geometry::TriangleMesh& skin, const study::Assessment& assessment,
                     const ColourScale& scale) {
  const std::size_t n = skin.vertices.size();
  std::vector<double> used = assessment.friction.mobilised, force = assessment.contact.force;
  used.resize(n, 0.0);
  force.resize(n, 0.0);
  SceneObject contact{.mesh = {skin.vertices, {}},
                      .colour = scale.neutral,
                      .vertex_colours = {},
                      .field = used,
                      .field_upper = scale.upper,
                      .map = scale.map};
  SceneObject rest{.mesh = {skin.vertices, {}}, .colour = scale.neutral, .vertex_colours = {}};
  std::vector<double> sum(n, 0.0), count(n, 0.0);
  for (const Triangle& t : skin.triangles) {
    int loaded = 0;
    double total = 0.0;
    for (const int v : t) {
      if (!(force[static_cast<std::size_t>(v)] > 0.0)) continue;
      ++loaded;
      total += used[static_cast<std::size_t>(v)];
    }
    (loaded > 0 ? contact : rest).mesh.triangles.push_back(t);
    if (loaded == 0) continue;
    for (const int v : t) {
      sum[static_cast<std::size_t>(v)] += total;
      count[static_cast<std::size_t>(v)] += loaded;
    }
  }
  const double least = 0.006 * scale.upper;  // below 0.005 a field is not shown
  for (std::size_t v = 0; v < n; ++v) {
    if (!(force[v] > 0.0) && count[v] > 0.0) contact.field[v] = sum[v] / count[v];
    contact.field[v] = std::max(contact.field[v], least);
  }
  if (contact.mesh.triangles.empty()) return {std::move(rest)};
  if (rest.mesh.triangles.empty()) return {std::move(contact)};
  return {std::move(rest), std::move(contact)};
}

}  // namespace

geometry::TriangleMesh undeformed_skin(const hand::Hand& hand,
                                       const study::Assessment& assessment) {
  geometry::TriangleMesh mesh = hand.skin;
  const contact::ContactResult& contact = assessment.contact;
  if (contact.undeformed.size() == mesh.vertices.size()) {
    mesh.vertices = contact.undeformed;
    return mesh;
  }
  if (assessment.posed_skin.size() == mesh.vertices.size()) mesh.vertices = assessment.posed_skin;
  for (Vec3& v : mesh.vertices) v = assessment.grasp.product_from_hand * v;
  return mesh;
}

geometry::TriangleMesh deformed_skin(const hand::Hand& hand, const study::Assessment& assessment) {
  geometry::TriangleMesh mesh = undeformed_skin(hand, assessment);
  const contact::ContactResult& contact = assessment.contact;
  if (contact.deformed.size() == mesh.vertices.size()) mesh.vertices = contact.deformed;
  return mesh;
}

std::vector<double> skin_pressure(const hand::Hand& hand, const study::Assessment& assessment) {
  std::vector<double> pressure = assessment.contact.pressure;
  pressure.resize(hand.skin.vertices.size(), 0.0);
  return pressure;
}

contact::ProductFootprint footprint_of(const study::AssessedProduct& assessed) {
  contact::ProductFootprint footprint = assessed.assessment.footprint;
  if (footprint.surface.triangles.empty()) footprint = {assessed.product.mesh, {}};
  footprint.pressure.resize(footprint.surface.vertices.size(), 0.0);
  return footprint;
}

ColourScale friction_scale() {
  return {.map = Colormap::kFern,
          .upper = 1.0,
          .quantity = "Friction",
          .unit = "1: slips",
          .neutral = kNeutralColour};
}

ColourScale pressure_scale(const study::AssessmentSet& set) {
  const bool any_in_hand = std::any_of(
      set.assessments.begin(), set.assessments.end(),
      [](const study::AssessedProduct& one) { return study::presses_on_skin(one.assessment); });
  double cells = 0.0;
  double peak = 0.0;
  for (const study::AssessedProduct& one : set.assessments) {
    const contact::RegionContact& total = one.assessment.contact.total;
    peak = std::max(peak, total.peak_pressure);
    if (any_in_hand && !study::presses_on_skin(one.assessment)) continue;
    cells = std::max(cells, total.peak_pressure_cells);
  }
  if (!(cells > 0.0)) cells = peak;
  ColourScale scale{.map = Colormap::kEmber,
                    .upper = cells > 0.0 && std::isfinite(cells) ? rounded_up(cells) : 0.1,
                    .quantity = "Pressure",
                    .unit = "MPa",
                    .neutral = kNeutralColour};
  scale.is_open_ended = peak > scale.upper;
  return scale;
}

std::vector<Picture> assessment_pictures(const hand::Hand& hand,
                                         const study::AssessedProduct& assessed,
                                         const ColourScale& scale, const PictureOptions& options,
                                         const Progress& progress) {
  const study::Assessment& assessment = assessed.assessment;
  const std::vector<Viewpoint> all =
      hand_viewpoints(hand.side, assessment.grasp.product_from_hand.rotation);
  const std::vector<double> pressure = skin_pressure(hand, assessment);
  const auto coloured = [&](geometry::TriangleMesh mesh, const std::vector<double>& field) {
    return SceneObject{.mesh = std::move(mesh),
                       .colour = scale.neutral,
                       .vertex_colours = {},
                       .field = field,
                       .field_upper = scale.upper,
                       .map = scale.map};
  };

  std::vector<Picture> pictures;
  const auto add = [&](const Kind& kind, const Scene& scene, const std::vector<Viewpoint>& from) {
    if (progress.is_cancelled()) return;
    add_views(pictures, kind, scene, from, assessed.product.name, scale, options, progress);
  };
  add({"map", "Pressure on the opened hand", "pressure drawn on the opened hand"},
      {coloured(hand.skin, pressure)}, {{"open_hand", "palm side", {0.0, 0.0, -1.0}}});
  add_thumb(pictures, hand, {coloured(hand.skin, pressure)}, options, progress);
  add({"pressure", "Pressure on the skin", "hand with the product hidden, coloured by pressure"},
      {coloured(deformed_skin(hand, assessment), pressure)}, all);
  add({"grasp", "Hand and product", "hand holding the product", false},
      {{.mesh = deformed_skin(hand, assessment), .colour = kSkinColour},
       {.mesh = assessed.product.mesh, .colour = kProductColour}},
      all);
  if (assessment.options.friction.is_on() && !progress.is_cancelled()) {
    const ColourScale used = friction_scale();
    const std::string shows = "coloured by the share of friction in use";
    add_views(pictures, {"friction", "Friction in use on the opened hand", "opened hand, " + shows},
              friction_scene(hand.skin, assessment, used),
              {{"open_hand", "palm side", {0.0, 0.0, -1.0}}}, assessed.product.name, used, options,
              progress);
    add_thumb(pictures, hand, friction_scene(hand.skin, assessment, used), options, progress);
    add_views(pictures,
              {"friction", "Friction in use on the skin", "hand with the product hidden, " + shows},
              friction_scene(deformed_skin(hand, assessment), assessment, used), all,
              assessed.product.name, used, options, progress);
  }
  contact::ProductFootprint footprint = footprint_of(assessed);
  add({"footprint", "Pressure on the product", "product coloured by the pressure of the hand"},
      {coloured(std::move(footprint.surface), footprint.pressure)},
      product_viewpoints(assessment.grasp));
  return pictures;
}

}  // namespace palmar::report
