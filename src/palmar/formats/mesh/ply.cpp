// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/ply.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/mesh/mesh_build.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

std::optional<Type> type_named(std::string_view name) {
  struct Entry {
    std::string_view name;
    Type type;
  };
  constexpr std::array<Entry, 16> kTypes = {{{"char", Type::kInt8},
                                             {"uchar", Type::kUint8},
                                             {"short", Type::kInt16},
                                             {"ushort", Type::kUint16},
                                             {"int", Type::kInt32},
                                             {"uint", Type::kUint32},
                                             {"float", Type::kFloat},
                                             {"double", Type::kDouble},
                                             {"int8", Type::kInt8},
                                             {"uint8", Type::kUint8},
                                             {"int16", Type::kInt16},
                                             {"uint16", Type::kUint16},
                                             {"int32", Type::kInt32},
                                             {"uint32", Type::kUint32},
                                             {"float32", Type::kFloat},
                                             {"float64", Type::kDouble}}};
  for (const Entry& entry : kTypes) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type = Type::kFloat;
  std::optional<Type> count_type;  ///< set for a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  int header_line = 0;
};

enum class Encoding { kAscii, kLittle, kBig };

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to and including the end of the line "end_header"
  int lines = 0;
};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name) : scan_(bytes), name_(name) {}

  Header read() {
    Header header;
    scan_.next_line();  // "ply"
    bool has_format = false;
    while (true) {
      const auto line = scan_.next_line();
      if (!line || scan_.line() > 10000) {
        throw InputError(name_ + ": is truncated: the PLY header has no \"end_header\"");
      }
      TextScanner words(*line);
      const std::string_view keyword = words.next_word().value_or("");
      if (keyword == "end_header") break;
      if (keyword == "format") {
        header.encoding = read_format(words);
        has_format = true;
      } else if (keyword == "element") {
        read_element(words, header);
      } else if (keyword == "property") {
        read_property(words, header);
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        fail(in_quotes(keyword) + " is no PLY header line");
      }
    }
    if (!has_format) throw InputError(name_ + ": the PLY header has no \"format\" line");
    header.size = scan_.position();
    header.lines = scan_.line();
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(scan_.line()) + ": " + what);
  }

  Encoding read_format(TextScanner& words) const {
    const std::string_view encoding = words.next_word().value_or("");
    if (encoding == "ascii") return Encoding::kAscii;
    if (encoding == "binary_little_endian") return Encoding::kLittle;
    if (encoding == "binary_big_endian") return Encoding::kBig;
    fail("format is " + in_quotes(encoding) +
         "; ascii, binary_little_endian or binary_big_endian is required");
  }

  void read_element(TextScanner& words, Header& header) const {
    Element element;
    element.name = std::string(words.next_word().value_or(""));
    element.header_line = scan_.line();
    const auto text = words.next_word().value_or("");
    const auto count = parse_integer(text);
    if (!count || *count < 0) {
      fail("element " + in_quotes(element.name) + ": count is " + in_quotes(text) +
           "; a whole number is required");
    }
    element.count = static_cast<std::uint64_t>(*count);
    header.elements.push_back(std::move(element));
  }

  void read_property(TextScanner& words, Header& header) const {
    if (header.elements.empty()) fail("a property comes before the first element");
    const auto type = [&](std::string_view word) {
      const auto found = type_named(word);
      if (!found) fail("property type is " + in_quotes(word) + "; char ... double is required");
      return *found;
    };
    Property property;
    std::string_view word = words.next_word().value_or("");
    if (word == "list") {
      property.count_type = type(words.next_word().value_or(""));
      if (*property.count_type == Type::kFloat || *property.count_type == Type::kDouble) {
        fail("a list is counted by a floating-point type; a whole-number type is required");
      }
      word = words.next_word().value_or("");
    }
    property.type = type(word);
    property.name = std::string(words.next_word().value_or(""));
    header.elements.back().properties.push_back(std::move(property));
  }

  TextScanner scan_;
  const std::string& name_;
};

/// Values one after the other from text.
class AsciiSource {
 public:
  AsciiSource(std::string_view body, int lines_before) : scan_(body), lines_before_(lines_before) {}
  /// False if the data end; the word stands in bad() if it is no number.
  bool read(Type /*type*/, double& value) {
    const auto word = scan_.next_word();
    if (!word) return false;
    const auto number = parse_double(*word);
    if (!number) {
      bad_ = in_quotes(*word);
      return false;
    }
    value = *number;
    return true;
  }
  std::string place() const { return "line " + std::to_string(lines_before_ + scan_.line()); }
  const std::string& bad() const { return bad_; }

