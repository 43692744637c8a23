#include "app/bench/open_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/monotonic.h"
#include "core/statistics.h"

namespace faba {

class OpenBench::Shown final : public Sink {
 public:
  Shown(BenchWatcher& watcher, BenchRig& rig) : watcher_(watcher), rig_(rig) {}
  void take(const Tick& t) override { watcher_.cycle(t, rig_.coils()->report()); }

 private:
  BenchWatcher& watcher_;
  BenchRig& rig_;
};

OpenBench::OpenBench(Scenario& s, std::uint64_t seed, Open what, BenchDevices devices)
    : devices_(std::move(devices)) {
  (void)BenchControls(s);  // throws for an unsuitable scenario before a device is opened
  const Parts& parts = builtin_parts();
  setup_ = *s.rig;
  if (setup_.needs_bench()) {
    if (!devices_.simulated) devices_.simulated = std::make_shared<BenchProcess>(s, seed);
    setup_ = setup_.at(devices_.simulated->at(), parts.camera, parts.driver);
  }
  frame_period_ = s.frame_period();
  if (what == Open::coils) return;
  camera_ = devices_.camera ? devices_.camera : std::shared_ptr<Camera>(setup_.camera.make({}));
  if (camera_->rate() > 0) s.camera.rate = camera_->rate();
  frame_period_ = s.frame_period();
  const Frame frame = s.arena.make({s.si_scale()})->frame();
  if (camera_->width() != frame.width || camera_->height() != frame.height)
    throw Error(Errc::usage, "arena",
                fmt::format("the view is {} x {} px, but the camera gives {} x {} px", frame.width,
                            frame.height, camera_->width(), camera_->height()));
}

BenchRig& OpenBench::rig(const std::filesystem::path& log) {
  if (rig_) return *rig_;
  const BenchRig::Params p{setup_.params.camera_timeout,
                           camera_->waits() ? CameraFeed::Keep::each : CameraFeed::Keep::newest};
  rig_ = std::make_unique<BenchRig>(camera_, std::make_unique<GuardLink>(guard_setup(log)), p);
  if (devices_.watcher) shown_ = std::make_unique<Shown>(*devices_.watcher, *rig_);
  return *rig_;
}

void OpenBench::try_coils() const {
  if (!rig_) (void)GuardLink(guard_setup({}));
}

double OpenBench::delay(const Scenario& s) {
  if (setup_.driver.has(Trait::no_current) || camera_->waits()) return 0;
  constexpr int kDelayPictures = 11;  // the median excludes one-time costs of the first picture
  BenchControls controls(s);
  std::vector<double> delays;
  Observation seen;
  rig({}).begin();
  for (int i = 0; i < kDelayPictures && rig_->read(seen); ++i) {
    const double received = monotonic_now();
    const Estimate e = controls.estimator->update(seen, {});
    (void)controls.controller->update(e, controls.reference->update(e), frame_period_);
    delays.push_back(seen.age + monotonic_now() - received);
  }
  if (delays.empty()) return 0;
  return median(delays);
}

BenchCheck check_bench(Scenario s, std::uint64_t seed, double seconds) {
  OpenBench bench(s, seed);
  const double delay = bench.delay(s);
  BenchRig& rig = bench.rig({});
  rig.begin();
  BenchControls controls(s);
  Observation seen;
  Estimate estimate;
  std::uint64_t frames = 0;
  double first = 0;
  for (const double until = monotonic_now() + seconds; monotonic_now() < until && rig.read(seen); ++frames) {
    if (frames == 0) first = seen.t;
    estimate = controls.estimator->update(seen, {});
  }
  if (frames == 0) throw Error(Errc::device, "camera", "no pictures received");
  const GuardReport guard = rig.coils()->report();
  BenchCheck c;
  c.camera = s.rig->camera.type;
  c.driver = s.rig->driver.type;
  c.width_px = bench.camera()->width();
  c.height_px = bench.camera()->height();
  if (frames > 1) c.rate_hz = double(frames - 1) / (seen.t - first);
  c.frames = frames;
  c.dropped = rig.dropped();
  c.corrupt = rig.feed().corrupt();
  c.age_s = seen.age;
  c.delay_s = delay;
  c.guard = word(guard.state);
  c.cannot_arm = guard.reason.data();
  for (std::size_t k = 0; k < rig.coils()->coils(); ++k) c.sensed_a.push_back(guard.sensed[k]);
  if (estimate.visible > 0)
    c.swarm = {.cells = estimate.visible, .centroid_px = controls.frame.image_from_world(estimate.centroid)};
  return c;
}

}  // namespace faba
