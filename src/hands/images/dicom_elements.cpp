// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_elements.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/formats/bytes.h"
#include "palmar/formats/text_scan.h"

namespace palmar::images {
namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr DicomTag kItem = 0xFFFEE000, kItemEnd = 0xFFFEE00D, kSequenceEnd = 0xFFFEE0DD;
constexpr DicomTag kPixelData = 0x7FE00010;
constexpr DicomTag kSharedGroups = 0x52009229, kFrameGroups = 0x52009230;
constexpr int kDeepestSequence = 32;
constexpr std::size_t kLongestNumbers = 17 * kMostDicomFrames;  // one number for each frame

/// Sequences within the groups that say something of a frame's place, values or kind.
bool is_group_read(DicomTag tag) {
  switch (tag) {
    case 0x00209113:  // plane position
    case 0x00209116:  // plane orientation
    case 0x00289110:  // pixel measures
    case 0x00289145:  // pixel value transformation
    case 0x00209071:  // frame anatomy
    case 0x00209111:  // frame content
    case 0x00189114:  // MR echo
    case 0x00189117:  // MR diffusion
    case 0x00189226:  // MR image frame type
    case 0x00189006:  // MR imaging modifier
    case 0x00189125:  // MR field of view and geometry
      return true;
    default:
      return false;
  }
}

std::string name_of(DicomTag tag) {
  return fmt::format("({:04X},{:04X})", tag >> 16, tag & 0xFFFF);
}

/// What stands before an element's value.
struct ElementHead {
  DicomTag tag = 0;
  std::string_view vr;  ///< two letters, empty if implicit
  std::uint32_t length = 0;
};

/// Walks through a data set.
class ElementWalk {
 public:
  ElementWalk(std::string_view bytes, std::uint64_t file_bytes, DicomElements& result)
      : bytes_(bytes), file_bytes_(file_bytes), result_(result) {}

  void run() {
    if (bytes_.size() >= 132 && bytes_.substr(128, 4) == "DICM") {
      position_ = 132;
      read_meta();
    }
    if (stopped_) return;
    if (result_.transfer_syntax.empty()) {
      is_explicit_ = looks_explicit();
      result_.transfer_syntax = is_explicit_ ? kExplicitLittleEndian : kImplicitLittleEndian;
    } else {
      is_explicit_ = result_.transfer_syntax != kImplicitLittleEndian;
    }
    // Retired and rare: their bytes can't be walked through as they are.
    if (result_.transfer_syntax == "1.2.840.10008.1.2.2" ||
        result_.transfer_syntax == "1.2.840.10008.1.2.1.99") {
      return;
    }
    while (!stopped_ && position_ < file_bytes_) read_element();
  }

 private:
  /// True if `count` more bytes are there; else says what is wrong, or that more must be read.
  bool has(std::uint64_t count, const char* what) {
    if (position_ <= bytes_.size() && count <= bytes_.size() - position_) return true;
    if (count <= file_bytes_ - position_) {
      result_.is_partial = true;
    } else {
      fail(fmt::format("the file ends in {}", what));
    }
    stopped_ = true;
    return false;
  }
  void fail(const std::string& why) {
    if (result_.damage.empty()) result_.damage = fmt::format("byte {}: {}", position_, why);
    stopped_ = true;
  }

  std::uint16_t read16(std::size_t ahead = 0) const {
    return formats::read_value<std::uint16_t>(bytes_, static_cast<std::size_t>(position_) + ahead);
  }
  std::uint32_t read32(std::size_t ahead = 0) const {
    return formats::read_value<std::uint32_t>(bytes_, static_cast<std::size_t>(position_) + ahead);
  }

  bool looks_explicit() const {
    if (bytes_.size() - position_ < 6) return false;
    const char a = bytes_[static_cast<std::size_t>(position_) + 4];
    const char b = bytes_[static_cast<std::size_t>(position_) + 5];
    return a >= 'A' && a <= 'Z' && b >= 'A' && b <= 'Z';
  }

  std::optional<ElementHead> read_head(bool is_explicit) {
    if (!has(8, "an element's head")) return std::nullopt;
    ElementHead head;
    head.tag = static_cast<DicomTag>(read16()) << 16 | read16(2);
    const bool is_delimiter = head.tag >> 16 == 0xFFFE;  // items have no representation
    if (!is_explicit || is_delimiter) {
      head.length = read32(4);
      position_ += 8;
      return head;
    }
    head.vr = bytes_.substr(static_cast<std::size_t>(position_) + 4, 2);
    const bool is_upper =
        head.vr[0] >= 'A' && head.vr[0] <= 'Z' && head.vr[1] >= 'A' && head.vr[1] <= 'Z';
    if (!is_upper) {
      fail(fmt::format("element {} has no value representation", name_of(head.tag)));
      return std::nullopt;
    }
    const std::string_view vr = head.vr;
    const bool is_long = vr == "OB" || vr == "OW" || vr == "OF" || vr == "OD" || vr == "OL" ||
                         vr == "OV" || vr == "SQ" || vr == "UN" || vr == "UC" || vr == "UR" ||
                         vr == "UT" || vr == "SV" || vr == "UV";
    if (!is_long) {
      head.length = read16(6);
      position_ += 8;
      return head;
    }
    if (!has(12, "an element's head")) return std::nullopt;
    head.length = read32(8);
    position_ += 12;
    return head;
  }

