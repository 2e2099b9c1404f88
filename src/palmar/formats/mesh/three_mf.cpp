// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/three_mf.h"

#include <array>
#include <map>
#include <memory>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_build.h"
#include "palmar/formats/text_scan.h"
#include "palmar/formats/xml_scan.h"
#include "palmar/formats/zip.h"

namespace palmar::formats {
namespace {

using Affine = Eigen::Affine3d;

/// A build item or component: an object put somewhere.
struct Placed {
  std::string part;    ///< part of the package that holds the object; "" = this one
  std::string object;  ///< its id
  Affine parent_from_object = Affine::Identity();
  std::string place;  ///< where in the file, for messages
};

struct Object {
  geometry::TriangleMesh mesh;
  std::vector<Placed> components;
  bool is_support = false;
};

struct Unit {
  geometry::LengthUnit unit = geometry::LengthUnit::kMillimetre;
  double scale = 1.0;  ///< of the coordinates, to be in `unit`
};

/// One model part.
struct Model {
  Unit unit;
  std::map<std::string, Object> objects;
  std::vector<Placed> build;
};

double to_millimetres(const Unit& unit) {
  return geometry::millimetres_per(unit.unit) * unit.scale;
}

class ModelReader {
 public:
  ModelReader(std::string_view text, const std::string& name) : scan_(text, name) {}

  Model read() {
    bool has_model = false;
    while (const XmlTag* tag = scan_.next()) {
      if (tag->is_start) {
        has_model |= tag->name == "model";
        start(*tag);
      }
      if (tag->is_end && tag->name == "object") object_ = nullptr;
      if (tag->is_end && tag->name == "mesh") is_in_mesh_ = false;
      if (tag->is_end && tag->name == "build") is_in_build_ = false;
    }
    if (!has_model) fail("no <model>");
    for (const auto& [id, object] : model_.objects) check_indices(id, object);
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(scan_.place() + ": " + what);
  }

  std::string_view required(const XmlTag& tag, std::string_view attribute) const {
    const auto value = tag.attribute(attribute);
    if (!value) {
      fail("element " + in_quotes(tag.name) + " has no attribute " + in_quotes(attribute));
    }
    return *value;
  }

  double coordinate(const XmlTag& tag, std::string_view attribute) const {
    const std::string_view text = required(tag, attribute);
    const auto value = parse_double(text);
    if (!value) fail(std::string(attribute) + " is " + in_quotes(text) + "; a number is required");
    return *value;
  }

  int index(const XmlTag& tag, std::string_view attribute) const {
    const std::string_view text = required(tag, attribute);
    const auto value = parse_integer(text);
    if (!value || *value < 0 || *value > 2147483647) {
      fail(std::string(attribute) + " is " + in_quotes(text) +
           "; a vertex number from 0 is required");
    }
    return static_cast<int>(*value);
  }

  void start(const XmlTag& tag) {
    if (tag.name == "vertex" && is_in_mesh_) {
      const double x = coordinate(tag, "x");
      const double y = coordinate(tag, "y");
      const double z = coordinate(tag, "z");
      const Vec3 p(x, y, z);
      if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() <= 1e12)) {
        check_position(p,
                       scan_.place() + ": vertex " + std::to_string(object_->mesh.vertices.size()));
      }
      object_->mesh.vertices.push_back(p);
    } else if (tag.name == "triangle" && is_in_mesh_) {
      const int a = index(tag, "v1");
      const int b = index(tag, "v2");
      const int c = index(tag, "v3");
      object_->mesh.triangles.push_back({a, b, c});
    } else if (tag.name == "mesh" && object_ != nullptr) {
      is_in_mesh_ = !tag.is_end;
    } else if (tag.name == "object") {
      object_ = &model_.objects[std::string(required(tag, "id"))];
      object_->is_support = tag.attribute("type").value_or("") == "support";
    } else if (tag.name == "component" && object_ != nullptr) {
      object_->components.push_back(placed(tag));
    } else if (tag.name == "build") {
      is_in_build_ = !tag.is_end;
    } else if (tag.name == "item" && is_in_build_) {
      model_.build.push_back(placed(tag));
    } else if (tag.name == "model") {
      model_.unit = unit(tag.attribute("unit").value_or("millimeter"));
    }
  }

  Unit unit(std::string_view text) const {
    if (text == "millimeter") return {geometry::LengthUnit::kMillimetre, 1.0};
    if (text == "centimeter") return {geometry::LengthUnit::kCentimetre, 1.0};
    if (text == "meter") return {geometry::LengthUnit::kMetre, 1.0};
    if (text == "inch") return {geometry::LengthUnit::kInch, 1.0};
    if (text == "foot") return {geometry::LengthUnit::kInch, 12.0};
    if (text == "micron") return {geometry::LengthUnit::kMillimetre, 1e-3};
    fail("unit is " + in_quotes(text) +
         "; micron, millimeter, centimeter, inch, foot or meter is required");
  }

