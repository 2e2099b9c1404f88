// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/formats/image/dicom_compressed.h"

namespace palmar {
namespace {

/// A Huffman code as T.81, annex C makes it of the number of codes per length.
struct HuffmanTable {
  std::array<int, 17> first_code{}, first_index{}, count{};  ///< by length
  std::vector<std::uint8_t> value;
};

struct Frame {
  int precision = 0;
  std::array<std::optional<HuffmanTable>, 4> table;
  int restart_interval = 0;  ///< samples, 0: none
  std::size_t table_used = 0;
  int predictor = 1, shift = 0;
};

/// The markers before the coded samples.
class Header {
 public:
  Header(std::string_view bytes, int columns, int rows, const std::string& name)
      : bytes_(bytes), columns_(columns), rows_(rows), name_(name) {}

  /// Returns where the coded samples begin.
  std::size_t read(Frame& frame) {
    if (word() != 0xFFD8) fail("doesn't begin as JPEG does");
    while (true) {
      const int marker = word();
      if (marker == 0xFFFF) {  // a byte that fills
        --at_;
        continue;
      }
      const std::size_t start = at_;
      const auto length = static_cast<std::size_t>(word());
      if (length < 2 || length > bytes_.size() - start) fail("is cut off");
      end_ = start + length;
      if (marker == 0xFFC3) {
        read_frame(frame);
      } else if (marker == 0xFFC4) {
        while (at_ < end_) read_table(frame);
      } else if (marker == 0xFFDD) {
        frame.restart_interval = word();
      } else if (marker == 0xFFDA) {
        read_scan(frame);
        return end_;
      } else if (marker < 0xFFE0 || marker > 0xFFFE) {
        fail(fmt::format("has the marker {:04X}, which lossless JPEG hasn't", marker));
      }
      at_ = end_;
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(fmt::format("{}: its compressed image {} (byte {})", name_, why, at_));
  }
  int byte() {
    if (at_ >= bytes_.size()) fail("is cut off");
    return static_cast<unsigned char>(bytes_[at_++]);
  }
  int word() {
    const int high = byte();
    return high << 8 | byte();
  }

  void read_frame(Frame& frame) {
    frame.precision = byte();
    const int rows = word();
    const int columns = word();
    if (rows != rows_ || columns != columns_) {
      fail(
          fmt::format("has {} x {} pixels; the file says {} x {}", columns, rows, columns_, rows_));
    }
    if (byte() != 1) fail("has several colours");
    if (frame.precision < 2 || frame.precision > 16) {
      fail(fmt::format("has {} bits", frame.precision));
    }
  }

  void read_table(Frame& frame) {
    const int id = byte();
    if (id > 3) fail("has an unknown table");
    HuffmanTable table;
    int code = 0;
    int total = 0;
    for (std::size_t length = 1; length <= 16; ++length) {
      table.count[length] = byte();
      table.first_code[length] = code;
      table.first_index[length] = total;
      code = (code + table.count[length]) << 1;
      total += table.count[length];
    }
    for (int v = 0; v < total; ++v) {
      const int value = byte();
      if (value > 16) fail("has a damaged table");
      table.value.push_back(static_cast<std::uint8_t>(value));
    }
    frame.table[static_cast<std::size_t>(id)] = std::move(table);
  }

  void read_scan(Frame& frame) {
    if (byte() != 1) fail("has several colours");
    byte();  // the component's name
    frame.table_used = static_cast<std::size_t>(byte() >> 4);
    frame.predictor = byte();
    byte();
    frame.shift = byte() & 15;
    if (frame.precision == 0) fail("has no frame");
    if (frame.table_used > 3 || !frame.table[frame.table_used]) fail("has no table");
    if (frame.predictor < 1 || frame.predictor > 7) {
      fail(fmt::format("has predictor {}", frame.predictor));
    }
    if (frame.shift >= frame.precision) fail("shifts all bits away");
    if (frame.restart_interval % columns_ != 0) fail("restarts within a row");
  }

  std::string_view bytes_;
  int columns_, rows_;
  const std::string& name_;
  std::size_t at_ = 0, end_ = 0;
};

/// Bits of the coded samples.
class BitReader {
 public:
  BitReader(std::string_view bytes, std::size_t at, const std::string& name)
      : bytes_(bytes), at_(at), name_(name) {}

