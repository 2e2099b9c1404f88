// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/product_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/product/parts/part_place.h"
#include "palmar/product/parts/sdf_mesh_for_test.h"

namespace palmar::product {
namespace {

constexpr double kPartPi = std::numbers::pi;

Product part_product(geometry::TriangleMesh mesh, const std::string& name = "test") {
  Product product;
  product.name = name;
  product.mesh = std::move(mesh);
  return product;
}

Product part_moved(const Product& product, const geometry::Rigid3& motion) {
  Product result = product;
  for (Vec3& p : result.mesh.vertices) p = motion * p;
  return result;
}

Product part_mirrored(const Product& product) {
  Product result = product;
  for (Vec3& p : result.mesh.vertices) p.x() = -p.x();
  for (Triangle& t : result.mesh.triangles) std::swap(t[1], t[2]);
  return result;
}

const geometry::Rigid3 kPartMotion = {
    Quat(Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized())), Vec3(123.0, -45.0, 67.0)};

std::string names_of(const ProductParts& found) {
  std::string names;
  for (const ProductPart& part : found.parts) names += name_of(part.kind) + " ";
  return names;
}

const ProductPart& first_of(const ProductParts& found, PartKind kind) {
  for (const ProductPart& part : found.parts) {
    if (part.kind == kind) return part;
  }
  throw std::runtime_error("no " + name_of(kind) + " among: " + names_of(found));
}

// Cup 80 mm wide and 90 mm high with walls of 4 mm about z; a D-handle of 12 mm on +x whose centre
// line stands 35 mm off the wall between z = 25 and 65: the opening is 35 - 6 = 29 mm wide beyond
// the wall and 40 - 12 = 28 mm high.
Product cup(double spacing) {
  const Sdf outside = sdf_cone(90.0, 40.0, 40.0);
  const Sdf inside = [](const Vec3& p) {
    return std::max(std::hypot(p.x(), p.y()) - 36.0, 5.0 - p.z());
  };
  const Sdf handle =
      sdf_tube({Vec3(38, 0, 25), Vec3(75, 0, 25), Vec3(75, 0, 65), Vec3(38, 0, 65)}, 6.0);
  return part_product(mesh_of(sdf_union(sdf_without(outside, inside), handle),
                              Box3(Vec3(-41, -41, -1), Vec3(82, 41, 91)), spacing),
                      "cup");
}

// A head 44 x 110 x 44 mm across the end of a bar of 28 mm.
Product hammer(double spacing) {
  const Sdf head = sdf_box(Vec3(0, 0, 0), Vec3(44, 110, 44));
  const Sdf handle = sdf_tube({Vec3(0, 0, 0), Vec3(240, 0, 0)}, 14.0);
  return part_product(
      mesh_of(sdf_union(head, handle), Box3(Vec3(-24, -57, -24), Vec3(256, 57, 24)), spacing),
      "hammer");
}

TEST(FindParts, CylinderIsABarOfItsLengthAndGirth) {
  const geometry::TriangleMesh mesh =
      geometry::make_cylinder({.radius = 16.0, .length = 130.0, .segments = 96, .rings = 30});
  const ProductParts found = find_parts(part_product(mesh));
  ASSERT_EQ(found.parts.size(), 1U) << names_of(found);
  const ProductPart& bar = found.parts[0];
  EXPECT_EQ(bar.kind, PartKind::kBar);
  EXPECT_EQ(bar.name, "handle");
  EXPECT_NEAR(bar.length, 130.0, 0.5);                // mm
  EXPECT_NEAR(bar.girth, 2.0 * kPartPi * 16.0, 0.3);  // the polygon is 0.02 % shorter
  EXPECT_NEAR(bar.thickness, 32.0, 0.2);
  EXPECT_GT(bar.straightness, 0.9999);
  EXPECT_FALSE(bar.ends[0].joined || bar.ends[1].joined);
  EXPECT_EQ(found.narrow_tunnels, 0);
  EXPECT_EQ(static_cast<int>(found.part_of_triangle.size()), mesh.triangle_count());
}

TEST(FindParts, TaperedBarHasTheGirthOfEachStation) {
  // Cone from 12 to 20 mm of radius over 140 mm.
  const ProductParts found = find_parts(part_product(
      mesh_of(sdf_cone(140.0, 12.0, 20.0), Box3(Vec3(-21, -21, -1), Vec3(21, 21, 141)), 2.0)));
  ASSERT_EQ(found.parts.size(), 1U) << names_of(found);
  const ProductPart& bar = found.parts[0];
  EXPECT_EQ(bar.kind, PartKind::kBar);
  EXPECT_NEAR(bar.length, 140.0, 1.4);
  const bool is_upwards = bar.line.back().centre.z() > bar.line.front().centre.z();
  for (const PartSection& s : bar.sections) {
    const double t = is_upwards ? s.along : 1.0 - s.along;
    if (t < 0.1 || t > 0.9) continue;  // the lattice rounds the ends' edges
    EXPECT_NEAR(s.girth, 2.0 * kPartPi * (12.0 + 8.0 * t), 0.02 * s.girth) << s.along;
  }
}

TEST(FindParts, BentTubeIsOneBarAlongItsArc) {
  // Quarter of a circle of 100 mm radius: 157 mm of centre line, ends rounded by 10 mm.
  std::vector<Vec3> arc;
  for (int i = 0; i <= 24; ++i) {
    const double t = 0.5 * kPartPi * i / 24;
    arc.push_back({100.0 * std::cos(t), 100.0 * std::sin(t), 0.0});
  }
  const ProductParts found = find_parts(part_product(
      mesh_of(sdf_tube(arc, 10.0), Box3(Vec3(-11, -11, -11), Vec3(111, 111, 11)), 2.0)));
  ASSERT_EQ(found.parts.size(), 1U) << names_of(found);
  const ProductPart& bar = found.parts[0];
  EXPECT_EQ(bar.kind, PartKind::kBar);
  EXPECT_NEAR(bar.length, 50.0 * kPartPi + 20.0, 0.02 * 177.0);
  EXPECT_NEAR(bar.girth, 20.0 * kPartPi, 0.02 * 62.8);
  // Chord of a quarter circle with straight ends of 10 mm: 155.6 mm of 177 mm.
  EXPECT_NEAR(bar.straightness, (100.0 * std::numbers::sqrt2 + 10.0 * std::numbers::sqrt2) / 177.1,
              0.02);
}

TEST(FindParts, TorusIsARingWithItsOpening) {
  const ProductParts found = find_parts(part_product(geometry::make_torus(35.0, 7.0, 120, 40)));
  ASSERT_EQ(found.parts.size(), 1U) << names_of(found);
  const ProductPart& ring = found.parts[0];
  EXPECT_EQ(ring.kind, PartKind::kLoop);
  EXPECT_TRUE(ring.is_ring);
  EXPECT_NEAR(ring.length, 70.0 * kPartPi, 0.01 * 220.0);
  EXPECT_NEAR(ring.girth, 14.0 * kPartPi, 0.01 * 44.0);
  ASSERT_TRUE(ring.opening);
  EXPECT_NEAR(ring.opening->disc, 56.0, 0.3);
  EXPECT_NEAR(ring.opening->width, 56.0, 0.3);
  EXPECT_NEAR(ring.opening->height, 56.0, 0.3);
  EXPECT_NEAR(std::abs(ring.opening->axis.z()), 1.0, 1e-3);
  EXPECT_LT(ring.opening->centre.norm(), 0.3);
  EXPECT_EQ(found.narrow_tunnels, 0);
}

TEST(FindParts, TooNarrowARingIsNoLoop) {
  // 8 mm of opening: no finger goes through.
  const ProductParts found = find_parts(part_product(geometry::make_torus(14.0, 10.0, 80, 40)));
  for (const ProductPart& part : found.parts) EXPECT_NE(part.kind, PartKind::kLoop);
  EXPECT_EQ(found.narrow_tunnels, 1);
}

TEST(FindParts, CupHasABodyAndALoopWithRoomForFingers) {
  const ProductParts found = find_parts(cup(2.0));
  ASSERT_EQ(found.parts.size(), 2U) << names_of(found);
  const ProductPart& body = found.parts[0];
  EXPECT_EQ(body.kind, PartKind::kBody);
  EXPECT_NEAR(body.girth, 80.0 * kPartPi, 0.01 * 251.0);
  EXPECT_NEAR(body.length, 90.0, 1.5);  // its axis leans by up to a degree
  EXPECT_NEAR(std::abs(body.line[0].axis.z()), 1.0, 0.01);
  const ProductPart& loop = found.parts[1];
  EXPECT_EQ(loop.kind, PartKind::kLoop);
  EXPECT_NEAR(loop.girth, 12.0 * kPartPi, 0.03 * 37.7);
  ASSERT_TRUE(loop.opening);
  EXPECT_NEAR(loop.opening->width, 29.0, 0.6);  // mm
  EXPECT_NEAR(loop.opening->height, 28.0, 0.6);
  EXPECT_NEAR(loop.opening->disc, 28.0, 0.6);
  EXPECT_NEAR(std::abs(loop.opening->axis.y()), 1.0, 0.01);
  EXPECT_EQ(loop.ends[0].joined, 1);
  EXPECT_EQ(loop.ends[1].joined, 1);
  EXPECT_EQ(found.narrow_tunnels, 0);
}

TEST(FindParts, PlateBallPenAndBottleAreTold) {
  const ProductParts plate = find_parts(part_product(geometry::make_box(Vec3(140, 70, 9), 30)));
  ASSERT_EQ(plate.parts.size(), 1U) << names_of(plate);
  EXPECT_EQ(plate.parts[0].kind, PartKind::kPlate);
  ASSERT_TRUE(plate.parts[0].face_normal);
  EXPECT_NEAR(std::abs(plate.parts[0].face_normal->z()), 1.0, 1e-6);
  EXPECT_NEAR(plate.parts[0].thickness, 9.0, 0.01);
  EXPECT_NEAR(plate.parts[0].width, 70.0, 0.01);
  EXPECT_NEAR(plate.parts[0].length, 140.0, 0.01);

  const ProductParts ball = find_parts(part_product(geometry::make_icosphere(35.0, 4)));
  ASSERT_EQ(ball.parts.size(), 1U) << names_of(ball);
  EXPECT_EQ(ball.parts[0].kind, PartKind::kBall);
  EXPECT_NEAR(ball.parts[0].length, 70.0, 0.3);

  const ProductParts pen = find_parts(part_product(
      geometry::make_cylinder({.radius = 5.0, .length = 140.0, .segments = 40, .rings = 60})));
  ASSERT_EQ(pen.parts.size(), 1U) << names_of(pen);
  EXPECT_EQ(pen.parts[0].kind, PartKind::kPen);

  // Radius 35 mm with a waist of 30 mm at z = 80 (cosine, 80 mm long), neck of 14 mm from 170 on.
  const Sdf bottle = [](const Vec3& p) {
    const double r = std::hypot(p.x(), p.y());
    double radius = 35.0;
    if (std::abs(p.z() - 80.0) < 40.0) {
      radius -= 2.5 * (1.0 + std::cos(kPartPi * (p.z() - 80.0) / 40.0));
    }
    if (p.z() > 150.0) radius = std::max(14.0, 35.0 - (p.z() - 150.0) * 1.05);
    return std::max({r - radius, -p.z(), p.z() - 200.0});
  };
  const ProductParts found =
      find_parts(part_product(mesh_of(bottle, Box3(Vec3(-36, -36, -1), Vec3(36, 36, 201)), 2.5)));
  const ProductPart& body = first_of(found, PartKind::kBody);
  std::vector<PartWaist> waists;
  for (const PartWaist& w : body.waists) {
    if (!w.is_neck) waists.push_back(w);
  }
  ASSERT_EQ(waists.size(), 1U);
  EXPECT_NEAR(waists[0].girth, 60.0 * kPartPi, 0.02 * 188.0);
  EXPECT_NEAR(point_at(body, {waists[0].along, 0.0, 0.0}).z(), 80.0, 3.0);
}

TEST(FindParts, HammerIsAHeadOnAHandle) {
  const ProductParts found = find_parts(hammer(2.5));
  ASSERT_EQ(found.parts.size(), 2U) << names_of(found);
  const ProductPart& handle = first_of(found, PartKind::kBar);
  EXPECT_EQ(handle.name, "handle");
  EXPECT_NEAR(handle.girth, 28.0 * kPartPi, 0.02 * 88.0);
  // From the head's face at 22 mm to the rounded end at 254 mm.
  EXPECT_NEAR(handle.length, 232.0, 0.02 * 232.0);
  EXPECT_FALSE(handle.ends[0].joined);
  EXPECT_TRUE(handle.ends[1].joined);
  EXPECT_NEAR(handle.ends[0].point.x(), 254.0, 1.5);
}

TEST(FindParts, TeeIsACrossbarAndAStem) {
  // Two bars of 24 mm, 180 and 120 mm long.
  const Sdf tee = sdf_union(sdf_tube({Vec3(-80, 0, 0), Vec3(80, 0, 0)}, 12.0),
                            sdf_tube({Vec3(0, 0, 0), Vec3(0, 120, 0)}, 12.0));
  const ProductParts found =
      find_parts(part_product(mesh_of(tee, Box3(Vec3(-93, -13, -13), Vec3(93, 133, 13)), 2.5)));
  ASSERT_EQ(found.parts.size(), 2U) << names_of(found);
  EXPECT_EQ(found.parts[0].kind, PartKind::kBar);
  EXPECT_EQ(found.parts[1].kind, PartKind::kBar);
  EXPECT_NEAR(found.parts[0].length, 184.0, 4.0);
  EXPECT_EQ(found.parts[1].joined, std::vector<int>{1});
}

TEST(FindParts, PistolHasAHandleOfItsOwn) {
  const Sdf pistol = sdf_union(sdf_tube({Vec3(-70, 0, 0), Vec3(90, 0, 0)}, 30.0),
                               sdf_tube({Vec3(40, 0, 0), Vec3(70, -130, 0)}, 17.0));
  const ProductParts found = find_parts(
      part_product(mesh_of(pistol, Box3(Vec3(-101, -148, -31), Vec3(121, 31, 31)), 3.0)));
  ASSERT_EQ(found.parts.size(), 2U) << names_of(found);
  EXPECT_EQ(found.parts[0].kind, PartKind::kBody);
  EXPECT_EQ(found.parts[1].kind, PartKind::kBar);
  EXPECT_NEAR(found.parts[1].girth, 34.0 * kPartPi, 0.02 * 107.0);
}

// Largest relative difference of two measures of all parts.
void expect_same_parts(const ProductParts& a, const ProductParts& b, double share,
                       const std::string& what) {
  ASSERT_EQ(names_of(a), names_of(b)) << what;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const ProductPart &p = a.parts[i], &q = b.parts[i];
    const std::string which = what + ", part " + std::to_string(p.number);
    EXPECT_EQ(p.name, q.name) << which;
    EXPECT_EQ(p.joined, q.joined) << which;
    EXPECT_NEAR(p.girth, q.girth, share * p.girth) << which;
    EXPECT_NEAR(p.length, q.length, 2.0 * share * p.length) << which;
    EXPECT_NEAR(p.width, q.width, 2.0 * share * p.width) << which;
    EXPECT_NEAR(p.thickness, q.thickness, 2.0 * share * p.thickness) << which;
    ASSERT_EQ(p.opening.has_value(), q.opening.has_value()) << which;
    if (p.opening) {
      EXPECT_NEAR(p.opening->disc, q.opening->disc, share * p.opening->disc) << which;
    }
  }
}

