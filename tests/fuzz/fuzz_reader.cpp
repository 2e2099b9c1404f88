// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A libFuzzer target: whatever the bytes, its reader ends with a value or with a Palmar error that
// names the file and speaks the user's language, not a library's.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "fuzzed_file.h"
#include "palmar/core/error.h"

namespace palmar::fuzz {
void read(std::string_view bytes);  // chosen_reader.cpp
}

namespace {

/// Messages may repeat what stands in the file.
bool speaks_for_a_library(std::string_view message, std::string_view bytes) {
  constexpr std::string_view kSign = "json.exception";
  return message.find(kSign) != std::string_view::npos &&
         bytes.find(kSign) == std::string_view::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    palmar::fuzz::read(bytes);
  } catch (const palmar::Error& error) {
    const std::string_view message = error.what();
    if (message.find(palmar::fuzz::kName) == std::string_view::npos ||
        speaks_for_a_library(message, bytes)) {
      std::fprintf(stderr, "a message that names no file, or a library: \"%s\"\n", error.what());
      std::abort();
    }
  }
  return 0;
}
