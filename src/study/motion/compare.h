#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/data/flow_source.h"
#include "study/motion/flow_histograms.h"
#include "study/stats/statistics.h"

namespace faba {

/// What `faba compare` is asked for (theory A17, A18).
struct CompareJob {
  std::filesystem::path reference;
  std::vector<std::filesystem::path> runs;  ///< videos, run directories or files of flows
  std::optional<double> direction_deg;      ///< of the response; found in the reference when empty
  std::optional<double> flow_threshold_px;  ///< found in the reference when empty
  std::optional<double> reference_t0_s,
      t0_s;           ///< first frame after the reversal in the reference and in the runs; found when empty
  bool align = true;  ///< false: all begin at their first frame
  double duration_s = 1e9;        ///< compared from there on
  double m = 0.9, threshold = 3;  ///< of the Quadratic-Chi distance; the threshold in bins
  FlowRegistry::PartType method;
  int shrink = 0;                 ///< see FlowSourceOptions
  double fps = 0;                 ///< see FlowSourceOptions
  std::string options_text = {};  ///< see FlowSourceOptions
  unsigned threads = 0;
  bool simulate_floor =
      true;  ///< run a run's scenario once more with another seed, when no two runs tell the floor
  std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)> progress =
      [](auto&, auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// Distances frame by frame, and what they come to.
struct DistanceSeries {
  std::vector<double> t_s;            ///< after the alignment
  std::vector<double> value, legacy;  ///< of the signed histograms, and of the thesis's
  double mean = 0, sd = 0;            ///< of value
  LineFit line;                       ///< of value against the number of the frame
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
  double t0_s = 0;
  DistanceSeries distance;
  ComparedPair furthest;  ///< where the distance is largest
  std::vector<std::string> notes;
};

struct Comparison {
  FlowFilter filter;
  bool direction_given = false;
  double reference_t0_s = 0;
  std::string alignment;  ///< how t0 was found, in words
  std::vector<ComparedRun> runs;
  std::optional<double> floor;  ///< mean distance between runs of one scenario with different seeds
  std::string floor_from;       ///< how it was found, or why not
  DistanceSeries naive;         ///< to a video in which nothing moves
  std::vector<std::string> notes;
};

/// The mean distance of a run on a scale from 0, as good as the same scenario with another seed, to 1, no
/// better than a video in which nothing moves. Empty where the floor is not known or not below that.
std::optional<double> score_of(const Comparison& c, const ComparedRun& run);

/// Compares every run with the reference, pair of frames by pair. Throws Error(input) when sizes differ or
/// nothing overlaps, and what FlowSource throws.
Comparison compare_videos(const CompareJob& job);

}  // namespace faba
