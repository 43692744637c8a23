#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

enum class EngineType { local, parallel, slurm, dask };

/// The table [engine]: where the simulations of a study run.
struct EngineSettings {
  EngineType type = EngineType::local;
  int workers = 0;                          ///< 0: default of the engine
  std::string scheduler;                    ///< dask: address; empty: workers on this machine
  std::vector<std::string> hosts;           ///< parallel: as --sshlogin
  std::string partition, account;           ///< slurm
  double time = 3600;                       ///< slurm: time limit of a job, s
  std::vector<std::string> options;         ///< slurm: further options of sbatch
  std::vector<std::string> environment;     ///< lines of shell before the worker
  std::string python = "/usr/bin/python3";  ///< dask: with the package distributed
  static Schema<EngineSettings> schema();
};

/// The name of an engine.
std::string engine_name(EngineType type);

/// JSON Schema of a file with the table [engine].
Json engine_file_schema();

/// Settings from `engine`, the name of an engine or a TOML file with a table [engine], and from options
/// KEY=VALUE. Throws Error(usage).
EngineSettings engine_settings(const std::string& engine, const std::vector<std::string>& options);

}  // namespace faba
