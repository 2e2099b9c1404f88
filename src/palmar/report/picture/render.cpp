// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/render.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/embree_mesh.h"
#include "palmar/report/picture/shading_normals.h"

namespace palmar::report {

namespace {

using Vec3f = Eigen::Vector3f;

constexpr int kMaxLayers = 12;           // surfaces seen through one another
constexpr int kOcclusionRays = 32;       // per vertex
constexpr double kOcclusionDepth = 0.8;  // light lost by a point that is closed in on all sides

constexpr float kLeastShare = 0.005F;  // of a field's upper end; less is not shown

float linear_from_byte(std::uint8_t byte) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double s = static_cast<double>(i) / 255.0;
      t[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return t;
  }();
  return table[byte];
}

// Rounded to the nearest byte by the middle between neighbouring bytes: as exact as the formula,
// and a search in a table is quicker than a power.
std::uint8_t byte_from_linear(float linear) {
  static const std::array<float, 255> border = [] {
    std::array<float, 255> b{};
    for (std::size_t i = 0; i < b.size(); ++i) {
      const double s = (static_cast<double>(i) + 0.5) / 255.0;
      b[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return b;
  }();
  return static_cast<std::uint8_t>(std::upper_bound(border.begin(), border.end(), linear) -
                                   border.begin());
}

Vec3f linear_from(Rgb c) {
  return {linear_from_byte(c.r), linear_from_byte(c.g), linear_from_byte(c.b)};
}

Rgb srgb_from(const Vec3f& c) {
  return {byte_from_linear(c.x()), byte_from_linear(c.y()), byte_from_linear(c.z())};
}

const std::array<Vec3f, 256>& linear_table(Colormap map) {
  const auto make = [](Colormap m) {
    std::array<Vec3f, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = linear_from(colour_table(m)[i]);
    return table;
  };
  static const std::array<Vec3f, 256> ember = make(Colormap::kEmber);
  static const std::array<Vec3f, 256> fern = make(Colormap::kFern);
  return map == Colormap::kEmber ? ember : fern;
}

// What shading needs to know about one corner of a triangle.
struct ShadedCorner {
  Vec3f normal;
  Vec3f colour;        // linear
  float value = 0.0F;  // of the field, as a share of its upper end
  float light = 1.0F;  // share of the ambient light that reaches it
};

struct ShadedTriangle {
  std::array<ShadedCorner, 3> corner;
  float opacity = 1.0F;
  int object = 0;
  const std::array<Vec3f, 256>* table = nullptr;  // colours of the field, linear; null: no field
};

// All objects in one mesh, so that one ray meets them in order.
struct PreparedScene {
  geometry::TriangleMesh all;
  geometry::TriangleMesh opaque;
  std::vector<ShadedTriangle> triangles;  // of `all`
};

void check_object(const SceneObject& object, std::size_t index) {
  const std::string name = "scene object " + std::to_string(index);
  if (!(object.opacity > 0.0 && object.opacity <= 1.0)) {
    throw UsageError(name + ": opacity is " + std::to_string(object.opacity) +
                     "; it must be above 0 and at most 1");
  }
  if (!object.vertex_colours.empty() &&
      object.vertex_colours.size() != object.mesh.vertices.size()) {
    throw UsageError(name + ": " + std::to_string(object.vertex_colours.size()) +
                     " vertex colours for " + std::to_string(object.mesh.vertices.size()) +
                     " vertices");
  }
  if (!object.field.empty() &&
      (object.field.size() != object.mesh.vertices.size() || !(object.field_upper > 0.0))) {
    throw UsageError(name + ": a field of " + std::to_string(object.field.size()) + " values for " +
                     std::to_string(object.mesh.vertices.size()) + " vertices, shown up to " +
                     std::to_string(object.field_upper) +
                     "; one value per vertex and an upper end above 0 are required");
  }
  for (const Triangle& t : object.mesh.triangles) {
    for (const int v : t) {
      if (v < 0 || v >= object.mesh.vertex_count()) {
        throw UsageError(name + ": a triangle uses vertex " + std::to_string(v) + " of " +
                         std::to_string(object.mesh.vertex_count()));
      }
    }
  }
}

void append(geometry::TriangleMesh& whole, const geometry::TriangleMesh& part) {
  const int first = whole.vertex_count();
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Triangle& t : part.triangles) {
    whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

PreparedScene prepare(const Scene& scene, double crease_angle) {
  PreparedScene prepared;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const SceneObject& object = scene[i];
    check_object(object, i);
    append(prepared.all, object.mesh);
    if (object.opacity == 1.0) append(prepared.opaque, object.mesh);
    const auto normals = shading_normals(object.mesh, crease_angle);
    for (std::size_t t = 0; t < object.mesh.triangles.size(); ++t) {
      ShadedTriangle shaded;
      shaded.opacity = static_cast<float>(object.opacity);
      shaded.object = static_cast<int>(i);
      if (!object.field.empty()) shaded.table = &linear_table(object.map);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(object.mesh.triangles[t][k]);
        shaded.corner[k].normal = normals[t][k].cast<float>();
        shaded.corner[k].colour =
            linear_from(object.vertex_colours.empty() ? object.colour : object.vertex_colours[v]);
        if (!object.field.empty()) {
          shaded.corner[k].value = static_cast<float>(object.field[v] / object.field_upper);
        }
      }
      prepared.triangles.push_back(shaded);
    }
  }
  return prepared;
}

// Directions over the hemisphere about +z, cosine-weighted, on a Fibonacci spiral.
std::array<Vec3f, kOcclusionRays> hemisphere_directions() {
  std::array<Vec3f, kOcclusionRays> directions;
  for (int i = 0; i < kOcclusionRays; ++i) {
    const double r2 = (i + 0.5) / kOcclusionRays;
    const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    directions[static_cast<std::size_t>(i)] =
        Vec3(std::sqrt(r2) * std::cos(turn), std::sqrt(r2) * std::sin(turn), std::sqrt(1.0 - r2))
            .cast<float>();
  }
  return directions;
}

float free_share(RTCScene scene, const Vec3f& point, const Vec3f& normal, float range) {
  static const std::array<Vec3f, kOcclusionRays> directions = hemisphere_directions();
  const Vec3f side = normal.unitOrthogonal();
  const Vec3f other = normal.cross(side);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  float closed = 0.0F;
  const Vec3f start = point + 0.02F * range * normal;
  for (const Vec3f& d : directions) {
    const Vec3f direction = d.x() * side + d.y() * other + d.z() * normal;
    RTCRayHit query{};
    query.ray = {
        start.x(), start.y(), start.z(), 0.0F, direction.x(), direction.y(), direction.z(), 0.0F,
        range,     ~0U,       0,         0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    // What is far away takes little light.
    if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) closed += 1.0F - query.ray.tfar / range;
  }
  return 1.0F - static_cast<float>(kOcclusionDepth) * closed / kOcclusionRays;
}

// Ambient occlusion at the corners. Light is interpolated over a triangle, which would smear it
// over triangles larger than the range: those are left fully lit.
void add_occlusion(PreparedScene& prepared, double range, const Progress& progress) {
  if (range <= 0.0 || prepared.opaque.triangles.empty()) return;
  const geometry::EmbreeMesh opaque(prepared.opaque);
  // Corners of one vertex mostly share their normal: the last answer at a vertex often serves.
  struct Known {
    Vec3f normal = Vec3f::Zero();
    float light = 1.0F;
  };
  const auto vertex_count = prepared.all.vertices.size();
  std::vector<Known> known(vertex_count);
  std::vector<std::vector<std::pair<int, int>>> corners(vertex_count);
  for (std::size_t t = 0; t < prepared.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      corners[static_cast<std::size_t>(prepared.all.triangles[t][k])].emplace_back(
          static_cast<int>(t), static_cast<int>(k));
    }
  }
  parallel_for(static_cast<int>(vertex_count), [&](int v) {
    if (progress.is_cancelled()) return;
    const Vec3& x = prepared.all.vertices[static_cast<std::size_t>(v)];
    const Vec3f point = (x - opaque.origin()).cast<float>();
    Known& last = known[static_cast<std::size_t>(v)];
    for (const auto& [t, k] : corners[static_cast<std::size_t>(v)]) {
      const Triangle& triangle = prepared.all.triangles[static_cast<std::size_t>(t)];
      double longest = 0.0;
      for (const int w : triangle) {
        longest =
            std::max(longest, (prepared.all.vertices[static_cast<std::size_t>(w)] - x).norm());
      }
      if (longest > range) continue;
      ShadedCorner& corner =
          prepared.triangles[static_cast<std::size_t>(t)].corner[static_cast<std::size_t>(k)];
      if ((corner.normal - last.normal).squaredNorm() > 1e-8F) {
        last = {corner.normal,
                free_share(opaque.scene(), point, corner.normal, static_cast<float>(range))};
      }
      corner.light = last.light;
    }
  });
}

// Eye, screen and lights in the scene's frame.
struct View {
  Vec3f eye, right, up, forward;
  bool is_orthographic = true;
  float half_width = 1.0F, half_height = 1.0F;  // mm, or tangents of the opening angle
  Vec3f key, fill, sky;
  float facing_light = 1.0F;  // light on a surface that faces the eye

