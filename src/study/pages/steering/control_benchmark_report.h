#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/data/provenance.h"
#include "study/steering/control_benchmark.h"

namespace faba {

nlohmann::ordered_json control_benchmark_json(const ControlBenchmarkResult& r);
/// A page in Markdown: for each case its question, a table, the comparison with the baseline, and published
/// results. `cycles`: of this machine; may be empty.
std::string control_benchmark_markdown(const ControlBenchmarkResult& r, const std::vector<CycleTime>& cycles);
/// The same as a report with the figures of every case.
std::string control_benchmark_page(const ControlBenchmarkResult& r, const std::vector<CycleTime>& cycles,
                                   const Provenance& provenance);
/// The cycle times as CSV.
std::string cycle_times_csv(const std::vector<CycleTime>& cycles);

}  // namespace faba
