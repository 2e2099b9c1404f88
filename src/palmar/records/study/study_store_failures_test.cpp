// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_store.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/records/study/study_store_fixture.h"

namespace palmar::records {
namespace {

namespace fs = std::filesystem;
using study_fixture::make_store;
using study_fixture::record_for;
using study_fixture::small_study;
using study_fixture::Study;
using ::testing::HasSubstr;

TEST(StudyStore, OneProcessWritesAtATime) {
  const formats::TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  {
    StudyStore store(path, StudyAccess::kWrite);
    store.keep(record_for(0));
    // The locks belong to processes, so another one has to ask.
    for (const auto access : {StudyAccess::kWrite, StudyAccess::kRead}) {
      const pid_t child = fork();
      if (child == 0) {
        int code = 1;
        try {
          const StudyStore second(path, access);
        } catch (const StudyBusy& busy) {
          code = std::string(busy.what()).find("a.palmar: in use by another process") ==
                         std::string::npos
                     ? 2
                     : 0;
        } catch (...) {
          code = 3;
        }
        _exit(code);
      }
      int status = -1;
      waitpid(child, &status, 0);
      EXPECT_EQ(status, 0);
    }
    store.keep(record_for(1));
  }
  EXPECT_EQ(StudyStore(path).done().size(), 2U);
}

// `study status` in a loop reads for some milliseconds at a time; a run that starts then waits.
TEST(StudyStore, AWriterWaitsForReaders) {
  const formats::TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  int reading[2];
  ASSERT_EQ(pipe(reading), 0);
  const pid_t child = fork();
  if (child == 0) {
    sqlite3* file = nullptr;
    const bool is_read = sqlite3_open(path.c_str(), &file) == SQLITE_OK &&
                         sqlite3_exec(file, "BEGIN; SELECT count(*) FROM sqlite_schema", nullptr,
                                      nullptr, nullptr) == SQLITE_OK;
    const bool is_told = write(reading[1], "r", 1) == 1;
    usleep(300'000);
    _exit(is_read && is_told ? 0 : 1);  // without COMMIT: the end of the process ends it
  }
  char byte = 0;
  ASSERT_EQ(read(reading[0], &byte, 1), 1);
  StudyStore(path, StudyAccess::kWrite).keep(record_for(0));
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(StudyStore(path).done().size(), 1U);
}

TEST(StudyStore, KillingTheWriterLosesNothingThatWasKept) {
  const formats::TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  const std::vector<std::int64_t> all = study::tasks_of(study.plan);
  for (int round = 0; StudyStore(path).missing().size() > 0; ++round) {
    ASSERT_LT(round, 40);
    int channel[2];
    ASSERT_EQ(pipe(channel), 0);
    const pid_t child = fork();
    if (child == 0) {
      StudyStore store(path, StudyAccess::kWrite);
      for (const std::int64_t number : store.missing()) {
        store.keep(record_for(number));
        const char number_kept = static_cast<char>(number);
        if (write(channel[1], &number_kept, 1) != 1) _exit(1);
      }
      close(channel[1]);  // a parent that waits for a second one when one was left
      pause();
      _exit(0);
    }
    close(channel[1]);
    // Killed right after it reported the second grasp: while it keeps the third.
    char number_kept = 0;
    std::int64_t last = -1;
    for (int i = 0; i < 2 && read(channel[0], &number_kept, 1) == 1; ++i) last = number_kept;
    if (round % 2 == 1) std::this_thread::sleep_for(std::chrono::microseconds(300 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(channel[0]);
    const std::vector<std::int64_t> done = StudyStore(path).done();
    if (last < 0) continue;
    EXPECT_TRUE(std::binary_search(done.begin(), done.end(), last)) << round;
  }
  StudyStore(path, StudyAccess::kWrite).finish();
  make_store(folder / "whole.palmar", study, all);
  EXPECT_EQ(formats::read_file(path), formats::read_file(folder / "whole.palmar"));
}

TEST(StudyStore, DamagedFilesAreNamed) {
  const formats::TestFolder folder;
  const Study study = small_study();
  make_store(folder / "good.palmar", study, study::tasks_of(study.plan));
  const std::string good = formats::read_file(folder / "good.palmar");
  const fs::path bad = folder / "bad.palmar";
  const auto outcome = [&](const std::string& bytes) {
    formats::write_file(bad, bytes);
    return formats::message_of<InputError>([&] {
      const StudyStore store(bad);
      store.inputs();
      store.for_each(true, [](const study::StudyRecord&) {});
    });
  };
  EXPECT_EQ(outcome(good), "");
  EXPECT_THAT(outcome("no study at all, but text"), HasSubstr("bad.palmar: is no study of Palmar"));
  EXPECT_THAT(outcome(good.substr(0, 50)), HasSubstr("bad.palmar: is no study of Palmar"));
  for (const std::size_t length : {std::size_t{4096}, good.size() / 3, good.size() - 16384}) {
    EXPECT_THAT(outcome(good.substr(0, length)), HasSubstr("bad.palmar: is damaged")) << length;
  }
  std::string newer = good;
  EXPECT_EQ(newer[63], 1);  // no faces: every Palmar reads it
  newer[63] = 3;
  EXPECT_THAT(outcome(newer), HasSubstr("bad.palmar: study of version 3; this program reads up to "
                                        "version 2 (a newer Palmar wrote it)"));
  // One byte of a value: the same file for SQLite, another result.
  const double force = record_for(4).force;
  std::string big_endian(reinterpret_cast<const char*>(&force), sizeof force);
  std::reverse(big_endian.begin(), big_endian.end());
  const std::size_t at = good.find(big_endian);
  ASSERT_NE(at, good.npos);
  std::string flipped = good;
  flipped[at + 7] ^= 1;
  EXPECT_THAT(outcome(flipped), HasSubstr("bad.palmar: grasp 4 is damaged"));
  EXPECT_THAT(formats::message_of<InputError>([&] { StudyStore(folder / "none.palmar"); }),
              HasSubstr("none.palmar: no such file"));
  EXPECT_THAT(formats::message_of<InputError>([&] { StudyStore(folder.path()); }),
              HasSubstr("is a directory"));
  // Any byte: named or without effect, never a crash.
  for (std::size_t i = 100; i < good.size(); i += 997) {
    std::string changed = good;
    changed[i] = static_cast<char>(changed[i] ^ 0x55);
    const std::string said = outcome(changed);
    EXPECT_TRUE(said.empty() || said.find("bad.palmar") != said.npos) << said;
  }
}

TEST(StudyStore, FoldersThatCantBeWrittenAreNamed) {
  const formats::TestFolder folder;
  const Study study = small_study();
  EXPECT_THAT(formats::message_of<OutputError>(
                  [&] { StudyStore::create(folder / "none/a.palmar", study.plan, study.inputs); }),
              HasSubstr("does not exist"));
  make_store(folder / "a.palmar", study, study::tasks_of(study.plan));
  EXPECT_THAT(formats::message_of<OutputError>(
                  [&] { StudyStore::create(folder / "a.palmar", study.plan, study.inputs); }),
              HasSubstr("a.palmar: is there already"));
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(StudyStore(folder / "a.palmar").done().size(), 20U) << "reading needs no permission";
  EXPECT_NE(formats::message_of<OutputError>(
                [&] { StudyStore::create(folder / "b.palmar", study.plan, study.inputs); }),
            "");
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(StudyStore, AFullDiskIsNamedAndLosesNothing) {
  const formats::TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  const pid_t child = fork();
  if (child == 0) {
    // No file may grow beyond what the store has now and a little more.
    signal(SIGXFSZ, SIG_IGN);
    const auto size = static_cast<rlim_t>(120'000);
    const struct rlimit limit = {size, size};
    setrlimit(RLIMIT_FSIZE, &limit);
    int kept = 0;
    try {
      StudyStore store(path, StudyAccess::kWrite);
      for (const std::int64_t number : store.missing()) {
        store.keep(record_for(number));
        ++kept;
      }
    } catch (const OutputError& error) {
      const bool is_named =
          std::string(error.what()).find("a.palmar: the disk ") != std::string::npos;
      _exit(is_named ? 100 + kept : 1);
    } catch (...) {
      _exit(2);
    }
    _exit(3);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_GE(WEXITSTATUS(status), 100) << "no named outcome";
  EXPECT_EQ(std::ssize(StudyStore(path).done()), WEXITSTATUS(status) - 100);
}

}  // namespace
}  // namespace palmar::records
