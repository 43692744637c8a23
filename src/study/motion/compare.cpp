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
#include "vision/image/kernels/histogram_distance.h"

namespace faba {
namespace {

constexpr double kReversalGap = 0.7;  // s between two opposite motions that make a reversal
constexpr double kRise = 0.4;         // s before and after that a rise of activity is measured over
constexpr double kOpposite = 120;     // degrees
constexpr double kSamePeriod = 0.02;  // share by which frame periods may differ unsaid

/// Where a video's response begins.
struct Beginning {
  enum class By { nothing, rise, motion, reversal };
  double t0_s = 0, direction_deg = 0;
  By by = By::nothing;
};
const char* words_of(Beginning::By by) {
  switch (by) {
    case Beginning::By::reversal:
      return "from the reversal of the motion on";
    case Beginning::By::motion:
      return "from the beginning of the first motion on";
    case Beginning::By::rise:
      return "from the steepest rise of activity on";
    default:
      return "from the first frame on: nothing moves";
  }
}

// Where cells jump further than their size from frame to frame their flow has no direction, but begins all
// the same.
Beginning steepest_rise(const Signature& s) {
  Beginning b;
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
      b = {s.t0_s(k), 0, Beginning::By::rise};
    }
  }
  return b;
}

Beginning beginning_of(const Signature& s, std::optional<double> direction) {
  const std::vector<MotionSegment> segments = motion_segments(s, direction);
  Beginning b;
  if (segments.empty()) return steepest_rise(s);
  b = {segments.front().t0_s, segments.front().direction_deg, Beginning::By::motion};
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const double turn =
        std::fabs(std::remainder(segments[i].direction_deg - segments[i - 1].direction_deg, 360));
    if (turn < kOpposite || segments[i].t0_s - segments[i - 1].t1_s > kReversalGap) continue;
    return {segments[i].t0_s, segments[i].direction_deg, Beginning::By::reversal};
  }
  return b;
}

class Comparer {
 public:
  explicit Comparer(const CompareJob& job)
      : job_(job), pool_(job.threads), distance_(BinSimilarity::truncated_linear(job.threshold), job.m) {}

  FlowSourceOptions options() const {
    return {.method = job_.method, .shrink = job_.shrink, .fps = job_.fps, .options_text = job_.options_text};
  }

  Signature signature(const std::filesystem::path& video, double threshold) {
    FlowSource source(video, options(), pool_);
    Signature s(threshold, job_.direction_deg.value_or(0));
    FlowPair pair;
    while (source.next(pair)) {
      s.add(pair, source.shrink());
      tick("aligning", s.size(), source.pairs());
    }
    return s;
  }

  /// Of the reference, once something was compared with it.
  const std::vector<std::string>& reference_notes() const { return reference_notes_; }

  double noise(const std::filesystem::path& video) {
    return noise_level(video, options(), pool_,
                       [&](auto done, auto total) { tick("finding the noise", done, total); })
        .threshold_px;
  }

