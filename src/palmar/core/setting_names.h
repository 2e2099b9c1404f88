// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace palmar {

/// What the reader of a message knows a setting as: "accept odd slices" -> "--accept-odd-slices" on
/// a command line. Empty: the setting keeps its own words.
using SettingNames = std::function<std::string(const std::string& setting)>;

/// Puts in the reader's names of settings. The library writes a setting that a message is about as
///
///     setting "accept odd slices"
///
/// in the words of the request's field, because it doesn't know who asks: a command line has
/// options, a file keys, Python arguments. The program that shows the message replaces all of that
/// (the word "setting", the quotes and what they hold) by `names` of what they hold.
std::string with_setting_names(const std::string& message, const SettingNames& names);

}  // namespace palmar
