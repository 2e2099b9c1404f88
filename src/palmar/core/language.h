// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace palmar {

/// In which reports speak. Messages, help and the keys of files are English.
enum class Language { kEnglish, kGerman };
std::string_view name_of(Language language);  ///< "en", "de"

/// "en" or "de". Throws UsageError with what is allowed.
Language language_named(const std::string& name);

}  // namespace palmar