void expect_same_parts_of(Product (*make)(double)) {
  const Product product = make(2.5);
  const ProductParts found = find_parts(product);
  expect_same_parts(found, find_parts(part_moved(product, kPartMotion)), 0.01,
                    product.name + " moved");
  expect_same_parts(found, find_parts(part_mirrored(product)), 0.01, product.name + " mirrored");
  expect_same_parts(found, find_parts(make(1.5)), 0.02, product.name + " with finer triangles");
}

TEST(FindParts, MovedMirroredOrMeshedAnewACupHasTheSameParts) { expect_same_parts_of(cup); }

TEST(FindParts, ThoroughMovedMirroredOrMeshedAnewAHammerHasTheSameParts) {
  expect_same_parts_of(hammer);
}

TEST(FindParts, SameBytesOnAnyNumberOfThreads) {
  const Product product = hammer(3.0);
  const auto text = [&] {
    std::ostringstream out;
    out.precision(17);
    const ProductParts found = find_parts(product);
    for (const ProductPart& p : found.parts) {
      out << p.name << p.length << ' ' << p.girth << ' ' << p.volume << ' ';
      for (const PartStation& s : p.line) out << s.centre.transpose() << s.zero.transpose();
    }
    for (const int label : found.part_of_triangle) out << label;
    return out.str();
  };
  set_thread_count(1);
  const std::string one = text();
  set_thread_count(0);
  EXPECT_EQ(one, text());
}

