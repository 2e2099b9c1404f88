// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/access.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "palmar/core/error.h"

namespace palmar::server {
namespace {

constexpr std::size_t kTokenBytes = 16;
constexpr std::size_t kLongestName = 100;
constexpr std::size_t kLongestProject = 64;

std::optional<int> hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

/// "%41+b" -> "A b"; what is no code stays.
std::string decoded(std::string_view text, bool is_query) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      const auto high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
      if (high && low) {
        result += static_cast<char>(16 * *high + *low);
        i += 2;
        continue;
      }
    }
    result += is_query && text[i] == '+' ? ' ' : text[i];
  }
  return result;
}

bool is_one_of_ours(std::string_view host, const ServedAt& at) {
  const std::string port = ":" + std::to_string(at.port);
  if (!host.ends_with(port)) return false;
  std::string name(host.substr(0, host.size() - port.size()));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.empty()) return false;
  if (name == "127.0.0.1" || name == "localhost" || name == "[::1]") return true;
  if (at.address == "0.0.0.0" || at.address == "::") return true;
  return name == at.address || name == "[" + at.address + "]";
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw InputError("the operating system gives no random numbers; no token can be made");
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4U];
    token += "0123456789abcdef"[byte & 0xfU];
  }
  return token;
}

bool is_same_secret(std::string_view one, std::string_view other) {
  unsigned differences = one.size() == other.size() ? 0U : 1U;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const char theirs = i < other.size() ? other[i] : '\0';
    differences |= static_cast<unsigned char>(one[i]) ^ static_cast<unsigned char>(theirs);
  }
  return differences == 0U;
}

bool is_own_host(std::string_view host, const ServedAt& at) { return is_one_of_ours(host, at); }

bool is_own_origin(std::string_view origin, const ServedAt& at) {
  if (origin.empty()) return true;
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && is_one_of_ours(origin.substr(kScheme.size()), at);
}

std::optional<std::string> Target::query(std::string_view name) const {
  std::string_view rest = query_text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string_view pair = rest.substr(0, end);
    const std::size_t equals = std::min(pair.find('='), pair.size());
    if (decoded(pair.substr(0, equals), true) == name) {
      return decoded(pair.substr(std::min(equals + 1, pair.size())), true);
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::nullopt;
}

Target parse_target(std::string_view target) {
  const std::size_t question = std::min(target.find('?'), target.size());
  Target result;
  result.path = decoded(target.substr(0, question), false);
  result.query_text = target.substr(std::min(question + 1, target.size()));
  return result;
}

std::string token_of(const Target& target, std::string_view authorization) {
  constexpr std::string_view kBearer = "Bearer ";
  if (authorization.starts_with(kBearer)) return std::string(authorization.substr(kBearer.size()));
  return target.query("token").value_or("");
}

std::string safe_file_name(std::string_view name) {
  const std::size_t slash = name.find_last_of("/\\");
  if (slash != std::string_view::npos) name.remove_prefix(slash + 1);
  std::string result;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f || (c == '.' && result.empty())) continue;
    result += c;
  }
  if (result.size() > kLongestName) {  // the ending says what it is
    const std::size_t dot = result.rfind('.');
    const std::string ending =
        dot == std::string::npos || result.size() - dot > 10 ? "" : result.substr(dot);
    result = result.substr(0, kLongestName - ending.size()) + ending;
  }
  return result.empty() ? "product" : result;
}

bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestProject &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

}  // namespace palmar::server
