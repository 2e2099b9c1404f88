// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palmar::server {

// The workbench's page, made from apps/workbench/bench when the program is built (embed.cmake).

std::string_view bench_page();     ///< HTML
std::string_view bench_script();   ///< with three.js, for browsers
std::string_view bench_style();    ///< CSS
std::string_view bench_icon();     ///< SVG
std::string_view bench_licence();  ///< of three.js, which goes with it

}  // namespace palmar::server