  Placed placed(const XmlTag& tag) const {
    Placed result;
    result.object = std::string(required(tag, "objectid"));
    result.part = std::string(tag.local_attribute("path").value_or(""));
    result.place = scan_.place();
    const auto text = tag.attribute("transform");
    if (!text) return result;
    TextScanner words(*text);
    // Row vectors: p' = p M, four rows of three numbers.
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 3; ++column) {
        const auto word = words.next_word();
        const auto value = word ? parse_double(*word) : std::nullopt;
        if (!value) fail("transform is " + in_quotes(*text) + "; 12 numbers are required");
        result.parent_from_object.matrix()(column, row) = *value;
      }
    }
    return result;
  }

  void check_indices(const std::string& id, const Object& object) const {
    for (std::size_t t = 0; t < object.mesh.triangles.size(); ++t) {
      for (const int v : object.mesh.triangles[t]) {
        if (v < object.mesh.vertex_count()) continue;
        fail("object " + id + ", triangle " + std::to_string(t) + " names vertex " +
             std::to_string(v) + "; the object has " + std::to_string(object.mesh.vertex_count()) +
             " (from 0)");
      }
    }
  }

  XmlScanner scan_;
  Model model_;
  Object* object_ = nullptr;
  bool is_in_mesh_ = false;
  bool is_in_build_ = false;
};

class Package {
 public:
  Package(std::string_view bytes, const std::string& name) : zip_(bytes, name), name_(name) {}

  MeshFile read() {
    const std::string root = root_part();
    const Model& model = part(root);
    if (model.build.empty()) {
      throw InputError(name_ + ": the 3MF places no object (its <build> is empty)");
    }
    file_.format = "3MF";
    file_.unit = model.unit.unit;
    unit_ = model.unit;
    int support_count = 0;
    int item_count = 0;
    for (const Placed& item : model.build) {
      const auto& [holder, object] = find(root, item);
      if (object->is_support) {
        ++support_count;
        continue;
      }
      ++item_count;
      add(holder, *object, item.parent_from_object, 0);
    }
    if (item_count > 1) {
      file_.notes.push_back(std::to_string(item_count) + " build items joined into one mesh");
    }
    if (support_count > 0) {
      file_.notes.push_back(std::to_string(support_count) + " support structures skipped");
    }
    finish_mesh(file_, name_);
    return std::move(file_);
  }

 private:
  std::string root_part() const {
    if (const auto relations = zip_.read("_rels/.rels")) {
      XmlScanner scan(*relations, name_ + " (_rels/.rels)");
      while (const XmlTag* tag = scan.next()) {
        if (tag->name == "Relationship" &&
            tag->attribute("Type").value_or("").ends_with("/3dmodel")) {
          return std::string(tag->attribute("Target").value_or(""));
        }
      }
    }
    return "3D/3dmodel.model";
  }

  const Model& part(const std::string& path) {
    auto& slot = parts_[path];
    if (!slot) {
      const auto text = zip_.read(path);
      if (!text) {
        throw InputError(name_ + ": is a ZIP archive without " + in_quotes(path) +
                         "; a 3MF package is required");
      }
      slot = std::make_unique<Model>(ModelReader(*text, name_ + " (" + path + ")").read());
    }
    return *slot;
  }

  /// Object that is placed by something in part `holder`, and the part where it stands.
  std::pair<std::string, const Object*> find(const std::string& holder, const Placed& placed) {
    const std::string where = placed.part.empty() ? holder : placed.part;
    const Model& model = part(where);
    const auto object = model.objects.find(placed.object);
    if (object == model.objects.end()) {
      throw InputError(placed.place + ": object " + in_quotes(placed.object) + " does not exist");
    }
    return {where, &object->second};
  }

  void add(const std::string& holder, const Object& object, const Affine& build_from_object,
           int depth) {
    // Objects within objects may name each other in a ring or multiply without end.
    constexpr int kDeepest = 32;
    constexpr int kMostInstances = 100'000;
    if (depth > kDeepest || ++instances_ > kMostInstances) {
      throw InputError(name_ + ": components are deeper than 32 levels or are more than 100000");
    }
    vertices_seen_ += object.mesh.vertices.size();
    check_triangle_count(name_, vertices_seen_ / 3);
    check_triangle_count(name_, file_.mesh.triangles.size() + object.mesh.triangles.size());
    const double scale = to_millimetres(part(holder).unit) / to_millimetres(unit_) * unit_.scale;
    const bool is_mirrored = build_from_object.linear().determinant() < 0.0;
    const int first = file_.mesh.vertex_count();
    for (const Vec3& v : object.mesh.vertices) {
      const Vec3 placed = scale * (build_from_object * v);
      if (!placed.allFinite() || !(placed.cwiseAbs().maxCoeff() <= 1e12)) {
        check_position(placed, name_ + ": a vertex put in place by a transform");
      }
      file_.mesh.vertices.push_back(placed);
    }
    for (const Triangle& t : object.mesh.triangles) {
      const int b = is_mirrored ? t[2] : t[1];
      const int c = is_mirrored ? t[1] : t[2];
      file_.mesh.triangles.push_back({first + t[0], first + b, first + c});
    }
    for (const Placed& component : object.components) {
      const auto& [where, inner] = find(holder, component);
      add(where, *inner, build_from_object * component.parent_from_object, depth + 1);
    }
  }

  ZipArchive zip_;
  const std::string& name_;
  std::map<std::string, std::unique_ptr<Model>> parts_;
  Unit unit_;
  int instances_ = 0;
  std::uint64_t vertices_seen_ = 0;
  MeshFile file_;
};

}  // namespace

MeshFile parse_three_mf(std::string_view bytes, const std::string& name) {
  return Package(bytes, name).read();
}

}  // namespace palmar::formats