  /// Pair by pair, from the beginnings on. `run` empty: against a video in which nothing moves.
  ComparedRun compare(const std::filesystem::path& run, double reference_t0, double t0,
                      const FlowFilter& filter) {
    ComparedRun result;
    result.file = run;
    result.t0_s = t0;
    furthest_ = -1;
    FlowSource reference(job_.reference, options(), pool_);
    std::optional<FlowSource> other;
    if (!run.empty()) {
      other.emplace(run, options(), pool_);
      if (other->width() != reference.width() || other->height() != reference.height())
        throw Error(
            Errc::input, run.string(),
            fmt::format("has pictures of {} x {} px, the reference of {} x {}; they must show the same view",
                        other->width(), other->height(), reference.width(), reference.height()));
    }
    FlowPair a, b;
    bool have = other && other->next(b);
    double ratio = 1;
    while (reference.next(a)) {
      const double at = (a.t0_s + a.t1_s) / 2 - reference_t0, period = a.t1_s - a.t0_s;
      if (at < 0) continue;
      if (at > job_.duration_s) break;
      tick("comparing", a.frame + 1, reference.pairs());
      if (other) {
        while (have && (b.t0_s + b.t1_s) / 2 - t0 < at - period / 2) have = other->next(b);
        if (!have) break;
        if ((b.t0_s + b.t1_s) / 2 - t0 > at + period / 2) continue;  // a gap in the run
        ratio = period / (b.t1_s - b.t0_s);
        if (std::fabs(ratio - 1) < kSamePeriod) ratio = 1;
      }
      take(at, a, other ? &b : nullptr, ratio, filter, result);
    }
    if (result.distance.t_s.size() < 3)
      throw Error(Errc::input, run.empty() ? job_.reference.string() : run.string(),
                  fmt::format("has fewer than three pairs of frames in common with the reference after the "
                              "alignment ({:.2f} s in the reference, {:.2f} s here); see --t0 and --no-align",
                              reference_t0, t0));
    finish(result.distance);
    if (other) result.notes = other->notes();
    if (other && other->method() != reference.method())
      result.notes.push_back(
          fmt::format("its flows were made with {}, the reference's with {}: they are not alike",
                      other->method(), reference.method()));
    reference_notes_ = reference.notes();
    if (ratio != 1)
      result.notes.push_back(
          fmt::format("its frames are {:.3g} times as far apart as the reference's; flows were "
                      "brought to the reference's",
                      1 / ratio));
    return result;
  }

 private:
  void tick(const char* what, std::uint64_t done, std::uint64_t total) {
    job_.progress(what, done, total);
    if (job_.stop()) throw Error(Errc::interrupted, job_.reference.string(), "stopped; nothing was written");
  }