  void read_meta() {
    while (!stopped_ && file_bytes_ - position_ >= 8) {
      if (!has(8, "the file's meta information")) return;
      if (read16() != 0x0002) return;
      const auto head = read_head(true);
      if (!head || !has(head->length, "the file's meta information")) return;
      take(*head);
    }
  }

  void take(const ElementHead& head) {
    const auto value = bytes_.substr(static_cast<std::size_t>(position_), head.length);
    result_.value.emplace(head.tag, value);
    position_ += head.length;
    if (head.tag == 0x00020010) result_.transfer_syntax = result_.text(head.tag);
  }

  void read_element() {
    // Padding behind the last element is no damage.
    if (result_.has_pixels && file_bytes_ - position_ < 8) {
      stopped_ = true;
      return;
    }
    const auto head = read_head(is_explicit_);
    if (!head) return;
    if (head->tag == kPixelData) {
      read_pixels(*head);
      stopped_ = true;
      return;
    }
    if (head->tag == kSharedGroups || head->tag == kFrameGroups) {
      read_groups(*head);
      return;
    }
    if (head->length == kUndefined) {
      pass_sequence(is_explicit_ && head->vr != "UN", 0);
      return;
    }
    if (head->length > file_bytes_ - position_) {
      fail(fmt::format("element {} says it has {} bytes; the file has {} more", name_of(head->tag),
                       head->length, file_bytes_ - position_));
      return;
    }
    if (head->vr == "SQ") {
      position_ += head->length;
    } else if (has(head->length, "an element")) {
      take(*head);
    }
  }

  /// Where a sequence or item of this length ends at the latest.
  std::uint64_t end_of(const ElementHead& head) {
    if (head.length == kUndefined) return file_bytes_;
    if (head.length <= file_bytes_ - position_) return position_ + head.length;
    fail(fmt::format("element {} ends behind the file", name_of(head.tag)));
    return position_;
  }

  /// Calls take(end) at the content of every item of a sequence.
  template <typename Take>
  void read_items(const ElementHead& sequence, const Take& take) {
    const std::uint64_t end = end_of(sequence);
    while (!stopped_ && position_ < end) {
      const auto item = read_head(is_explicit_);
      if (!item || item->tag == kSequenceEnd) return;
      if (item->tag != kItem) {
        return fail(fmt::format("element {} is where an item belongs", name_of(item->tag)));
      }
      take(end_of(*item));
    }
  }

  /// Functional groups: of all frames together, or one item for each frame.
  void read_groups(const ElementHead& sequence) {
    read_items(sequence, [&](std::uint64_t end) {
      if (sequence.tag == kSharedGroups) return read_item(end, false, 0, result_.shared);
      if (result_.frame.size() >= kMostDicomFrames) {
        return fail(fmt::format("holds more than {} frames", kMostDicomFrames));
      }
      read_item(end, false, 0, result_.frame.emplace_back());
    });
  }

  /// Elements of an item; kept if the sequence around it is one that is read.
  void read_item(std::uint64_t end, bool is_kept, int depth, DicomAttributes& into) {
    if (depth >= kDeepestSequence) return fail("sequences are nested too deeply");
    while (!stopped_ && position_ < end) {
      const auto head = read_head(is_explicit_);
      if (!head || head->tag == kItemEnd) return;
      if (is_group_read(head->tag)) {
        read_items(*head,
                   [&](std::uint64_t item_end) { read_item(item_end, true, depth + 1, into); });
      } else if (head->length == kUndefined) {
        pass_sequence(is_explicit_ && head->vr != "UN", depth);
      } else {
        const std::uint64_t behind = end_of(*head);
        if (stopped_) return;
        if (is_kept && head->vr != "SQ") {
          if (!has(head->length, "an element")) return;
          into.value.emplace(head->tag,
                             bytes_.substr(static_cast<std::size_t>(position_), head->length));
        }
        position_ = behind;
      }
    }
  }

  /// Items up to the delimiter.
  void pass_sequence(bool is_explicit, int depth) {
    if (depth >= kDeepestSequence) return fail("sequences are nested too deeply");
    while (!stopped_) {
      const auto item = read_head(is_explicit);
      if (!item) return;
      if (item->tag == kSequenceEnd) return;
      if (item->tag != kItem) {
        return fail(fmt::format("element {} is where an item belongs", name_of(item->tag)));
      }
      if (item->length != kUndefined) {
        if (item->length > file_bytes_ - position_) return fail("an item ends behind the file");
        position_ += item->length;
        continue;
      }
      while (!stopped_) {
        const auto head = read_head(is_explicit);
        if (!head || head->tag == kItemEnd) break;
        if (head->length == kUndefined) {
          pass_sequence(is_explicit && head->vr != "UN", depth + 1);
        } else if (head->length > file_bytes_ - position_) {
          return fail(fmt::format("element {} ends behind the file", name_of(head->tag)));
        } else {
          position_ += head->length;
        }
      }
    }
  }

