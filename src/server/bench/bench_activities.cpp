// What a bench does for the pages of the lab: the activities of the console.
#include <fmt/format.h>

#include <cmath>

#include "app/bench/bench_session.h"
#include "app/bench/coil_jog.h"
#include "app/bench/step_response.h"
#include "app/scenario/read_scenario.h"
#include "server/access.h"
#include "server/bench/bench_console.h"
#include "study/pages/reported_run.h"
#include "study/pages/run_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

std::string shown(const BenchDestination& to, const fs::path& out) {
  return out.lexically_relative(to.root).string();
}

RunOptions options_of(const BenchDestination& to, BenchActivity& a) {
  RunOptions o;
  o.out = to.out;
  o.numbered = true;
  o.progress = [&a](std::uint64_t done, std::uint64_t total) { a.progress(done, total); };
  o.stop = &a.stop;
  return o;
}

Document with_exposure(Document d, std::optional<double> exposure) {
  if (exposure) d.set("exposure", fmt::format("{:.1f} s", *exposure), "bench");
  return d;
}

// Direction of the field after the reversal: counter-clockwise from the right, y up. The direction of the
// parameters is that of the cells before the reversal, clockwise.
double field_after_reversal(const StepResponseParams& p, int polarity) {
  const double cells = -(p.direction + 180);
  return std::fmod(std::fmod(polarity > 0 ? cells : cells + 180, 360) + 360, 360);
}

}  // namespace

void BenchConsole::capture(CaptureJob job, const BenchDestination& to) {
  const auto exposed = exposure();
  start(new_activity("capture", to.title, false),
        [this, job, to, exposed](ViewedBench& b, BenchActivity& a) mutable {
          b.stop_view();
          job.out = to.out;
          job.timeout = b.scenario().rig->params.camera_timeout;
          job.stop = &a.stop;
          const auto camera = b.camera();
          const std::size_t bytes = std::size_t(camera->width()) * std::size_t(camera->height());
          job.progress = [&a](std::uint64_t done, std::uint64_t total) { a.progress(done, total); };
          job.live = [&a, bytes](const Captured& c) { a.captured(c, bytes); };
          a.out(shown(to, job.out), to.experiment);
          const Captured done = faba::capture(camera, job);
          a.captured(done, bytes);
          if (done.kept == 0) throw Error(Errc::input, "capture", "no frame was kept; there is no recording");
          recorded_({.path = job.out, .experiment = to.experiment, .drop = to.drop, .exposure_s = exposed});
          std::string note = done.memory_full ? "stopped because the memory was full" : "";
          return note;
        });
}

void BenchConsole::run(double duration_s, const BenchDestination& to, std::uint64_t page,
                       const std::string& permit) {
  permits_.use(permit, page, "run", monotonic_now());
  const auto exposed = exposure();
  Document d = with_exposure(bench(true)->scene(), exposed);
  d.set("duration", fmt::format("{} s", duration_s), "bench");
  Scenario s = read_scenario(d, builtin_parts());  // reports a wrong duration before anything starts
  start(new_activity("run", to.title, true),
        [this, s, to, exposed](ViewedBench& b, BenchActivity& a) mutable {
          b.stop_view();
          const auto open = std::make_shared<OpenBench>(s, b.seed(), OpenBench::Open::all, b.devices(&a));
          BenchSession session = BenchSession::begin(s, open, b.seed(), options_of(to, a));
          a.out(shown(to, session.dir()), to.experiment);
          const bool complete = run_with_report(session);
          recorded_({.path = session.dir(),
                     .experiment = to.experiment,
                     .drop = to.drop,
                     .exposure_s = exposed,
                     .polarity = s.polarity()});
          std::string note = complete ? "" : "stopped by the user";
          return note;
        });
}

