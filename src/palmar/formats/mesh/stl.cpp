// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/stl.h"

#include <cctype>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/mesh/mesh_build.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

bool equals_ignoring_case(std::string_view word, std::string_view lower) {
  return word.size() == lower.size() &&
         std::equal(word.begin(), word.end(), lower.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

std::uint64_t binary_length(std::string_view bytes) {
  return kHeaderBytes + kFacetBytes * std::uint64_t{read_value<std::uint32_t>(bytes, 80)};
}

bool has_binary_length(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes && binary_length(bytes) == bytes.size();
}

MeshFile parse_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderBytes) {
    throw InputError(name + ": is truncated: a binary STL has at least 84 bytes, got " +
                     std::to_string(bytes.size()));
  }
  const auto count = read_value<std::uint32_t>(bytes, 80);
  const std::uint64_t expected = binary_length(bytes);
  if (bytes.size() < expected) {
    throw InputError(name + ": is truncated (or no STL): " + std::to_string(expected) +
                     " bytes expected for " + std::to_string(count) + " triangles, got " +
                     std::to_string(bytes.size()));
  }
  check_triangle_count(name, count);

  MeshFile file;
  file.format = "binary STL";
  if (bytes.size() > expected) {
    file.notes.push_back(std::to_string(bytes.size() - expected) +
                         " bytes behind the last triangle ignored");
  }
  file.mesh.triangles.reserve(count);
  ExactWelder welder(count / 2);
  for (std::uint32_t f = 0; f < count; ++f) {
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = kHeaderBytes + kFacetBytes * f + 12 + 12 * k;
      const Vec3 p(read_value<float>(bytes, at), read_value<float>(bytes, at + 4),
                   read_value<float>(bytes, at + 8));
      if (!(p.cwiseAbs().maxCoeff() <= 1e12) || !p.allFinite()) {
        check_position(
            p, name + ": facet " + std::to_string(f + 1) + ", corner " + std::to_string(k + 1));
      }
      triangle[k] = welder.add(p, file.mesh.vertices);
    }
    file.mesh.triangles.push_back(triangle);
  }
  finish_mesh(file, name);
  return file;
}

/// ASCII STL: words, since white space and line breaks are free.
class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::string& name)
      : scan_(text), name_(name), welder_(text.size() / 500) {}

  MeshFile read() {
    file_.format = "ASCII STL";
    auto word = scan_.next_word();
    if (!word || !equals_ignoring_case(*word, "solid")) {
      throw InputError(name_ + ": is no STL: starts with " + in_quotes(word.value_or("")) +
                       "; \"solid\" or a binary header is required");
    }
    scan_.next_line();  // the name of the solid
    bool is_open = true;
    while ((word = scan_.next_word())) {
      if (equals_ignoring_case(*word, "facet")) {
        read_facet();
      } else if (equals_ignoring_case(*word, "endsolid") || equals_ignoring_case(*word, "solid")) {
        is_open = equals_ignoring_case(*word, "solid");
        scan_.next_line();
      } else {
        fail(*word, "\"facet\" or \"endsolid\"");
      }
    }
    if (is_open) file_.notes.push_back("the closing \"endsolid\" is missing");
    finish_mesh(file_, name_);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(std::optional<std::string_view> word, const std::string& expected) const {
    if (!word) {
      throw InputError(name_ + ": is truncated: ends in facet " + facet_number() + " (line " +
                       std::to_string(scan_.line()) + ") where " + expected + " is expected");
    }
    throw InputError(name_ + ":" + std::to_string(scan_.line()) + ": " + in_quotes(*word) +
                     " where " + expected + " is expected");
  }

  std::string facet_number() const { return std::to_string(file_.mesh.triangles.size() + 1); }

  void expect(std::string_view lower) {
    const auto word = scan_.next_word();
    if (!word || !equals_ignoring_case(*word, lower)) fail(word, in_quotes(lower));
  }

  double number(std::string_view what) {
    const auto word = scan_.next_word();
    const auto value = word ? parse_double(*word) : std::nullopt;
    if (!value) fail(word, "a number (" + std::string(what) + ")");
    return *value;
  }

  void read_facet() {
    expect("normal");
    // Stored normals are often wrong or nan; they are skipped unread.
    for (int c = 0; c < 3; ++c) {
      if (!scan_.next_word()) fail(std::nullopt, "a number (normal)");
    }
    expect("outer");
    expect("loop");
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      expect("vertex");
      const double x = number("x");
      const double y = number("y");
      const double z = number("z");
      const Vec3 p(x, y, z);
      if (!(p.cwiseAbs().maxCoeff() <= 1e12) || !p.allFinite()) {
        check_position(p, name_ + ":" + std::to_string(scan_.line()) + ": facet " + facet_number());
      }
      triangle[k] = welder_.add(p, file_.mesh.vertices);
    }
    expect("endloop");
    expect("endfacet");
    file_.mesh.triangles.push_back(triangle);
  }

  TextScanner scan_;
  const std::string& name_;
  ExactWelder welder_;
  MeshFile file_;
};

}  // namespace

bool is_stl(std::string_view bytes) {
  if (has_binary_length(bytes)) return true;
  if (!looks_like_text(bytes)) return false;
  TextScanner scan(bytes);
  const auto first = scan.next_word();
  if (!first || !equals_ignoring_case(*first, "solid")) return false;
  scan.next_line();
  const auto second = scan.next_word();
  return second &&
         (equals_ignoring_case(*second, "facet") || equals_ignoring_case(*second, "endsolid"));
}

MeshFile parse_stl(std::string_view bytes, const std::string& name) {
  if (!has_binary_length(bytes) && looks_like_text(bytes)) {
    return AsciiReader(bytes, name).read();
  }
  return parse_binary(bytes, name);
}

std::string format_stl(const geometry::TriangleMesh& mesh) {
  std::string bytes;
  bytes.reserve(kHeaderBytes + kFacetBytes * mesh.triangles.size());
  // Must not start with "solid": many readers would take it for text.
  bytes = "Palmar, binary STL, millimetre";
  bytes.resize(80, ' ');
  append_value(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const Vec3* v : {&normal, &a, &b, &c}) {
      for (int k = 0; k < 3; ++k) append_value(bytes, static_cast<float>((*v)[k]));
    }
    append_value(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace palmar::formats
