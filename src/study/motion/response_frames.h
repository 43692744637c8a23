#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "study/data/frame_inspector.h"
#include "vision/drop/circle_fit.h"
#include "vision/foreground/background.h"
#include "vision/image/image.h"

namespace faba {

/// Side above which pictures are averaged over squares, px.
inline constexpr int kLongResponseSide = 640;

/// The pictures of a part of a video in memory, averaged over squares of side() px.
class ResponsePictures {
 public:
  struct Picture {
    double t_s;
    CompactImage grey;
  };
  /// None are kept if they would need more than `most_bytes` as floats.
  explicit ResponsePictures(const VideoPart& part, std::size_t most_bytes = 256u << 20)
      : part_(part), most_bytes_(most_bytes) {}
  /// For another part of the same video, without pictures.
  ResponsePictures of(const VideoPart& part) const { return ResponsePictures(part, most_bytes_); }
  /// Takes them in a reading of the video, to its end or that of the part.
  FrameInspector inspector();

  int side() const { return side_; }
  /// Whether all pictures of this part are here, after the reading.
  bool hold(const VideoPart& part) const;
  const std::vector<Picture>& all() const { return pictures_; }

 private:
  void begin(const VideoReader& video);

  VideoPart part_;
  std::size_t most_bytes_, bytes_ = 0;  ///< of all, and of a picture
  int side_ = 1;
  bool kept_ = false;
  double t_s_ = 0;  ///< of the next picture
  std::vector<Picture> pictures_;
};

/// A part of a video as pictures of its objects: differences from an empty background, positive for objects,
/// grey levels of the video averaged over squares of side() px. Dark objects absorb a fraction of the light,
/// so that their differences are relative to the light of the background, in units of its median: a cell has
/// the same contrast on the dark edge of a drop as in its middle. Bright objects add light.
///
/// The background is the temporal median with small objects filled by line_closing(): objects that do not
/// move are not part of it, long lines such as the edge of a drop are.
class ResponseFrames {
 public:
  /// Uses `pictures` if they hold the part, otherwise reads it once into them; if they do not keep it, each()
  /// reads it again. Throws the errors of VideoReader, and what `check`, called for each frame, throws.
  ResponseFrames(std::filesystem::path video, const VideoPart& part, unsigned threads,
                 std::function<void()> check, std::shared_ptr<ResponsePictures> pictures = nullptr);

  int side() const { return pictures_->side(); }  ///< px of the video per px of the pictures
  double object_px() const { return size_; }  ///< full width at half maximum of an object, px of the pictures
  double noise() const { return noise_; }     ///< standard deviation of a pixel, grey
  std::int64_t frames() const { return frames_; }
  int width() const { return filled_.width; }                  ///< px of the pictures
  int height() const { return filled_.height; }                ///< px of the pictures
  const std::optional<Circle>& edge() const { return edge_; }  ///< of a drop, px of the pictures
  const GrayF& still() const { return still_; }                ///< the objects that do not move

  unsigned threads() const { return threads_; }  ///< that work on a video
  /// Number of pictures that are worked on, or held, at a time.
  std::size_t slots() const;
  /// Each picture of a part, which may be another one. Threads call work(slot, objects, t_s) for each; then
  /// take(slot) is called for the pictures in order, by the calling thread. Two pictures in work have
  /// different slots, below slots().
  void each(const VideoPart& part,
            const std::function<void(std::size_t slot, const GrayF& objects, double t_s)>& work,
            const std::function<void(std::size_t slot)>& take) const;

 private:
  void take(const VideoPart& part, BackgroundSampler& sampler);
  void read_all(const VideoPart& part, BackgroundSampler& sampler);
  void read(const VideoPart& part,
            const std::function<void(std::size_t slot, GrayF& frame, double t_s)>& work,
            const std::function<void(std::size_t slot)>& take) const;
  GrayF objects_in(GrayF picture) const;

  std::filesystem::path video_;
  unsigned threads_;
  std::function<void()> check_;
  std::shared_ptr<ResponsePictures> pictures_;
  std::int64_t frames_ = 0;
  double size_ = 0, noise_ = 0, sign_ = 1;
  std::optional<Circle> edge_;
  GrayF filled_;  ///< background in the sense of dark objects
  GrayF gain_;    ///< factor on the differences of dark objects; empty for bright ones
  GrayF still_;
};

}  // namespace faba
