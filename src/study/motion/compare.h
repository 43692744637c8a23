#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/data/flow_source.h"
#include "study/motion/flow_histograms.h"
#include "study/quality/quality.h"
#include "study/stats/statistics.h"

namespace faba {

/// Input of compare_videos() (theory A17, A18).
struct CompareJob {
  std::filesystem::path reference;
  std::vector<std::filesystem::path> runs;  ///< videos, run directories or files of flows
  std::optional<double> direction_deg;      ///< of the response; detected in the reference when empty
  std::optional<double> flow_threshold_px;  ///< determined from the reference when empty
  std::optional<double> reference_t0_s,
      t0_s;  ///< first frame after the reversal in the reference and in the runs; detected when empty
  bool align = true;              ///< false: all start at their first frame
  double duration_s = 1e9;        ///< compared duration
  double m = 0.9, threshold = 3;  ///< exponent and threshold (bins) of the Quadratic-Chi distance
  FlowRegistry::PartType method;
  int shrink = 0;                 ///< see FlowSourceOptions
  double fps = 0;                 ///< see FlowSourceOptions
  std::string options_text = {};  ///< see FlowSourceOptions
  VideoPart part;                 ///< of the reference and of the runs, each in its own time
  unsigned threads = 0;
  bool simulate_noise_floor =
      true;  ///< repeat the scenario with another seed when only one run of it is given
  std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)> progress =
      [](auto&, auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// Distances for all pairs of frames, and their summary.
struct DistanceSeries {
  std::vector<double> t_s;            ///< after the alignment
  std::vector<double> value, legacy;  ///< distances of the signed histograms and of the thesis's
  double mean = 0, sd = 0;            ///< of value
  LineFit line;                       ///< of value against the index of the pair
  double legacy_mean = 0, legacy_sd = 0;
  LineFit legacy_line;
};

/// One pair of both videos, for pictures.
struct ComparedPair {
  double t_s = 0;
  Flow reference, run;
  FlowHistograms reference_bins, run_bins;
};

struct ComparedRun {
  std::filesystem::path file;
  VideoScale scale;
  double t0_s = 0;
  DistanceSeries distance;
  ComparedPair furthest;  ///< pair with the largest distance
  std::vector<Warning> warnings;
  std::vector<std::string> notes;
};

struct Comparison {
  FlowFilter filter;
  bool direction_given = false;
  double reference_t0_s = 0;
  std::string alignment;  ///< description of how t0 was determined
  std::vector<ComparedRun> runs;
  std::optional<double> noise_floor;  ///< mean distance between runs of one scenario with different seeds
  std::string noise_floor_from;       ///< how the noise floor was determined, or why it was not
  DistanceSeries naive;               ///< distance to a video without motion
  std::vector<Warning> warnings;
  std::vector<std::string> notes;
};

/// The warnings of the reference and of all runs; those of a run name it in the evidence.
std::vector<Warning> all_warnings(const Comparison& comparison);

/// The mean distance of a run on a scale from 0, the distance to the same scenario with another seed, to 1,
/// the distance to a video without motion. Empty when the noise floor is unknown or not below the latter.
std::optional<double> score_of(const Comparison& c, const ComparedRun& run);

/// Compares every run with the reference, pair by pair. Throws Error(input) when sizes differ or the videos
/// do not overlap, and the errors of FlowSource.
Comparison compare_videos(const CompareJob& job);

}  // namespace faba
