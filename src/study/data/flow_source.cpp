#include "study/data/flow_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/counted.h"
#include "study/data/run_video.h"
#include "vision/files/grey_video.h"
#include "vision/flow/flow_file.h"

namespace faba {
namespace {

/// The input file of a path.
struct Input {
  std::filesystem::path file;
  bool flows = false;
  std::optional<double> um_per_px;
};

Input resolve(const std::filesystem::path& path, bool frames) {
  if (!frames && is_run(path) && std::filesystem::exists(path / "flow.h5"))
    return {path / "flow.h5", true, {}};
  const RunVideo video = run_video(path);
  const bool flows = FlowFileReader::recognises(video.file);
  if (frames && flows)
    throw Error(Errc::input, path.string(),
                "contains flows but no frames, which are needed; specify the video");
  return {video.file, flows, video.um_per_px};
}

}  // namespace

struct FlowSource::Impl {
  std::filesystem::path path;
  FlowSourceOptions options;
  Input input;
  std::string method;
  int width = 0, height = 0;

  std::optional<FlowFileReader> flows;
  std::uint64_t next = 0;

  std::optional<GreyVideo> video;
  std::unique_ptr<FlowMethod> flow;
  GrayF before, after;
  double t_before = 0;
  std::uint64_t frame = 0;

  void open_video(Pool& pool);
  bool next_of_video(FlowPair& pair);
  bool next_of_file(FlowPair& pair);
  bool in_time(double t0, double t1) const {
    return t0 >= options.t0_s && (!options.t1_s || t1 <= *options.t1_s);
  }
};

FlowSource::FlowSource(const std::filesystem::path& path, const FlowSourceOptions& options, Pool& pool)
    : impl_(new Impl) {
  impl_->path = path;
  impl_->options = options;
  impl_->input = resolve(path, options.frames);
  if (!impl_->input.flows) {
    impl_->open_video(pool);
    return;
  }
  impl_->flows.emplace(impl_->input.file);
  impl_->width = impl_->flows->info().width;
  impl_->height = impl_->flows->info().height;
  impl_->method = impl_->flows->info().method;
  if (!impl_->input.um_per_px) impl_->input.um_per_px = impl_->flows->info().um_per_px;
  if (impl_->flows->size() == 0) throw Error(Errc::input, path.string(), "contains no flows");
}
FlowSource::~FlowSource() = default;

void FlowSource::Impl::open_video(Pool& pool) {
  VideoReader reader(input.file, options.fps);
  const int w = reader.width(), h = reader.height();
  const int side =
      options.shrink > 0 ? options.shrink : std::max(1, (std::max(w, h) + kLongSide - 1) / kLongSide);
  width = w / side;
  height = h / side;
  if (width < 2 || height < 2)
    throw side > 1
        ? Error(Errc::usage, "shrink",
                fmt::format("{} is too large for frames of {} x {} px; a flow needs at least 2 x 2 px after "
                            "shrinking",
                            side, w, h))
        : Error(Errc::input, path.string(),
                fmt::format("has frames of {} x {} px; a flow needs at least 2 x 2 px", w, h));
  video.emplace(std::move(reader), side);
  flow = options.method.make({&pool});
  method = options.method.resolved.dump();
  if (!video->read(before, t_before)) throw Error(Errc::input, path.string(), "contains no frames");
}

bool FlowSource::Impl::next_of_video(FlowPair& pair) {
  double t = 0;
  const int side = video->side();
  while (video->read(after, t)) {
    if (options.t1_s && t > *options.t1_s) return false;
    const bool wanted = in_time(t_before, t) && frame % options.every == 0;
    if (wanted) {
      flow->between(before, after, pair.flow);
      if (side > 1)
        for (GrayF* c : {&pair.flow.u, &pair.flow.v})
          for (float& x : c->px) x *= float(side);
      pair.frame = frame;
      pair.t0_s = t_before;
      pair.t1_s = t;
      pair.image = after;
    }
    std::swap(before, after);
    t_before = t;
    ++frame;
    if (wanted) return true;
  }
  if (frame == 0)
    throw Error(Errc::input, path.string(),
                "contains one frame only; motion needs at least two: give a video, or a second picture to "
                "`faba flow`");
  return false;
}

bool FlowSource::Impl::next_of_file(FlowPair& pair) {
  for (; next < flows->size();) {
    flows->read(next, pair.frame, pair.t0_s, pair.t1_s, pair.flow);
    next += options.every;
    if (in_time(pair.t0_s, pair.t1_s)) return true;
  }
  return false;
}

bool FlowSource::next(FlowPair& pair) {
  return impl_->flows ? impl_->next_of_file(pair) : impl_->next_of_video(pair);
}

int FlowSource::width() const { return impl_->width; }
int FlowSource::height() const { return impl_->height; }
int FlowSource::shrink() const { return impl_->video ? impl_->video->side() : 1; }
double FlowSource::fps() const {
  return impl_->flows ? impl_->flows->info().fps : impl_->video->reader().fps();
}
std::uint64_t FlowSource::pairs() const {
  if (impl_->flows) return impl_->flows->size();
  const std::int64_t frames = impl_->video->reader().frames_in_header();
  return frames > 1 ? std::uint64_t(frames - 1) : 0;
}
std::optional<double> FlowSource::um_per_px() const { return impl_->input.um_per_px; }
const std::string& FlowSource::method() const { return impl_->method; }

std::vector<std::string> FlowSource::notes() const {
  std::vector<std::string> notes;
  if (is_run(impl_->path) && !is_complete(impl_->path))
    notes.emplace_back("the run was interrupted; the result is based on the recorded part");
  if (impl_->flows) {
    if (!impl_->options.options_text.empty())
      notes.push_back(fmt::format("the flows were read from {} and not computed: {} has no effect",
                                  impl_->input.file.filename().string(), impl_->options.options_text));
    return notes;
  }
  if (const std::string note =
          override_note(impl_->path, {impl_->input.file, impl_->input.um_per_px}, impl_->options.fps, {});
      !note.empty())
    notes.push_back(note);
  const VideoReader& reader = impl_->video->reader();
  if (impl_->video->side() > 1 && impl_->options.shrink == 0)
    notes.push_back(
        fmt::format("frames were averaged over blocks of {0} x {0} px; flows are in px of the video",
                    impl_->video->side()));
  if (!(reader.fps() > 0))
    notes.emplace_back("no frame rate is stated: times are frame counts; specify --fps");
  if (!impl_->video->words().empty()) notes.push_back(impl_->video->words());
  if (reader.truncated())
    notes.push_back(fmt::format("{} could be read; {}", counted(impl_->frame + 1, "frame"), reader.damage()));
  else if (reader.damaged_frames() > 0)
    notes.push_back(
        fmt::format("{} damaged frames were skipped ({})", reader.damaged_frames(), reader.damage()));
  return notes;
}

}  // namespace faba