 private:
  TextScanner scan_;
  int lines_before_;
  std::string bad_;
};

/// Values one after the other from bytes.
class BinarySource {
 public:
  BinarySource(std::string_view bytes, std::size_t start, std::endian order)
      : bytes_(bytes), at_(start), order_(order) {}
  bool read(Type type, double& value) {
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) return false;
    switch (type) {
      case Type::kInt8:
        value = read_value<std::int8_t>(bytes_, at_, order_);
        break;
      case Type::kUint8:
        value = read_value<std::uint8_t>(bytes_, at_, order_);
        break;
      case Type::kInt16:
        value = read_value<std::int16_t>(bytes_, at_, order_);
        break;
      case Type::kUint16:
        value = read_value<std::uint16_t>(bytes_, at_, order_);
        break;
      case Type::kInt32:
        value = read_value<std::int32_t>(bytes_, at_, order_);
        break;
      case Type::kUint32:
        value = read_value<std::uint32_t>(bytes_, at_, order_);
        break;
      case Type::kFloat:
        value = read_value<float>(bytes_, at_, order_);
        break;
      case Type::kDouble:
        value = read_value<double>(bytes_, at_, order_);
        break;
    }
    at_ += size;
    return true;
  }
  std::string place() const { return "byte " + std::to_string(at_); }
  std::string bad() const { return {}; }

 private:
  std::string_view bytes_;
  std::size_t at_;
  std::endian order_;
};

template <typename Source>
class BodyReader {
 public:
  BodyReader(Source source, std::size_t body_bytes, const std::string& name,
             geometry::SurfaceColours* colours)
      : source_(std::move(source)), body_bytes_(body_bytes), name_(name), colours_(colours) {}

