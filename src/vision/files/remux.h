#pragma once
#include <filesystem>
#include <functional>

#include "vision/files/video_format.h"

namespace faba {

/// Puts the coded frames of `part` (a plain H.264 byte stream, or PNG files one after the other) unchanged
/// into the container of `format`, at a constant frame rate or, in mp4, at the times that `time_s` says (s,
/// rising, kept to the microsecond; empty: none), under a temporary name (`to` + ".tmp") that is
/// renamed when the file is complete and on the disk. MP4 gets its index in front, so that browsers start at
/// once. `part` is kept. Returns the number of frames. Throws Error(Errc::internal): with `part` when it
/// holds no frame or cannot be read, with `to` when the place cannot be written or the disk is full; then no
/// temporary file stays behind.
long long remux(const std::filesystem::path& part, VideoFormat format, FrameRate rate,
                const std::filesystem::path& to, const std::function<double(long long frame)>& time_s = {});

}  // namespace faba
