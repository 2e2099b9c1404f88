// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"
#include "palmar/formats/mesh/glb.h"
#include "palmar/formats/mesh/mesh_build.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

using Json = nlohmann::json;
using Affine = Eigen::Affine3d;

std::optional<std::string> decode_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    int digit = 0;
    if (c >= 'A' && c <= 'Z') {
      digit = c - 'A';
    } else if (c >= 'a' && c <= 'z') {
      digit = c - 'a' + 26;
    } else if (c >= '0' && c <= '9') {
      digit = c - '0' + 52;
    } else if (c == '+' || c == '-') {
      digit = 62;
    } else if (c == '/' || c == '_') {
      digit = 63;
    } else if (c == '=') {
      break;
    } else {
      return std::nullopt;
    }
    group = (group << 6 | static_cast<std::uint32_t>(digit)) & 0xffffff;
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(group >> bits & 0xff);
    }
  }
  return bytes;
}

std::string decode_percent(std::string_view uri) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
      result += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

/// Element `index` of the top-level list `list`, or nothing.
const Json* element(const Json& json, const char* list, std::int64_t index) {
  const auto found = json.find(list);
  if (found == json.end() || !found->is_array() || index < 0 ||
      index >= static_cast<std::int64_t>(found->size())) {
    return nullptr;
  }
  return &(*found)[static_cast<std::size_t>(index)];
}

