#pragma once
#include "study/engines/engine.h"

namespace faba {

/// The engine of the settings. Throws Error(usage) when a program that it needs is not installed.
std::unique_ptr<Engine> make_engine(const EngineSettings& settings, const WorkerCommand& worker);

// One function for each engine.
std::unique_ptr<Engine> local_engine(const EngineSettings& settings, const WorkerCommand& worker);
std::unique_ptr<Engine> parallel_engine(const EngineSettings& settings, const WorkerCommand& worker);
std::unique_ptr<Engine> slurm_engine(const EngineSettings& settings, const WorkerCommand& worker);
std::unique_ptr<Engine> dask_engine(const EngineSettings& settings, const WorkerCommand& worker);

/// Cancels the Slurm jobs that a command on the directory of a study has left in the queue, because it was
/// killed. Returns a sentence on them; empty: there are none.
std::string cancel_slurm_jobs(const std::filesystem::path& study);

}  // namespace faba
