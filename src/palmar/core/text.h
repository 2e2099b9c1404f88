// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace palmar {

/// A number as messages and labels show it: rounded to so many significant digits, without trailing
/// zeros (C's %g).
std::string significant(double value, int digits);

/// "1 hole", "3 holes".
std::string counted(int count, std::string_view one, std::string_view many);

/// ASCII letters as small ones; the rest stays.
std::string lower_case(std::string_view text);

/// Without spaces and tabs at either end.
std::string trimmed(std::string_view text);

/// A word as a shell takes it, in quotes where it needs them: command lines can be run again.
std::string shell_word(const std::string& word);

/// The words in their order, with the text `between` from one to the next.
std::string joined(std::span<const std::string> words, std::string_view between);

}  // namespace palmar
