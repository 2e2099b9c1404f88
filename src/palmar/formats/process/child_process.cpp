// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/process/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "palmar/core/error.h"

namespace palmar::formats {
namespace {

using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLimitsAddressSpace = false;
#else
constexpr bool kLimitsAddressSpace = true;
#endif

constexpr int kCannotStart = 127;
constexpr int kPollMilliseconds = 20;
constexpr std::size_t kLongestLine = 500;
constexpr double kMega = 1024.0 * 1024.0;

/// A file descriptor that closes itself.
class Handle {
 public:
  explicit Handle(int fd = -1) : fd_(fd) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  int get() const { return fd_; }
  void set(int fd) { fd_ = fd; }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

struct Pipe {
  Handle read, write;
};

bool open_pipe(Pipe& pipe) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return false;
  pipe.read.set(ends[0]);
  pipe.write.set(ends[1]);
  return true;
}

void set_limit(int resource, rlim_t value) {
  const struct rlimit limit = {value, value};
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

rlim_t bytes_of(double megabytes) { return static_cast<rlim_t>(megabytes * kMega); }

/// Runs between fork and exec: only calls that are safe there.
struct ChildStart {
  char* const* argv;
  int input, output, log;
  rlim_t memory, file, cpu_seconds;

  [[noreturn]] void run() const {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // even if the parent is killed
    if (::dup2(input, STDIN_FILENO) < 0 || ::dup2(output, STDOUT_FILENO) < 0 ||
        ::dup2(log, STDERR_FILENO) < 0) {
      ::_exit(kCannotStart);
    }
    if (::close_range(3, ~0U, 0) != 0) {
      constexpr int kMost = 4096;
      for (int fd = 3; fd < kMost; ++fd) ::close(fd);
    }
    ::signal(SIGPIPE, SIG_DFL);
    ::signal(SIGINT, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, cpu_seconds);
    set_limit(RLIMIT_FSIZE, file);
    if (kLimitsAddressSpace) set_limit(RLIMIT_AS, memory);
    ::execv(argv[0], argv);
    ::_exit(kCannotStart);
  }
};

/// Ends the child and its group if nobody else has.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() { kill(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  void kill() {
    if (pid_ < 0) return;
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
  }
  /// Whether it has ended; then with which status.
  bool has_ended(int& status) {
    pid_t got = 0;
    do {
      got = ::waitpid(pid_, &status, WNOHANG);
    } while (got < 0 && errno == EINTR);
    if (got == 0) return false;
    if (got < 0) status = kCannotStart << 8;  // someone else has waited for it
    pid_ = -1;
    return true;
  }

 private:
  pid_t pid_;
};

/// MB of address space (peak) and of resident memory; 0 if they can't be determined.
struct Memory {
  double peak = 0.0, resident = 0.0;
};
Memory memory_of(pid_t pid) {
  Memory memory;
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    const bool is_peak = line.rfind("VmPeak:", 0) == 0;
    if (!is_peak && line.rfind("VmRSS:", 0) != 0) continue;
    const double megabytes = std::strtod(line.c_str() + line.find(':') + 1, nullptr) / 1024.0;
    (is_peak ? memory.peak : memory.resident) = megabytes;
  }
  return memory;
}

/// Seconds of processor time that the threads of a process have used; 0 if it can't be determined.
double processor_time_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos) return 0.0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  constexpr int kBeforeTimes = 11;  // fields 3 to 13 of proc(5)
  for (int i = 0; i < kBeforeTimes; ++i) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

/// Whether a child has had its time.
bool is_over(const ChildLimits& limits, pid_t pid, double by_the_clock) {
  constexpr double kPatience = 5.0;
  if (!limits.is_processor_time) return by_the_clock > limits.seconds;
  if (by_the_clock <= limits.seconds / std::max(1U, std::thread::hardware_concurrency())) {
    return false;  // it can't have used that much
  }
  return processor_time_of(pid) > limits.seconds || by_the_clock > kPatience * limits.seconds;
}

