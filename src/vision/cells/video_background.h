#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "vision/foreground/background.h"

namespace faba {

/// Reads the complete video at `path` (any input of VideoReader) with a BackgroundSampler. `progress`, if
/// given, is called after each frame with the number of frames read and the stated number (0: unknown).
/// Throws as VideoReader.
Background video_background(const std::filesystem::path& path, int most_frames = 50,
                            const std::function<void(std::int64_t, std::int64_t)>& progress = {});

}  // namespace faba
