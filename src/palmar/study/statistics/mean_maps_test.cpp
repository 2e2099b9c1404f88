// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/mean_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/study/statistics/study_test_results.h"

namespace palmar::study {
namespace {

using testing::held;
using testing::not_held;
using testing::study_of;

RecordSource source_of(const std::vector<StudyRecord>& records) {
  return [&records](const std::function<void(const StudyRecord&)>& visit) {
    for (const StudyRecord& record : records) visit(record);
  };
}

TEST(MeanMaps, AreThoseOfFullFields) {
  // Vertex 0: 0.02, 0.06, 0; vertex 2: 0, 0, 0.3 MPa; computed by hand below.
  StudyResults results = study_of(4, {"a"});
  std::vector<StudyRecord> records = {held(0, 0.2), held(1, 0.2), held(2, 0.2),
                                      not_held(3, StudyOutcome::kSlipsOut)};
  records[0].skin_pressure = {{0}, {0.02F}};
  records[1].skin_pressure = {{0}, {0.06F}};
  records[2].skin_pressure = {{2}, {0.3F}};
  records[3].skin_pressure = {{1}, {9.0F}};  // not in the hand: says nothing
  records[0].product_pressure = {{1}, {0.1F}};
  const std::vector<StudyMaps> maps = mean_maps(results.plan, source_of(records), 3, {2});
  ASSERT_EQ(maps.size(), 1U);
  EXPECT_EQ(maps[0].hands, 3);
  const PressureMap& skin = maps[0].skin;
  EXPECT_NEAR(skin.mean[0], 0.08 / 3.0, 1e-8);  // MPa; fields are in single precision
  const double m = 0.08 / 3.0;
  EXPECT_NEAR(skin.sd[0],
              std::sqrt(((0.02 - m) * (0.02 - m) + (0.06 - m) * (0.06 - m) + m * m) / 2.0), 1e-8);
  EXPECT_NEAR(skin.above[0], 1.0 / 3.0, 1e-15);  // above 0.05 MPa
  EXPECT_EQ(skin.mean[1], 0.0);
  EXPECT_NEAR(skin.mean[2], 0.1, 1e-7);
  EXPECT_NEAR(maps[0].on_product.mean[1], 0.1 / 3.0, 1e-8);
  EXPECT_EQ(maps[0].on_product.above[0], 0.0);
}

TEST(MeanMaps, OfOneFieldTwiceHaveNoScatter) {
  StudyResults results = study_of(2, {"a"});
  std::vector<StudyRecord> records = {held(0, 0.2), held(1, 0.2)};
  for (StudyRecord& record : records) record.skin_pressure = {{0, 1}, {0.123F, 0.077F}};
  const std::vector<StudyMaps> maps = mean_maps(results.plan, source_of(records), 2, {1});
  EXPECT_EQ(maps[0].skin.mean[0], static_cast<double>(0.123F));
  EXPECT_EQ(maps[0].skin.sd[0], 0.0);
  EXPECT_EQ(maps[0].skin.above[1], 1.0);
}

TEST(MeanMaps, PopulationsAreMappedByThemselves) {
  StudyResults results = study_of(2, {"a"}, 2);
  std::vector<StudyRecord> records = {held(0, 0.2), held(1, 0.2)};
  records[0].skin_pressure = {{0}, {0.2F}};
  const std::vector<StudyMaps> maps = mean_maps(results.plan, source_of(records), 1, {1});
  ASSERT_EQ(maps.size(), 3U);
  EXPECT_NEAR(maps[0].skin.mean[0], 0.1, 1e-8);
  EXPECT_NEAR(maps[1].skin.mean[0], 0.2, 1e-8);
  EXPECT_EQ(maps[2].skin.mean[0], 0.0);
}

TEST(MeanMaps, NameAVertexThatIsNotThere) {
  StudyResults results = study_of(1, {"a"});
  std::vector<StudyRecord> records = {held(0, 0.2)};
  records[0].skin_pressure = {{7}, {0.2F}};
  try {
    mean_maps(results.plan, source_of(records), 3, {1});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "pressure map: task 0 names vertex 7 of a mesh of 3");
  }
}

}  // namespace
}  // namespace palmar::study
