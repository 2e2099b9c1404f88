// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::formats {
namespace {

std::string system_text(int error) { return std::generic_category().message(error); }

/// Closes a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  /// Closes now; returns the error or 0. Some file systems report a full disk only here.
  int close() {
    const int result = ::close(fd_) == 0 ? 0 : errno;
    fd_ = -1;
    return result;
  }

 private:
  int fd_;
};

/// Writes all bytes; returns the error or 0.
int write_all(int fd, std::string_view bytes) {
  constexpr std::size_t kChunk = std::size_t{1} << 28;  // one call writes 2 GiB at most on Linux
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), std::min(bytes.size(), kChunk));
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

[[noreturn]] void fail_output(const std::filesystem::path& path, int error) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::string reason = system_text(error);
  std::error_code ignored;
  if (error == ENOENT && !std::filesystem::exists(folder, ignored)) {
    reason = "folder " + folder.string() + " does not exist (" + reason + ")";
  }
  throw OutputError(path.string() + ": can't be written: " + reason);
}

/// Removes the temporary file unless it was renamed.
struct TemporaryFile {
  std::filesystem::path path;
  bool kept = false;
  ~TemporaryFile() {
    if (!kept) ::unlink(path.c_str());
  }
};

}  // namespace

namespace {

/// An input opened and looked at: a regular file that isn't empty.
struct OpenInput {
  Descriptor file;
  std::uint64_t size = 0;
};

OpenInput open_input(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const std::string name = path.string();
  // O_NONBLOCK: opening a pipe that nobody writes to would wait for ever.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) {
    if (errno == ENOENT) throw InputError(name + ": no such file");
    throw InputError(name + ": can't be read: " + system_text(errno));
  }
  OpenInput input{Descriptor(fd)};
  struct stat status {};
  if (::fstat(fd, &status) != 0) {
    throw InputError(name + ": can't be read: " + system_text(errno));
  }
  if (S_ISDIR(status.st_mode)) throw InputError(name + ": is a directory; a file is required");
  if (!S_ISREG(status.st_mode)) {
    throw InputError(name + ": is a pipe or device; a regular file is required");
  }
  input.size = static_cast<std::uint64_t>(status.st_size);
  if (input.size == 0) throw InputError(name + ": is empty (0 bytes)");
  if (input.size > max_bytes) {
    throw InputError(name + ": has " + std::to_string(input.size) + " bytes; up to " +
                     std::to_string(max_bytes) + " are read");
  }
  return input;
}

std::string read_part(const OpenInput& input, std::uint64_t offset, std::size_t size,
                      const std::string& name) {
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(input.file.get(), bytes.data() + done, size - done,
                                static_cast<off_t>(offset + done));
    if (got < 0) {
      if (errno == EINTR) continue;
      throw InputError(name + ": can't be read: " + system_text(errno));
    }
    if (got == 0) break;  // shortened while being read
    done += static_cast<std::size_t>(got);
  }
  if (done != size) {
    throw InputError(name + ": changed while it was read: " + std::to_string(offset + done) +
                     " of " + std::to_string(input.size) + " bytes");
  }
  return bytes;
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const OpenInput input = open_input(path, max_bytes);
  return read_part(input, 0, static_cast<std::size_t>(input.size), path.string());
}

FileEnds read_ends(const std::filesystem::path& path, std::size_t size) {
  const OpenInput input = open_input(path, kMaxInputBytes);
  const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(size, input.size));
  const std::string name = path.string();
  return {read_part(input, 0, part, name), read_part(input, input.size - part, part, name),
          input.size};
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  if (path.empty() || !path.has_filename()) {
    throw OutputError("\"" + path.string() + "\": can't be written: a file name is required");
  }
  // A rename would replace a link instead of what it points to.
  std::error_code no_link;
  std::filesystem::path target = std::filesystem::canonical(path, no_link);
  if (no_link) target = path;

  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    throw OutputError(path.string() + ": can't be written: is a directory");
  }
  if (exists && !S_ISREG(status.st_mode)) {
    Descriptor device(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (device.get() < 0) fail_output(path, errno);
    if (const int error = write_all(device.get(), bytes)) fail_output(path, error);
    if (const int error = device.close()) fail_output(path, error);
    return;
  }

  static std::atomic<unsigned> counter{0};
  std::string temporary_name(".");
  temporary_name.append(target.filename().string()).append(".");
  temporary_name.append(std::to_string(::getpid())).append("-");
  temporary_name.append(std::to_string(counter++)).append(".tmp");
  TemporaryFile temporary{target.parent_path() / temporary_name};
  const mode_t mode = exists ? status.st_mode & 07777 : 0666;
  Descriptor file(::open(temporary.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
  if (file.get() < 0) {
    const int error = errno;
    temporary.kept = true;  // not ours
    fail_output(path, error);
  }
  if (const int error = write_all(file.get(), bytes)) fail_output(path, error);
  if (::fsync(file.get()) != 0) fail_output(path, errno);
  if (const int error = file.close()) fail_output(path, error);
  if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail_output(path, errno);
  temporary.kept = true;
}

void create_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error && !std::filesystem::is_directory(path, error) && !error) {
    error = std::make_error_code(std::errc::not_a_directory);
  }
  if (error) {
    throw OutputError(path.string() + ": folder can't be made: " + error.message());
  }
}

}  // namespace palmar::formats
