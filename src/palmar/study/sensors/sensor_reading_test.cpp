// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/sensors/sensor_reading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/product/primitives.h"

namespace palmar::study {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRadius = 20.0;  // mm, of the handle
constexpr double kSpot = 4.0;     // mm^2, that a point of skin presses on

product::Product handle() {
  product::CylinderProductOptions options;
  options.diameter = 2.0 * kRadius;
  options.length = 150.0;
  return product::make_cylinder_product(options);
}

/// Points of skin that press a product.
struct Presser {
  hand::Hand hand;
  contact::ContactResult contact;

  void add(const Vec3& at, double force, hand::Region region) {
    hand.region.push_back(region);
    contact.deformed.push_back(at);
    contact.force.push_back(force);
    contact.pressure.push_back(force / kSpot);
  }
};

/// The cylinder's axis and its middle.
struct Axis {
  Vec3 middle, along;
};
Axis axis_of(const product::Product& product) {
  Box3 box;
  for (const Vec3& v : product.mesh.vertices) box.extend(v);
  Axis axis{box.center(), Vec3::Zero()};
  Eigen::Index longest = 0;
  box.sizes().maxCoeff(&longest);
  axis.along[longest] = 1.0;
  return axis;
}

SensorLayout mat(const Axis& axis, const Vec3& seam) {
  SensorLayout layout = *sensor_layout_named("mat");
  layout.origin = axis.middle;
  layout.axis = axis.along;
  layout.seam = seam;
  return layout;
}

const SensorCell& cell_at(const SensorReading& reading, int row, int column) {
  for (const SensorCell& one : reading.cells) {
    if (one.row == row && one.column == column) return one;
  }
  throw Error("no such cell");
}

TEST(SensorReading, ACellStandsWhereTheArcSaysAndNamesItsRegion) {
  const product::Product product = handle();
  const Axis axis = axis_of(product);
  const Vec3 seam = axis.along.unitOrthogonal();
  const Vec3 side = axis.along.cross(seam);
  Presser presser;
  // A quarter round, 31.4 mm from the seam: column 7 of 5 mm. 12.5 mm above the middle of 32 rows:
  // row 19.
  presser.add(axis.middle + kRadius * side + 12.5 * axis.along, 2.0, hand::Region::kIndexDistal);
  // Half round, 62.8 mm: column 13; 2.5 mm below the middle: row 16.
  presser.add(axis.middle - kRadius * seam - 2.5 * axis.along, 3.0, hand::Region::kThenar);
  const SensorReading reading =
      sensor_reading(presser.hand, product, {}, presser.contact, mat(axis, seam));
  EXPECT_EQ(reading.rows, 32);
  EXPECT_EQ(reading.columns, 26);  // 125.7 mm round
  const SensorCell& quarter = cell_at(reading, 19, 7);
  EXPECT_NEAR(quarter.force, 2.0, 1e-9);
  EXPECT_NEAR(quarter.mean_pressure, 2.0 / 25.0, 1e-9);
  EXPECT_EQ(quarter.region, hand::Region::kIndexDistal);
  EXPECT_NEAR(cell_at(reading, 16, 13).force, 3.0, 1e-9);
  EXPECT_EQ(cell_at(reading, 16, 13).region, hand::Region::kThenar);
  EXPECT_FALSE(cell_at(reading, 1, 1).region);
  EXPECT_NEAR(reading.force, 5.0, 1e-12);
  EXPECT_NEAR(reading.force_beside, 0.0, 1e-12);
  EXPECT_NEAR(reading.peak_pressure, 3.0 / 25.0, 1e-9);
  // The last column has the room that is left of the girth.
  EXPECT_NEAR(cell_at(reading, 16, 26).area, 5.0 * (2.0 * std::numbers::pi * kRadius - 125.0), 0.5);
}

TEST(SensorReading, CellsAndWhatPressesBesideThemAddUpToTheForce) {
  const product::Product product = handle();
  const Axis axis = axis_of(product);
  const Vec3 seam = axis.along.unitOrthogonal();
  const Vec3 side = axis.along.cross(seam);
  Presser presser;
  double all = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double angle = 0.37 * k;
    const double force = 0.1 + 0.001 * k;
    presser.add(axis.middle + kRadius * (std::cos(angle) * seam + std::sin(angle) * side) +
                    (0.35 * k - 70.0) * axis.along,
                force, hand::Region::kRadialPalm);
    all += force;
  }
  // On the end: a mat isn't there.
  presser.add(axis.middle + 75.0 * axis.along + 3.0 * seam, 7.0, hand::Region::kHypothenar);
  all += 7.0;
  for (const int rows : {32, 8}) {
    SensorLayout layout = mat(axis, seam);
    layout.rows = rows;
    const SensorReading reading =
        sensor_reading(presser.hand, product, {}, presser.contact, layout);
    double cells = 0.0;
    for (const SensorCell& one : reading.cells) cells += one.force;
    EXPECT_NEAR(cells, reading.force, 1e-9);
    EXPECT_NEAR(cells + reading.force_beside, all, 1e-9);
    if (rows == 32) {
      EXPECT_NEAR(reading.force_beside, 7.0, 1e-9);
    } else {
      EXPECT_GT(reading.force_beside, 50.0);
    }
  }
}

