#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "core/vec.h"
#include "study/data/series.h"
#include "study/identify/episode.h"

namespace faba {

/// The segments that a swarm's way tells: it goes to and fro along one line, from one side to the other. A
/// segment begins where the swarm leaves the side it was at, told from the line through its first twentieth
/// and its first quarter of the way, and lasts until the next begins or the video ends. What comes before the
/// first is left out. Empty when the way is shorter than `least_px`. `centroid_image`: at each time, NaN
/// where no swarm is seen.
std::vector<FieldSegment> segments_of_swarm(const std::vector<double>& t_s,
                                            const std::vector<Vec2>& centroid_image, double least_px);

/// The segments that a run's own record of the field tells: stretches in which it keeps its direction for 0.4
/// s or more. One that is on from the beginning is left out, during which the swarm gathers, unless it is the
/// only one. Cells swim along the field, or against it (south-seekers). Empty when the record has no field.
std::vector<FieldSegment> segments_of_field(const Series& record, bool against);

/// The segments during which all that is seen in a video moves one way (see motion_segments()). `fps` as
/// VideoReader takes it; frames are averaged over squares of `side` px. `tick` is called after each pair of
/// frames. Throws what measure_activity() throws.
std::vector<FieldSegment> segments_of_motion(const std::filesystem::path& video, double fps, int side,
                                             const std::function<void()>& tick);

}  // namespace faba
