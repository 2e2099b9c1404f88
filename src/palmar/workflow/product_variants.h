// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/product/primitives.h"
#include "palmar/records/product/made_product.h"

namespace palmar::workflow {

/// Products that are to be made, and the files of each.
struct ProductVariantsRequest {
  struct Entry {
    std::string name;    ///< unique
    std::string family;  ///< what the variants of a sweep share; may be ""
    records::MadeProduct product;
    std::vector<std::string> files;  ///< by suffix: .step, .stp, .stl, .obj, .ply
  };
  std::vector<Entry> products;
  double chordal_error = product::MeshFineness{}.chordal_error;  ///< mm, of meshes
  std::string folder;  ///< gets study.toml, which lets hands hold the products; "": none is written
  std::string command;  ///< that the study file gives as where it comes from
  /// Called with every note as it arises (what was written); they are in the outcome, too.
  std::function<void(const std::string& note)> on_note;

  /// Throws UsageError on a suffix that can't be written, on two products of one file, or if FOLDER
  /// has a study.toml that somebody else wrote.
  void check() const;
};

struct ProductVariantsOutcome {
  std::filesystem::path study;     ///< study.toml; empty: none was written
  std::vector<std::string> notes;  ///< what was written and what was noticed
  std::string json;                ///< the products with volumes and files, one JSON object
};

/// "handles/tapered_handle-diameter-25mm.step", one per format ("step,stl"). Throws UsageError on a
/// format that isn't known.
std::vector<std::string> files_in_folder(const std::string& folder, const std::string& name,
                                         const std::string& formats);

/// Makes and writes them. Throws as ProductVariantsRequest::check() before anything is written,
/// then as make_solid() and make_cad(); Cancelled.
ProductVariantsOutcome write_variants(const ProductVariantsRequest& request,
                                      const Progress& progress = {});

}  // namespace palmar::workflow
