// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/measured_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

std::string with_text(const std::string& csv) {
  const std::string path = formats::own_file("curves.csv");
  formats::write_file(path, csv);
  return path;
}

MeasuredCurves read_curves(const std::string& csv) { return read_measured_curves(with_text(csv)); }

std::string curves_message(const std::string& csv) {
  try {
    read_curves(csv);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(MeasuredCurves, UnitsOfTheHeaderAreConverted) {
  const MeasuredCurves curves = read_curves(
      "# somebody 1999, table 2\n"
      "subject,depth_mm,force_mN,area_cm2,time_s\n"
      "\"Doe, J.\",0,0,,0\n"
      "\"Doe, J.\",0.5,250,0.25,1\r\n"
      "\n"
      "B,1.0,700,,2\n");
  ASSERT_EQ(curves.points.size(), 2U);
  EXPECT_EQ(curves.points[0].subject, "Doe, J.");
  EXPECT_DOUBLE_EQ(curves.points[0].force, 0.25);  // N
  EXPECT_DOUBLE_EQ(*curves.points[0].area, 25.0);  // mm^2
  EXPECT_EQ(curves.points[0].line, 4);
  EXPECT_FALSE(curves.points[1].area);
  EXPECT_EQ(curves.points[1].line, 6);
  EXPECT_EQ(curves.zero_depths, 1);
  EXPECT_EQ(curves.ignored, std::vector<std::string>{"time_s"});
}

TEST(MeasuredCurves, SemicolonsTabsAndDeviationsAreRead) {
  EXPECT_DOUBLE_EQ(read_curves("depth_mm;force_n\n1;2\n").points[0].force, 2.0);
  EXPECT_DOUBLE_EQ(read_curves("\xEF\xBB\xBF"
                               "depth_mm\tforce_n\n1\t2\n")
                       .points[0]
                       .force,
                   2.0);
  EXPECT_DOUBLE_EQ(read_curves("depth_mm,force_n,force_sd_mn\n1,2,500\n").points[0].weight, 4.0);
  EXPECT_DOUBLE_EQ(read_curves("depth_mm,force_n,weight\n1,2,3\n").points[0].weight, 3.0);
}

TEST(MeasuredCurves, BadHeadersSayWhatIsNeeded) {
  EXPECT_THAT(curves_message("depth_mm,forse_n\n1,2\n"),
              HasSubstr("/curves.csv:1: column force_n (or force_mn) is missing; the header "
                        "has depth_mm, forse_n (is forse_n meant?)"));
  EXPECT_THAT(curves_message("force_n\n2\n"), HasSubstr("column depth_mm is missing"));
  EXPECT_THAT(curves_message("depth,force_n\n1,2\n"),
              HasSubstr("column \"depth\" has no unit; depth_mm is needed"));
  EXPECT_THAT(curves_message("depth_mm,force_kg\n1,2\n"),
              HasSubstr("unit \"kg\" is not known; force_ with n or mn is allowed"));
  EXPECT_THAT(curves_message("depth_mm,force_MN\n1,2\n"), HasSubstr("meganewton"));
  EXPECT_THAT(curves_message("depth_mm,force_n,force_mn\n1,2,3\n"), HasSubstr("say the same"));
  EXPECT_THAT(curves_message("depth_mm,force_n,weight,force_sd_n\n1,2,3,4\n"),
              HasSubstr("exclude"));
}

TEST(MeasuredCurves, BadRowsAreNamedByLine) {
  EXPECT_THAT(curves_message("depth_mm,force_n\n1,2\n1,abc\n"),
              HasSubstr("/curves.csv:3: force_n is \"abc\"; a number is needed"));
  EXPECT_THAT(curves_message("depth_mm,force_n\n-1,2\n"),
              HasSubstr(":2: depth_mm is -1; 0 or more is needed"));
  EXPECT_THAT(curves_message("depth_mm,force_n\n1,-2\n"), HasSubstr("force_n is -2"));
  EXPECT_THAT(curves_message("depth_mm,force_n\n1,nan\n"), HasSubstr("a number is needed"));
  EXPECT_THAT(curves_message("depth_mm,force_n\n1,\n"), HasSubstr("force_n is \"\""));
  EXPECT_THAT(curves_message("depth_mm,force_n\n1\n"),
              HasSubstr("it has 1 cells; the header has 2"));
  EXPECT_THAT(curves_message("depth_mm;force_n\n0,5;1\n"), HasSubstr("with a decimal point"));
  EXPECT_THAT(curves_message("depth_mm,force_n,weight\n1,2,0\n"),
              HasSubstr("more than 0 is needed"));
  EXPECT_THAT(curves_message("depth_mm,force_n\n\"1,2\n"), HasSubstr("a quote is not closed"));
}

TEST(MeasuredCurves, FilesWithoutReadingsAreRefused) {
  EXPECT_THAT(curves_message("# nothing\n"), HasSubstr("it has no header"));
  EXPECT_THAT(curves_message("depth_mm,force_n\n"), HasSubstr("it has no readings"));
  EXPECT_THAT(curves_message(std::string("depth\0mm", 8)), HasSubstr("no text"));
  EXPECT_THROW(read_measured_curves("/nowhere/curves.csv"), InputError);
}

}  // namespace
}  // namespace palmar::records