TEST(PartPlace, PointsReturnFromPartCoordinates) {
  for (const Product& product : {cup(2.5), hammer(3.0)}) {
    for (const ProductPart& part : find_parts(product).parts) {
      for (const double along : {0.2, 0.5, 0.8}) {
        for (const double turn : {-2.0, 0.5}) {
          const PartPlace place = {along, turn, 3.0};
          const PartPlace back = place_of(part, point_at(part, place));
          EXPECT_NEAR(back.along, along, 1e-6);
          EXPECT_NEAR(back.turn, turn, 1e-6);
          EXPECT_NEAR(back.height, 3.0, 1e-6);
        }
      }
    }
  }
}

TEST(PartPlace, APlaceIsFoundAgainOnTheMovedProduct) {
  const Product product = cup(2.5);
  const ProductParts before = find_parts(product),
                     after = find_parts(part_moved(product, kPartMotion));
  ASSERT_EQ(before.parts.size(), 2U);
  ASSERT_EQ(after.parts.size(), 2U);
  const ProductPart &loop = before.parts[1], &loop_after = after.parts[1];
  // The loop is symmetric about the plane between its ends: along may be 1 - along.
  const double turn = 0.4;
  const Vec3 here = kPartMotion * point_at(loop, {0.5, turn, 6.0});
  const Vec3 there = point_at(loop_after, {0.5, turn, 6.0});
  const Vec3 mirrored_there = point_at(loop_after, {0.5, -turn, 6.0});
  EXPECT_LT(std::min((here - there).norm(), (here - mirrored_there).norm()), 1.5);  // mm
}

