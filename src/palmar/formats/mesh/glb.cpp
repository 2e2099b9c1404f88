// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/glb.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"

namespace palmar::formats {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"

constexpr int kSignedByte = 5120, kUnsignedByte = 5121, kSignedShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;

std::uint32_t word_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

void append_word(std::vector<std::uint8_t>& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  }
}

template <class Value>
Value number_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::size_t size_of_component(int type) {
  switch (type) {
    case kSignedByte:
    case kUnsignedByte:
      return 1;
    case kSignedShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

double component_at(const std::vector<std::uint8_t>& bytes, std::size_t at, int type) {
  switch (type) {
    case kSignedByte:
      return number_at<std::int8_t>(bytes, at);
    case kUnsignedByte:
      return number_at<std::uint8_t>(bytes, at);
    case kSignedShort:
      return number_at<std::int16_t>(bytes, at);
    case kUnsignedShort:
      return number_at<std::uint16_t>(bytes, at);
    case kUnsignedInt:
      return number_at<std::uint32_t>(bytes, at);
    default:
      return static_cast<double>(number_at<float>(bytes, at));
  }
}

int components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  return 0;
}

std::string type_of(int components) {
  return components == 1    ? "SCALAR"
         : components == 16 ? "MAT4"
                            : "VEC" + std::to_string(components);
}

struct ByteRange {
  std::size_t offset = 0, length = 0;
  std::size_t stride = 0;  ///< 0 = tightly packed
};

ByteRange view_range(const Glb& glb, int view, const std::string& name) {
  const std::string what = name + ": bufferView " + std::to_string(view);
  const auto views = glb.json.find("bufferViews");
  if (views == glb.json.end() || !views->is_array() || view < 0 ||
      static_cast<std::size_t>(view) >= views->size()) {
    throw InputError(what + " does not exist");
  }
  try {
    const nlohmann::json& entry = (*views)[static_cast<std::size_t>(view)];
    if (json_whole_or<int>(entry, "buffer", 0) != 0) {
      throw InputError(what + " is not in the embedded buffer");
    }
    ByteRange range;
    range.offset = json_whole_or<std::size_t>(entry, "byteOffset", 0);
    range.length = json_whole<std::size_t>(entry.at("byteLength"));
    range.stride = json_whole_or<std::size_t>(entry, "byteStride", 0);
    if (range.offset > glb.buffer.size() || range.length > glb.buffer.size() - range.offset) {
      throw InputError(what + " reaches to byte " + std::to_string(range.offset) + " + " +
                       std::to_string(range.length) + ", but the buffer has " +
                       std::to_string(glb.buffer.size()));
    }
    return range;
  } catch (const nlohmann::json::exception& e) {
    throw InputError(what + ": " + json_reason(e));
  }
}

int add_view(Glb& glb, const void* data, std::size_t bytes, int target) {
  while (glb.buffer.size() % 8 != 0) glb.buffer.push_back(0);
  const std::size_t offset = glb.buffer.size();
  const auto* first = static_cast<const std::uint8_t*>(data);
  glb.buffer.insert(glb.buffer.end(), first, first + bytes);
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
  if (target != 0) view["target"] = target;
  glb.json["bufferViews"].push_back(std::move(view));
  return static_cast<int>(glb.json["bufferViews"].size()) - 1;
}

int add_accessor(Glb& glb, int view, int component_type, std::size_t count, int components) {
  glb.json["accessors"].push_back({{"bufferView", view},
                                   {"componentType", component_type},
                                   {"count", count},
                                   {"type", type_of(components)}});
  return static_cast<int>(glb.json["accessors"].size()) - 1;
}

}  // namespace

