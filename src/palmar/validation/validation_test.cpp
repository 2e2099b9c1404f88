// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/validation/validation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <set>

#include "palmar/core/error.h"

namespace palmar::validation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ValidationReport report_of(ValidationRow row) {
  ValidationReport report;
  report.hand_name = "nobody's";
  report.cases.push_back({"T1", "a case", {std::move(row)}, 12.5});
  return report;
}

TEST(Judge, ValueWithinItsToleranceIsMet) {
  const ValidationRow row = judge("force", "N", 2.03, near_value(2.0, 0.02, "a law"));
  EXPECT_EQ(row.verdict, Verdict::kMet);
  EXPECT_NEAR(row.difference.value(), 0.015, 1e-12);
}

TEST(Judge, DeliberatelyWrongTargetIsMissed) {
  // What the program does with it: see report_of(row).count and the exit code of the command.
  EXPECT_EQ(judge("force", "N", 2.05, near_value(2.0, 0.02, "")).verdict, Verdict::kMissed);
  EXPECT_EQ(judge("force", "N", 1.95, near_value(2.0, 0.02, "")).verdict, Verdict::kMissed);
  EXPECT_EQ(judge("force", "N", -2.03, near_value(-2.0, 0.02, "")).verdict, Verdict::kMet);
  EXPECT_EQ(judge("force", "N", -2.05, near_value(-2.0, 0.02, "")).verdict, Verdict::kMissed);
}

TEST(Judge, EdgesAreInclusiveAndReportTheWayToTheNearerOne) {
  EXPECT_EQ(judge("x", "", 1.0, between(1.0, 2.0, "")).verdict, Verdict::kMet);
  EXPECT_EQ(judge("x", "", 2.0, between(1.0, 2.0, "")).verdict, Verdict::kMet);
  EXPECT_EQ(judge("x", "", 1.5, between(1.0, 2.0, "")).difference, 0.0);
  const ValidationRow above = judge("x", "", 2.5, between(1.0, 2.0, ""));
  EXPECT_EQ(above.verdict, Verdict::kMissed);
  EXPECT_NEAR(above.difference.value(), 0.25, 1e-12);
  const ValidationRow below = judge("x", "", 0.5, between(1.0, 2.0, ""));
  EXPECT_EQ(below.verdict, Verdict::kMissed);
  EXPECT_NEAR(below.difference.value(), -0.5, 1e-12);
}

TEST(Judge, OneSidedLimits) {
  EXPECT_EQ(judge("x", "", 0.0, at_most(0.0, "")).verdict, Verdict::kMet);
  EXPECT_EQ(judge("x", "", 1.0, at_most(0.0, "")).verdict, Verdict::kMissed);
  EXPECT_EQ(judge("x", "", 1.0, at_most(0.0, "")).difference, std::nullopt);  // no share of 0
  EXPECT_EQ(judge("x", "", -1e-9, at_least(0.0, "")).verdict, Verdict::kMissed);
}

TEST(Judge, NoNumberIsMissedWhateverTheTarget) {
  EXPECT_EQ(judge("x", "", kNan, near_value(1.0, 0.5, "")).verdict, Verdict::kMissed);
  EXPECT_EQ(judge("x", "", kNan, at_most(1.0, "")).verdict, Verdict::kMissed);
  EXPECT_EQ(judge("x", "", kNan, at_least(1.0, "")).verdict, Verdict::kMissed);
  EXPECT_EQ(judge("x", "", kNan, between(0.0, 1.0, "")).verdict, Verdict::kMissed);
}

TEST(Judge, InformationIsNotJudged) {
  const ValidationRow row = judge("x", "", 3.0, information(2.0, ""));
  EXPECT_EQ(row.verdict, Verdict::kInformation);
  EXPECT_NEAR(row.difference.value(), 0.5, 1e-12);
  EXPECT_EQ(judge("x", "", 3.0, information(std::nullopt, "")).difference, std::nullopt);
}

TEST(ValidationReport, CountsVerdictsOfAllCases) {
  ValidationReport report = report_of(judge("x", "", 3.0, at_most(2.0, "")));
  report.cases.push_back({"T2", "", {not_built("y", "issue 7")}, 0.0});
  EXPECT_EQ(report.count(Verdict::kMissed), 1);
  EXPECT_EQ(report.count(Verdict::kNotBuilt), 1);
  EXPECT_EQ(report.count(Verdict::kMet), 0);
}