  void take(double at, const FlowPair& a, const FlowPair* b, double ratio, const FlowFilter& filter,
            ComparedRun& result) {
    flow_histograms(a.flow, filter, 1, p_);
    if (b) {
      flow_histograms(b->flow, filter, ratio, q_);
    } else {
      for (auto [from, to] : {std::pair{&p_.x, &q_.x},
                              {&p_.y, &q_.y},
                              {&p_.right, &q_.right},
                              {&p_.left, &q_.left},
                              {&p_.down, &q_.down},
                              {&p_.up, &q_.up}})
        to->assign(from->size(), 0.0);
    }
    double squares = 0;
    for (const auto& [p, q] :
         {std::pair{&p_.right, &q_.right}, {&p_.left, &q_.left}, {&p_.down, &q_.down}, {&p_.up, &q_.up}}) {
      const double d = distance_(*p, *q);
      squares += d * d;
    }
    DistanceSeries& series = result.distance;
    series.t_s.push_back(at);
    series.value.push_back(std::sqrt(squares));
    series.legacy.push_back(distance_(p_.x, q_.x) + distance_(p_.y, q_.y));
    if (b && series.value.back() > furthest_) {
      furthest_ = series.value.back();
      result.furthest = {at, a.flow, b->flow, p_, q_};
    }
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
  Pool pool_;
  HistogramDistance distance_;
  FlowHistograms p_, q_;
  double furthest_ = -1;
  std::vector<std::string> reference_notes_;
};

/// A run of the same scenario with another seed, in a folder of its own that goes with it.
class Twin {
 public:
  Twin(const std::filesystem::path& run, const CompareJob& job) {
    std::string name = (std::filesystem::temp_directory_path() / "faba-twin-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(Errc::internal, name,
                  "no folder can be made there for a run with another seed; see --no-floor");
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
  ~Twin() { remove(); }
  Twin(const Twin&) = delete;
  Twin& operator=(const Twin&) = delete;
  std::filesystem::path run() const { return folder_ / "run"; }

 private:
  void remove() {
    std::error_code ec;
    std::filesystem::remove_all(folder_, ec);
  }
  std::filesystem::path folder_;
};

/// Mean distance between runs of one scenario with different seeds; compares with the job's first such run in
/// the place of the reference.
void find_floor(const CompareJob& job, Comparison& c) {
  std::vector<std::filesystem::path> same;
  std::string scenario;
  for (const auto& file : job.runs) {
    if (!is_run(file)) continue;
    const RunInfo info = read_run_info(file / run_files::kManifest);
    if (same.empty()) scenario = info.scenario_hash;
    if (info.scenario_hash == scenario) same.push_back(file);
  }
  if (same.empty()) {
    c.floor_from =
        "not known: no run directory was given, and a video cannot be made again with another seed";
    return;
  }
  std::optional<Twin> twin;
  if (same.size() < 2) {
    if (!job.simulate_floor) {
      c.floor_from = "not asked for";
      return;
    }
    twin.emplace(same.front(), job);
    same.push_back(twin->run());
    c.floor_from = fmt::format("{} and its scenario run once more with another seed", same.front().string());
  } else {
    c.floor_from = fmt::format("{} runs of the same scenario", same.size());
  }
  CompareJob between = job;
  between.reference = same.front();
  Comparer comparer(between);
  double sum = 0;
  for (std::size_t i = 1; i < same.size(); ++i) {
    double t0 = 0;
    for (const ComparedRun& r : c.runs)
      if (r.file == same.front()) t0 = r.t0_s;
    sum +=
        comparer.compare(same[i], t0, t0, c.filter).distance.mean;  // one scenario: one schedule of the field
  }
  c.floor = sum / double(same.size() - 1);
}

}  // namespace

std::optional<double> score_of(const Comparison& c, const ComparedRun& run) {
  if (!c.floor || !(c.naive.mean > *c.floor)) return {};
  return (run.distance.mean - *c.floor) / (c.naive.mean - *c.floor);
}

Comparison compare_videos(const CompareJob& job) {
  Comparer comparer(job);
  Comparison c;
  c.filter.threshold_px = job.flow_threshold_px ? *job.flow_threshold_px : comparer.noise(job.reference);
  Beginning reference;
  if ((job.align && !job.reference_t0_s) || !job.direction_deg)
    reference = beginning_of(comparer.signature(job.reference, c.filter.threshold_px), job.direction_deg);
  c.direction_given = job.direction_deg.has_value();
  c.filter.direction_deg = job.direction_deg.value_or(reference.direction_deg);
  if (!c.direction_given && reference.by < Beginning::By::motion)
    c.notes.push_back(
        "nothing in the reference goes one way, so that the legacy distance is that of all flow to the "
        "right; "
        "give --direction");
  c.reference_t0_s = job.reference_t0_s.value_or(job.align ? reference.t0_s : 0);
  c.alignment = !job.align           ? "from the first frame on"
                : job.reference_t0_s ? "from the moment given on"
                                     : words_of(reference.by);
  for (const auto& file : job.runs) {
    double t0 = job.t0_s.value_or(0);
    Beginning b;
    const bool found = job.align && !job.t0_s;
    if (found) {
      b = beginning_of(comparer.signature(file, c.filter.threshold_px), job.direction_deg);
      t0 = b.t0_s;
    }
    ComparedRun run = comparer.compare(file, c.reference_t0_s, t0, c.filter);
    if (found && (job.reference_t0_s ? b.by != Beginning::By::reversal : b.by != reference.by))
      run.notes.push_back(
          fmt::format("taken {}, at {:.2f} s; the reference {}, at {:.2f} s. Give --t0 when that is "
                      "not the same moment",
                      words_of(b.by), t0, c.alignment, c.reference_t0_s));
    c.runs.push_back(std::move(run));
  }
  c.naive = comparer.compare({}, c.reference_t0_s, 0, c.filter).distance;
  for (const std::string& note : comparer.reference_notes()) c.notes.push_back("the reference: " + note);
  find_floor(job, c);
  return c;
}

}  // namespace faba
