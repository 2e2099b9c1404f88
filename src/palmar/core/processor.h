// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palmar {

// PALMAR_AVX2 before a function: it is compiled for processors with AVX2, and may be called where
// has_avx2() says so.
#if defined(__x86_64__) && defined(__GNUC__)
#define PALMAR_AVX2 __attribute__((target("avx2")))
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#else
#define PALMAR_AVX2
inline bool has_avx2() { return false; }
#endif

}  // namespace palmar
