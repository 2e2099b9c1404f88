// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "palmar/records/sqlite_file.h"
#include "palmar/records/study/study_store.h"

namespace palmar::records {

/// A study's file, open and looked through: for writing, locked against every other process; for
/// reading, also where the folder can't be written to. Waits for readers up to ten seconds, for a
/// writer three. Throws InputError: no such file, no study, of a newer version, damaged; and
/// SqliteFailure, "busy" for one. For use inside `records` only.
std::unique_ptr<SqliteFile> open_store(const std::filesystem::path& path, StudyAccess access);

}  // namespace palmar::records
