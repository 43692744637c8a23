#pragma once
#include <filesystem>
#include <vector>

namespace faba {

/// A histogram from a text file: one number per line; empty lines and those that begin with '#' are left out.
/// Throws Error(input, "file:line") for anything else, for numbers below 0, and for a file without a number.
std::vector<double> read_histogram(const std::filesystem::path& file);

/// What `faba distance` is asked for (theory A18).
struct DistanceOptions {
  double m = 0.9;                    ///< exponent of the normalisation, [0, 1)
  double threshold = 3;              ///< of the truncated linear similarity, bins
  std::filesystem::path similarity;  ///< a matrix instead: rows of comma-separated numbers
  bool normalise = false;            ///< both histograms to a sum of 1 first: only their shapes count
};
/// The Quadratic-Chi distance of the first histogram to each of the others. Throws Error(input) and
/// Error(usage).
std::vector<double> histogram_distances(const std::filesystem::path& first,
                                        const std::vector<std::filesystem::path>& others,
                                        const DistanceOptions& options);

}  // namespace faba
