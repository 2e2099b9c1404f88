// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/face_contacts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/product/primitives.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/study/statistics/study_test_results.h"
#include "palmar/study/study_record.h"
#include "palmar/study/study_task.h"

namespace palmar::study {
namespace {

using testing::held;
using testing::not_held;
using testing::study_of;

product::Product prism() {
  return product::make_prism_product(
      {.width = 40, .depth = 30, .length = 150, .fillet_radius = 3, .fineness = {}});
}

/// A pressure per vertex of a product's map.
template <class Pressure>
std::vector<double> field_on(const ProductMap& map, const Pressure& pressure) {
  std::vector<double> field;
  for (const Vec3& x : map.mesh.vertices) field.push_back(pressure(x));
  return field;
}

/// Hertz' paraboloid-like press of a ball: round `centre`, 0 outside of `radius`, mm.
auto ball_at(const Vec3& centre, double radius, double peak) {
  return [=](const Vec3& x) {
    const double r = (x - centre).norm() / radius;
    return r < 1.0 ? peak * (1.0 - r * r) : 0.0;
  };
}

struct Totals {
  double force = 0.0, area = 0.0;
};

/// Integrals over the whole map, triangle by triangle, without faces.
Totals totals_of(const ProductMap& map, const std::vector<double>& field) {
  Totals totals;
  for (const Triangle& t : map.mesh.triangles) {
    const double area = 0.5 * (map.mesh.vertices[t[1]] - map.mesh.vertices[t[0]])
                                  .cross(map.mesh.vertices[t[2]] - map.mesh.vertices[t[0]])
                                  .norm();
    totals.force += area * (field[t[0]] + field[t[1]] + field[t[2]]) / 3.0;
    for (const int v : t) totals.area += field[v] > 0.0 ? area / 3.0 : 0.0;
  }
  return totals;
}

TEST(FaceContacts, SumUpToTheMap) {
  const product::Product product = prism();
  const ProductMap map = product_map(product);
  const FaceAreas areas(map.mesh, map.face_of_triangle);
  const std::vector<double> field = field_on(map, [](const Vec3& x) {
    return std::max(0.0, 0.2 * std::sin(0.2 * x.x() + 0.3 * x.y()) * std::cos(0.1 * x.z()));
  });
  const Totals expected = totals_of(map, field);
  double force = 0.0, area = 0.0, peak = 0.0;
  int with_peak = 0;
  for (const FaceContact& one : areas.contacts(field)) {
    force += one.force;
    area += one.area;
    peak = std::max(peak, one.peak_pressure);
    with_peak += one.has_peak ? 1 : 0;
    EXPECT_NEAR(one.mean_pressure * one.area, one.force, 1e-9);
    EXPECT_LE(one.mean_pressure, one.peak_pressure);
    EXPECT_LE(one.area, product.faces->face[one.face].area * (1.0 + 1e-9));
  }
  EXPECT_NEAR(force, expected.force, 1e-9 * expected.force);
  EXPECT_NEAR(area, expected.area, 1e-9 * expected.area);
  EXPECT_EQ(peak, *std::max_element(field.begin(), field.end()));
  EXPECT_EQ(with_peak, 1);
}

TEST(FaceContacts, ABallInTheMiddleOfAFacePressesOnThatFaceAlone) {
  const product::Product product = prism();
  const ProductMap map = product_map(product, 1.0);
  // On "back", y = 15; force pi r^2 peak / 2 = 75.4 N mm^2/mm^2 of a paraboloid.
  const double radius = 8.0, peak = 0.75;
  const std::vector<FaceContact> found =
      FaceAreas(map.mesh, map.face_of_triangle)
          .contacts(field_on(map, ball_at(Vec3(0.0, 15.0, 10.0), radius, peak)));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(product.faces->face[found[0].face].name, "back");
  EXPECT_TRUE(found[0].has_peak);
  EXPECT_NEAR(found[0].force, 0.5 * std::numbers::pi * radius * radius * peak,
              0.02 * found[0].force);
  EXPECT_NEAR(found[0].area, std::numbers::pi * radius * radius, 0.05 * found[0].area);
  EXPECT_NEAR(found[0].peak_pressure, peak, 0.01);
}

TEST(FaceContacts, SymmetricPressureIsThatOfSymmetricFaces) {
  const product::Product product = prism();
  const ProductMap map = product_map(product);
  const std::vector<FaceContact> found =
      FaceAreas(map.mesh, map.face_of_triangle).contacts(field_on(map, [](const Vec3& x) {
        return 0.01 * std::abs(x.x());
      }));
  ASSERT_EQ(found.size(), 10U);
  const auto of = [&](const std::string& name) {
    for (const FaceContact& one : found) {
      if (product.faces->face[one.face].name == name) return one;
    }
    return FaceContact{};
  };
  for (const auto& [one, other] : {std::pair{"left", "right"},
                                   {"front", "back"},
                                   {"fillet 1", "fillet 2"},
                                   {"fillet 3", "fillet 4"}}) {
    EXPECT_NEAR(of(one).force, of(other).force, 1e-3 * of(one).force) << one;
    EXPECT_NEAR(of(one).area, of(other).area, 0.02 * of(one).area) << one;
  }
  // Closed forms: 0.2 MPa on the sides of 24 x 150 mm; 0.01 x on the flats of 34 mm.
  EXPECT_NEAR(of("right").force, 0.2 * 24.0 * 150.0, 1e-6);
  EXPECT_NEAR(of("back").force, 0.01 * 17.0 * 17.0 * 150.0, 0.01 * of("back").force);
}

TEST(FaceContacts, ThePeakOnARimIsOfTheFaceThatBearsMore) {
  // Two triangles on either side of an edge; the pressure goes on to the left.
  geometry::TriangleMesh map;
  map.vertices = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
  map.triangles = {{0, 1, 2}, {1, 0, 3}};
  const FaceAreas areas(map, {0, 1});
  std::vector<FaceContact> found = areas.contacts({0.5, 0.2, 0.1, 0.0});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].has_peak);
  EXPECT_FALSE(found[1].has_peak);
  EXPECT_EQ(found[1].peak_pressure, 0.5);  // it has that vertex, too
  found = areas.contacts({0.5, 0.2, 0.0, 0.1});
  EXPECT_TRUE(found[1].has_peak);
  EXPECT_TRUE(areas.contacts({0.0, 0.0, 0.0, 0.0}).empty());
}

