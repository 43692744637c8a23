#pragma once
#include "study/motion/response.h"
#include "study/motion/segments.h"

namespace faba {

/// The flow of a video, for video_response().
struct VideoMotion {
  const Signature& signature;
  const std::vector<MotionSegment>& segments;
  double direction_deg = 0;  ///< of the signature, when no other is known
};

/// The response of a video (`job.video`: also a run directory or a file of flows) from its frames or, for a
/// file of flows and a run without a camera video, from its optical flow. The time of the reversal is that of
/// `job`, or the first one that the run recorded, or else precedes the first segment that starts later than
/// the video. Without a segment it is searched in the frames. Empty when there is no reversal, no segment and
/// nothing to search in, and with too few frames.
std::optional<Response> video_response(ResponseJob job, const VideoMotion& motion);

/// For the pictures that video_response() needs, unless the time of the reversal follows from a segment
/// outside of them: another reading of `job.part` may take them.
std::shared_ptr<ResponsePictures> response_pictures(ResponseJob job);

}  // namespace faba
