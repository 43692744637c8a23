#pragma once
#include "server/bench/bench_console.h"
#include "server/experiments/experiment_store.h"

namespace faba {

/// Adds a recording of the bench to the experiment that it names, with what the bench knows about it; nothing
/// without an experiment. A drop of this name that the experiment does not have is added. Throws Error if the
/// experiment cannot be changed.
void keep_recording(ExperimentStore& experiments, const BenchRecording& r);

}  // namespace faba