  float light_on(const Vec3f& n, float ambient) const {
    const auto soft = [](float cosine) { return std::max(0.0F, (cosine + 0.3F) / 1.3F); };
    return ambient * (0.26F + 0.10F * n.dot(sky)) +
           (0.35F + 0.65F * ambient) * (0.72F * soft(n.dot(key)) + 0.16F * soft(n.dot(fill)));
  }
};

View make_view(const Camera& camera, const RenderOptions& options, const Vec3& origin) {
  const Vec3 forward = camera.direction.normalized();
  const Vec3 side = forward.cross(camera.up);
  if (!(camera.direction.norm() > 0.0) || !(side.norm() > 1e-9 * camera.up.norm())) {
    throw UsageError("camera: direction and up must have a length and not be parallel");
  }
  View view;
  const Vec3 right = side.normalized();
  const Vec3 up = right.cross(forward);
  view.eye = (camera.position - origin).cast<float>();
  view.right = right.cast<float>();
  view.up = up.cast<float>();
  view.forward = forward.cast<float>();
  view.is_orthographic = camera.is_orthographic;
  const double half_height =
      camera.is_orthographic ? 0.5 * camera.view_height : std::tan(0.5 * camera.field_of_view);
  if (!(half_height > 0.0) || !std::isfinite(half_height)) {
    throw UsageError("camera: view height [mm] and field of view [rad] must be above 0");
  }
  view.half_height = static_cast<float>(half_height);
  view.half_width = static_cast<float>(half_height * options.width / options.height);
  view.key = (-0.45 * right + 0.55 * up - 0.70 * forward).normalized().cast<float>();
  view.fill = (0.70 * right - 0.20 * up - 0.60 * forward).normalized().cast<float>();
  view.sky = up.cast<float>();
  view.facing_light = view.light_on(-view.forward, 1.0F);
  return view;
}

struct Sample {
  Vec3f colour;     // linear
  int object = -1;  // first one met
  Vec3f normal = Vec3f::Zero();
};

class Caster {
 public:
  Caster(const PreparedScene& prepared, const geometry::EmbreeMesh& mesh, const View& view,
         Rgb background)
      : prepared_(prepared),
        scene_(mesh.scene()),
        view_(view),
        background_(linear_from(background)) {}

