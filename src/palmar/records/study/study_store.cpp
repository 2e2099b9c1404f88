// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_store.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/version.h"
#include "palmar/formats/sha256.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/records/product/made_product.h"
#include "palmar/records/study/study_bytes.h"
#include "palmar/records/study/study_open.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/records/study/study_tables.h"

namespace palmar::records {
namespace {

constexpr int kReadAhead = 64;  // records

namespace fs = std::filesystem;

/// What went wrong, as an Error with the file's name.
[[noreturn]] void fail(const fs::path& path, const SqliteFailure& failure, bool is_writing) {
  const std::string name = path.string();
  switch (failure.code) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw StudyBusy(name + ": in use by another process" +
                      (is_writing ? "; one process at a time may write a study"
                                  : ", which writes it; wait until it is done or stop it"));
    case SQLITE_FULL:
      throw OutputError(name + ": the disk is full; what was finished before is kept");
    case SQLITE_READONLY:
    case SQLITE_PERM: {
      std::error_code none;
      if (!fs::exists(path, none)) {
        throw OutputError(name +
                          ": was moved or deleted while it was in use; what came after is lost");
      }
      throw OutputError(name + ": can't be written: no permission to write to it or to its folder");
    }
    case SQLITE_CANTOPEN:
      throw OutputError(name + ": can't be opened (" + failure.what() +
                        "); it and its folder must be writable");
    case SQLITE_IOERR:
      throw OutputError(name + ": the disk gives an error (" + failure.what() +
                        "); what was finished before is kept");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw InputError(name + ": is damaged (" + failure.what() + ")");
    default:
      break;
  }
  throw InputError(name + ": " + failure.what());
}

/// Runs `body`; what SQLite can't do becomes an Error, and what is damaged gets the file's name.
template <typename Body>
auto guarded(const fs::path& path, bool is_writing, const Body& body) {
  try {
    return body();
  } catch (const SqliteFailure& failure) {
    fail(path, failure, is_writing);
  } catch (const InputError& error) {
    if (std::string_view(error.what()).rfind(path.string(), 0) == 0) throw;
    throw InputError(path.string() + ": " + error.what());
  }
}

void sync_folder(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);  // some file systems can't; the rename itself has happened
  ::close(fd);
}

void sync_file(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_synced = fd >= 0 && ::fsync(fd) == 0;
  const int error = errno;
  if (fd >= 0) ::close(fd);
  if (!is_synced) {
    throw OutputError(path.string() +
                      ": can't be written: " + std::generic_category().message(error));
  }
}

fs::path beside(const fs::path& path, const std::string& ending) {
  return path.parent_path() / ("." + path.filename().string() + ending);
}

/// A file that is removed unless it got its final name.
struct Draft {
  fs::path path;
  bool is_kept = false;
  ~Draft() {
    std::error_code ignored;
    if (!is_kept) fs::remove(path, ignored);
  }
};

study::StudyShard shard_named(const std::string& name) {
  const std::size_t slash = name.find('/');
  const auto k = formats::parse_integer(std::string_view(name).substr(0, slash));
  const auto n = slash == name.npos
                     ? std::nullopt
                     : formats::parse_integer(std::string_view(name).substr(slash + 1));
  if (!k || !n) throw InputError("its shard can't be read: " + formats::in_quotes(name));
  study::StudyShard shard{static_cast<int>(*k), static_cast<int>(*n)};
  shard.check();
  return shard;
}

/// `body` writes a new file at the draft's path; SQLite's failures are reported for `path`.
template <typename Body>
void write_draft(const fs::path& path, const Draft& draft, const Body& body) {
  std::error_code ignored;
  fs::remove(draft.path, ignored);
  guarded(path, true, [&] {
    body();
    return 0;
  });
  sync_file(draft.path);
}

void publish_new(const Draft& draft, const fs::path& path) {
  // A link fails where a rename would replace what another process has made meanwhile.
  if (::link(draft.path.c_str(), path.c_str()) != 0) {
    const int error = errno;
    if (error == EEXIST) throw OutputError(path.string() + ": is there already");
    std::error_code failed;
    if (fs::exists(path)) throw OutputError(path.string() + ": is there already");
    fs::rename(draft.path, path, failed);  // a file system without links
    if (failed) throw OutputError(path.string() + ": can't be written: " + failed.message());
  }
  sync_folder(path);
}

/// Whether the product is made again from its words, exact distance, faces and all; others come
/// from the store.
bool is_made_again(const study::StudyProduct& product) {
  return is_made(product.file) && is_analytic(made_from(product.file));
}

}  // namespace

