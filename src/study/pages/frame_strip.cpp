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
constexpr int kMaxFrameWidth = 320;                  // px, on the page

/// The picture averaged over squares of n x n pixels.
RgbImage averaged(const RgbImage& picture, int n) {
  RgbImage out(picture.width / n, picture.height / n);
  for (int r = 0; r < out.height; ++r)
    for (int c = 0; c < out.width; ++c) {
      int red = 0, green = 0, blue = 0;
      for (int i = 0; i < n * n; ++i) {
        const Rgb p = picture.at(c * n + i % n, r * n + i / n);
        red += p.r;
        green += p.g;
        blue += p.b;
      }
      const auto mean = [&](int sum) { return std::uint8_t((sum + n * n / 2) / (n * n)); };
      out.at(c, r) = {mean(red), mean(green), mean(blue)};
    }
  return out;
}

struct Shot {
  RgbImage picture;
  double t_s = 0;
};

/// Frames at equal time intervals from a video of unknown length: every 2^k-th frame is kept, and every
/// second kept frame is dropped when the maximum number is reached.
std::vector<Shot> shots_of(const std::filesystem::path& video) {
  VideoReader reader(video);
  const int n = std::max(1, (reader.width() + kMaxFrameWidth - 1) / kMaxFrameWidth);
  std::vector<Shot> kept;
  Shot shot;  // holds the last frame after the end
  std::size_t every = 1;
  for (std::size_t frame = 0; reader.read_colours(shot.picture, shot.t_s); ++frame) {
    if (frame % every) continue;
    kept.push_back({averaged(shot.picture, n), shot.t_s});
    if (kept.size() < kMaxKept) continue;
    for (std::size_t i = 0; 2 * i < kept.size(); ++i) kept[i] = kept[2 * i];
    kept.resize(kept.size() / 2);
    every *= 2;
  }
  if (kept.empty()) return {};
  if (kept.back().t_s < shot.t_s) kept.push_back({averaged(shot.picture, n), shot.t_s});
  std::vector<Shot> chosen;
  const std::size_t count = std::min(kStripFrames, kept.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double t =
        count == 1 ? 0
                   : kept.front().t_s + (kept.back().t_s - kept.front().t_s) * double(i) / double(count - 1);
    chosen.push_back(*std::min_element(kept.begin(), kept.end(), [&](const Shot& a, const Shot& b) {
      return std::fabs(a.t_s - t) < std::fabs(b.t_s - t);
    }));
  }
  return chosen;
}

}  // namespace

std::string frame_strip(const std::filesystem::path& video) {
  std::vector<Shot> shots;
  try {
    shots = shots_of(video);
  } catch (const Error&) {
    return "";
  }
  if (shots.empty()) return "";
  std::string out = "<figure class=\"frames\">\n<h3>Frames</h3>\n<div>\n";
  for (const Shot& s : shots)
    out += fmt::format("<p>{}{}\u00A0s</p>\n",
                       inline_picture(s.picture, fmt::format("Frame at {} s", three_digits(s.t_s))),
                       three_digits(s.t_s));
  return out + "</div>\n<figcaption>Frames of the video at equal time intervals.</figcaption>\n</figure>\n";
}

}  // namespace faba