TEST(FaceContacts, RefuseWhatDoesNotFit) {
  using ::testing::HasSubstr;
  using ::testing::ThrowsMessage;
  const product::Product product = prism();
  EXPECT_THAT([&] { FaceAreas(product.mesh, {0}); },
              ThrowsMessage<UsageError>(HasSubstr("faces: 1 triangles have a face; the map has ")));
  const FaceAreas areas(product.mesh, product.faces->face_of_triangle);
  EXPECT_THAT([&] { areas.contacts({1.0}); },
              ThrowsMessage<UsageError>(HasSubstr("faces: 1 pressures for a map of ")));
}

/// Records of a study with one prism: hands press where `places` says.
struct FaceStudy {
  StudyResults results;
  std::vector<product::Product> products;
  std::vector<StudyRecord> records;
  FaceStudy(const std::vector<std::pair<Vec3, double>>& places, double glove = 0.0)
      : results(study_of(static_cast<int>(places.size()) + 1, {"handle"})) {
    results.plan.profiles[0].glove_thickness = glove;
    products = {prism()};
    const ProductMap map = product_map(products[0]);
    for (std::size_t i = 0; i < places.size(); ++i) {
      records.push_back(held(static_cast<std::int64_t>(i), 0.3));
      records.back().product_pressure =
          sparse(field_on(map, ball_at(places[i].first, 10.0, places[i].second)));
    }
    records.push_back(not_held(static_cast<std::int64_t>(places.size()), StudyOutcome::kSlipsOut));
  }
  std::vector<FaceStatistics> statistics(double threshold = 0.05) const {
    return face_statistics(results.plan, products,
                           [&](const std::function<void(const StudyRecord&)>& visit) {
                             for (const StudyRecord& record : records) visit(record);
                           },
                           {.threshold = threshold});
  }
};

const FaceSummary* of_face(const product::Product& product, const FaceStatistics& statistics,
                           const std::string& name) {
  for (const FaceSummary& one : statistics.faces) {
    if (product.faces->face[one.face].name == name) return &one;
  }
  return nullptr;
}

TEST(FaceStatistics, CountHandsByFace) {
  // The mesh has vertices at z = 0; hands 0 to 2 press on the back, hand 3 on the front, where
  // hand 4 is not, as the product slips out of it.
  const Vec3 back(0.0, 15.0, 0.0), front(0.0, -15.0, 0.0);
  const FaceStudy study({{back, 0.2}, {back, 0.3}, {back, 0.4}, {front, 0.6}});
  const std::vector<FaceStatistics> all = study.statistics(0.35);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].hands, 4);
  ASSERT_EQ(all[0].faces.size(), 2U);
  const FaceSummary* one = of_face(study.products[0], all[0], "back");
  ASSERT_NE(one, nullptr);
  EXPECT_EQ(one->touched.count, 3);
  EXPECT_EQ(one->touched.n, 4);
  EXPECT_EQ(one->has_peak.count, 3);
  EXPECT_EQ(one->peak.n, 3);
  // Vertices near the middle of the balls: within half an edge, so 2 % of the peak at most.
  EXPECT_NEAR(one->peak.mean, 0.3, 0.02 * 0.3);
  EXPECT_NEAR(one->peak.sd, 0.1, 0.02 * 0.1);
  EXPECT_NEAR(one->peak.max, 0.4, 0.02 * 0.4);
  EXPECT_NEAR(one->peak_p95, 0.39, 0.02 * 0.39);  // 0.3 + 0.9 (0.4 - 0.3)
  EXPECT_EQ(one->above.count, 1);                 // of the four: 0.4 MPa
  EXPECT_NEAR(one->force_share, 0.75, 1e-12);
  // R: prop.test(3, 4, correct = FALSE)$conf.int
  EXPECT_NEAR(one->has_peak.interval.low, 0.3006418, 1e-6);
  EXPECT_NEAR(one->has_peak.interval.high, 0.9544127, 1e-6);
  EXPECT_EQ(hottest_face(all[0]), one);
}

TEST(FaceStatistics, InsideAGloveForcesAreThoseOnItsSurface) {
  // On a flat side the glove's surface is as large as the product's: the same force.
  const Vec3 back(0.0, 15.0, 0.0);
  const FaceStudy bare({{back, 0.2}}), in_glove({{back, 0.2}}, 2.0);
  const FaceStatistics a = bare.statistics()[0], b = in_glove.statistics()[0];
  ASSERT_EQ(b.faces.size(), 1U);
  EXPECT_NEAR(a.faces[0].force, b.faces[0].force, 1e-9 * a.faces[0].force);
  EXPECT_EQ(a.faces[0].peak.mean, b.faces[0].peak.mean);
}

TEST(FaceStatistics, AreNothingForProductsWithoutFaces) {
  FaceStudy study({{Vec3(0.0, 15.0, 0.0), 0.2}});
  study.products[0].faces = nullptr;
  EXPECT_TRUE(study.statistics().empty());
}

}  // namespace
}  // namespace palmar::study
