#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/run/live_run.h"
#include "app/sinks/series_row.h"
#include "server/frame_message.h"

namespace faba {

/// The run that the live lab shows, and what is kept of it for those who watch.
struct ShownRun final : Sink {
  ShownRun(const Document& document, std::uint64_t seed, const Parts& parts, Pool& pool);
  void take(const Tick& t) override;
  /// Mean speed of all cells since the frame before, m/s: what the activity of a video is a measure of.
  double mean_speed(double dt);
  /// The newest frame as a FrameMessage, with the camera's picture if `camera`.
  std::shared_ptr<const std::string> message(std::uint32_t run, bool camera);

  Document document;
  LiveRun live;
  SeriesRow row;
  std::vector<std::string> columns;
  std::vector<double> rows;  ///< the newest kRows
  double time = 0;
  std::vector<float> before_x, before_y;  ///< m, in the frame before
  PictureBox box;
  std::vector<float> field_x, field_y;  ///< where the field is shown, m, world
  int field_columns = 1, field_rows = 1;
};

}  // namespace faba
