// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <string>
#include <utility>
#include <vector>

#include "palmar/formats/bytes.h"
#include "palmar/formats/test_files.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/types.h"

namespace palmar::formats {

/// A ZIP archive with these members, for tests.
inline std::string zip_bytes(const std::vector<std::pair<std::string, std::string>>& members,
                             bool deflated) {
  std::string bytes;
  std::string directory;
  for (const auto& [name, content] : members) {
    std::string packed = content;
    if (deflated) {
      z_stream stream{};
      deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
      packed.resize(deflateBound(&stream, static_cast<uLong>(content.size())));
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
      stream.avail_in = static_cast<uInt>(content.size());
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, Z_FINISH);
      packed.resize(stream.total_out);
      deflateEnd(&stream);
    }
    std::string common;  // the fields that local header and directory share
    append_value(common, std::uint16_t{20});
    append_value(common, std::uint16_t{0});
    append_value(common, static_cast<std::uint16_t>(deflated ? 8 : 0));
    append_value(common, std::uint32_t{0});  // time and date
    append_value(common,
                 static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()),
                                                  static_cast<uInt>(content.size()))));
    append_value(common, static_cast<std::uint32_t>(packed.size()));
    append_value(common, static_cast<std::uint32_t>(content.size()));
    append_value(common, static_cast<std::uint16_t>(name.size()));
    append_value(common, std::uint16_t{0});  // extra
    directory += "PK\x01\x02";
    append_value(directory, std::uint16_t{20});
    directory += common;
    append_value(directory, std::uint16_t{0});  // comment
    append_value(directory, std::uint32_t{0});  // disk, internal attributes
    append_value(directory, std::uint32_t{0});
    append_value(directory, static_cast<std::uint32_t>(bytes.size()));
    directory += name;
    bytes += "PK\x03\x04" + common + name + packed;
  }
  const auto start = static_cast<std::uint32_t>(bytes.size());
  bytes += directory + "PK\x05\x06";
  append_value(bytes, std::uint32_t{0});
  append_value(bytes, static_cast<std::uint16_t>(members.size()));
  append_value(bytes, static_cast<std::uint16_t>(members.size()));
  append_value(bytes, static_cast<std::uint32_t>(directory.size()));
  append_value(bytes, start);
  append_value(bytes, std::uint16_t{0});
  return bytes;
}

/// The <mesh> element of a 3MF model.
inline std::string mesh_xml(const geometry::TriangleMesh& mesh) {
  std::string xml = "<mesh><vertices>";
  for (const Vec3& v : mesh.vertices) {
    xml += "<vertex x=\"" + shortest(v.x()) + "\" y=\"" + shortest(v.y()) + "\" z=\"" +
           shortest(v.z()) + "\" />";
  }
  xml += "</vertices><triangles>";
  for (const Triangle& t : mesh.triangles) {
    xml += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) +
           "\" v3=\"" + std::to_string(t[2]) + "\"/>";
  }
  return xml + "</triangles></mesh>";
}

/// A whole model part of a 3MF package.
inline std::string model_xml(const std::string& resources, const std::string& build,
                             const std::string& unit) {
  return "<?xml version=\"1.0\"?>\n<model " + unit +
         " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><!-- c "
         "--><resources>" +
         resources + "</resources><build>" + build + "</build></model>";
}

/// A 3MF archive with one box of `size` in the unit of the attribute, e.g. `unit="inch"`.
inline std::string box_three_mf(const Vec3& size, const std::string& unit) {
  return zip_bytes(
      {{"3D/3dmodel.model", model_xml("<object id=\"1\">" + mesh_xml(box_mesh(size)) + "</object>",
                                      "<item objectid=\"1\"/>", unit)}},
      true);
}

}  // namespace palmar::formats
