// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/face_mesh_file.h"

#include <zlib.h>

#include <cmath>
#include <cstdint>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/file.h"

namespace palmar::records {
namespace {

constexpr std::string_view kFacesMagic = "PalmarPF";
constexpr std::string_view kMeshMagic = "PalmarFM";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kLongestText = 4096;
constexpr double kLargestCoordinate = 1e12;  // mm; as for every mesh file

/// Takes values off the front; never reads past the end.
class Taker {
 public:
  Taker(std::string_view bytes, const std::string& what) : bytes_(bytes), what_(what) {}

  template <typename T>
  T take() {
    if (bytes_.size() < sizeof(T)) fail("it ends too early");
    const T value = formats::read_value<T>(bytes_, 0);
    bytes_.remove_prefix(sizeof(T));
    return value;
  }
  /// A count of things of at least `size` bytes each that must still follow.
  std::size_t take_count(std::size_t size) {
    const std::size_t count = take<std::uint32_t>();
    if (count > bytes_.size() / size) fail("it ends too early");
    return count;
  }
  double take_number() {
    const auto value = take<double>();
    if (!(std::abs(value) <= kLargestCoordinate)) fail("a number is not finite or too large");
    return value;
  }
  Vec3 take_point() {
    const double x = take_number(), y = take_number(), z = take_number();
    return {x, y, z};
  }
  bool take_bool() {
    const auto value = take<std::uint8_t>();
    if (value > 1) fail("a yes or no is neither");
    return value == 1;
  }
  /// An index into `count` things, or -1.
  int take_index(std::size_t count) {
    const auto value = take<std::int32_t>();
    if (value < -1 || value >= static_cast<std::int64_t>(count)) fail("an index is out of range");
    return value;
  }
  std::string take_text() {
    const std::size_t size = take_count(1);
    if (size > kLongestText) fail("a text is too long");
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
    }
    return text;
  }
  std::string_view take_bytes(std::size_t size) {
    if (size > bytes_.size()) fail("it ends too early");
    const std::string_view part = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return part;
  }
  void end() const {
    if (!bytes_.empty()) fail("something follows behind its end");
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(what_ + " is damaged: " + why);
  }

 private:
  std::string_view bytes_;
  std::string what_;
};

void append_short_text(std::string& bytes, const std::string& text) {
  const std::string_view kept = std::string_view(text).substr(0, kLongestText);
  formats::append_value(bytes, static_cast<std::uint32_t>(kept.size()));
  bytes += kept;
}

void append_point(std::string& bytes, const Vec3& point) {
  for (int c = 0; c < 3; ++c) formats::append_value(bytes, point[c]);
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void append_checksum(std::string& bytes) { formats::append_value(bytes, checksum(bytes)); }

/// The content between magic, version and checksum.
Taker open_checked(std::string_view bytes, std::string_view magic, const std::string& what) {
  Taker taker(bytes, what);
  if (!bytes.starts_with(magic)) taker.fail("it doesn't begin as it must");
  if (bytes.size() < magic.size() + 8) taker.fail("it ends too early");
  const std::string_view body = bytes.substr(0, bytes.size() - 4);
  if (formats::read_value<std::uint32_t>(bytes, body.size()) != checksum(body)) {
    taker.fail("its checksum is wrong");
  }
  Taker content(body.substr(magic.size()), what);
  if (const auto version = content.take<std::uint32_t>(); version != kVersion) {
    content.fail("its version is " + std::to_string(version) + "; " + std::to_string(kVersion) +
                 " is read");
  }
  return content;
}

void append_face(std::string& bytes, const product::ProductFace& face) {
  formats::append_value(bytes, static_cast<std::int32_t>(face.number));
  append_short_text(bytes, face.name);
  append_short_text(bytes, face.part);
  formats::append_value(bytes, static_cast<std::uint8_t>(face.kind));
  formats::append_value(bytes, face.radius);
  formats::append_value(bytes, static_cast<std::uint8_t>(face.is_concave));
  formats::append_value(bytes, static_cast<std::uint8_t>(face.is_fillet));
  formats::append_value(bytes, face.area);
  formats::append_value(bytes, static_cast<std::uint8_t>(face.colour.has_value()));
  if (!face.colour) return;
  for (const float share : *face.colour) formats::append_value(bytes, share);
}

product::ProductFace take_face(Taker& taker) {
  product::ProductFace face;
  face.number = taker.take<std::int32_t>();
  face.name = taker.take_text();
  face.part = taker.take_text();
  const auto kind = taker.take<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(product::FaceKind::kFreeform))
    taker.fail("a face's kind is unknown");
  face.kind = static_cast<product::FaceKind>(kind);
  face.radius = taker.take_number();
  face.is_concave = taker.take_bool();
  face.is_fillet = taker.take_bool();
  face.area = taker.take_number();
  if (taker.take_bool()) {
    std::array<float, 3> colour{};
    for (float& share : colour) {
      share = taker.take<float>();
      if (!(share >= 0.0F && share <= 1.0F)) taker.fail("a colour is outside 0 to 1");
    }
    face.colour = colour;
  }
  return face;
}

void append_edge(std::string& bytes, const product::ProductEdge& edge) {
  formats::append_value(bytes, static_cast<std::int32_t>(edge.number));
  for (const int face : edge.faces) formats::append_value(bytes, static_cast<std::int32_t>(face));
  formats::append_value(bytes, static_cast<std::uint8_t>(edge.is_convex));
  formats::append_value(bytes, static_cast<std::uint8_t>(edge.is_smooth));
  formats::append_value(bytes, edge.angle);
  formats::append_value(bytes, edge.length);
  formats::append_value(bytes, static_cast<std::uint32_t>(edge.points.size()));
  for (const Vec3& point : edge.points) append_point(bytes, point);
}

product::ProductEdge take_edge(Taker& taker, std::size_t faces) {
  product::ProductEdge edge;
  edge.number = taker.take<std::int32_t>();
  for (int& face : edge.faces) face = taker.take_index(faces);
  edge.is_convex = taker.take_bool();
  edge.is_smooth = taker.take_bool();
  edge.angle = taker.take_number();
  edge.length = taker.take_number();
  edge.points.resize(taker.take_count(3 * sizeof(double)));
  for (Vec3& point : edge.points) point = taker.take_point();
  return edge;
}

}  // namespace

