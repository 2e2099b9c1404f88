// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/face_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "palmar/product/primitives.h"

namespace palmar::report {
namespace {

study::StudyPlan plan_of_one() {
  study::StudyPlan plan;
  plan.populations.push_back({});
  plan.populations[0].population.name = "people";
  plan.profiles.push_back({});
  plan.settings.push_back({});
  plan.grips.push_back(std::nullopt);
  plan.products.push_back({});
  plan.products[0].name = "handle r3";
  return plan;
}

product::Product prism() {
  return product::make_prism_product(
      {.width = 40, .depth = 30, .length = 150, .fillet_radius = 3, .fineness = {}});
}

/// Peaks of 30 hands on the first fillet (all of them touch it) and of some on the right side.
study::FaceStatistics statistics() {
  study::FaceStatistics all;
  all.hands = 30;
  study::FaceSummary side, fillet;
  side.face = 0;
  side.touched = statistics::wilson_proportion(10, 30);
  side.has_peak = statistics::wilson_proportion(11, 30);
  side.peak = statistics::summarise(std::vector<double>{0.2, 0.3});
  side.peak_p95 = 0.29;
  fillet.face = 4;
  fillet.touched = statistics::wilson_proportion(30, 30);
  fillet.has_peak = statistics::wilson_proportion(19, 30);
  fillet.above = statistics::wilson_proportion(30, 30);
  fillet.peak = statistics::summarise(std::vector<double>{0.4, 0.42});
  fillet.peak_p95 = 0.419;
  fillet.force_share = 0.75;
  all.faces = {side, fillet};
  return all;
}

TEST(FaceWords, SayTheSentenceOfTheHottestFace) {
  EXPECT_EQ(
      face_words(plan_of_one(), prism(), statistics()),
      "Handle r3: face 5 \"fillet 1\" (fillet r 3): peak 0.41 MPa in the mean, highest of the "
      "product in 63 % of 30 hands.");
  EXPECT_EQ(face_words(prism().faces->face[1], nullptr),
            "face 2 \"back\" (plane): nobody touches it");
  EXPECT_EQ(face_words(plan_of_one(), prism(), study::FaceStatistics{}), "");
}

TEST(FaceWords, AsCsvHaveOneRowPerFaceInFull) {
  const records::CsvTable table =
      face_statistics_csv(plan_of_one(), {prism()}, {statistics()}, 0.05);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_NO_THROW(records::format_csv(table));  // rows are as long as the header
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

TEST(FaceWords, FacesOfOneGraspHaveARowEach) {
  study::AssessedProduct assessed;
  assessed.product = prism();
  assessed.assessment.faces = {
      {.face = 6, .force = 20.0, .area = 80.0, .peak_pressure = 0.41, .has_peak = true}};
  const records::CsvTable table =
      records::face_table({.hand = nullptr, .assessments = {assessed}, .command_line = ""});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_NO_THROW(records::format_csv(table));
  EXPECT_EQ(table.rows[0][2], "7");
}

}  // namespace
}  // namespace palmar::report
