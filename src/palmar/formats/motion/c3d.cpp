// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/motion/c3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

constexpr std::size_t kBlock = 512;
constexpr unsigned char kKey = 0x50;  // second byte of header and parameter section

enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };

std::string without_blanks(std::string_view text) {
  constexpr std::string_view kBlank(" \t\r\n\0", 5);
  const auto from = text.find_first_not_of(kBlank);
  if (from == text.npos) return "";
  return std::string(text.substr(from, text.find_last_not_of(kBlank) - from + 1));
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// One parameter as it stands in the file.
struct Parameter {
  int type = 0;  ///< -1 characters, 1 bytes, 2 integers, 4 floats
  std::vector<std::size_t> dimension;
  std::size_t start = 0;  ///< of its data
  std::size_t count = 0;  ///< of its values
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  MarkerRecording read(std::optional<geometry::LengthUnit> unit) {
    if (!is_c3d(bytes_)) fail(0, "no C3D header");
    read_parameters();
    read_layout();
    const double factor = geometry::millimetres_per(unit ? *unit : unit_of_file());
    read_labels();
    read_frames(factor);
    recording_.format = fmt::format("C3D ({}, {})",
                                    processor_ == Processor::kIntel ? "Intel"
                                    : processor_ == Processor::kDec ? "DEC"
                                                                    : "MIPS",
                                    is_float_ ? "float" : "integer");
    return std::move(recording_);
  }

 private:
  [[noreturn]] void fail(std::size_t byte, const std::string& why) const {
    throw InputError(fmt::format("{}: byte {}: {}", path_, byte, why));
  }

  void need(std::size_t offset, std::size_t size, const char* what) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      fail(offset, fmt::format("the file ends within {} ({} bytes in all)", what, bytes_.size()));
    }
  }

  std::uint8_t byte_at(std::size_t offset) const {
    return static_cast<std::uint8_t>(bytes_[offset]);
  }
  std::int16_t word_at(std::size_t offset) const {
    return read_value<std::int16_t>(
        bytes_, offset, processor_ == Processor::kMips ? std::endian::big : std::endian::little);
  }
  /// DEC's single precision has its 16-bit halves swapped and an exponent that is larger by 2.
  float float_at(std::size_t offset) const {
    if (processor_ == Processor::kMips) return read_value<float>(bytes_, offset, std::endian::big);
    if (processor_ == Processor::kIntel) return read_value<float>(bytes_, offset);
    const auto low = read_value<std::uint16_t>(bytes_, offset);
    const auto high = read_value<std::uint16_t>(bytes_, offset + 2);
    const std::uint32_t bits = (static_cast<std::uint32_t>(low) << 16) | high;
    return std::bit_cast<float>(bits) / 4.0F;
  }

  void read_parameters() {
    const std::size_t start = (byte_at(0) - std::size_t{1}) * kBlock;
    need(start, 4, "the parameter section");
    const int kind = byte_at(start + 3);
    if (kind < 84 || kind > 86) {
      fail(start + 3,
           fmt::format("processor type {}; 84 (Intel), 85 (DEC) or 86 (MIPS) is needed", kind));
    }
    processor_ = static_cast<Processor>(kind);
    std::map<int, std::string> group_name;
    std::vector<std::pair<int, std::pair<std::string, Parameter>>> found;
    std::size_t at = start + 4;
    // Each entry goes forward by at least its own size, so this ends.
    while (at + 2 <= bytes_.size()) {
      const int length = std::abs(static_cast<int>(static_cast<std::int8_t>(byte_at(at))));
      if (length == 0) break;
      const int id = static_cast<std::int8_t>(byte_at(at + 1));
      const auto name_size = static_cast<std::size_t>(length);
      need(at + 2, name_size + 2, "a parameter's name");
      const std::string name = upper(without_blanks(bytes_.substr(at + 2, name_size)));
      const std::size_t link = at + 2 + name_size;
      const auto offset = static_cast<std::uint16_t>(word_at(link));
      if (id < 0) {
        group_name.emplace(-id, name);
      } else if (id > 0) {
        found.emplace_back(id, std::make_pair(name, read_parameter(link + 2, name)));
      }
      if (offset == 0) break;
      if (offset < 2) fail(link, "a parameter points back into itself");
      at = link + offset;
    }
    for (auto& [id, entry] : found) {
      const auto group = group_name.find(id);
      if (group == group_name.end()) continue;
      parameter_.emplace(group->second + ":" + entry.first, std::move(entry.second));
    }
  }

  Parameter read_parameter(std::size_t at, const std::string& name) const {
    need(at, 2, "a parameter");
    Parameter parameter;
    parameter.type = static_cast<std::int8_t>(byte_at(at));
    const std::size_t dimensions = byte_at(at + 1);
    need(at + 2, dimensions, "a parameter's dimensions");
    parameter.start = at + 2 + dimensions;
    parameter.count = 1;
    const auto size = static_cast<std::size_t>(std::abs(parameter.type));
    for (std::size_t d = 0; d < dimensions; ++d) {
      parameter.dimension.push_back(byte_at(at + 2 + d));
      parameter.count *= parameter.dimension.back();
      if (parameter.count > bytes_.size()) {
        fail(at, "parameter " + in_quotes(name) + " is larger than the file");
      }
    }
    if (size != 1 && size != 2 && size != 4) {
      fail(at, fmt::format("parameter {} is of type {}; -1, 1, 2 or 4 is needed", in_quotes(name),
                           parameter.type));
    }
    need(parameter.start, parameter.count * size, "a parameter's values");
    return parameter;
  }

  const Parameter* find(const std::string& name) const {
    const auto found = parameter_.find(name);
    return found == parameter_.end() || found->second.count == 0 ? nullptr : &found->second;
  }

  /// The k-th value of a parameter as a number.
  std::optional<double> number(const std::string& name, std::size_t k = 0) const {
    const Parameter* parameter = find(name);
    if (parameter == nullptr || k >= parameter->count) return std::nullopt;
    if (parameter->type == 4) return float_at(parameter->start + 4 * k);
    if (parameter->type == 2) return word_at(parameter->start + 2 * k);
    if (parameter->type == 1) return byte_at(parameter->start + k);
    return std::nullopt;
  }

  std::vector<std::string> strings(const std::string& name) const {
    const Parameter* parameter = find(name);
    std::vector<std::string> result;
    if (parameter == nullptr || parameter->type != -1 || parameter->dimension.empty()) {
      return result;
    }
    const std::size_t length = parameter->dimension.front();
    for (std::size_t at = 0; at + length <= parameter->count; at += length) {
      result.push_back(without_blanks(bytes_.substr(parameter->start + at, length)));
    }
    return result;
  }

  static int unsigned_word(std::int16_t word) { return static_cast<std::uint16_t>(word); }

  void read_layout() {
    points_ = unsigned_word(word_at(2));
    if (const auto used = number("POINT:USED")) {
      const int count = unsigned_word(static_cast<std::int16_t>(*used));
      if (count != points_) {
        recording_.notes.push_back(fmt::format(
            "the header has {} points, POINT:USED says {}; the header counts", points_, count));
      }
    }
    if (points_ == 0) fail(2, "the file has no 3D points");
    analog_ = unsigned_word(word_at(4));
    first_frame_ = unsigned_word(word_at(6));
    const int last_frame = unsigned_word(word_at(8));
    frames_ = std::max(0, last_frame - first_frame_ + 1);
    // Longer recordings don't fit the header's 16 bits.
    if (const Parameter* start = find("TRIAL:ACTUAL_START_FIELD");
        start != nullptr && find("TRIAL:ACTUAL_END_FIELD") != nullptr) {
      const auto long_of = [&](const std::string& name) {
        const Parameter* p = find(name);
        if (p->type != 2 || p->count < 2) return std::int64_t{-1};
        return std::int64_t{unsigned_word(word_at(p->start))} +
               65536 * std::int64_t{unsigned_word(word_at(p->start + 2))};
      };
      const std::int64_t from = long_of("TRIAL:ACTUAL_START_FIELD");
      const std::int64_t to = long_of("TRIAL:ACTUAL_END_FIELD");
      if (from >= 0 && to >= from && to - from < (std::int64_t{1} << 30)) {
        first_frame_ = static_cast<int>(std::min<std::int64_t>(from, 1 << 30));
        frames_ = static_cast<int>(to - from + 1);
      }
    }
    float scale = float_at(12);
    if (const auto value = number("POINT:SCALE")) scale = static_cast<float>(*value);
    is_float_ = scale < 0.0F;
    if (!std::isfinite(scale) || (!is_float_ && !(scale > 0.0F))) {
      fail(12, fmt::format("POINT:SCALE is {}; a number other than 0 is needed", scale));
    }
    scale_ = std::abs(static_cast<double>(scale));
    rate_ = float_at(20);
    if (const auto value = number("POINT:RATE")) rate_ = *value;
    if (!(std::isfinite(rate_) && rate_ > 0.0)) {
      recording_.notes.emplace_back("the frame rate is not given: frames have no time");
      rate_ = 0.0;
    }
    int block = unsigned_word(word_at(16));
    if (block == 0) {
      const double given = number("POINT:DATA_START").value_or(0.0);
      block = given > 0.0 && given < 65536.0 ? static_cast<int>(given) : 0;
    }
    if (block == 0) fail(16, "the start of the data is not given");
    data_ = (static_cast<std::size_t>(block) - 1) * kBlock;
  }

  geometry::LengthUnit unit_of_file() {
    const std::vector<std::string> units = strings("POINT:UNITS");
    if (units.empty() || units.front().empty()) {
      throw InputError(path_ + ": POINT:UNITS is missing; give the unit by setting \"unit\"");
    }
    if (const auto unit = geometry::length_unit_named(units.front())) return *unit;
    throw InputError(path_ + ": POINT:UNITS is " + in_quotes(units.front()) +
                     ", which is not known; give the unit by setting \"unit\"");
  }

  void read_labels() {
    std::vector<std::string> labels = strings("POINT:LABELS");
    for (int k = 2; k < 300; ++k) {
      const std::vector<std::string> more = strings("POINT:LABELS" + std::to_string(k));
      if (more.empty()) break;
      labels.insert(labels.end(), more.begin(), more.end());
    }
    const auto count = static_cast<std::size_t>(points_);
    if (labels.size() < count) {
      recording_.notes.push_back(
          fmt::format("{} of {} points have no label", count - labels.size(), count));
    }
    labels.resize(count);
    std::set<std::string> taken;
    for (std::size_t i = 0; i < count; ++i) {
      if (labels[i].empty()) labels[i] = "point " + std::to_string(i + 1);
      if (!taken.insert(labels[i]).second) {
        recording_.notes.push_back("label " + in_quotes(labels[i]) +
                                   " appears twice; the first point has it");
        labels[i] += " (" + std::to_string(i + 1) + ")";
      }
    }
    recording_.labels = std::move(labels);
  }

  std::optional<Vec3> point_at(std::size_t at, double factor) {
    Vec3 p;
    double residual = 0.0;
    if (is_float_) {
      for (int k = 0; k < 3; ++k) {
        p[k] = factor * float_at(at + 4 * static_cast<std::size_t>(k));
      }
      residual = float_at(at + 12);
    } else {
      for (int k = 0; k < 3; ++k) {
        p[k] = factor * scale_ * word_at(at + 2 * static_cast<std::size_t>(k));
      }
      residual = word_at(at + 6);
    }
    if (residual < 0.0) return std::nullopt;
    constexpr double kFar = 1e9;  // mm; no laboratory is that large
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFar || std::isnan(residual)) {
      ++broken_;
      return std::nullopt;
    }
    if (p == Vec3::Zero()) {
      ++at_origin_;
      return std::nullopt;
    }
    return p;
  }

  void read_frames(double factor) {
    const std::size_t value = is_float_ ? 4 : 2;
    const std::size_t point_size = 4 * value;
    const std::size_t frame_size =
        static_cast<std::size_t>(points_) * point_size + static_cast<std::size_t>(analog_) * value;
    need(data_, frame_size, "the first frame of the data");
    const std::size_t there = (bytes_.size() - data_) / frame_size;
    auto frames = static_cast<std::size_t>(frames_);
    if (frames == 0) fail(6, "the file has no frames");
    if (frames > there) {
      recording_.notes.push_back(
          fmt::format("the header promises {} frames, the file holds {}", frames, there));
      frames = there;
    }
    recording_.frames.resize(frames);
    for (std::size_t f = 0; f < frames; ++f) {
      MarkerRecording::Frame& frame = recording_.frames[f];
      frame.number = first_frame_ + static_cast<int>(f);
      if (rate_ > 0.0) frame.time = static_cast<double>(f) / rate_;
      frame.position.reserve(static_cast<std::size_t>(points_));
      for (std::size_t i = 0; i < static_cast<std::size_t>(points_); ++i) {
        frame.position.push_back(point_at(data_ + f * frame_size + i * point_size, factor));
      }
    }
    if (broken_ > 0) {
      recording_.notes.push_back(
          fmt::format("{} positions are no numbers and count as not seen", broken_));
    }
    if (at_origin_ > 0) {
      recording_.notes.push_back(
          fmt::format("{} positions are 0, 0, 0 and count as not seen", at_origin_));
    }
  }

  std::string_view bytes_;
  std::string path_;
  Processor processor_ = Processor::kIntel;
  std::map<std::string, Parameter> parameter_;  ///< "POINT:LABELS"
  int points_ = 0, analog_ = 0, first_frame_ = 1, frames_ = 0;
  bool is_float_ = false;
  double scale_ = 1.0, rate_ = 0.0;
  std::size_t data_ = 0;
  int broken_ = 0, at_origin_ = 0;
  MarkerRecording recording_;
};

}  // namespace

bool is_c3d(std::string_view bytes) {
  return bytes.size() >= 2 * kBlock && static_cast<unsigned char>(bytes[1]) == kKey &&
         static_cast<unsigned char>(bytes[0]) >= 2;
}

MarkerRecording parse_c3d(std::string_view bytes, const std::string& path,
                          std::optional<geometry::LengthUnit> unit) {
  return Reader(bytes, path).read(unit);
}

}  // namespace palmar::formats
