// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/upload_drawer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::server {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class Uploads : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "palmar_uploads_XXXXXX").string();
    test_folder = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(test_folder); }
  fs::path test_folder;
};

TEST_F(Uploads, FilesOfOneKeyStandInTheirFolders) {
  UploadDrawer drawer(test_folder / "uploads");
  drawer.add("k1", "reference/p0_c1.jpg", "a");
  drawer.add("k1", "reference/p0_c2.jpg", "b");
  drawer.add("k2", "photo.png", "c");
  EXPECT_THAT(files_under(drawer.folder("k1")),
              ElementsAre("reference/p0_c1.jpg", "reference/p0_c2.jpg"));
  EXPECT_EQ(formats::read_file(drawer.folder("k2") / "photo.png"), "c");
  drawer.forget("k1");
  EXPECT_THROW(drawer.folder("k1"), UsageError);
  EXPECT_FALSE(fs::exists(test_folder / "uploads" / "k1"));
}

TEST_F(Uploads, NoNameLeavesItsFolder) {
  UploadDrawer drawer(test_folder / "uploads");
  for (const char* name : {"../../evil.sh", "/etc/passwd", "..\\..\\evil", "a/../../b", "./.x"}) {
    drawer.add("k", name, "x");
  }
  const fs::path folder = drawer.folder("k");
  EXPECT_EQ(files_under(test_folder).size(), files_under(folder).size())
      << "all of them are in the key's folder";
  for (const char* key : {"", "..", "a/b", "a b"}) {
    EXPECT_THROW(drawer.add(key, "a.png", "x"), UsageError) << key;
  }
  for (const char* name : {"", "/", "a/b/c/d/e/f"}) {
    EXPECT_THROW(drawer.add("k", name, "x"), UsageError) << name;
  }
  drawer.add("k", "folder/a.png", "x");
  EXPECT_THROW(drawer.add("k", "folder", "x"), UsageError);
  EXPECT_THROW(drawer.add("k", "folder/a.png/b.png", "x"), UsageError);
}

TEST_F(Uploads, LinksAreNoFiles) {
  fs::create_directories(test_folder / "found");
  fs::create_symlink("/etc/passwd", test_folder / "found" / "passwd");
  formats::write_file(test_folder / "found" / "skin.ply", "x");
  EXPECT_THAT(files_under(test_folder), ElementsAre("found/skin.ply"));
  EXPECT_TRUE(files_under(test_folder / "nothing").empty());
}

TEST_F(Uploads, KeysAreFew) {
  UploadDrawer drawer(test_folder / "uploads");
  for (std::size_t k = 0; k < UploadDrawer::kMostKeys; ++k) {
    drawer.add("k" + std::to_string(k), "a.png", "x");
  }
  EXPECT_THROW(drawer.add("more", "a.png", "x"), UsageError);
  drawer.forget("k0");
  drawer.add("more", "a.png", "x");
}

}  // namespace
}  // namespace palmar::server
