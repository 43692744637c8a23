#include "python/runs.h"

#include <fmt/format.h>

#include <atomic>

#include "app/bench/bench_session.h"
#include "app/bench/replay.h"
#include "app/recording/run_directory.h"
#include "python/convert.h"
#include "python/reported_progress.h"
#include "python/scene.h"
#include "study/data/run_info.h"
#include "study/pages/reported_run.h"
#include "study/steering/metric_list.h"

namespace faba::python {
namespace {

/// Options of a recorded run whose progress and stop come from Python.
class WatchedRun {
 public:
  WatchedRun(const std::string& out, bool numbered, bool force, unsigned threads, const py::object& progress,
             const std::shared_ptr<Raised>& raised)
      : progress_(progress, raised) {
    options_.out = out;
    options_.numbered = numbered;
    options_.force = force;
    options_.threads = checked_threads(threads);
    options_.stop = &stop_;
    options_.progress = [this, raised](std::uint64_t done, std::uint64_t total) {
      progress_.report(done, total);
      if (raised->stopped()) stop_ = true;
    };
  }
  WatchedRun(const WatchedRun&) = delete;
  WatchedRun& operator=(const WatchedRun&) = delete;

  const RunOptions& options() const { return options_; }

 private:
  ReportedProgress progress_;
  std::atomic<bool> stop_{false};
  RunOptions options_;
};

std::string default_out(const Document& d, const std::string& end) {
  return fmt::format("runs/{}-{}", std::filesystem::path(d.name).stem().string(), end);
}

std::string note_of(const std::string& dir) { return "the recorded data are in " + dir; }

std::string run_scene(const py::object& scene, const py::object& out, const py::object& seed,
                      const py::object& set, const py::object& duration, const py::object& controller,
                      const py::object& estimator, const py::object& reference, unsigned threads, bool force,
                      bool as_seen, const py::object& progress) {
  const auto raised = std::make_shared<Raised>();
  const SceneArguments a{scene, seed, set, duration, {estimator, reference, controller}};
  Scenario s = read_scene(a, raised);
  if (as_seen) s.record.as_seen = true;
  const std::string dir = out.is_none() ? default_out(read_document(a), std::to_string(*s.params.seed))
                                        : py::str(out).cast<std::string>();
  const WatchedRun watched(dir, out.is_none(), force, threads, progress, raised);
  std::string made = dir;
  raised->run(
      [&] {
        Session session = Session::begin(s, *s.params.seed, watched.options());
        made = session.dir().string();
        run_with_report(session);
      },
      note_of(dir));
  return made;
}

void resume_run(const std::string& dir, const py::object& controller, const py::object& estimator,
                const py::object& reference, unsigned threads, const py::object& progress) {
  const auto raised = std::make_shared<Raised>();
  const Parts parts = GivenParts{estimator, reference, controller}.parts(raised);
  const WatchedRun watched(dir, false, false, threads, progress, raised);
  raised->run(
      [&] {
        Session session = Session::resume(parts, watched.options());
        run_with_report(session);
      },
      note_of(dir));
}

std::string bench_run(const py::object& scene, bool arm, const py::object& out, const py::object& seed,
                      const py::object& set, const py::object& duration, const py::object& controller,
                      const py::object& estimator, const py::object& reference, bool force,
                      const py::object& progress) {
  const auto raised = std::make_shared<Raised>();
  const SceneArguments a{scene, seed, set, duration, {estimator, reference, controller}};
  Document d = read_document(a);
  d.set("camera.sensor", Json("frames"), "bench");
  Scenario s = read_scenario_with(std::move(d), a.parts.parts(raised));
  if (!s.rig)
    throw Error(Errc::usage, "scene", "the table [rig] is missing; add it, as in scenes/bench.toml");
  if (!arm)
    throw Error(
        Errc::usage, "arm",
        "is False, so the coils would stay disarmed; give arm=True while a person supervises the coils");
  const std::string dir =
      out.is_none() ? default_out(read_document(a), "bench") : py::str(out).cast<std::string>();
  const WatchedRun watched(dir, out.is_none(), force, 0, progress, raised);
  std::string made = dir;
  raised->run(
      [&] {
        const auto bench = std::make_shared<OpenBench>(s, *s.params.seed);
        const GuardSetup setup = bench->guard_setup({});
        raised->longest_call = CoilGuard(setup.guard, setup.bounds(), setup.frame_period).command_deadline();
        BenchSession session = BenchSession::begin(s, bench, *s.params.seed, watched.options());
        made = session.dir().string();
        run_with_report(session);
      },
      note_of(dir));
  return made;
}

py::dict replay(const std::string& dir, const py::object& controller, const py::object& estimator,
                const py::object& reference) {
  const auto raised = std::make_shared<Raised>();
  const Parts parts = GivenParts{estimator, reference, controller}.parts(raised);
  Replayed r;
  raised->run(
      [&] { r = replay_run(dir, parts, [&](std::uint64_t, std::uint64_t) { return !raised->stopped(); }); });
  py::dict result;
  result["recorded"] = r.recorded;
  result["equal_commands"] = r.equal;
  result["same"] = r.equal == r.recorded;
  result["first_difference"] = r.first_difference ? py::object(py::int_(*r.first_difference)) : py::none();
  return result;
}

py::object run_metrics(const std::string& dir) {
  const RunInfo info = read_run_info(std::filesystem::path(dir) / run_files::kManifest);
  const Series series = read_series(std::filesystem::path(dir) / "series.csv");
  return object_of(metrics_json(
      control_metrics(series, info.setpoint_tolerance_px, std::size_t(info.setpoints.value_or(0)))));
}

}  // namespace

void bind_runs(py::module_& m) {
  const auto none = py::none();
  m.def("run_scene", run_scene, py::arg("scene"), py::kw_only(), py::arg("out") = none,
        py::arg("seed") = none, py::arg("set") = none, py::arg("duration") = none,
        py::arg("controller") = none, py::arg("estimator") = none, py::arg("reference") = none,
        py::arg("threads") = 0, py::arg("force") = false, py::arg("as_seen") = false,
        py::arg("progress") = none, "Records a simulated run; returns its directory.");
  m.def("resume_run", resume_run, py::arg("dir"), py::kw_only(), py::arg("controller") = none,
        py::arg("estimator") = none, py::arg("reference") = none, py::arg("threads") = 0,
        py::arg("progress") = none, "Continues an interrupted run from its last checkpoint.");
  m.def("bench_run", bench_run, py::arg("scene"), py::kw_only(), py::arg("arm") = false,
        py::arg("out") = none, py::arg("seed") = none, py::arg("set") = none, py::arg("duration") = none,
        py::arg("controller") = none, py::arg("estimator") = none, py::arg("reference") = none,
        py::arg("force") = false, py::arg("progress") = none,
        "Records a run on the bench of a scenario; returns its directory.");
  m.def("replay_run", replay, py::arg("dir"), py::kw_only(), py::arg("controller") = none,
        py::arg("estimator") = none, py::arg("reference") = none,
        "Computes the commands of a run on a bench again from its pictures.");
  m.def("run_metrics", run_metrics, py::arg("dir"), "Metrics of the control of a recorded run, a dict.");
}

}  // namespace faba::python
