// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palmar::records {

enum class CadFormat { kStep, kIges };
std::string name_of(CadFormat format);  ///< "STEP", "IGES"

/// What the first bytes say; nothing if it is neither.
std::optional<CadFormat> cad_format_of_content(std::string_view head);
/// By suffix: .step, .stp, .p21, .iges, .igs, upper case too.
std::optional<CadFormat> cad_format_of_name(const std::filesystem::path& path);

/// Whether Palmar takes the file for CAD: by content, else by suffix. A file that can't be opened
/// is judged by its suffix. Never throws.
bool is_cad_file(const std::filesystem::path& path);

struct CadFormatCheck {
  CadFormat format = CadFormat::kStep;
  std::string head;  ///< first 16 KB
};
/// Looks at the beginning and the end, without reading the file. Throws InputError naming the file:
/// missing, empty, neither STEP nor IGES (and what it is, if known), cut off before its end.
CadFormatCheck check_cad_format(const std::filesystem::path& path);

}  // namespace palmar::records