TEST(FindParts, RefusesOptionsOutOfRangeAndTakesAnEmptyProduct) {
  EXPECT_TRUE(find_parts(Product{}).parts.empty());
  PartOptions options;
  options.finger = 0.0;
  try {
    find_parts(part_product(geometry::make_icosphere(20.0, 2)), options);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("\"finger\""), std::string::npos);
  }
}

// Scans. What people take hold of was written down beforehand (SOURCES.md beside them).
std::filesystem::path scans() {
  std::filesystem::path folder = std::filesystem::path(__FILE__).parent_path();
  for (int i = 0; i < 9; ++i, folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / "shared" / "products"))
      return folder / "shared" / "products";
  }
  return {};
}

Product scan(const std::string& name) {
  geometry::TriangleMesh mesh;
  std::ifstream file(scans() / (name + ".obj"));
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      mesh.vertices.push_back(p);
    } else if (kind == "f") {
      Triangle t{};
      for (int& i : t) {
        std::string word;
        words >> word;
        i = std::stoi(word) - 1;
      }
      mesh.triangles.push_back(t);
    }
  }
  return part_product(std::move(mesh), name);
}

#define SKIP_WITHOUT_SCANS() \
  if (scans().empty()) GTEST_SKIP() << "the scans in ../shared/products are not there"

