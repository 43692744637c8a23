#pragma once
#include "core/table.h"

namespace faba {

/// What was recorded once per camera frame: named columns of equal length, one row per frame, in the order
/// written. The unit is the end of a column's name (`_px` picture pixels with y down, `_s` seconds, `_ut`
/// microtesla in the world frame with y up, `_a` ampere). NaN stands for "nothing there", for instance a
/// setpoint when there is no target.
///
/// Columns of a run's `series.csv`:
/// `frame,t_s,centroid_x_px,centroid_y_px,sigma_x_px,sigma_y_px,rms_radius_px, distance_px`, and as far as
/// the run has them `visible_count,responding_count,estimate_x_px,estimate_y_px,
/// setpoint_x_px,setpoint_y_px,field_x_ut,field_y_ut,current_0_a,current_1_a,...,limited`.
using Series = Table;

/// Reads a series.csv. A last line without its line end, as a power cut leaves it, is left out.
inline Series read_series(const std::filesystem::path& path) { return read_table(path, LastLine::drop); }

}  // namespace faba
