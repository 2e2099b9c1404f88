// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/face_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "palmar/product/primitives.h"

namespace palmar {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

StudyPlan plan_of_one() {
  StudyPlan plan;
  plan.populations.push_back({});
  plan.populations[0].population.name = "people";
  plan.profiles.push_back({});
  plan.settings.push_back({});
  plan.grips.push_back(std::nullopt);
  plan.products.push_back({});
  plan.products[0].name = "handle r3";
  return plan;
}

Product prism() {
  return make_prism_product(
      {.width = 40, .depth = 30, .length = 150, .fillet_radius = 3, .fineness = {}});
}

/// Peaks of 30 hands on the first fillet (all of them touch it) and of some on the right side.
FaceStatistics statistics() {
  FaceStatistics all;
  all.hands = 30;
  FaceSummary side, fillet;
  side.face = 0;
  side.touched = wilson_proportion(10, 30);
  side.has_peak = wilson_proportion(11, 30);
  side.peak = summarise(std::vector<double>{0.2, 0.3});
  side.peak_p95 = 0.29;
  fillet.face = 4;
  fillet.touched = wilson_proportion(30, 30);
  fillet.has_peak = wilson_proportion(19, 30);
  fillet.above = wilson_proportion(30, 30);
  fillet.peak = summarise(std::vector<double>{0.4, 0.42});
  fillet.peak_p95 = 0.419;
  fillet.force_share = 0.75;
  all.faces = {side, fillet};
  return all;
}

TEST(FaceTables, SayTheSentenceOfTheHottestFace) {
  EXPECT_EQ(
      face_words(plan_of_one(), prism(), statistics()),
      "Handle r3: face 5 \"fillet 1\" (fillet r 3): peak 0.41 MPa in the mean, highest of the "
      "product in 63 % of 30 hands.");
  EXPECT_EQ(face_words(prism().faces->face[1], nullptr),
            "face 2 \"back\" (plane): nobody touches it");
  EXPECT_EQ(face_words(plan_of_one(), prism(), FaceStatistics{}), "");
}

TEST(FaceTables, OfAStudyHaveTheHottestFirstAndNoMarkupOfNames) {
  Product product = prism();
  ProductFaces faces = *product.faces;
  faces.face[4].name = "<script>";
  faces.face[4].part = "a & b";
  product.faces = std::make_shared<const ProductFaces>(faces);
  const std::string html =
      face_statistics_section(plan_of_one(), {product}, {statistics()}, {}, 0.05);
  EXPECT_THAT(html, HasSubstr("Face 5 &quot;&lt;script&gt;&quot; (fillet r 3)<br>"));
  EXPECT_THAT(html, HasSubstr("a &amp; b"));
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_LT(html.find("(fillet r 3)<br>"), html.find("Face 1 &quot;right&quot; (plane)</th>"));
  EXPECT_THAT(html, HasSubstr("Peak above 50 kPa"));
  EXPECT_THAT(html, HasSubstr("Of 10 faces nobody touches 8."));
  // Another condition has no table, nor has a product without faces.
  EXPECT_EQ(face_statistics_section(plan_of_one(), {product}, {statistics()},
                                    {.population = {}, .profile = 1}, 0.05),
            "");
  EXPECT_EQ(face_statistics_section(plan_of_one(), {product}, {}, {}, 0.05), "");
}

TEST(FaceTables, AsCsvHaveOneRowPerFaceInFull) {
  const CsvTable table = face_statistics_csv(plan_of_one(), {prism()}, {statistics()}, 0.05);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_NO_THROW(format_csv(table));  // rows are as long as the header
  const auto column = [&](const std::string& name) {
    const auto found = std::find(table.header.begin(), table.header.end(), name);
    return table.rows[1].at(static_cast<std::size_t>(found - table.header.begin()));
  };
  EXPECT_EQ(column("face"), "5");
  EXPECT_EQ(column("kind"), "cylinder");
  EXPECT_EQ(column("is_fillet"), "1");
  EXPECT_EQ(column("radius_mm"), "3");
  EXPECT_EQ(column("has_peak"), "19");
  EXPECT_EQ(column("force_share_mean"), "0.75");
}

TEST(FaceTables, OfOneGraspNameThePeak) {
  AssessedProduct assessed;
  assessed.product = prism();
  assessed.assessment.faces = {
      {.face = 1, .force = 12.0, .area = 300.0, .peak_pressure = 0.1, .mean_pressure = 0.04},
      {.face = 6,
       .force = 20.0,
       .area = 80.0,
       .peak_pressure = 0.41,
       .mean_pressure = 0.25,
       .has_peak = true}};
  const std::string html = face_contact_table(assessed);
  EXPECT_THAT(html, HasSubstr("face 7 &quot;fillet 3&quot; (fillet r 3), 0.41 MPa"));
  const CsvTable table =
      face_table({.hand = nullptr, .assessments = {assessed}, .command_line = ""});
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_NO_THROW(format_csv(table));
  EXPECT_EQ(table.rows[1][2], "7");
  assessed.product.faces = nullptr;
  EXPECT_EQ(face_contact_table(assessed), "");
}

}  // namespace
}  // namespace palmar
