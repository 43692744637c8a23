#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/run/live_run.h"
#include "app/sinks/series_row.h"
#include "server/shown/frame_message.h"
#include "server/shown/row_history.h"

namespace faba {

/// The run displayed by the live lab, with the data for its messages.
struct ShownRun final : Sink {
  ShownRun(const Document& document, std::uint64_t seed, const Parts& parts, Pool& pool);
  void take(const Tick& t) override;
  /// Mean speed of all cells since the previous frame, m/s; the activity of a video is a measure of it.
  double mean_speed(double dt);
  /// The newest frame as a FrameMessage, with the camera image if `camera`; `sites` as there.
  std::shared_ptr<const std::string> message(std::uint32_t run, bool camera, int sites);

  Document document;
  LiveRun live;
  SeriesRow row;
  std::vector<std::string> columns;
  std::vector<double> rows;  ///< the newest kRows rows
  Estimate estimate;         ///< of the newest frame
  RowHistory history;        ///< for pages that connect later
  double time = 0;
  std::vector<float> before_x, before_y;  ///< m, positions in the previous frame
  PictureBox box;
  std::vector<std::size_t> ends;        ///< index of the first cell after each swarm
  std::vector<float> field_x, field_y;  ///< m, world, points of the displayed field
  int field_columns = 1, field_rows = 1;
};

}  // namespace faba
