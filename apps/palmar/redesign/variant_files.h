// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli.h"
#include "palmar/records/product/made_product.h"

namespace palmar::cli {

/// Products that are to be made, and the files of each.
struct VariantFiles {
  struct Entry {
    std::string name;    ///< unique
    std::string family;  ///< what the variants of a sweep share; may be ""
    MadeProduct product;
    std::vector<std::string> files;  ///< by suffix: .step, .stp, .stl, .obj, .ply
  };
  std::vector<Entry> products;
  double chordal_error = 0.01;  ///< mm, of meshes
  std::string folder;           ///< "": no study file is written
  std::string command_line;     ///< for the study file
};

/// "handles/tapered_handle-diameter-25mm.step", one per format ("step,stl"). Throws UsageError on a
/// format that isn't known.
std::vector<std::string> files_in_folder(const std::string& folder, const std::string& name,
                                         const std::string& formats);

/// Makes and writes them, and FOLDER/study.toml that lets hands hold them; tells what was written,
/// with --json on stdout. Throws UsageError on a suffix that can't be written, before anything is.
void write_variants(const VariantFiles& files, const Context& context);

}  // namespace palmar::cli
