// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_open.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/records/study/study_tables.h"

namespace palmar::records {

namespace fs = std::filesystem;

namespace {

/// Refuses what is no store by the file's first bytes, before SQLite looks at it.
void check_header(const fs::path& path) {
  constexpr std::size_t kHeader = 100;        // bytes; SQLite's file format, section 1.3
  constexpr std::size_t kUserVersion = 60;    // big endian
  constexpr std::size_t kApplicationId = 68;  // big endian
  const std::string name = path.string();
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(name + ": no such file");
  if (fs::is_directory(status)) throw InputError(name + ": is a directory; a file is required");
  std::ifstream file(path, std::ios::binary);
  std::string header(kHeader, '\0');
  file.read(header.data(), static_cast<std::streamsize>(kHeader));
  if (!file && file.gcount() == 0 && !file.eof()) throw InputError(name + ": can't be read");
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  if (file.gcount() < static_cast<std::streamsize>(kHeader) ||
      header.compare(0, kMagic.size(), kMagic) != 0 ||
      formats::read_value<std::int32_t>(header, kApplicationId, std::endian::big) !=
          kStudyApplicationId) {
    throw InputError(name + ": is no study of Palmar");
  }
  const auto version = formats::read_value<std::int32_t>(header, kUserVersion, std::endian::big);
  if (version > kStudyStoreVersion || version < 1) {
    throw InputError(name + ": study of version " + std::to_string(version) +
                     "; this program reads up to version " + std::to_string(kStudyStoreVersion) +
                     (version > kStudyStoreVersion ? " (a newer Palmar wrote it)" : ""));
  }
}

/// Path as SQLite's URI for a file that nobody changes.
std::string immutable_uri(const fs::path& path) {
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      const auto byte = static_cast<unsigned char>(c);
      uri += '%';
      uri += "0123456789ABCDEF"[byte >> 4U];
      uri += "0123456789ABCDEF"[byte & 15U];
    } else {
      uri += c;
    }
  }
  return uri + "?immutable=1";
}

bool has_log(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path.string() + "-wal", error);
  return !error && size > 0;
}

/// Whether another process holds the store for writing: SQLite then has a write lock on the 510
/// bytes from 2^30 + 2, where readers have read locks (SQLite, "File Locking And Concurrency",
/// constants of os.h).
bool has_writer(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  struct flock lock = {};
  lock.l_type = F_RDLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = (1L << 30) + 2;
  lock.l_len = 510;
  const bool is_known = ::fcntl(fd, F_GETLK, &lock) == 0;
  ::close(fd);
  return is_known && lock.l_type == F_WRLCK;
}

/// The store for this process alone. Waits for readers, which are soon done (`study status` in a
/// loop), up to ten seconds; for a writer three, as one that was killed just now takes a moment to
/// be gone.
std::unique_ptr<SqliteFile> open_alone(const fs::path& path) {
  using std::chrono::seconds, std::chrono::steady_clock;
  const auto begin = steady_clock::now();
  while (true) {
    try {
      auto file = std::make_unique<SqliteFile>(path.string(), SQLITE_OPEN_READWRITE);
      // Exclusive before the first look: no shared memory, which network folders don't have.
      file->run(
          "PRAGMA locking_mode = EXCLUSIVE; PRAGMA synchronous = FULL; BEGIN EXCLUSIVE; COMMIT");
      return file;
    } catch (const SqliteFailure& failure) {
      const bool is_busy = failure.code == SQLITE_BUSY || failure.code == SQLITE_LOCKED;
      const auto patience = has_writer(path) ? seconds(3) : seconds(10);
      if (!is_busy || steady_clock::now() > begin + patience) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace

std::unique_ptr<SqliteFile> open_store(const fs::path& path, StudyAccess access) {
  check_header(path);
  std::unique_ptr<SqliteFile> file;
  if (access == StudyAccess::kWrite) {
    file = open_alone(path);
  } else {
    // For writing even to read: what a killed process left in its log is then taken in.
    file = std::make_unique<SqliteFile>(path.string(), SQLITE_OPEN_READWRITE);
    try {
      file->run("PRAGMA busy_timeout = 500");
      file->integer("SELECT count(*) FROM sqlite_schema");
    } catch (const SqliteFailure& failure) {
      const bool is_barred = failure.code == SQLITE_CANTOPEN || failure.code == SQLITE_READONLY;
      if (!is_barred || has_log(path)) throw;
      // A folder that may not be written to: then nobody else writes either.
      file =
          std::make_unique<SqliteFile>(immutable_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    }
  }
  const std::string verdict = file->text("PRAGMA quick_check(1)");
  if (verdict != "ok") throw InputError(path.string() + ": is damaged (" + verdict + ")");
  return file;
}

}  // namespace palmar::records