TEST(PartsOfScans, HandlesAreWherePeopleHoldThem) {
  SKIP_WITHOUT_SCANS();
  struct Handle {
    const char* product;
    int axis;
    double low, high;  // mm along that axis of the file, at least (a drill's up to its trigger)
  };
  for (const Handle& h :
       {Handle{"screwdriver_phillips", 0, 40, 125}, Handle{"rubber_mallet", 0, -140, 35},
        Handle{"cookie_spatula", 0, -115, -25}, Handle{"power_drill", 1, -50, 0}}) {
    const ProductParts found = find_parts(scan(h.product));
    bool is_found = false;
    for (const ProductPart& part : found.parts) {
      if (part.kind != PartKind::kBar || part.name != "handle") continue;
      double low = 1e9, high = -1e9;
      for (const PartStation& s : part.line) {
        low = std::min(low, s.centre[h.axis]);
        high = std::max(high, s.centre[h.axis]);
      }
      is_found = is_found || (low <= h.low && high >= h.high);
    }
    EXPECT_TRUE(is_found) << h.product << ": " << names_of(found);
  }
}

TEST(PartsOfScans, MugHasOneLoopOnItsSide) {
  SKIP_WITHOUT_SCANS();
  const ProductParts found = find_parts(scan("mug"));
  ASSERT_EQ(found.parts.size(), 2U) << names_of(found);
  EXPECT_EQ(found.parts[0].kind, PartKind::kBody);
  const ProductPart& loop = found.parts[1];
  ASSERT_EQ(loop.kind, PartKind::kLoop);
  EXPECT_GT(loop.opening->disc, 25.0);  // mm; two fingers side by side go in
  EXPECT_GT(loop.opening->centre.x(), 35.0);
  EXPECT_NEAR(loop.opening->centre.z(), 55.0, 10.0);
}

