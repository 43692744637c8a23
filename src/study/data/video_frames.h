#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/data/run_video.h"
#include "vision/files/video_reader.h"

namespace faba {

/// One frame of a video.
struct VideoFrame {
  GrayF grey;      ///< in the grey values of the file
  double t_s = 0;  ///< see VideoReader
  std::int64_t index =
      0;  ///< number of the frame; estimated from the mean rate if the frames have time stamps
};
using VideoFrameRef = std::shared_ptr<const VideoFrame>;

/// Frames of a video in any order, for display: of all files that VideoReader reads, and of run directories.
/// Going forwards by few frames reads on; other frames are found by seeking, so that the time for a frame
/// does not depend on the length of the video where the file has an index. The last frames stay in memory, so
/// that going backwards frame by frame is quick. Not thread-safe.
class VideoFrames {
 public:
  /// Throws as run_video() and VideoReader.
  explicit VideoFrames(const std::filesystem::path& path);
  explicit VideoFrames(RunVideo video);

  int width() const { return reader_->width(); }    ///< px
  int height() const { return reader_->height(); }  ///< px
  int bits() const { return reader_->bits(); }      ///< see VideoReader
  double fps() const { return reader_->fps(); }     ///< see VideoReader; 0: times are numbers of frames
  /// Number of frames according to the file, 0 if unknown.
  std::int64_t frames_stated() const { return frames_stated_; }
  const VideoScale& scale() const { return video_.scale; }
  /// Description of the damage found so far; empty: none.
  std::string damage() const;

  /// The frame displayed at `t_s`: the last one that is not after it; the first one for times before it, and
  /// the last one for times after the end.
  VideoFrameRef at(double t_s);
  /// The frame after the one that was returned last; null at the end.
  VideoFrameRef next();
  /// The last frame. The damage of a truncated file is known afterwards.
  VideoFrameRef last();
  /// Estimated memory use, bytes.
  std::size_t bytes() const;

 private:
  bool covers(double t_s) const;
  void show(double t_s);
  bool start_before(double t_s);
  bool read_until(double t_s, bool skip);
  bool read_on();
  void add_converted(double t_s);
  double last_readable(double t_s);
  void reopen();

  RunVideo video_;
  std::optional<VideoReader> reader_;
  std::int64_t frames_stated_ = 0;
  double interval_s_ = 1;            ///< mean time between two frames
  std::size_t most_known_ = 2;       ///< length of `known_`
  std::string damage_;               ///< of readers before reopen()
  std::deque<VideoFrameRef> known_;  ///< frames that follow each other; the reader is after the last one
  VideoFrameRef shown_;              ///< the frame returned last, one of `known_`
  bool ended_ = false;               ///< no frame follows the last one of `known_`
};

/// Grey values of a picture, counted in up to 256 equal intervals from `least`.
struct GreyHistogram {
  double least = 0, most = 0;
  double step = 1;                   ///< width of an interval; integers where the picture has no others
  double low = 0, high = 0;          ///< quantiles of 0.1 % and 99.9 %, for an automatic contrast
  std::vector<std::int64_t> counts;  ///< empty: no pixel is finite
};
/// Pixels that are not finite are not counted.
GreyHistogram grey_histogram(const GrayF& picture);

/// How a frame is displayed.
struct FrameLook {
  int width = 0;               ///< px, maximum; the frame is averaged over squares. 0: the size of the frame
  double low = 0, high = 255;  ///< grey values that are displayed black and white
};
Gray8 displayed_frame(const GrayF& picture, const FrameLook& look);
/// The same as a PNG file.
std::string displayed_png(const GrayF& picture, const FrameLook& look);

}  // namespace faba
