#include "study/identify/identify.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "study/identify/derived_seed.h"
#include "study/identify/evidence.h"
#include "study/identify/families/family_checks.h"
#include "study/identify/legacy_selection.h"
#include "study/identify/response/measured_response.h"
#include "study/identify/sampled_episode.h"
#include "study/identify/simulation_round.h"
#include "study/identify/u_turn.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

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

// The magnetic moment is estimated from the duration of U-turns; a U-turn shorter than a frame carries no
// information.
void add_u_turn_doubt(FoundModel& m, const IdentifyStudy& study, const Candidate& c,
                      const std::vector<ResponseVideo>& videos) {
  const ResponseVideo& v = videos.front();
  for (FoundParameter& p : m.parameters) {
    if (p.parameter.role != Role::coupling || p.doubt.empty()) continue;
    const Document d =
        candidate_scenario(study, c, v, v.episodes.front(), VectorXd::Constant(Index(c.free.size()), 0.5),
                           exact_timing(v.episodes.front()));
    const double turn = u_turn_s(d.root["swarm"][0]["model"], p.median, c.field_strength_in(v)),
                 frame = 1 / v.fps;
    if (turn < frame)
      p.doubt += fmt::format("; a U-turn lasts {:.2g} s, less than a frame ({:.2g} s): use a weaker field",
                             turn, frame);
  }
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

std::vector<CandidateSearch> searches_of(const IdentifyStudy& study, const ObservedStatistics& o) {
  std::vector<CandidateSearch> searches;
  for (std::size_t c = 0; c < study.candidates.size(); ++c) {
    const Candidate& candidate = study.candidates[c];
    searches.push_back(
        {std::make_unique<ParameterSearch>(int(candidate.free.size()), o.numbers, prior_of(candidate),
                                           SearchRounds::of(candidate.simulations),
                                           derived_seed(study.seed, SeedUse::search, c)),
         {}});
  }
  return searches;
}

// False when the sweep was stopped.
bool run_searches(std::vector<CandidateSearch>& searches, const IdentifyStudy& study,
                  const std::vector<ResponseVideo>& videos, const ObservedStatistics& o, ResultStore& results,
                  const SweepOptions& options) {
  for (std::size_t number = 0;; ++number) {
    SimulationRound round(study, videos, o);
    for (std::size_t c = 0; c < searches.size(); ++c)
      if (searches[c].failed.empty() && searches[c].search->next())
        round.add(c, *searches[c].search->next(), number);
    if (round.empty()) return true;
    if (!round.run(results, options)) return false;
    for (CandidateSearch& s : searches) {
      if (!s.failed.empty() || !s.search->next()) continue;
      try {
        s.search->take(round.take(results, s.search->next()->rows()));
      } catch (const Error& e) {
        if (e.code() != Errc::input) throw;
        s.failed = e.what();
      }
    }
  }
}

// Unit of each statistic in the scores, equal for all models: the mean of their noise.
VectorXd score_scale(const std::vector<CandidateSearch>& searches, const ObservedStatistics& o) {
  VectorXd scale = VectorXd::Zero(o.numbers.size());
  double models = 0;
  for (const CandidateSearch& s : searches)
    if (s.failed.empty()) {
      scale += noise_of(*s.search);
      models += 1;
    }
  return scale / std::max(1.0, models);
}

// Sets r.models; returns what the checks of their families need.
std::vector<SearchedModel> find_models(Identification& r, const std::vector<CandidateSearch>& searches,
                                       const ObservedStatistics& o, const VectorXd& scale) {
  const IdentifyStudy& study = r.study;
  std::vector<SearchedModel> all(searches.size());
  r.models.resize(searches.size());
  for (std::size_t c = 0; c < searches.size(); ++c) {
    FoundModel& m = r.models[c];
    if (searches[c].failed.empty()) {
      ScoredModel scored = found_model(study.candidates[c], *searches[c].search, o.columns, o.parts_name,
                                       scale, derived_seed(study.seed, SeedUse::found_model, c));
      m = std::move(scored.model);
      all[c] = {searches[c].search.get(), &m, std::move(scored.samples)};
    }
    m.name = study.candidates[c].model.name;
    m.failed = searches[c].failed;
    add_u_turn_doubt(m, study, study.candidates[c], r.videos);
  }
  return all;
}

}  // namespace

std::optional<Identification> identify(const IdentifyStudy& study, std::vector<ResponseVideo> videos,
                                       ResultStore& results, const SweepOptions& options) {
  Identification r;
  r.study = study;
  r.videos = std::move(videos);
  check_same_camera(r.videos);
  for (ResponseVideo& v : r.videos) note_field_strength(study, v);
  const ObservedStatistics o = observed_statistics(r.videos);
  for (Index k = 0; k < o.numbers.size(); ++k)
    if (!std::isfinite(o.numbers[k]))
      throw Error(
          Errc::input, study.videos.front().file.string(),
          fmt::format("no cells detected in the measured frames ({})", o.statistics[std::size_t(k)].name));
  std::vector<CandidateSearch> searches = searches_of(study, o);
  if (!run_searches(searches, study, r.videos, o, results, options)) return {};
  const VectorXd scale = score_scale(searches, o);
  std::vector<SearchedModel> models = find_models(r, searches, o, scale);
  if (!check_families(study, r.videos, o, models, scale, results, options)) return {};
  r.statistics = o.statistics;
  r.experiments = o.experiments;
  r.parts = o.parts_name;
  judge(r);
  return r;
}

std::optional<Identification> identify(const IdentifyStudy& study, ResultStore& results,
                                       const SweepOptions& options, const std::function<void()>& reading) {
  auto r = identify(study, measured_responses(study, options, reading), results, options);
  if (!r || !study.legacy) return r;
  auto legacy = legacy_selection(study, r->videos, measured_references(study, r->videos, options, reading),
                                 results, options);
  if (!legacy) return {};
  r->legacy = std::move(*legacy);
  return r;
}

}  // namespace faba
