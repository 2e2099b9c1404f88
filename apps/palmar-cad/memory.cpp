// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Memory that is refused ends this program at once with a code of its own. OpenCASCADE would catch
// what it throws itself and go on with faces missing; then a limit would look like a bad file.
#include <unistd.h>

#include <cstddef>

#include "palmar/formats/process/worker.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

extern "C" {

// The C library's own, under the names that it keeps for programs that stand in between.
// NOLINTBEGIN(readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
// NOLINTEND(readability-identifier-naming)

void* malloc(std::size_t size) {
  void* const memory = __libc_malloc(size);
  if (memory == nullptr) _exit(palmar::formats::kWorkerOutOfMemory);
  return memory;
}

void* calloc(std::size_t count, std::size_t size) {
  void* const memory = __libc_calloc(count, size);
  if (memory == nullptr) _exit(palmar::formats::kWorkerOutOfMemory);
  return memory;
}

void* realloc(void* old, std::size_t size) {
  void* const memory = __libc_realloc(old, size);
  if (memory == nullptr && size > 0) _exit(palmar::formats::kWorkerOutOfMemory);
  return memory;
}

}  // extern "C"

#endif
