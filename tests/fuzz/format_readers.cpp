// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Readers of the module formats, by the names of their targets.
#include <string>
#include <string_view>
#include <vector>

#include "fuzzed_file.h"
#include "hands/images/dicom_slice.h"
#include "hands/images/exif.h"
#include "hands/images/image_formats.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/mesh/glb.h"
#include "palmar/formats/mesh/gltf.h"
#include "palmar/formats/mesh/obj.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/mesh/stl.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/formats/mesh/three_mf.h"
#include "palmar/formats/motion/c3d.h"
#include "palmar/formats/toml_section.h"

namespace palmar::fuzz {

void stl(std::string_view bytes) { formats::parse_stl(bytes, kName); }
void obj(std::string_view bytes) { formats::parse_obj(bytes, kName); }
void ply(std::string_view bytes) { formats::parse_ply(bytes, kName); }
void gltf(std::string_view bytes) { formats::parse_gltf(bytes, kName); }
void glb(std::string_view bytes) {
  formats::parse_glb(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), kName);
}
void three_mf(std::string_view bytes) { formats::parse_three_mf(bytes, kName); }
void picture(std::string_view bytes) { formats::read_texture(bytes, kName); }
void exif(std::string_view bytes) { images::read_exif(bytes); }
void nifti(std::string_view bytes) { images::read_nifti(bytes, kName); }
void dicom(std::string_view bytes) { images::read_dicom_headers(fuzzed_file(bytes, ".dcm")); }
void c3d(std::string_view bytes) { formats::parse_c3d(bytes, kName); }
void csv(std::string_view bytes) { formats::parse_csv(bytes, kName); }
void toml(std::string_view bytes) { formats::parse_toml(std::string(bytes), kName); }

}  // namespace palmar::fuzz