Glb parse_glb(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  if (bytes.size() < 20 || word_at(bytes, 0) != kGlbMagic) {
    throw InputError(name + ": not a binary glTF file (.glb): it has " +
                     std::to_string(bytes.size()) + " bytes and does not start with \"glTF\"");
  }
  if (word_at(bytes, 4) != 2) {
    throw InputError(name + ": glTF container version " + std::to_string(word_at(bytes, 4)) +
                     "; version 2 can be read");
  }
  const std::size_t total = word_at(bytes, 8);
  if (total > bytes.size() || total < 20) {
    throw InputError(name + ": truncated: the header promises " + std::to_string(total) +
                     " bytes, the file has " + std::to_string(bytes.size()));
  }
  Glb glb;
  bool has_json = false;
  for (std::size_t at = 12; at + 8 <= total;) {
    const std::size_t length = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    at += 8;
    if (length > total - at) {
      throw InputError(name + ": truncated: a chunk at byte " + std::to_string(at - 8) +
                       " promises " + std::to_string(length) + " bytes, " +
                       std::to_string(total - at) + " are left");
    }
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto last = first + static_cast<std::ptrdiff_t>(length);
    if (type == kJsonChunk && !has_json) {
      try {
        glb.json = nlohmann::json::parse(first, last);
      } catch (const nlohmann::json::exception& e) {
        throw InputError(name + ": broken JSON in the glTF file: " + json_reason(e));
      }
      has_json = true;
    } else if (type == kBinChunk && glb.buffer.empty()) {
      glb.buffer.assign(first, last);
    }
    at += length;
  }
  if (!has_json || !glb.json.is_object()) {
    throw InputError(name + ": the glTF file has no JSON object");
  }
  return glb;
}

Glb read_glb(const std::string& path) {
  const std::string bytes = read_file(path);
  return parse_glb({bytes.begin(), bytes.end()}, path);
}

std::vector<std::uint8_t> format_glb(const Glb& glb) {
  nlohmann::json json = glb.json;
  std::vector<std::uint8_t> buffer = glb.buffer;
  while (buffer.size() % 4 != 0) buffer.push_back(0);
  if (!buffer.empty()) {
    json["buffers"] = nlohmann::json::array();
    json["buffers"].push_back({{"byteLength", buffer.size()}});
  }
  std::string text = json.dump();
  while (text.size() % 4 != 0) text.push_back(' ');
  const std::size_t total = 12 + 8 + text.size() + (buffer.empty() ? 0 : 8 + buffer.size());
  std::vector<std::uint8_t> bytes;
  bytes.reserve(total);
  append_word(bytes, kGlbMagic);
  append_word(bytes, 2);
  append_word(bytes, static_cast<std::uint32_t>(total));
  append_word(bytes, static_cast<std::uint32_t>(text.size()));
  append_word(bytes, kJsonChunk);
  bytes.insert(bytes.end(), text.begin(), text.end());
  if (!buffer.empty()) {
    append_word(bytes, static_cast<std::uint32_t>(buffer.size()));
    append_word(bytes, kBinChunk);
    bytes.insert(bytes.end(), buffer.begin(), buffer.end());
  }
  return bytes;
}

