// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/product_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/mesh/test_archives.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(LoadProduct, TheUnitOfTheFileOrOfTheUserTurnsIntoMillimetres) {
  const formats::TestFolder folder;
  formats::write_file(folder / "handle.3mf", formats::box_three_mf({4, 1, 1}, "unit=\"inch\""));
  const product::Product from_file = load_product(folder / "handle.3mf");
  EXPECT_EQ(from_file.name, "handle");
  EXPECT_EQ(from_file.unit_source, product::UnitSource::kFile);
  EXPECT_NEAR(formats::signed_volume(from_file.mesh), 4 * 25.4 * 25.4 * 25.4, 1e-6);

  formats::write_mesh(folder / "handle.stl", formats::box_mesh({12, 3, 3}));
  const product::Product from_user =
      load_product(folder / "handle.stl", {.unit = geometry::LengthUnit::kCentimetre});
  EXPECT_EQ(from_user.unit_source, product::UnitSource::kUser);
  EXPECT_NEAR(formats::signed_volume(from_user.mesh), 108000.0, 1e-6);
  // Inside: in the very middle, and 7 mm from the nearest side.
  EXPECT_NEAR(from_user.distance->at(Vec3(60, 15, 15)).distance, -15.0, 1e-9);
  EXPECT_NEAR(from_user.distance->at(Vec3(33, 7, 9)).distance, -7.0, 1e-9);
}

TEST(LoadProduct, AnUndecidableUnitAndAnAbsurdSizeAreRefusedByName) {
  const formats::TestFolder folder;
  formats::write_mesh(folder / "a.stl", formats::box_mesh({12, 3, 3}));
  const std::string undecided =
      formats::message_of<InputError>([&] { load_product(folder / "a.stl"); });
  EXPECT_THAT(undecided, StartsWith((folder / "a.stl").string()));
  EXPECT_THAT(undecided, HasSubstr("setting \"unit\""));
  formats::write_mesh(folder / "b.stl", formats::box_mesh({1e9, 1e8, 1e8}));
  EXPECT_THAT(formats::message_of<InputError>([&] {
                load_product(folder / "b.stl", {.unit = geometry::LengthUnit::kMillimetre});
              }),
              StartsWith((folder / "b.stl").string()));
}

}  // namespace
}  // namespace palmar::records
