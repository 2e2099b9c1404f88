// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "palmar/core/progress.h"

namespace palmar {

/// What the child process that handles CAD may use. Beyond it, it is ended and the user told which
/// limit it was.
struct CadLimits {
  double seconds = 60.0;    ///< of wall clock
  double memory_mb = 4096;  ///< of address space
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// Exit code of the child when memory was refused to it.
inline constexpr int kCadOutOfMemory = 71;

/// A folder of its own for one run of the worker, removed at the end of its life.
class CadFolder {
 public:
  CadFolder();  ///< throws OutputError
  ~CadFolder();
  CadFolder(const CadFolder&) = delete;
  CadFolder& operator=(const CadFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs `palmar-cad VERB FOLDER` (beside this program, or $PALMAR_CAD) as a child and waits for it.
///
/// `request` is a JSON object that the verb knows (apps/palmar-cad/VERB.cpp); it goes into
/// request.json of the folder. The reply, a JSON object, comes back; files that it speaks of are in
/// the folder. Progress lines of the child become those of `progress`.
///
/// Throws what the child found wrong with the same class and message (InputError, UsageError,
/// NumericalError, OutputError); InputError naming `object` and the limit if it ran out of time or
/// memory, or crashed on its input; Cancelled (the child is ended at once); OutputError if the
/// program isn't there.
std::string run_cad(const std::string& verb, const std::string& request, const CadFolder& folder,
                    const std::string& object, const CadLimits& limits = {},
                    const Progress& progress = {});

}  // namespace palmar
