// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/setting_names.h"

#include <string_view>

namespace palmar {

std::string with_setting_names(const std::string& message, const SettingNames& names) {
  if (!names) return message;
  constexpr std::string_view kBefore = "setting \"";
  std::string result;
  std::size_t done = 0;
  while (true) {
    const std::size_t begin = message.find(kBefore, done);
    if (begin == std::string::npos) break;
    const std::size_t word = begin + kBefore.size();
    const std::size_t end = message.find('"', word);
    if (end == std::string::npos) break;
    result += message.substr(done, begin - done) + names(message.substr(word, end - word));
    done = end + 1;
  }
  return result + message.substr(done);
}

}  // namespace palmar
