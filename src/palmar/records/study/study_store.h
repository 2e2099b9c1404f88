// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/progress.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"
#include "palmar/study/study_run.h"

namespace palmar::records {

/// Newest version of the stores that this program reads and writes; a newer one is refused
/// (docs/using/study-store.md has every table). Version 2 keeps faces of products; a study without
/// any is written as version 1.
inline constexpr int kStudyStoreVersion = 2;

/// Another process writes the study, or reads what this one wants to write.
class StudyBusy : public Error {
 public:
  using Error::Error;
};

enum class StudyAccess {
  kRead,  ///< beside other readers; refused while another process writes
  kWrite  ///< alone
};

/// A study in one SQLite file: plan, what it was made of, and every grasp that is finished, one
/// transaction each; whatever ends the program, no finished grasp is lost and no half one is there.
/// A finished store depends on nothing but plan, inputs and program: it has the same bytes whether
/// the study ran in one go, in pieces, on any number of threads, or in shards that were merged.
///
/// Messages begin with the file's name. Throws StudyBusy: in use by another process; InputError: no
/// store, of a newer version, damaged; OutputError: no permission, disk full.
class StudyStore {
 public:
  /// A store without any grasp. Throws OutputError if there is a file of that name.
  static void create(const std::filesystem::path& path, const study::StudyPlan& plan,
                     const study::StudyInputs& inputs, study::StudyShard shard = {});

  explicit StudyStore(const std::filesystem::path& path, StudyAccess access = StudyAccess::kRead);
  ~StudyStore();
  StudyStore(StudyStore&&) noexcept;

  const std::filesystem::path& path() const;
  const study::StudyPlan& plan() const;
  study::StudyShard shard() const;
  std::string program() const;  ///< version of Palmar that made it
  /// Hand and products, the very ones the study was begun with; distance fields are made again.
  study::StudyInputs inputs() const;

  std::vector<std::int64_t> done() const;     ///< numbers of finished grasps, ascending
  std::vector<std::int64_t> missing() const;  ///< of the shard, ascending
  /// Every finished grasp, ascending by number; without `with_fields` skin_pressure and
  /// product_pressure stay empty. StudyRecord::seconds only until finish().
  void for_each(bool with_fields,
                const std::function<void(const study::StudyRecord&)>& visit) const;
  /// Throws UsageError if it isn't there.
  study::StudyRecord record(std::int64_t number) const;

  /// Adds a grasp; on return it is on the disk. Throws UsageError if it is there already.
  void keep(const study::StudyRecord& record);
  /// Turns a store without missing grasps into a finished one: in the order of numbers, without
  /// times, with the digest of all results. The file is replaced at once, never half. Throws
  /// UsageError if a grasp is missing.
  void finish();
  bool is_finished() const;
  /// SHA-256 of plan, inputs and all results of a finished store; "" before.
  std::string digest() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Joins the finished shards of one study to the store that one process would have written. Throws
/// UsageError naming what is wrong: a shard that is missing, twice or not finished, or of another
/// study (and in what it differs); OutputError if `out` is there.
void merge_studies(const std::vector<std::filesystem::path>& shards,
                   const std::filesystem::path& out, const Progress& progress = {});

std::string sqlite_version();  ///< "3.40.1"; of the library that runs

/// SHA-256 of what a study is made of, in StudyPlan's fields.
std::string content_hash(const geometry::TriangleMesh& mesh);  ///< mm; of a product as it is held
std::string content_hash(const hand::Hand& hand);

}  // namespace palmar::records
