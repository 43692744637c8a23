#pragma once
#include "core/archive.h"
#include "study/motion/activity.h"

namespace faba {

/// Reads or writes the results of measure_video(), apart from `input` and the pictures of `busiest`.
void archive_activity(Archive& archive, VideoActivity& video);

}  // namespace faba
