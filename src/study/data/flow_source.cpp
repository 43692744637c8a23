#include "study/data/flow_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/recording/session.h"
#include "core/counted.h"
#include "core/threads/ordered_work.h"
#include "study/data/run_info.h"
#include "study/data/run_video.h"
#include "vision/files/grey_video.h"
#include "vision/flow/flow_file.h"
#include "vision/image/kernels/arithmetic.h"

namespace faba {
namespace {

/// The input file of a path.
struct Input {
  std::filesystem::path file;
  bool flows = false;
  VideoScale scale;
};

/// What a reader has found in a video up to some pair of frames.
struct ReadState {
  std::uint64_t pairs = 0;
  bool truncated = false;
  std::int64_t damaged_frames = 0;
  std::string damage;
  ReadState() = default;
  ReadState(const VideoReader& reader, std::uint64_t pairs_read)
      : pairs(pairs_read),
        truncated(reader.truncated()),
        damaged_frames(reader.damaged_frames()),
        damage(reader.damage()) {}
};

/// A pair of frames between reading and taking.
struct Item {
  std::shared_ptr<const GrayF> before, after;
  std::vector<std::function<void()>> jobs;  ///< of FlowSourceOptions::inspect
  FlowPair pair;
  ReadState state;
};

Input resolve(const std::filesystem::path& path, bool frames) {
  if (!frames && is_run(path) && std::filesystem::exists(path / "flow.h5")) {
    const RunInfo info = read_run_info(path / run_files::kManifest);
    return {path / "flow.h5", true, {info.um_per_px, info.um_per_px_source, ""}};
  }
  const RunVideo video = run_video(path);
  const bool flows = FlowFileReader::recognises(video.file);
  if (frames && flows)
    throw Error(Errc::input, path.string(),
                "contains flows but no frames, which are needed; specify the video");
  return {video.file, flows, video.scale};
}

}  // namespace

struct FlowSource::Impl {
  std::filesystem::path path;
  FlowSourceOptions options;
  Input input;
  std::string method;
  int width = 0, height = 0;
  double fps = 0, end_s = 0;
  std::uint64_t pairs = 0, every = 1;
  bool any = false;  // a pair was taken

  std::optional<FlowFileReader> flows;
  std::uint64_t next = 0;

  // A video: its frames are read one after the other, the flows are computed by all threads.
  std::optional<GreyVideo> video;
  std::shared_ptr<const GrayF> before;
  double t_before = 0;
  std::uint64_t frame = 0, read_frames = 0;  // index of `before`, and of the frame after the last one read
  ReadState taken;
  std::vector<Item> items;
  std::vector<std::unique_ptr<FlowMethod>> methods;  // of each thread
  Pool one_thread{1};
  std::unique_ptr<OrderedWork> work;  // the last member: its threads use the others

