#include "study/motion/compare.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "study/data/run_info.h"
#include "study/data/run_video.h"
#include "study/motion/segments.h"
#include "study/motion/video_look.h"
#include "vision/image/kernels/histogram_distance.h"

namespace faba {
namespace {

constexpr double kReversalGap = 0.7;    // largest time between opposite motions of a reversal, s
constexpr double kRise = 0.4;           // window before and after a rise of activity, s
constexpr double kOppositeStart = 120;  // degrees
constexpr double kSamePeriod = 0.02;    // relative difference below which frame periods count as equal

/// The start of the response in a video.
struct ResponseStart {
  enum class By { nothing, rise, motion, reversal };
  double t0_s = 0, direction_deg = 0;
  By by = By::nothing;
};
const char* alignment_text(ResponseStart::By by) {
  switch (by) {
    case ResponseStart::By::reversal:
      return "from the reversal of the motion";
    case ResponseStart::By::motion:
      return "from the start of the first motion";
    case ResponseStart::By::rise:
      return "from the steepest rise of activity";
    default:
      return "from the first frame, because no motion was detected";
  }
}

// For cells that move further than their size between frames, whose flow has a start but no direction.
ResponseStart steepest_rise(const Signature& s) {
  ResponseStart b;
  double most = 0;
  for (std::size_t k = 1; k < s.size(); ++k) {
    double before = 0, after = 0;
    int n = 0, m = 0;
    for (std::size_t i = k; i-- > 0 && s.t0_s(k) - s.t0_s(i) <= kRise;) {
      before += s.speed(i);
      ++n;
    }
    for (std::size_t i = k; i < s.size() && s.t1_s(i) - s.t0_s(k) <= kRise; ++i) {
      after += s.speed(i);
      ++m;
    }
    if (n < 2 || m < 2) continue;
    if (const double rise = after / m - before / n; rise > most) {
      most = rise;
      b = {s.t0_s(k), 0, ResponseStart::By::rise};
    }
  }
  return b;
}

ResponseStart response_start(const Signature& s, std::optional<double> direction) {
  const std::vector<MotionSegment> segments = motion_segments(s, direction);
  ResponseStart b;
  if (segments.empty()) return steepest_rise(s);
  b = {segments.front().t0_s, segments.front().direction_deg, ResponseStart::By::motion};
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const double turn =
        std::fabs(std::remainder(segments[i].direction_deg - segments[i - 1].direction_deg, 360));
    if (turn < kOppositeStart || segments[i].t0_s - segments[i - 1].t1_s > kReversalGap) continue;
    return {segments[i].t0_s, segments[i].direction_deg, ResponseStart::By::reversal};
  }
  return b;
}

// Flows in px are comparable at the same scale only; 2 % is within the uncertainty of a calibration (A20).
void warn_scale(const VideoScale& reference, ComparedRun& run) {
  constexpr double kSame = 0.02;
  const auto& of_reference = reference.um_per_px;
  const auto& of_run = run.scale.um_per_px;
  if (!of_reference || !of_run || std::fabs(*of_run / *of_reference - 1) < kSame) return;
  run.warnings.push_back({"scale", "the videos have different scales, but flows are compared in px",
                          fmt::format("{:.4g} and {:.4g} um per px", *of_reference, *of_run),
                          "compare videos of one magnification", Quality::poor});
}

class Comparer {
 public:
  explicit Comparer(const CompareJob& job)
      : job_(job), distance_(BinSimilarity::truncated_linear(job.threshold), job.m) {}

  FlowSourceOptions options() const {
    return {.method = job_.method,
            .shrink = job_.shrink,
            .t0_s = job_.part.from_s,
            .t1_s = job_.part.to_s,
            .fps = job_.fps,
            .options_text = job_.options_text,
            .threads = job_.threads};
  }

  Signature signature(const std::filesystem::path& video, double threshold) {
    FlowSource source(video, options());
    Signature s(threshold, job_.direction_deg.value_or(0));
    FlowPair pair;
    while (source.next(pair)) {
      s.add(pair, source.shrink());
      tick("aligning", s.size(), source.pairs());
    }
    return s;
  }

