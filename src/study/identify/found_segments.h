#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "core/vec.h"
#include "study/data/series.h"
#include "study/data/video_part.h"
#include "study/identify/statistics/episode.h"

namespace faba {

/// Detects field segments from the path of a swarm that swims back and forth along a line. A segment starts
/// when the swarm leaves one side, extrapolated from 5 % and 25 % of its path, and lasts until the next
/// segment or the end of the video. The time before the first segment is ignored. Empty when the swarm moves
/// less than `least_px`. `centroid_image`: centroid at each time, NaN where no swarm is visible.
std::vector<FieldSegment> segments_of_swarm(const std::vector<double>& t_s,
                                            const std::vector<Vec2>& centroid_image, double least_px);

/// Field segments in the field that a run recorded: intervals of at least 0.4 s with constant direction. The
/// segment at the start of the run, during which the swarm gathers, is ignored unless it is the only one.
/// `against`: cells swim against the field (south-seeking). Empty when the record has no field.
std::vector<FieldSegment> segments_of_field(const Series& record, bool against);

/// Segments of a video with motion in one direction (see motion_segments()), times in the video; frames are
/// averaged over squares of `side` px. `tick` is called after each pair of frames. Throws the errors of
/// measure_activity().
std::vector<FieldSegment> segments_of_motion(const std::filesystem::path& video, const VideoPart& part,
                                             int side, unsigned threads, const std::function<void()>& tick);

}  // namespace faba
