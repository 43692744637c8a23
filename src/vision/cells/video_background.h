#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "vision/foreground/background.h"

namespace faba {

/// A pass over the whole video at `path` (anything VideoReader reads; `fps` as there) with a
/// BackgroundSampler. `progress`, when given, is called with frames done and stated (0: unknown) after each
/// frame. Throws what VideoReader throws.
Background video_background(const std::filesystem::path& path, int most_frames = 50,
                            const std::function<void(std::int64_t, std::int64_t)>& progress = {});

}  // namespace faba