std::string faces_bytes(const product::ProductFaces& faces) {
  std::string bytes(kFacesMagic);
  formats::append_value(bytes, kVersion);
  formats::append_value(bytes, static_cast<std::uint32_t>(faces.face.size()));
  for (const product::ProductFace& face : faces.face) append_face(bytes, face);
  formats::append_value(bytes, static_cast<std::uint32_t>(faces.edge.size()));
  for (const product::ProductEdge& edge : faces.edge) append_edge(bytes, edge);
  formats::append_value(bytes, static_cast<std::uint32_t>(faces.face_of_triangle.size()));
  for (const int face : faces.face_of_triangle) {
    formats::append_value(bytes, static_cast<std::int32_t>(face));
  }
  append_checksum(bytes);
  return bytes;
}

product::ProductFaces faces_from_bytes(std::string_view bytes, int triangles,
                                       const std::string& what) {
  Taker taker = open_checked(bytes, kFacesMagic, what);
  product::ProductFaces faces;
  constexpr std::size_t kLeastFace = 32, kLeastEdge = 34;  // bytes
  faces.face.resize(taker.take_count(kLeastFace));
  for (product::ProductFace& face : faces.face) face = take_face(taker);
  faces.edge.resize(taker.take_count(kLeastEdge));
  for (product::ProductEdge& edge : faces.edge) edge = take_edge(taker, faces.face.size());
  faces.face_of_triangle.resize(taker.take_count(sizeof(std::int32_t)));
  const std::size_t expected = faces.face.empty() ? 0 : static_cast<std::size_t>(triangles);
  if (faces.face_of_triangle.size() != expected) {
    taker.fail(std::to_string(faces.face_of_triangle.size()) +
               " triangles have a face; there are " + std::to_string(triangles));
  }
  for (int& face : faces.face_of_triangle) {
    face = taker.take_index(faces.face.size());
    if (face < 0) taker.fail("a triangle has no face");
  }
  taker.end();
  return faces;
}

std::string face_mesh_bytes(const FaceMesh& mesh) {
  std::string bytes(kMeshMagic);
  formats::append_value(bytes, kVersion);
  formats::append_value(bytes, static_cast<std::uint32_t>(mesh.mesh.vertices.size()));
  for (const Vec3& vertex : mesh.mesh.vertices) append_point(bytes, vertex);
  formats::append_value(bytes, static_cast<std::uint32_t>(mesh.mesh.triangles.size()));
  for (const Triangle& triangle : mesh.mesh.triangles) {
    for (const int v : triangle) formats::append_value(bytes, static_cast<std::int32_t>(v));
  }
  const std::string faces = faces_bytes(mesh.faces);
  formats::append_value(bytes, static_cast<std::uint64_t>(faces.size()));
  bytes += faces;
  append_checksum(bytes);
  return bytes;
}

FaceMesh face_mesh_from_bytes(std::string_view bytes, const std::string& what) {
  Taker taker = open_checked(bytes, kMeshMagic, what);
  FaceMesh mesh;
  mesh.mesh.vertices.resize(taker.take_count(3 * sizeof(double)));
  for (Vec3& vertex : mesh.mesh.vertices) vertex = taker.take_point();
  mesh.mesh.triangles.resize(taker.take_count(3 * sizeof(std::int32_t)));
  for (Triangle& triangle : mesh.mesh.triangles) {
    for (int& v : triangle) {
      v = taker.take_index(mesh.mesh.vertices.size());
      if (v < 0) taker.fail("a triangle has no corner");
    }
  }
  const auto size = taker.take<std::uint64_t>();
  mesh.faces = faces_from_bytes(taker.take_bytes(static_cast<std::size_t>(size)),
                                mesh.mesh.triangle_count(), what);
  taker.end();
  return mesh;
}

void write_face_mesh(const std::filesystem::path& path, const FaceMesh& mesh) {
  formats::write_file(path, face_mesh_bytes(mesh));
}

FaceMesh read_face_mesh(const std::filesystem::path& path) {
  return face_mesh_from_bytes(formats::read_file(path), path.string());
}

}  // namespace palmar::records
