#include "study/identify/identify.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/error.h"
#include "core/hash.h"
#include "study/identify/derived_seed.h"
#include "study/identify/found_model.h"
#include "study/identify/legacy_selection.h"
#include "study/identify/parameter_search.h"
#include "study/identify/response_survey.h"
#include "study/identify/u_turn.h"
#include "study/stats/statistics.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Standard deviation of the time of a field reversal, frames: given to within one frame (uniform), and
// detected from the path of the swarm.
constexpr double kTimingGiven = 0.58, kTimingDetected = 1.5;

/// An episode of a video and the columns of its statistics in the list of all statistics.
struct Part {
  std::size_t video = 0, episode = 0;
  Index begin = 0, count = 0;
  std::shared_ptr<const EpisodeStatistics> statistics;
};

/// Statistics of all videos in one list, and their division into experiments.
struct Observed {
  std::vector<Part> parts;
  VectorXd numbers;
  std::vector<Identification::Statistic> statistics;
  std::vector<std::string> experiments;
  std::vector<std::vector<Index>> columns;  ///< of each experiment
  const char* parts_name = "experiments";   ///< "field segments" when these take the role of experiments
};

// With one experiment, its field segments take the role of experiments.
Observed gather(const std::vector<ResponseVideo>& videos) {
  Observed o;
  std::vector<double> numbers;
  std::vector<std::string> experiment, segment;  // of each statistic
  for (std::size_t v = 0; v < videos.size(); ++v)
    for (std::size_t e = 0; e < videos[v].episodes.size(); ++e) {
      const ResponseVideo& video = videos[v];
      const auto& statistics = video.statistics[e];
      const std::string name =
          video.input.experiment.empty() ? fmt::format("video {}", v + 1) : video.input.experiment;
      o.parts.push_back({v, e, Index(numbers.size()), Index(video.observed[e].size()), statistics});
      for (std::size_t k = 0; k < video.observed[e].size(); ++k) {
        numbers.push_back(video.observed[e][k]);
        const EpisodeStatistics::Number& n = statistics->numbers()[k];
        const bool several = videos.size() > 1 || video.episodes.size() > 1;
        o.statistics.push_back(
            {fmt::format("{}segment {}, {:.3g} s: {}", several ? video.episodes[e].name + ": " : "",
                         n.segment + 1, n.t_s, n.what),
             v, e, n, video.observed[e][k]});
        experiment.push_back(name);
        segment.push_back(fmt::format("{}, segment {}", name, e + n.segment + 1));
      }
    }
  const bool one =
      std::all_of(experiment.begin(), experiment.end(), [&](const auto& x) { return x == experiment[0]; });
  const auto& label = one ? segment : experiment;
  if (one) o.parts_name = "field segments";
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = std::find(o.experiments.begin(), o.experiments.end(), label[k]);
    const auto i = std::size_t(at - o.experiments.begin());
    if (at == o.experiments.end()) {
      o.experiments.push_back(label[k]);
      o.columns.emplace_back();
    }
    o.columns[i].push_back(Index(k));
  }
  o.numbers = Eigen::Map<VectorXd>(numbers.data(), Index(numbers.size()));
  return o;
}

std::string digest(const VectorXd& v) {
  Hash h;
  h.values(std::span<const double>(v.data(), std::size_t(v.size())));
  return h.hex();
}

/// Search for the parameters of one candidate.
struct CandidateSearch {
  std::unique_ptr<ParameterSearch> search;
  std::string failed;
};

ParameterSearch::LogPrior prior_of(const Candidate& c) {
  return [&c](const VectorXd& u) {
    double sum = 0;
    for (std::size_t j = 0; j < c.free.size(); ++j) sum += c.free[j].log_prior(u[Index(j)]);
    return sum;
  };
}

Document scenario_of(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v, const Episode& e,
                     const VectorXd& u, const SegmentTiming& timing) {
  Document d = episode_scenario(v, e, {study.boundary, study.scene, c.model, c.field_strength_in(v)}, timing);
  for (std::size_t j = 0; j < c.free.size(); ++j) d.set(c.free[j].path, c.free[j].json(u[Index(j)]), "free");
  return d;
}

