// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/gltf.h"
#include "palmar/formats/mesh/obj.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/mesh/stl.h"
#include "palmar/formats/mesh/three_mf.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

constexpr std::string_view kSupported = "STL, OBJ, PLY, 3MF, glTF and GLB are read";

enum class Kind { kStl, kObj, kPly, kThreeMf, kGltf, kGlb };

std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, 6> kNames = {"STL", "OBJ", "PLY", "3MF", "glTF", "GLB"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::optional<Kind> kind_of_extension(const std::string& extension) {
  if (extension == ".stl") return Kind::kStl;
  if (extension == ".obj") return Kind::kObj;
  if (extension == ".ply") return Kind::kPly;
  if (extension == ".3mf") return Kind::kThreeMf;
  if (extension == ".gltf") return Kind::kGltf;
  if (extension == ".glb") return Kind::kGlb;
  return std::nullopt;
}

std::optional<Kind> kind_of_content(std::string_view bytes) {
  if (bytes.starts_with("glTF")) return Kind::kGlb;
  if (is_ply(bytes)) return Kind::kPly;
  if (bytes.starts_with("PK\x03\x04")) return Kind::kThreeMf;
  if (looks_like_text(bytes)) {
    const std::size_t start = bytes.find_first_not_of(" \t\r\n");
    if (start != bytes.npos && bytes[start] == '{') return Kind::kGltf;
  }
  if (is_stl(bytes)) return Kind::kStl;
  if (is_obj(bytes)) return Kind::kObj;
  return std::nullopt;
}

/// What a file is that Palmar knows but doesn't read; "" if unknown.
std::string foreign_format(std::string_view bytes, const std::string& extension) {
  const std::string_view start = bytes.substr(0, 256);
  if (start.find("ISO-10303-21") != start.npos || extension == ".step" || extension == ".stp") {
    return "STEP";
  }
  const bool has_iges_start = bytes.size() > 80 && bytes[72] == 'S' && looks_like_text(bytes) &&
                              bytes.substr(73, 7).find_first_not_of(" 01") == bytes.npos;
  if (extension == ".iges" || extension == ".igs" || has_iges_start) return "IGES";
  if (start.starts_with("Kaydara FBX") || extension == ".fbx") return "FBX";
  if (start.starts_with("OFF") || extension == ".off") return "OFF";
  if (extension == ".sldprt" || extension == ".sldasm") return "SolidWorks";
  return {};
}

MeshFile parse(Kind kind, std::string_view bytes, const std::filesystem::path& path) {
  const std::string name = path.string();
  switch (kind) {
    case Kind::kStl:
      return parse_stl(bytes, name);
    case Kind::kObj:
      return parse_obj(bytes, name);
    case Kind::kPly:
      return parse_ply(bytes, name);
    case Kind::kThreeMf:
      return parse_three_mf(bytes, name);
    case Kind::kGltf:
    case Kind::kGlb:
      return parse_gltf(bytes, path);
  }
  throw InputError(name + ": unknown kind of mesh file");
}

}  // namespace

MeshFile read_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const std::string extension = lower_case(path.extension().string());
  const auto content = kind_of_content(bytes);
  const auto named = kind_of_extension(extension);

  if (!content) {
    const std::string foreign = foreign_format(bytes, extension);
    if (foreign == "STEP" || foreign == "IGES") {
      throw InputError(path.string() + ": " + foreign +
                       " holds surfaces, not a mesh; `palmar product convert` makes one of it");
    }
    if (!foreign.empty()) {
      throw InputError(path.string() + ": " + foreign + " is not supported; " +
                       std::string(kSupported));
    }
    if (!named) {
      throw InputError(path.string() + ": is no mesh that Palmar knows; " +
                       std::string(kSupported));
    }
  }
  const Kind kind = content ? *content : *named;
  MeshFile file = parse(kind, bytes, path);
  const bool is_contradiction =
      named && *named != kind && !(*named == Kind::kGltf && kind == Kind::kGlb);
  if (is_contradiction) {
    file.notes.push_back("is named " + extension + " but holds " + std::string(name_of(kind)));
  }
  return file;
}

void write_mesh(const std::filesystem::path& path, const geometry::TriangleMesh& mesh) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".stl") {
    write_file(path, format_stl(mesh));
  } else if (extension == ".obj") {
    write_file(path, format_obj(mesh));
  } else if (extension == ".ply") {
    write_file(path, format_ply(mesh));
  } else {
    throw UsageError(path.string() + ": can't write a mesh as \"" + extension +
                     "\"; .stl, .obj or .ply is required");
  }
}

}  // namespace palmar::formats
