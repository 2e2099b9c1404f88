// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/geometry/repair/weld.h"
#include "palmar/product/primitives.h"

namespace palmar::product {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double kPi = std::numbers::pi;

template <typename ErrorType, typename Function>
std::string repair_message(Function function) {
  try {
    function();
  } catch (const ErrorType& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error of the expected kind";
  return "";
}

std::string text_of(const std::vector<RepairAction>& actions) {
  std::string text;
  for (const RepairAction& action : actions) text += action.name + ": " + action.text + "\n";
  return text;
}

const RepairAction* find(const std::vector<RepairAction>& actions, const std::string& name) {
  for (const RepairAction& action : actions) {
    if (action.name == name) return &action;
  }
  return nullptr;
}

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& other, const Vec3& shift) {
  const int n = mesh.vertex_count();
  for (const Vec3& x : other.vertices) mesh.vertices.push_back(x + shift);
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
}

/// Takes out the triangles round `count` corners that share no triangle with each other.
int punch(geometry::TriangleMesh& mesh, int count, std::mt19937& random) {
  std::vector<bool> is_near(mesh.vertices.size(), false);
  std::vector<bool> is_gone(mesh.triangles.size(), false);
  const geometry::MeshTopology topology = geometry::build_topology(mesh);
  int punched = 0;
  for (int attempt = 0; attempt < 100 * count && punched < count; ++attempt) {
    const int v = static_cast<int>(random() % mesh.vertices.size());
    std::vector<int> ring;
    for (const int h : topology.outgoing(v)) {
      for (const int w : mesh.triangles[h / 3]) ring.push_back(w);
    }
    if (std::any_of(ring.begin(), ring.end(), [&](int w) { return is_near[w]; })) continue;
    for (const int w : ring) is_near[w] = true;
    for (const int h : topology.outgoing(v)) is_gone[h / 3] = true;
    ++punched;
  }
  std::vector<Triangle> kept;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (!is_gone[t]) kept.push_back(mesh.triangles[t]);
  }
  mesh.triangles = std::move(kept);
  return punched;
}

void flip_and_double(geometry::TriangleMesh& mesh, std::mt19937& random) {
  const int count = mesh.triangle_count();
  for (int t = 0; t < count; ++t) {
    if (random() % 10 == 0) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    if (random() % 20 == 0) mesh.triangles.push_back(mesh.triangles[t]);
  }
}

