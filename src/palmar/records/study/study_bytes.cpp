// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_bytes.h"

#include <zlib.h>

#include <cstdint>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"

namespace palmar::records {
namespace {

constexpr std::uint32_t kMostBytes = 1U << 30;

/// Takes values off the front; never reads past the end.
class Unpacker {
 public:
  Unpacker(std::string_view bytes, std::string what) : bytes_(bytes), what_(std::move(what)) {}

  template <typename T>
  T take() {
    if (bytes_.size() < sizeof(T)) fail();
    const T value = formats::read_value<T>(bytes_, 0);
    bytes_.remove_prefix(sizeof(T));
    return value;
  }
  /// A count of things of at least `size` bytes each that must still follow.
  std::size_t take_count(std::size_t size) {
    const auto count = static_cast<std::size_t>(take<std::uint32_t>());
    if (size > 0 && count > bytes_.size() / size) fail();
    return count;
  }
  std::uint32_t take_leb128() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const auto byte = take<std::uint8_t>();
      value |= static_cast<std::uint32_t>(byte & 0x7F) << shift;
      if ((byte & 0x80) == 0) return value;
    }
    fail();
  }
  std::string_view rest() const { return bytes_; }
  void end() const {
    if (!bytes_.empty()) fail();
  }
  [[noreturn]] void fail() const { throw InputError(what_ + " is damaged"); }

 private:
  std::string_view bytes_;
  std::string what_;
};

void append_leb128(std::string& bytes, std::uint32_t value) {
  while (value >= 0x80) {
    bytes += static_cast<char>(0x80 | (value & 0x7F));
    value >>= 7;
  }
  bytes += static_cast<char>(value);
}

void append_text(std::string& bytes, const std::string& text) {
  formats::append_value(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

}  // namespace

std::string pack(std::string_view bytes) {
  if (bytes.size() > kMostBytes) throw OutputError("more than 1 GiB can't be kept in one piece");
  std::string packed;
  formats::append_value(packed, static_cast<std::uint32_t>(bytes.size()));
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  const std::size_t head = packed.size();
  packed.resize(head + size);
  const int code = compress2(reinterpret_cast<Bytef*>(packed.data() + head), &size,
                             reinterpret_cast<const Bytef*>(bytes.data()),
                             static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (code != Z_OK) throw OutputError("zlib can't compress (code " + std::to_string(code) + ")");
  packed.resize(head + size);
  return packed;
}

std::string unpack(std::string_view packed) {
  Unpacker unpacker(packed, "packed data");
  const auto expected = unpacker.take<std::uint32_t>();
  if (expected > kMostBytes) unpacker.fail();
  std::string bytes(expected, '\0');
  uLongf size = expected;
  const std::string_view rest = unpacker.rest();
  const int code =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                 reinterpret_cast<const Bytef*>(rest.data()), static_cast<uLong>(rest.size()));
  if (code != Z_OK || size != expected) unpacker.fail();
  return bytes;
}

std::string mesh_bytes(const geometry::TriangleMesh& mesh) {
  std::string bytes;
  formats::append_value(bytes, static_cast<std::uint32_t>(mesh.vertices.size()));
  formats::append_value(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Vec3& v : mesh.vertices) {
    for (int c = 0; c < 3; ++c) formats::append_value(bytes, v[c]);
  }
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) formats::append_value(bytes, static_cast<std::int32_t>(v));
  }
  return bytes;
}

geometry::TriangleMesh mesh_from_bytes(std::string_view bytes) {
  Unpacker unpacker(bytes, "a mesh");
  const auto vertices = unpacker.take<std::uint32_t>();
  const auto triangles = unpacker.take<std::uint32_t>();
  const std::uint64_t needed = std::uint64_t{24} * vertices + std::uint64_t{12} * triangles;
  if (needed != unpacker.rest().size()) unpacker.fail();
  geometry::TriangleMesh mesh;
  mesh.vertices.resize(vertices);
  mesh.triangles.resize(triangles);
  for (Vec3& v : mesh.vertices) {
    for (int c = 0; c < 3; ++c) v[c] = unpacker.take<double>();
  }
  for (Triangle& t : mesh.triangles) {
    for (int& v : t) {
      v = unpacker.take<std::int32_t>();
      if (v < 0 || static_cast<std::uint32_t>(v) >= vertices) unpacker.fail();
    }
  }
  return mesh;
}

