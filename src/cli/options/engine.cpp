#include "cli/options/engine.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/process/installation.h"
#include "study/engines/engines.h"

namespace faba::cli {

void add_engine_options(CLI::App* v, EngineOptions& o) {
  v->add_option(
       "--engine", o.engine,
       "Where the tasks of the study run: local (processes on this machine), parallel (GNU parallel), slurm, "
       "dask, or a TOML file with a table [engine]; default: threads of this process")
      ->check(not_empty);
  v->add_option("--engine-set", o.set, "Set a value of the table [engine], such as partition=short")
      ->check(not_empty)
      ->type_name("KEY=VALUE");
  v->add_option("--workers", o.workers, "Number of workers of the engine; default: see the table [engine]")
      ->check(integers(1, 100000));
  v->add_option("--scheduler", o.scheduler, "Address of a Dask scheduler, such as tcp://node1:8786")
      ->check(not_empty);
  v->add_option("--sshlogin", o.hosts, "Host for GNU parallel, such as 4/user@pc2; may be repeated")
      ->check(not_empty);
}

EngineSettings settings_of(const EngineOptions& o) {
  EngineSettings s = engine_settings(o.engine, o.set);
  if (!o.scheduler.empty() && s.type != EngineType::dask)
    throw Error(Errc::usage, "--scheduler", "requires --engine dask");
  if (!o.hosts.empty() && s.type != EngineType::parallel)
    throw Error(Errc::usage, "--sshlogin", "requires --engine parallel");
  if (o.workers > 0) s.workers = o.workers;
  if (!o.scheduler.empty()) s.scheduler = o.scheduler;
  if (!o.hosts.empty()) s.hosts = o.hosts;
  return s;
}

void check_engine(const EngineOptions& o) {
  if (!o.engine.empty()) {
    (void)settings_of(o);
    return;
  }
  for (const auto& [option, given] :
       {std::pair{"--engine-set", !o.set.empty()}, std::pair{"--workers", o.workers > 0},
        std::pair{"--scheduler", !o.scheduler.empty()}, std::pair{"--sshlogin", !o.hosts.empty()}})
    if (given) throw Error(Errc::usage, option, "requires --engine, such as --engine local");
}

std::vector<std::string> engine_words(const EngineOptions& o) {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (!o.engine.empty()) add("--engine", o.engine);
  for (const std::string& s : o.set) add("--engine-set", s);
  if (o.workers > 0) add("--workers", std::to_string(o.workers));
  if (!o.scheduler.empty()) add("--scheduler", o.scheduler);
  for (const std::string& host : o.hosts) add("--sshlogin", host);
  return words;
}

EngineStart::EngineStart(EngineOptions options, const std::filesystem::path& dir, std::string study_hash,
                         const Common& c)
    : options_(std::move(options)),
      dir_(std::filesystem::absolute(dir)),
      study_hash_(std::move(study_hash)),
      quiet_(c.quiet),
      bar_("computing", !c.quiet && !c.json) {}

bool EngineStart::operator()(const Round& round, ResultStore& store) {
  if (!run_) {
    const WorkerCommand worker{program_file("faba"), dir_, study_hash_};
    EngineRun::Reports reports;
    reports.progress = [this](std::uint64_t done, std::uint64_t total, const std::string& waiting) {
      bar_.update(done, total, waiting);
    };
    reports.stop = [&stop = stop_requested()] { return stop.load(); };
    reports.note = [this](const std::string& text) {
      bar_.clear();
      if (!quiet_) print_stderr("faba: note: " + text);
    };
    const EngineSettings settings = settings_of(options_);
    run_ = std::make_unique<EngineRun>(make_engine(settings, worker), engine_name(settings.type), dir_,
                                       std::move(reports));
  }
  const bool complete = (*run_)(round, store);
  bar_.clear();
  return complete;
}

}  // namespace faba::cli