struct StudyStore::Impl {
  fs::path path;
  StudyAccess access = StudyAccess::kRead;
  std::unique_ptr<SqliteFile> file;
  study::StudyPlan plan;
  study::StudyShard shard;
  std::string program;
  std::unique_ptr<StudyTableWriter> writer;

  template <typename Body>
  auto read(const Body& body) const {
    return guarded(path, false, body);
  }
  std::vector<std::int64_t> done() const {
    std::vector<std::int64_t> numbers;
    SqliteStatement rows(*file, "SELECT number FROM grasp ORDER BY number");
    while (rows.next()) numbers.push_back(rows.integer(0));
    return numbers;
  }
  StudyHead head() const {
    StudyHead result{.plan = plan,
                     .hand = "",
                     .products = {},
                     .faces = std::vector<std::string>(plan.products.size()),
                     .shard = shard,
                     .program = program};
    SqliteStatement rows(*file, "SELECT kind, data, number FROM input ORDER BY kind, number");
    while (rows.next()) {
      const std::string kind = rows.text(0);
      const std::int64_t number = rows.integer(2);
      if (kind == "hand") {
        result.hand = rows.blob(1);
      } else if (kind == "faces") {
        if (number < 0 || number >= std::ssize(result.faces)) {
          throw InputError("its inputs are damaged");
        }
        result.faces[number] = rows.blob(1);
      } else {
        result.products.push_back(rows.blob(1));
      }
    }
    if (result.hand.empty() || result.products.size() != plan.products.size()) {
      throw InputError("its inputs are damaged");
    }
    return result;
  }
};

void StudyStore::create(const fs::path& path, const study::StudyPlan& plan,
                        const study::StudyInputs& inputs, study::StudyShard shard) {
  plan.check();
  study::tasks_of(plan, shard);  // checks the shard
  if (fs::exists(path)) throw OutputError(path.string() + ": is there already");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) {
    throw OutputError(path.string() + ": can't be written: folder " + folder.string() +
                      " does not exist");
  }
  StudyHead head{.plan = plan,
                 .hand = pack(format_hand(*inputs.base)),
                 .products = {},
                 .faces = {},
                 .shard = shard,
                 .program = version()};
  for (std::size_t i = 0; i < inputs.products.size(); ++i) {
    const product::Product& product = inputs.products[i];
    head.products.push_back(pack(mesh_bytes(product.mesh)));
    const bool is_kept = product.faces != nullptr && !is_made_again(plan.products[i]);
    head.faces.push_back(is_kept ? pack(faces_bytes(*product.faces)) : "");
  }
  const Draft draft{beside(path, "." + std::to_string(::getpid()) + ".new")};
  write_draft(path, draft, [&] { build_store(draft.path, head, false, {}); });
  publish_new(draft, path);
}

StudyStore::StudyStore(const fs::path& path, StudyAccess access) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->access = access;
  const bool is_writing = access == StudyAccess::kWrite;
  guarded(path, is_writing, [&] {
    impl_->file = open_store(path, access);
    SqliteFile& file = *impl_->file;
    impl_->plan = parse_plan(study_value(file, "plan"), path.string());
    impl_->shard = shard_named(study_value(file, "shard"));
    impl_->program = study_value(file, "palmar");
    if (is_writing && !is_finished()) {
      if (file.text("PRAGMA journal_mode = WAL") != "wal") {
        throw OutputError(path.string() + ": can't be written: SQLite keeps no log here");
      }
      impl_->writer = std::make_unique<StudyTableWriter>(file, impl_->plan);
    }
    return 0;
  });
}

StudyStore::~StudyStore() = default;
StudyStore::StudyStore(StudyStore&&) noexcept = default;

const fs::path& StudyStore::path() const { return impl_->path; }
const study::StudyPlan& StudyStore::plan() const { return impl_->plan; }
study::StudyShard StudyStore::shard() const { return impl_->shard; }
std::string StudyStore::program() const { return impl_->program; }