/// The simulations of one round, as tasks.
class Round {
 public:
  Round(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos, const Observed& observed,
        const Parts& parts)
      : study_(study),
        videos_(videos),
        observed_(observed),
        parts_(parts),
        observed_digest_(digest(observed.numbers)) {}

  /// Adds simulations of candidate `candidate`, one for each row of `u` and each episode.
  void add(const Candidate& c, const MatrixXd& u, std::size_t candidate, std::size_t number) {
    for (Index i = 0; i < u.rows(); ++i)
      for (std::size_t p = 0; p < observed_.parts.size(); ++p)
        add_one(c, u.row(i).transpose(), candidate, number, i, p);
  }
  const std::vector<Task>& tasks() const { return tasks_; }

 private:
  void add_one(const Candidate& c, const VectorXd& u, std::size_t candidate, std::size_t number, Index i,
               std::size_t p) {
    const Part& part = observed_.parts[p];
    const ResponseVideo& video = videos_[part.video];
    // Independent seed for each simulation.
    Hash h;
    h.value(study_.seed);
    h.value(candidate);
    h.value(number);
    h.value(i);
    h.value(p);
    const std::uint64_t seed = h.result() >> 1;
    const Episode& episode = video.episodes[part.episode];
    const double timing_sd = (video.segments_detected ? kTimingDetected : kTimingGiven) / video.fps;
    const SegmentTiming timing = random_timing(episode, study_.timing_s.value_or(timing_sd), seed);
    const auto d = std::make_shared<const Document>(scenario_of(study_, c, video, episode, u, timing));
    const std::string key = task_key(fmt::format("response 1 {} {} {} {} {} {}", d->root.dump(), seed,
                                                 timing.lead_s, observed_digest_, p, int(study_.look)));
    tasks_.push_back({key, [this, d, seed, lead = timing.lead_s, &part, &video] {
                        try {
                          const EpisodeObservation seen =
                              simulate_episode(read_scenario(*d, parts_), seed, lead,
                                               part.statistics->times_s(), study_.look, video.ground);
                          std::vector<double> numbers = study_.look == Look::video
                                                            ? part.statistics->of_frames(seen.frames)
                                                            : part.statistics->of_positions(seen.positions);
                          StudyRandom random(seed, StudyDraws::measurement);
                          part.statistics->blur(numbers, random);
                          return numbers;
                        } catch (const Error& e) {
                          if (e.code() != Errc::usage) throw;
                          // Incompatible values, such as speeds that need too many steps.
                          return std::vector<double>(std::size_t(part.count), std::nan(""));
                        }
                      }});
  }
  const IdentifyStudy& study_;
  const std::vector<ResponseVideo>& videos_;
  const Observed& observed_;
  const Parts& parts_;
  std::string observed_digest_;
  std::vector<Task> tasks_;
};

// Statistics of the simulations of one candidate in a round, one row each, in the order of their tasks.
MatrixXd collect(const ResultStore& results, const std::vector<Task>& tasks, std::size_t& at, Index rows,
                 const Observed& o) {
  MatrixXd s = MatrixXd::Constant(rows, o.numbers.size(), std::nan(""));
  for (Index i = 0; i < rows; ++i)
    for (const Part& part : o.parts) {
      const std::vector<double>& values = *results.find(tasks[at++].key);
      if (Index(values.size()) != part.count)
        throw Error(
            Errc::usage, "results.jsonl",
            fmt::format("result with {} numbers, expected {}; delete the file to compute all results again",
                        values.size(), part.count));
      s.row(i).segment(part.begin, part.count) =
          Eigen::Map<const VectorXd>(values.data(), part.count).transpose();
    }
  return s;
}

