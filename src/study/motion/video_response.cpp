#include "study/motion/video_response.h"

#include <algorithm>
#include <cmath>

#include "study/data/run_video.h"
#include "study/motion/recorded_reversals.h"
#include "study/tracks/cell_view.h"
#include "vision/flow/flow_file.h"

namespace faba {
namespace {

constexpr double kBeforeSegment = 0.5;  // s: the onset precedes the detected start of a segment
constexpr double kSearchedFlow = 4;     // s after the reversal

bool has_frames(const std::filesystem::path& path) {
  if (is_run(path)) return has_camera_video(path);
  return !FlowFileReader::recognises(path);
}

// The first segment that does not start with the video.
const MotionSegment* late_segment(const VideoMotion& m) {
  for (const MotionSegment& s : m.segments)
    if (s.t0_s > m.signature.t0_s(0) + kBeforeSegment) return &s;
  return nullptr;
}

// Takes the first reversal that the run recorded, if there is one.
void take_recorded(ResponseJob& job) {
  if (job.part.fps > 0) return;  // the times of the run are not those of the measurement
  for (const FieldReversal& r : recorded_reversals(job.video))
    if (job.part.holds(r.t_s)) {
      job.reversal_s = r.t_s;
      if (!job.direction_deg) job.direction_deg = r.direction_deg;
      return;
    }
}

// Completes time and direction of the reversal; returns the source of the time.
Response::Source complete(ResponseJob& job, const VideoMotion& motion) {
  if (job.reversal_s) return Response::Source::given;
  take_recorded(job);
  if (job.reversal_s) return Response::Source::recorded;
  if (const MotionSegment* s = late_segment(motion)) {
    job.reversal_s = s->t0_s - kBeforeSegment;
    if (!job.direction_deg) job.direction_deg = s->direction_deg;
  }
  return Response::Source::detected;
}

std::optional<Response> response_in_flow(const ResponseJob& job, const VideoMotion& motion) {
  if (!job.reversal_s) return {};
  const double direction = job.direction_deg.value_or(motion.direction_deg);
  const Vec2 d = unit_vector(direction);
  std::vector<double> t0, t1, along, across;
  for (std::size_t k = 0; k < motion.signature.size(); ++k) {
    const Vec2 sum = motion.signature.sum(k);
    t0.push_back(motion.signature.t0_s(k));
    t1.push_back(motion.signature.t1_s(k));
    along.push_back(dot(sum, d));
    across.push_back(sum.y * d.x - sum.x * d.y);
  }
  const double latest = std::min(job.part.to_s.value_or(t1.back()), *job.reversal_s + kSearchedFlow);
  const auto change = change_point({t0, t1, along, across}, *job.reversal_s, latest);
  if (!change) return {};
  Response r;
  r.earliest_s = *job.reversal_s;
  r.direction_deg = direction;
  r.measure = "optical flow";
  r.change = *change;
  r.responds = change->after > 0 && change->t_statistic > least_t(*change, latest - *job.reversal_s, 1);
  return r;
}

}  // namespace

std::shared_ptr<ResponsePictures> response_pictures(ResponseJob job) {
  if (!has_frames(job.video)) return {};
  if (!job.reversal_s) take_recorded(job);
  VideoPart part = response_part(job);
  part.from_s = std::max(part.from_s, job.part.from_s);
  return std::make_shared<ResponsePictures>(part);
}

std::optional<Response> video_response(ResponseJob job, const VideoMotion& motion) {
  if (motion.signature.still() && !job.reversal_s) return {};
  const Response::Source source = complete(job, motion);
  std::optional<Response> r;
  if (has_frames(job.video)) {
    job.video = run_video(job.video).file;
    r = measure_response(job);
  } else {
    r = response_in_flow(job, motion);
  }
  if (r) r->source = source;
  return r;
}

}  // namespace faba
