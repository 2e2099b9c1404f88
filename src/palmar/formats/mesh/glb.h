// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palmar::formats {

/// A binary glTF 2.0 container: the JSON chunk and the one embedded buffer (Khronos glTF 2.0,
/// section 4). For use inside `io` only.
struct Glb {
  nlohmann::json json;
  std::vector<std::uint8_t> buffer;
};

/// Reads a container. Throws InputError naming the file for: missing, not glTF, another version
/// than 2, truncated, broken JSON.
Glb read_glb(const std::string& path);

/// The same from memory; `name` stands in the messages.
Glb parse_glb(const std::vector<std::uint8_t>& bytes, const std::string& name);

/// The bytes of a container, both chunks padded to 4 bytes.
std::vector<std::uint8_t> format_glb(const Glb& glb);

/// Writes a container. Throws OutputError if the file can't be written in full.
void write_glb(const Glb& glb, const std::string& path);

/// All numbers of accessor `index` [count x components], row by row. Float, and unsigned or signed
/// integer components; normalised integers are returned as they are. Throws InputError, naming the
/// accessor, if it is missing, sparse, or reaches outside its buffer.
struct AccessorData {
  int count = 0;
  int components = 0;
  std::vector<double> value;  ///< count x components
};
AccessorData read_accessor(const Glb& glb, int index, const std::string& name);

/// The doubles of a buffer view (little endian; glTF has no accessor for them). Throws InputError
/// if the view is missing or not `expected` numbers long.
std::vector<double> read_doubles(const Glb& glb, int buffer_view, std::size_t expected,
                                 const std::string& name);

/// Appends numbers to the buffer and describes them; each returns the index of the new accessor
/// (add_doubles: of the buffer view).
int add_floats(Glb& glb, const std::vector<float>& value, int components, bool with_bounds = false);
int add_indices(Glb& glb, const std::vector<std::uint32_t>& value);
int add_bytes(Glb& glb, const std::vector<std::uint8_t>& value, int components);
int add_doubles(Glb& glb, const std::vector<double>& value);

}  // namespace palmar::formats
