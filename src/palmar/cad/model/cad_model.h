// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace palmar::cad {

/// A boundary representation: one or more bodies with names and colours, mm. An immutable value,
/// cheap to copy; operations give a new one. Faces and edges are numbered from 1 in the order in
/// which the CAD kernel walks through the bodies, edges by the numbers of their faces and then by
/// where their middle is; the same order that ProductFaces has, and that a file keeps.
class CadModel {
 public:
  struct Impl;  ///< occt_model.h, for the sources of this module only

  CadModel();
  explicit CadModel(std::shared_ptr<const Impl> impl);
  const Impl& impl() const { return *impl_; }

  bool is_empty() const;
  int solid_count() const;
  int face_count() const;
  int edge_count() const;

 private:
  std::shared_ptr<const Impl> impl_;
};

/// In their order.
std::vector<std::string> body_names(const CadModel& model);

}  // namespace palmar::cad