  void read_pixels(const ElementHead& head) {
    result_.has_pixels = true;
    result_.pixel_offset = position_;
    if (head.length == kUndefined) {
      result_.is_encapsulated = true;
      check_fragments();
    } else {
      result_.pixel_length = head.length;
      if (head.length > file_bytes_ - position_) {
        fail(fmt::format("the pixels end after {} of {} bytes", file_bytes_ - position_,
                         head.length));
      }
    }
  }

  /// Compressed pixels: items with their lengths up to the delimiter.
  void check_fragments() {
    while (!stopped_) {
      if (!has(8, "the compressed pixels")) return;
      const auto item = read_head(false);
      if (item->tag == kSequenceEnd) return;
      if (item->tag != kItem || item->length > file_bytes_ - position_) {
        return fail("the compressed pixels are cut off or damaged");
      }
      position_ += item->length;
      if (position_ > bytes_.size()) {
        result_.is_partial = true;
        stopped_ = true;
      }
    }
  }

  std::string_view bytes_;
  std::uint64_t file_bytes_;
  DicomElements& result_;
  std::uint64_t position_ = 0;
  bool is_explicit_ = true;
  bool stopped_ = false;
};

std::string_view without_padding(std::string_view text) {
  constexpr std::string_view kBlank(" \t\r\n\0", 5);
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t more = lead < 0x80                   ? 0
                             : lead >= 0xC2 && lead < 0xE0 ? 1
                             : lead >= 0xE0 && lead < 0xF0 ? 2
                             : lead >= 0xF0 && lead < 0xF5 ? 3
                                                           : 9;
    if (i + more >= text.size()) return false;
    for (std::size_t k = 1; k <= more; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return false;
    }
    // Overlong forms, surrogates and what lies beyond Unicode.
    const auto second = more > 0 ? static_cast<unsigned char>(text[i + 1]) : 0;
    if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
        (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) {
      return false;
    }
    i += more + 1;
  }
  return true;
}

}  // namespace

std::string DicomAttributes::text(DicomTag tag) const {
  const auto found = value.find(tag);
  if (found == value.end()) return {};
  const std::string_view raw = without_padding(found->second.substr(0, 1024));
  const bool keep = is_utf8(raw);
  std::string result;
  for (const char c : raw) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      result += ' ';
    } else if (byte < 0x80 || keep) {
      result += c;
    } else {  // taken as ISO 8859-1, which most scanners write
      result += static_cast<char>(0xC0 | byte >> 6);
      result += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return result;
}

std::optional<std::vector<double>> DicomAttributes::numbers(DicomTag tag) const {
  const auto found = value.find(tag);
  if (found == value.end() || without_padding(found->second).empty()) return std::nullopt;
  std::vector<double> result;
  std::string_view rest = found->second.substr(0, kLongestNumbers);
  while (true) {
    const std::size_t end = rest.find('\\');
    const auto number = formats::parse_double(without_padding(rest.substr(0, end)));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    result.push_back(*number);
    if (end == std::string_view::npos) return result;
    rest.remove_prefix(end + 1);
  }
}

std::optional<double> DicomAttributes::number(DicomTag tag) const {
  const auto all = numbers(tag);
  return all ? std::optional<double>(all->front()) : std::nullopt;
}

std::optional<int> DicomAttributes::integer(DicomTag tag) const {
  const auto found = value.find(tag);
  if (found == value.end() || found->second.size() < 2) return std::nullopt;
  return formats::read_value<std::uint16_t>(found->second, 0);
}

std::optional<std::uint32_t> DicomAttributes::integer32(DicomTag tag) const {
  const auto found = value.find(tag);
  if (found == value.end() || found->second.size() < 4) return std::nullopt;
  return formats::read_value<std::uint32_t>(found->second, 0);
}

std::optional<double> DicomAttributes::float64(DicomTag tag) const {
  const auto found = value.find(tag);
  if (found == value.end() || found->second.size() < 8) return std::nullopt;
  const auto number = formats::read_value<double>(found->second, 0);
  return std::isfinite(number) ? std::optional<double>(number) : std::nullopt;
}

std::optional<DicomTag> DicomAttributes::named_tag(DicomTag tag) const {
  const auto bits = integer32(tag);
  if (!bits) return std::nullopt;
  return *bits << 16 | *bits >> 16;
}

bool looks_like_dicom(std::string_view head) {
  if (head.size() >= 132 && head.substr(128, 4) == "DICM") return true;
  // Without a preamble: the group's length (0008,0000), the character set (0008,0005), the image
  // type (0008,0008) or the SOP class (0008,0016).
  if (head.size() < 64 || formats::read_value<std::uint16_t>(head, 0) != 0x0008) return false;
  const auto element = formats::read_value<std::uint16_t>(head, 2);
  return element == 0x0000 || element == 0x0005 || element == 0x0008 || element == 0x0016;
}

DicomElements dicom_elements(std::string_view bytes, std::uint64_t file_bytes) {
  DicomElements result;
  ElementWalk(bytes, file_bytes, result).run();
  return result;
}

}  // namespace palmar::images
