#include "study/identify/identify_warnings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace faba {
namespace {

constexpr double kMisses = 2.5;    // standard deviations; 1.2 % of the statistics of a model that is right
constexpr std::size_t kNamed = 3;  // statistics in a sentence

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

void warn_fit(const Identification& r, std::vector<Warning>& out) {
  const FoundModel& m = r.models[r.best];
  if (!m.failed.empty() || m.fit_p >= FoundModel::kDoubtfulFit) return;
  out.push_back(
      {"fit", fmt::format("{} does not explain the videos: its intervals are not those of the cells", m.name),
       fmt::format("goodness-of-fit p = {:.2g}; {}", m.fit_p, missed(r, m)),
       "let the motile fraction, the responding fraction and the spread of the speed be free, and "
       "try other models",
       m.fit_p < FoundModel::kPoorFit ? Quality::poor : Quality::doubtful});
}

void warn_inputs(const Identification& r, std::vector<Warning>& out) {
  for (const ResponseVideo& v : r.videos) {
    const std::string file = v.input.file.string();
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
  warn_inputs(r, out);
  for (const FoundParameter& p : r.models[r.best].parameters)
    if (!p.doubt.empty()) out.push_back({"parameter", p.doubt, "", "", Quality::doubtful});
  return out;
}

}  // namespace faba
