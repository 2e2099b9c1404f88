// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/image/dicom_slice.h"
#include "palmar/formats/image/image_affine.h"
#include "palmar/formats/image/image_formats.h"
#include "palmar/formats/text_scan.h"

namespace palmar {
namespace {

struct NrrdHeader {
  std::map<std::string, std::string> field;
  std::size_t data = 0;  ///< offset of the values
};

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

NrrdHeader read_header(std::string_view bytes, const std::string& name) {
  NrrdHeader header;
  TextScanner scanner(bytes.substr(0, 65536));
  scanner.next_line();  // NRRD000x
  while (const auto line = scanner.next_line()) {
    if (line->empty()) {
      header.data = scanner.position();
      return header;
    }
    const std::size_t colon = line->find(':');
    if (line->front() == '#' || colon == std::string_view::npos || colon + 1 >= line->size() ||
        (*line)[colon + 1] == '=') {
      continue;  // a comment or a key of the user's
    }
    std::string key = trimmed(line->substr(0, colon));
    key.erase(std::remove(key.begin(), key.end(), ' '), key.end());
    header.field[key] = trimmed(line->substr(colon + 1));
  }
  throw InputError(name +
                   ": has no empty line behind its header (values in a file of their own "
                   "aren't read)");
}

StoredType type_of(const std::string& text, const std::string& name) {
  static const std::map<std::string, StoredType> kTypes = {
      {"signed char", StoredType::kInt8},    {"int8", StoredType::kInt8},
      {"int8_t", StoredType::kInt8},         {"uchar", StoredType::kUint8},
      {"unsigned char", StoredType::kUint8}, {"uint8", StoredType::kUint8},
      {"uint8_t", StoredType::kUint8},       {"short", StoredType::kInt16},
      {"short int", StoredType::kInt16},     {"signed short", StoredType::kInt16},
      {"int16", StoredType::kInt16},         {"int16_t", StoredType::kInt16},
      {"ushort", StoredType::kUint16},       {"unsigned short", StoredType::kUint16},
      {"uint16", StoredType::kUint16},       {"uint16_t", StoredType::kUint16},
      {"int", StoredType::kInt32},           {"signed int", StoredType::kInt32},
      {"int32", StoredType::kInt32},         {"int32_t", StoredType::kInt32},
      {"uint", StoredType::kUint32},         {"unsigned int", StoredType::kUint32},
      {"uint32", StoredType::kUint32},       {"uint32_t", StoredType::kUint32},
      {"float", StoredType::kFloat32},       {"double", StoredType::kFloat64}};
  const auto found = kTypes.find(text);
  if (found == kTypes.end()) {
    throw InputError(fmt::format("{}: values of type {} aren't read", name, in_quotes(text)));
  }
  return found->second;
}

/// Numbers of a text, with parentheses and commas as blanks.
std::vector<double> numbers_of(std::string text, const std::string& field,
                               const std::string& name) {
  for (char& c : text) {
    if (c == '(' || c == ')' || c == ',') c = ' ';
  }
  std::vector<double> result;
  TextScanner scanner(text);
  while (const auto word = scanner.next_word()) {
    const auto value = parse_double(*word);
    if (!value) {
      throw InputError(
          fmt::format("{}: \"{}\" is {}; numbers are required", name, field, in_quotes(text)));
    }
    result.push_back(*value);
  }
  return result;
}

/// Signs that turn a NRRD space into DICOM's.
Vec3 signs_of(const std::string& space, const std::string& name) {
  if (space == "left-posterior-superior" || space == "LPS") return {1, 1, 1};
  if (space == "right-anterior-superior" || space == "RAS") return {-1, -1, 1};
  if (space == "left-anterior-superior" || space == "LAS") return {1, -1, 1};
  throw InputError(fmt::format("{}: the space {} isn't read", name, in_quotes(space)));
}

void read_place(const NrrdHeader& header, ImageFile& file, const std::string& name) {
  const auto text = [&](const char* field) {
    const auto found = header.field.find(field);
    return found == header.field.end() ? std::string() : found->second;
  };
  Eigen::Matrix<double, 3, 4> affine = Eigen::Matrix<double, 3, 4>::Zero();
  const std::string directions = text("spacedirections");
  if (!directions.empty()) {
    const auto steps = numbers_of(directions, "space directions", name);
    if (steps.size() != 9) {
      throw InputError(fmt::format("{}: \"space directions\" has {} numbers; 9 are required", name,
                                   steps.size()));
    }
    for (int a = 0; a < 3; ++a) {
      for (int r = 0; r < 3; ++r) affine(r, a) = steps[static_cast<std::size_t>(3 * a + r)];
    }
    if (const std::string origin = text("spaceorigin"); !origin.empty()) {
      const auto at = numbers_of(origin, "space origin", name);
      if (at.size() != 3) throw InputError(name + ": \"space origin\" needs 3 numbers");
      affine.col(3) = Vec3(at[0], at[1], at[2]);
    }
    affine = signs_of(text("space"), name).asDiagonal() * affine;
  } else {
    const auto spacings = numbers_of(text("spacings"), "spacings", name);
    if (spacings.size() != 3) {
      throw InputError(name + ": has neither \"space directions\" nor three \"spacings\"");
    }
    for (int a = 0; a < 3; ++a) affine(a, a) = spacings[static_cast<std::size_t>(a)];
    file.notes.push_back("the file doesn't say how the image lies in the patient");
  }
  set_affine(file.image.grid, affine, name);
}

}  // namespace

ImageFile read_nrrd(std::string_view bytes, const std::string& name) {
  const NrrdHeader header = read_header(bytes, name);
  const auto field = [&](const char* key) {
    const auto found = header.field.find(key);
    return found == header.field.end() ? std::string() : found->second;
  };
  if (!field("datafile").empty()) {
    throw InputError(name + ": its values lie in a file of their own, which isn't read");
  }
  const auto sizes = numbers_of(field("sizes"), "sizes", name);
  if (sizes.size() != 3) {
    throw InputError(fmt::format("{}: has {} dimensions; 3 are required", name, sizes.size()));
  }
  check_image_size(name, sizes[0], sizes[1], sizes[2]);
  ImageFile file;
  file.description = std::filesystem::path(name).filename().string();
  for (std::size_t a = 0; a < 3; ++a) file.image.grid.size[a] = static_cast<int>(sizes[a]);
  read_place(header, file, name);

  StoredValues values;
  values.type = type_of(field("type"), name);
  const std::string endian = field("endian");
  if (endian == "big") values.order = std::endian::big;
  if (size_of(values.type) > 1 && endian != "big" && endian != "little") {
    throw InputError(name + ": \"endian\" is neither little nor big");
  }
  const std::string encoding = field("encoding");
  std::string_view data = bytes.substr(header.data);
  std::string unpacked;
  if (encoding == "gzip" || encoding == "gz") {
    unpacked = gunzip(data, file.image.grid.count() * size_of(values.type), name);
    data = unpacked;
  } else if (encoding != "raw") {
    throw InputError(
        fmt::format("{}: the encoding {} isn't read; raw and gzip are", name, in_quotes(encoding)));
  }
  file.image.value = decode_values(data, file.image.grid, values, name);
  return file;
}

std::string nrrd_bytes(const Volume& image) {
  const VolumeGrid& grid = image.grid;
  const auto vector = [](const Vec3& v) {
    return fmt::format("({},{},{})", shortest(v.x()), shortest(v.y()), shortest(v.z()));
  };
  std::string bytes = fmt::format(
      "NRRD0004\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
      "space directions: {} {} {}\nkinds: domain domain domain\nendian: little\nencoding: gzip\n"
      "space origin: {}\n\n",
      grid.size[0], grid.size[1], grid.size[2], vector(grid.axes.col(0) * grid.spacing[0]),
      vector(grid.axes.col(1) * grid.spacing[1]), vector(grid.axes.col(2) * grid.spacing[2]),
      vector(grid.origin));
  std::string values;
  values.reserve(image.value.size() * sizeof(float));
  for (const float value : image.value) append_value(values, value);
  return bytes + gzip(values);
}

}  // namespace palmar
