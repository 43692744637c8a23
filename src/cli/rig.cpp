#include <fmt/format.h>

#include <cmath>

#include <cstdio>

#include "app/bench/bench_session.h"
#include "app/bench/capture.h"
#include "app/bench/open_bench.h"
#include "app/bench/replay.h"
#include "app/bench/simulated_bench.h"
#include "app/bench/step_response.h"
#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "cli/progress.h"
#include "cli/quantity.h"
#include "cli/scene.h"
#include "cli/verbs.h"
#include "study/pages/run_report.h"
#include "study/plot/markup.h"
#include "study/steering/metrics.h"

namespace faba::cli {
namespace {

// A bench has a camera, which tells no cells.
Scenario bench_scene(const RigVerb& v) {
  Document d = read_scene(v.run);
  d.set("camera.sensor", Json("frames"), "faba rig");
  return read_scenario(d, builtin_parts());
}

void require_arm(const RigVerb& v) {
  if (v.arm) return;
  throw Error(Errc::usage, "--arm",
              "is missing: coils are disarmed until somebody who sees them says so; to look only, `faba rig "
              "check`");
}

void latency(std::uint64_t frames, const Manifest::Bench& b) {
  const auto ms = [](double v) { return std::isnan(v) ? std::string("-") : three_digits(v) + " ms"; };
  fmt::print("frames {} taken, {} dropped, {} corrupt; {} after mid-exposure at the program (median)\n",
             frames, b.frames_dropped, b.frames_corrupt, ms(b.arrival.median));
  fmt::print("command at the coils {} after the frame came (median), 99.9 % within {}\n",
             ms(b.command.median), ms(b.command.p999));
  if (b.guard_rests > 0)
    fmt::print("the coils came to rest {} time{}, because no command came in time\n", b.guard_rests,
               b.guard_rests == 1 ? "" : "s");
}

}  // namespace

int rig_run(const RigVerb& v, const Common& c) {
  Scenario s = bench_scene(v);
  const std::uint64_t seed = s.params.seed.value_or(drawn_seed());
  require_arm(v);
  Progress bar("on the bench", !c.quiet && !c.json);
  RunOptions o;
  o.out = v.run.out;
  if (o.out.empty()) o.out = fmt::format("runs/{}-bench", std::filesystem::path(v.run.scene).stem().string());
  o.numbered = v.run.out.empty();
  o.force = v.run.force;
  o.threads = v.run.threads;
  o.program = shell_word(program());
  refuse_own_input(v.run);
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = &stop_requested();
  const auto bench = std::make_shared<OpenBench>(s, seed);
  BenchSession session = BenchSession::begin(s, bench, seed, o);
  bool whole = false;
  try {
    whole = session.run();
  } catch (const Error&) {
    std::error_code ec;  // what was recorded can be looked at, too
    if (std::filesystem::exists(session.dir() / run_files::kManifest, ec))
      write_run_report(session.dir(), run_info(session.manifest()), session.series());
    throw;
  }
  bar.clear();
  const Manifest& manifest = session.manifest();
  const Series series = session.series();
  write_run_report(session.dir(), run_info(manifest), series);
  if (whole) session.complete();
  const Metrics metrics = control_metrics(series);
  if (!c.quiet)
    for (const std::string& note : manifest.notes) tell(fmt::format("faba: note: {}: {}", v.run.scene, note));
  if (c.json) {
    Json j = {{"out", session.dir().string()}};
    for (const auto& source : {manifest_json(manifest), metrics_json(metrics)})
      for (const auto& [k, value] : source.items())
        if (!j.contains(k)) j[k] = value;
    fmt::print("{}\n", j.dump());
  } else if (!c.quiet) {
    fmt::print("{}\n", run_in_words(metrics, run_info(manifest)).outcome);
    latency(manifest.frames, *manifest.bench);
    fmt::print("  report {}\n", (session.dir() / "report.html").string());
  }
  return whole ? 0 : int(Errc::interrupted);
}

int rig_capture(const RigVerb& v, const Common& c) {
  Scenario s = bench_scene(v);
  CaptureJob job;
  job.out = v.run.out, job.force = v.run.force;
  job.frames = v.frames, job.one_of = v.one_of, job.buffered = v.buffered;
  const auto span = [](const std::string& words, const char* option) {
    const double value = quantity_of(words, "s", option, "500 ms");
    if (!(value > 0)) throw Error(Errc::usage, option, "must be above zero");
    return value;
  };
  if (v.time) job.time = span(*v.time, "--for");
  if (v.every) job.every = span(*v.every, "--every");
  const std::string ending = job.out.extension().string();
  job.format = !v.format.empty() ? v.format : ending == ".mp4" ? "mp4" : ending == ".avi" ? "avi" : "png";
  if (!v.format.empty() && (ending == ".mp4" || ending == ".avi"))
    throw Error(Errc::usage, "--format", "is for pictures, and --out names a video");
  if (v.format.empty() && job.format == "png" && !ending.empty())
    throw Error(Errc::usage, job.out.string(),
                "end it in .avi or .mp4 for a video, or say --format for a folder of pictures");
  job.patience = s.rig ? s.rig->params.camera_timeout : job.patience;
  job.stop = &stop_requested();
  Progress bar("capturing", !c.quiet && !c.json);
  job.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  const OpenBench bench(s, s.params.seed.value_or(1));
  const Captured done = capture(bench.camera(), job);
  bar.clear();
  if (c.json)
    fmt::print("{}\n", Json{{"out", job.out.string()},
                            {"frames", done.taken},
                            {"kept", done.kept},
                            {"frames_dropped", done.dropped},
                            {"frames_corrupt", done.corrupt},
                            {"duration_s", done.duration},
                            {"memory_full", done.memory_full}}
                           .dump());
  else if (!c.quiet)
    fmt::print("{}: {} of {} frames in {:.2f} s, {} dropped, {} corrupt{}\n", job.out.string(), done.kept,
               done.taken, done.duration, done.dropped, done.corrupt,
               done.memory_full ? "; ended because memory went short" : "");
  // With an end of its own it was broken off; else that is how it ends.
  const bool cut = stop_requested().load() && (job.frames > 0 || job.time > 0 || done.kept == 0);
  return cut ? int(Errc::interrupted) : 0;
}

int rig_step_response(const RigVerb& v, const Common& c) {
  StepResponseJob job;
  job.scene = read_scene(v.run);
  if (v.exposure) job.scene.set("exposure", *v.exposure, "--exposure");
  if (v.repeat) job.scene.set("rig.step_response.repeat", *v.repeat, "--repeat");
  if (v.every) job.scene.set("rig.step_response.every", *v.every, "--every");
  const Scenario s = read_scenario(job.scene, builtin_parts());
  job.seed = s.params.seed.value_or(drawn_seed());
  require_arm(v);
  job.experiment = v.experiment;
  Progress bar("on the bench", !c.quiet && !c.json);
  job.run.out = v.run.out;
  if (job.run.out.empty())
    job.run.out = fmt::format("runs/{}-response", std::filesystem::path(v.run.scene).stem().string());
  job.run.threads = v.run.threads;
  job.run.program = shell_word(program());
  job.run.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  job.run.stop = &stop_requested();
  Json all = Json::array();
  job.done = [&](const RecordedResponse& r) {
    bar.clear();
    write_run_report(r.dir, read_run_info(r.dir / run_files::kManifest), read_series(r.dir / "series.csv"));
    all.push_back({{"out", r.dir.string()},
                   {"exposure_s", r.exposure},
                   {"cells", r.cells},
                   {"swarm_px", r.at_px ? Json{r.at_px->x, r.at_px->y} : Json()},
                   {"frames", r.frames},
                   {"frames_dropped", r.dropped}});
    if (c.json || c.quiet) return;
    fmt::print("{}: after {:.0f} s in air, {}; {} frames, {} dropped\n", r.dir.string(), r.exposure,
               r.at_px ? fmt::format("some {} cells about ({:.0f}, {:.0f}) px", three_digits(r.cells),
                                     r.at_px->x, r.at_px->y)
                       : "no swarm in view",
               r.frames, r.dropped);
    std::fflush(stdout);
  };
  const auto study = job.run.out / "study.toml";
  record_step_responses(job);
  bar.clear();
  if (c.json)
    fmt::print("{}\n", Json{{"study", study.string()}, {"responses", all}}.dump());
  else if (!c.quiet)
    fmt::print("now try: {} activity {}\n", shell_word(program()), shell_word(study.string()));
  return 0;
}

int rig_list(const Common& c) {
  const std::vector<Device> all = device_list();
  if (c.json) {
    Json j = Json::array();
    for (const Device& d : all) j.push_back({{"kind", d.kind}, {"name", d.name}, {"what", d.what}});
    fmt::print("{}\n", Json{{"devices", j}}.dump());
    return 0;
  }
  for (const Device& d : all) fmt::print("{:<14}  {:<24}  {}\n", d.kind, d.name, d.what);
  if (c.quiet) return 0;
  if (all.empty()) fmt::print("no cameras, serial lines or output devices are here\n");
  fmt::print(
      "always there: camera \"simulated\" and \"playback\", driver \"simulated\"; see faba parts camera, "
      "faba parts driver\n");
  return 0;
}

namespace {

Json check_json(const BenchCheck& b) {
  Json sensed = Json::array();
  for (const double a : b.sensed_a) sensed.push_back(std::isnan(a) ? Json() : Json(a));
  Json j = {{"camera", b.camera},
            {"size_px", {b.width_px, b.height_px}},
            {"rate_hz", b.rate_hz ? Json(*b.rate_hz) : Json()},
            {"frames", b.frames},
            {"dropped", b.dropped},
            {"corrupt", b.corrupt},
            {"age_ms", 1e3 * b.age_s},
            {"delay_ms", 1e3 * b.delay_s},
            {"driver", b.driver},
            {"guard", b.guard},
            {"cannot_arm", b.cannot_arm.empty() ? Json() : Json(b.cannot_arm)},
            {"sensed_a", sensed},
            {"swarm", nullptr}};
  if (b.swarm)
    j["swarm"] = {{"cells", b.swarm->cells},
                  {"centroid_px", {b.swarm->centroid_px.x, b.swarm->centroid_px.y}}};
  return j;
}

void print_check(const BenchCheck& b) {
  fmt::print(
      "camera   {}: {} x {} px, {}, {} after mid-exposure, decided on after {}; {} frames, {} dropped, {} "
      "corrupt\n",
      b.camera, b.width_px, b.height_px, b.rate_hz ? three_digits(*b.rate_hz) + " Hz" : "-",
      three_digits(1e3 * b.age_s) + " ms", three_digits(1e3 * b.delay_s) + " ms", b.frames, b.dropped,
      b.corrupt);
  if (b.swarm)
    fmt::print("swarm    some {} cells about ({}, {}) px\n", three_digits(b.swarm->cells),
               three_digits(b.swarm->centroid_px.x), three_digits(b.swarm->centroid_px.y));
  else
    fmt::print("swarm    none is seen\n");
  std::string sensed;
  for (const double a : b.sensed_a) sensed += " " + (std::isnan(a) ? "-" : fmt::format("{:.3f} A", a));
  fmt::print("coils    {}: {}; sensed{}\n", b.driver, b.guard, sensed);
  if (!b.cannot_arm.empty()) fmt::print("         cannot be armed: {}\n", b.cannot_arm);
}

}  // namespace

int rig_check(const RigVerb& v, const Common& c) {
  constexpr double kLook = 2;  // s
  Scenario s = bench_scene(v);
  const BenchCheck check = check_bench(s, s.params.seed.value_or(1), kLook);
  if (c.json)
    fmt::print("{}\n", check_json(check).dump());
  else
    print_check(check);
  return check.cannot_arm.empty() ? 0 : int(Errc::device);
}

int rig_replay(const RigVerb& v, const Common& c) {
  Progress bar("replaying", !c.quiet && !c.json);
  const Replayed r = replay_run(v.run.scene, [&](std::uint64_t done, std::uint64_t of) {
    bar.update(done, of);
    return !stop_requested().load();
  });
  bar.clear();
  const bool same = r.equal == r.recorded;
  if (c.json)
    fmt::print("{}\n", Json{{"recorded", r.recorded},
                            {"equal", r.equal},
                            {"same", same},
                            {"first_other", r.first_other ? Json(*r.first_other) : Json()}}
                           .dump());
  else if (!c.quiet)
    fmt::print("{} of {} commands are the same, bit for bit{}\n", r.equal, r.recorded,
               r.first_other ? fmt::format("; the first other one is that of frame {}", *r.first_other) : "");
  return same ? 0 : int(Errc::internal);
}

int rig_simulate(const RigVerb& v, const Common& c) {
  const Scenario s = bench_scene(v);
  const std::uint64_t seed = s.params.seed.value_or(drawn_seed());
  std::error_code ec;
  if (!v.run.force && std::filesystem::exists(v.log, ec))
    throw Error(Errc::usage, v.log.string(), "exists; choose another --log, or --force to replace it");
  Pool pool(v.run.threads);
  const auto ready = [&] {
    if (c.quiet || c.json) return;
    fmt::print("a simulated bench at {}; Ctrl-C ends it\n", v.at.string());
    std::fflush(stdout);
  };
  const SimulatedBench::Summary done = SimulatedBench::run(
      s, seed, pool, {.at = v.at, .log = v.log, .once = v.once, .stop = &stop_requested(), .ready = ready});
  if (c.json)
    fmt::print(
        "{}\n",
        Json{{"frames", done.frames}, {"unfetched", done.unfetched}, {"behind_s", done.behind}}.dump());
  else if (!c.quiet)
    fmt::print("{} frames taken, {} that nobody fetched in time; at most {} ms behind the clock\n",
               done.frames, done.unfetched, three_digits(1e3 * done.behind));
  return 0;
}

}  // namespace faba::cli