  /// Notes on the reference; available after compare().
  const std::vector<std::string>& reference_notes() const { return reference_notes_; }

  double noise(const std::filesystem::path& video) {
    return noise_level(video, options(),
                       [&](auto done, auto total) { tick("determining the noise level", done, total); })
        .threshold_px;
  }

  /// Compares pair by pair from the start times. `no_motion`: also the distances of the reference to a video
  /// without motion, in the same reading.
  ComparedRun compare(const std::filesystem::path& run, double reference_t0, double t0,
                      const FlowFilter& filter, DistanceSeries* no_motion = nullptr) {
    ComparedRun result;
    result.file = run;
    result.t0_s = t0;
    furthest_ = -1;
    FlowSource reference(job_.reference, options()), other(run, options());
    if (other.width() != reference.width() || other.height() != reference.height())
      throw Error(
          Errc::input, run.string(),
          fmt::format(
              "has frames of {} x {} px, but the reference has {} x {} px; both must show the same view",
              other.width(), other.height(), reference.width(), reference.height()));
    result.scale = other.scale();
    warn_scale(reference.scale(), result);
    FlowPair a, b;
    VideoLook looks[2];
    bool have = other.next(b);
    double ratio = 1;
    while ((have || no_motion) && reference.next(a)) {
      const double at = (a.t0_s + a.t1_s) / 2 - reference_t0, period = a.t1_s - a.t0_s;
      if (at < 0) continue;
      if (at > job_.duration_s) break;
      tick("comparing", a.frame + 1, reference.pairs());
      flow_histograms(a.flow, filter, 1, p_);
      if (no_motion) take_still(at, *no_motion);
      while (have && (b.t0_s + b.t1_s) / 2 - t0 < at - period / 2) have = other.next(b);
      if (!have || (b.t0_s + b.t1_s) / 2 - t0 > at + period / 2) continue;  // the end of the run, or a gap
      ratio = period / (b.t1_s - b.t0_s);
      if (std::fabs(ratio - 1) < kSamePeriod) ratio = 1;
      take(at, a, b, ratio, filter, result);
      looks[0].add(a.image);
      looks[1].add(b.image);
    }
    if (result.distance.t_s.size() < 3)
      throw Error(
          Errc::input, run.string(),
          fmt::format("has fewer than three pairs of frames in common with the reference after "
                      "alignment (at {:.2f} s in the reference, {:.2f} s here); see --t0 and --no-align",
                      reference_t0, t0));
    finish(result.distance);
    if (no_motion) {
      finish(*no_motion);
      reference_notes_ = reference.notes();
    }
    result.notes = other.notes();
    result.warnings = look_warnings(looks[0], looks[1], filter.threshold_px);
    if (other.method() != reference.method())
      result.warnings.push_back({"method",
                                 "the flows were computed with different methods: they are not comparable",
                                 fmt::format("{}; reference: {}", other.method(), reference.method()),
                                 "compute both with the same method and parameters", Quality::poor});
    if (ratio != 1)
      result.warnings.push_back({"frame_rate", "the frame periods differ; the flows were scaled accordingly",
                                 fmt::format("{:.3g} times that of the reference", 1 / ratio),
                                 "record both at the same frame rate: optical flow depends on it"});
    return result;
  }

 private:
  void tick(const char* what, std::uint64_t done, std::uint64_t total) {
    job_.progress(what, done, total);
    if (job_.stop())
      throw Error(Errc::interrupted, job_.reference.string(), "stopped; no output was written");
  }

  void take_still(double at, DistanceSeries& series) {
    for (auto [from, to] : {std::pair{&p_.x, &q_.x},
                            {&p_.y, &q_.y},
                            {&p_.right, &q_.right},
                            {&p_.left, &q_.left},
                            {&p_.down, &q_.down},
                            {&p_.up, &q_.up}})
      to->assign(from->size(), 0.0);
    add_distance(at, series);
  }

