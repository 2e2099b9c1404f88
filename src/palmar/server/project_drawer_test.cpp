// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/project_drawer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/server/data_folder.h"

namespace palmar::server {
namespace {

namespace fs = std::filesystem;

class Drawer : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "palmar_drawer_XXXXXX").string();
    test_folder = mkdtemp(name.data());
    product.file_name = "cup.stl";
    product.argument = "mine/cup.stl";
    product.unit = geometry::LengthUnit::kCentimetre;
    product.path = test_folder / "cup.stl";
    formats::write_file(product.path, "the cup");
  }
  void TearDown() override { fs::remove_all(test_folder); }

  fs::path test_folder;
  ShelvedProduct product;
};

TEST_F(Drawer, KeepsAndOpensWithItsOwnCopyOfTheProduct) {
  {
    ProjectDrawer drawer(test_folder / "data" / "projects");
    EXPECT_TRUE(drawer.list().empty());
    drawer.keep("a1", product,
                R"({"state": {"hold": 3}, "picture": "data:image/png;base64,AA", "history": [1]})");
  }
  fs::remove(product.path);
  const ProjectDrawer again(test_folder / "data" / "projects");
  ASSERT_EQ(again.list().size(), 1U);
  EXPECT_EQ(again.list()[0].file_name, "cup.stl");
  EXPECT_EQ(again.list()[0].picture, "data:image/png;base64,AA");
  const ProjectDrawer::Opened opened = again.open("a1");
  EXPECT_EQ(formats::read_file(opened.product.path), "the cup");
  EXPECT_EQ(opened.product.argument, "mine/cup.stl");
  EXPECT_EQ(opened.product.unit, geometry::LengthUnit::kCentimetre);
  EXPECT_EQ(opened.state, R"({"hold":3})");
  EXPECT_EQ(opened.history, "[1]");
}

TEST_F(Drawer, NewestFirstAndTheOldestGoes) {
  ProjectDrawer drawer(test_folder);
  for (std::size_t k = 0; k < ProjectDrawer::kMost + 2; ++k) {
    drawer.keep("p" + std::to_string(k), product, R"({"state": {}})");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const auto all = drawer.list();
  ASSERT_EQ(all.size(), ProjectDrawer::kMost);
  EXPECT_EQ(all.front().key, "p" + std::to_string(ProjectDrawer::kMost + 1));
  EXPECT_EQ(all.back().key, "p2");
  EXPECT_THROW(drawer.open("p0"), UsageError);
  drawer.remove("p5");
  EXPECT_EQ(drawer.list().size(), ProjectDrawer::kMost - 1);
  EXPECT_THROW(drawer.remove("p5"), UsageError);
}

TEST_F(Drawer, StaysInItsFolderAndRefusesWhatIsNoProject) {
  ProjectDrawer drawer(test_folder / "projects");
  for (const char* key : {"", "..", "a/b", "a.b", "../../etc"}) {
    EXPECT_THROW(drawer.keep(key, product, R"({"state": {}})"), UsageError) << key;
    EXPECT_THROW(drawer.open(key), UsageError) << key;
    EXPECT_THROW(drawer.remove(key), UsageError) << key;
  }
  for (const char* content : {"", "[]", "{}", R"({"state": 7})", "{"}) {
    EXPECT_THROW(drawer.keep("a", product, content), UsageError) << content;
  }
  EXPECT_TRUE(drawer.list().empty());
  // A picture that is too large or none is left out; the project is kept.
  drawer.keep(
      "a", product,
      R"({"state": {}, "picture": "data:image/png;base64,)" + std::string(90'000, 'A') + "\"}");
  EXPECT_EQ(drawer.list()[0].picture, "");
}

TEST_F(Drawer, DamagedProjectsAreLeftOut) {
  ProjectDrawer drawer(test_folder);
  drawer.keep("good", product, R"({"state": {}})");
  drawer.keep("cut", product, R"({"state": {}})");
  formats::write_file(test_folder / "cut" / "project.json", "{\"palmar_kept\": 1");
  drawer.keep("away", product, R"({"state": {}, "history": [1]})");
  formats::write_file(test_folder / "away" / "history.json", "[1");
  ASSERT_EQ(drawer.list().size(), 2U);
  EXPECT_EQ(drawer.open("away").history, "null");
  fs::remove(test_folder / "away" / "product" / "cup.stl");
  EXPECT_THROW(drawer.open("away"), InputError);
}

TEST_F(Drawer, WithoutAFolderNothingIsKeptAndThatIsSaid) {
  ProjectDrawer drawer(std::nullopt);
  EXPECT_TRUE(drawer.list().empty());
  EXPECT_THROW(drawer.keep("a", product, R"({"state": {}})"), OutputError);
  ProjectDrawer full(fs::path("/dev/null/projects"));
  EXPECT_THROW(full.keep("a", product, R"({"state": {}})"), OutputError);
}

TEST(DataFolder, IsWhereXdgSays) {
  const char* const before = std::getenv("XDG_DATA_HOME");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("XDG_DATA_HOME", "/data", 1);
  EXPECT_EQ(user_data_folder(), "/data/palmar");
  ::setenv("XDG_DATA_HOME", "relative", 1);
  ::setenv("HOME", "/home/anna", 1);
  EXPECT_EQ(user_data_folder(), "/home/anna/.local/share/palmar");
  ::unsetenv("XDG_DATA_HOME");
  ::unsetenv("HOME");
  EXPECT_EQ(user_data_folder(), std::nullopt);
  if (before != nullptr) ::setenv("XDG_DATA_HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace palmar::server
