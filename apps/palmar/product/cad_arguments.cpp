// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "product/cad_arguments.h"

namespace palmar::cli {

void CadArguments::add_to(CLI::App& verb) {
  verb.add_option("--chordal-error-mm", chordal_error,
                  "CAD: largest gap between triangles and surface; without it from size and "
                  "smallest radius");
  verb.add_option("--time-limit-s", limits.seconds, "CAD: most processor time for reading a file")
      ->capture_default_str();
  verb.add_option("--memory-limit-mb", limits.memory_mb, "CAD: most memory for reading a file")
      ->capture_default_str();
}

records::LoadProductOptions CadArguments::options(const std::string& unit) const {
  limits.check();
  records::LoadProductOptions options;
  options.unit = parse_unit(unit);
  options.chordal_error = chordal_error;
  options.limits = limits;
  return options;
}

}  // namespace palmar::cli