study::StudyInputs StudyStore::inputs() const {
  return impl_->read([&] {
    const StudyHead head = impl_->head();
    study::StudyInputs inputs;
    inputs.base =
        std::make_shared<const hand::Hand>(parse_hand(unpack(head.hand), impl_->path.string()));
    if (content_hash(*inputs.base) != impl_->plan.hand_hash) {
      throw InputError("the hand in it is damaged");
    }
    for (std::size_t i = 0; i < head.products.size(); ++i) {
      const study::StudyProduct& asked = impl_->plan.products[i];
      product::Product product;
      if (is_made_again(asked)) {
        product = make_solid(made_from(asked.file), {.size = asked.size});  // its distance is exact
      } else {
        product.mesh = mesh_from_bytes(unpack(head.products[i]));
        product.distance = std::make_shared<const geometry::MeshDistance>(product.mesh);
        product.source = asked.file;
        if (!head.faces[i].empty()) {
          product.faces = std::make_shared<const product::ProductFaces>(
              faces_from_bytes(unpack(head.faces[i]), product.mesh.triangle_count(),
                               "what it says of the faces of product \"" + asked.name + "\""));
        }
      }
      if (content_hash(product.mesh) != asked.content_hash) {
        throw InputError("product \"" + asked.name + "\" in it is damaged");
      }
      product.name = asked.name;
      inputs.products.push_back(std::move(product));
    }
    return inputs;
  });
}

std::vector<std::int64_t> StudyStore::done() const {
  return impl_->read([&] { return impl_->done(); });
}

std::vector<std::int64_t> StudyStore::missing() const {
  const std::vector<std::int64_t> all = study::tasks_of(impl_->plan, impl_->shard);
  const std::vector<std::int64_t> done_ones = done();
  std::vector<std::int64_t> rest;
  std::set_difference(all.begin(), all.end(), done_ones.begin(), done_ones.end(),
                      std::back_inserter(rest));
  return rest;
}

void StudyStore::for_each(bool with_fields,
                          const std::function<void(const study::StudyRecord&)>& visit) const {
  std::unique_ptr<StudyTableReader> reader;
  impl_->read([&] {
    reader = std::make_unique<StudyTableReader>(*impl_->file, with_fields);
    return 0;
  });
  if (!with_fields) {
    study::StudyRecord record;
    while (impl_->read([&] { return reader->next(record); })) visit(record);
    return;
  }
  // Unpacking is most of it, and goes on all threads.
  std::vector<study::StudyRecord> records(kReadAhead);
  std::vector<PackedFields> packed(kReadAhead);
  for (int count = kReadAhead; count == kReadAhead;) {
    impl_->read([&] {
      for (count = 0; count < kReadAhead; ++count) {
        if (!reader->next(records[count], packed[count])) break;
      }
      parallel_for(count, [&](int i) { unpack_fields(packed[i], records[i]); });
      return 0;
    });
    for (int i = 0; i < count; ++i) visit(records[i]);
  }
}

study::StudyRecord StudyStore::record(std::int64_t number) const {
  return impl_->read([&] {
    StudyTableReader reader(*impl_->file, true, number);
    study::StudyRecord found;
    if (!reader.next(found)) {
      throw UsageError(impl_->path.string() + ": grasp " + std::to_string(number) +
                       " is not in it (not finished, or no such number)");
    }
    return found;
  });
}

void StudyStore::keep(const study::StudyRecord& record) {
  if (impl_->writer == nullptr) {
    throw UsageError(impl_->path.string() + ": is not open for more grasps");
  }
  guarded(impl_->path, true, [&] {
    SqliteFile& file = *impl_->file;
    file.run("BEGIN");
    try {
      impl_->writer->write(record);
      impl_->writer->write_time(record);
      file.run("COMMIT");
    } catch (const SqliteFailure& failure) {
      if (sqlite3_get_autocommit(file.handle()) == 0) file.run("ROLLBACK");
      if (failure.code == SQLITE_CONSTRAINT) {
        throw UsageError(impl_->path.string() + ": grasp " + std::to_string(record.number) +
                         " can't be kept (" + failure.what() + ")");
      }
      throw;
    }
    return 0;
  });
}