  void take(double at, const FlowPair& a, const FlowPair& b, double ratio, const FlowFilter& filter,
            ComparedRun& result) {
    flow_histograms(b.flow, filter, ratio, q_);
    add_distance(at, result.distance);
    if (const double last = result.distance.value.back(); last > furthest_) {
      furthest_ = last;
      result.furthest = {at, a.flow, b.flow, p_, q_};
    }
  }

  // The distance of the histograms p_ and q_.
  void add_distance(double at, DistanceSeries& series) {
    double squares = 0;
    for (const auto& [p, q] :
         {std::pair{&p_.right, &q_.right}, {&p_.left, &q_.left}, {&p_.down, &q_.down}, {&p_.up, &q_.up}}) {
      const double d = distance_(*p, *q);
      squares += d * d;
    }
    series.t_s.push_back(at);
    series.value.push_back(std::sqrt(squares));
    series.legacy.push_back(distance_(p_.x, q_.x) + distance_(p_.y, q_.y));
  }

  static void finish(DistanceSeries& s) {
    std::vector<double> frame(s.t_s.size());
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = double(i);
    s.mean = mean(s.value);
    s.sd = sample_sd(s.value);
    s.line = fit_line(frame, s.value);
    s.legacy_mean = mean(s.legacy);
    s.legacy_sd = sample_sd(s.legacy);
    s.legacy_line = fit_line(frame, s.legacy);
  }

  const CompareJob& job_;
  HistogramDistance distance_;
  FlowHistograms p_, q_;
  double furthest_ = -1;
  std::vector<std::string> reference_notes_;
};

/// A run of the same scenario with another seed, in a temporary folder that is deleted with this object.
class RepeatedRun {
 public:
  RepeatedRun(const std::filesystem::path& run, const CompareJob& job) {
    std::string name = (std::filesystem::temp_directory_path() / "faba-twin-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(Errc::internal, name,
                  "a temporary folder for a run with another seed cannot be created; see --no-floor");
    folder_ = name;
    try {
      Document d = read_toml(run / run_files::kScenario);
      const Scenario s = read_scenario(d, builtin_parts());
      const std::string seed = read_run_info(run / run_files::kManifest).seed;
      RunOptions o;
      o.out = folder_ / "run";
      o.threads = job.threads;
      o.progress = [&](auto done, auto total) {
        job.progress("simulating with another seed", done, total);
        if (job.stop()) throw Error(Errc::interrupted, run.string(), "stopped");
      };
      Session session = Session::begin(s, seed.empty() ? 1 : std::stoull(seed) + 1, o);
      session.run();
      session.complete();
    } catch (...) {
      remove();
      throw;
    }
  }
  ~RepeatedRun() { remove(); }
  RepeatedRun(const RepeatedRun&) = delete;
  RepeatedRun& operator=(const RepeatedRun&) = delete;
  std::filesystem::path run() const { return folder_ / "run"; }

 private:
  void remove() {
    std::error_code ec;
    std::filesystem::remove_all(folder_, ec);
  }
  std::filesystem::path folder_;
};

/// Mean distance between runs of one scenario with different seeds. The first such run is the reference.
void find_noise_floor(const CompareJob& job, Comparison& c) {
  std::vector<std::filesystem::path> same_scenario;
  std::string scenario;
  for (const auto& file : job.runs) {
    if (!is_run(file)) continue;
    const RunInfo info = read_run_info(file / run_files::kManifest);
    if (same_scenario.empty()) scenario = info.scenario_hash;
    if (info.scenario_hash == scenario) same_scenario.push_back(file);
  }
  if (same_scenario.empty()) {
    c.noise_floor_from =
        "not computed: none of the compared inputs is a run directory, and a video cannot be repeated with "
        "another seed";
    return;
  }
  std::optional<RepeatedRun> repeated;
  if (same_scenario.size() < 2) {
    if (!job.simulate_noise_floor) {
      c.noise_floor_from = "not computed, because of --no-floor";
      return;
    }
    repeated.emplace(same_scenario.front(), job);
    same_scenario.push_back(repeated->run());
    c.noise_floor_from =
        fmt::format("{} and a run of its scenario with another seed", same_scenario.front().string());
  } else {
    c.noise_floor_from = fmt::format("{} runs of the same scenario", same_scenario.size());
  }
  CompareJob noise_floor_job = job;
  noise_floor_job.reference = same_scenario.front();
  Comparer comparer(noise_floor_job);
  double sum = 0;
  for (std::size_t i = 1; i < same_scenario.size(); ++i) {
    double t0 = 0;
    for (const ComparedRun& r : c.runs)
      if (r.file == same_scenario.front()) t0 = r.t0_s;
    sum += comparer.compare(same_scenario[i], t0, t0, c.filter)
               .distance.mean;  // one scenario: equal field schedules
  }
  c.noise_floor = sum / double(same_scenario.size() - 1);
}

}  // namespace

