// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace palmar::formats {

/// Writes a C3D file byte by byte as its specification has it (Motion Lab Systems, The C3D File
/// Format User Guide): every processor, both number formats.
struct C3dTestFile {
  enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };
  struct Point {
    float x = 0, y = 0, z = 0;
    bool is_seen = true;
  };
  Processor processor = Processor::kIntel;
  bool is_float = true;
  float scale = 0.05F;  ///< of integers
  float rate = 100.0F;  ///< Hz
  std::string unit = "mm";
  std::vector<std::string> labels;
  std::size_t labels_per_parameter = 255;  ///< the rest goes to LABELS2, LABELS3
  std::vector<std::vector<Point>> frames;
  int first_frame = 1;
  int analog_per_frame = 0;
  int promised_frames = 0;  ///< more than there are, if above 0

  std::string bytes() const {
    const std::string parameters = parameter_section();
    const int blocks = static_cast<int>(parameters.size() / 512);
    std::string header;
    header += '\x02';
    header += '\x50';
    add_word(header, static_cast<int>(labels.size()));
    add_word(header, analog_per_frame);
    add_word(header, first_frame);
    const int count = promised_frames > 0 ? promised_frames : static_cast<int>(frames.size());
    add_word(header, first_frame + count - 1);
    add_word(header, 0);  // gap
    add_float(header, is_float ? -scale : scale);
    add_word(header, 2 + blocks);
    add_word(header, 1);  // analog samples per frame
    add_float(header, rate);
    header.resize(512, '\0');
    std::string data;
    for (const std::vector<Point>& frame : frames) {
      for (const Point& point : frame) add_point(data, point);
      for (int a = 0; a < analog_per_frame; ++a) {
        if (is_float) {
          add_float(data, 7.5F);
        } else {
          add_word(data, 17);
        }
      }
    }
    data.resize((data.size() + 511) / 512 * 512, '\0');
    return header + parameters + data;
  }

 private:
  void add_word(std::string& to, int value) const {
    const auto v = static_cast<std::uint16_t>(value);
    const char low = static_cast<char>(v & 0xFF), high = static_cast<char>(v >> 8);
    to += processor == Processor::kMips ? high : low;
    to += processor == Processor::kMips ? low : high;
  }

  void add_float(std::string& to, float value) const {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, 4);
    const auto byte = [&](int k) { return static_cast<char>((bits >> (8 * k)) & 0xFF); };
    if (processor == Processor::kIntel) {
      for (int k = 0; k < 4; ++k) to += byte(k);
    } else if (processor == Processor::kMips) {
      for (int k = 3; k >= 0; --k) to += byte(k);
    } else {
      // VAX F: sign, exponent of excess 128 with the point left of the hidden bit, the word with
      // them first; each word little-endian. As IEEE bits that is the value times 4.
      if (value != 0.0F) bits += 2U << 23;
      to += byte(2);
      to += byte(3);
      to += byte(0);
      to += byte(1);
    }
  }

  void add_point(std::string& to, const Point& point) const {
    if (is_float) {
      add_float(to, point.x);
      add_float(to, point.y);
      add_float(to, point.z);
      add_float(to, point.is_seen ? 0.0F : -1.0F);
      return;
    }
    for (const float v : {point.x, point.y, point.z}) {
      add_word(to, static_cast<int>(v / scale + (v < 0 ? -0.5F : 0.5F)));
    }
    add_word(to, point.is_seen ? 0 : -1);
  }

  void add_entry(std::string& to, const std::string& name, int id, const std::string& body) const {
    to += static_cast<char>(name.size());
    to += static_cast<char>(id);
    to += name;
    add_word(to, static_cast<int>(body.size()) + 2);  // to the next entry, counted from here
    to += body;
  }

  std::string text_parameter(const std::vector<std::string>& texts, std::size_t length) const {
    std::string body;
    body += '\xFF';  // -1: characters
    body += '\x02';
    body += static_cast<char>(length);
    body += static_cast<char>(texts.size());
    for (std::string text : texts) {
      text.resize(length, ' ');
      body += text;
    }
    return body + '\0';
  }

  std::string float_parameter(float value) const {
    std::string body;
    body += '\x04';
    body += '\0';
    add_float(body, value);
    return body + '\0';
  }

  std::string parameter_section() const {
    std::string entries;
    std::string description(1, '\0');
    add_entry(entries, "POINT", -1, description);
    add_entry(entries, "SCALE", 1, float_parameter(is_float ? -scale : scale));
    add_entry(entries, "RATE", 1, float_parameter(rate));
    add_entry(entries, "UNITS", 1, text_parameter({unit}, 4));
    std::size_t k = 0;
    for (std::size_t from = 0; from < labels.size(); from += labels_per_parameter) {
      const std::size_t to = std::min(labels.size(), from + labels_per_parameter);
      const std::vector<std::string> some(labels.begin() + static_cast<std::ptrdiff_t>(from),
                                          labels.begin() + static_cast<std::ptrdiff_t>(to));
      ++k;
      add_entry(entries, k == 1 ? "LABELS" : "LABELS" + std::to_string(k), 1,
                text_parameter(some, 24));
    }
    entries += '\0';
    entries += '\0';
    std::string section;
    section += '\x01';
    section += '\x50';
    section += static_cast<char>((entries.size() + 4 + 511) / 512);
    section += static_cast<char>(processor);
    section += entries;
    section.resize((section.size() + 511) / 512 * 512, '\0');
    return section;
  }
};

}  // namespace palmar::formats