// The magnetic moment is estimated from the duration of U-turns; a U-turn shorter than a frame carries no
// information.
void add_u_turn_doubt(FoundModel& m, const IdentifyStudy& study, const Candidate& c,
                      const std::vector<ResponseVideo>& videos) {
  const ResponseVideo& v = videos.front();
  for (FoundParameter& p : m.parameters) {
    if (p.parameter.role != Role::coupling || p.doubt.empty()) continue;
    const Document d =
        scenario_of(study, c, v, v.episodes.front(), VectorXd::Constant(Index(c.free.size()), 0.5),
                    exact_timing(v.episodes.front()));
    const double turn = u_turn_s(d.root["swarm"][0]["model"], p.median, c.field_strength_in(v)),
                 frame = 1 / v.fps;
    if (turn < frame)
      p.doubt += fmt::format("; a U-turn lasts {:.2g} s, less than a frame ({:.2g} s): use a weaker field",
                             turn, frame);
  }
}

// Posterior predictive intervals of the best model. False when the sweep was stopped.
bool predict(const IdentifyStudy& study, Identification& r, const ParameterSearch& search, const Observed& o,
             const Parts& parts, ResultStore& results, const SweepOptions& options) {
  constexpr int kPredictive = 40;           // simulations
  constexpr std::size_t kNumber = 1000000;  // round number that no search reaches
  const MatrixXd u = search.posterior({}, kPredictive, derived_seed(study.seed, SeedUse::best_model));
  Round round(study, r.videos, o, parts);
  round.add(study.candidates[r.best], u, r.best, kNumber);
  if (!sweep(results, round.tasks(), options)) return false;
  std::size_t at = 0;
  const MatrixXd simulated = collect(results, round.tasks(), at, u.rows(), o);
  for (Index k = 0; k < simulated.cols(); ++k) {
    std::vector<double> v;
    for (const double x : simulated.col(k))
      if (std::isfinite(x)) v.push_back(x);
    r.models[r.best].predicted90.push_back(v.empty() ? std::array{std::nan(""), std::nan("")}
                                                     : std::array{quantile(v, 0.05), quantile(v, 0.95)});
  }
  return true;
}

// All videos must have one frame size and one frame rate.
void check_same_camera(const std::vector<ResponseVideo>& videos) {
  const ResponseVideo& first = videos.front();
  for (const ResponseVideo& v : videos) {
    const auto differs = [&](int a, int b) {
      return std::abs(a * v.side - b * first.side) >= std::max(v.side, first.side);
    };
    if (differs(v.view.width, first.view.width) || differs(v.view.height, first.view.height))
      throw Error(
          Errc::input, v.input.file.string(),
          fmt::format("frame size {} x {} px differs from {} x {} px of {}; all videos of a study must come "
                      "from one camera",
                      v.view.width * v.side, v.view.height * v.side, first.view.width * first.side,
                      first.view.height * first.side, first.input.file.string()));
    if (std::fabs(v.fps / first.fps - 1) > 0.01)
      throw Error(
          Errc::input, v.input.file.string(),
          fmt::format("frame rate {:.4g} Hz differs from {:.4g} Hz of {}; all videos of a study must have "
                      "one rate",
                      v.fps, first.fps, first.input.file.string()));
  }
}

// The turning rate of cells depends on the field strength.
void note_field_strength(const IdentifyStudy& study, ResponseVideo& v) {
  constexpr double kSame = 0.02;
  for (const Candidate& c : study.candidates) {
    const double t = c.field_strength_in(v);
    if (!c.field_strength_t && !v.field_t) {
      v.notes.push_back(
          fmt::format("field strength unknown: simulated with the default, {:g} uT; give field_strength, "
                      "such as \"115 uT\"",
                      1e6 * t));
      return;
    }
    if (v.field_t && std::fabs(t / *v.field_t - 1) > kSame)
      v.notes.push_back(
          fmt::format("recorded field strength {0:.4g} uT; {1} is simulated with {2:.4g} uT, as given in the "
                      "study; if the "
                      "record is right, set field_strength = \"{0:.4g} uT\" in the study",
                      1e6 * *v.field_t, c.model.name, 1e6 * t));
  }
}

