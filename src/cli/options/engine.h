#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/progress.h"
#include "study/engines/engine_run.h"

namespace faba::cli {

/// Options that determine where the simulations of a study run.
struct EngineOptions {
  std::string engine;            ///< name, or TOML file; empty: in this process
  std::vector<std::string> set;  ///< KEY=VALUE
  std::string scheduler;
  std::vector<std::string> hosts;
  int workers = 0;
};

/// Adds --engine, --engine-set, --workers, --scheduler and --sshlogin.
void add_engine_options(CLI::App* v, EngineOptions& o);

/// The settings of the options, of which --engine is given. Throws Error(usage), also for an option that the
/// engine does not have.
EngineSettings settings_of(const EngineOptions& o);
/// Throws Error(usage) for options that settings_of() refuses, and for those that need --engine without it.
void check_engine(const EngineOptions& o);

/// The options as words of a command: "--engine", "slurm", "--workers", "3".
std::vector<std::string> engine_words(const EngineOptions& o);

/// Starts the engine of the options for the first round that is computed, with one progress bar.
class EngineStart {
 public:
  EngineStart(EngineOptions options, const std::filesystem::path& dir, std::string study_hash,
              const Common& c);
  bool operator()(const Round& round, ResultStore& store);

 private:
  EngineOptions options_;
  std::filesystem::path dir_;
  std::string study_hash_;
  bool quiet_;
  Progress bar_;
  std::unique_ptr<EngineRun> run_;
};

}  // namespace faba::cli
