#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "study/tracks/track_options.h"

namespace faba {

/// What the first pass over a video finds: all that the second one, which detects and tracks, must know.
struct TrackSurvey {
  std::int64_t frames = 0;     ///< that could be read
  double duration_s = 0;       ///< from the first to the last
  double frame_s = 1;          ///< median time between frames
  bool timed = true;           ///< false: the video states no frame rate, and times are counts of frames
  int bits = 8;                ///< of the grey scale, see VideoReader
  GrayF first;                 ///< the first frame
  float black = 0, white = 1;  ///< grey values of its 0.1 and 99.9 % quantiles
  Background background;
  bool temporal = false;    ///< the background is the median over time, else each frame's own smoothed copy
  double smoothing_px = 0;  ///< of that copy
  Polarity polarity = Polarity::dark;
  double size_px = 0;
  bool size_found = true;        ///< false: nothing stood out, size_px is a guess
  std::int64_t still_spots = 0;  ///< spots that never move: seen in the median itself
  std::int64_t spots = 0;        ///< in one frame in the middle, against the background that was chosen
  std::vector<std::string> notes;
};

/// Where spots are looked for: `drop` as Detector takes it.
DetectorOptions detector_options(const TrackOptions& o, const TrackSurvey& s,
                                 const std::optional<DropMask>& drop);

/// Makes what is not finite, as in a TIFF of floats, the median of the rest.
void make_finite(GrayF& frame);

/// Reads the whole video once, each frame averaged over squares of `side` px. `tick` is called after each.
TrackSurvey survey_tracks(const TrackOptions& o, const std::filesystem::path& video,
                          const std::function<void(std::int64_t done, std::int64_t stated)>& tick,
                          int side = 1);

}  // namespace faba