  void open_flows();
  void open_video();
  void set_samples() {
    if (options.samples > 0) every = std::max<std::uint64_t>(1, pairs / options.samples);
  }
  std::uint64_t pairs_of_interval(std::uint64_t all) const;
  bool read(std::shared_ptr<const GrayF>& picture, double& t_s, Item& item);
  bool make(Item& item);
  void compute(Item& item, FlowMethod& flow) const;
  static void do_jobs(Item& item);
  [[noreturn]] void throw_no_pairs() const;
  bool next_of_video(FlowPair& pair);
  bool next_of_file(FlowPair& pair);
  bool in_time(double t0, double t1) const {
    return t0 >= options.t0_s && (!options.t1_s || t1 <= *options.t1_s);
  }
};

FlowSource::FlowSource(const std::filesystem::path& path, const FlowSourceOptions& options)
    : impl_(new Impl) {
  impl_->path = path;
  impl_->options = options;
  impl_->input = resolve(path, options.frames);
  impl_->input.flows ? impl_->open_flows() : impl_->open_video();
}
FlowSource::~FlowSource() = default;

void FlowSource::Impl::open_flows() {
  flows.emplace(input.file);
  const FlowInfo& info = flows->info();
  width = info.width;
  height = info.height;
  method = info.method;
  fps = info.fps;
  pairs = flows->size();
  end_s = double(pairs) / (fps > 0 ? fps : 1);
  set_samples();
  if (!input.scale.um_per_px && info.um_per_px) input.scale = {info.um_per_px, "metadata", ""};
  if (flows->size() == 0) throw Error(Errc::input, path.string(), "contains no flows");
}

void FlowSource::Impl::open_video() {
  const unsigned threads = OrderedWork::threads(options.threads);
  VideoReader reader(input.file, options.fps, threads);
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
  fps = video->reader().fps();
  const std::int64_t frames = video->reader().frames_in_header();
  const std::uint64_t all = frames > 1 ? std::uint64_t(frames - 1) : 0;
  pairs = pairs_of_interval(all);
  end_s = double(all) / (fps > 0 ? fps : 1);
  set_samples();
  method = options.method.resolved.dump();
  items.resize(OrderedWork::slots(threads));
  for (unsigned i = 0; i < threads; ++i) methods.push_back(options.method.make({&one_thread}));
  if (options.t0_s > 0) frame = read_frames = std::uint64_t(video->skip_to(options.t0_s));
  if (options.inspect.begin) options.inspect.begin(video->reader());
  if (!read(before, t_before, items.front())) throw Error(Errc::input, path.string(), "contains no frames");
  work = std::make_unique<OrderedWork>(
      threads, OrderedWork::Steps{
                   [this](std::size_t slot) { return make(items[slot]); },
                   [this](std::size_t slot, unsigned thread) { compute(items[slot], *methods[thread]); }});
}

std::uint64_t FlowSource::Impl::pairs_of_interval(std::uint64_t all) const {
  if (!(fps > 0)) return all;
  const double end = double(all) / fps, to = std::min(options.t1_s.value_or(end), end);
  return std::min(all, std::uint64_t(std::llround(std::max(0.0, to - options.t0_s) * fps)));
}

// Reads the next frame; `picture` is empty when no pair needs it.
bool FlowSource::Impl::read(std::shared_ptr<const GrayF>& picture, double& t_s, Item& item) {
  picture.reset();
  if (!video->next(t_s)) return false;
  const std::uint64_t index = read_frames++;
  if (!in_time(t_s, t_s)) return true;
  const bool inspected = options.inspect.needs && options.inspect.needs(t_s);
  const bool paired = index % every == 0 || (index > 0 && (index - 1) % every == 0);
  if (!inspected && !paired) return true;
  auto frame_read = std::make_shared<GrayF>();
  video->picture(*frame_read, [&](const GrayF& of_file) {
    if (!inspected) return;
    if (auto job = options.inspect.take(of_file)) item.jobs.push_back(std::move(job));
  });
  picture = std::move(frame_read);
  return true;
}

bool FlowSource::Impl::make(Item& item) {
  std::shared_ptr<const GrayF> after;
  for (double t = 0; read(after, t, item) && !(options.t1_s && t > *options.t1_s);
       before = after, t_before = t, ++frame) {
    if (!in_time(t_before, t) || frame % every != 0) continue;
    item.before = std::exchange(before, after);
    item.after = after;
    item.pair.frame = frame++;
    item.pair.t0_s = std::exchange(t_before, t);
    item.pair.t1_s = t;
    item.state = ReadState(video->reader(), frame);
    return true;
  }
  do_jobs(item);
  if (frame == 0 && read_frames == 1)
    throw Error(Errc::input, path.string(),
                "contains one frame only; motion needs at least two: give a video, or a second picture to "
                "`faba flow`");
  return false;
}

void FlowSource::Impl::do_jobs(Item& item) {
  for (const auto& job : item.jobs) job();
  item.jobs.clear();
}

void FlowSource::Impl::compute(Item& item, FlowMethod& flow) const {
  do_jobs(item);
  FlowPair& pair = item.pair;
  pair.image = item.after;
  if (options.kept && options.samples == 0)
    if (std::optional<Flow> kept = options.kept->take(pair.frame)) {
      pair.flow = std::move(*kept);
      return;
    }
  flow.between(*item.before, *item.after, pair.flow);
  if (const int side = video->side(); side > 1)
    for (GrayF* c : {&pair.flow.u, &pair.flow.v}) multiply(*c, float(side));
  if (options.kept && options.samples > 0) options.kept->keep(pair.frame, pair.flow);
}

bool FlowSource::Impl::next_of_video(FlowPair& pair) {
  const std::optional<std::size_t> slot = work->next();
  if (!slot) {
    taken = ReadState(video->reader(), frame);
    return false;
  }
  std::swap(pair, items[*slot].pair);
  taken = std::move(items[*slot].state);
  return true;
}

bool FlowSource::Impl::next_of_file(FlowPair& pair) {
  for (; next < flows->size();) {
    flows->read(next, pair.frame, pair.t0_s, pair.t1_s, pair.flow);
    next += every;
    if (in_time(pair.t0_s, pair.t1_s)) return true;
  }
  return false;
}

bool FlowSource::next(FlowPair& pair) {
  const bool more = impl_->flows ? impl_->next_of_file(pair) : impl_->next_of_video(pair);
  impl_->any = impl_->any || more;
  if (!impl_->any) impl_->throw_no_pairs();
  return more;
}

void FlowSource::Impl::throw_no_pairs() const {
  const auto place = [&](double t) {
    return fps > 0 ? fmt::format("{:g} s", t) : fmt::format("frame {:g}", t);
  };
  throw Error(Errc::input, path.string(),
              fmt::format("has fewer than two frames from {} to {}{}; change the interval (--from, --to, or "
                          "from and to in the study)",
                          place(options.t0_s), options.t1_s ? place(*options.t1_s) : "the end",
                          end_s > 0 ? fmt::format("; the video ends at {}", place(end_s)) : ""));
}

int FlowSource::width() const { return impl_->width; }
int FlowSource::height() const { return impl_->height; }
int FlowSource::shrink() const { return impl_->video ? impl_->video->side() : 1; }
double FlowSource::fps() const { return impl_->fps; }
std::uint64_t FlowSource::every() const { return impl_->every; }
std::uint64_t FlowSource::pairs() const { return impl_->pairs; }
const VideoScale& FlowSource::scale() const { return impl_->input.scale; }
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
          override_note(impl_->path, {impl_->input.file, impl_->input.scale}, impl_->options.fps, {});
      !note.empty())
    notes.push_back(note);
  if (!impl_->input.scale.ignored.empty()) notes.push_back(impl_->input.scale.ignored);
  if (impl_->video->side() > 1 && impl_->options.shrink == 0)
    notes.push_back(
        fmt::format("frames were averaged over blocks of {0} x {0} px; flows are in px of the video",
                    impl_->video->side()));
  if (!(impl_->fps > 0)) notes.emplace_back("no frame rate is stated: times are frame counts; specify --fps");
  if (const std::string words = impl_->video->words(); !words.empty()) notes.push_back(words);
  const ReadState& read = impl_->taken;
  if (read.truncated)
    notes.push_back(fmt::format("{} could be read; {}", counted(read.pairs + 1, "frame"), read.damage));
  else if (read.damaged_frames > 0)
    notes.push_back(fmt::format("{} damaged frames were skipped ({})", read.damaged_frames, read.damage));
  return notes;
}

}  // namespace faba
