#include "app/recording/recording.h"

#include <fmt/chrono.h>

#include "app/recording/checkpoint.h"
#include "core/file.h"

namespace faba {

using namespace run_files;

namespace {

/// Passes the frames of a range to a sink.
class RecordedPart final : public Sink {
 public:
  RecordedPart(Sink& sink, FrameRange range) : sink_(sink), range_(range) {}
  void take(const Tick& t) override {
    if (t.index >= range_.first && t.index < range_.end) sink_.take(t);
  }

 private:
  Sink& sink_;
  FrameRange range_;
};

}  // namespace

Recording::Recording(RunDirectory directory, const Scenario& scenario, bool resumed)
    : directory_(std::move(directory)), scenario_hash_(scenario.hash()) {
  if (!resumed) write_file(dir() / kScenario, to_toml(scenario.resolved()));
}

void Recording::open_sinks(const SinkContext& c, Archive* resume) {
  kept_ = c.kept;
  auto series = series_sink(c, resume);
  series_ = series.get();
  sinks_.push_back(std::move(series));
  if (c.record.tracks && c.truth) sinks_.push_back(tracks_sink(c, resume));
  if (c.record.video) sinks_.push_back(video_sink(c, false, resume));
  if (c.record.lossless) {
    SinkContext lossless = c;
    if (c.record.video) lossless.kept = nullptr;  // frames are kept of one video only
    sinks_.push_back(video_sink(lossless, true, resume));
  }
  if (c.record.flow) sinks_.push_back(flow_sink(c, resume));
  for (const auto& s : sinks_) parts_.push_back(std::make_unique<RecordedPart>(*s, c.recorded));
}

std::vector<Sink*> Recording::sinks() const {
  std::vector<Sink*> all;
  for (const auto& s : parts_) all.push_back(s.get());
  return all;
}

void Recording::checkpoint(Archive& a) {
  for (const auto& s : sinks_) s->checkpoint(a);
  write_checkpoint(dir() / kCheckpoint, scenario_hash_, a);
}

void Recording::finish(const Manifest& m, bool keep) {
  for (const auto& s : sinks_) s->finish(keep);
  write_file(dir() / kManifest, manifest_json(m).dump(2) + "\n");
}

std::string Recording::date() const {
  return fmt::format("{:%FT%TZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(date_)));
}

double Recording::wall_time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

}  // namespace faba
