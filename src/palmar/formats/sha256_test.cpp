// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/sha256.h"

#include <gtest/gtest.h>

#include <string>

namespace palmar::formats {
namespace {

// NIST's example values for SHA-256 (csrc.nist.gov, "SHA256.pdf", and FIPS 180-2, appendix B).
TEST(Sha256, MeetsNistsExamples) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, PiecesGiveWhatTheWholeGives) {
  // Lengths on both sides of 55, 56 and 64 bytes, where padding takes another block.
  for (const std::size_t length : {1U, 54U, 55U, 56U, 57U, 63U, 64U, 65U, 127U, 128U, 200U}) {
    std::string bytes;
    for (std::size_t i = 0; i < length; ++i) bytes += static_cast<char>(17 * i);
    Sha256 hash;
    for (std::size_t i = 0; i < length; i += 7) hash.add(bytes.substr(i, 7));
    EXPECT_EQ(hash.hex(), sha256_hex(bytes)) << length;
    EXPECT_EQ(hash.hex(), sha256_hex(bytes)) << "asking doesn't change it";
  }
}

}  // namespace
}  // namespace palmar::formats
