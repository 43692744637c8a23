#include "server/bench/bench_console.h"

#include <utility>

#include "core/monotonic.h"

namespace faba {
namespace {

constexpr double kIdleTimeout = 20;    // s without a request, after which the camera is closed
constexpr double kWatchPeriod = 0.1;   // s
constexpr double kNewsPeriod = 0.5;    // s, during an activity
constexpr std::size_t kFinished = 20;  // activities in the state

}  // namespace

BenchConsole::BenchConsole(std::function<void(const Json&)> changed,
                           std::function<void(const BenchRecording&)> recorded)
    : changed_(std::move(changed)),
      recorded_(std::move(recorded)),
      watcher_([this](const std::stop_token& s) { watch(s); }) {}

BenchConsole::~BenchConsole() {
  off();
  stop();
  watcher_ = {};
  worker_ = {};
}

void BenchConsole::watch(const std::stop_token& stop) {
  double last_news = 0;
  bool was_armed = false;
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(std::chrono::duration<double>(kWatchPeriod));
    std::shared_ptr<BenchActivity> a;
    {
      const std::lock_guard lock(mutex_);
      a = activity_;
    }
    const double now = monotonic_now();
    const bool armed = a && a->armed();
    if (armed != was_armed || (a && now - last_news > kNewsPeriod)) {
      was_armed = armed;
      last_news = now;
      tell();
    }
    const auto b = bench(false);
    if (b && !a && now - b->last_used() > kIdleTimeout) {
      try {
        close();
      } catch (const Error&) {  // NOLINT(bugprone-empty-catch): an activity has started meanwhile
      }
    }
  }
}

std::shared_ptr<ViewedBench> BenchConsole::bench(bool required) {
  const std::lock_guard lock(mutex_);
  if (!bench_ && required) throw Error(Errc::input, "bench", "no camera is open");
  return bench_;
}

std::shared_ptr<ViewedBench> BenchConsole::take_bench() {
  permits_.revoke();
  const std::lock_guard lock(mutex_);
  if (activity_) throw Error(Errc::usage, "bench", "is in use; stop the activity first");
  return std::exchange(bench_, nullptr);
}

void BenchConsole::open(const Document& scene, const std::string& name) {
  const std::lock_guard one_at_a_time(opening_);
  (void)take_bench();  // closes it: the new one may need the same camera
  const auto b = std::make_shared<ViewedBench>(scene, name);
  b->view();
  {
    const std::lock_guard lock(mutex_);
    bench_ = b;
    ++openings_;
  }
  tell();
}

void BenchConsole::close() {
  const std::lock_guard one_at_a_time(opening_);
  (void)take_bench();
  tell();
}

std::string BenchConsole::png() {
  const auto b = bench(false);
  if (!b) return {};
  b->mark_used();
  return b->live().png();
}

std::string BenchConsole::bmp() {
  const auto b = bench(false);
  if (!b) return {};
  b->mark_used();
  return b->live().bmp();
}

void BenchConsole::set(const std::string& control, double value, std::optional<bool> automatically) {
  const auto b = bench(true);
  const auto kind = control_kind(control);
  if (!kind) reject_control(control);
  b->set({*kind, value, automatically});
}

void BenchConsole::sample(std::optional<double> exposure_s) {
  const std::lock_guard lock(mutex_);
  placed_.reset();
  if (exposure_s) placed_ = monotonic_now() - *exposure_s;
}

std::optional<double> BenchConsole::exposure() {
  const std::lock_guard lock(mutex_);
  if (!placed_) return {};
  return monotonic_now() - *placed_;
}

std::shared_ptr<BenchActivity> BenchConsole::new_activity(const char* kind, const std::string& title,
                                                          bool uses_coils) {
  const Scenario& s = bench(true)->scenario();
  return std::make_shared<BenchActivity>(kind, title, uses_coils, s.arena.make({s.si_scale()})->frame(),
                                         permitted_currents(s));
}

