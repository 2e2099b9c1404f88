// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/assessment/index_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

grasp::GraspIndices two_rows() {
  grasp::GraspIndex firm;
  firm.key = "epsilon_l1";
  firm.name = "largest disturbance";
  firm.group = "stability";
  firm.value = 0.1 + 0.2;
  firm.lowest = 0.0;
  firm.better = grasp::Better::kUp;
  firm.definition = "distance from 0, in \"wrench\" space";
  firm.source = "Ferrari and Canny 1992";
  grasp::GraspIndex sore;
  sore.key = "skin_above_50_kpa_mm2";
  sore.name = "skin without blood flow";
  sore.group = "comfort";
  sore.unit = "mm2";
  sore.better = grasp::Better::kDown;
  sore.remark = "nothing is touched";
  return {firm, sore};
}

TEST(IndexJson, ValuesReadBackExactlyAndNothingIsNull) {
  const auto json = nlohmann::json::parse(index_values(two_rows()).dump());
  EXPECT_EQ(json.size(), 2u);
  EXPECT_EQ(json["epsilon_l1"].get<double>(), 0.1 + 0.2);
  EXPECT_TRUE(json["skin_above_50_kpa_mm2"].is_null());
}

TEST(IndexJson, RowsReportEverything) {
  const auto json = nlohmann::json::parse(index_rows(two_rows()).dump());
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["better"], "up");
  EXPECT_EQ(json[0]["lowest"], 0.0);
  EXPECT_TRUE(json[0]["highest"].is_null());
  EXPECT_EQ(json[0]["definition"], "distance from 0, in \"wrench\" space");
  EXPECT_EQ(json[1]["remark"], "nothing is touched");
  EXPECT_TRUE(json[1]["value"].is_null());
}

TEST(IndexJson, InfinityIsNull) {
  grasp::GraspIndices rows = two_rows();
  rows[0].value = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(index_values(rows)["epsilon_l1"].is_null());
}

TEST(IndexJson, NoRowsAreEmptyAndValidJson) {
  EXPECT_EQ(index_values({}).dump(), "{}");
  EXPECT_EQ(index_rows({}).dump(), "[]");
  EXPECT_EQ(index_text({}), "");
}

TEST(IndexJson, TextHasNoExponentsAndItsColumnsStandInLine) {
  grasp::GraspIndices rows = two_rows();
  rows[0].value = 0.001594;
  rows[1].value = 1972.4;
  rows[1].remark.clear();
  const std::string text = index_text(rows);
  EXPECT_THAT(text, HasSubstr(" 0.00159 "));
  EXPECT_THAT(text, HasSubstr(" 1970 mm²  less is better"));
  // "mm²" is one character longer in bytes than on the terminal.
  const auto column = [&](const char* words) {
    const std::size_t at = text.find(words);
    return at - text.rfind('\n', at);
  };
  EXPECT_EQ(column("more is better") + 1, column("less is better"));
}

TEST(IndexJson, TextGroupsRowsAndLeavesNoBlanksAtLineEnds) {
  const std::string text = index_text(two_rows());
  EXPECT_THAT(text, HasSubstr("stability\n  largest disturbance"));
  EXPECT_THAT(text, HasSubstr("0.3"));
  EXPECT_THAT(text, HasSubstr("more is better\n"));
  EXPECT_THAT(text, HasSubstr("comfort\n  skin without blood flow"));
  EXPECT_THAT(text, HasSubstr("nothing is touched\n"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr(" \n")));
}

}  // namespace
}  // namespace palmar::records
