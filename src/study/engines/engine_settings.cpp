#include "study/engines/engine_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/error.h"
#include "core/toml.h"

namespace faba {
namespace {

constexpr std::array kEngines = {"local", "parallel", "slurm", "dask"};

// Engines that use a key; all others are for every engine.
const std::map<std::string, std::vector<EngineType>>& engines_of_keys() {
  using enum EngineType;
  static const std::map<std::string, std::vector<EngineType>> all{
      {"scheduler", {dask}},  {"hosts", {parallel}},
      {"partition", {slurm}}, {"account", {slurm}},
      {"time", {slurm}},      {"options", {slurm}},
      {"python", {dask}},     {"environment", {slurm, parallel}}};
  return all;
}

// A file can have settings of several engines; an option is for the engine of the command.
void check_use(const std::string& option, EngineType type) {
  const auto it = engines_of_keys().find(option.substr(0, option.find_first_of("=[")));
  if (it == engines_of_keys().end() || std::ranges::find(it->second, type) != it->second.end()) return;
  std::vector<std::string> names;
  for (const EngineType engine : it->second) names.push_back(engine_name(engine));
  throw Error(Errc::usage, "--engine-set",
              fmt::format("{} is not used by the engine {}, but by {}", it->first, engine_name(type),
                          fmt::join(names, " and ")));
}

}  // namespace

Schema<EngineSettings> EngineSettings::schema() {
  using E = EngineSettings;
  return Schema<E>("engine", "Where the tasks of a study run")
      .add(
          "type", &E::type,
          {.doc = "local: processes on this machine; parallel: GNU parallel; slurm: array jobs; dask: a Dask "
                  "cluster",
           .choices = {kEngines.begin(), kEngines.end()}})
      .add(
          "workers", &E::workers,
          {.min = 0,
           .max = 100000,
           .doc =
               "Number of workers; 0: all processors of the machine (local, dask without a scheduler), those "
               "of the hosts (parallel) or of the scheduler (dask), 16 (slurm)"})
      .add("scheduler", &E::scheduler,
           {.doc = "dask: address of a running scheduler, such as tcp://node1:8786; default: workers on this "
                   "machine"})
      .add("hosts", &E::hosts,
           {.doc = "parallel: hosts, as for its option --sshlogin, such as \"4/user@pc2\"; default: this "
                   "machine"})
      .add("partition", &E::partition, {.doc = "slurm: partition; default: that of the cluster"})
      .add("account", &E::account, {.doc = "slurm: account"})
      .add("time", &E::time,
           {.unit = "s",
            .min = 180,
            .max = 1e7,
            .doc = "slurm: time limit of a job; a worker is asked to end 1 to 2 min before it"})
      .add("options", &E::options, {.doc = "slurm: further options of sbatch, such as \"--mem=2G\""})
      .add("environment", &E::environment,
           {.doc = "Lines of shell before each worker, such as \"module load gcc\" (slurm, parallel)"})
      .add("python", &E::python, {.doc = "dask: Python interpreter that has the package distributed"});
}

Json engine_file_schema() {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"type", "object"},
          {"properties", {{"engine", EngineSettings::schema().json_schema()}}},
          {"required", {"engine"}}};
}

std::string engine_name(EngineType type) { return kEngines[std::size_t(type)]; }

EngineSettings engine_settings(const std::string& engine, const std::vector<std::string>& options) {
  Document d;
  if (std::find(kEngines.begin(), kEngines.end(), engine) != kEngines.end()) {
    d.name = "--engine";
    d.root["engine"]["type"] = engine;
  } else if (engine.ends_with(".toml")) {
    d = read_toml(engine);
  } else {
    const std::string near = suggestion(engine, {kEngines.begin(), kEngines.end()});
    throw Error(
        Errc::usage, "--engine",
        fmt::format("unknown engine \"{}\"; it must be one of {}, or a TOML file with a table [engine]{}",
                    engine, fmt::join(kEngines, ", "),
                    near.starts_with("; did") ? near : "; for another scheduler use `faba study`"));
  }
  for (const std::string& option : options) {
    const auto equals = option.find('=');
    if (equals == std::string::npos)
      throw Error(Errc::usage, "--engine-set",
                  fmt::format("\"{}\" has no value; write KEY=VALUE, such as partition=short", option));
    d.set("engine." + option.substr(0, equals), option.substr(equals + 1), "--engine-set");
  }
  const Node root(d);
  if (!root.has("engine"))
    throw Error(Errc::usage, engine, "has no table [engine]; write [engine] with type = \"slurm\"");
  EngineSettings s = EngineSettings::schema().parse(root.child("engine"));
  for (const std::string& option : options) check_use(option, s.type);
  return s;
}

}  // namespace faba
