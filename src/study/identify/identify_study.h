#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/identify/episode_simulation.h"
#include "study/identify/free_parameter.h"

namespace faba {

/// Field that is taken when nothing is known of it, T: with it IT-1 turns at once (assumed).
inline constexpr double kDefaultFieldStrength = 1e-3;

/// A model that may explain the videos, with what of it is not known.
struct Candidate {
  Variant model;
  std::optional<double> field_strength_t;  ///< strength of the field, T; what a run recorded when empty
  std::vector<FreeParameter> free;
  /// Values of the first of them that the thesis's rule tries; the middles of five equal parts of its range
  /// when empty.
  std::vector<double> legacy_values = {};

  /// Strength of the field in a video, T: as given, as recorded, or the default.
  double field_strength_in(const ResponseVideo& v) const {
    return field_strength_t.value_or(v.field_t.value_or(kDefaultFieldStrength));
  }
};

/// What `faba identify` is asked for.
struct IdentifyStudy {
  std::string title;
  std::uint64_t seed = 1;
  Boundary boundary = Boundary::drop;
  Look look = Look::video;
  Measure measure = Measure::density;
  int simulations = 600;  ///< of each episode with each candidate
  bool legacy = false;    ///< the thesis's rule, too
  std::optional<double>
      timing_s;  ///< how well the moments are known at which the field turns, sd; 0.58 frames when empty
  Json scene = Json::object();
  std::vector<ResponseInput> videos;
  std::vector<Candidate> candidates;
};
/// Reads a study file. Everything that can be wrong without looking at a video is found here. Throws
/// Error(usage).
IdentifyStudy read_identify_study(const std::filesystem::path& file);
/// JSON Schema of a study file.
Json identify_study_schema();
/// Hash of all that the result depends on, with what is in the videos.
std::string study_hash(const IdentifyStudy& study);

}  // namespace faba
