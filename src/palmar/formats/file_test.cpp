// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string read_message(const std::filesystem::path& path) {
  return message_of<InputError>([&] { read_file(path); });
}
std::string write_message(const std::filesystem::path& path, std::string_view bytes = "x") {
  return message_of<OutputError>([&] { write_file(path, bytes); });
}
std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Runs `body` in a child process; returns its exit code.
template <typename Body>
int in_child(const Body& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(File, WrittenBytesReadBackUnchanged) {
  const TestFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  write_file(folder / "f.bin", bytes);
  EXPECT_EQ(read_file(folder / "f.bin"), bytes);
  write_file(folder / "f.bin", "shorter");
  EXPECT_EQ(read_file(folder / "f.bin"), "shorter");
  EXPECT_EQ(entries(folder.path()), 1u) << "a temporary file was left behind";
}

TEST(File, ReadingReportsWhatIsWrongWithThePath) {
  const TestFolder folder;
  const std::string name = (folder / "no.stl").string();
  EXPECT_EQ(read_message(folder / "no.stl"), name + ": no such file");
  EXPECT_EQ(read_message(folder.path()),
            folder.path().string() + ": is a directory; a file is required");
  std::ofstream(folder / "empty.stl");
  EXPECT_EQ(read_message(folder / "empty.stl"),
            (folder / "empty.stl").string() + ": is empty (0 bytes)");
  EXPECT_THAT(read_message("/dev/zero"),
              HasSubstr("is a pipe or device; a regular file is required"));
  EXPECT_THAT(read_message(folder / "empty.stl" / "x"), HasSubstr("Not a directory"));
}

TEST(File, APipeThatNobodyWritesToIsRefusedAtOnce) {
  const TestFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(read_message(folder / "pipe"), HasSubstr("is a pipe or device"));
}

TEST(File, TooLargeInputNamesBothSizes) {
  const TestFolder folder;
  write_file(folder / "f", "12345");
  EXPECT_THAT(message_of<InputError>([&] { read_file(folder / "f", 4); }),
              HasSubstr("has 5 bytes; up to 4 are read"));
}

TEST(File, UnreadableAndUnwritablePathsNameThePermission) {
  if (::getuid() != 0) {
    const TestFolder folder;
    write_file(folder / "f", "x");
    ::chmod((folder / "f").c_str(), 0);
    EXPECT_THAT(read_message(folder / "f"), HasSubstr("can't be read: Permission denied"));
    ::chmod(folder.path().c_str(), 0500);
    EXPECT_THAT(write_message(folder / "g"), HasSubstr("can't be written: Permission denied"));
    ::chmod(folder.path().c_str(), 0700);
    return;
  }
  // The superuser may read everything: ask as somebody else.
  const TestFolder folder;
  write_file(folder / "f", "x");
  ::chmod((folder / "f").c_str(), 0);
  const int failures = in_child([&] {
    if (::setgid(65534) != 0 || ::setuid(65534) != 0) return 77;
    int wrong = 0;
    if (!read_message(folder / "f").ends_with("can't be read: Permission denied")) wrong |= 1;
    if (!write_message(folder / "g").ends_with("can't be written: Permission denied")) wrong |= 2;
    return wrong;
  });
  if (failures == 77) GTEST_SKIP() << "this system does not let a test change its user";
  EXPECT_EQ(failures, 0);
}

TEST(File, WritingIntoAMissingFolderNamesIt) {
  const TestFolder folder;
  const std::string message = write_message(folder / "a" / "b.json");
  EXPECT_THAT(message, StartsWith((folder / "a" / "b.json").string()));
  EXPECT_THAT(message, HasSubstr("folder " + (folder / "a").string() + " does not exist"));
  EXPECT_THAT(message, HasSubstr("No such file or directory"));
  EXPECT_THAT(write_message(folder.path()), HasSubstr("is a directory"));
}

TEST(File, AFullDiskIsNamed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  EXPECT_EQ(write_message("/dev/full"), "/dev/full: can't be written: No space left on device");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "the device was replaced";
}

TEST(File, AFailedWriteKeepsTheOldFileAndLeavesNothingBehind) {
  const TestFolder folder;
  write_file(folder / "f", "old");
  // A file-size limit stops the write half-way, as a full disk does.
  const int wrong = in_child([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{.rlim_cur = 1000, .rlim_max = 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    return write_message(folder / "f", std::string(5000, 'n')).ends_with("File too large") ? 0 : 1;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(read_file(folder / "f"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(File, WritingThroughALinkKeepsTheLinkAndTheMode) {
  const TestFolder folder;
  write_file(folder / "target", "old");
  ::chmod((folder / "target").c_str(), 0640);
  std::filesystem::create_symlink("target", folder / "link");
  write_file(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "target"), "new");
  struct stat status {};
  ::stat((folder / "target").c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(CreateFolder, MakesParentsAndNamesWhatStandsInTheWay) {
  const TestFolder folder;
  create_folder(folder / "a/b/c");
  create_folder(folder / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
  write_file(folder / "file", "x");
  EXPECT_THAT(message_of<OutputError>([&] { create_folder(folder / "file"); }),
              StartsWith((folder / "file").string() + ": folder can't be made: "));
  EXPECT_THAT(message_of<OutputError>([&] { create_folder(folder / "file/inside"); }),
              HasSubstr("Not a directory"));
}

}  // namespace
}  // namespace palmar::formats
