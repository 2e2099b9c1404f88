// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/cad_model.h"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListIteratorOfListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <utility>

#include "palmar/cad/model/occt_model.h"

namespace palmar::cad {

CadModel::CadModel() : impl_(std::make_shared<const Impl>()) {}
CadModel::CadModel(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

bool CadModel::is_empty() const { return impl_->bodies.empty(); }
int CadModel::face_count() const { return impl_->faces.Extent(); }
int CadModel::edge_count() const { return impl_->edges.Extent(); }

int CadModel::solid_count() const {
  int count = 0;
  if (is_empty()) return count;
  for (TopExp_Explorer it(impl_->shape, TopAbs_SOLID); it.More(); it.Next()) ++count;
  return count;
}

std::vector<std::string> body_names(const CadModel& model) {
  std::vector<std::string> names;
  for (const CadModel::Impl::Body& body : model.impl().bodies) names.push_back(body.name);
  return names;
}

namespace {

/// What an edge is recognised by: the faces that it bounds and where its middle is. The order in
/// which the kernel walks along outlines changes when a file is written and read; this doesn't.
struct EdgeKey {
  std::array<int, 2> faces = {};
  std::array<double, 3> middle = {};  ///< 1e-5 mm, rounded
  auto operator<=>(const EdgeKey&) const = default;
};

TopTools_IndexedMapOfShape edges_in_order(const TopoDS_Shape& shape,
                                          const TopTools_IndexedMapOfShape& faces) {
  constexpr double kRounding = 1e5;
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
  std::vector<std::pair<EdgeKey, int>> order;
  for (int e = 1; e <= faces_of.Extent(); ++e) {
    EdgeKey key;
    int side = 0;
    for (TopTools_ListIteratorOfListOfShape it(faces_of(e)); it.More() && side < 2; it.Next()) {
      key.faces[side++] = faces.FindIndex(it.Value());
    }
    std::sort(key.faces.begin(), key.faces.end());
    double first = 0, last = 0;
    const Handle(Geom_Curve) curve =
        BRep_Tool::Curve(TopoDS::Edge(faces_of.FindKey(e)), first, last);
    if (!curve.IsNull()) {
      const gp_Pnt middle = curve->Value(0.5 * (first + last));
      for (int c = 0; c < 3; ++c) key.middle[c] = std::round(middle.Coord(c + 1) * kRounding);
    }
    order.emplace_back(key, e);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  TopTools_IndexedMapOfShape edges;
  for (const auto& [key, e] : order) edges.Add(faces_of.FindKey(e));
  return edges;
}

}  // namespace

CadModel make_cad_model(std::vector<CadModel::Impl::Body> bodies) {
  auto impl = std::make_shared<CadModel::Impl>();
  impl->bodies = std::move(bodies);
  if (impl->bodies.size() == 1) {
    impl->shape = impl->bodies.front().shape;
  } else if (!impl->bodies.empty()) {
    TopoDS_Compound all;
    const BRep_Builder builder;
    builder.MakeCompound(all);
    for (const CadModel::Impl::Body& body : impl->bodies) builder.Add(all, body.shape);
    impl->shape = all;
  }
  if (!impl->bodies.empty()) {
    TopExp::MapShapes(impl->shape, TopAbs_FACE, impl->faces);
    impl->edges = edges_in_order(impl->shape, impl->faces);
  }
  return CadModel(std::move(impl));
}

CadModel make_cad_model(const TopoDS_Shape& shape, const std::string& name) {
  return make_cad_model({{.shape = shape, .name = name, .colour = std::nullopt}});
}

}  // namespace palmar::cad