  int bit() {
    if (left_ == 0) {
      if (at_ >= bytes_.size()) fail();
      current_ = static_cast<unsigned char>(bytes_[at_++]);
      left_ = 8;
      if (current_ == 0xFF) {  // followed by 0, or else by a marker
        if (at_ >= bytes_.size() || bytes_[at_] != 0) fail();
        ++at_;
      }
    }
    --left_;
    return current_ >> left_ & 1;
  }
  int bits(int count) {
    int value = 0;
    for (int b = 0; b < count; ++b) value = value << 1 | bit();
    return value;
  }
  int symbol(const HuffmanTable& table) {
    int code = 0;
    for (std::size_t length = 1; length <= 16; ++length) {
      code = code << 1 | bit();
      const int offset = code - table.first_code[length];
      if (offset >= 0 && offset < table.count[length]) {
        return table.value[static_cast<std::size_t>(table.first_index[length] + offset)];
      }
    }
    fail();
  }
  /// Passes over the marker between two intervals.
  void restart() {
    left_ = 0;
    const bool is_there = at_ + 1 < bytes_.size() && bytes_[at_] == '\xFF' &&
                          (static_cast<unsigned char>(bytes_[at_ + 1]) & 0xF8) == 0xD0;
    if (!is_there) fail();
    at_ += 2;
  }

 private:
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("{}: its compressed image is damaged or cut off (byte {} of {})",
                                 name_, at_, bytes_.size()));
  }
  std::string_view bytes_;
  std::size_t at_;
  const std::string& name_;
  int current_ = 0, left_ = 0;
};

/// Table H.1: a left, b above, c above left.
int predicted(int predictor, int a, int b, int c) {
  switch (predictor) {
    case 1:
      return a;
    case 2:
      return b;
    case 3:
      return c;
    case 4:
      return a + b - c;
    case 5:
      return a + ((b - c) >> 1);
    case 6:
      return b + ((a - c) >> 1);
    default:
      return (a + b) >> 1;
  }
}

/// Table F.1 and H.2: a difference from the number of its bits.
int difference(BitReader& reader, const HuffmanTable& table) {
  const int size = reader.symbol(table);
  if (size == 0) return 0;
  if (size == 16) return 32768;
  const int value = reader.bits(size);
  return value < 1 << (size - 1) ? value - (1 << size) + 1 : value;
}

}  // namespace

std::vector<std::uint16_t> lossless_jpeg(std::string_view bytes, int columns, int rows,
                                         const std::string& name) {
  Frame frame;
  const std::size_t start = Header(bytes, columns, rows, name).read(frame);
  const std::size_t width = static_cast<std::size_t>(columns);
  const std::size_t count = width * static_cast<std::size_t>(rows);
  // No sample has less than a bit: a short file can't ask for much memory.
  if (bytes.size() * 8 < count) {
    throw InputError(name + ": its compressed image is cut off");
  }
  const HuffmanTable& table = *frame.table[frame.table_used];
  BitReader reader(bytes, start, name);
  std::vector<std::uint16_t> value(count);
  const auto interval = static_cast<std::size_t>(frame.restart_interval);
  const int middle = 1 << (frame.precision - frame.shift - 1);
  std::size_t first_row = 0;  // of the interval
  for (std::size_t v = 0; v < count; ++v) {
    if (interval > 0 && v > 0 && v % interval == 0) {
      reader.restart();
      first_row = v / width;
    }
    const std::size_t row = v / width;
    const std::size_t column = v % width;
    int expected = middle;
    if (row == first_row) {
      if (column > 0) expected = value[v - 1];
    } else if (column == 0) {
      expected = value[v - width];
    } else {
      expected = predicted(frame.predictor, value[v - 1], value[v - width], value[v - width - 1]);
    }
    value[v] = static_cast<std::uint16_t>((expected + difference(reader, table)) & 0xFFFF);
  }
  if (frame.shift > 0) {
    for (std::uint16_t& v : value) v = static_cast<std::uint16_t>(v << frame.shift);
  }
  return value;
}

}  // namespace palmar
