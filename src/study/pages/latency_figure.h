#pragma once
#include <filesystem>
#include <optional>

#include "study/plot/figure.h"

namespace faba {

/// How late pictures and commands of a run on a bench were, as histograms of its latency.csv; none where
/// there is no such file. `frame_s`: time between two frames, s. Throws Error(Errc::input) for a file that is
/// damaged.
std::optional<Figure> latency_figure(const std::filesystem::path& run_dir, double frame_s);

}  // namespace faba
