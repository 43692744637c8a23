#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/identify/episode_simulation.h"
#include "study/identify/free_parameter.h"

namespace faba {

/// Default field strength, T, when it is unknown: IT-1 turns almost immediately in it (assumed).
inline constexpr double kDefaultFieldStrength = 1e-3;

/// A candidate model with its free parameters.
struct Candidate {
  Variant model;
  std::optional<double> field_strength_t;  ///< field strength, T; empty: as recorded by the run
  std::vector<FreeParameter> free;         ///< the parameters of the study, then the nuisance parameters
  /// Values of the first free parameter for the rule of the thesis; empty: the middles of five equal parts of
  /// its range.
  std::vector<double> legacy_values = {};
  /// Simulations per episode: as many as the study has, or more if the nuisance parameters need them.
  int simulations = 0;

  /// Field strength in a video, T: as given, else as recorded, else the default.
  double field_strength_in(const ResponseVideo& v) const {
    return field_strength_t.value_or(v.field_t.value_or(kDefaultFieldStrength));
  }
};

/// Configuration of `faba identify`.
struct IdentifyStudy {
  std::string title;
  std::uint64_t seed = 1;
  Boundary boundary = Boundary::drop;
  Look look = Look::video;
  Measure measure = Measure::density;
  int simulations = 600;                   ///< per episode and candidate
  bool legacy = false;                     ///< apply the rule of the thesis as well
  std::filesystem::path calibration = {};  ///< calibration.json of this study; may not exist; empty: none
  /// Standard deviation of the times of field reversals, s. Empty: 0.58 frames, or 1.5 frames for segments
  /// that are detected in the video.
  std::optional<double> timing_s;
  /// Relative standard deviations of the scale, of the field strength and of the number of cells, which each
  /// simulation samples.
  double scale_sd = 0, field_sd = 0, count_sd = 0;
  Json scene = Json::object();
  std::vector<ResponseInput> videos;
  std::vector<Candidate> candidates;
};
/// Reads a study file and checks everything that does not need the videos. Throws Error(usage), and
/// Error(input) for a video that does not exist, unless the process does not need the videos.
IdentifyStudy read_identify_study(const std::filesystem::path& file, bool needs_videos = true);
/// JSON Schema of a study file.
Json identify_study_schema();
/// Sets the digest of each video. It depends on the content and not on the path: a different video under the
/// same name is a different study, and a study under another mount point is the same.
void digest_videos(IdentifyStudy& study);
/// Sets the digests that another process computed. Throws Error(usage) if their number is wrong.
void take_digests(IdentifyStudy& study, const std::vector<std::string>& digests);
/// Hash of everything that the result depends on, with the digests of the videos.
std::string study_hash(const IdentifyStudy& study);
/// study_hash() without the seed: the design that a calibration tests.
std::string design_hash(const IdentifyStudy& study);
/// Hash of everything that the measurement of a video depends on.
std::string measurement_key(const IdentifyStudy& study, std::size_t video);

}  // namespace faba
