// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace palmar::report {

/// Text in the WinAnsi encoding of PDF (ISO 32000-1, annex D.2): Latin-1 with typographic marks.
/// Other signs become what stands for them in ASCII ("≥" ">="), Greek letters their names, anything
/// else '?'.
std::string win_ansi(std::string_view utf8);

/// Advance width of a WinAnsi character in Helvetica or Helvetica Bold, 1/1000 of the font size
/// (Adobe's font metrics of the 14 standard fonts). Characters that have none get that of 'n'.
int helvetica_advance(unsigned char character, bool is_bold);

}  // namespace palmar::report
