#include "study/tracks/track_preview.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "study/tracks/track_warnings.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

constexpr std::int64_t kPreviewShown = 9;  // frames
constexpr std::int64_t kIfUnknown = 40;    // frames, when the file does not state its length

}  // namespace

void sample_frames(VideoReader& reader, const TrackOptions& o, const std::filesystem::path& name,
                   TrackSurveyor& surveyor,
                   const std::function<void(double, const GrayF&, std::int64_t, std::int64_t)>& take) {
  const PixelRegion region = searched_region(o, reader.width(), reader.height());
  const std::int64_t stated = frames_stated(reader, o.part), frames = stated > 0 ? stated : kIfUnknown;
  const auto stride = std::int64_t(BackgroundSampler().stride_for(
      std::uint64_t(frames), std::size_t(region.width) * std::size_t(region.height)));
  const std::int64_t wanted = (frames + stride - 1) / stride;
  const double frame_s = reader.fps() > 0 ? 1 / reader.fps() : 1;
  const FrameInspector inspector = surveyor.inspector();
  GrayF frame;
  double t_s = 0, first_s = 0;
  std::int64_t done = 0;
  if (o.part.from_s > 0) reader.skip_to(o.part.from_s);
  while (done < wanted && reader.next(t_s) && !o.part.ends_before(t_s)) {
    if (done == 0) first_s = t_s;
    const double next_s = first_s + double(done * stride) * frame_s;
    if (!o.part.holds(t_s) || t_s < next_s - 0.5 * frame_s || !inspector.needs(t_s)) continue;
    reader.picture(frame);
    make_finite(frame);
    inspector.take(frame);
    take(t_s, frame, ++done, wanted);
    reader.skip_to(first_s + double(done * stride) * frame_s);
  }
  if (done == 0) throw_no_frames(name, o.part);
}

TrackPreview preview_tracks(const TrackOptions& o, const RunVideo& source,
                            const std::function<void(std::int64_t, std::int64_t)>& tick) {
  VideoReader reader(source.file, o.part.fps, 1);
  TrackSurveyor surveyor(o);
  TrackPreview out;
  sample_frames(reader, o, source.file, surveyor,
                [&](double t_s, const GrayF& frame, std::int64_t done, std::int64_t wanted) {
                  // Evenly spread over those that are read.
                  const bool show = done * kPreviewShown / wanted > (done - 1) * kPreviewShown / wanted ||
                                    wanted <= kPreviewShown;
                  if (show) out.frames.push_back({t_s, frame, {}});
                  tick(done, wanted);
                });
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
  out.warnings = out.survey.warnings;
  const std::vector<Warning> found = detection_warnings(out.detection);
  out.warnings.insert(out.warnings.end(), found.begin(), found.end());
  return out;
}

}  // namespace faba
