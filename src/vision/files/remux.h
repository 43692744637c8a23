#pragma once
#include <filesystem>
#include <functional>

#include "vision/files/frame_encoder.h"
#include "vision/files/video_format.h"

namespace faba {

/// Remuxes the frames of `part` (an H.264 byte stream, or concatenated PNG files, of `encoder` or of another
/// one with the same parameters) without re-encoding into the container of `format`, at a constant frame rate
/// or, in mp4, at the presentation times `time_s` (s, increasing, stored to the microsecond; empty: constant
/// rate). The file is written as `to` + ".tmp" and renamed when it is complete and synced to disk. The index
/// of an MP4 is at the start of the file, so that browsers start playing at once. `part` is kept. Returns the
/// number of frames. Throws Error(Errc::internal): with `part` when it has no frame or cannot be read, with
/// `to` when the file cannot be written or the disk is full; the temporary file is then removed.
long long remux(const std::filesystem::path& part, VideoFormat format, FrameRate rate,
                const FrameEncoder& encoder, const std::filesystem::path& to,
                const std::function<double(long long frame)>& time_s = {});

}  // namespace faba