void StudyStore::finish() {
  if (is_finished()) return;
  const std::size_t rest = missing().size();
  if (rest > 0) {
    throw UsageError(impl_->path.string() + ": " + std::to_string(rest) +
                     " grasps are missing; it can't be finished");
  }
  if (impl_->access != StudyAccess::kWrite) {
    throw UsageError(impl_->path.string() + ": is open for reading only");
  }
  Draft draft{beside(impl_->path, ".finishing")};
  write_draft(impl_->path, draft, [&] {
    build_store(draft.path, impl_->head(), true, [&](StudyTableWriter& writer) {
      StudyTableReader reader(*impl_->file, true);
      study::StudyRecord record;
      PackedFields fields;
      while (reader.next(record, fields)) {
        unpack_fields(fields, record);
        writer.write(record, fields);
      }
    });
  });
  guarded(impl_->path, true, [&] {
    // The log goes before the file is replaced: it would not fit the new one.
    impl_->writer.reset();
    impl_->file->run("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
    std::error_code error;
    fs::rename(draft.path, impl_->path, error);
    if (error) {
      throw OutputError(impl_->path.string() + ": can't be written: " + error.message());
    }
    draft.is_kept = true;
    sync_folder(impl_->path);
    impl_->file.reset();  // gives up the lock on the old file
    impl_->file = open_store(impl_->path, impl_->access);
    return 0;
  });
}

bool StudyStore::is_finished() const { return !digest().empty(); }

std::string StudyStore::digest() const {
  return impl_->read([&] { return study_value(*impl_->file, "digest"); });
}

std::string sqlite_version() { return sqlite3_libversion(); }

std::string content_hash(const geometry::TriangleMesh& mesh) {
  return formats::sha256_hex(mesh_bytes(mesh));
}

std::string content_hash(const hand::Hand& hand) { return formats::sha256_hex(format_hand(hand)); }

void merge_studies(const std::vector<fs::path>& shards, const fs::path& out,
                   const Progress& progress) {
  if (shards.empty()) throw UsageError("merge: no shard was given");
  if (fs::exists(out)) throw OutputError(out.string() + ": is there already");
  std::vector<StudyStore> stores;
  for (const fs::path& path : shards) {
    stores.emplace_back(path);
    const StudyStore& store = stores.back();
    const StudyStore& first = stores.front();
    const std::string name = path.string();
    if (!store.is_finished()) {
      const std::size_t rest = store.missing().size();
      throw UsageError(name + ": shard " + name_of(store.shard()) + " is not finished (" +
                       std::to_string(rest) + " grasps are missing); `palmar study resume " + name +
                       "` continues with it");
    }
    const std::vector<std::string> differences = plan_differences(first.plan(), store.plan());
    if (!differences.empty()) {
      throw UsageError(name + ": is of another study than " + first.path().string() + ": " +
                       differences.front());
    }
    if (store.program() != first.program()) {
      throw UsageError(name + ": was run by Palmar " + store.program() + ", " +
                       first.path().string() + " by " + first.program());
    }
    if (store.shard().n != first.shard().n) {
      throw UsageError(name + ": is shard " + name_of(store.shard()) + ", " +
                       first.path().string() + " is shard " + name_of(first.shard()));
    }
  }
  const int count = stores.front().shard().n;
  std::vector<const StudyStore*> by_number(count, nullptr);
  for (const StudyStore& store : stores) {
    const StudyStore*& place = by_number[store.shard().k - 1];
    if (place != nullptr) {
      throw UsageError(store.path().string() + " and " + place->path().string() +
                       " are both shard " + name_of(store.shard()));
    }
    place = &store;
  }
  std::string absent;
  for (int k = 1; k <= count; ++k) {
    if (by_number[k - 1] != nullptr) continue;
    absent += (absent.empty() ? "" : ", ") + name_of(study::StudyShard{k, count});
  }
  if (!absent.empty()) {
    throw UsageError("merge: missing " + absent + " of the study \"" + stores.front().plan().name +
                     "\"");
  }

  const StudyStore::Impl& first = by_number.front()->impl();
  StudyHead head = first.read([&] { return first.head(); });
  head.shard = {};
  Draft draft{beside(out, "." + std::to_string(::getpid()) + ".new")};
  write_draft(out, draft, [&] {
    build_store(draft.path, head, true, [&](StudyTableWriter& writer) {
      std::vector<std::unique_ptr<StudyTableReader>> readers;
      std::vector<study::StudyRecord> next(stores.size());
      std::vector<bool> has_next;
      for (const StudyStore& store : stores) {
        readers.push_back(std::make_unique<StudyTableReader>(*store.impl().file, true));
      }
      const auto advance = [&](std::size_t i) {
        return stores[i].impl().read([&] { return readers[i]->next(next[i]); });
      };
      for (std::size_t i = 0; i < stores.size(); ++i) has_next.push_back(advance(i));
      const std::int64_t total = study::task_count(head.plan);
      for (std::int64_t done = 0; done < total; ++done) {
        std::size_t least = stores.size();
        for (std::size_t i = 0; i < stores.size(); ++i) {
          if (!has_next[i]) continue;
          if (least == stores.size() || next[i].number < next[least].number) least = i;
        }
        if (least == stores.size()) throw InputError("merge: grasps are missing");
        writer.write(next[least]);
        has_next[least] = advance(least);
        progress.update(static_cast<double>(done + 1) / static_cast<double>(total),
                        "joining shards");
      }
    });
  });
  publish_new(draft, out);
}

}  // namespace palmar::records
