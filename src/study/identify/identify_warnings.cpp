#include "study/identify/identify_warnings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace faba {
namespace {

constexpr double kMisses = 2.5;      // standard deviations; 1.2 % of the statistics of a model that is right
constexpr double kSameField = 0.02;  // relative
constexpr std::size_t kNamed = 3;    // statistics in a sentence

// The statistics that the model misses most.
std::string missed(const Identification& r, const FoundModel& m) {
  std::vector<StatisticCheck> checks = checks_of(r, m);
  std::erase_if(checks, [](const StatisticCheck& c) { return c.fits(); });
  std::sort(checks.begin(), checks.end(), [](const StatisticCheck& a, const StatisticCheck& b) {
    return std::fabs(a.deviation()) > std::fabs(b.deviation());
  });
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(kNamed, checks.size()); ++k)
    names.push_back(fmt::format("{} by {:+.1f} sd", checks[k].name, checks[k].deviation()));
  if (names.empty()) return "no single statistic differs clearly";
  return fmt::format("of {} statistics {} deviate, most of all {}", r.statistics.size(), checks.size(),
                     fmt::join(names, ", "));
}

std::string amount_of(const FamilyCheck& c) {
  return fmt::format("{:.2g} +- {:.1g} {} (standard error, extrapolated), t = {:.1f}", c.amount, c.sd, c.unit,
                     c.t);
}

// The aspect of the misfit, by the tests of families.
void warn_families(const FoundModel& m, std::vector<Warning>& out) {
  for (const FamilyCheck& c : m.families)
    if (c.named)
      out.push_back({c.aspect,
                     fmt::format("{} does not describe the videos as well as if {}", m.name, c.what),
                     fmt::format("{}; it removes {:.0f} % of the squared deviations", amount_of(c),
                                 100 * std::max(0.0, c.explained)),
                     fmt::format("{}, and repeat", c.advice),
                     m.fit_p < FoundModel::kPoorFit ? Quality::poor : Quality::doubtful});
}

void warn_fit(const Identification& r, std::vector<Warning>& out) {
  const FoundModel& m = r.models[r.best];
  if (!m.failed.empty() || !m.converged) return;  // tests near a wrong posterior mean nothing
  warn_families(m, out);
  if (m.missed_family() || m.fit_p >= FoundModel::kPoorFit) return;
  out.push_back(
      {"fit", fmt::format("{} does not explain the videos: its intervals are not those of the cells", m.name),
       fmt::format("goodness-of-fit p = {:.2g}; {}", m.fit_p, missed(r, m)),
       "no known property of the cells explains it; try other models, and check boundary, scale and times",
       Quality::poor});
}

// A model that would explain the videos as well as the best one.
void warn_rival(const Identification& r, std::vector<Warning>& out) {
  if (!r.rival) return;
  const FoundModel& m = r.models[*r.rival];
  const FamilyCheck& c = m.families[*m.extension];
  out.push_back(
      {c.aspect,
       fmt::format("{} may explain the videos as well as {} if {}", m.name, r.models[r.best].name, c.what),
       amount_of(c), fmt::format("{} of {}, and repeat", c.advice, m.name), Quality::doubtful});
}

// A search that ended in a wrong region: the model may be better than it appears.
void warn_search(const Identification& r, std::vector<Warning>& out) {
  for (const FoundModel& m : r.models)
    if (m.failed.empty() && !m.converged)
      out.push_back(
          {"search",
           fmt::format("the search for the parameters of {} ended far from the simulations that are nearest "
                       "to the videos",
                       m.name),
           fmt::format("fit p = {:.2g}", m.fit_p), "increase simulations, or give narrower ranges",
           &m == &r.models[r.best] ? Quality::poor : Quality::doubtful});
}

void warn_inputs(const Identification& r, std::vector<Warning>& out) {
  for (const ResponseVideo& v : r.videos) {
    const std::string file = v.input.file.string();
    if (v.recorded_um_per_px)
      out.push_back({"scale",
                     "the scale of the study differs from the recorded one; all lengths depend on it",
                     fmt::format("{}: {:g} um per px recorded", file, *v.recorded_um_per_px),
                     "remove um_per_px and scale from the study if the record is right"});
    const double field = r.study.candidates[r.best].field_strength_in(v);
    if (v.field_t && field > 0 && std::fabs(field / *v.field_t - 1) > kSameField)
      out.push_back(
          {"field_strength", "the field strength of the study differs from the recorded one",
           fmt::format("{}: {:.4g} uT recorded, {:.4g} uT simulated", file, 1e6 * *v.field_t, 1e6 * field),
           "remove field_strength from the study if the record is right"});
    if (v.segments_detected)
      out.push_back({"timing", "the field segments were detected in the video; all results depend on them",
                     file, "give reversal and direction, or [[video.segment]]"});
    const bool given = std::all_of(r.study.candidates.begin(), r.study.candidates.end(),
                                   [](const Candidate& c) { return c.field_strength_t.has_value(); });
    if (!given && !v.field_t)
      out.push_back(
          {"field_strength",
           "the field strength is unknown, and the default was simulated; speed and moment depend on it",
           fmt::format("{}: {:g} uT", file, 1e6 * kDefaultFieldStrength), "give field_strength"});
  }
}

}  // namespace

bool StatisticCheck::fits() const { return !(std::fabs(deviation()) > kMisses); }

std::vector<StatisticCheck> checks_of(const Identification& r, const FoundModel& m) {
  std::vector<StatisticCheck> out;
  for (std::size_t k = 0; k < m.predicted.size() && k < r.statistics.size(); ++k)
    out.push_back({r.statistics[k].name, r.statistics[k].observed, m.predicted[k], m.predicted_sd[k]});
  return out;
}

std::vector<Warning> identify_warnings(const Identification& r) {
  std::vector<Warning> out;
  warn_fit(r, out);
  warn_rival(r, out);
  warn_search(r, out);
  warn_inputs(r, out);
  for (const FoundParameter& p : r.models[r.best].parameters)
    if (!p.doubt.empty() && !p.parameter.nuisance())
      out.push_back({"parameter", p.doubt, "", "", Quality::doubtful});
  return out;
}

}  // namespace faba
