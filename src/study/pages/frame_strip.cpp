#include "study/pages/frame_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr std::size_t kStripFrames = 6;
constexpr std::size_t kMaxKept = 16 * kStripFrames;  // while the length of the video is unknown

/// Of a video whose number of frames is not stated: every 2^k-th frame is kept, and every second kept frame
/// is dropped when the maximum number is reached.
std::vector<SmallFrame> shots_of_all(VideoReader& reader) {
  std::vector<SmallFrame> kept;
  SmallFrame shot;  // holds the last frame after the end
  std::size_t every = 1;
  for (std::size_t frame = 0; reader.read_colours(shot.picture, shot.t_s); ++frame) {
    if (frame % every) continue;
    kept.push_back({small_picture(shot.picture), shot.t_s});
    if (kept.size() < kMaxKept) continue;
    for (std::size_t i = 0; 2 * i < kept.size(); ++i) kept[i] = kept[2 * i];
    kept.resize(kept.size() / 2);
    every *= 2;
  }
  if (kept.empty()) return {};
  if (kept.back().t_s < shot.t_s) kept.push_back({small_picture(shot.picture), shot.t_s});
  std::vector<SmallFrame> chosen;
  const std::size_t count = std::min(kStripFrames, kept.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double t =
        count == 1 ? 0
                   : kept.front().t_s + (kept.back().t_s - kept.front().t_s) * double(i) / double(count - 1);
    chosen.push_back(
        *std::min_element(kept.begin(), kept.end(), [&](const SmallFrame& a, const SmallFrame& b) {
          return std::fabs(a.t_s - t) < std::fabs(b.t_s - t);
        }));
  }
  return chosen;
}

/// Of a video of `seconds`: frames at about equal time intervals. A key frame is taken if it is near enough,
/// because other frames need all frames since the last key frame to be decoded.
std::vector<SmallFrame> shots_of(VideoReader& reader, double seconds) {
  constexpr double kNear = 0.2;  // of the interval
  const double interval = seconds / double(kStripFrames - 1);
  std::vector<SmallFrame> chosen;
  SmallFrame shot;
  for (std::size_t i = 0; i < kStripFrames; ++i) {
    const bool last = i + 1 == kStripFrames;
    const double t = interval * double(i), from = last ? seconds - 0.5 / reader.fps() : t - kNear * interval;
    if (i > 0 && shot.t_s >= from) continue;  // of a video with fewer frames than the strip
    reader.skip_to(t);
    bool any = false;
    while (reader.read_colours(shot.picture, shot.t_s)) {
      any = true;
      if (shot.t_s >= from) break;
    }
    if (any) chosen.push_back({small_picture(shot.picture), shot.t_s});
  }
  return chosen;
}

std::vector<SmallFrame> shots_of(const std::filesystem::path& video) {
  VideoReader reader(video);
  const std::int64_t frames = reader.frames_in_header();
  if (frames < 1 || reader.fps() <= 0) return shots_of_all(reader);
  return shots_of(reader, double(frames - 1) / reader.fps());
}

}  // namespace

std::vector<SmallFrame> strip_frames(const std::filesystem::path& video) {
  try {
    return shots_of(video);
  } catch (const Error&) {
    return {};
  }
}

std::string frame_strip(const std::vector<SmallFrame>& shots) {
  if (shots.empty()) return "";
  std::string out = "<figure class=\"frames\">\n<h3>Frames</h3>\n<div>\n";
  for (const SmallFrame& s : shots)
    out += fmt::format("<p>{}{}\u00A0s</p>\n",
                       inline_picture(s.picture, fmt::format("Frame at {} s", three_digits(s.t_s))),
                       three_digits(s.t_s));
  return out +
         "</div>\n<figcaption>Frames of the video at about equal time intervals.</figcaption>\n</figure>\n";
}

}  // namespace faba
