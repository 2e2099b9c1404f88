// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace palmar::formats {

/// SHA-256 (NIST FIPS 180-4, section 6.2) of bytes given piece by piece: names what a study was
/// made of. Not for secrets.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// 64 lower-case hex digits of everything added so far; more may be added afterwards.
  std::string hex() const;

 private:
  void take_block(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_;
  std::array<std::uint8_t, 64> waiting_{};  ///< bytes of a block that isn't full yet
  std::uint64_t length_ = 0;                ///< bytes added
};

std::string sha256_hex(std::string_view bytes);

}  // namespace palmar::formats