/// The file with all its buffers joined into one, as read_accessor() wants it.
class Loader {
 public:
  Loader(std::string_view bytes, const std::filesystem::path& path)
      : folder_(path.parent_path()), name_(path.string()) {
    if (bytes.starts_with("glTF")) {
      glb_ = parse_glb(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), name_);
    } else {
      glb_.json = Json::parse(bytes);
    }
    if (!glb_.json.is_object()) throw InputError(name_ + ": is no glTF: no JSON object");
    check_asset();
    join_buffers(bytes.starts_with("glTF"));
  }
  const Glb& glb() const { return glb_; }

  /// The bytes of image `index`, as they are coded.
  std::string image_bytes(std::int64_t index) const {
    const std::string what = name_ + ": image " + std::to_string(index);
    const Json* image = element(glb_.json, "images", index);
    if (image == nullptr || !image->is_object()) throw InputError(what + " does not exist");
    if (image->contains("uri")) return load(image->at("uri").get<std::string>(), what);
    const Json* view =
        element(glb_.json, "bufferViews", json_whole_or<std::int64_t>(*image, "bufferView", -1));
    if (view == nullptr) throw InputError(what + " has neither \"uri\" nor \"bufferView\"");
    // join_buffers() has looked whether it lies inside.
    const auto offset = json_whole_or<std::uint64_t>(*view, "byteOffset", 0);
    const auto size = json_whole_or<std::uint64_t>(*view, "byteLength", 0);
    if (offset > glb_.buffer.size() || size > glb_.buffer.size() - offset) {
      throw InputError(what + " is outside its buffer");
    }
    const auto* start = reinterpret_cast<const char*>(glb_.buffer.data()) + offset;
    return {start, size};
  }

 private:
  void check_asset() const {
    const auto asset = glb_.json.find("asset");
    if (asset == glb_.json.end() || !asset->is_object()) {
      throw InputError(name_ + ": is no glTF: the JSON has no \"asset\"");
    }
    const std::string version = asset->value("version", "");
    if (!version.starts_with("2.")) {
      throw InputError(name_ + ": is glTF version " + in_quotes(version) + "; 2.0 is read");
    }
    const auto required = glb_.json.find("extensionsRequired");
    if (required == glb_.json.end() || !required->is_array()) return;
    for (const Json& extension : *required) {
      const std::string text = extension.is_string() ? extension.get<std::string>() : "";
      if (text.find("compression") != text.npos || text.find("quantization") != text.npos) {
        throw InputError(name_ + ": needs " + in_quotes(text) +
                         ", which is not supported; export without compression");
      }
    }
  }

  std::string load(const std::string& uri, const std::string& what) const {
    if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');
      if (comma == uri.npos || uri.find(";base64") > comma) {
        throw InputError(what + ": its data URI is not base64");
      }
      auto bytes = decode_base64(std::string_view(uri).substr(comma + 1));
      if (!bytes) throw InputError(what + ": its data URI holds characters that are no base64");
      return std::move(*bytes);
    }
    const std::filesystem::path file = decode_percent(uri);
    // Only neighbours: a mesh has no business elsewhere on the disk or on the network.
    const bool leaves =
        file.is_absolute() || uri.find("://") != uri.npos ||
        std::any_of(file.begin(), file.end(), [](const auto& p) { return p == ".."; });
    if (leaves) {
      throw InputError(what + ": " + in_quotes(uri) + " is outside the file's own folder");
    }
    try {
      return read_file(folder_ / file);
    } catch (const InputError& error) {
      throw InputError(what + ": " + error.what());
    }
  }

  void join_buffers(bool is_binary) {
    std::vector<std::pair<std::size_t, std::size_t>> place;  // start and length of each buffer
    const auto buffers = glb_.json.find("buffers");
    if (buffers == glb_.json.end() || !buffers->is_array()) return;
    for (std::size_t i = 0; i < buffers->size(); ++i) {
      const Json& buffer = (*buffers)[i];
      if (!buffer.is_object())
        throw InputError(name_ + ": buffer " + std::to_string(i) + " is no object");
      if (i == 0 && is_binary && !buffer.contains("uri")) {
        place.emplace_back(0, glb_.buffer.size());
        continue;
      }
      const std::string bytes =
          load(buffer.at("uri").get<std::string>(), name_ + ": buffer " + std::to_string(i));
      place.emplace_back(glb_.buffer.size(), bytes.size());
      glb_.buffer.insert(glb_.buffer.end(), bytes.begin(), bytes.end());
    }
    const auto views = glb_.json.find("bufferViews");
    if (views == glb_.json.end() || !views->is_array()) return;
    for (std::size_t i = 0; i < views->size(); ++i) {
      Json& view = (*views)[i];
      if (!view.is_object())
        throw InputError(name_ + ": bufferView " + std::to_string(i) + " is no object");
      const auto buffer = json_whole_or<std::int64_t>(view, "buffer", 0);
      const std::string what = name_ + ": bufferView " + std::to_string(i);
      if (buffer < 0 || buffer >= static_cast<std::int64_t>(place.size())) {
        throw InputError(what + " names buffer " + std::to_string(buffer) + "; there are " +
                         std::to_string(place.size()));
      }
      const auto [start, length] = place[static_cast<std::size_t>(buffer)];
      const auto offset = json_whole_or<std::uint64_t>(view, "byteOffset", 0);
      const auto size = json_whole_or<std::uint64_t>(view, "byteLength", 0);
      if (offset > length || size > length - offset) {
        throw InputError(what + " reaches to byte " + std::to_string(offset) + " + " +
                         std::to_string(size) + "; its buffer has " + std::to_string(length));
      }
      view["buffer"] = 0;
      view["byteOffset"] = start + offset;
    }
  }

  std::filesystem::path folder_;
  std::string name_;
  Glb glb_;
};

class SceneReader {
 public:
  /// `colours`: null if only the shape is wanted.
  SceneReader(const Loader& loader, const std::string& name, geometry::SurfaceColours* colours)
      : loader_(loader), glb_(loader.glb()), name_(name), colours_(colours), welder_(1024) {}

  MeshFile read() {
    file_.unit = geometry::LengthUnit::kMetre;
    for (const std::int64_t root : root_nodes()) visit(root, Affine::Identity(), 0);
    note(skin_count_, "skinned meshes read in their rest pose");
    note(morph_count_, "morph targets skipped");
    note(line_count_, "primitives of points or lines skipped");
    if (colours_ != nullptr) finish_colours();
    finish_mesh(file_, name_, colours_);
    return std::move(file_);
  }

 private:
  /// Colours of a primitive's vertices and where in which texture they lie.
  struct PrimitiveColours {
    std::vector<Eigen::Vector2f> place;
    int texture = -1;
  };

