// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/vtk.h"

#include <cstdint>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

/// Collects the arrays that stand behind the XML part.
class Appended {
 public:
  /// A DataArray element for these raw values; its header is their length in bytes.
  std::string array(std::string_view type, const std::string& name, int components,
                    std::string_view raw) {
    std::string block;
    append_value(block, static_cast<std::uint64_t>(raw.size()));
    // Header and data are encoded apart, so that a reader finds the length by itself.
    const std::string element = "<DataArray type=\"" + std::string(type) + "\" Name=\"" +
                                xml_escaped(name) + "\" NumberOfComponents=\"" +
                                std::to_string(components) + "\" format=\"appended\" offset=\"" +
                                std::to_string(data_.size()) + "\"/>\n";
    data_ += base64(block + std::string(raw));
    return element;
  }
  const std::string& data() const { return data_; }

 private:
  std::string data_;
};

std::string raw_doubles(const std::vector<double>& values) {
  std::string raw;
  raw.reserve(8 * values.size());
  for (const double v : values) append_value(raw, v);
  return raw;
}

/// VTK writes a string in ascii as the codes of its bytes, ended by 0.
std::string field_data(const std::vector<MeshNote>& notes) {
  if (notes.empty()) return "";
  std::string result = "<FieldData>\n";
  for (const MeshNote& note : notes) {
    result += "<DataArray type=\"String\" Name=\"" + xml_escaped(note.name) +
              "\" NumberOfTuples=\"1\" format=\"ascii\">";
    for (const char c : note.text) {
      result += std::to_string(static_cast<int>(static_cast<unsigned char>(c))) + " ";
    }
    result += "0</DataArray>\n";
  }
  return result + "</FieldData>\n";
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

PointField vector_field(const std::string& name, const std::vector<Vec3>& vectors) {
  PointField field{.name = name, .value = {}, .components = 3};
  field.value.reserve(3 * vectors.size());
  for (const Vec3& v : vectors) field.value.insert(field.value.end(), v.data(), v.data() + 3);
  return field;
}

std::string format_vtp(const geometry::TriangleMesh& mesh, const std::vector<PointField>& fields,
                       const std::vector<MeshNote>& notes) {
  Appended appended;
  std::string point_data;
  for (const PointField& field : fields) {
    if (field.value.size() != mesh.vertices.size() * static_cast<std::size_t>(field.components)) {
      throw Error("field \"" + field.name + "\": " + std::to_string(field.value.size()) +
                  " numbers; " + std::to_string(field.components) + " for each of " +
                  std::to_string(mesh.vertices.size()) + " vertices are required");
    }
    point_data += appended.array("Float64", field.name, field.components, raw_doubles(field.value));
  }
  const std::string points = appended.array("Float64", "position_mm", 3,
                                            raw_doubles(vector_field("", mesh.vertices).value));
  std::string connectivity;
  std::string offsets;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) append_value(connectivity, static_cast<std::int64_t>(v));
    append_value(offsets, static_cast<std::int64_t>(3 * (t + 1)));
  }
  const std::string polys = appended.array("Int64", "connectivity", 1, connectivity) +
                            appended.array("Int64", "offsets", 1, offsets);
  const std::string active =
      fields.empty() ? "" : " Scalars=\"" + xml_escaped(fields.front().name) + "\"";
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n"
         "<PolyData>\n" +
         field_data(notes) + "<Piece NumberOfPoints=\"" + std::to_string(mesh.vertices.size()) +
         "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(mesh.triangles.size()) + "\">\n<PointData" + active + ">\n" + point_data +
         "</PointData>\n<Points>\n" + points + "</Points>\n<Polys>\n" + polys +
         "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"base64\">\n_" +
         appended.data() + "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace palmar::formats
