#include "study/data/frame_inspector.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/threads/ordered_work.h"
#include "core/threads/parallel.h"

namespace faba {

std::int64_t frames_stated(const VideoReader& video, const VideoPart& part) {
  const auto all = double(video.frames_in_header()), fps = video.fps();
  if (!(fps > 0)) return video.frames_in_header();
  const double to = part.to_s ? std::min(all, *part.to_s * fps) : all;
  return std::llround(std::max(0.0, to - part.from_s * fps));
}

FrameInspector both(const FrameInspector& a, const FrameInspector& b) {
  if (!a.needs || !b.needs) return a.needs ? a : b;
  struct Needed {
    bool a = false, b = false;
  };
  const auto now = std::make_shared<Needed>();
  FrameInspector all;
  all.needs = [a, b, now](double t_s) {
    *now = {a.needs(t_s), b.needs(t_s)};
    return now->a || now->b;
  };
  all.take = [a, b, now](const GrayF& frame) -> std::function<void()> {
    const std::function<void()> first = now->a ? a.take(frame) : nullptr;
    const std::function<void()> second = now->b ? b.take(frame) : nullptr;
    if (!first || !second) return first ? first : second;
    return [first, second] {
      first();
      second();
    };
  };
  all.begin = [a, b](const VideoReader& video) {
    if (a.begin) a.begin(video);
    if (b.begin) b.begin(video);
  };
  return all;
}

VideoReading inspect_video(const std::filesystem::path& video, const VideoPart& part,
                           const FrameInspector& inspector, unsigned threads,
                           const std::function<void(std::int64_t, std::int64_t)>& tick) {
  threads = OrderedWork::threads(threads);
  VideoReader reader(video, part.fps, threads);
  if (inspector.begin) inspector.begin(reader);
  const std::int64_t stated = frames_stated(reader, part);
  if (part.from_s > 0) reader.skip_to(part.from_s);
  std::vector<std::function<void()>> jobs(OrderedWork::slots(threads));
  GrayF frame;
  std::int64_t done = 0;
  const auto next_job = [&](std::size_t slot) {
    for (double t_s = 0; reader.next(t_s) && !part.ends_before(t_s);) {
      if (!part.holds(t_s)) continue;
      jobs[slot] = nullptr;
      if (inspector.needs(t_s)) {
        reader.picture(frame);
        jobs[slot] = inspector.take(frame);
      }
      tick(++done, stated);
      if (jobs[slot]) return true;
    }
    return false;
  };
  OrderedWork work(threads, {next_job, [&](std::size_t slot, unsigned) { jobs[slot](); }});
  while (work.next()) {
  }
  return {reader.bits(), reader.fps() > 0, reader.truncated() || reader.damaged_frames() > 0,
          reader.damage()};
}

}  // namespace faba