TEST(PartsOfScans, WholeThingsAreOnePart) {
  SKIP_WITHOUT_SCANS();
  const std::vector<std::pair<std::string, PartKind>> expected = {
      {"portable_speaker", PartKind::kBody},
      {"portable_drive", PartKind::kPlate},
      {"handheld_console", PartKind::kPlate},
      {"large_marker", PartKind::kPen},
      {"mustard_bottle", PartKind::kBody}};
  for (const auto& [name, kind] : expected) {
    const ProductParts found = find_parts(scan(name));
    ASSERT_EQ(found.parts.size(), 1U) << name << ": " << names_of(found);
    EXPECT_EQ(found.parts[0].kind, kind) << name;
  }
  const ProductParts bottle = find_parts(scan("mustard_bottle"));
  bool has_waist = false, has_neck = false;
  for (const PartWaist& w : bottle.parts[0].waists) {
    const double z = point_at(bottle.parts[0], {w.along, 0.0, 0.0}).z();
    has_waist = has_waist || (!w.is_neck && z > 55.0 && z < 100.0);
    has_neck = has_neck || (w.is_neck && z > 150.0);
  }
  EXPECT_TRUE(has_waist);
  EXPECT_TRUE(has_neck);
}

TEST(PartsOfScans, TunnelsOfTheScrewdriversScanAreNoLoops) {
  SKIP_WITHOUT_SCANS();
  const ProductParts found = find_parts(scan("screwdriver_phillips"));  // Euler number -6
  for (const ProductPart& part : found.parts) EXPECT_NE(part.kind, PartKind::kLoop);
  EXPECT_EQ(found.narrow_tunnels, 4);
}

TEST(PartsOfScans, ThoroughMovedOrMirroredTheyHaveTheSameParts) {
  SKIP_WITHOUT_SCANS();
  for (const char* name : {"mug", "rubber_mallet", "screwdriver_phillips", "power_drill",
                           "cookie_spatula", "portable_drive"}) {
    const Product product = scan(name);
    const ProductParts found = find_parts(product);
    expect_same_parts(found, find_parts(part_moved(product, kPartMotion)), 0.02,
                      std::string(name) + " moved");
    expect_same_parts(found, find_parts(part_mirrored(product)), 0.02,
                      std::string(name) + " mirrored");
  }
}

}  // namespace
}  // namespace palmar::product
