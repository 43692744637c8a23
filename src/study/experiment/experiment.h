#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/schema.h"
#include "study/data/video_scale.h"

namespace faba {

/// Which way cells swim in a field: north-seeking cells along it, south-seeking cells against it.
enum class CellPolarity : std::size_t { unknown, north, south };

/// A sample under the microscope. Its videos have increasing air exposure times.
struct ExperimentDrop {
  std::string name, note;
  CellPolarity polarity = CellPolarity::unknown;
};

/// A field segment: a time interval of a video in which the field is constant.
struct ExperimentSegment {
  double from_s = 0, to_s = 0;
  /// In which the cells swim: counter-clockwise from the right, y up, rad.
  std::optional<double> direction;

  static Schema<ExperimentSegment> schema();
};

/// A video of a drop.
struct ExperimentVideo {
  std::string file;                       ///< relative to the folder of the experiment
  std::string drop;                       ///< name of an ExperimentDrop; may be empty
  std::optional<double> exposure_s;       ///< air exposure time before the video
  std::optional<double> reversal_s;       ///< time of the field reversal in the video
  std::optional<double> field_direction;  ///< after the reversal: counter-clockwise from the right, y up, rad
  std::optional<double> field_strength;   ///< T
  std::optional<double> from_s, to_s;     ///< part of the video that is evaluated
  std::optional<double> um_per_px;        ///< instead of that of the experiment
  std::optional<double> um_per_px_se;     ///< its standard error
  std::string um_per_px_source;           ///< see Experiment
  std::vector<ExperimentSegment> segments;  ///< in order, without overlap; empty: not stated
  std::string note;
};

/// An experiment: a folder with experiment.toml, videos and results.
struct Experiment {
  std::string title, note, objective;
  std::optional<double> um_per_px;     ///< empty: not known, and lengths are in px
  std::optional<double> um_per_px_se;  ///< its standard error; empty: not known
  /// "calibration" (picture of a ruler), "ruler" (a line that was drawn over a known length), "typed" or
  /// "metadata"; empty: not stated.
  std::string um_per_px_source;
  std::string noise;  ///< video of a dead sample, for the threshold of the flow
  std::vector<ExperimentDrop> drops;
  std::vector<ExperimentVideo> videos;
};

/// Name of the file of an experiment in its folder.
inline constexpr const char* kExperimentFile = "experiment.toml";

/// The experiment file of a path: of a folder that has one, or the file itself if it has this name. Empty for
/// any other path.
std::optional<std::filesystem::path> experiment_file(const std::filesystem::path& path);

/// Reads an experiment file. Throws Error(usage) with file, line and key. Videos need not exist.
Experiment read_experiment(const std::filesystem::path& file);
/// The same from a document.
Experiment read_experiment(const Document& d);
/// JSON Schema of an experiment file.
Json experiment_schema();

/// Path of a video: relative to the folder of the experiment file.
std::filesystem::path video_path(const std::filesystem::path& experiment_file, const ExperimentVideo& video);
/// The scale of a video, with its source; empty if it is not known.
std::optional<VideoScale> scale_of(const Experiment& e, const ExperimentVideo& video);
/// Direction in which the cells of a video swim after the reversal of the field: 0 right, 90 down in the
/// picture, degrees from 0 to 360. Empty unless the direction of the field and the polarity of the drop are
/// known.
std::optional<double> swimming_direction_deg(const Experiment& e, const ExperimentVideo& video);

}  // namespace faba
