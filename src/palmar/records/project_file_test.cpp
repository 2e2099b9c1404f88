// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/project_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class ProjectFile : public ::testing::Test {
 protected:
  fs::path written(const std::string& text) const {
    formats::write_file(test_folder / "project.toml", text);
    return test_folder / "project.toml";
  }
  std::string message(const std::string& text) const {
    try {
      read_project(written(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  formats::TestFolder test_folder;
};

TEST_F(ProjectFile, HasNameAuthorNotesAndLogo) {
  formats::write_file(test_folder / "logo.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
  const Project project = read_project(written(
      "name = \"Knife\"\nauthor = \"Studio\"\nnotes = \"Second round.\"\nlogo = \"logo.svg\"\n"));
  EXPECT_EQ(project.name, "Knife");
  EXPECT_EQ(project.author, "Studio");
  EXPECT_EQ(project.notes, "Second round.");
  EXPECT_EQ(project.logo_type, "image/svg+xml");
  EXPECT_FALSE(project.is_empty());
  EXPECT_TRUE(read_project(written("name = \"\"\n")).is_empty());
}

TEST_F(ProjectFile, SaysWhatIsWrongWithLineAndKey) {
  EXPECT_THAT(message("nmae = \"x\"\n"), AllOf(HasSubstr("project.toml:1"), HasSubstr("name")));
  EXPECT_THAT(message("name = \"x\"\nlogo = \"nothing.png\"\n"),
              AllOf(HasSubstr("project.toml:2"), HasSubstr("nothing.png"), HasSubstr("read")));
  formats::write_file(test_folder / "text.png", "no picture");
  EXPECT_THAT(message("logo = \"text.png\"\n"), HasSubstr("no PNG, JPEG or SVG"));
  formats::write_file(test_folder / "large.png", "\x89PNG\r\n\x1a\n" + std::string(1'000'001, 'x'));
  EXPECT_THAT(message("logo = \"large.png\"\n"), HasSubstr("at most 1000000"));
  EXPECT_THAT(message("notes = \"" + std::string(401, 'x') + "\"\n"), HasSubstr("401 letters"));
  EXPECT_THAT(message("name = 3\n"), HasSubstr("name"));
}

}  // namespace
}  // namespace palmar::records