  MeshFile read(const std::vector<Element>& elements) {
    for (const Element& element : elements) {
      // No element needs memory or time beyond what the file can hold.
      if (!element.properties.empty() && element.count > body_bytes_) {
        throw InputError(name_ + ": is truncated: the header announces " +
                         std::to_string(element.count) + " " + in_quotes(element.name) +
                         " elements, but only " + std::to_string(body_bytes_) +
                         " bytes of data follow it");
      }
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        if (element.name == "tristrips") has_strips_ = true;
        skip(element);
      }
    }
    if (file_.mesh.triangles.empty() && has_strips_) {
      throw InputError(name_ + ": holds triangle strips; export it with faces");
    }
    check_faces();
    if (small_face_count_ > 0) {
      file_.notes.push_back(std::to_string(small_face_count_) +
                            " faces with fewer than 3 corners skipped");
    }
    if (splitter_.doubtful_count() > 0) {
      file_.notes.push_back(std::to_string(splitter_.doubtful_count()) +
                            " polygons cross themselves; split as fans");
    }
    finish_mesh(file_, name_, colours_);
    return std::move(file_);
  }

 private:
  double value(Type type, const Element& element, std::uint64_t row) {
    double result = 0.0;
    if (source_.read(type, result)) return result;
    const std::string where = element.name + " " + std::to_string(row + 1) + " of " +
                              std::to_string(element.count) + " (" + source_.place() + ")";
    if (!source_.bad().empty()) {
      throw InputError(name_ + ": " + where + ": " + source_.bad() + " is no number");
    }
    throw InputError(name_ + ": is truncated: the data end in " + where);
  }

  std::size_t list_size(const Property& property, const Element& element, std::uint64_t row) {
    const double count = value(*property.count_type, element, row);
    if (!(count >= 0.0) || count > static_cast<double>(body_bytes_) || count != std::floor(count)) {
      throw InputError(name_ + ": " + element.name + " " + std::to_string(row + 1) + " (" +
                       source_.place() + "): a list of " + shortest(count) +
                       " values can't be in this file");
    }
    return static_cast<std::size_t>(count);
  }

  void skip_property(const Property& property, const Element& element, std::uint64_t row) {
    const std::size_t count = property.count_type ? list_size(property, element, row) : 1;
    for (std::size_t k = 0; k < count; ++k) value(property.type, element, row);
  }

  void skip(const Element& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (const Property& property : element.properties) skip_property(property, element, row);
    }
  }

  /// Which of red, green and blue each property is, -1 for others; empty unless all are there.
  static std::vector<int> channels(const Element& element) {
    constexpr std::array<std::array<std::string_view, 3>, 3> kNames{
        {{"red", "green", "blue"},
         {"r", "g", "b"},
         {"diffuse_red", "diffuse_green", "diffuse_blue"}}};
    for (const auto& names : kNames) {
      std::vector<int> result(element.properties.size(), -1);
      int found = 0;
      for (std::size_t k = 0; k < result.size(); ++k) {
        const Property& property = element.properties[k];
        const auto name = std::find(names.begin(), names.end(), property.name);
        if (property.count_type || name == names.end()) continue;
        result[k] = static_cast<int>(name - names.begin());
        ++found;
      }
      if (found == 3) return result;
    }
    return {};
  }

  /// Property that says which vertices were seen, as `palmar photos mesh` writes it: less than
  /// `least`, and it is a guess.
  struct Sight {
    std::size_t property = 0;
    double least = 0.0;
  };
  static std::optional<Sight> sight_property(const Element& element) {
    constexpr std::array<std::pair<std::string_view, double>, 2> kNames{
        {{"measured", 1.0}, {"views", 2.0}}};
    for (const auto& [name, least] : kNames) {
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const Property& property = element.properties[k];
        if (!property.count_type && property.name == name) return Sight{k, least};
      }
    }
    return {};
  }

  void read_vertices(const Element& element) {
    std::array<bool, 3> has{};
    std::vector<int> axis;
    for (const Property& property : element.properties) {
      int which = -1;
      if (!property.count_type && property.name.size() == 1) {
        which = std::string_view("xyz").find(property.name) != std::string_view::npos
                    ? property.name[0] - 'x'
                    : -1;
      }
      if (which >= 0) has[static_cast<std::size_t>(which)] = true;
      axis.push_back(which);
    }
    for (int c = 0; c < 3; ++c) {
      if (!has[static_cast<std::size_t>(c)]) {
        throw InputError(name_ + ":" + std::to_string(element.header_line) +
                         ": element vertex has no property " + "xyz"[c]);
      }
    }
    check_triangle_count(name_, element.count / 3);
    const std::vector<int> channel = colours_ == nullptr ? std::vector<int>() : channels(element);
    const std::optional<Sight> sight = channel.empty() ? std::nullopt : sight_property(element);
    file_.mesh.vertices.reserve(file_.mesh.vertices.size() + element.count);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      Vec3 p = Vec3::Zero();
      geometry::Srgb colour = geometry::Srgb::Zero();
      for (std::size_t k = 0; k < axis.size(); ++k) {
        if (axis[k] >= 0) {
          p[axis[k]] = value(element.properties[k].type, element, row);
        } else if (!channel.empty() && channel[k] >= 0) {
          const Type type = element.properties[k].type;
          const bool is_fraction = type == Type::kFloat || type == Type::kDouble;
          colour[channel[k]] =
              static_cast<float>(value(type, element, row) / (is_fraction ? 1.0 : 255.0));
        } else if (sight && sight->property == k) {
          const double count = value(element.properties[k].type, element, row);
          colours_->is_guess.push_back(count < sight->least ? 1 : 0);
        } else {
          skip_property(element.properties[k], element, row);
        }
      }
      if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() <= 1e12)) {
        check_position(p, name_ + ": vertex " + std::to_string(row) + " (" + source_.place() + ")");
      }
      file_.mesh.vertices.push_back(p);
      if (!channel.empty()) {
        colours_->vertex.push_back(colour.cwiseMax(0.0F).cwiseMin(1.0F));
      }
    }
    vertices_read_ = true;
    for (auto& [element_row, corners] : waiting_) {
      add_face(corners, element_row);
    }
    waiting_.clear();
  }

  void read_faces(const Element& element) {
    check_triangle_count(name_, element.count);
    std::vector<int> corners;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      corners.clear();
      for (const Property& property : element.properties) {
        if (!property.count_type ||
            (property.name != "vertex_indices" && property.name != "vertex_index")) {
          skip_property(property, element, row);
          continue;
        }
        const std::size_t count = list_size(property, element, row);
        corners.clear();
        for (std::size_t k = 0; k < count; ++k) {
          const double index = value(property.type, element, row);
          if (!(index >= 0.0 && index < 2147483647.0) || index != std::floor(index)) {
            throw InputError(name_ + ": face " + std::to_string(row) + " (" + source_.place() +
                             ") names vertex " + shortest(index) +
                             "; a whole number from 0 is required");
          }
          corners.push_back(static_cast<int>(index));
        }
      }
      if (vertices_read_) {
        add_face(corners, row);
      } else {
        waiting_.emplace_back(row, corners);
      }
    }
  }

  void add_face(const std::vector<int>& corners, std::uint64_t row) {
    for (const int corner : corners) {
      if (corner >= file_.mesh.vertex_count()) {
        throw InputError(name_ + ": face " + std::to_string(row) + " (" + source_.place() +
                         ") names vertex " + std::to_string(corner) + "; the file has " +
                         std::to_string(file_.mesh.vertex_count()) + " (from 0)");
      }
    }
    if (corners.size() < 3) {
      ++small_face_count_;
      return;
    }
    check_triangle_count(name_, file_.mesh.triangles.size() + corners.size() - 2);
    splitter_.split(file_.mesh.vertices, corners, file_.mesh.triangles);
  }

  void check_faces() const {
    if (!waiting_.empty()) throw InputError(name_ + ": has faces but no element \"vertex\"");
  }

  Source source_;
  std::size_t body_bytes_;
  const std::string& name_;
  bool vertices_read_ = false;
  bool has_strips_ = false;
  int small_face_count_ = 0;
  std::vector<std::pair<std::uint64_t, std::vector<int>>> waiting_;  ///< faces before vertices
  PolygonSplitter splitter_;
  MeshFile file_;
  geometry::SurfaceColours* colours_;  ///< null: only the shape is wanted
};

