// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/cad_model.h"

#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <utility>

#include "palmar/cad/occt_model.h"

namespace palmar {

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
    TopExp::MapShapes(impl->shape, TopAbs_EDGE, impl->edges);
  }
  return CadModel(std::move(impl));
}

CadModel make_cad_model(const TopoDS_Shape& shape, const std::string& name) {
  return make_cad_model({{.shape = shape, .name = name, .colour = std::nullopt}});
}

}  // namespace palmar
