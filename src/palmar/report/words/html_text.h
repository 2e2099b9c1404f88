// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace palmar::report {

/// Text made safe inside HTML, XML and SVG elements and attributes: & < > " ' escaped, control
/// characters that XML doesn't allow and broken UTF-8 replaced by U+FFFD.
std::string html_escaped(std::string_view text);

/// Text made safe inside a <script> element: "</" becomes "<\/" and "<!--" becomes
/// "\u003c!--", which mean the same in strings of JSON and of JavaScript.
std::string script_escaped(std::string_view text);

}  // namespace palmar::report