std::vector<CandidateSearch> searches_of(const IdentifyStudy& study, const Observed& o) {
  std::vector<CandidateSearch> searches;
  for (std::size_t c = 0; c < study.candidates.size(); ++c) {
    const Candidate& candidate = study.candidates[c];
    searches.push_back(
        {std::make_unique<ParameterSearch>(int(candidate.free.size()), o.numbers, prior_of(candidate),
                                           SearchRounds::of(study.simulations),
                                           derived_seed(study.seed, SeedUse::search, c)),
         {}});
  }
  return searches;
}

// False when the sweep was stopped.
bool run_searches(std::vector<CandidateSearch>& searches, const IdentifyStudy& study,
                  const std::vector<ResponseVideo>& videos, const Observed& o, const Parts& parts,
                  ResultStore& results, const SweepOptions& options) {
  for (std::size_t number = 0;; ++number) {
    Round round(study, videos, o, parts);
    for (std::size_t c = 0; c < searches.size(); ++c)
      if (searches[c].failed.empty() && searches[c].search->next())
        round.add(study.candidates[c], *searches[c].search->next(), c, number);
    if (round.tasks().empty()) return true;
    if (!sweep(results, round.tasks(), options)) return false;
    std::size_t at = 0;
    for (CandidateSearch& s : searches) {
      if (!s.failed.empty() || !s.search->next()) continue;
      try {
        s.search->take(collect(results, round.tasks(), at, s.search->next()->rows(), o));
      } catch (const Error& e) {
        if (e.code() != Errc::input) throw;
        s.failed = e.what();
      }
    }
  }
}

std::vector<FoundModel> models_of(const std::vector<CandidateSearch>& searches, const IdentifyStudy& study,
                                  const std::vector<ResponseVideo>& videos, const Observed& o) {
  VectorXd scale = VectorXd::Zero(o.numbers.size());
  double models = 0;
  for (const CandidateSearch& s : searches)
    if (s.failed.empty()) {
      scale += noise_of(*s.search);
      models += 1;
    }
  scale /= std::max(1.0, models);
  std::vector<FoundModel> found;
  for (std::size_t c = 0; c < searches.size(); ++c) {
    FoundModel m;
    if (searches[c].failed.empty())
      m = found_model(study.candidates[c], *searches[c].search, o.columns, o.parts_name, scale,
                      derived_seed(study.seed, SeedUse::found_model, c));
    m.name = study.candidates[c].model.name;
    m.failed = searches[c].failed;
    add_u_turn_doubt(m, study, study.candidates[c], videos);
    found.push_back(std::move(m));
  }
  return found;
}

}  // namespace

std::optional<Identification> identify(const IdentifyStudy& study, ResultStore& results, SweepOptions options,
                                       const std::function<void()>& reading) {
  Identification r;
  r.study = study;
  for (std::size_t v = 0; v < study.videos.size(); ++v) {
    ResponseInput input = study.videos[v];
    input.threads = options.threads;
    r.videos.push_back(survey_response(input, study.boundary, study.measure, [&] {
      reading();
      if (options.stop())
        throw Error(Errc::interrupted, study.videos[v].file.string(),
                    "stopped; completed results are kept; run the same command again to continue");
    }));
  }
  check_same_camera(r.videos);
  for (ResponseVideo& v : r.videos) note_field_strength(study, v);
  const Observed o = gather(r.videos);
  for (Index k = 0; k < o.numbers.size(); ++k)
    if (!std::isfinite(o.numbers[k]))
      throw Error(
          Errc::input, study.videos.front().file.string(),
          fmt::format("no cells detected in the measured frames ({})", o.statistics[std::size_t(k)].name));
  const Parts& parts = builtin_parts();
  std::vector<CandidateSearch> searches = searches_of(study, o);
  if (!run_searches(searches, study, r.videos, o, parts, results, options)) return {};
  r.models = models_of(searches, study, r.videos, o);
  r.statistics = o.statistics;
  r.experiments = o.experiments;
  r.parts = o.parts_name;
  judge(r);
  if (!predict(study, r, *searches[r.best].search, o, parts, results, options)) return {};
  if (study.legacy) {
    auto legacy = legacy_selection(study, r.videos, results, options, reading);
    if (!legacy) return {};
    r.legacy = std::move(*legacy);
  }
  return r;
}

}  // namespace faba