/// Lines out of pieces as they come.
class Lines {
 public:
  void add(const char* bytes, std::size_t size,
           const std::function<void(const std::string&)>& on_line) {
    for (std::size_t i = 0; i < size; ++i) {
      if (bytes[i] == '\n') {
        if (on_line) on_line(line_);
        line_.clear();
      } else if (line_.size() < kLongestLine) {
        line_ += bytes[i];
      }
    }
  }

 private:
  std::string line_;
};

/// Takes what there is; false at the end.
bool read_available(int fd, Lines& lines, const std::function<void(const std::string&)>& on_line) {
  std::array<char, 4096> buffer;
  const ssize_t got = ::read(fd, buffer.data(), buffer.size());
  if (got > 0) lines.add(buffer.data(), static_cast<std::size_t>(got), on_line);
  return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

}  // namespace

ChildResult run_child(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments, const std::filesystem::path& log,
                      const ChildLimits& limits,
                      const std::function<void(const std::string&)>& on_line,
                      const std::function<bool()>& is_cancelled) {
  const auto fail = [&](int error) {
    throw OutputError(program.string() +
                      " can't be started: " + std::generic_category().message(error));
  };
  if (::access(program.c_str(), X_OK) != 0) fail(errno);
  // Everything that allocates is made ready before the fork.
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  Pipe life, output;
  const Handle log_file(
      ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (log_file.get() < 0 || !open_pipe(life) || !open_pipe(output)) fail(errno);
  ::fcntl(output.read.get(), F_SETFL, O_NONBLOCK);
  const double cores = std::max(1U, std::thread::hardware_concurrency());
  // Only in case that the parent is gone: more than all cores can use in the time.
  const double cpu_seconds = std::ceil(limits.seconds * cores) + 10.0;
  const ChildStart start{argv.data(),
                         life.read.get(),
                         output.write.get(),
                         log_file.get(),
                         bytes_of(limits.memory_mb),
                         bytes_of(limits.file_mb),
                         static_cast<rlim_t>(cpu_seconds)};
  const auto began = Clock::now();
  const pid_t pid = ::fork();
  if (pid < 0) fail(errno);
  if (pid == 0) start.run();
  Child child(pid);
  ::setpgid(pid, pid);  // whoever of the two comes first
  life.read.close();
  output.write.close();

  ChildResult result;
  Lines lines;
  int status = 0;
  bool is_open = true;
  while (!child.has_ended(status)) {
    struct pollfd wait = {output.read.get(), POLLIN, 0};
    const int ready = ::poll(&wait, is_open ? 1 : 0, kPollMilliseconds);
    if (ready > 0) is_open = read_available(output.read.get(), lines, on_line);
    const Memory memory = memory_of(child.pid());
    result.peak_memory_mb = std::max(result.peak_memory_mb, memory.peak);
    if (is_cancelled && is_cancelled()) {
      result.end = ChildResult::End::kCancelled;
    } else if (is_over(limits, child.pid(),
                       std::chrono::duration<double>(Clock::now() - began).count())) {
      result.end = ChildResult::End::kOutOfTime;
    } else if (memory.resident > limits.memory_mb) {
      result.end = ChildResult::End::kOutOfMemory;
    } else {
      continue;
    }
    child.kill();
    return result;
  }
  while (is_open && read_available(output.read.get(), lines, on_line)) {
    if (errno == EAGAIN) break;
  }
  result.end = WIFSIGNALED(status) ? ChildResult::End::kSignal : ChildResult::End::kExited;
  result.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  return result;
}

std::string words_of_signal(int signal) {
  const char* const known = ::strsignal(signal);
  std::string words = known != nullptr ? known : "unknown";
  for (char& c : words) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return words + " (signal " + std::to_string(signal) + ")";
}

}  // namespace palmar::formats