/// Every triangle with corners of its own, as STL has them.
geometry::TriangleMesh repair_soup(const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const int n = soup.vertex_count();
    for (const int v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

geometry::TriangleMesh read_obj(const std::filesystem::path& path) {
  geometry::TriangleMesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      Vec3 x;
      words >> x.x() >> x.y() >> x.z();
      mesh.vertices.push_back(x);
    } else if (key == "f") {
      Triangle t{};
      for (int& v : t) {
        words >> key;
        v = std::stoi(key) - 1;
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

TEST(Repair, OfGoodMeshesChangesNothing) {
  for (const geometry::TriangleMesh& mesh :
       {make_cylinder_product({}).mesh, make_prism_product({}).mesh,
        geometry::make_torus(30, 8, 48, 24), geometry::make_box(Vec3(40, 30, 100)),
        geometry::make_icosphere(25, 4)}) {
    const RepairResult repaired = repair_mesh(mesh);
    EXPECT_FALSE(repaired.has_changed()) << text_of(repaired.done);
    EXPECT_TRUE(repaired.left.empty()) << text_of(repaired.left);
    EXPECT_EQ(repaired.mesh.triangles, mesh.triangles);
    EXPECT_EQ(repaired.mesh.vertices, mesh.vertices);
    EXPECT_TRUE(fix_list(check_mesh(mesh), repaired.limits).empty());
  }
}

TEST(Repair, OfARuinedBallIsABall) {
  std::mt19937 random(7);
  const geometry::TriangleMesh ball = geometry::make_icosphere(30, 4);
  geometry::TriangleMesh ruined = ball;
  ASSERT_EQ(punch(ruined, 25, random), 25);
  flip_and_double(ruined, random);
  ruined = repair_soup(ruined);
  for (int i = 0; i < 5; ++i)
    append(ruined, geometry::make_icosphere(0.2, 1), Vec3(33.0, 3.0 * i, 0));
  const ProductCheck before = check_mesh(ruined);
  EXPECT_GE(before.verdict, Severity::kWarning);
  const RepairResult repaired = repair_mesh(ruined);
  EXPECT_TRUE(repaired.left.empty()) << text_of(repaired.left);
  ASSERT_TRUE(find(repaired.done, "holes"));
  EXPECT_EQ(find(repaired.done, "holes")->count, 25);
  EXPECT_EQ(find(repaired.done, "specks")->count, 5);
  ASSERT_TRUE(find(repaired.done, "duplicates"));
  ASSERT_TRUE(find(repaired.done, "orientation"));
  const ProductCheck after = check_mesh(repaired.mesh);
  EXPECT_EQ(after.verdict, Severity::kOk);
  EXPECT_TRUE(after.is_closed);
  EXPECT_EQ(after.euler_number, 2);
  EXPECT_NEAR(after.volume, geometry::signed_volume(ball), 0.01 * geometry::signed_volume(ball));
  // Repaired again, nothing happens.
  const RepairResult again = repair_mesh(repaired.mesh);
  EXPECT_FALSE(again.has_changed()) << text_of(again.done);
  EXPECT_EQ(again.mesh.triangles, repaired.mesh.triangles);
  EXPECT_EQ(again.mesh.vertices, repaired.mesh.vertices);
}

TEST(Repair, IsTheSameEveryTime) {
  std::mt19937 random(3);
  geometry::TriangleMesh ruined = geometry::make_torus(30, 10, 60, 30);
  punch(ruined, 10, random);
  flip_and_double(ruined, random);
  EXPECT_EQ(repair_mesh(ruined).mesh.vertices, repair_mesh(ruined).mesh.vertices);
  EXPECT_EQ(repair_mesh(ruined).mesh.triangles, repair_mesh(ruined).mesh.triangles);
}

TEST(Repair, AnOpeningIsNoHole) {
  // A cup: the cylinder's upper lid is missing.
  geometry::TriangleMesh cup = geometry::make_cylinder({.radius = 40, .length = 90});
  std::erase_if(cup.triangles, [&](const Triangle& t) {
    return cup.vertices[t[0]].z() > 44.9 && cup.vertices[t[1]].z() > 44.9 &&
           cup.vertices[t[2]].z() > 44.9;
  });
  const RepairResult repaired = repair_mesh(cup);
  ASSERT_EQ(repaired.left.size(), 1u);
  EXPECT_THAT(repaired.left[0].text, HasSubstr("mm are filled"));
  EXPECT_THAT(repaired.left[0].text, HasSubstr("(0.0, 0.0, 45.0) mm"));
  EXPECT_GE(check_mesh(repaired.mesh).verdict, Severity::kWarning);
  const auto fixes = fix_list(check_mesh(cup), repaired.limits);
  ASSERT_EQ(fixes.size(), 1u);
  EXPECT_THAT(fixes[0], HasSubstr("--hole-mm 252"));  // 2 pi 40 = 251.3
  // Asked for, it is closed.
  const ProductCheck closed = check_mesh(repair_mesh(cup, {.hole = 260.0}).mesh);
  EXPECT_TRUE(closed.is_closed);
  EXPECT_EQ(closed.euler_number, 2);
}

TEST(Repair, ACrackIsClosed) {
  // Two halves of a box whose faces were cut differently: corners of one lie on edges of the other.
  geometry::TriangleMesh box = geometry::make_box(Vec3(40, 40, 40), 4);
  // Each triangle with a corner on the upper edge at x = 20 gets another one in the edge's middle.
  const int count = box.triangle_count();
  for (int t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) {
      const Triangle old = box.triangles[t];
      const Vec3 a = box.vertices[old[k]], b = box.vertices[old[(k + 1) % 3]];
      const bool is_on_top =
          box.vertices[old[(k + 2) % 3]].z() == 20.0 && a.z() == 20.0 && b.z() == 20.0;
      if (!is_on_top || a.x() != 20.0 || b.x() != 20.0) continue;
      box.vertices.push_back((a + b) / 2.0);
      const int m = box.vertex_count() - 1;
      box.triangles[t] = {old[k], m, old[(k + 2) % 3]};
      box.triangles.push_back({m, old[(k + 1) % 3], old[(k + 2) % 3]});
      break;
    }
  }
  ASSERT_EQ(check_mesh(box).hole_perimeters.size(), 4u);
  const RepairResult repaired = repair_mesh(box);
  const ProductCheck after = check_mesh(repaired.mesh);
  EXPECT_TRUE(after.is_closed) << text_of(repaired.left);
  EXPECT_EQ(after.low_triangles, 0);
  EXPECT_EQ(after.euler_number, 2);
  EXPECT_NEAR(after.volume, 64000.0, 1e-6);
}

TEST(Repair, TakesApartCubesThatTouchAndDropsAFin) {
  geometry::TriangleMesh cubes = geometry::make_box(Vec3(20, 20, 20), 4);
  append(cubes, geometry::make_box(Vec3(20, 20, 20), 4), Vec3(20, 20, 0));
  // A fin: one small triangle on an edge.
  cubes = geometry::weld(cubes, {.tolerance = 1e-9}).mesh;
  const Triangle first = cubes.triangles[0];
  const Vec3 middle = (cubes.vertices[first[0]] + cubes.vertices[first[1]]) / 2.0;
  cubes.vertices.push_back(1.1 * middle);
  cubes.triangles.push_back({first[0], first[1], cubes.vertex_count() - 1});
  ASSERT_EQ(check_mesh(cubes).non_manifold_edges, 5);
  const RepairOptions options{.speck = 8.0};
  const RepairResult repaired = repair_mesh(cubes, options);
  EXPECT_TRUE(find(repaired.done, "fins")) << text_of(repaired.done);
  EXPECT_TRUE(find(repaired.done, "touching")) << text_of(repaired.done);
  const ProductCheck after = check_mesh(repaired.mesh);
  EXPECT_EQ(after.non_manifold_edges, 0);
  EXPECT_EQ(after.parts, 2);
  EXPECT_NEAR(after.volume, 16000.0, 1.0);
  EXPECT_FALSE(repair_mesh(repaired.mesh, options).has_changed());
}

TEST(Repair, ReportsWhatGoesThroughItself) {
  geometry::TriangleMesh balls = geometry::make_icosphere(20, 3);
  append(balls, geometry::make_icosphere(20, 3), Vec3(25, 1, 2));
  const RepairResult repaired = repair_mesh(balls);
  EXPECT_FALSE(repaired.has_changed());
  ASSERT_TRUE(find(repaired.left, "crossings"));
  EXPECT_EQ(find(repaired.left, "crossings")->count,
            static_cast<int>(geometry::find_self_crossings(balls).size()));
}

TEST(Repair, AsksOnlySeveralBodiesToBeUnited) {
  geometry::TriangleMesh balls = geometry::make_icosphere(20, 3);
  append(balls, geometry::make_icosphere(20, 3), Vec3(25, 1, 2));
  const RepairLimits limits = repair_mesh(balls).limits;
  EXPECT_THAT(fix_list(check_mesh(balls), limits), Contains(HasSubstr("unite the solids")));
  // One that goes through itself: a corner drawn out through the other side.
  geometry::TriangleMesh ball = geometry::make_icosphere(20, 3);
  ball.vertices.front() *= -1.5;
  const ProductCheck check = check_mesh(ball);
  ASSERT_GT(check.crossing_pairs, 0);
  ASSERT_EQ(check.parts, 1);
  EXPECT_THAT(fix_list(check, limits), Not(Contains(HasSubstr("unite"))));
}

TEST(Repair, NamesWhatCannotBe) {
  geometry::TriangleMesh ball = geometry::make_icosphere(30, 2);
  EXPECT_THAT(repair_message<UsageError>([&] { repair_mesh(ball, {.weld = -1.0}); }),
              HasSubstr("the weld's tolerance is -1 mm"));
  EXPECT_THAT(repair_message<UsageError>([&] { repair_mesh(ball, {.weld = 30.0}); }),
              HasSubstr("up to 5.1"));
  EXPECT_THAT(repair_message<UsageError>([&] { repair_mesh(ball, {.hole = std::nan("")}); }),
              HasSubstr("the longest hole is nan mm"));
  EXPECT_THAT(repair_message<UsageError>([&] { repair_mesh(ball, {.speck = 1e9}); }),
              HasSubstr("the largest speck is 1e+09 mm"));
  ball.vertices[5].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(repair_message<InputError>([&] { repair_mesh(ball); }), HasSubstr("vertex 5"));
  EXPECT_THAT(repair_message<InputError>([&] {
                repair_mesh({{Vec3::Zero()}, {{0, 0, 7}}});
              }),
              HasSubstr("triangle 0 names vertex 7"));
  EXPECT_THROW(repair_mesh({}), InputError);
  EXPECT_THROW(repair_mesh({{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, {{0, 1, 2}}}), InputError);
}

TEST(Repair, OfRealProductsBringsBackTheirVolume) {
  const std::filesystem::path folder = std::string(PALMAR_SHARED_DIR) + "/products";
  if (!std::filesystem::exists(folder / "mug.obj")) {
    GTEST_SKIP() << "the ten scanned products (shared/products) aren't here";
  }
  // Volumes of the files; the mug and the marker have a tunnel each (handle, clip).
  for (const std::string name : {"mug", "large_marker", "mustard_bottle", "rubber_mallet"}) {
    const geometry::TriangleMesh whole = read_obj(folder / (name + ".obj"));
    ASSERT_FALSE(repair_mesh(whole).has_changed()) << name;
    for (unsigned seed = 1; seed <= 2; ++seed) {
      std::mt19937 random(seed);
      geometry::TriangleMesh ruined = whole;
      punch(ruined, 8, random);
      flip_and_double(ruined, random);
      const RepairResult repaired = repair_mesh(repair_soup(ruined), {.hole = 100.0});
      const ProductCheck after = check_mesh(repaired.mesh);
      EXPECT_TRUE(after.is_closed) << name << "\n" << text_of(repaired.left);
      EXPECT_EQ(after.euler_number, geometry::examine_topology(whole).euler_number) << name;
      EXPECT_NEAR(after.volume, geometry::signed_volume(whole),
                  0.01 * geometry::signed_volume(whole))
          << name;
      EXPECT_FALSE(repair_mesh(repaired.mesh, {.hole = 100.0}).has_changed()) << name;
    }
  }
}

TEST(Repair, OfAnythingEndsAndStaysAsItIs) {
  std::mt19937 random(11);
  const geometry::TriangleMesh base = geometry::make_torus(20, 8, 14, 8);
  int unsettled = 0;
  std::string last;
  for (int round = 0; round < 300; ++round) {
    geometry::TriangleMesh mesh = base;
    for (int change = static_cast<int>(random() % 12); change >= 0; --change) {
      const std::size_t t = random() % mesh.triangles.size();
      const std::size_t v = random() % mesh.vertices.size();
      switch (random() % 8) {
        case 0:
          mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
          break;
        case 1:
          mesh.triangles[t][random() % 3] = static_cast<int>(v);
          break;
        case 2:
          mesh.vertices[v] = mesh.vertices[random() % mesh.vertices.size()];
          break;
        case 3:
          mesh.vertices[v] *= 0.1 * static_cast<double>(random() % 30);
          break;
        case 4:
          std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
          break;
        case 5:
          mesh.triangles.push_back(mesh.triangles[t]);
          break;
        case 6:
          mesh.triangles.push_back({static_cast<int>(v),
                                    static_cast<int>(random() % mesh.vertices.size()),
                                    static_cast<int>(random() % mesh.vertices.size())});
          break;
        default:
          punch(mesh, 1, random);
      }
    }
    const RepairResult repaired = repair_mesh(mesh);
    ASSERT_TRUE(std::all_of(repaired.mesh.vertices.begin(), repaired.mesh.vertices.end(),
                            [](const Vec3& x) { return x.allFinite(); }));
    // No crossing that wasn't there.
    if (geometry::find_self_crossings(
            geometry::weld(mesh, {.tolerance = repaired.limits.weld}).mesh)
            .empty()) {
      EXPECT_TRUE(geometry::find_self_crossings(repaired.mesh).empty()) << round << "\n"
                                                                        << text_of(repaired.done);
    }
    // A second run may only find what the first one brought together.
    const RepairResult again = repair_mesh(repaired.mesh);
    if (again.has_changed()) {
      ++unsettled;
      last = text_of(repaired.done) + "then\n" + text_of(again.done);
    }
  }
  EXPECT_LE(unsettled, 2) << last;
}

}  // namespace
}  // namespace palmar::product
