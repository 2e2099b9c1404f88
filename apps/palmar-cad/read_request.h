// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <string>

#include "palmar/cad/model/cad_file.h"
#include "palmar/core/error.h"
#include "verbs.h"

namespace palmar::cad_worker {

/// The CAD file that a request names: {file, millimetres_per_unit?}.
cad::CadFile read_request(const Json& request, const Progress& progress);

/// Does the work on a file; what the kernel can't do with it is the file's fault, by name. Memory
/// that is refused stays what it is.
template <typename Work>
auto on_file(const std::string& object, const Work& work) {
  try {
    return work();
  } catch (const Standard_OutOfMemory&) {
    throw;
  } catch (const Standard_Failure& failure) {
    const char* const text = failure.GetMessageString();
    throw InputError(object + ": the CAD kernel gave up on it: " + failure.DynamicType()->Name() +
                     (text != nullptr && *text != '\0' ? std::string(", ") + text : ""));
  }
}

}  // namespace palmar::cad_worker
