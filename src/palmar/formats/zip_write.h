// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palmar::formats {

struct ZipMember {
  std::string name;  ///< with / between folders, UTF-8
  std::string content;
};

/// The bytes of a ZIP archive with these members in this order, deflated. It holds no time (all are
/// of 1 January 1980): same members, same bytes. Throws UsageError if there are more than 65535
/// members, a name is empty or longer than 65535 bytes, or the archive would pass 4 GiB, which
/// needs ZIP64.
///
/// Source: PKWARE, APPNOTE.TXT - .ZIP File Format Specification, 6.3, 4.3.
std::string format_zip(const std::vector<ZipMember>& members);

}  // namespace palmar::formats
