// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/formats/sha256.h"
#include "palmar/records/sqlite_file.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"
#include "palmar/study/study_run.h"

namespace palmar::records {

// The tables of a study store (docs/using/study-store.md). For use inside `io` only; what SQLite
// can't do is a SqliteFailure.

inline constexpr int kStudyApplicationId = 0x504C4D52;  ///< "PLMR"
inline constexpr int kStudyPageSize = 16384;            ///< bytes

/// A record's fields as they lie in the file.
struct PackedFields {
  std::string skin, product;
};

/// Writes records into the tables of an open file.
class StudyTableWriter {
 public:
  StudyTableWriter(SqliteFile& file, const study::StudyPlan& plan);
  /// All rows of one record; the caller begins and ends the transaction.
  void write(const study::StudyRecord& record);
  /// The same of a record whose fields are there packed, too: packing is most of the time.
  void write(const study::StudyRecord& record, const PackedFields& fields);
  /// The time it took; only while the store isn't finished.
  void write_time(const study::StudyRecord& record);
  /// SHA-256 of what add_to_digest() got and of all records written, in their order.
  std::string digest() const { return digest_.hex(); }
  void add_to_digest(const std::string& bytes) { digest_.add(bytes); }

 private:
  std::int64_t quantity_id(const std::string& key);
  void write_hold(std::int64_t number, const study::StudyHold& hold);
  void write_fallbacks(std::int64_t number, const contact::ContactFallbacks& fallbacks);

  SqliteFile& file_;
  const study::StudyPlan& plan_;
  std::map<std::string, std::int64_t> quantity_;
  formats::Sha256 digest_;
  SqliteStatement grasp_, region_, index_, field_;
  std::optional<SqliteStatement> hold_, fallback_;
};

/// Reads records one by one, ascending by number. Throws InputError: a record is damaged.
class StudyTableReader {
 public:
  /// Of one number only, if given.
  StudyTableReader(SqliteFile& file, bool with_fields, std::optional<std::int64_t> only = {});
  bool next(study::StudyRecord& record);
  /// The same with the fields left packed; unpack_fields() may follow on another thread.
  bool next(study::StudyRecord& record, PackedFields& fields);

 private:
  void read_regions(study::StudyRecord& record);
  void read_indices(study::StudyRecord& record);
  void read_hold(study::StudyRecord& record);
  void read_fallbacks(study::StudyRecord& record);

  bool with_fields_;
  std::map<std::int64_t, std::string> quantity_;
  SqliteStatement grasp_, region_, index_;
  std::optional<SqliteStatement> hold_, fallback_;
  // A row that isn't taken yet.
  bool has_region_ = false, has_index_ = false, has_hold_ = false, has_fallback_ = false;
};

/// Gives a record its fields. Throws InputError: they are damaged.
void unpack_fields(const PackedFields& fields, study::StudyRecord& record);

/// Text of a key of table `study`, or "".
std::string study_value(SqliteFile& file, const std::string& key);

/// What a new store begins with: everything but records.
struct StudyHead {
  const study::StudyPlan& plan;
  std::string hand;                   ///< packed, as in table `input`
  std::vector<std::string> products;  ///< packed
  std::vector<std::string> faces;     ///< packed, by product; "": has none, or Palmar makes it
  study::StudyShard shard;
  std::string program;
};

/// A new store at `path` (which must not exist), synced to the disk: `fill` writes its records.
/// With `is_finished` it gets its digest. Same arguments, same bytes.
void build_store(const std::filesystem::path& path, const StudyHead& head, bool is_finished,
                 const std::function<void(StudyTableWriter&)>& fill);

}  // namespace palmar::records
