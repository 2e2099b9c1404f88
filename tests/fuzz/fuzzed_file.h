// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace palmar::fuzz {

/// What messages call the bytes: part of every path that fuzzed_file() gives.
inline const std::string kName = "fuzzed";

/// Path of a file in memory that holds the bytes, until the next call; gone at the end.
inline std::string fuzzed_file(std::string_view bytes, const std::string& extension) {
  static const std::string path = "/dev/shm/fuzzed-" + std::to_string(getpid()) + extension;
  static const int at_end = std::atexit([] { unlink(path.c_str()); });
  (void)at_end;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

}  // namespace palmar::fuzz