  static float srgb_of_linear(double x) {
    const double c = std::clamp(x, 0.0, 1.0);
    return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055);
  }

  /// Numbers of an accessor; whole ones stand for fractions.
  AccessorData fractions(int index, const std::string& what) const {
    AccessorData data = read_accessor(glb_, index, what);
    const Json* accessor = element(glb_.json, "accessors", index);
    const int type = json_whole_or<int>(*accessor, "componentType", 5126);
    const double whole = type == 5121 ? 255.0 : type == 5123 ? 65535.0 : 1.0;
    for (double& x : data.value) x /= whole;
    return data;
  }

  /// Index in colours_->textures of the base colour texture of a primitive; -1 without.
  int texture_of(const Json& primitive, int& coordinates) {
    const Json* material =
        element(glb_.json, "materials", json_whole_or<std::int64_t>(primitive, "material", -1));
    if (material == nullptr || !material->contains("pbrMetallicRoughness")) return -1;
    const Json& base = material->at("pbrMetallicRoughness");
    if (!base.contains("baseColorTexture")) return -1;
    const Json& use = base.at("baseColorTexture");
    coordinates = json_whole_or<int>(use, "texCoord", 0);
    if (use.contains("extensions")) ++transformed_count_;
    const Json* texture =
        element(glb_.json, "textures", json_whole_or<std::int64_t>(use, "index", -1));
    if (texture == nullptr) throw InputError(name_ + ": a material names a missing texture");
    const auto source = json_whole_or<std::int64_t>(*texture, "source", -1);
    if (source < 0) {
      ++unread_count_;
      return -1;
    }
    const auto found = std::find(image_.begin(), image_.end(), source);
    if (found == image_.end()) {
      image_.push_back(source);
      colours_->textures.push_back(
          read_texture(loader_.image_bytes(source), name_ + ": image " + std::to_string(source)));
      return static_cast<int>(image_.size()) - 1;
    }
    return static_cast<int>(found - image_.begin());
  }

  PrimitiveColours read_colours(const Json& primitive, const std::vector<int>& vertex,
                                const std::string& what) {
    PrimitiveColours result;
    const Json& attributes = primitive.at("attributes");
    colour_sum_.resize(file_.mesh.vertices.size(), Eigen::Vector4f::Zero());
    if (attributes.contains("COLOR_0")) {
      const AccessorData colour = fractions(json_whole<int>(attributes.at("COLOR_0")), what);
      if (colour.components < 3 || static_cast<std::size_t>(colour.count) != vertex.size()) {
        throw InputError(what + ": COLOR_0 isn't one colour per vertex");
      }
      for (std::size_t i = 0; i < vertex.size(); ++i) {
        const double* c = colour.value.data() + i * static_cast<std::size_t>(colour.components);
        colour_sum_[static_cast<std::size_t>(vertex[i])] +=
            Eigen::Vector4f(srgb_of_linear(c[0]), srgb_of_linear(c[1]), srgb_of_linear(c[2]), 1.0F);
      }
    }
    int coordinates = 0;
    result.texture = texture_of(primitive, coordinates);
    const std::string name = "TEXCOORD_" + std::to_string(coordinates);
    if (result.texture < 0 || !attributes.contains(name)) {
      result.texture = -1;
      return result;
    }
    const AccessorData place = fractions(json_whole<int>(attributes.at(name)), what);
    if (place.components != 2 || static_cast<std::size_t>(place.count) != vertex.size()) {
      throw InputError(what + ": " + name + " isn't one place per vertex");
    }
    for (std::size_t i = 0; i < vertex.size(); ++i) {
      result.place.emplace_back(static_cast<float>(place.value[2 * i]),
                                static_cast<float>(place.value[2 * i + 1]));
    }
    return result;
  }

  void finish_colours() {
    note(transformed_count_, "texture transforms ignored");
    note(unread_count_, "textures in a format that isn't read (PNG and JPEG are)");
    colour_sum_.resize(file_.mesh.vertices.size(), Eigen::Vector4f::Zero());
    const auto has_colour = [](const Eigen::Vector4f& c) { return c.w() > 0.0F; };
    if (!std::all_of(colour_sum_.begin(), colour_sum_.end(), has_colour)) return;
    for (const Eigen::Vector4f& c : colour_sum_) colours_->vertex.push_back(c.head<3>() / c.w());
  }

  void note(int count, const std::string& what) {
    if (count > 0) file_.notes.push_back(std::to_string(count) + " " + what);
  }

  std::vector<std::int64_t> root_nodes() const {
    const auto nodes = glb_.json.find("nodes");
    const std::size_t count = nodes != glb_.json.end() && nodes->is_array() ? nodes->size() : 0;
    const Json* scene =
        element(glb_.json, "scenes", json_whole_or<std::int64_t>(glb_.json, "scene", 0));
    if (scene != nullptr) {
      return json_wholes<std::int64_t>(*scene, "nodes");
    }
    std::vector<bool> is_child(count, false);
    for (std::size_t n = 0; n < count; ++n) {
      for (const auto child : json_wholes<std::int64_t>((*nodes)[n], "children")) {
        if (child >= 0 && child < static_cast<std::int64_t>(count)) {
          is_child[static_cast<std::size_t>(child)] = true;
        }
      }
    }
    std::vector<std::int64_t> roots;
    for (std::size_t n = 0; n < count; ++n) {
      if (!is_child[n]) roots.push_back(static_cast<std::int64_t>(n));
    }
    return roots;
  }

  static Affine transform(const Json& node) {
    Affine result = Affine::Identity();
    if (node.contains("matrix")) {
      const auto m = node.at("matrix").get<std::array<double, 16>>();  // column by column
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 3; ++r) result.matrix()(r, c) = m[static_cast<std::size_t>(4 * c + r)];
      }
      return result;
    }
    const auto t = node.value("translation", std::array<double, 3>{0.0, 0.0, 0.0});
    const auto q = node.value("rotation", std::array<double, 4>{0.0, 0.0, 0.0, 1.0});
    const auto s = node.value("scale", std::array<double, 3>{1.0, 1.0, 1.0});
    result.translate(Vec3(t[0], t[1], t[2]));
    result.rotate(Quat(q[3], q[0], q[1], q[2]).normalized());
    result.scale(Vec3(s[0], s[1], s[2]));
    return result;
  }

  void visit(std::int64_t index, const Affine& parent, int depth) {
    const Json* node = element(glb_.json, "nodes", index);
    if (node == nullptr) {
      throw InputError(name_ + ": node " + std::to_string(index) + " does not exist");
    }
    // The nodes form trees; anything else would never end.
    if (visited_.empty()) visited_.resize(glb_.json.at("nodes").size(), false);
    if (visited_[static_cast<std::size_t>(index)] || depth > 200) {
      throw InputError(name_ + ": node " + std::to_string(index) +
                       " is reached twice or is deeper than 200 levels");
    }
    visited_[static_cast<std::size_t>(index)] = true;
    const Affine scene_from_node = parent * transform(*node);
    if (node->contains("mesh")) {
      const bool is_skinned = node->contains("skin");
      if (is_skinned) ++skin_count_;
      read_mesh(json_whole<std::int64_t>(node->at("mesh")), scene_from_node);
    }
    for (const auto child : json_wholes<std::int64_t>(*node, "children")) {
      visit(child, scene_from_node, depth + 1);
    }
  }

  void read_mesh(std::int64_t index, const Affine& scene_from_node) {
    const Json* mesh = element(glb_.json, "meshes", index);
    if (mesh == nullptr) {
      throw InputError(name_ + ": mesh " + std::to_string(index) + " does not exist");
    }
    for (const Json& primitive : mesh->at("primitives")) {
      const std::string what = name_ + ": mesh " + std::to_string(index);
      morph_count_ += primitive.contains("targets") ? 1 : 0;
      const int mode = json_whole_or<int>(primitive, "mode", 4);
      if (mode < 4 || mode > 6) {
        ++line_count_;
        continue;
      }
      read_primitive(primitive, mode, scene_from_node, what);
    }
  }

  void read_primitive(const Json& primitive, int mode, const Affine& scene_from_node,
                      const std::string& what) {
    const AccessorData positions =
        read_accessor(glb_, json_whole<int>(primitive.at("attributes").at("POSITION")), what);
    if (positions.components != 3) throw InputError(what + ": POSITION is no VEC3");
    // Many nodes may show one mesh; the work must stay bounded even if it holds no triangle.
    vertices_seen_ += static_cast<std::uint64_t>(positions.count);
    check_triangle_count(name_, vertices_seen_ / 3);
    std::vector<int> vertex;
    vertex.reserve(static_cast<std::size_t>(positions.count));
    for (int i = 0; i < positions.count; ++i) {
      const double* p = positions.value.data() + 3 * i;
      const Vec3 placed = scene_from_node * Vec3(p[0], p[1], p[2]);
      if (!placed.allFinite() || !(placed.cwiseAbs().maxCoeff() <= 1e12)) {
        check_position(placed, what + ", vertex " + std::to_string(i));
      }
      vertex.push_back(welder_.add(placed, file_.mesh.vertices));
    }
    PrimitiveColours colour;
    if (colours_ != nullptr) colour = read_colours(primitive, vertex, what);
    std::vector<int> corners;  // of this primitive
    if (primitive.contains("indices")) {
      const AccessorData indices =
          read_accessor(glb_, json_whole<int>(primitive.at("indices")), what);
      if (indices.components != 1) throw InputError(what + ": indices are no scalars");
      corners.reserve(indices.value.size());
      for (const double value : indices.value) {
        if (!(value >= 0.0 && value < positions.count)) {
          throw InputError(what + ": a triangle names vertex " + shortest(value) + "; there are " +
                           std::to_string(positions.count) + " (from 0)");
        }
        corners.push_back(static_cast<int>(value));
      }
    } else {
      corners.resize(vertex.size());
      std::iota(corners.begin(), corners.end(), 0);
    }
    check_triangle_count(name_, file_.mesh.triangles.size() +
                                    corners.size() / (mode == 4 ? std::size_t{3} : std::size_t{1}));
    const bool is_mirrored = scene_from_node.linear().determinant() < 0.0;
    const auto add = [&](int a, int b, int c) {
      if (is_mirrored) std::swap(b, c);
      const std::array<std::size_t, 3> own{static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                                           static_cast<std::size_t>(c)};
      file_.mesh.triangles.push_back({vertex[own[0]], vertex[own[1]], vertex[own[2]]});
      if (colours_ == nullptr) return;
      colours_->texture.push_back(colour.texture);
      if (colour.texture < 0) {
        colours_->place.emplace_back();
        colours_->place.back().fill(Eigen::Vector2f::Zero());
      } else {
        colours_->place.push_back(
            {colour.place[own[0]], colour.place[own[1]], colour.place[own[2]]});
      }
    };
    if (mode == 4) {
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        add(corners[i], corners[i + 1], corners[i + 2]);
      }
    } else {
      for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const std::size_t first = mode == 5 ? i : 0;
        const bool is_odd = mode == 5 && i % 2 == 1;
        add(corners[first], corners[is_odd ? i + 2 : i + 1], corners[is_odd ? i + 1 : i + 2]);
      }
    }
  }

  const Loader& loader_;
  const Glb& glb_;
  const std::string& name_;
  geometry::SurfaceColours* colours_;
  std::vector<std::int64_t> image_;          ///< behind each of colours_->textures
  std::vector<Eigen::Vector4f> colour_sum_;  ///< per vertex: colours met there, their number
  int transformed_count_ = 0;
  int unread_count_ = 0;
  ExactWelder welder_;
  std::vector<bool> visited_;
  std::uint64_t vertices_seen_ = 0;
  int skin_count_ = 0;
  int morph_count_ = 0;
  int line_count_ = 0;
  MeshFile file_;
};

MeshFile parse(std::string_view bytes, const std::filesystem::path& path,
               geometry::SurfaceColours* colours) {
  const std::string name = path.string();
  try {
    const Loader loader(bytes, path);
    MeshFile file = SceneReader(loader, name, colours).read();
    file.format = bytes.starts_with("glTF") ? "binary glTF" : "glTF";
    return file;
  } catch (const Json::exception& error) {
    throw InputError(name + ": is no valid glTF: " + json_reason(error));
  }
}

}  // namespace

MeshFile parse_gltf(std::string_view bytes, const std::filesystem::path& path) {
  return parse(bytes, path, nullptr);
}

MeshFile parse_gltf(std::string_view bytes, const std::filesystem::path& path,
                    geometry::SurfaceColours& colours) {
  return parse(bytes, path, &colours);
}

}  // namespace palmar::formats