MeshFile parse_ply_bytes(std::string_view bytes, const std::string& name,
                         geometry::SurfaceColours* colours) {
  if (!is_ply(bytes)) {
    throw InputError(name + ": is no PLY: starts with " + in_quotes(bytes.substr(0, 8)) +
                     "; a line \"ply\" is required");
  }
  const Header header = HeaderReader(bytes, name).read();
  const std::size_t body = bytes.size() - header.size;
  MeshFile file;
  if (header.encoding == Encoding::kAscii) {
    AsciiSource source(bytes.substr(header.size), header.lines);
    file = BodyReader(std::move(source), body, name, colours).read(header.elements);
    file.format = "ascii PLY";
  } else {
    const auto order =
        header.encoding == Encoding::kLittle ? std::endian::little : std::endian::big;
    BinarySource source(bytes, header.size, order);
    file = BodyReader(source, body, name, colours).read(header.elements);
    file.format = "binary PLY";
  }
  return file;
}

std::string format(const geometry::TriangleMesh& mesh, const std::vector<geometry::Srgb>& colour,
                   const std::vector<PlyByteProperty>& properties = {}) {
  std::string names;
  for (const PlyByteProperty& property : properties) {
    if (property.value.size() != mesh.vertices.size()) {
      throw UsageError("property " + property.name +
                       " of a mesh: one value per vertex is required");
    }
    names += "property uchar " + property.name + "\n";
  }
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment Palmar; millimetre\n"
      "element vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\n" +
      (colour.empty() ? "" : "property uchar red\nproperty uchar green\nproperty uchar blue\n") +
      names + "element face " + std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 27 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int c = 0; c < 3; ++c) append_value(bytes, mesh.vertices[v][c]);
    for (int c = 0; c < 3 && !colour.empty(); ++c) {
      const float value = std::clamp(colour[v][c], 0.0F, 1.0F);
      append_value(bytes, static_cast<std::uint8_t>(std::lround(255.0F * value)));
    }
    for (const PlyByteProperty& property : properties) append_value(bytes, property.value[v]);
  }
  for (const Triangle& t : mesh.triangles) {
    append_value(bytes, std::uint8_t{3});
    for (const int v : t) append_value(bytes, static_cast<std::int32_t>(v));
  }
  return bytes;
}

}  // namespace

bool is_ply(std::string_view bytes) {
  return bytes.size() > 4 && bytes.substr(0, 3) == "ply" && (bytes[3] == '\n' || bytes[3] == '\r');
}

MeshFile parse_ply(std::string_view bytes, const std::string& name) {
  return parse_ply_bytes(bytes, name, nullptr);
}

MeshFile parse_ply(std::string_view bytes, const std::string& name,
                   geometry::SurfaceColours& colours) {
  return parse_ply_bytes(bytes, name, &colours);
}

std::string format_ply(const geometry::TriangleMesh& mesh) { return format(mesh, {}); }

std::string format_ply(const geometry::ColouredMesh& mesh) {
  return format(mesh.mesh, mesh.colour);
}

std::string format_ply(const geometry::ColouredMesh& mesh,
                       const std::vector<PlyByteProperty>& properties) {
  return format(mesh.mesh, mesh.colour, properties);
}

}  // namespace palmar::formats