  // x from -1 (left) to 1 (right), y from -1 (bottom) to 1 (top).
  Sample cast(float x, float y) const {
    const Vec3f across = x * view_.half_width * view_.right + y * view_.half_height * view_.up;
    const Vec3f start = view_.is_orthographic ? Vec3f(view_.eye + across) : view_.eye;
    const Vec3f direction =
        view_.is_orthographic ? view_.forward : Vec3f((view_.forward + across).normalized());
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    Sample sample{Vec3f::Zero()};
    float clear = 1.0F;  // share of the light that still comes from behind
    float near = 0.0F;
    for (int layer = 0; layer < kMaxLayers && clear > 0.004F; ++layer) {
      RTCRayHit query{};
      query.ray = {start.x(),
                   start.y(),
                   start.z(),
                   near,
                   direction.x(),
                   direction.y(),
                   direction.z(),
                   0.0F,
                   std::numeric_limits<float>::infinity(),
                   ~0U,
                   0,
                   0};
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
      near = std::nextafter(query.ray.tfar * 1.000001F, std::numeric_limits<float>::infinity());
      add_layer(prepared_.triangles[query.hit.primID], query.hit.u, query.hit.v, direction, sample,
                clear);
    }
    sample.colour += clear * background_;
    return sample;
  }

 private:
  void add_layer(const ShadedTriangle& triangle, float u, float v, const Vec3f& direction,
                 Sample& sample, float& clear) const {
    const auto& [a, b, c] = triangle.corner;
    const float w = 1.0F - u - v;
    Vec3f normal = (w * a.normal + u * b.normal + v * c.normal).normalized();
    float cosine = -normal.dot(direction);
    const bool is_translucent = triangle.opacity < 1.0F;
    if (cosine < 0.0F) {
      if (is_translucent) return;  // the far side of a translucent body would only blur
      normal = -normal;
      cosine = -cosine;
    }
    const float ambient = w * a.light + u * b.light + v * c.light;
    Vec3f own = w * a.colour + u * b.colour + v * c.colour;
    // The value is interpolated, then coloured: contours stay sharp on coarse triangles.
    const float value = w * a.value + u * b.value + v * c.value;
    if (triangle.table != nullptr && value > kLeastShare) {
      own = (*triangle.table)[static_cast<std::size_t>(255.0F * std::min(value, 1.0F) + 0.5F)];
    }
    // Grazing surfaces are darkened a little: outlines read without lines.
    const float rim = 0.72F + 0.28F * std::min(1.0F, cosine / 0.35F);
    const float light = std::min(1.25F, rim * view_.light_on(normal, ambient) / view_.facing_light);
    // A translucent wall looks denser where it is seen edge-on.
    const float opacity =
        is_translucent ? 1.0F - std::pow(1.0F - triangle.opacity, 1.0F / std::max(cosine, 0.12F))
                       : 1.0F;
    if (sample.object < 0) {
      sample.object = triangle.object;
      sample.normal = normal;
    }
    sample.colour += clear * opacity * light * own;
    clear *= 1.0F - opacity;
  }

