#include "cli/options/study.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <thread>

#include "core/error.h"
#include "core/file.h"
#include "core/process/child.h"
#include "study/engines/engines.h"
#include "study/pages/provenance_output.h"
#include "study/sweep/program_version.h"
#include "study/sweep/round_planner.h"

#include <nlohmann/json.hpp>

namespace faba::cli {
namespace {

Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  Shard s;
  const auto slash = text.find('/');
  const auto number = [&](std::size_t from, std::size_t to, std::uint64_t& out) {
    const auto [end, error] = std::from_chars(text.data() + from, text.data() + to, out);
    return error == std::errc() && end == text.data() + to;
  };
  if (slash == std::string::npos || !number(0, slash, s.index) || !number(slash + 1, text.size(), s.count))
    throw Error(Errc::usage, "--shard",
                fmt::format("\"{}\" is not a shard; write INDEX/COUNT, such as 3/16", text));
  if (s.count < 1 || s.count > 1000000)
    throw Error(Errc::usage, "--shard",
                fmt::format("\"{}\" is out of range; COUNT must be between 1 and 1000000", text));
  if (s.index < 1 || s.index > s.count)
    throw Error(Errc::usage, "--shard",
                fmt::format("\"{}\" is out of range; INDEX must be between 1 and COUNT", text));
  return s;
}

std::filesystem::path out_of(const StudyOptions& v) {
  return v.out.empty() ? std::filesystem::path("runs") / v.study.stem() : v.out;
}

void print_complete(const std::filesystem::path& out, const nlohmann::ordered_json& j) {
  nlohmann::ordered_json all{{"out", out.string()}, {"complete", true}};
  all.update(j);
  fmt::print("{}\n", all.dump());
}

// Opens the directory of the study and imports the results of others.
StudyDirectory open_study(const StudyOptions& v, const StudyJob& job) {
  const std::filesystem::path out = out_of(v);
  const StudySource source = job.source();
  std::string again = shell_word(program()) + " " + source.verb;
  if (!source.file.empty()) again += " " + shell_word(v.study.string());
  for (const std::string& word : source.options) again += " " + shell_word(word);
  again += (source.file.empty() ? " --folder " : " --out ") + shell_word(out.string());
  for (const std::string& word : engine_words(v.engine)) again += " " + shell_word(word);
  StudyDirectory dir(out, job.hash(), again, v.force, source);
  dir.merge(v.merge);
  return dir;
}

// Whether the directory has the complete study; if so, reports it or, with --json, prints its NAME.json
// again.
bool report_if_complete(const StudyOptions& v, const StudyJob& job, const Common& c) {
  const std::filesystem::path out = out_of(v);
  if (v.force || !holds_complete_study(out, job.hash())) return false;
  check_merge(v.merge, job.hash());  // a wrong name is an error even if there is nothing to import
  const std::string version = version_of_study(out);
  if (version != program_version() && !version.empty() && !c.quiet)
    print_stderr(fmt::format("faba: note: {}: faba {} has computed this study, this is faba {}", out.string(),
                             version, program_version()));
  if (c.json)
    print_complete(out, nlohmann::ordered_json::parse(read_file(out / (job.report() + ".json"))));
  else if (!c.quiet)
    fmt::print("{}: this study is already complete; --force writes its pages again\n", out.string());
  return true;
}

void report_partial(const StudyOptions& v, const Common& c, const std::filesystem::path& dir) {
  if (c.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"out", dir.string()}, {"complete", false}}.dump());
  else if (!c.quiet)
    fmt::print(
        "part {} of this round is complete; its results are in {}. When the other parts are complete, run "
        "the command again with --merge and their directories, until it reports that the study is complete\n",
        v.shard, dir.string());
}

}  // namespace

void add_study_run_options(CLI::App* v, StudyOptions& o, const std::string& folder) {
  v->add_option("-o,--out", o.out,
                "Directory of the study; default: " + folder + ". An incomplete study is resumed")
      ->check(not_empty);
  v->add_option("--threads", o.threads,
                "Number of threads; default: all threads of the machine. Does not change the result")
      ->check(integers(1, 1024));
  v->add_flag("--force", o.force,
              "Replace another study in the directory, or write the pages of a complete study again");
  add_engine_options(v, o.engine);
}

void add_study_options(CLI::App* v, StudyOptions& o) {
  v->add_option("study", o.study, "Study file (TOML), or the name of an example")
      ->required()
      ->transform(or_example("studies"));
  v->add_option("--shard", o.shard,
                "Compute only this part of the simulations, such as 3/16, to use several machines")
      ->check(not_empty);
  v->add_option("--merge", o.merge, "First import the results in these directories of the same study");
  add_study_run_options(v, o, "runs/NAME");
}

SweepOptions sweep_options(const StudyOptions& v) {
  check_engine(v.engine);
  SweepOptions o;
  o.threads = v.threads;
  o.shard = shard_of(v.shard);
  o.stop = [&stop = stop_requested()] { return stop.load(); };
  if (!v.engine.engine.empty() && (!v.shard.empty() || v.threads > 0))
    throw Error(Errc::usage, "--engine",
                "cannot be combined with --shard or --threads; give the number of workers by --workers");
  return o;
}

std::optional<std::filesystem::path> run_study(StudyJob& job, const StudyOptions& v, SweepOptions options,
                                               const Common& c) {
  if (report_if_complete(v, job, c)) return {};
  StudyDirectory dir = open_study(v, job);
  const std::string cancelled = cancel_slurm_jobs(dir.path());
  if (!cancelled.empty() && !c.quiet) print_stderr("faba: note: " + cancelled);
  options.measured = dir.path() / study_files::kMeasured;
  RoundPlanner planner(dir.path());  // `faba study export` reads the rounds
  options.completed = [&planner](const Round& round, const ResultStore& store) {
    planner.plan(round, store, true);
  };
  if (!job.run(dir, std::move(options), c)) return dir.path();
  job.print(dir, c);
  return {};
}

int run_study_verb(StudyJob& job, const StudyOptions& v, const SweepOptions& options, const Common& c) {
  if (!v.shard.empty() && !c.quiet)
    print_stderr(
        "faba: note: --shard and --merge will be removed in the next version; use --engine, or faba "
        "study plan, work and collect");
  SweepOptions all = options;
  EngineStart engine(v.engine, out_of(v), job.hash(), c);
  if (!v.engine.engine.empty())
    all.elsewhere = [&](const Round& round, ResultStore& store) { return engine(round, store); };
  if (const auto dir = run_study(job, v, std::move(all), c)) report_partial(v, c, *dir);
  return 0;
}

Provenance study_provenance(const StudySource& source) {
  Provenance p;
  p.add(source.file);
  for (std::size_t i = 0; i + 1 < source.options.size(); i += 2)
    p.options.emplace_back(source.options[i], source.options[i + 1]);
  return p;
}

void finish(StudyDirectory& dir, const std::string& name, nlohmann::ordered_json j, const Provenance& p,
            unsigned threads) {
  add_provenance(j, p);
  write_file(dir.path() / (name + ".json"), j.dump(2) + "\n");
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  dir.complete({{"date", fmt::format("{:%FT%TZ}", fmt::gmtime(now))},
                {"threads", threads > 0 ? threads : std::thread::hardware_concurrency()},
                {"out", dir.path().string()}});
}

void print_study(const StudyDirectory& dir, const std::string& name) {
  print_complete(dir.path(), nlohmann::ordered_json::parse(read_file(dir.path() / (name + ".json"))));
}

}  // namespace faba::cli
