#include "study/tracks/track_preview.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "study/tracks/track_warnings.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr std::int64_t kShown = 9, kRead = 27;  // frames; the background needs more of them than are shown

}  // namespace

TrackPreview preview_tracks(const TrackOptions& o, const RunVideo& source,
                            const std::function<void(std::int64_t, std::int64_t)>& tick) {
  VideoReader reader(source.file, o.part.fps, 1);
  const std::int64_t stated = frames_stated(reader, o.part);
  const std::int64_t wanted = stated > 0 ? std::min(stated, kRead) : kRead;
  const std::int64_t show = std::max<std::int64_t>(1, wanted / kShown);
  const double frame_s = reader.fps() > 0 ? 1 / reader.fps() : 1,
               step_s = frame_s * std::max(1.0, double(stated) / double(kRead));
  TrackSurveyor surveyor(o);
  const FrameInspector inspector = surveyor.inspector();
  TrackPreview out;
  GrayF frame;
  double t_s = 0;
  std::int64_t done = 0;
  if (o.part.from_s > 0) reader.skip_to(o.part.from_s);
  while (done < wanted && reader.next(t_s) && !o.part.ends_before(t_s)) {
    const double next_s = o.part.from_s + double(done) * step_s;
    if (!o.part.holds(t_s) || t_s < next_s - 0.5 * frame_s || !inspector.needs(t_s)) continue;
    reader.picture(frame);
    make_finite(frame);
    inspector.take(frame);
    if (done % show == show / 2 && std::ssize(out.frames) < kShown) out.frames.push_back({t_s, frame, {}});
    tick(++done, wanted);
    reader.skip_to(next_s + step_s);
  }
  if (done == 0) throw_no_frames(source.file, o.part);
  Pool pool(o.threads);
  out.survey = surveyor.result(reader.bits(), reader.fps() > 0, pool);
  const std::optional<DropMask> drop = drop_of(o, out.survey);
  const Detector detector(out.survey.background, detector_options(o, out.survey, drop));
  out.detection = detection_of(o, out.survey, detector, drop);
  SpotSums sums;
  for (PreviewFrame& f : out.frames) {
    f.spots = spots_in(f.picture, detector, out.survey);
    sums.take(f.spots);
  }
  sums.describe(out.detection);
  out.warnings = detection_warnings(out.detection);
  return out;
}

}  // namespace faba