void write_glb(const Glb& glb, const std::string& path) {
  const std::vector<std::uint8_t> bytes = format_glb(glb);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

AccessorData read_accessor(const Glb& glb, int index, const std::string& name) {
  const std::string what = name + ": accessor " + std::to_string(index);
  const auto accessors = glb.json.find("accessors");
  if (accessors == glb.json.end() || !accessors->is_array() || index < 0 ||
      static_cast<std::size_t>(index) >= accessors->size()) {
    throw InputError(what + " does not exist");
  }
  try {
    const nlohmann::json& entry = (*accessors)[static_cast<std::size_t>(index)];
    if (entry.contains("sparse") || !entry.contains("bufferView")) {
      throw InputError(what + " is sparse or has no bufferView; that can't be read");
    }
    const ByteRange range = view_range(glb, json_whole<int>(entry.at("bufferView")), name);
    const int type = json_whole<int>(entry.at("componentType"));
    const std::size_t size = size_of_component(type);
    const std::size_t count = json_whole<std::size_t>(entry.at("count"));
    const int components = components_of(entry.at("type").get<std::string>());
    if (size == 0 || components == 0) {
      throw InputError(what + ": componentType " + std::to_string(type) + " or type \"" +
                       entry.at("type").get<std::string>() + "\" is unknown");
    }
    const std::size_t element = size * static_cast<std::size_t>(components);
    const std::size_t stride = range.stride == 0 ? element : range.stride;
    const std::size_t offset = json_whole_or<std::size_t>(entry, "byteOffset", 0);
    // Division, not multiplication: a wild count must not overflow past the check.
    if (offset > range.length ||
        (count > 0 && (range.length - offset < element ||
                       (range.length - offset - element) / stride < count - 1))) {
      throw InputError(what + ": " + std::to_string(count) +
                       " elements reach outside its bufferView of " + std::to_string(range.length) +
                       " bytes");
    }
    AccessorData data;
    data.count = static_cast<int>(count);
    data.components = components;
    data.value.reserve(count * static_cast<std::size_t>(components));
    for (std::size_t i = 0; i < count; ++i) {
      for (int c = 0; c < components; ++c) {
        const std::size_t at =
            range.offset + offset + i * stride + static_cast<std::size_t>(c) * size;
        data.value.push_back(component_at(glb.buffer, at, type));
      }
    }
    return data;
  } catch (const nlohmann::json::exception& e) {
    throw InputError(what + ": " + json_reason(e));
  }
}

std::vector<double> read_doubles(const Glb& glb, int buffer_view, std::size_t expected,
                                 const std::string& name) {
  const ByteRange range = view_range(glb, buffer_view, name);
  if (range.length % sizeof(double) != 0 || range.length / sizeof(double) != expected) {
    throw InputError(name + ": bufferView " + std::to_string(buffer_view) + " has " +
                     std::to_string(range.length) + " bytes; " + std::to_string(expected) +
                     " numbers of 8 bytes are needed");
  }
  std::vector<double> value(expected);
  if (expected > 0) std::memcpy(value.data(), glb.buffer.data() + range.offset, range.length);
  return value;
}

int add_floats(Glb& glb, const std::vector<float>& value, int components, bool with_bounds) {
  constexpr int kVertexTarget = 34962;
  const int view = add_view(glb, value.data(), value.size() * sizeof(float),
                            components == 16 ? 0 : kVertexTarget);
  const auto width = static_cast<std::size_t>(components);
  const int accessor = add_accessor(glb, view, kFloat, value.size() / width, components);
  if (with_bounds) {
    std::vector<float> low(width, std::numeric_limits<float>::max());
    std::vector<float> high(width, std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < value.size(); ++i) {
      low[i % width] = std::min(low[i % width], value[i]);
      high[i % width] = std::max(high[i % width], value[i]);
    }
    glb.json["accessors"].back()["min"] = low;
    glb.json["accessors"].back()["max"] = high;
  }
  return accessor;
}

int add_indices(Glb& glb, const std::vector<std::uint32_t>& value) {
  constexpr int kIndexTarget = 34963;
  const int view = add_view(glb, value.data(), value.size() * sizeof(std::uint32_t), kIndexTarget);
  return add_accessor(glb, view, kUnsignedInt, value.size(), 1);
}

int add_bytes(Glb& glb, const std::vector<std::uint8_t>& value, int components) {
  constexpr int kVertexTarget = 34962;
  const int view = add_view(glb, value.data(), value.size(), kVertexTarget);
  return add_accessor(glb, view, kUnsignedByte, value.size() / static_cast<std::size_t>(components),
                      components);
}

int add_doubles(Glb& glb, const std::vector<double>& value) {
  return add_view(glb, value.data(), value.size() * sizeof(double), 0);
}

}  // namespace palmar::formats
