#include "app/recording/recording.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <cmath>

#include "app/recording/checkpoint.h"
#include "app/recording/ro_crate.h"
#include "core/file.h"

namespace faba {

using namespace run_files;

namespace {

std::string iso_date(std::chrono::system_clock::time_point at) {
  return fmt::format("{:%FT%TZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(at)));
}

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
    : directory_(std::move(directory)),
      scenario_hash_(scenario.hash()),
      inputs_(input_files(scenario.resolved())) {
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

bool Recording::seamless() const {
  return std::ranges::all_of(sinks_, [](const auto& s) { return s->seamless(); });
}

void Recording::finish(const Manifest& m, bool keep) {
  for (const auto& s : sinks_) s->finish(keep);
  manifest_ = m;
  write_file(dir() / kManifest, manifest_json(m).dump(2) + "\n");
}

void Recording::complete() {
  const auto end = date_ + std::chrono::seconds(std::llround(manifest_.wall_time_s));
  write_file(dir() / kRoCrate, ro_crate(manifest_, dir(), inputs_, iso_date(end)).dump(2) + "\n");
  directory_.complete();
}

std::string Recording::date() const { return iso_date(date_); }

double Recording::wall_time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

}  // namespace faba
