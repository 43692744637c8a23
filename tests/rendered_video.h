#pragma once
#include <cmath>
#include <filesystem>
#include <functional>
#include <vector>

#include "vision/files/video_writer.h"
#include "vision/render/microscope.h"

namespace faba {

/// A rendered video with known ground truth: parameters of the rendering and positions of the cells.
struct RenderedVideo {
  int width = 320, height = 240;  ///< px; different, to detect swapped axes
  double m_per_px = 1e-6;
  double fps = 15;
  int frames = 30;
  Circle edge{};  ///< the drop, image frame, px; radius 0: none
  MicroscopeParams microscope{};
  std::uint64_t seed = 1;
  /// Cells at time t, s; image frame, px. Their displacement during the exposure is computed from it.
  std::function<std::vector<CameraCell>(double t)> cells = [](double) { return std::vector<CameraCell>(); };
  /// Time of frame k, s; empty: k / fps. Other times are possible only with mp4.
  std::function<double(long long)> time_s = {};

  double time_of(long long frame) const { return time_s ? time_s(frame) : double(frame) / fps; }
};

/// Renders the frames of the video and calls take(frame, k) for each.
template <class Take>
void render_frames(const RenderedVideo& v, Take&& take) {
  Frame frame;
  frame.m_per_px = v.m_per_px;
  frame.width = v.width;
  frame.height = v.height;
  Pool pool(1);
  Microscope microscope(v.microscope, frame, v.edge, 1 / v.fps, v.seed);
  const double half = microscope.exposure_time() / 2;
  Gray8 picture;
  for (int k = 0; k < v.frames; ++k) {
    const double t = v.time_of(k);
    std::vector<CameraCell> cells = v.cells(t);
    const std::vector<CameraCell> open = v.cells(t - half), shut = v.cells(t + half);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells[i].dx = shut[i].x - open[i].x;
      cells[i].dy = shut[i].y - open[i].y;
    }
    microscope.render({std::uint64_t(k), t, cells}, pool, picture);
    take(std::as_const(picture), k);
  }
}

/// Renders to `path`: lossless if it ends in .avi, otherwise H.264 in mp4.
inline void write_rendered(const RenderedVideo& v, const std::filesystem::path& path) {
  const bool avi = path.extension() == ".avi";
  VideoWriter writer(path.string() + ".part", avi ? VideoFormat::lossless_avi : VideoFormat::mp4, v.width,
                     v.height, v.fps, 0, VideoPixels::grey8);
  render_frames(v, [&](const Gray8& picture, int) { writer.write(picture); });
  writer.finish(path, false, v.time_s);
}

}  // namespace faba
