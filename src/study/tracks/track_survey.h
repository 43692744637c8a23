#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "study/data/frame_inspector.h"
#include "study/quality/quality.h"
#include "study/tracks/track_options.h"
#include "vision/image/coding_traces.h"

namespace faba {

/// Result of the first pass over a video: input of the second pass, which detects and tracks.
struct TrackSurvey {
  std::int64_t frames = 0;     ///< number of readable frames in the part of the video
  double duration_s = 0;       ///< from the first frame to the last
  double frame_s = 1;          ///< median time between frames
  bool timed = true;           ///< false: no frame rate is stated, and times are frame counts
  int bits = 8;                ///< of the grey scale, see VideoReader
  GrayF first;                 ///< the first frame
  PixelRegion region;          ///< the searched part of the frames
  float black = 0, white = 1;  ///< 0.1 and 99.9 % quantiles of its grey values
  Background background;       ///< of the region
  bool temporal = false;       ///< the background is the temporal median, else a smoothed copy of each frame
  double smoothing_px = 0;     ///< smoothing of that copy
  Polarity polarity = Polarity::dark;
  double size_px = 0;
  CodingTraces coding;
  bool size_found = true;             ///< false: no spots were detected, size_px is the default
  std::optional<TwoSizes> two_sizes;  ///< see SpotSize; empty when the size was given
  std::int64_t stationary_spots = 0;  ///< stationary spots: detected in the median
  std::int64_t spots = 0;             ///< number of spots in the middle frame with the selected background
  std::vector<Warning> warnings;      ///< a background that changes
  std::vector<std::string> notes;
};

/// Throws Error(Errc::input): the part of the video contains no frames.
[[noreturn]] void throw_no_frames(const std::filesystem::path& video, const VideoPart& part);

/// Options for a detector in the region of the survey; `drop`, in coordinates of the frame, restricts the
/// search further.
DetectorOptions detector_options(const TrackOptions& o, const TrackSurvey& s,
                                 const std::optional<DropMask>& drop);

/// The part of a survey that does not depend on size, polarity, threshold and method for the background.
struct SurveyedFrames {
  TrackSurvey survey;  ///< without background, polarity, size and numbers of spots
  Background median;   ///< temporal median
  Background fine;     ///< spatial background of the middle frame
  GrayF middle;        ///< the middle one of the sampled frames, in the region
};

/// What a survey has to find: the input of the second pass, or also its warnings and stationary spots.
enum class SurveyScope { input, all };

/// Determines the rest of the survey for these options.
TrackSurvey survey_of(const TrackOptions& o, const SurveyedFrames& frames, Pool& pool,
                      SurveyScope scope = SurveyScope::all);

/// The first pass over a video, frame by frame.
class TrackSurveyor {
 public:
  /// Frames are averaged over squares of `side` px.
  explicit TrackSurveyor(const TrackOptions& options, int side = 1) : options_(options), side_(side) {}

  /// Takes the frames of the part.
  FrameInspector inspector();
  std::int64_t frames() const { return frames_; }

  /// The result, when all frames were taken. `bits`, `timed`: see TrackSurvey. There must be at least one
  /// frame.
  TrackSurvey result(int bits, bool timed, Pool& pool, SurveyScope scope = SurveyScope::all) const;
  /// The part of it that does not depend on the options for spots.
  SurveyedFrames surveyed(int bits, bool timed, Pool& pool) const;

 private:
  bool needs(double t_s);
  void take(const GrayF& frame);

  TrackOptions options_;
  int side_;
  BackgroundSampler sampler_;
  GrayF first_;
  PixelRegion region_;
  std::vector<double> gaps_;
  std::int64_t frames_ = 0;
  double first_s_ = 0, last_s_ = 0;
};

/// The region of the options in frames of this size. Throws Error(Errc::usage) for a region that is not
/// inside of them, or with fewer than 16 px on a side: smaller ones have no room for a spot and its
/// surroundings.
PixelRegion searched_region(const TrackOptions& o, int width, int height);

/// Replaces values that are not finite, as in a TIFF of floats, by the median of the others.
void make_finite(GrayF& frame);

/// Reads the part of the video once, see TrackSurveyor. `tick` is called after each frame.
TrackSurvey survey_tracks(const TrackOptions& o, const std::filesystem::path& video,
                          const std::function<void(std::int64_t done, std::int64_t stated)>& tick,
                          int side = 1);

}  // namespace faba