std::optional<double> score_of(const Comparison& c, const ComparedRun& run) {
  if (!c.noise_floor || !(c.naive.mean > *c.noise_floor)) return {};
  return (run.distance.mean - *c.noise_floor) / (c.naive.mean - *c.noise_floor);
}

std::vector<Warning> all_warnings(const Comparison& c) {
  std::vector<Warning> all = c.warnings;
  for (const ComparedRun& r : c.runs)
    for (Warning w : r.warnings) {
      w.evidence = fmt::format("{}: {}", r.file.string(), w.evidence);
      all.push_back(std::move(w));
    }
  return all;
}

Comparison compare_videos(const CompareJob& job) {
  Comparer comparer(job);
  Comparison c;
  c.filter.threshold_px = job.flow_threshold_px ? *job.flow_threshold_px : comparer.noise(job.reference);
  ResponseStart reference;
  if ((job.align && !job.reference_t0_s) || !job.direction_deg)
    reference = response_start(comparer.signature(job.reference, c.filter.threshold_px), job.direction_deg);
  c.direction_given = job.direction_deg.has_value();
  c.filter.direction_deg = job.direction_deg.value_or(reference.direction_deg);
  if (!c.direction_given && reference.by < ResponseStart::By::motion)
    c.warnings.push_back({"direction",
                          "no directed motion was detected in the reference; the distance of the thesis "
                          "(legacy) uses the flow to the right",
                          "", "specify --direction"});
  c.reference_t0_s = job.reference_t0_s.value_or(job.align ? reference.t0_s : 0);
  c.alignment = !job.align           ? "from the first frame"
                : job.reference_t0_s ? "from the given time"
                                     : alignment_text(reference.by);
  for (const auto& file : job.runs) {
    double t0 = job.t0_s.value_or(0);
    ResponseStart b;
    const bool found = job.align && !job.t0_s;
    if (found) {
      b = response_start(comparer.signature(file, c.filter.threshold_px), job.direction_deg);
      t0 = b.t0_s;
    }
    ComparedRun run =
        comparer.compare(file, c.reference_t0_s, t0, c.filter, c.runs.empty() ? &c.naive : nullptr);
    if (found && (job.reference_t0_s ? b.by != ResponseStart::By::reversal : b.by != reference.by))
      run.warnings.push_back({"alignment",
                              "the start of the response was detected by another rule than in the reference",
                              fmt::format("{}, at {:.2f} s; the reference {}, at {:.2f} s",
                                          alignment_text(b.by), t0, c.alignment, c.reference_t0_s),
                              "specify --t0 and --reference-t0"});
    // The last pair ends half a period after its time; one further period is rounding.
    const std::vector<double>& t = run.distance.t_s;
    if (job.duration_s < CompareJob{}.duration_s && t.back() + 1.5 * (t[1] - t[0]) < job.duration_s)
      run.notes.push_back(fmt::format(
          "the comparison ends after {:.3g} s, where one of the two videos ends; --duration is {:g} s",
          t.back() + (t[1] - t[0]) / 2, job.duration_s));
    c.runs.push_back(std::move(run));
  }
  for (const std::string& note : comparer.reference_notes()) c.notes.push_back("the reference: " + note);
  find_noise_floor(job, c);
  return c;
}

}  // namespace faba
