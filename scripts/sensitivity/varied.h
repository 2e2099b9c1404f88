// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

// Stands in copies of the sources alone (scripts/sensitivity.mjs): constants that can be changed
// while the program runs.
namespace palmar::sensitivity {

struct Factors {
  std::uint64_t varied = 0;  ///< the constant that is changed now; 0: none
  double factor = 1.0;       ///< of it
  /// Factors of numbers that are changed beside it.
  std::vector<std::pair<std::uint64_t, double>> lasting;
  /// What sets the constants, each after those that it is computed from.
  std::vector<std::function<void()>> setters;
  std::mutex mutex;
};
inline Factors& factors() {
  static Factors made;
  return made;
}

/// A number of the sources as it counts now.
template <class Number>
Number varied(std::uint64_t id, Number value) {
  const Factors& now = factors();
  double factor = now.varied == id ? now.factor : 1.0;
  for (const auto& [other, lasting] : now.lasting) {
    if (other == id) factor *= lasting;
  }
  return factor == 1.0 ? value : static_cast<Number>(factor * value);
}

template <class T>
void assign(T& constant, const T& now) {
  constant = now;
}
template <class T, std::size_t kCount>
void assign(T (&constant)[kCount], const T (&now)[kCount]) {
  for (std::size_t k = 0; k < kCount; ++k) assign(constant[k], now[k]);
}

/// Keeps what sets a constant, and calls it.
inline bool add(std::function<void()> setter) {
  const std::lock_guard lock(factors().mutex);
  setter();
  factors().setters.push_back(std::move(setter));
  return true;
}

/// From now on this constant alone is changed; id 0: none.
inline void vary(std::uint64_t id, double factor) {
  factors().varied = id;
  factors().factor = factor;
  for (const auto& setter : factors().setters) setter();
}

}  // namespace palmar::sensitivity
