// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/column_heading.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include "palmar/core/text.h"
#include "palmar/geometry/length_unit.h"

namespace palmar::population {
namespace {

using Words = std::vector<std::string>;

bool is_letter_or_digit(char c) {
  // Bytes of UTF-8 letters belong to their words.
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

/// Words in small letters; a capital after a small letter begins a new one.
Words words_of(std::string_view text) {
  Words words;
  bool is_inside = false;
  bool was_small = false;
  for (const char c : text) {
    if (!is_letter_or_digit(c)) {
      is_inside = was_small = false;
      continue;
    }
    const bool is_capital = std::isupper(static_cast<unsigned char>(c)) != 0;
    if (!is_inside || (is_capital && was_small)) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    is_inside = true;
    was_small = !is_capital;
  }
  return words;
}

constexpr std::array kTimeUnits{std::pair{"y", 1.0},
                                std::pair{"yr", 1.0},
                                std::pair{"yrs", 1.0},
                                std::pair{"year", 1.0},
                                std::pair{"years", 1.0},
                                std::pair{"a", 1.0},
                                std::pair{"month", 1.0 / 12.0},
                                std::pair{"months", 1.0 / 12.0},
                                std::pair{"mo", 1.0 / 12.0}};
constexpr std::array<std::string_view, 16> kOtherUnits{"kg",  "g",   "n",   "kn",      "kgf", "lb",
                                                       "lbs", "lbf", "deg", "degrees", "rad", "kpa",
                                                       "mpa", "ml",  "s",   "percent"};

template <class List>
std::optional<double> factor_of(const List& list, std::string_view unit) {
  for (const auto& [name, factor] : list) {
    if (unit == name) return factor;
  }
  return std::nullopt;
}

/// Usual names, words run together, of the whole hand's dimensions and of the wrist.
constexpr std::array kWholeHand{std::pair{"handlength", "hand_length"},
                                std::pair{"lengthofhand", "hand_length"},
                                std::pair{"handbreadth", "hand_width"},
                                std::pair{"handwidth", "hand_width"},
                                std::pair{"breadthofhand", "hand_width"},
                                std::pair{"widthofhand", "hand_width"},
                                std::pair{"palmbreadth", "hand_width"},
                                std::pair{"palmwidth", "hand_width"},
                                std::pair{"handbreadthatmetacarpals", "hand_width"},
                                std::pair{"handbreadthmetacarpal", "hand_width"},
                                std::pair{"handcircumference", "hand_circumference"},
                                std::pair{"handcirc", "hand_circumference"},
                                std::pair{"handgirth", "hand_circumference"},
                                std::pair{"handperimeter", "hand_circumference"},
                                std::pair{"palmcircumference", "hand_circumference"},
                                std::pair{"circumferenceofhand", "hand_circumference"},
                                std::pair{"handthickness", "hand_thickness"},
                                std::pair{"handdepth", "hand_thickness"},
                                std::pair{"palmthickness", "hand_thickness"},
                                std::pair{"palmlength", "palm_length"},
                                std::pair{"lengthofpalm", "palm_length"},
                                std::pair{"wristcircumference", "wrist_circumference"},
                                std::pair{"wristcirc", "wrist_circumference"}};

std::optional<std::string> finger_named_by(const std::string& word) {
  if (word == "thumb" || word == "d1" || word == "digit1") return "thumb";
  if (word == "index" || word == "d2" || word == "digit2" || word == "forefinger") return "index";
  if (word == "d3" || word == "digit3") return "middle";
  if (word == "ring" || word == "d4" || word == "digit4") return "ring";
  if (word == "little" || word == "pinky" || word == "d5" || word == "digit5") return "little";
  return std::nullopt;
}

std::optional<std::string> quantity_named_by(const std::string& word) {
  if (word == "length") return "length";
  if (word == "width" || word == "breadth") return "width";
  if (word == "thickness" || word == "depth") return "thickness";
  return std::nullopt;
}

/// "index finger, proximal, length" in any order; nothing if a word is left over. A phalanx' length
/// is that of the bone, which is no dimension of ours: our segments end at creases, and the
/// proximal one is half as long as its bone.
std::optional<hand::HandDimension> phalanx_dimension(const Words& words) {
  std::optional<std::string> finger, segment, quantity;
  int middles = 0;
  bool is_bone = false;
  for (const std::string& word : words) {
    is_bone = is_bone || word.starts_with("phala") || word == "bone";
    constexpr std::array<std::string_view, 9> kFillers{
        "finger", "phalanx", "phalange", "of", "phalanges", "the", "hand", "segment", "digit"};
    if (word == "middle") {
      ++middles;
    } else if (const auto named = finger_named_by(word); named && !finger) {
      finger = named;
    } else if ((word == "proximal" || word == "distal") && !segment) {
      segment = word;
    } else if ((word == "intermediate" || word == "medial") && !segment) {
      segment = "middle";
    } else if (const auto what = quantity_named_by(word); what && !quantity) {
      quantity = what;
    } else if (std::find(kFillers.begin(), kFillers.end(), word) == kFillers.end()) {
      return std::nullopt;
    }
  }
  if (middles > 0 && !finger) {
    finger = "middle";
    --middles;
  }
  if (middles > 0 && !segment) {
    segment = "middle";
    --middles;
  }
  if (middles > 0 || !finger || !segment || !quantity) return std::nullopt;
  if (is_bone && *quantity == "length") return std::nullopt;
  return hand::hand_dimension_named(*finger + "_" + *segment + "_" + *quantity);
}

/// The usual name in our list: of a dimension or of the wrist.
std::optional<std::string> known_name(std::string_view text) {
  const Words words = words_of(text);
  const std::string run = joined(words, "");
  for (const auto& [usual, name] : kWholeHand) {
    if (run == usual) return name;
  }
  if (const auto dimension = phalanx_dimension(words)) return name_of(*dimension);
  return std::nullopt;
}

/// Takes the unit off the end of a heading: in brackets, or as its last word.
std::string take_unit(std::string& heading) {
  const auto close = heading.find_last_not_of(" \t");
  if (close != heading.npos && (heading[close] == ')' || heading[close] == ']')) {
    const auto open = heading.rfind(heading[close] == ')' ? '(' : '[');
    if (open != heading.npos && open + 1 < close) {
      std::string unit = heading.substr(open + 1, close - open - 1);
      const Words words = words_of(unit);
      // Remarks in brackets stay a part of the name: "(right hand)".
      if (words.size() <= 1) {
        heading.erase(open);
        return words.empty() ? unit : words[0];
      }
    }
  }
  const auto last = heading.find_last_of(" _,-/.");
  if (last == heading.npos || last + 1 >= heading.size()) return "";
  const Words word = words_of(heading.substr(last + 1));
  if (word.size() != 1) return "";
  const bool is_unit =
      geometry::length_unit_named(word[0]) || factor_of(kTimeUnits, word[0]) ||
      std::find(kOtherUnits.begin(), kOtherUnits.end(), word[0]) != kOtherUnits.end();
  if (!is_unit) return "";
  heading.erase(last);
  return word[0];
}

}  // namespace

ColumnHeading heading_of(std::string_view header) {
  ColumnHeading heading;
  std::string text(header);
  heading.unit = take_unit(text);
  const Words words = words_of(text);
  heading.name = known_name(text).value_or(joined(words, "_"));
  if (heading.name.empty()) heading.name = std::string(header);
  heading.dimension = hand::hand_dimension_named(heading.name);
  if (const auto unit = geometry::length_unit_named(heading.unit)) {
    heading.quantity = Quantity::kLength;
    heading.factor = geometry::millimetres_per(*unit);
  } else if (heading.name == "age") {
    heading.quantity = Quantity::kAge;
    heading.factor = factor_of(kTimeUnits, heading.unit).value_or(1.0);
  } else {
    constexpr std::array<std::string_view, 10> kLabels{
        "id",     "subject",     "subject_id", "subjectid", "no",
        "number", "participant", "name",       "person",    "label"};
    if (std::find(kLabels.begin(), kLabels.end(), heading.name) != kLabels.end()) {
      heading.quantity = Quantity::kLabel;
    }
  }
  return heading;
}

std::optional<SizeRange> size_range(std::string_view name) {
  if (name == "wrist_circumference") return SizeRange{80.0, 260.0};
  const auto dimension = hand::hand_dimension_named(name);
  if (!dimension) return std::nullopt;
  switch (dimension->kind) {
    case hand::DimensionKind::kHandLength:
      return SizeRange{90.0, 260.0};
    case hand::DimensionKind::kHandCircumference:
      return SizeRange{95.0, 320.0};
    case hand::DimensionKind::kHandWidth:
      return SizeRange{40.0, 130.0};
    case hand::DimensionKind::kHandThickness:
      return SizeRange{10.0, 60.0};
    case hand::DimensionKind::kSegmentLength:
      break;
    case hand::DimensionKind::kSegmentWidth:
      return SizeRange{5.0, 45.0};
    case hand::DimensionKind::kSegmentThickness:
      return SizeRange{4.0, 40.0};
  }
  if (name == "palm_length") return SizeRange{48.0, 150.0};
  if (name == "thumb_proximal_length") return SizeRange{6.0, 70.0};
  if (name.find("proximal") != name.npos) return SizeRange{6.0, 40.0};  // bones: 30 to 50
  return SizeRange{6.0, 50.0};
}

}  // namespace palmar::population
