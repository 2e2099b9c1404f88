// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/xcaf_bodies.h"

#include <NCollection_DataMap.hxx>
#include <Quantity_Color.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <map>
#include <set>

#include "palmar/cad/model/body_repair.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

using Colour = std::optional<std::array<float, 3>>;
constexpr int kDeepestAssembly = 64;

struct ShapeInfo {
  std::string name;
  Colour colour;
};
using InfoMap = NCollection_DataMap<TopoDS_Shape, ShapeInfo, TopTools_ShapeMapHasher>;

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return {};
  const TCollection_ExtendedString& text = attribute->Get();
  std::string name(text.LengthOfCString(), '\0');
  Standard_PCharacter place = name.data();
  text.ToUTF8CString(place);
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  const std::size_t first = name.find_first_not_of(' ');
  if (first == name.npos) return {};
  constexpr std::size_t kLongest = 200;  // bytes; more nobody reads
  return name.substr(first, std::min(kLongest, name.find_last_not_of(' ') + 1 - first));
}

Colour colour_of(const Handle(XCAFDoc_ColorTool) & tool, const TDF_Label& label) {
  Quantity_Color colour;
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
    if (!tool->GetColor(label, type, colour)) continue;
    Standard_Real r = 0, g = 0, b = 0;
    colour.Values(r, g, b, Quantity_TOC_sRGB);
    const auto share = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
    return std::array<float, 3>{share(r), share(g), share(b)};
  }
  return std::nullopt;
}

/// Walks through the assembly and collects what has a surface.
class Flattener {
 public:
  Flattener(const Handle(TDocStd_Document) & document, double scale, const ReadCadOptions& options,
            const std::string& object, const Progress& progress)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        scale_(scale),
        options_(options),
        object_(object),
        progress_(progress) {}

  void run(CadFile& file) {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    Count all;
    for (const TDF_Label& root : roots) all += count(root, 0);
    check_count(all);
    if (all.faces == 0.0) fail_without_faces(all);
    has_solids_ = all.solids > 0.0;
    for (const TDF_Label& root : roots) walk(root, TopLoc_Location(), "", std::nullopt);
    add_loose_faces();
    finish(all, file);
  }

 private:
  /// Of all instances; doubles, for they may be more than any integer holds.
  struct Count {
    double bodies = 0, faces = 0, solids = 0, loose_faces = 0, curves = 0, points = 0;
    Count& operator+=(const Count& o) {
      bodies += o.bodies, faces += o.faces, solids += o.solids, loose_faces += o.loose_faces;
      curves += o.curves, points += o.points;
      return *this;
    }
  };
  struct FaceInfo {
    std::vector<ShapeInfo> by_face;  ///< in the kernel's order within the body
  };

  static std::string entry(const TDF_Label& label) {
    TCollection_AsciiString text;
    TDF_Tool::Entry(label, text);
    return text.ToCString();
  }

  /// The part or assembly that a component stands for; the label itself if it is none.
  static TDF_Label referred(const TDF_Label& label) {
    TDF_Label part;
    return XCAFDoc_ShapeTool::GetReferredShape(label, part) ? part : label;
  }

  void check_depth(int depth) const {
    if (depth <= kDeepestAssembly) return;
    throw InputError(object_ + ": assemblies are nested more than " +
                     std::to_string(kDeepestAssembly) + " deep");
  }

  Count count(const TDF_Label& label, int depth) {
    check_depth(depth);
    const TDF_Label part = referred(label);
    const std::string key = entry(part);
    if (const auto known = counts_.find(key); known != counts_.end()) return known->second;
    Count result;
    TDF_LabelSequence components;
    if (XCAFDoc_ShapeTool::IsAssembly(part) && XCAFDoc_ShapeTool::GetComponents(part, components)) {
      for (const TDF_Label& component : components) result += count(component, depth + 1);
    } else {
      result = count_shape(XCAFDoc_ShapeTool::GetShape(part));
    }
    counts_[key] = result;
    return result;
  }

