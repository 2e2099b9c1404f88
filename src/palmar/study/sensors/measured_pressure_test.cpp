// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/sensors/measured_pressure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"

namespace palmar::study {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A mat of 2 rows and 3 columns of 25 mm^2; forces 1, 2, 4, 0, 0, 3 N.
SensorReading small_mat() {
  SensorReading reading;
  reading.layout = *sensor_layout_named("mat");
  reading.rows = 2;
  reading.columns = 3;
  const double force[] = {1.0, 2.0, 4.0, 0.0, 0.0, 3.0};
  for (int i = 0; i < 6; ++i) {
    SensorCell cell;
    cell.patch = "mat";
    cell.row = 1 + i / 3;
    cell.column = 1 + i % 3;
    cell.area = 25.0;
    cell.force = force[i];
    cell.mean_pressure = force[i] / 25.0;
    if (force[i] > 0.0) cell.region = i < 3 ? hand::Region::kIndexDistal : hand::Region::kThenar;
    reading.cells.push_back(cell);
  }
  return reading;
}

MeasuredCell cell(int row, int column, double force, int line = 2) {
  MeasuredCell result;
  result.patch = "mat";
  result.row = row;
  result.column = column;
  result.load = force;
  result.line = line;
  return result;
}

TEST(ComparePressure, TwiceTheLoadGoesTogetherAndIsTwiceTheForce) {
  const PressureComparison result = compare_pressure(
      small_mat(),
      {"grip.csv", {cell(1, 1, 2.0), cell(1, 2, 4.0), cell(1, 3, 8.0), cell(2, 3, 6.0)}});
  EXPECT_EQ(result.compared, 4);  // two cells are loaded by neither
  EXPECT_EQ(result.pearson.n, 4);
  EXPECT_NEAR(result.pearson.r, 1.0, 1e-12);
  EXPECT_NEAR(result.spearman.r, 1.0, 1e-12);
  EXPECT_NEAR(result.force_measured, 20.0, 1e-12);
  EXPECT_NEAR(result.force_simulated, 10.0, 1e-12);
  EXPECT_NEAR(result.peak_measured, 8.0 / 25.0, 1e-12);
  // Differences of 1, 2, 4 and 3 N over 25 mm^2.
  EXPECT_NEAR(result.rms, std::sqrt(30.0 / 4.0) / 25.0, 1e-12);
  EXPECT_NEAR(result.mean_difference, -2.5 / 25.0, 1e-12);
  ASSERT_EQ(result.parts.size(), 2U);
  EXPECT_EQ(result.parts[0].name, "index_distal");
  EXPECT_NEAR(result.parts[0].measured, 14.0, 1e-12);
  EXPECT_NEAR(result.parts[0].simulated, 7.0, 1e-12);
  EXPECT_EQ(result.parts[1].name, "thenar");
  EXPECT_NEAR(result.parts[1].measured, 6.0, 1e-12);
}

TEST(ComparePressure, CorrelationsAreThoseOfRsCorTest) {
  // 3, 1, 2, 5 N against 1, 2, 4, 3 N, by hand: means 2.75 and 2.5,
  // sxy = 0.25(-1.5) + (-1.75)(-0.5) + (-0.75)(1.5) + 2.25(0.5) = 0.5, sxx = 8.75, syy = 5.
  const PressureComparison result = compare_pressure(
      small_mat(),
      {"grip.csv", {cell(1, 1, 3.0), cell(1, 2, 1.0), cell(1, 3, 2.0), cell(2, 3, 5.0)}});
  EXPECT_NEAR(result.pearson.r, 0.5 / std::sqrt(8.75 * 5.0), 1e-12);
  // Ranks 3, 1, 2, 4 against 1, 2, 4, 3: 1 - 6 (4 + 1 + 4 + 1) / (4 * 15) = 0.
  EXPECT_NEAR(result.spearman.r, 0.0, 1e-12);
}

TEST(ComparePressure, FramesAreAveragedAndPressureCountsOverTheCell) {
  MeasuredCell pressure = cell(2, 1, 0.2);
  pressure.is_pressure = true;  // 0.2 MPa over 25 mm^2: 5 N
  const PressureComparison result =
      compare_pressure(small_mat(), {"grip.csv", {cell(1, 1, 1.0), cell(1, 1, 2.0), pressure}});
  EXPECT_NEAR(result.measured[0], 1.5, 1e-12);
  EXPECT_NEAR(result.measured[3], 5.0, 1e-12);
  EXPECT_EQ(result.compared, 5);
  // No skin presses that cell.
  EXPECT_EQ(result.parts[1].name, "beside the hand");
  EXPECT_NEAR(result.parts[1].measured, 5.0, 1e-12);
}

TEST(ComparePressure, NamesFileLineAndCellOfWhatDoesntFit) {
  EXPECT_THAT(
      [] {
        compare_pressure(small_mat(), {"grip.csv", {cell(1, 1, 1.0), cell(3, 2, 1.0, 17)}});
      },
      ThrowsMessage<InputError>(AllOf(HasSubstr("grip.csv:17: row 3, column 2 of mat"),
                                      HasSubstr("rows 1 to 2 and columns 1 to 3"))));
  MeasuredCell other = cell(1, 1, 1.0, 9);
  other.patch = "glove";
  EXPECT_THAT(
      [&] {
        compare_pressure(small_mat(), {"grip.csv", {other}});
      },
      ThrowsMessage<InputError>(HasSubstr("grip.csv:9: patch \"glove\" is not in layout")));
  SensorReading idle = small_mat();
  for (SensorCell& one : idle.cells) one.force = 0.0;
  EXPECT_THAT(
      [&] {
        compare_pressure(idle, {"grip.csv", {cell(1, 1, 1.0)}});
      },
      ThrowsMessage<InputError>(HasSubstr("1 cell is loaded")));
}

}  // namespace
}  // namespace palmar::study
