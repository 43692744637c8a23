#pragma once
#include <filesystem>
#include <vector>

namespace faba {

/// A histogram from a text file: one number per line; empty lines and lines that begin with '#' are ignored.
/// Throws Error(input, "file:line") for other text and negative numbers, and for a file without numbers.
std::vector<double> read_histogram(const std::filesystem::path& file);

/// Options of histogram_distances() (theory A18).
struct DistanceOptions {
  double m = 0.9;                    ///< exponent of the normalisation, [0, 1)
  double threshold = 3;              ///< of the truncated linear similarity, bins
  std::filesystem::path similarity;  ///< matrix to use instead: rows of comma-separated numbers
  bool normalise = false;            ///< normalise both histograms to a sum of 1
};
/// The Quadratic-Chi distance of the first histogram to each of the others. Throws Error(input) and
/// Error(usage).
std::vector<double> histogram_distances(const std::filesystem::path& first,
                                        const std::vector<std::filesystem::path>& others,
                                        const DistanceOptions& options);

}  // namespace faba
