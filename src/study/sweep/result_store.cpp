#include "study/sweep/result_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "core/error.h"
#include "core/hash.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kResultsSuffix = ".results";
constexpr std::size_t kBlockDoubles = 1 << 16;
constexpr std::uint64_t kMostTasks = 1'000'000'000;  // of a round; more is damage

std::string host_name() {
  char name[64] = "";
  if (gethostname(name, sizeof name - 1) != 0) return "unknown";
  return name;
}

// Names of the result files in a folder without ".part", with the names they have now.
std::map<std::string, fs::path> result_files(const fs::path& folder) {
  std::map<std::string, fs::path> files;
  std::error_code missing;
  for (const auto& e : fs::directory_iterator(folder, missing)) {
    const fs::path& p = e.path();
    if (p.extension() == kResultsSuffix) files[p.filename().string()] = p;
    if (p.extension() == ".part" && p.stem().extension() == kResultsSuffix)
      files.emplace(p.stem().string(), p);
  }
  return files;
}

}  // namespace

std::uint64_t round_key(const std::string& study_hash, const Round& round) {
  Hash h;
  h.text(FABA_VERSION);
  h.text(study_hash);
  h.value(round.size);
  h.text(round.description);
  return h.result();
}

ResultStore::ResultStore(fs::path folder, std::string study_hash)
    : folder_(std::move(folder)), study_hash_(std::move(study_hash)) {
  read_new();
}

ResultStore::~ResultStore() {
  if (!own_) return;
  try {
    own_->complete();
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): the records in the .part file count as well
  }
}

std::optional<std::span<const double>> ResultStore::find(TaskId id) const {
  const auto it = rounds_.find(id.round);
  if (it == rounds_.end() || id.task >= it->second.tasks.size()) return {};
  const Values& v = it->second.tasks[id.task];
  if (!v.first) return {};
  return std::span<const double>(v.first, v.count);
}

// Values are stored in blocks, which are never moved: find() returns references to them.
double* ResultStore::keep(std::span<const double> values) {
  if (blocks_.empty() || used_ + std::max<std::size_t>(1, values.size()) > block_size_) {
    block_size_ = std::max(kBlockDoubles, values.size());
    blocks_.push_back(std::make_unique<double[]>(block_size_));
    used_ = 0;
  }
  double* at = blocks_.back().get() + used_;
  std::copy(values.begin(), values.end(), at);
  used_ += values.size();
  return at;
}

bool ResultStore::take(const TaskResult& r) {
  Results& round = rounds_[r.id.round];
  if (r.id.task >= kMostTasks)
    throw Error(Errc::input, folder_.string(), fmt::format("result of task {}: no such task", r.id.task));
  if (r.id.task >= round.tasks.size()) round.tasks.resize(std::max(r.id.task + 1, 2 * round.tasks.size()));
  Values& v = round.tasks[r.id.task];
  if (v.first) return false;
  if (!r.failure.empty()) {
    Failures& f = round.failures[r.id.task];
    ++f.attempts;
    f.what = r.failure;
    return true;
  }
  v = {keep(r.values), std::uint32_t(r.values.size())};
  round.failures.erase(r.id.task);
  round.seconds += r.seconds;
  ++round.done;
  ++size_;
  return true;
}

std::string ResultStore::own_name() const {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("{}-{}-{}{}", host_name(), getpid(),
                     std::chrono::duration_cast<std::chrono::milliseconds>(now).count(), kResultsSuffix);
}

void ResultStore::add(TaskId id, std::span<const double> values, double seconds) {
  const std::lock_guard lock(adding_);
  const TaskResult r{id, seconds, values, {}};
  if (find(id)) return;
  if (!own_ && !folder_.empty()) {
    fs::create_directories(folder_);
    own_ = std::make_unique<ResultFile>(folder_ / own_name(), study_hash_);
    files_[own_->path().filename().string()].complete = true;  // its results are known
  }
  if (own_) own_->add(r);
  take(r);
}

bool ResultStore::read_new(const std::function<void(TaskId)>& taken) {
  bool news = false;
  for (const auto& [name, now] : result_files(folder_)) {
    Reading& file = files_[name];
    if (file.complete) continue;
    const auto read = [&](const fs::path& path) {
      file.from = read_results(path, study_hash_, file.from, [&](const TaskResult& r) {
        if (!take(r)) return;
        news = true;
        if (taken && r.failure.empty()) taken(r.id);
      });
      file.complete = path.extension() != ".part";
    };
    // A worker may rename its file between the listing and the reading.
    if (std::error_code ec; fs::exists(now, ec))
      read(now);
    else if (fs::exists(folder_ / name, ec))
      read(folder_ / name);
  }
  return news;
}

void ResultStore::import(const fs::path& file) {
  const std::string content = read_file(file);
  fs::path to = folder_ / file.filename();
  if (fs::exists(to)) {
    if (read_file(to) == content) return;
    Hash h;  // another file has this name
    h.text(content);
    to = folder_ / fmt::format("{}-{}", h.hex(), file.filename().string());
  }
  // Checked first: a file of another study must not come into the folder.
  read_results(file, study_hash_, 0, [](const TaskResult&) {});
  fs::create_directories(folder_);
  write_file(to, content);
  read_new();
}

void ResultStore::merge(const fs::path& folder) {
  for (const auto& [name, file] : result_files(folder)) import(file);
}

std::map<std::uint64_t, ResultStore::Failures> ResultStore::failures(std::uint64_t round) const {
  const auto it = rounds_.find(round);
  if (it == rounds_.end()) return {};
  return it->second.failures;
}

std::optional<double> ResultStore::seconds_per_task(std::uint64_t round) const {
  double seconds = 0, done = 0;
  if (const auto it = rounds_.find(round); it != rounds_.end() && it->second.done > 0)
    return it->second.seconds / double(it->second.done);
  for (const auto& [_, r] : rounds_) {
    seconds += r.seconds;
    done += double(r.done);
  }
  if (done == 0) return {};
  return seconds / done;
}

}  // namespace faba
