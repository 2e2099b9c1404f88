// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/zip_write.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/formats/zip.h"

namespace palmar::formats {
namespace {

TEST(ZipWrite, IsReadBackByTheReader) {
  std::string noise;
  unsigned state = 1;
  for (int i = 0; i < 70000; ++i) {
    state = state * 1103515245u + 12345u;
    noise += static_cast<char>(state >> 24);
  }
  const std::string bytes =
      format_zip({{"a.txt", "one one one one"}, {"folder/ü.xml", ""}, {"noise", noise}});
  const ZipArchive archive(bytes, "made.zip");
  EXPECT_EQ(archive.read("a.txt"), "one one one one");
  EXPECT_EQ(archive.read("folder/ü.xml"), "");
  EXPECT_EQ(archive.read("noise"), noise);
  EXPECT_FALSE(archive.read("b.txt").has_value());
}

TEST(ZipWrite, AnotherProgramFindsNoFault) {
  if (std::system("unzip -v > /dev/null 2>&1") != 0) GTEST_SKIP() << "unzip isn't installed";
  const std::string file = own_file("written.zip");
  write_file(file, format_zip({{"a.txt", "one"}, {"b/c.txt", std::string(100000, 'x')}}));
  EXPECT_EQ(std::system(("unzip -tq '" + file + "' > /dev/null").c_str()), 0);
}

TEST(ZipWrite, SameMembersSameBytes) {
  const std::vector<ZipMember> members = {{"a", "text"}, {"b", "more"}};
  EXPECT_EQ(format_zip(members), format_zip(members));
  EXPECT_TRUE(ZipArchive(format_zip({}), "empty.zip").read("a") == std::nullopt);
}

TEST(ZipWrite, RefusesAnEmptyName) {
  try {
    format_zip({{"", "text"}});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "zip: a name of 0 bytes; 1 to 65535 are allowed");
  }
}

}  // namespace
}  // namespace palmar::formats
