// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/report/picture/shading_normals.h"

namespace palmar::report {
namespace {

constexpr Rgb kRed{200, 40, 30};
constexpr Rgb kBlue{30, 60, 200};

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

// Looks along -z at a square of 100 mm about the origin.
Camera front_camera() {
  return {.position = {0, 0, 200},
          .direction = -Vec3::UnitZ(),
          .up = Vec3::UnitY(),
          .view_height = 100.0};
}

RenderOptions small(int side = 200) {
  return {.width = side, .height = side, .occlusion_range = 0.0};
}

int not_white(const Image& image) {
  return static_cast<int>(std::count_if(image.pixels.begin(), image.pixels.end(),
                                        [](Rgb c) { return !(c == kWhite); }));
}

TEST(RenderScene, SphereCoversTheAreaOfItsSilhouette) {
  const Scene scene{{.mesh = geometry::make_icosphere(30.0, 4), .colour = kRed}};
  const Image image = render_scene(scene, front_camera(), small(400));
  // A disc of radius 30 mm at 4 pixels per mm; half a ring of border pixels counts as covered.
  const double radius = 30.0 * 4.0;
  const double disc = std::numbers::pi * radius * radius;
  EXPECT_NEAR(not_white(image), disc, 2.0 * std::numbers::pi * radius);
  EXPECT_EQ(image.at(0, 0), kWhite);
}

TEST(RenderScene, SurfaceThatFacesTheEyeShowsItsOwnColour) {
  const Scene scene{{.mesh = geometry::make_box({40, 40, 40}), .colour = kRed}};
  const Image image = render_scene(scene, front_camera(), small());
  const Rgb middle = image.at(100, 100);
  EXPECT_NEAR(middle.r, kRed.r, 1);
  EXPECT_NEAR(middle.g, kRed.g, 1);
  EXPECT_NEAR(middle.b, kRed.b, 1);
}

TEST(RenderScene, FieldShowsItsMapAndNothingWhereItIsZero) {
  geometry::TriangleMesh patch = moved(geometry::make_grid_patch(2, 1, 40.0), {-40, -20, 0});
  std::vector<double> field;
  for (const Vec3& v : patch.vertices) field.push_back(v.x() > 1.0 ? 0.4 : 0.0);
  const Scene scene{{.mesh = patch, .colour = kBlue, .field = field, .field_upper = 0.4}};
  const Image image = render_scene(scene, front_camera(), small());
  EXPECT_NEAR(image.at(60, 100).b, kBlue.b, 1);  // left half: no field
  const Rgb half = colour_table(Colormap::kEmber)[128];
  const Rgb shown = image.at(140, 100);  // 20 mm right of the middle: half the upper end
  EXPECT_NEAR(shown.r, half.r, 6);
  EXPECT_NEAR(shown.g, half.g, 6);
}

TEST(RenderScene, NearerBodyHidesTheOneBehindIt) {
  const geometry::TriangleMesh box = geometry::make_box({30, 30, 2});
  const Scene scene{{.mesh = moved(box, {0, 0, -20}), .colour = kBlue},
                    {.mesh = moved(box, {0, 0, 20}), .colour = kRed}};
  EXPECT_NEAR(render_scene(scene, front_camera(), small()).at(100, 100).r, kRed.r, 1);
  Camera behind = front_camera();
  behind.position.z() = -200;
  behind.direction = Vec3::UnitZ();
  EXPECT_NEAR(render_scene(scene, behind, small()).at(100, 100).b, kBlue.b, 1);
}

TEST(RenderScene, TranslucentBodyLetsTheOneBehindShine) {
  const geometry::TriangleMesh box = geometry::make_box({30, 30, 2});
  Scene scene{{.mesh = moved(box, {0, 0, -20}), .colour = {0, 0, 0}},
              {.mesh = moved(box, {0, 0, 20}), .colour = {255, 255, 255}, .opacity = 0.5}};
  const Rgb c = render_scene(scene, front_camera(), small()).at(100, 100);
  EXPECT_NEAR(c.r, 188, 2);  // half of the light: sRGB 0.5 linear is 188
}

TEST(RenderScene, PerspectiveShowsWhatIsNearLarger) {
  const auto covered = [](double z) {
    const Scene scene{{.mesh = moved(geometry::make_box({20, 20, 1}), {0, 0, z}), .colour = kRed}};
    Camera camera = front_camera();
    camera.is_orthographic = false;
    return not_white(render_scene(scene, camera, small()));
  };
  // Distances from the eye to the front faces: 99.5 and 199.5 mm; the area goes with the square.
  EXPECT_NEAR(static_cast<double>(covered(100.0)) / covered(0.0), std::pow(199.5 / 99.5, 2), 0.25);
}

TEST(RenderScene, SameBytesOnAnyNumberOfThreads) {
  const Scene scene{{.mesh = geometry::make_torus(25, 10, 40, 20), .colour = kRed},
                    {.mesh = geometry::make_icosphere(20, 3), .colour = kBlue, .opacity = 0.4}};
  const RenderOptions options{.width = 160, .height = 120};
  set_thread_count(1);
  const Image one = render_scene(scene, front_camera(), options);
  set_thread_count(4);
  const Image four = render_scene(scene, front_camera(), options);
  set_thread_count(0);
  EXPECT_EQ(one.pixels, four.pixels);
}

TEST(RenderScene, PointCloseToAWallIsDarker) {
  // A ball 1 mm above a finely cut floor takes ambient light from under it.
  const geometry::TriangleMesh floor = moved(geometry::make_grid_patch(40, 40, 2.0), {-40, -40, 0});
  Scene scene{{.mesh = floor, .colour = {180, 180, 180}}};
  const RenderOptions options{.width = 200, .height = 200, .occlusion_range = 18.0};
  const int free = render_scene(scene, front_camera(), options).at(100, 140).r;
  scene.push_back({.mesh = moved(geometry::make_icosphere(12, 3), {0, 0, 13}), .colour = kRed});
  const int near = render_scene(scene, front_camera(), options).at(100, 128).r;
  EXPECT_LT(near, free - 4);
}

TEST(RenderScene, EmptySceneIsBackground) {
  EXPECT_EQ(not_white(render_scene({}, front_camera(), small(32))), 0);
}

TEST(RenderScene, NamesWhatIsWrongWithAScene) {
  const auto message = [](const Scene& scene) -> std::string {
    try {
      render_scene(scene, front_camera(), small(32));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "nothing";
  };
  const geometry::TriangleMesh box = geometry::make_box({1, 1, 1});
  EXPECT_THAT(message({{.mesh = box, .vertex_colours = {kRed}}}),
              testing::HasSubstr("1 vertex colours for 8 vertices"));
  EXPECT_THAT(message({{.mesh = box, .opacity = 0.0}}), testing::HasSubstr("opacity is 0"));
  EXPECT_THAT(message({{.mesh = {{Vec3::Zero()}, {{0, 1, 2}}}}}),
              testing::HasSubstr("vertex 1 of 1"));
  EXPECT_THROW(render_scene({}, front_camera(), {.width = 0, .height = 10}), UsageError);
}

TEST(FitCamera, ShowsTheWholeSceneWithItsMargin) {
  const Scene scene{{.mesh = geometry::make_box({50, 20, 30}), .colour = kRed}};
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(1, -1, 0.5), Vec3(-1, 0.2, 0)}) {
    const Camera camera =
        fit_camera(scene, direction, Vec3::UnitZ() + 0.01 * Vec3::UnitX(), {.aspect = 1.5});
    const Image image =
        render_scene(scene, camera, {.width = 150, .height = 100, .occlusion_range = 0.0});
    EXPECT_GT(not_white(image), 500);
    for (int x = 0; x < image.width; ++x) {
      EXPECT_EQ(image.at(x, 2), kWhite);
      EXPECT_EQ(image.at(x, 97), kWhite);
    }
    for (int y = 0; y < image.height; ++y) {
      EXPECT_EQ(image.at(2, y), kWhite);
      EXPECT_EQ(image.at(147, y), kWhite);
    }
  }
  EXPECT_THROW(fit_camera({}, -Vec3::UnitZ(), Vec3::UnitY()), UsageError);
  EXPECT_THROW(fit_camera(scene, Vec3::UnitZ(), Vec3::UnitZ()), UsageError);
}

TEST(ShadingNormals, SphereGetsRadialNormalsAndABoxKeepsItsEdges) {
  const geometry::TriangleMesh sphere = geometry::make_icosphere(10.0, 3);
  const auto smooth = shading_normals(sphere, 0.8);
  for (std::size_t t = 0; t < smooth.size(); ++t) {
    const Vec3 radial =
        sphere.vertices[static_cast<std::size_t>(sphere.triangles[t][0])].normalized();
    EXPECT_GT(smooth[t][0].dot(radial), 0.999);
  }
  for (const auto& corners : shading_normals(geometry::make_box({1, 2, 3}), 0.8)) {
    EXPECT_NEAR(corners[0].cwiseAbs().maxCoeff(), 1.0, 1e-12);
    EXPECT_EQ(corners[0], corners[1]);
  }
}

}  // namespace
}  // namespace palmar::report
