#pragma once
#include <filesystem>
#include <optional>

#include "study/plot/figure.h"

namespace faba {

/// Histograms of the frame and command latencies of a run on hardware, from its latency.csv; empty without
/// such a file. `frame_s`: frame period, s. Throws Error(Errc::input) for a damaged file.
std::optional<Figure> latency_figure(const std::filesystem::path& run_dir, double frame_s);

}  // namespace faba