std::string field_bytes(const study::SparseField& field) {
  std::string bytes;
  formats::append_value(bytes, static_cast<std::uint32_t>(field.vertex.size()));
  std::uint32_t last = 0;
  for (const int vertex : field.vertex) {
    const auto v = static_cast<std::uint32_t>(vertex);
    append_leb128(bytes, v - last);
    last = v;
  }
  std::string plain;
  for (const float value : field.value) formats::append_value(plain, value);
  for (std::size_t b = 0; b < sizeof(float); ++b) {
    for (std::size_t i = b; i < plain.size(); i += sizeof(float)) bytes += plain[i];
  }
  return bytes;
}

study::SparseField field_from_bytes(std::string_view bytes) {
  Unpacker unpacker(bytes, "a field");
  const std::size_t count = unpacker.take_count(1 + sizeof(float));
  study::SparseField field;
  field.vertex.resize(count);
  field.value.resize(count);
  std::uint32_t last = 0;
  for (int& vertex : field.vertex) {
    last += unpacker.take_leb128();
    vertex = static_cast<int>(last);
  }
  const std::string_view rest = unpacker.rest();
  if (rest.size() != count * sizeof(float)) unpacker.fail();
  std::string plain(rest.size(), '\0');
  for (std::size_t b = 0; b < sizeof(float); ++b) {
    for (std::size_t i = 0; i < count; ++i) plain[i * sizeof(float) + b] = rest[b * count + i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    field.value[i] = formats::read_value<float>(plain, i * sizeof(float));
  }
  return field;
}

std::string posture_bytes(const hand::Posture& posture) {
  std::string bytes;
  for (const double angle : posture.angle) formats::append_value(bytes, angle);
  return bytes;
}

hand::Posture posture_from_bytes(std::string_view bytes) {
  Unpacker unpacker(bytes, "a posture");
  hand::Posture posture;
  for (double& angle : posture.angle) angle = unpacker.take<double>();
  unpacker.end();
  return posture;
}

std::string rigid_bytes(const geometry::Rigid3& rigid) {
  std::string bytes;
  const Quat& q = rigid.rotation;
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) formats::append_value(bytes, value);
  for (int c = 0; c < 3; ++c) formats::append_value(bytes, rigid.translation[c]);
  return bytes;
}

geometry::Rigid3 rigid_from_bytes(std::string_view bytes) {
  Unpacker unpacker(bytes, "a placement");
  geometry::Rigid3 rigid;
  rigid.rotation.w() = unpacker.take<double>();
  rigid.rotation.x() = unpacker.take<double>();
  rigid.rotation.y() = unpacker.take<double>();
  rigid.rotation.z() = unpacker.take<double>();
  for (int c = 0; c < 3; ++c) rigid.translation[c] = unpacker.take<double>();
  unpacker.end();
  return rigid;
}

std::string record_bytes(const study::StudyRecord& record) {
  std::string bytes;
  formats::append_value(bytes, record.number);
  append_text(bytes, name_of(record.outcome));
  append_text(bytes, record.reason);
  append_text(bytes, std::string(name_of(record.grip)));
  bytes += record.is_balanced ? '\1' : '\0';
  for (const double value :
       {record.force, record.grip_force, record.area, record.peak_pressure,
        record.peak_pressure_cells, record.mean_pressure, record.demand.range_share,
        record.demand.grip_strength, record.demand.nail_room}) {
    formats::append_value(bytes, value);
  }
  bytes += posture_bytes(record.posture) + rigid_bytes(record.product_from_hand);
  for (const study::RegionRecord& region : record.regions) {
    append_text(bytes, std::string(name_of(region.region)));
    for (const double value : {region.force, region.area, region.peak_pressure,
                               region.peak_pressure_cells, region.mean_pressure}) {
      formats::append_value(bytes, value);
    }
  }
  for (const study::IndexRecord& index : record.indices) {
    append_text(bytes, index.key);
    formats::append_value(bytes, index.value);
  }
  return bytes;
}

std::string hold_bytes(const study::StudyHold& held) {
  const grasp::Hold& hold = held.hold;
  std::string bytes;
  formats::append_value(bytes, static_cast<std::int64_t>(hold.part));
  append_text(bytes, hold.part_name);
  append_text(bytes, std::string(name_of(hold.grip)));
  for (const double value : {hold.along, hold.edge, static_cast<double>(hold.toward), hold.turn}) {
    formats::append_value(bytes, value);
  }
  bytes += hold.is_over_end ? '\1' : '\0';
  append_text(bytes, held.words);
  return bytes;
}

}  // namespace palmar::records
