// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/helvetica.h"

#include <array>
#include <utility>

#include "palmar/report/chart/figure.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {
namespace {

// Characters 32 to 126.
constexpr std::array<int, 95> kRegular{
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
constexpr std::array<int, 95> kBold{
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 333, 333, 584, 584, 584, 611, 975, 722, 722, 722, 722, 667,
    611, 778, 722, 278, 556, 722, 611, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 333, 278, 333, 584, 556, 333, 556, 611, 556, 611, 556, 333, 611, 611, 278, 278, 556,
    278, 889, 611, 611, 611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389, 280, 389, 584};

// Signs that WinAnsi has at another place, or that ASCII stands for.
constexpr std::array kSubstitutes{
    std::pair{U'\u2013', "\x96"}, std::pair{U'\u2014', "\x97"},  std::pair{U'\u2212', "\x96"},
    std::pair{U'\u2018', "\x91"}, std::pair{U'\u2019', "\x92"},  std::pair{U'\u201c', "\x93"},
    std::pair{U'\u201d', "\x94"}, std::pair{U'\u2026', "\x85"},  std::pair{U'\u2265', ">="},
    std::pair{U'\u2264', "<="},   std::pair{U'\u03b1', "alpha"}, std::pair{U'\u03bc', "\xb5"},
    std::pair{U'\u03c1', "rho"},  std::pair{U'\u03c3', "sigma"}, std::pair{U'\u0394', "Delta"}};

}  // namespace

std::string win_ansi(std::string_view utf8) {
  std::string result;
  for (const char32_t code : code_points(utf8)) {
    if ((code >= 32 && code <= 126) || (code >= 0xa0 && code <= 0xff)) {
      result += static_cast<char>(static_cast<unsigned char>(code));
      continue;
    }
    std::string substitute = "?";
    for (const auto& [sign, text] : kSubstitutes) {
      if (sign == code) substitute = text;
    }
    result += substitute;
  }
  return result;
}

int helvetica_advance(unsigned char c, bool is_bold) {
  const auto& widths = is_bold ? kBold : kRegular;
  const auto of_letter = [&](char letter) { return widths[static_cast<std::size_t>(letter - 32)]; };
  if (c >= 32 && c <= 126) return of_letter(static_cast<char>(c));
  switch (c) {
    case 0x85:
    case 0x97:
      return 1000;  // ellipsis, em dash
    case 0x91:
    case 0x92:
      return is_bold ? 278 : 222;
    case 0x93:
    case 0x94:
      return is_bold ? 500 : 333;
    case 0xb0:
      return 400;  // degree
    case 0xb1:
    case 0xd7:
    case 0xf7:
      return 584;  // plus-minus, times, divided
    case 0xb2:
    case 0xb3:
    case 0xb9:
      return 333;  // superscripts
    case 0xb5:
      return is_bold ? 611 : 556;  // micro
    case 0xb7:
      return 278;  // middle dot
    case 0xc6:
      return 1000;
    case 0xe6:
      return 889;
    case 0xdf:
      return 611;
    default:
      break;
  }
  // Letters with accents are as wide as those without.
  constexpr std::string_view kBare =
      "AAAAAA?CEEEEIIIIDNOOOOO?OUUUUYP?aaaaaa?ceeeeiiiidnooooo?ouuuuypy";
  if (c >= 0xc0) {
    const char bare = kBare[static_cast<std::size_t>(c - 0xc0)];
    if (bare == 'i') return 278;
    if (bare != '?') return of_letter(bare);
  }
  return of_letter('n');
}

double text_width(std::string_view text, const Lettering& look) {
  int sum = 0;
  for (const char c : win_ansi(text)) {
    sum += helvetica_advance(static_cast<unsigned char>(c), look.is_bold);
  }
  return sum * 1e-3 * look.size;
}

}  // namespace palmar::report
