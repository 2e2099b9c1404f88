// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <TDocStd_Document.hxx>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/occt_model.h"

namespace palmar::cad {

/// Bodies of the kernel's document (assembly tree with names and colours), flattened, with their
/// names, colours and those of their faces; lengths times `scale`. `object` names the file in
/// messages. Fills model, solids, open_shells and notes of `file`. Throws InputError if there is
/// nothing with a surface, or too much.
void flatten(const Handle(TDocStd_Document) & document, double scale, const ReadCadOptions& options,
             const std::string& object, const Progress& progress, CadFile& file);

/// A new empty document.
Handle(TDocStd_Document) new_document();

}  // namespace palmar::cad
