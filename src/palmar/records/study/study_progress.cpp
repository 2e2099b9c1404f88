// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_progress.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <system_error>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostProgressBytes = 1 << 20;

}  // namespace

std::filesystem::path progress_path(const std::filesystem::path& store) {
  return store.string() + "-progress";
}

void write_study_progress(const std::filesystem::path& store, StudyProgressNote note) {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const Json json = {{"shard", note.shard.k},
                     {"shards", note.shard.n},
                     {"done", note.done},
                     {"total", note.total},
                     {"done_before", note.done_before},
                     {"outcomes", note.outcomes},
                     {"reasons", note.reasons},
                     {"seconds", note.seconds},
                     {"updated_s", std::chrono::duration_cast<std::chrono::seconds>(now).count()},
                     {"host", host.data()},
                     {"process", ::getpid()}};
  try {
    formats::write_file(progress_path(store),
                        json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  } catch (const OutputError&) {
    return;  // the store itself says if the disk is full
  }
}

std::optional<StudyProgressNote> read_study_progress(const std::filesystem::path& store) {
  try {
    const Json json = Json::parse(formats::read_file(progress_path(store), kMostProgressBytes));
    StudyProgressNote note;
    note.shard = {json.at("shard").get<int>(), json.at("shards").get<int>()};
    note.done = json.at("done");
    note.total = json.at("total");
    note.done_before = json.at("done_before");
    note.outcomes = json.at("outcomes").get<std::map<std::string, std::int64_t>>();
    note.reasons = json.at("reasons").get<std::map<std::string, std::int64_t>>();
    note.seconds = json.at("seconds");
    note.updated = json.at("updated_s");
    note.host = json.at("host");
    note.process = json.at("process");
    return note;
  } catch (const Error&) {
    return std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void remove_study_progress(const std::filesystem::path& store) {
  std::error_code ignored;
  std::filesystem::remove(progress_path(store), ignored);
}

}  // namespace palmar::records