TEST(ValidationMarkdown, RowReportsOursTheirsDifferenceAndVerdict) {
  const std::string text =
      validation_markdown(report_of(judge("force", "N", 2.03, near_value(2.0, 0.02, "a law"))));
  EXPECT_THAT(text, HasSubstr("| force, N | 2.03 | 2 | +1.5 % | 2 % | met | no | - | a law |"));
  EXPECT_THAT(text, AllOf(HasSubstr("## T1: a case"), HasSubstr("1 met, 0 missed"),
                          HasSubstr("palmar validate --markdown > docs/method/validation.md")));
  EXPECT_THAT(text, Not(HasSubstr("12.5"))) << "times change from run to run";
}

TEST(ValidationMarkdown, RangesLimitsAndMisses) {
  EXPECT_THAT(validation_markdown(report_of(judge("x", "", 4.0, between(1.0, 2.0, "s")))),
              HasSubstr("| x | 4 | 1 to 2 | +100.0 % | - | **missed** | no | - | s |"));
  EXPECT_THAT(validation_markdown(report_of(judge("x", "", 1.5, at_least(1.0, "s")))),
              HasSubstr("| x | 1.5 | at least 1 | inside | - | met | no | - | s |"));
  EXPECT_THAT(validation_markdown(report_of(judge("x", "", kNan, at_most(1.0, "s")))),
              HasSubstr("| x | no number | at most 1 |"));
  EXPECT_THAT(validation_markdown(report_of(not_built("redesigns", "issue 6"))),
              HasSubstr("| redesigns | - | - | - | - | not built yet | no | - | issue 6 |"));
}

TEST(ValidationMarkdown, RowSaysWhatWasChosenOnItAndWhereItComesFrom) {
  ValidationRow row = judge("x", "", 1.5, at_least(1.0, "s"));
  row.added_in = "abc1234";
  row.chosen_in = "def5678";
  EXPECT_THAT(validation_markdown(report_of(row)),
              HasSubstr("| met | yes, in def5678 | abc1234 | s |"));
}

TEST(ValidationText, ReportsTheTimeOfACase) {
  EXPECT_THAT(validation_text(report_of(not_built("x", "y"))), HasSubstr("T1: a case (12.5 s)"));
}

TEST(ValidationOptions, UnknownCaseIsRefusedByName) {
  ValidationOptions options;
  options.cases = {"G1", "layr"};
  try {
    options.check();
    FAIL() << "an unknown case was taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("\"layr\""), HasSubstr("did you mean layer"),
                                    HasSubstr("allowed are G1, ")));
  }
}

TEST(Validate, IdsOfCasesDiffer) {
  std::set<std::string> ids;
  for (const ValidationCaseName& name : validation_cases()) {
    EXPECT_TRUE(ids.insert(name.id).second) << name.id;
    EXPECT_FALSE(name.title.empty()) << name.id;
  }
}

TEST(Validate, MissingHandIsRefused) { EXPECT_THROW(validate(nullptr), UsageError); }

TEST(Validate, RunsOnlyWhatIsAskedAndNothingSlowWhenQuick) {
  const auto hand = std::make_shared<const hand::Hand>();  // not touched by the case that runs
  ValidationOptions options;
  options.cases = {"G1", "motion"};
  options.quick = true;
  const ValidationReport report = validate(hand, options);
  ASSERT_EQ(report.cases.size(), 1U);
  EXPECT_EQ(report.cases[0].id, "G1");
  EXPECT_EQ(report.count(Verdict::kMissed), 0);
  EXPECT_GT(report.count(Verdict::kMet), 10);
  for (const ValidationRow& row : report.cases[0].rows) {
    EXPECT_FALSE(row.added_in.empty()) << row.quantity;
  }
}

TEST(Validate, CancelEndsIt) {
  const std::atomic<bool> cancel = true;
  Progress progress;
  progress.cancel = &cancel;
  EXPECT_THROW(validate(std::make_shared<const hand::Hand>(), {}, progress), Cancelled);
}

}  // namespace
}  // namespace palmar::validation
