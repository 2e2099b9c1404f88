// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/access.h"

#include <gtest/gtest.h>

#include <set>

namespace palmar::server {
namespace {

TEST(Token, Has128RandomBitsInHexadecimal) {
  std::set<std::string> seen;
  for (int i = 0; i < 200; ++i) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    seen.insert(token);
  }
  EXPECT_EQ(seen.size(), 200U);
}

TEST(Token, OnlyTheWholeSecretIsTheSame) {
  EXPECT_TRUE(is_same_secret("abc", "abc"));
  for (const char* other : {"", "ab", "abd", "abcd", "ABC"}) {
    EXPECT_FALSE(is_same_secret("abc", other)) << other;
  }
  EXPECT_FALSE(is_same_secret(std::string("abc\0", 4), "abc"));
}

TEST(Host, OnlyNamesOfThisMachineWithThePort) {
  const ServedAt at{"127.0.0.1", 8123};
  for (const char* own : {"127.0.0.1:8123", "localhost:8123", "LocalHost:8123", "[::1]:8123"}) {
    EXPECT_TRUE(is_own_host(own, at)) << own;
  }
  for (const char* other :
       {"", ":8123", "127.0.0.1", "127.0.0.1:81", "evil.example:8123",
        "127.0.0.1.evil.example:8123", "localhost:8123.evil.example", "192.168.1.5:8123"}) {
    EXPECT_FALSE(is_own_host(other, at)) << other;
  }
  EXPECT_TRUE(is_own_host("192.168.1.5:80", {"192.168.1.5", 80}));
  EXPECT_TRUE(is_own_host("desk.example:80", {"0.0.0.0", 80}));
}

TEST(Origin, OnlyOurOwnPagesAndRequestsOfNoPage) {
  const ServedAt at{"127.0.0.1", 8123};
  EXPECT_TRUE(is_own_origin("", at));
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8123", at));
  EXPECT_TRUE(is_own_origin("http://localhost:8123", at));
  for (const char* other : {"null", "https://127.0.0.1:8123", "http://127.0.0.1:8124",
                            "http://evil.example", "http://127.0.0.1:8123.evil.example"}) {
    EXPECT_FALSE(is_own_origin(other, at)) << other;
  }
}

TEST(Target, QueryIsReadAndDecoded) {
  const Target target = parse_target("/api/products?name=my%20cup%2f..%2fx.stl&unit=mm&flag&a=b=c");
  EXPECT_EQ(target.path, "/api/products");
  EXPECT_EQ(target.query("name"), "my cup/../x.stl");
  EXPECT_EQ(target.query("unit"), "mm");
  EXPECT_EQ(target.query("flag"), "");
  EXPECT_EQ(target.query("a"), "b=c");
  EXPECT_EQ(target.query("none"), std::nullopt);
  EXPECT_EQ(parse_target("/x%").path, "/x%");
  EXPECT_EQ(parse_target("/%zz%4").path, "/%zz%4");
}

TEST(Target, TokenStandsInTheHeaderOrTheQuery) {
  EXPECT_EQ(token_of(parse_target("/api/x?token=abc"), ""), "abc");
  EXPECT_EQ(token_of(parse_target("/api/x"), "Bearer abc"), "abc");
  EXPECT_EQ(token_of(parse_target("/api/x?token=wrong"), "Bearer abc"), "abc");
  EXPECT_EQ(token_of(parse_target("/api/x"), "Basic abc"), "");
}

TEST(FileName, LeadsNowhereElse) {
  EXPECT_EQ(safe_file_name("cup.stl"), "cup.stl");
  EXPECT_EQ(safe_file_name("../../etc/passwd"), "passwd");
  EXPECT_EQ(safe_file_name("C:\\tmp\\cup.stl"), "cup.stl");
  EXPECT_EQ(safe_file_name(".."), "product");
  EXPECT_EQ(safe_file_name("..."), "product");
  EXPECT_EQ(safe_file_name(".hidden.stl"), "hidden.stl");
  EXPECT_EQ(safe_file_name(""), "product");
  EXPECT_EQ(safe_file_name(std::string("a\0b\n.stl", 8)), "ab.stl");
  const std::string cut = safe_file_name(std::string(500, 'a') + ".step");
  EXPECT_EQ(cut.size(), 100U);
  EXPECT_TRUE(cut.ends_with(".step"));
}

TEST(ProjectName, IsPlain) {
  EXPECT_TRUE(is_plain_name("handle-2_b"));
  for (const char* other : {"", ".", "..", "a/b", "a b", "a.b", "\xc3\xa4"}) {
    EXPECT_FALSE(is_plain_name(other)) << other;
  }
  EXPECT_FALSE(is_plain_name(std::string(65, 'a')));
}

}  // namespace
}  // namespace palmar::server