  const PreparedScene& prepared_;
  RTCScene scene_;
  const View& view_;
  Vec3f background_;
};

bool differ(const Sample& a, const Sample& b) {
  return a.object != b.object || (a.colour - b.colour).cwiseAbs().maxCoeff() > 0.02F ||
         (a.normal - b.normal).squaredNorm() > 0.08F;
}

Image render_view(const PreparedScene& prepared, const geometry::EmbreeMesh& mesh,
                  const Camera& camera, const RenderOptions& options, const Progress& progress) {
  Image image(options.width, options.height, options.background);
  const View view = make_view(camera, options, mesh.origin());
  const Caster caster(prepared, mesh, view, options.background);
  const auto across = [&](float x) { return 2.0F * x / static_cast<float>(options.width) - 1.0F; };
  const auto upward = [&](float y) { return 1.0F - 2.0F * y / static_cast<float>(options.height); };
  const auto width = static_cast<std::size_t>(options.width);

  std::vector<Sample> first(image.pixels.size());
  const auto pixel = [&](int x, int y) -> Sample& {
    return first[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
  };
  const auto cast_centre = [&](int x, int y) {
    return caster.cast(across(static_cast<float>(x) + 0.5F), upward(static_cast<float>(y) + 0.5F));
  };
  // Every other pixel of every other row first. Where the neighbours agree, those in between need
  // no ray of their own: three rays of four are saved inside smooth surfaces.
  parallel_for((options.height + 1) / 2, [&](int half) {
    if (progress.is_cancelled()) return;
    for (int x = 0; x < options.width; x += 2) pixel(x, 2 * half) = cast_centre(x, 2 * half);
  });
  parallel_for(options.height, [&](int y) {
    if (progress.is_cancelled()) return;
    for (int x = 0; x < options.width; ++x) {
      if (x % 2 == 0 && y % 2 == 0) continue;
      const int x0 = x - x % 2, x1 = x + x % 2, y0 = y - y % 2, y1 = y + y % 2;
      if (x1 >= options.width || y1 >= options.height) {
        pixel(x, y) = cast_centre(x, y);
        continue;
      }
      const Sample& a = pixel(x0, y0);
      const Sample& b = pixel(x1, y0);
      const Sample& c = pixel(x0, y1);
      const Sample& d = pixel(x1, y1);
      if (differ(a, b) || differ(a, c) || differ(a, d)) {
        pixel(x, y) = cast_centre(x, y);
      } else {
        pixel(x, y) = {0.25F * (a.colour + b.colour + c.colour + d.colour), a.object, a.normal};
      }
    }
  });
  // More rays only where the picture changes: edges, outlines, borders of colour.
  parallel_for(options.height, [&](int y) {
    if (progress.is_cancelled()) return;
    for (int x = 0; x < options.width; ++x) {
      const Sample& here = pixel(x, y);
      const bool is_edge = (x > 0 && differ(here, pixel(x - 1, y))) ||
                           (x + 1 < options.width && differ(here, pixel(x + 1, y))) ||
                           (y > 0 && differ(here, pixel(x, y - 1))) ||
                           (y + 1 < options.height && differ(here, pixel(x, y + 1)));
      Vec3f colour = here.colour;
      if (is_edge && options.samples > 1) {
        const int n = options.samples;
        colour = Vec3f::Zero();
        for (int i = 0; i < n * n; ++i) {
          const float sx = (static_cast<float>(i % n) + 0.5F) / static_cast<float>(n);
          const float sy = (static_cast<float>(i / n) + 0.5F) / static_cast<float>(n);
          const Sample s =
              caster.cast(across(static_cast<float>(x) + sx), upward(static_cast<float>(y) + sy));
          colour += s.colour.cwiseMin(1.0F);
        }
        colour /= static_cast<float>(n * n);
      }
      image.at(x, y) = here.object < 0 && !is_edge ? options.background : srgb_from(colour);
    }
  });
  return image;
}

}  // namespace

void RenderOptions::check() const {
  const auto require = [](bool is_allowed, const std::string& field, double value,
                          const std::string& allowed) {
    if (!is_allowed) {
      throw UsageError("render option " + field + " is " + std::to_string(value) + "; " + allowed);
    }
  };
  require(samples >= 1 && samples <= 16, "samples", samples, "1 to 16 are allowed");
  require(occlusion_range >= 0.0 && std::isfinite(occlusion_range), "occlusion_range",
          occlusion_range, "0 mm or more is required");
  require(crease_angle >= 0.0 && crease_angle <= std::numbers::pi, "crease_angle", crease_angle,
          "0 to pi rad are allowed");
}

Camera fit_camera(const Scene& scene, const Vec3& direction, const Vec3& up,
                  const FitOptions& options) {
  const Vec3 forward = direction.normalized();
  const Vec3 side = forward.cross(up);
  if (!(direction.norm() > 0.0) || !(side.norm() > 1e-9 * up.norm())) {
    throw UsageError("camera: direction and up must have a length and not be parallel");
  }
  if (!(options.margin >= 0.0 && options.margin < 0.45) || !(options.aspect > 0.0)) {
    throw UsageError("camera: margin must be 0 to 0.45 and the aspect above 0");
  }
  Eigen::Matrix3d camera_from_scene;
  camera_from_scene << side.normalized().transpose(), side.normalized().cross(forward).transpose(),
      forward.transpose();
  Box3 box;  // in camera axes: right, up, forward
  for (const SceneObject& object : scene) {
    for (const Triangle& t : object.mesh.triangles) {
      for (const int v : t) {
        box.extend(camera_from_scene * object.mesh.vertices.at(static_cast<std::size_t>(v)));
      }
    }
  }
  if (box.isEmpty()) throw UsageError("camera: the scene has no triangle to look at");
  const double room = 1.0 - 2.0 * options.margin;
  const double height =
      std::max({box.sizes().y() / room, box.sizes().x() / room / options.aspect, 1e-3});
  Camera camera;
  camera.direction = forward;
  camera.up = up;
  camera.is_orthographic = options.is_orthographic;
  camera.view_height = height;
  const double depth = box.sizes().z();
  // Far enough that the nearest face of the box fills the picture.
  const double back = camera.is_orthographic ? 0.1 * (depth + height) + 1.0
                                             : 0.5 * height / std::tan(0.5 * camera.field_of_view);
  const Vec3 eye(box.center().x(), box.center().y(), box.min().z() - back);
  camera.position = camera_from_scene.transpose() * eye;
  return camera;
}

std::vector<Image> render_views(const Scene& scene, const std::vector<Camera>& cameras,
                                const RenderOptions& options, const Progress& progress) {
  options.check();
  PreparedScene prepared = prepare(scene, options.crease_angle);
  if (prepared.all.triangles.empty()) {
    return std::vector<Image>(cameras.size(),
                              Image(options.width, options.height, options.background));
  }
  progress.throw_if_cancelled();
  add_occlusion(prepared, options.occlusion_range, progress);
  const geometry::EmbreeMesh mesh(prepared.all);
  std::vector<Image> images;
  for (const Camera& camera : cameras) {
    progress.throw_if_cancelled();
    images.push_back(render_view(prepared, mesh, camera, options, progress));
  }
  progress.throw_if_cancelled();  // the last picture may be half done
  return images;
}

Image render_scene(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  return std::move(render_views(scene, {camera}, options).front());
}

}  // namespace palmar::report
