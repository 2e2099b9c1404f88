// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/product.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/product/intake/check.h"
#include "palmar/product/intake/contact_body.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/product/primitives.h"

namespace palmar::product {
namespace {

using testing::HasSubstr;

template <typename ErrorType, typename Function>
std::string message_of(Function function) {
  try {
    function();
  } catch (const ErrorType& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error of the expected kind";
  return "";
}

Box3 box_of(double longest) {
  return Box3(Vec3::Zero(), Vec3(0.3 * longest, longest, 0.2 * longest));
}

const UnitDecision kInMm{geometry::LengthUnit::kMillimetre, UnitSource::kUser, ""};

bool has_note(const Product& product, const std::string& part) {
  for (const std::string& note : product.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(UnitGuard, ProposesTheOnlyUnitThatFitsAHand) {
  const auto propose = [](double longest) {
    return decide_unit(box_of(longest), {}, {}, "cup.stl");
  };
  EXPECT_EQ(propose(120.0).unit, geometry::LengthUnit::kMillimetre);
  EXPECT_EQ(propose(0.12).unit, geometry::LengthUnit::kMetre);
  EXPECT_EQ(propose(2.5).unit, geometry::LengthUnit::kInch);
  EXPECT_EQ(propose(120.0).source, UnitSource::kProposed);
  EXPECT_THAT(propose(0.12).explanation, HasSubstr("36 x 120 x 24 mm"));
  EXPECT_THAT(propose(0.12).explanation, HasSubstr("setting \"unit\""));
}

TEST(UnitGuard, RefusesToGuessBetweenTwoUnits) {
  for (const double longest : {5.0, 10.0, 20.0, 30.0, 1.0, 0.01, 5000.0}) {
    const std::string message =
        message_of<InputError>([&] { decide_unit(box_of(longest), {}, {}, "cup.stl"); });
    EXPECT_THAT(message, HasSubstr("cup.stl"));
    EXPECT_THAT(message, HasSubstr("setting \"unit\""));
  }
  const std::string message =
      message_of<InputError>([] { decide_unit(box_of(5.0), {}, {}, "cup.stl"); });
  EXPECT_THAT(message, HasSubstr("127 mm if inch"));
  EXPECT_THAT(message, HasSubstr("50 mm if cm"));
}

TEST(UnitGuard, UserWinsOverFileAndIsReported) {
  EXPECT_EQ(decide_unit(box_of(5.0), {}, geometry::LengthUnit::kInch, "cup").unit,
            geometry::LengthUnit::kInch);
  EXPECT_EQ(decide_unit(box_of(0.1), geometry::LengthUnit::kMetre, {}, "cup").source,
            UnitSource::kFile);
  const UnitDecision both = decide_unit(box_of(100.0), geometry::LengthUnit::kCentimetre,
                                        geometry::LengthUnit::kMillimetre, "cup");
  EXPECT_EQ(both.unit, geometry::LengthUnit::kMillimetre);
  EXPECT_THAT(both.explanation, HasSubstr("file says cm"));
}

TEST(UnitGuard, RefusesAbsurdSizes) {
  EXPECT_THAT(message_of<InputError>([] {
                decide_unit(box_of(1e9), geometry::LengthUnit::kMillimetre, {}, "cup.3mf");
              }),
              HasSubstr("1e+09"));
  EXPECT_THAT(message_of<InputError>([] { decide_unit(box_of(0.0), {}, {}, "cup.stl"); }),
              HasSubstr("0 x 0 x 0"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of<InputError>(
                  [&] { decide_unit(Box3(Vec3::Zero(), Vec3(1, nan, 1)), {}, {}, "cup.stl"); }),
              HasSubstr("nan"));
  EXPECT_EQ(InputError("").exit_code(), 3);
}

TEST(UnitNames, ReadWhatTheyWrite) {
  for (const geometry::LengthUnit unit :
       {geometry::LengthUnit::kMillimetre, geometry::LengthUnit::kCentimetre,
        geometry::LengthUnit::kMetre, geometry::LengthUnit::kInch}) {
    EXPECT_EQ(geometry::length_unit(name_of(unit)), unit);
  }
  EXPECT_EQ(geometry::length_unit_named("Millimeters"), geometry::LengthUnit::kMillimetre);
  EXPECT_EQ(geometry::length_unit_named("centimetres"), geometry::LengthUnit::kCentimetre);
  EXPECT_EQ(geometry::length_unit_named("meter"), geometry::LengthUnit::kMetre);
  EXPECT_EQ(geometry::length_unit_named("inches"), geometry::LengthUnit::kInch);
  for (const char* other : {"", "kilometre", "et", "meterstick", "mms"}) {
    EXPECT_FALSE(geometry::length_unit_named(other)) << other;
  }
  EXPECT_THAT(message_of<UsageError>([] { geometry::length_unit("furlong"); }),
              HasSubstr("\"furlong\""));
}

TEST(MakeProduct, ConvertsToMillimetres) {
  const geometry::TriangleMesh inches = geometry::make_box(Vec3(1.0, 2.0, 4.0), 2);
  const Product product =
      make_product("box", inches, {geometry::LengthUnit::kInch, UnitSource::kUser, ""}, "box.stl");
  EXPECT_LT((geometry::bounding_box(product.mesh).sizes() - Vec3(25.4, 50.8, 101.6)).norm(), 1e-9);
  EXPECT_NEAR(product.distance->at(Vec3(0, 0, 60)).distance, 60.0 - 50.8, 1e-9);
  EXPECT_EQ(product.unit, geometry::LengthUnit::kInch);
}

TEST(MakeProduct, WeldsTrianglesThatShareNoVertices) {
  // As STL stores them.
  const geometry::TriangleMesh whole = geometry::make_icosphere(30.0, 3);
  geometry::TriangleMesh soup;
  for (const Triangle& t : whole.triangles) {
    const int n = soup.vertex_count();
    for (const int v : t) soup.vertices.push_back(whole.vertices[v].cast<float>().cast<double>());
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  const Product product = make_product("ball", soup, kInMm, "ball.stl");
  EXPECT_EQ(product.mesh.vertex_count(), whole.vertex_count());
  EXPECT_TRUE(geometry::examine_topology(product.mesh).is_closed);
  EXPECT_TRUE(product.notes.empty());
}

TEST(MakeProduct, TurnsAnInvertedMeshAndSaysSo) {
  geometry::TriangleMesh inverted = geometry::make_icosphere(30.0, 3);
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  const Product product = make_product("ball", inverted, kInMm, "ball.stl");
  EXPECT_LT(product.distance->at(Vec3::Zero()).distance, 0.0);
  EXPECT_TRUE(has_note(product, "faced inwards"));
}

TEST(MakeProduct, ReportsThatAMeshIsOpen) {
  const Product product = make_product(
      "tube",
      geometry::make_cylinder({.radius = 20, .length = 100, .rings = 20, .is_capped = false}),
      kInMm, "tube.stl");
  EXPECT_TRUE(has_note(product, "2 holes"));
  EXPECT_LT(product.distance->at(Vec3::Zero()).distance, 0.0);
}

TEST(MakeProduct, NamesWhatIsMissing) {
  EXPECT_THAT(message_of<InputError>([] { make_product("x", {}, kInMm, "x.stl"); }),
              HasSubstr("x.stl: no triangles"));
  geometry::TriangleMesh one;
  one.vertices = {Vec3(0, 0, 0), Vec3(50, 0, 0), Vec3(0, 50, 0)};
  one.triangles = {{0, 1, 2}};
  EXPECT_THAT(message_of<InputError>([&] { make_product("x", one, kInMm, "x.stl"); }),
              HasSubstr("only one triangle"));
  geometry::TriangleMesh bad = geometry::make_box(Vec3(50, 50, 50), 1);
  bad.vertices[4].z() = std::numeric_limits<double>::infinity();
  const std::string message =
      message_of<InputError>([&] { make_product("x", bad, kInMm, "x.stl"); });
  EXPECT_THAT(message, HasSubstr("vertex 4"));
  EXPECT_THAT(message, HasSubstr("inf"));
  geometry::TriangleMesh line;
  line.vertices = {Vec3(0, 0, 0), Vec3(50, 0, 0), Vec3(100, 0, 0), Vec3(70, 0, 0)};
  line.triangles = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_THAT(message_of<InputError>([&] { make_product("x", line, kInMm, "x.stl"); }),
              HasSubstr("no area"));
}

/// Mesh vertices lie on the exact solid, triangle centres within the chordal error of it.
void expect_mesh_on_solid(const Product& product, double chordal_error) {
  const geometry::TopologyReport topology = geometry::examine_topology(product.mesh);
  EXPECT_TRUE(topology.is_closed && topology.is_two_manifold && topology.is_oriented)
      << product.name;
  EXPECT_EQ(topology.euler_number, 2) << product.name;
  EXPECT_GT(geometry::signed_volume(product.mesh), 0.0) << product.name;
  for (const Vec3& x : product.mesh.vertices) {
    ASSERT_NEAR(product.distance->at(x).distance, 0.0, 1e-8) << product.name << x.transpose();
  }
  for (const Triangle& t : product.mesh.triangles) {
    const Vec3 c =
        (product.mesh.vertices[t[0]] + product.mesh.vertices[t[1]] + product.mesh.vertices[t[2]]) /
        3.0;
    const double d = product.distance->at(c).distance;
    ASSERT_LE(d, 1e-9) << product.name;
    ASSERT_GE(d, -chordal_error) << product.name;
  }
}

TEST(Primitives, MeshesLieOnTheExactSolids) {
  expect_mesh_on_solid(make_cylinder_product({}), 0.01);
  expect_mesh_on_solid(make_prism_product({}), 0.01);
  expect_mesh_on_solid(make_prism_product({.fillet_radius = 15.0}), 0.01);
  expect_mesh_on_solid(make_prism_product({.fillet_radius = 0.0}), 0.01);
  expect_mesh_on_solid(make_sphere_product({}), 0.01);
  expect_mesh_on_solid(make_ellipsoid_product({}), 0.01);
  expect_mesh_on_solid(make_plane_product({}), 0.01);
}

TEST(Primitives, VolumesAreThoseOfTheSolids) {
  using std::numbers::pi;
  const auto volume = [](const Product& p) { return geometry::signed_volume(p.mesh); };
  // Chords of 0.01 mm take at most their height times the area away.
  EXPECT_NEAR(volume(make_cylinder_product({.diameter = 48, .length = 100})), pi * 576 * 100,
              0.01 * pi * 48 * 100);
  EXPECT_NEAR(volume(make_sphere_product({.diameter = 60})), pi * 36000, 0.01 * pi * 3600);
  EXPECT_NEAR(volume(make_ellipsoid_product({.diameters = {50, 60, 120}})), pi / 6 * 360000, 250);
  EXPECT_NEAR(
      volume(make_prism_product({.width = 40, .depth = 30, .length = 100, .fillet_radius = 5})),
      100 * (1200 - (4 - pi) * 25), 0.01 * 10 * pi * 100);
  EXPECT_NEAR(volume(make_plane_product({.width = 100, .depth = 80, .thickness = 10})), 80000,
              1e-6);
}

TEST(Primitives, OptionsNameWhatIsWrong) {
  EXPECT_THAT(message_of<UsageError>([] { make_cylinder_product({.diameter = 0.0}); }),
              HasSubstr("diameter is 0"));
  EXPECT_THAT(message_of<UsageError>([] { make_sphere_product({.diameter = 1e9}); }),
              HasSubstr("1e+09"));
  EXPECT_THROW(make_prism_product({.width = 40, .depth = 8, .fillet_radius = 5}), UsageError);
}

TEST(CheckMesh, FindsNothingOnACleanSolid) {
  const ProductCheck check = check_product(make_cylinder_product({}));
  EXPECT_EQ(check.verdict, Severity::kOk);
  EXPECT_TRUE(check.is_closed);
  EXPECT_EQ(check.euler_number, 2);
  EXPECT_EQ(check.parts, 1);
  EXPECT_NEAR(check.size.z(), 150.0, 1e-9);
  EXPECT_FALSE(check.is_too_big || check.is_too_small || check.is_inverted);
}

TEST(CheckMesh, CountsHolesFlipsAndParts) {
  geometry::TriangleMesh mesh = geometry::make_icosphere(30.0, 3);
  mesh.triangles.erase(mesh.triangles.begin() + 100);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  const geometry::TriangleMesh dust = geometry::make_icosphere(0.1, 0);
  const int n = mesh.vertex_count();
  for (const Vec3& x : dust.vertices) mesh.vertices.push_back(x + Vec3(40, 0, 0));
  for (const Triangle& t : dust.triangles) {
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const ProductCheck check = check_mesh(mesh);
  EXPECT_FALSE(check.is_closed);
  EXPECT_EQ(check.holes, 1);
  EXPECT_EQ(check.boundary_edges, 3);
  EXPECT_EQ(check.flipped_triangles, 1);
  EXPECT_EQ(check.parts, 2);
  EXPECT_EQ(check.tiny_parts, 1);
  EXPECT_EQ(check.verdict, Severity::kWarning);
}

TEST(CheckMesh, SeesCrossingAndInversion) {
  geometry::TriangleMesh mesh = geometry::make_icosphere(20.0, 2);
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(check_mesh(mesh).is_inverted);

  geometry::TriangleMesh two = geometry::make_icosphere(20.0, 2);
  const geometry::TriangleMesh other = two;
  for (const Vec3& x : other.vertices) two.vertices.push_back(x + Vec3(15.3, 1.7, 0.4));
  for (const Triangle& t : other.triangles) {
    two.triangles.push_back(
        {t[0] + other.vertex_count(), t[1] + other.vertex_count(), t[2] + other.vertex_count()});
  }
  EXPECT_GT(check_mesh(two).crossing_pairs, 0);
}

TEST(CheckMesh, ASolidWithoutVolumeIsAnError) {
  // A sheet of 60 x 40 mm with two sides and nothing between them.
  geometry::TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {60, 0, 0}, {60, 40, 0}, {0, 40, 0}, {30, 20, 0}, {30, 20, 1e-4}};
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 3}, {3, 0}}) {
    sheet.triangles.push_back({a, b, 5});
    sheet.triangles.push_back({b, a, 4});
  }
  const ProductCheck check = check_mesh(sheet);
  EXPECT_TRUE(check.is_closed);
  EXPECT_EQ(check.verdict, Severity::kError);
}

TEST(CheckMesh, HoldsTheSizeAgainstAHand) {
  EXPECT_TRUE(check_product(make_sphere_product({.diameter = 300.0})).is_too_big);
  EXPECT_TRUE(check_product(make_cylinder_product({.diameter = 2.0})).is_too_small);
  EXPECT_FALSE(check_product(make_cylinder_product({.diameter = 100.0})).is_too_big);
  EXPECT_EQ(check_mesh({}).verdict, Severity::kError);
}

/// Vertices and triangles of an OBJ file, nothing else; the real reader stands in a later module.
geometry::TriangleMesh read_plain_obj(const std::filesystem::path& path) {
  geometry::TriangleMesh mesh;
  std::ifstream file(path);
  for (std::string line, kind; std::getline(file, line);) {
    std::istringstream words(line);
    words >> kind;
    if (kind == "v") {
      Vec3 x;
      words >> x.x() >> x.y() >> x.z();
      mesh.vertices.push_back(x);
    } else if (kind == "f") {
      Triangle t;
      std::string word;
      for (int& corner : t) {
        words >> word;
        corner = std::stoi(word) - 1;
      }
      mesh.triangles.push_back(t);
    }
    kind.clear();
  }
  return mesh;
}

TEST(ScannedProducts, BecomeProductsWithRightSigns) {
  const std::filesystem::path folder = std::string(PALMAR_SHARED_DIR) + "/products";
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "the ten scanned products (shared/products) aren't here";
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".obj") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files.size(), 10u);
  for (const auto& path : files) {
    const geometry::TriangleMesh raw = read_plain_obj(path);
    const UnitDecision unit =
        decide_unit(geometry::bounding_box(raw), {}, {}, path.filename().string());
    EXPECT_EQ(unit.unit, geometry::LengthUnit::kMillimetre);  // the headers say so
    const Product product = make_product(path.stem().string(), raw, unit, path.string());
    const auto& field = dynamic_cast<const geometry::MeshDistance&>(*product.distance);
    std::mt19937 generator(1);
    const Box3 box = field.bounding_box();
    int inside = 0;
    const int count = 4000;
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
      Vec3 u;
      for (int k = 0; k < 3; ++k) u[k] = static_cast<double>(generator()) / 4294967296.0;
      points.push_back(box.min() + u.cwiseProduct(box.sizes()));
    }
    std::vector<geometry::DistanceSample> samples(points.size());
    field.sample(points, std::numeric_limits<double>::infinity(), samples);
    for (std::size_t i = 0; i < points.size(); ++i) {
      inside += samples[i].distance < 0.0 ? 1 : 0;
      // Signs carried over from neighbours agree with the winding number of each point.
      if (std::abs(samples[i].distance) > 0.01) {
        ASSERT_EQ(samples[i].distance<0.0, field.winding_number(points[i])> 0.5)
            << path << points[i].transpose();
      }
    }
    // Volume by counting against volume by the divergence theorem; 4000 points give 3 standard
    // deviations of at most 2.4 % of the box.
    const double share = static_cast<double>(inside) / count;
    // The inside of the mug counts as solid.
    const geometry::TriangleMesh body = contact_body(product.mesh).mesh;
    const double filled = geometry::signed_volume(body) / geometry::signed_volume(product.mesh);
    EXPECT_GT(filled, path.stem() == "mug" ? 1.5 : 0.99) << path;
    EXPECT_NEAR(share, geometry::signed_volume(body) / box.volume(), 0.03) << path;
    EXPECT_FALSE(check_product(product).is_too_small) << path;
  }
}

}  // namespace
}  // namespace palmar::product
