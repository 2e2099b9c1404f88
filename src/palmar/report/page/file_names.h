// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

namespace palmar::report {

/// Whether full stops stay in a name; one that would stand first never does.
enum class FullStops { kKept, kReplaced };

/// `text` as a name of a file or folder that every file system takes, of at most 80 bytes and
/// different from those in `used`, to which it is added: "a b" -> "a_b", then "a_b_2"; "" ->
/// "product".
std::string unique_file_name(const std::string& text, std::set<std::string>& used,
                             FullStops full_stops);

}  // namespace palmar::report
