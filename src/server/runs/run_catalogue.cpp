#include "server/runs/run_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "app/recording/run_lock.h"
#include "core/error.h"
#include "core/file.h"
#include "server/experiments/experiment_store.h"
#include "server/files/opened_input.h"
#include "server/runs/run_card.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr auto kMeasuring = std::chrono::milliseconds(150);  // per list; the page asks again for the rest
constexpr std::size_t kLongestShown = 80;

std::string path_of(const std::string& name) { return "runs/" + name; }
// The scenario of a recording of the live lab.
std::string scenario_beside(const std::string& name) { return "runs/" + name + ".toml"; }

}  // namespace

fs::path RunCatalogue::folder(const std::string& name) const {
  fs::path dir = workspace_.existing(path_of(name));
  std::error_code ec;
  if (name.find('/') != name.npos || !fs::is_regular_file(dir / run_files::kManifest, ec))
    throw Error(Errc::input, name.substr(0, kLongestShown), "run not found");
  return dir;
}

Json RunCatalogue::list() {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Known> known;
  std::vector<std::string> order;
  for (const std::string& name : workspace_.runs()) {
    try {
      known.emplace(name, look_at(name));
      order.push_back(name);
    } catch (const std::exception&) {
      continue;  // an invalid manifest, or a run that is being deleted, must not hide the other runs
    }
  }
  known_ = std::move(known);
  const auto until = Clock::now() + kMeasuring;
  Json all = Json::array();
  for (const std::string& name : order) {
    Json& card = known_[name].card;
    const fs::path dir = workspace_.root() / path_of(name);
    if (card["measured"] == false && Clock::now() < until) measure_run(card, dir);
    all.push_back(card);
    all.back()["writing"] = card["complete"] == false && RunLock::held(dir);
  }
  return all;
}

RunCatalogue::Known RunCatalogue::look_at(const std::string& name) {
  const fs::path dir = folder(name);
  Known run{fs::last_write_time(dir / run_files::kManifest), fs::last_write_time(dir), {}};
  const auto before = known_.find(name);
  const bool same = before != known_.end() && before->second.manifest == run.manifest &&
                    before->second.folder == run.folder;
  run.card = same ? std::move(before->second.card) : run_card(name, dir);
  return run;
}

std::uint64_t RunCatalogue::size(const std::string& name) const { return bytes_of(folder(name)); }

void RunCatalogue::check_unused(const std::string& name, const fs::path& dir) const {
  if (RunLock::held(dir))
    throw Error(Errc::usage, name, "a process is writing this run; wait until it ends or cancel it");
  for (const Job& j : jobs_.jobs()) {
    if (job_uses(j, path_of(name)) || job_uses(j, scenario_beside(name)))
      throw Error(Errc::usage, name,
                  fmt::format("the job \"{}\" uses this run; wait until it ends or cancel it", j.title));
  }
}

Trash::Item RunCatalogue::remove(const std::string& name) {
  const std::lock_guard lock(mutex_);
  check_unused(name, folder(name));
  return trash_.take(path_of(name), {scenario_beside(name)});
}

std::string RunCatalogue::rename(const std::string& name, const std::string& to) {
  const std::lock_guard lock(mutex_);
  check_unused(name, folder(name));
  const fs::path runs = workspace_.existing("runs");
  std::string wanted = safe_name(to);
  if (wanted.empty())
    throw Error(Errc::usage, "to", fmt::format("\"{}\" must have at least one letter or digit", to));
  if (wanted == name) return name;
  std::error_code ec;
  const auto used = [&] {
    return Error(Errc::usage, "to", fmt::format("the name {} is already used; choose another name", wanted));
  };
  if (fs::exists(fs::symlink_status(runs / (wanted + ".toml"), ec))) throw used();
  if (!rename_new(runs / name, runs / wanted, name)) throw used();
  if (fs::exists(runs / (name + ".toml"), ec))
    rename_new(runs / (name + ".toml"), runs / (wanted + ".toml"), scenario_beside(name));
  return wanted;
}

void RunCatalogue::set_tags(const std::string& name, const Json& asked) {
  const std::lock_guard lock(mutex_);
  const std::string tags = tags_of(asked).dump(2) + "\n";
  with_opened(folder(name), name, [&](const fs::path& dir) { write_file(dir / kTagsFile, tags); });
}

}  // namespace faba
