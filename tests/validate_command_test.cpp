// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_program.h"

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST(ValidateCommand, ClosedFormsAreMet) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar("validate --case G1 --json --out table.md", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(run.out);
  EXPECT_EQ(report.at("missed"), 0);
  ASSERT_EQ(report.at("cases").size(), 1U);
  EXPECT_EQ(report.at("cases")[0].at("case"), "G1");
  bool has_sphere = false;
  for (const Json& row : report.at("cases")[0].at("rows")) {
    if (row.at("quantity").get<std::string>().rfind("sphere, force at 2 mm", 0) != 0) continue;
    has_sphere = true;
    // F = (16/3) G sqrt(R) depth^1.5 = 3.3731 N
    EXPECT_NEAR(row.at("theirs").get<double>(), 3.3731, 1e-4);
    EXPECT_NEAR(row.at("ours").get<double>(), 3.3731, 0.02 * 3.3731);
    EXPECT_EQ(row.at("verdict"), "met");
  }
  EXPECT_TRUE(has_sphere);
  EXPECT_THAT(read_text(folder + "/table.md"), HasSubstr("## G1: "));
}

TEST(ValidateCommand, SameRunGivesTheSameTable) {
  const ProgramRun a = run_palmar("validate --case layer --markdown --threads 1");
  const ProgramRun b = run_palmar("validate --case layer --markdown --threads 2");
  EXPECT_THAT(a.out, HasSubstr("## layer: ")) << a.err;
  EXPECT_EQ(a.out, b.out);
}

TEST(ValidateCommand, ListsItsCases) {
  const ProgramRun run = run_palmar("validate --list");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, AllOf(HasSubstr("G1 "), HasSubstr("layer "), HasSubstr("G6 "),
                             HasSubstr("(not with --quick)")));
}

TEST(ValidateCommand, BadArgumentsAreNamed) {
  const ProgramRun unknown = run_palmar("validate --case G9");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("\"G9\""), HasSubstr("G1")));
  const ProgramRun out = run_palmar("validate --case G1 --out table.xls");
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.err, AllOf(HasSubstr("table.xls"), HasSubstr(".md")));
  EXPECT_EQ(run_palmar("validate --case G1 --json --markdown").exit_code, 2);
}

}  // namespace
}  // namespace palmar::testing