  static Count count_shape(const TopoDS_Shape& shape) {
    Count c;
    if (shape.IsNull()) return c;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) ++c.solids;
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) ++c.faces;
    for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next()) {
      ++c.loose_faces;
    }
    for (TopExp_Explorer it(shape, TopAbs_EDGE, TopAbs_FACE); it.More(); it.Next()) ++c.curves;
    for (TopExp_Explorer it(shape, TopAbs_VERTEX, TopAbs_EDGE); it.More(); it.Next()) ++c.points;
    c.bodies = c.solids + (c.loose_faces > 0.0 ? 1.0 : 0.0);
    return c;
  }

  void check_count(const Count& all) const {
    const auto refuse = [this](double value, const std::string& what, int allowed) {
      char text[32];
      std::snprintf(text, sizeof text, "%.6g", value);
      throw InputError(object_ + ": its assembly repeats parts to " + text + " " + what +
                       "; up to " + std::to_string(allowed) +
                       " are read. Export the part that is held, not the whole assembly");
    };
    if (all.bodies > options_.max_bodies) refuse(all.bodies, "bodies", options_.max_bodies);
    if (all.faces > options_.max_faces) refuse(all.faces, "faces", options_.max_faces);
  }

  [[noreturn]] void fail_without_faces(const Count& all) const {
    const auto number = [](double v) { return std::to_string(static_cast<long long>(v)); };
    if (all.curves > 0.0) {
      throw InputError(object_ + ": holds only a wireframe (" + number(all.curves) +
                       " curves, no surface); export the solid");
    }
    if (all.points > 0.0) {
      throw InputError(object_ + ": holds only points (" + number(all.points) +
                       "), no surface; export the solid");
    }
    throw InputError(object_ + ": holds no shape; export the solid");
  }

  void walk(const TDF_Label& label, const TopLoc_Location& outer, const std::string& path,
            Colour colour) {
    progress_.throw_if_cancelled();
    const TDF_Label part = referred(label);
    // GetShape() of the component would already be moved; places are gathered on the way instead.
    const TopLoc_Location place =
        part == label ? outer : outer * XCAFDoc_ShapeTool::GetLocation(label);
    if (!colour && part != label) colour = colour_of(colours_, label);
    if (!colour) colour = colour_of(colours_, part);
    std::string name = name_of(part);
    if (name.empty() && part != label) name = name_of(label);
    const std::string full = path.empty() || name.empty() ? path + name : path + " / " + name;
    TDF_LabelSequence components;
    if (XCAFDoc_ShapeTool::IsAssembly(part) && XCAFDoc_ShapeTool::GetComponents(part, components)) {
      for (const TDF_Label& component : components) walk(component, place, full, colour);
      return;
    }
    add_part(part, place, full, colour);
  }

  void add_part(const TDF_Label& part, const TopLoc_Location& place, const std::string& path,
                const Colour& colour) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
    if (shape.IsNull()) return;
    InfoMap infos;
    TDF_LabelSequence subs;
    XCAFDoc_ShapeTool::GetSubShapes(part, subs);
    for (const TDF_Label& sub : subs) {
      const TopoDS_Shape sub_shape = XCAFDoc_ShapeTool::GetShape(sub);
      if (!sub_shape.IsNull()) {
        infos.Bind(sub_shape, {name_of(sub), colour_of(colours_, sub)});
      }
    }
    if (!has_solids_) {
      // Surfaces of a file without solids may stand in it one by one: all are sewn in the end.
      for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
        const TopoDS_Shape face = placed(it.Current(), place, scale_);
        ShapeInfo info;
        if (const ShapeInfo* known = infos.Seek(it.Current())) info = *known;
        if (!info.colour) info.colour = colour;
        loose_.push_back(TopoDS::Face(face));
        loose_info_.Bind(face, info);
        loose_path_.Bind(face, path);
      }
      return;
    }
    std::vector<TopoDS_Shape> solids;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
      solids.push_back(it.Current());
    }
    for (const TopoDS_Shape& solid : solids) {
      std::string name = path;
      Colour own = colour;
      if (const ShapeInfo* info = infos.Seek(solid)) {
        if (info->colour) own = info->colour;
        if (!info->name.empty() && (solids.size() > 1 || name.empty())) {
          name += (name.empty() ? "" : " / ") + info->name;
        }
      }
      RepairedBody body = repaired(solid);
      body.shape = placed(body.shape, place, scale_);
      add_body(body, name, own, infos);
    }
  }

  void add_loose_faces() {
    if (loose_.empty()) return;
    for (const RepairedBody& body : sew(loose_)) {
      std::string name;
      if (!body.original_faces.empty() && !body.original_faces.front().IsNull()) {
        if (const std::string* path = loose_path_.Seek(body.original_faces.front())) name = *path;
      }
      add_body(body, name, std::nullopt, loose_info_);
    }
  }

  void add_body(const RepairedBody& body, std::string name, const Colour& colour,
                const InfoMap& infos) {
    if (body.is_healed) ++healed_;
    if (body.is_turned) ++turned_;
    if (body.was_invalid && !body.is_healed) ++invalid_;
    if (body.was_sewn && body.is_solid) ++sewn_solids_;
    if (name.empty()) name = "body";
    if (const int number = ++names_[name]; number > 1) {
      // "screw", "screw (2)": so that every body can be distinguished from the others.
      name += " (" + std::to_string(number) + ")";
    }
    FaceInfo info;
    for (const TopoDS_Shape& original : body.original_faces) {
      const ShapeInfo* found = original.IsNull() ? nullptr : infos.Seek(original);
      info.by_face.push_back(found != nullptr ? *found : ShapeInfo());
    }
    infos_.push_back(std::move(info));
    bodies_.push_back({.shape = body.shape, .name = name, .colour = colour});
    (body.is_solid ? solids_ : open_) += 1;
  }

  void finish(const Count& all, CadFile& file) {
    CadModel model = make_cad_model(bodies_);
    auto impl = std::make_shared<CadModel::Impl>(model.impl());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      TopTools_IndexedMapOfShape faces;
      TopExp::MapShapes(bodies_[b].shape, TopAbs_FACE, faces);
      const std::vector<ShapeInfo>& info = infos_[b].by_face;
      for (int f = 1; f <= faces.Extent() && f <= static_cast<int>(info.size()); ++f) {
        const int number = impl->faces.FindIndex(faces(f));
        if (number == 0) continue;
        if (!info[f - 1].name.empty()) impl->face_name[number] = info[f - 1].name;
        if (info[f - 1].colour) impl->face_colour[number] = *info[f - 1].colour;
      }
    }
    file.model = CadModel(std::move(impl));
    file.solids = solids_;
    file.open_shells = open_;
    const auto add = [&file](double count, const std::string& one, const std::string& many) {
      if (count <= 0.0) return;
      const auto number = static_cast<long long>(count);
      file.notes.push_back(std::to_string(number) + " " + (number == 1 ? one : many));
    };
    if (has_solids_) {
      add(all.loose_faces, "surface beside the solids was left out",
          "surfaces beside the solids were left out");
    }
    add(all.curves, "curve was left out", "curves were left out");
    add(all.points, "point was left out", "points were left out");
    add(sewn_solids_, "solid was made of surfaces that close",
        "solids were made of surfaces that close");
    add(open_,
        "open shell: its surfaces enclose nothing, what is inside is judged by the winding number",
        "open shells: their surfaces enclose nothing, what is inside is judged by the winding "
        "number");
    add(turned_, "solid was inside out and was turned", "solids were inside out and were turned");
    add(healed_, "body was faulty and was repaired", "bodies were faulty and were repaired");
    add(invalid_, "body is faulty by the CAD kernel's check (`palmar product check`)",
        "bodies are faulty by the CAD kernel's check (`palmar product check`)");
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  double scale_;
  const ReadCadOptions& options_;
  const std::string& object_;
  const Progress& progress_;
  std::map<std::string, Count> counts_;
  std::map<std::string, int> names_;
  std::vector<CadModel::Impl::Body> bodies_;
  std::vector<FaceInfo> infos_;
  std::vector<TopoDS_Face> loose_;  ///< of a file without solids
  InfoMap loose_info_;
  NCollection_DataMap<TopoDS_Shape, std::string, TopTools_ShapeMapHasher> loose_path_;
  bool has_solids_ = false;
  int solids_ = 0, open_ = 0, healed_ = 0, turned_ = 0, invalid_ = 0, sewn_solids_ = 0;
};

}  // namespace

void flatten(const Handle(TDocStd_Document) & document, double scale, const ReadCadOptions& options,
             const std::string& object, const Progress& progress, CadFile& file) {
  Flattener(document, scale, options, object, progress).run(file);
}

Handle(TDocStd_Document) new_document() {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
  return document;
}

}  // namespace palmar::cad
