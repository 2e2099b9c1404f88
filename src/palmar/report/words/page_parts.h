// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palmar::report {

// Made from apps/workbench when the program is built (embed.cmake).

std::string_view page_script();     ///< components and pages, ES5
std::string_view page_style();      ///< style sheet of all pages
std::string_view viewer_script();   ///< the 3-D view with three.js, for browsers
std::string_view page_behaviour();  ///< what pages do in a browser beside their 3-D views
std::string_view viewer_licence();  ///< of three.js, which goes with it
std::string_view english_texts();   ///< sentences of reports by key, JSON
std::string_view german_texts();    ///< the same in German

}  // namespace palmar::report