void BenchConsole::start(const std::shared_ptr<BenchActivity>& activity, Work work,
                         std::shared_ptr<Jog> jog) {
  const auto b = bench(true);
  std::jthread before;
  {
    const std::lock_guard lock(mutex_);
    if (activity_) throw Error(Errc::usage, "bench", "is in use; stop the activity first");
    activity_ = activity;
    jog_ = std::move(jog);
    before = std::move(worker_);
  }
  before = {};  // has ended
  std::jthread worker([this, b, activity, work = std::move(work)] {
    Json result = {{"ok", true}, {"what", ""}};
    try {
      result["what"] = work(*b, *activity);
    } catch (const Error& e) {
      result["ok"] = e.code() == Errc::interrupted;
      result["what"] = e.what();
    } catch (const std::exception& e) {
      result = {{"ok", false}, {"what", e.what()}};
    }
    result["late_ms"] = 1e3 * b->live().lateness();
    b->view();
    finish(activity, std::move(result));
  });
  {
    const std::lock_guard lock(mutex_);
    worker_ = std::move(worker);
  }
  tell();
}

void BenchConsole::finish(const std::shared_ptr<BenchActivity>& activity, Json result) {
  Json last = Json::object();
  activity->describe(last);
  const Json& a = last["activity"];
  for (const char* key : {"kind", "title", "out", "experiment", "taken", "kept", "dropped", "corrupt"})
    if (a.contains(key)) result[key] = a[key];
  result["duration_s"] = a["started_s_ago"];
  {
    const std::lock_guard lock(mutex_);
    result["at"] = monotonic_now();
    if (activity->uses_coils) {  // the last use of the coils had this fault, or none
      fault_ = result["ok"] == false ? result["what"] : Json("");
      fault_at_ = monotonic_now();
    }
    finished_.push_front(std::move(result));
    if (finished_.size() > kFinished) finished_.pop_back();
    activity_.reset();
    jog_.reset();
  }
  permits_.revoke();
  tell();
}

void BenchConsole::steering(std::uint64_t page) {
  permits_.steering(page);
  const std::lock_guard lock(mutex_);
  if (activity_ && jog_ && jog_->page != page) activity_->stop = true;
}

void BenchConsole::stop() {
  const std::lock_guard lock(mutex_);
  if (activity_) activity_->stop = true;
}

void BenchConsole::off() {
  permits_.revoke();
  const std::lock_guard lock(mutex_);
  if (activity_ && activity_->uses_coils) activity_->stop = true;
}

Json BenchConsole::state() {
  if (const auto b = bench(false)) b->mark_used();
  return describe(true);
}

void BenchConsole::tell() { changed_(describe(false)); }

Json BenchConsole::describe(bool all) {
  const double now = monotonic_now();
  std::shared_ptr<ViewedBench> b;
  std::shared_ptr<BenchActivity> a;
  Json j = {{"open", nullptr},  {"activity", nullptr},    {"armed", false},
            {"guard", nullptr}, {"coils", Json::array()}, {"setpoint_px", nullptr}};
  {
    const std::lock_guard lock(mutex_);
    b = bench_;
    a = activity_;
    j["opening"] = openings_;
    j["sample"] = placed_ ? Json{{"exposure_s", now - *placed_}} : Json();
    j["last_fault"] = fault_.empty() ? Json() : Json{{"reason", fault_}, {"ago_s", now - fault_at_}};
    Json finished = Json::array();
    for (Json f : finished_) {
      f["ago_s"] = now - f["at"].get<double>();
      f.erase("at");
      finished.push_back(std::move(f));
    }
    j["finished"] = std::move(finished);
  }
  if (b) b->describe(j, all);
  if (a) {
    a->describe(j);
    if (b) j["activity"]["late_ms"] = 1e3 * b->live().lateness();
  }
  return j;
}

}  // namespace faba
