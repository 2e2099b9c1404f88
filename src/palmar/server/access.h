// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palmar::server {

// Who may talk to the server of this machine. Every page that a browser shows can send requests to
// 127.0.0.1; what keeps them out is a secret that they don't know, and two headers that they can't
// forge: Host (a name of theirs that leads here) and Origin (where the page came from).

/// 32 random hexadecimal digits (128 bits) from the operating system. Throws InputError if it
/// gives none.
std::string random_token();

/// Whether two secrets are equal, in a time that doesn't depend on where they differ.
bool is_same_secret(std::string_view one, std::string_view other);

/// Where the server can be reached.
struct ServedAt {
  std::string address = "127.0.0.1";  ///< that it listens on
  unsigned port = 0;
};

/// The Host header of those who meant this server: 127.0.0.1, localhost or [::1] with its port; of
/// one that listens elsewhere also that address, and any if it listens on all (0.0.0.0, ::).
bool is_own_host(std::string_view host, const ServedAt& at);

/// The Origin header of the server's own pages; a request without one comes from no page.
bool is_own_origin(std::string_view origin, const ServedAt& at);

/// A request target in its parts: path and the values of its query, percent-decoded.
struct Target {
  std::string path;
  /// "a=1&b=2"; the first of several with one name.
  std::optional<std::string> query(std::string_view name) const;
  std::string query_text;
};
Target parse_target(std::string_view target);

/// The token that a request carries: "Authorization: Bearer TOKEN", or "token" in its query.
std::string token_of(const Target& target, std::string_view authorization);

/// A file's name as a client gives it, safe to be used in a folder of ours: the last part of a
/// path, without control characters, no leading dots, at most 100 bytes; "product" if nothing is
/// left.
std::string safe_file_name(std::string_view name);

/// Letters, digits, '-' and '_', 1 to 64 of them: what projects may be called.
bool is_plain_name(std::string_view name);

}  // namespace palmar::server
