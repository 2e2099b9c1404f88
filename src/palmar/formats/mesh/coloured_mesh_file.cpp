// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/coloured_mesh_file.h"

#include <algorithm>
#include <map>
#include <string>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/gltf.h"
#include "palmar/formats/mesh/obj.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

namespace fs = std::filesystem;

/// A neighbour of `path`; a mesh has no business elsewhere on the disk.
fs::path neighbour(const fs::path& path, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path file(name);
  if (file.is_absolute() ||
      std::any_of(file.begin(), file.end(), [](const fs::path& part) { return part == ".."; })) {
    throw InputError(path.string() + ": names " + in_quotes(name) +
                     ", which is outside its folder");
  }
  return path.parent_path() / file;
}

/// Image of the diffuse colour (map_Kd) of every material of an MTL file.
void read_materials(const fs::path& path, std::map<std::string, std::string>& image_of) {
  const std::string bytes = read_file(path);
  TextScanner scan(bytes);
  std::string material;
  while (const auto line = scan.next_line()) {
    const auto first = line->find_first_not_of(" \t");
    if (first == line->npos) continue;
    const std::string_view statement = line->substr(first);
    const auto blank = statement.find_first_of(" \t");
    if (blank == statement.npos) continue;
    const std::string_view keyword = statement.substr(0, blank);
    const auto begin = statement.find_first_not_of(" \t", blank);
    if (begin == statement.npos) continue;
    const std::string_view rest =
        statement.substr(begin, statement.find_last_not_of(" \t\r") - begin + 1);
    if (keyword == "newmtl") material = std::string(rest);
    if (keyword != "map_Kd") continue;
    // Options (-s 1 1 1 ...) stand before the name.
    const bool has_options = rest.starts_with('-');
    const auto name = has_options ? rest.find_last_of(" \t") + 1 : 0;
    image_of[material] = std::string(rest.substr(name));
  }
}

void read_obj_textures(const fs::path& path, const ObjColours& obj,
                       geometry::SurfaceColours& colours, std::vector<std::string>& notes) {
  std::map<std::string, std::string> image_of;
  for (const std::string& library : obj.library) {
    const fs::path file = neighbour(path, library);
    if (!fs::exists(file)) {
      throw InputError(path.string() + ": its material file " + in_quotes(file.string()) +
                       " is missing; keep .obj, .mtl and images together");
    }
    read_materials(file, image_of);
  }
  std::map<std::string, int> read;  // images, by name
  std::vector<int> texture_of;      // per material
  for (const std::string& material : obj.material) {
    const auto image = image_of.find(material);
    if (image == image_of.end()) {
      texture_of.push_back(-1);
      continue;
    }
    const auto [known, is_new] =
        read.try_emplace(image->second, static_cast<int>(colours.textures.size()));
    if (is_new) {
      const fs::path file = neighbour(path, image->second);
      if (!fs::exists(file)) {
        throw InputError(path.string() + ": its texture " + in_quotes(file.string()) +
                         " is missing; keep .obj, .mtl and images together");
      }
      colours.textures.push_back(read_texture(read_file(file), file.string()));
    }
    texture_of.push_back(known->second);
  }
  std::size_t bare = 0;
  for (int& t : colours.texture) {
    t = t < 0 ? -1 : texture_of[static_cast<std::size_t>(t)];
    bare += t < 0 ? 1 : 0;
  }
  if (colours.textures.empty()) {
    colours.place.clear();
    colours.texture.clear();
  } else if (bare > 0) {
    notes.push_back(std::to_string(bare) + " triangles without texture");
  }
}

}  // namespace

ColouredMeshFile read_coloured_mesh(const fs::path& path) {
  const std::string bytes = read_file(path);
  const std::string name = path.string();
  ColouredMeshFile file;
  const auto first = bytes.find_first_not_of(" \t\r\n");
  if (is_ply(bytes)) {
    file.shape = parse_ply(bytes, name, file.colours);
  } else if (bytes.starts_with("glTF") ||
             (looks_like_text(bytes) && first != bytes.npos && bytes[first] == '{')) {
    file.shape = parse_gltf(bytes, path, file.colours);
  } else if (is_obj(bytes)) {
    ObjColours obj;
    file.shape = parse_obj(bytes, name, obj);
    file.colours = std::move(obj.surface);
    read_obj_textures(path, obj, file.colours, file.shape.notes);
  } else {
    file.shape = read_mesh(path);
  }
  return file;
}

void write_coloured_mesh(const fs::path& path, const geometry::ColouredMesh& mesh) {
  if (path.extension() != ".ply") {
    throw UsageError(path.string() + ": colours are written as .ply only");
  }
  write_file(path, format_ply(mesh));
}

void write_textured_mesh(const fs::path& path, const geometry::TriangleMesh& mesh,
                         const geometry::SurfaceColours& colours) {
  if (path.extension() != ".obj" || colours.textures.size() != 1 ||
      colours.place.size() != mesh.triangles.size()) {
    throw UsageError(path.string() + ": one texture on all triangles is written, as .obj");
  }
  const std::string stem = path.stem().string();
  std::string text = "mtllib " + stem + ".mtl\n";
  for (const Vec3& v : mesh.vertices) {
    text += "v " + shortest(v.x()) + " " + shortest(v.y()) + " " + shortest(v.z()) + "\n";
  }
  for (const auto& corners : colours.place) {
    for (const Eigen::Vector2f& p : corners) {
      // From the lower left.
      text += "vt " + shortest(p.x()) + " " + shortest(1.0 - p.y()) + "\n";
    }
  }
  text += "usemtl skin\n";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += "f";
    for (std::size_t k = 0; k < 3; ++k) {
      text += " " + std::to_string(mesh.triangles[t][k] + 1) + "/" + std::to_string(3 * t + k + 1);
    }
    text += "\n";
  }
  write_file(fs::path(path).replace_extension(".png"), format_png(colours.textures.front()));
  write_file(fs::path(path).replace_extension(".mtl"),
             "newmtl skin\nKd 1 1 1\nmap_Kd " + stem + ".png\n");
  write_file(path, text);
}

}  // namespace palmar::formats
