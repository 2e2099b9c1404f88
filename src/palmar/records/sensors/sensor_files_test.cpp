// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/records/sensors/measured_pressure_file.h"
#include "palmar/records/sensors/sensor_layout_file.h"

namespace palmar::records {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A file with that text in a folder that is gone after the test.
class TextFile {
 public:
  TextFile(const std::string& text, const std::string& name) : path_((folder_ / name).string()) {
    formats::write_file(path_, text);
  }
  const std::string& path() const { return path_; }

 private:
  formats::TestFolder folder_;
  std::string path_;
};

/// What reading a text as layout is answered with; "" if it is taken.
std::string layout_refusal(const std::string& text) {
  const TextFile file(text, "layout.toml");
  try {
    read_sensor_layout(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string measured_refusal(const std::string& text, const std::string& layout = "mat") {
  const TextFile file(text, "grip.csv");
  try {
    read_measured_pressure(file.path(), *study::sensor_layout_named(layout));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SensorLayoutFile, ReadsMatsGlovesAndFreeSensors) {
  const TextFile mat(
      "name = \"grip\"\nkind = \"mat\"\npitch_mm = 4\nrows = 20\ncolumns = 30\n"
      "origin_mm = [1, 2, 3.5]\naxis = [0, 0, 2]\nseam = [1, 0, 0]\n",
      "mat.toml");
  const study::SensorLayout sheet = read_sensor_layout(mat.path());
  EXPECT_EQ(sheet.kind, study::SensorKind::kMat);
  EXPECT_EQ(sheet.pitch, 4.0);
  EXPECT_EQ(sheet.rows, 20);
  EXPECT_EQ(sheet.columns, 30);
  EXPECT_EQ(*sheet.origin, Vec3(1.0, 2.0, 3.5));
  const TextFile glove(
      "name = \"g\"\nkind = \"glove\"\npitch_mm = 5\n[[patch]]\nregion = \"index_distal\"\n"
      "rows = 4\ncolumns = 3\n",
      "glove.toml");
  const study::SensorLayout patches = read_sensor_layout(glove.path());
  ASSERT_EQ(patches.patches.size(), 1U);
  EXPECT_EQ(patches.patches[0].region, hand::Region::kIndexDistal);
  EXPECT_EQ(patches.patches[0].columns, 3);
  const TextFile pads(
      "name = \"p\"\nkind = \"free\"\n[[sensor]]\nname = \"trigger\"\nat_mm = [1, 0, 2]\n"
      "area_mm2 = 71\n",
      "pads.toml");
  const study::SensorLayout single = read_sensor_layout(pads.path());
  ASSERT_EQ(single.sensors.size(), 1U);
  EXPECT_EQ(single.sensors[0].area, 71.0);
  EXPECT_EQ(read_sensor_layout("mat").pitch, 5.0);
}

TEST(SensorLayoutFile, NamesLineKeyAndValueOfWhatIsWrong) {
  const std::string head = "name = \"m\"\nkind = \"mat\"\n";
  EXPECT_THAT(layout_refusal(head + "pitch_mm = 0.2\nrows = 4\n"),
              AllOf(HasSubstr("layout.toml:3: pitch_mm"), HasSubstr("0.2"), HasSubstr("50 mm")));
  EXPECT_THAT(layout_refusal(head + "pitch_mm = 5\nrow = 4\n"),
              AllOf(HasSubstr(":4:"), HasSubstr("rows")));
  EXPECT_THAT(layout_refusal(head + "pitch_mm = 5\n"), HasSubstr("rows is missing"));
  EXPECT_THAT(layout_refusal(head + "pitch_mm = 5\nrows = 4\naxis = [0, 1]\n"),
              AllOf(HasSubstr(":5: axis"), HasSubstr("3 are required")));
  EXPECT_THAT(layout_refusal("name = \"m\"\nkind = \"carpet\"\n"),
              AllOf(HasSubstr(":2: kind"), HasSubstr("mat, glove or free")));
  EXPECT_THAT(layout_refusal("name = \"m\"\nkind = \"glove\"\npitch_mm = 5\n[[patch]]\n"
                             "region = \"index_distl\"\nrows = 1\ncolumns = 1\n"),
              AllOf(HasSubstr(":5:"), HasSubstr("index_distal")));
  EXPECT_THAT(layout_refusal("name = \"m\"\nkind = \"free\"\n"), HasSubstr("no sensor is given"));
  try {
    read_sensor_layout("matt");
    FAIL() << "accepted";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("\"matt\" is not known"), HasSubstr("mat")));
  }
}

TEST(MeasuredPressureFile, ReadsForceOrPressure) {
  const TextFile force("row;column;force_n;note\n1;2;0.5;a\n3;4;1.25;b\n", "grip.csv");
  const study::MeasuredPressure grip =
      read_measured_pressure(force.path(), *study::sensor_layout_named("mat"));
  ASSERT_EQ(grip.cells.size(), 2U);
  EXPECT_EQ(grip.cells[1].row, 3);
  EXPECT_EQ(grip.cells[1].column, 4);
  EXPECT_EQ(grip.cells[1].load, 1.25);
  EXPECT_FALSE(grip.cells[1].is_pressure);
  EXPECT_EQ(grip.cells[1].line, 3);
  const TextFile pressure("patch,row,column,pressure_kpa\nthenar,1,1,40\n", "glove.csv");
  const study::MeasuredPressure glove =
      read_measured_pressure(pressure.path(), *study::sensor_layout_named("glove"));
  EXPECT_EQ(glove.cells[0].patch, "thenar");
  EXPECT_TRUE(glove.cells[0].is_pressure);
  EXPECT_NEAR(glove.cells[0].load, 0.04, 1e-12);  // MPa
}

TEST(MeasuredPressureFile, NamesLineColumnAndValueOfWhatIsWrong) {
  EXPECT_THAT(measured_refusal("row,column\n1,1\n"),
              AllOf(HasSubstr("grip.csv:1:"), HasSubstr("force_n, pressure_kpa")));
  EXPECT_THAT(measured_refusal("row,column,force_n,pressure_kpa\n1,1,1,1\n"),
              HasSubstr("are both given"));
  EXPECT_THAT(measured_refusal("column,force_n\n1,1\n"), HasSubstr("column row is missing"));
  EXPECT_THAT(measured_refusal("row,column,force_n\n1,1,1\n1.5,1,1\n"),
              AllOf(HasSubstr("grip.csv:3: row is 1.5"), HasSubstr("whole number from 1")));
  EXPECT_THAT(measured_refusal("row,column,force_n\n1,1,-2\n"),
              AllOf(HasSubstr("grip.csv:2: force_n is -2"), HasSubstr("0 or more")));
  EXPECT_THAT(measured_refusal("row,column,force_n\n1,1,much\n"),
              AllOf(HasSubstr("grip.csv:2:"), HasSubstr("much")));
  EXPECT_THAT(measured_refusal("row,column,force_n\n"), HasSubstr("a cell is needed"));
  EXPECT_THAT(measured_refusal("row,column,force_n\n1,1,1\n", "glove"),
              HasSubstr("column patch is missing"));
}

}  // namespace
}  // namespace palmar::records
