// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/job_shelf.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/child_process.h"
#include "palmar/formats/text_scan.h"
#include "palmar/server/access.h"
#include "palmar/server/job_file.h"
#include "palmar/server/upload_drawer.h"

namespace palmar::server {
namespace {

constexpr int kJobNiceness = 10;                     // our choice: the live channel comes first
constexpr double kLongestJob = 30.0 * 24 * 3600;     // s
constexpr double kJobMemory = 1e6, kJobFiles = 1e6;  // MB; studies need what they need
constexpr const char* kJobLog = "log.txt";
constexpr const char* kJobSources = "sources";
constexpr const char* kQuickFound = "quick.json";  // what `palmar hand quick` says

std::string new_job_key(const std::vector<Job>& jobs) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  std::int64_t stamp = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
  const auto is_taken = [&](const std::string& key) {
    return std::any_of(jobs.begin(), jobs.end(), [&](const Job& one) { return one.key == key; });
  };
  while (is_taken("j" + std::to_string(stamp))) ++stamp;
  return "j" + std::to_string(stamp);
}

std::string title_of_products(const std::vector<ShelvedProduct>& products) {
  std::string title;
  for (const ShelvedProduct& one : products) {
    title += (title.empty() ? "" : ", ") + std::filesystem::path(one.file_name).stem().string();
  }
  return title;
}

std::string title_of_hand(const JobRequest& request) {
  return request.hand.name.empty() ? "hand" : request.hand.name;
}

/// Only one unit can be said on a command line, for the files that carry none.
std::optional<geometry::LengthUnit> one_unit_of(const std::vector<ShelvedProduct>& products) {
  std::optional<geometry::LengthUnit> unit;
  for (const ShelvedProduct& one : products) {
    if (!one.unit) continue;
    if (unit && *unit != *one.unit) {
      throw UsageError("the products are in different units (" + name_of(*unit) + ", " +
                       name_of(*one.unit) + "); convert one of them (palmar product convert)");
    }
    unit = one.unit;
  }
  return unit;
}

/// What the program said last, without its name in front.
std::string last_words(const std::filesystem::path& log) {
  constexpr std::string_view kSaid = "palmar: ";
  try {
    const std::string text = formats::read_file(log);
    const std::size_t begin = text.rfind("\npalmar: ");
    std::string words = begin == std::string::npos ? text : text.substr(begin + 1);
    if (words.starts_with(kSaid)) words.erase(0, kSaid.size());
    while (!words.empty() && words.back() == '\n') words.pop_back();
    return words;
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

std::string_view name_of(JobState state) {
  switch (state) {
    case JobState::kEstimating:
      return "estimating";
    case JobState::kNew:
      return "new";
    case JobState::kWaiting:
      return "waiting";
    case JobState::kRunning:
      return "running";
    case JobState::kStopped:
      return "stopped";
    case JobState::kFailed:
      return "failed";
    case JobState::kDone:
      return "done";
  }
  return {};
}

JobShelf::JobShelf(std::optional<std::filesystem::path> folder, std::filesystem::path program)
    : folder_(std::move(folder)), program_(std::move(program)) {
  load();
  thread_ = std::thread([this] { run(); });
}

JobShelf::~JobShelf() {
  {
    const std::scoped_lock lock(mutex_);
    is_stopping_ = true;
    cancel_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

void JobShelf::load() {
  if (!folder_) return;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(*folder_, error)) {
    const std::string key = entry.path().filename().string();
    if (!is_plain_name(key)) continue;
    auto job = read_job(entry.path());
    if (!job) continue;
    job->key = key;
    const bool was_running = job->state == JobState::kRunning || job->state == JobState::kWaiting;
    if (was_running) job->state = JobState::kStopped;
    if (job->state == JobState::kEstimating) job->state = JobState::kNew;
    look(*job);
    jobs_.push_back(std::move(*job));
  }
}

void JobShelf::look(Job& job) const {
  job.has_report = std::filesystem::exists(report(job));
  job.has_preview = false;
  for (const char* shape : {"/pressed.stl", "/redesign.stl", "/region.ply"}) {
    job.has_preview = job.has_preview || made_file(job, kJobPreview + std::string(shape));
  }
  job.has_hand =
      job.request.kind == JobKind::kHand && std::filesystem::is_regular_file(hand_place(job));
}

std::filesystem::path JobShelf::hand_place(const Job& job) const {
  return place(job.key) / hand_result(job.request.hand, places(job).sources);
}

JobPlaces JobShelf::places(const Job& job) const {
  JobPlaces places;
  if (job.request.kind == JobKind::kHand) {
    const std::filesystem::path sources = place(job.key) / kJobSources;
    for (const std::string& one : hand_sources(job.request.hand.method, files_under(sources))) {
      if (!job.request.hand.uploads.empty()) {
        places.sources.push_back((one.empty() ? sources : sources / one).string());
      }
    }
  }
  places.hand = own_hand_of(job.request);
  for (const ShelvedProduct& one : job.products) places.products.push_back(one.path.string());
  places.unit = one_unit_of(job.products);
  places.folder = place(job.key).string() + "/";
  return places;
}

std::string JobShelf::own_hand_of(const JobRequest& request) const {
  if (request.own_hand.empty()) return {};
  for (const Job& other : jobs_) {
    if (other.key == request.own_hand && other.has_hand) return hand_place(other).string();
  }
  throw UsageError("hand " + formats::in_quotes(request.own_hand) + " is not there (any more)");
}

JobPlaces JobShelf::locked_places(const Job& job) const {
  const std::scoped_lock lock(mutex_);
  return places(job);
}

Job JobShelf::add(const JobRequest& request, const std::vector<ShelvedProduct>& products,
                  const std::filesystem::path& sources) {
  if (!folder_) throw OutputError("neither XDG_DATA_HOME nor HOME says where to keep results");
  const std::scoped_lock lock(mutex_);
  if (jobs_.size() >= kMost) {
    throw UsageError("there are " + std::to_string(kMost) +
                     " studies, comparisons, redesigns and hands; "
                     "remove one first");
  }
  Job job;
  job.request = request;
  job.title = title_of_products(products);
  job.key = new_job_key(jobs_);
  job.created = std::stoll(job.key.substr(1));
  one_unit_of(products);  // refused before anything is copied
  own_hand_of(request);
  for (std::size_t p = 0; p < products.size(); ++p) {
    ShelvedProduct copy = products[p];
    copy.product = nullptr;
    // Two may have one name: each in a folder of its own.
    copy.path = place(job.key) / "products" / std::to_string(p + 1) / copy.file_name;
    formats::create_folder(copy.path.parent_path());
    formats::write_file(copy.path, formats::read_file(products[p].path));
    job.products.push_back(std::move(copy));
  }
  if (request.kind == JobKind::kHand) {
    job.title = title_of_hand(request);
    try {
      if (!sources.empty()) take_sources(job, sources);
    } catch (const Error&) {
      remove_place(job.key);
      throw;
    }
  }
  job.commands = shown_commands(job);
  job.state = is_tried_first(request) ? JobState::kEstimating : JobState::kWaiting;
  save(job);
  jobs_.push_back(job);
  queue_.push_back(job.key);
  woken_.notify_all();
  return job;
}

void JobShelf::take_sources(Job& job, const std::filesystem::path& sources) const {
  const std::filesystem::path own = place(job.key) / kJobSources;
  HandRequest& hand = job.request.hand;
  formats::create_folder(place(job.key));
  std::error_code error;
  std::filesystem::copy(sources, own, std::filesystem::copy_options::recursive, error);
  if (error) throw OutputError(place(job.key).string() + ": " + error.message());
  if (hand.method != HandMethod::kFile) {
    if (const auto known = known_source(files_under(own))) {
      const std::string text = formats::read_file(own / *known, records::kMostPersonBytes);
      hand.known = records::merged(records::parse_person(text, *known), hand.known);
      job.request = parse_job_request(job_request_json(job.request));  // as it is read again
      std::filesystem::remove(own / *known, error);
    }
  }
  const bool is_of_measures = hand.method == HandMethod::kQuick && !hand.known.sizes.empty();
  if (!is_of_measures && hand_sources(hand.method, files_under(own)).empty()) {
    throw UsageError("hand: none of the files that were sent is one that " + name_of(hand.method) +
                     " takes");
  }
}

std::vector<std::string> JobShelf::shown_commands(const Job& job) const {
  JobPlaces shown = places(job);
  const std::filesystem::path sources = place(job.key) / kJobSources;
  for (std::string& one : shown.sources) {
    const auto inside = std::filesystem::path(one).lexically_relative(sources);
    one = inside == "." ? job.title : inside.generic_string();
  }
  shown.folder.clear();
  shown.products.clear();
  for (const ShelvedProduct& one : job.products) shown.products.push_back(one.argument);
  std::vector<std::string> commands;
  for (const JobCommand& one : commands_of(job.request, shown)) {
    commands.push_back(command_text(one));
  }
  return commands;
}

void JobShelf::write_known(const Job& job) const {
  const std::filesystem::path path = place(job.key) / kHandKnown;
  const records::PersonFile& known = job.request.hand.known;
  std::error_code ignored;
  if (known.is_empty()) {
    std::filesystem::remove(path, ignored);
  } else {
    formats::write_file(path, records::format_person(known));
  }
}

std::vector<Job> JobShelf::list() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Job> all = jobs_;
  std::sort(all.begin(), all.end(), [](const Job& a, const Job& b) {
    return std::pair(b.created, a.key) < std::pair(a.created, b.key);
  });
  return all;
}

std::optional<Job> JobShelf::find(const std::string& key) const {
  const std::scoped_lock lock(mutex_);
  for (const Job& one : jobs_) {
    if (one.key == key) return one;
  }
  return std::nullopt;
}

Job* JobShelf::at(const std::string& key) {
  for (Job& one : jobs_) {
    if (one.key == key) return &one;
  }
  throw UsageError("job " + formats::in_quotes(key) + " is not there (any more)");
}

void JobShelf::save(const Job& job) const { write_job(place(job.key), job); }

void JobShelf::start(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  Job* const job = at(key);
  if (job->state == JobState::kWaiting || job->state == JobState::kRunning ||
      job->state == JobState::kDone) {
    return;
  }
  // While it is estimated the estimate is given up.
  if (running_ == key) cancel_ = true;
  job->state = JobState::kWaiting;
  job->message.clear();
  save(*job);
  std::erase(queue_, key);
  queue_.push_back(key);
  woken_.notify_all();
}

void JobShelf::revise(const std::string& key, const JobRequest& request) {
  const std::scoped_lock lock(mutex_);
  Job* const job = at(key);
  const HandRequest& before = job->request.hand;
  if (request.kind != JobKind::kHand || job->request.kind != JobKind::kHand ||
      request.hand.method != before.method || request.hand.uploads != before.uploads) {
    throw UsageError("job " + formats::in_quotes(key) +
                     ": only a hand's settings and corrections can be new");
  }
  if (running_ == key || job->state == JobState::kWaiting) {
    throw UsageError("job " + formats::in_quotes(key) + " is running; stop it first");
  }
  job->request = request;
  job->title = title_of_hand(request);
  job->commands = shown_commands(*job);
  job->state = JobState::kWaiting;
  job->message.clear();
  save(*job);
  queue_.push_back(key);
  woken_.notify_all();
}

void JobShelf::cancel(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  Job* const job = at(key);
  if (running_ == key) {
    cancel_ = true;  // its thread says that it has stopped
    return;
  }
  if (job->state != JobState::kWaiting) return;
  std::erase(queue_, key);
  job->state = JobState::kStopped;
  save(*job);
}

void JobShelf::remove(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  const Job* const job = at(key);
  if (running_ == key)
    throw UsageError("job " + formats::in_quotes(key) + " is running; stop it first");
  std::erase(queue_, key);
  remove_place(job->key);
  std::erase_if(jobs_, [&](const Job& one) { return one.key == key; });
}

void JobShelf::remove_place(const std::string& key) const {
  std::error_code ignored;
  // Without it the folder counts for nothing, whatever happens to the rest.
  std::filesystem::remove(place(key) / kJobJson, ignored);
  std::filesystem::remove_all(place(key), ignored);
}

std::vector<std::string> JobShelf::made(const Job& job) const {
  const char* const folder = job.request.kind == JobKind::kHand       ? kHandFound
                             : job.request.kind == JobKind::kRedesign ? kJobPreview
                                                                      : nullptr;
  std::vector<std::string> names;
  if (folder == nullptr) return names;
  for (const std::string& one : files_under(place(job.key) / folder)) {
    names.push_back(std::string(folder) + "/" + one);
  }
  return names;
}

std::optional<std::filesystem::path> JobShelf::made_file(const Job& job,
                                                         const std::string& name) const {
  const std::vector<std::string> names = made(job);
  if (std::find(names.begin(), names.end(), name) == names.end()) return std::nullopt;
  return place(job.key) / name;
}

std::optional<std::filesystem::path> JobShelf::hand_file(const std::string& key) const {
  const auto job = find(key);
  if (!job || !job->has_hand) return std::nullopt;
  return hand_place(*job);
}

std::vector<std::string> JobShelf::files(const Job& job) const {
  std::vector<std::string> names;
  std::error_code error;
  const std::filesystem::path folder = place(job.key) / job_results(job.request.kind);
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) names.push_back(entry.path().filename().string());
  }
  if (job.request.kind == JobKind::kStudy && std::filesystem::exists(store(job))) {
    names.emplace_back(kJobStore);
  }
  if (job.request.kind == JobKind::kHand && std::filesystem::exists(place(job.key) / kHandKnown)) {
    names.emplace_back(kHandKnown);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<std::filesystem::path> JobShelf::file(const Job& job, const std::string& name) const {
  const std::vector<std::string> names = files(job);
  if (std::find(names.begin(), names.end(), name) == names.end()) return std::nullopt;
  if (name == kJobStore) return store(job);
  if (name == kHandKnown) return place(job.key) / kHandKnown;
  return place(job.key) / job_results(job.request.kind) / name;
}

std::filesystem::path JobShelf::report(const Job& job) const {
  return place(job.key) / job_report(job.request.kind);
}

std::filesystem::path JobShelf::store(const Job& job) const { return place(job.key) / kJobStore; }

// --- the thread

void JobShelf::run() {
  // Of this thread alone, and what it starts.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kJobNiceness);
  while (true) {
    std::string key;
    {
      std::unique_lock lock(mutex_);
      running_.clear();
      woken_.wait(lock, [this] { return is_stopping_ || !queue_.empty(); });
      if (is_stopping_) return;
      key = queue_.front();
      queue_.pop_front();
      running_ = key;
      cancel_ = false;
    }
    try {
      work(key);
    } catch (const std::exception& error) {
      change(key, JobState::kFailed, error.what());
    }
  }
}

void JobShelf::change(const std::string& key, JobState state, const std::string& message) {
  const std::scoped_lock lock(mutex_);
  Job* const job = at(key);
  if (state != JobState::kRunning && running_ == key) running_.clear();  // it may be removed
  job->state = state;
  job->message = message;
  job->share = 0.0;
  job->doing.clear();
  if (state == JobState::kDone || state == JobState::kNew) look(*job);
  try {
    save(*job);
  } catch (const Error& error) {  // a full disk, say
    job->message = error.what();
  }
}

void JobShelf::work(const std::string& key) {
  const std::optional<Job> job = find(key);
  if (!job) return;
  if (job->state == JobState::kEstimating) return estimate(*job);
  change(key, JobState::kRunning);
  const bool is_hand = job->request.kind == JobKind::kHand;
  if (is_hand) {  // it goes on from what earlier runs made
    formats::create_folder(place(key) / kHandFound);
    write_known(*job);
  } else if (job->request.kind !=
             JobKind::kStudy) {  // half of what an earlier run made is of no use
    std::error_code ignored;
    std::filesystem::remove_all(place(key) / job_results(job->request.kind), ignored);
  }
  double from = 0.0;
  std::string said;
  for (const JobCommand& command : commands_of(job->request, locked_places(*job))) {
    const std::string error = run_command(key, command, from, is_hand ? &said : nullptr);
    if (cancel_) return change(key, JobState::kStopped);
    if (!error.empty()) return change(key, JobState::kFailed, error);
    from += command.share;
  }
  if (is_hand && job->request.hand.method == HandMethod::kQuick) {
    formats::write_file(place(key) / kHandFound / kQuickFound, said);
  }
  change(key, JobState::kDone);
}

void JobShelf::estimate(const Job& job) {
  std::string said;
  std::error_code ignored;
  std::filesystem::remove_all(place(job.key) / kJobPreview, ignored);
  const JobCommand command = estimate_of(job.request, locked_places(job));
  const std::string error = run_command(job.key, command, 0.0, &said);
  {
    const std::scoped_lock lock(mutex_);
    Job* const now = at(job.key);
    if (now->state != JobState::kEstimating) return;  // it was started meanwhile
    if (job.request.kind == JobKind::kRedesign) said.clear();
    const StudyEstimateWords words = study_estimate_in(said);
    now->estimate_seconds = words.seconds;
    now->grasps = words.grasps;
  }
  change(job.key, cancel_ || error.empty() ? JobState::kNew : JobState::kFailed,
         cancel_ ? "" : error);
}

std::string JobShelf::run_command(const std::string& key, const JobCommand& command, double from,
                                  std::string* said) {
  const std::filesystem::path log = place(key) / kJobLog;
  const auto take = [&](const std::string& line) {
    const auto progress = progress_in(line);
    if (!progress) {
      if (said != nullptr) *said += line + "\n";
      return;
    }
    const std::scoped_lock lock(mutex_);
    for (Job& one : jobs_) {
      if (one.key != key) continue;
      one.share = from + command.share * progress->share;
      one.doing = progress->doing;
    }
  };
  const formats::ChildResult result =
      formats::run_child(program_, command.words, log,
                         {.seconds = kLongestJob, .memory_mb = kJobMemory, .file_mb = kJobFiles},
                         take, [this] { return cancel_.load(); });
  if (result.end == formats::ChildResult::End::kExited && result.code == 0) return {};
  if (result.end == formats::ChildResult::End::kExited) {
    const std::string words = last_words(log);
    return words.empty() ? "it ended with code " + std::to_string(result.code) : words;
  }
  return result.end == formats::ChildResult::End::kSignal ? formats::words_of_signal(result.code)
                                                          : "it was stopped";
}

}  // namespace palmar::server
