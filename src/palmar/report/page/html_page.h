// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/report/picture/assessment_pictures.h"

namespace palmar {

// Pieces of plain report pages, which work without a network and run no scripts.

/// A whole page. `title` is text; `summary` and `body` are HTML.
std::string html_page(const std::string& title, const std::string& summary,
                      const std::string& body);

/// Figures of the pictures whose name begins with one of `kinds`; "" if there is none.
std::string pictures_html(const std::vector<Picture>& pictures,
                          std::initializer_list<std::string_view> kinds);

/// The title, a text, over `html`; "" over nothing.
std::string titled(const std::string& title, const std::string& html);

/// Sentences as a list under a title; "" for none.
std::string notes_section(const std::string& title, const std::vector<std::string>& notes);

/// A cell that shows a number shortened and holds it in full; a dash for none.
std::string number_cell(const std::optional<double>& value, int decimals = 2);
std::string row_head(const std::string& text);
/// `rows`: HTML; `texts`: how many of the first columns hold words.
std::string html_table(const std::string& caption, const std::vector<std::string>& heads,
                       const std::string& rows, std::size_t texts = 1);

}  // namespace palmar