void BenchConsole::step_responses(const Json& changes, BenchDestination to, std::uint64_t page,
                                  const std::string& permit) {
  Document d = with_exposure(bench(true)->scene(), exposure());
  for (const auto& [key, value] : changes.items()) d.set("rig.step_response." + key, value, "bench");
  const Scenario s = read_scenario(d, builtin_parts());
  check_step_response(d);  // reports wrong values before anything starts
  permits_.use(permit, page, "step-response", monotonic_now());
  start(new_activity("step-response", to.title, true), [this, d, s, to](ViewedBench& b, BenchActivity& a) {
    b.stop_view();
    const StepResponseParams p = s.rig->step_response;
    StepResponseJob job;
    job.scene = d;
    job.seed = b.seed();
    job.experiment = to.drop;
    job.run = options_of(to, a);
    job.devices = b.devices(&a);
    int made = 0;
    a.out(shown(to, to.out), to.experiment);
    a.item(1, p.repeat);
    job.done = [&](const RecordedResponse& r) {
      write_run_report(r.dir, read_run_info(r.dir / run_files::kManifest), read_series(r.dir / "series.csv"));
      recorded_({.path = r.dir,
                 .experiment = to.experiment,
                 .drop = to.drop,
                 .exposure_s = r.exposure,
                 .reversal_s = r.reversal,
                 .field_deg = field_after_reversal(p, s.polarity()),
                 .field_t = p.field,
                 .polarity = s.polarity()});
      a.item(std::min(++made + 1, p.repeat), p.repeat);
    };
    record_step_responses(job);
    return std::string();
  });
}

BenchConsole::Jog::Jog(std::uint64_t of_page)
    : secret(random_token()), page(of_page), heard(monotonic_now()) {}

std::string BenchConsole::work_of_jog(ViewedBench& b, BenchActivity& a, Jog& asked) {
  Scenario s = b.scenario();
  const OpenBench open(s, b.seed(), OpenBench::Open::coils, b.devices(nullptr));
  GuardLink coils(open.guard_setup({}));
  CoilJog jog(coils, s);
  jog.arm();
  while (!a.stop) {
    std::this_thread::sleep_for(std::chrono::duration<double>(CoilJog::kCycle));
    bool reset = false;
    {
      const std::lock_guard lock(asked.mutex);
      if (monotonic_now() - asked.heard > kJogDeadline) {
        jog.disarm();
        std::string note = "the page was silent: the coils were switched off";
        return note;
      }
      reset = std::exchange(asked.reset, false);
      for (std::size_t k = 0; k < asked.current.size() && k < jog.coils(); ++k)
        jog.request(k, asked.current[k]);
    }
    if (reset) {
      jog.reset();
      jog.arm();
    }
    const GuardReport report = jog.step();
    a.coils(jog.requested(), report);
    if (report.state == CoilGuard::State::armed) continue;
    const std::lock_guard lock(asked.mutex);
    asked.current.clear();  // no current until the page asks for one after the fault
  }
  const GuardReport last = coils.report();
  jog.disarm();
  if (last.state == CoilGuard::State::tripped)
    throw Error(Errc::device, "coil guard", std::string(last.reason.data()) + "; the coils are de-energised");
  return "";
}

JogSession BenchConsole::jog(std::uint64_t page, const std::string& permit) {
  permits_.use(permit, page, "jog", monotonic_now());
  const auto asked = std::make_shared<Jog>(page);
  const std::vector<double> most = permitted_currents(bench(true)->scenario());
  start(
      new_activity("jog", "", true),
      [asked](ViewedBench& b, BenchActivity& a) { return work_of_jog(b, a, *asked); }, asked);
  return {asked->secret, most};
}

std::shared_ptr<BenchConsole::Jog> BenchConsole::jog_of(const std::string& session) {
  const std::lock_guard lock(mutex_);
  if (!jog_ || !equal_in_constant_time(session, jog_->secret))
    throw Error(Errc::usage, "session", "this jog has ended; the coils are switched off");
  return jog_;
}

Json BenchConsole::jog_set(const std::string& session, std::uint64_t number,
                           const std::vector<double>& current) {
  const auto jog = jog_of(session);
  {
    const std::lock_guard lock(jog->mutex);
    if (number <= jog->number)
      throw Error(Errc::usage, "number",
                  fmt::format("{} is not after {}, the newest message of this jog", number, jog->number));
    jog->number = number;
    jog->heard = monotonic_now();
    jog->current = current;
  }
  const Json all = describe(false);
  return {{"coils", all["coils"]}, {"guard", all["guard"]}, {"armed", all["armed"]}};
}

void BenchConsole::jog_reset(const std::string& session, std::uint64_t page, const std::string& permit) {
  const auto jog = jog_of(session);
  permits_.use(permit, page, "jog", monotonic_now());
  const std::lock_guard lock(jog->mutex);
  jog->reset = true;
  jog->heard = monotonic_now();
  jog->current.clear();
}

}  // namespace faba