TEST(SensorReading, AForceOnTheSeamIsSharedByTheFirstAndTheLastColumn) {
  const product::Product product = handle();
  const Axis axis = axis_of(product);
  const Vec3 seam = axis.along.unitOrthogonal();
  Presser presser;
  presser.add(axis.middle + kRadius * seam + 2.5 * axis.along, 1.0, hand::Region::kThenar);
  const SensorReading reading =
      sensor_reading(presser.hand, product, {}, presser.contact, mat(axis, seam));
  const double first = cell_at(reading, 17, 1).force;
  EXPECT_NEAR(first, 0.5, 1e-3);
  EXPECT_NEAR(first + cell_at(reading, 17, 26).force + cell_at(reading, 17, 25).force, 1.0, 1e-9);
}

TEST(SensorReading, FreeSensorsTakeWhatLiesOverThem) {
  const product::Product product = handle();
  const Axis axis = axis_of(product);
  const Vec3 seam = axis.along.unitOrthogonal();
  Presser presser;
  presser.add(axis.middle + kRadius * seam, 1.5, hand::Region::kThumbDistal);
  presser.add(axis.middle - kRadius * seam, 2.5, hand::Region::kIndexDistal);
  SensorLayout layout;
  layout.name = "pads";
  layout.kind = SensorKind::kFree;
  layout.sensors = {{"thumb", axis.middle + kRadius * seam, 80.0},
                    {"idle", axis.middle + kRadius * seam + 40.0 * axis.along, 80.0}};
  const SensorReading reading = sensor_reading(presser.hand, product, {}, presser.contact, layout);
  ASSERT_EQ(reading.cells.size(), 2U);
  EXPECT_EQ(reading.cells[0].patch, "thumb");
  EXPECT_NEAR(reading.cells[0].force, 1.5, 1e-9);
  EXPECT_EQ(reading.cells[0].region, hand::Region::kThumbDistal);
  EXPECT_EQ(reading.cells[1].force, 0.0);
  EXPECT_NEAR(reading.force_beside, 2.5, 1e-9);
}

TEST(SensorReading, RefusesLayoutsThatDontFit) {
  const product::Product product = handle();
  const Axis axis = axis_of(product);
  const Vec3 seam = axis.along.unitOrthogonal();
  Presser presser;
  presser.add(axis.middle + kRadius * seam, 1.0, hand::Region::kThenar);
  const auto read = [&](const SensorLayout& layout) {
    return [&presser, &product, layout] {
      sensor_reading(presser.hand, product, {}, presser.contact, layout);
    };
  };
  SensorLayout layout = mat(axis, seam);
  layout.pitch = 0.5;
  EXPECT_THAT(read(layout), ThrowsMessage<UsageError>(HasSubstr("pitch is 0.5 mm; 1 to 50 mm")));
  layout = mat(axis, axis.along);
  EXPECT_THAT(read(layout), ThrowsMessage<UsageError>(HasSubstr("the seam lies along the axis")));
  layout = mat(axis, seam);
  layout.origin = axis.middle + 900.0 * axis.along;
  EXPECT_THAT(read(layout), ThrowsMessage<UsageError>(HasSubstr("don't meet the product")));
  layout = *sensor_layout_named("glove");
  layout.patches.push_back(layout.patches.front());
  EXPECT_THAT(read(layout), ThrowsMessage<UsageError>(HasSubstr("two patches on")));
  EXPECT_FALSE(sensor_layout_named("carpet"));
  for (const SensorLayout& one : sensor_layouts()) EXPECT_NO_THROW(one.check()) << one.name;
}

}  // namespace
}  // namespace palmar::study
