#include "study/identify/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random/distributions.h"
#include "study/stats/statistics.h"

namespace faba {
namespace {

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x / double(v.size());
  return sum;
}

/// The difference in energy score between another model and the best one.
struct Lead {
  std::size_t model = 0;
  bool extended = false;  ///< of that model with its best family
  double mean = 0, se = 0, half = 0;
  bool clear() const { return mean - half > 0; }
};

Lead lead_over(const FoundModel& best, const Identification& r, std::size_t other, bool extended) {
  const FoundModel& m = r.models[other];
  const std::vector<double>& scores = extended ? m.extended_scores : m.scores;
  Lead lead{.model = other, .extended = extended};
  std::vector<double> each;
  for (std::size_t e = 0; e < scores.size(); ++e) each.push_back(scores[e] - best.scores[e]);
  lead.mean = mean(each);
  const double n = double(each.size());
  if (n < 2) return lead;
  lead.se = sample_sd(each) / std::sqrt(n);
  lead.half = student_t_quantile(0.975, n - 1) * lead.se;
  return lead;
}

// Sentences about what the model does not explain.
std::string poor_fit(const FoundModel& m) {
  if (m.fit_p < FoundModel::kPoorFit)
    return fmt::format(
        " {} does not explain the videos: only {:.1g} % of its simulations deviate from their mean as much "
        "as "
        "the videos.",
        m.name, 100 * m.fit_p);
  if (const FamilyCheck* missed = m.missed_family())
    return fmt::format(" {} alone does not explain the videos: {}.", m.name, missed->what);
  if (m.fit_p < FoundModel::kDoubtfulFit)
    return fmt::format(" The fit of {} is doubtful (p = {:.2g}).", m.name, m.fit_p);
  return "";
}

// "dipole", or "dipole if the cells tumble".
std::string name_of(const Identification& r, const Lead& lead) {
  const FoundModel& m = r.models[lead.model];
  return lead.extended ? fmt::format("{} if {}", m.name, m.families[*m.extension].what) : m.name;
}

void rate(Identification& r, const Lead& plain, const Lead& next) {
  const FoundModel& best = r.models[r.best];
  r.score_lead = next.mean;
  r.score_lead_ci95 = {next.mean - next.half, next.mean + next.half};
  // A model that does not fit is at most the better one of two wrong models.
  const bool fits = best.fit_p >= FoundModel::kDoubtfulFit && !best.missed_family();
  const bool all_converged = std::all_of(
      r.models.begin(), r.models.end(), [](const FoundModel& m) { return !m.failed.empty() || m.converged; });
  // An extended model that makes clear evidence unclear, or is better than the best model.
  if (next.extended && !next.clear() && (plain.clear() || next.mean < 0)) r.rival = next.model;
  r.evidence = next.clear() && fits && all_converged ? "clear" : next.mean > next.se ? "weak" : "none";
  // Without evidence the model with fewer parameters is preferred.
  std::string simpler;
  const FoundModel& other = r.models[next.model];
  const std::string names = fmt::format("{} over {}", best.name, name_of(r, next));
  const std::string words =
      fmt::format("the energy score of {} is lower by {:.3g} per experiment (95 % interval {:.3g} to {:.3g})",
                  best.name, next.mean, (*r.score_lead_ci95)[0], (*r.score_lead_ci95)[1]);
  if (r.evidence == "none" && !next.extended && other.parameters.size() < best.parameters.size()) {
    r.best = next.model;
    simpler = fmt::format(" {} has fewer parameters and is preferred.", other.name);
  }
  r.words = (r.evidence == "clear"  ? fmt::format("Clear evidence for {}: {}.", names, words)
             : r.evidence == "weak" ? fmt::format("Weak evidence for {}: {}.", names, words)
                                    : fmt::format("No evidence for {}: {}.{}", names, words, simpler)) +
            poor_fit(r.models[r.best]);
}

}  // namespace

void judge(Identification& r) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < r.models.size(); ++i)
    if (r.models[i].failed.empty()) order.push_back(i);
  if (order.empty()) throw Error(Errc::input, r.study.title, r.models.front().failed);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return r.models[a].score < r.models[b].score; });
  r.best = order[0];
  const FoundModel& best = r.models[r.best];
  r.evidence = "none";
  if (order.size() < 2) {
    r.words = "Only one model was identified; there is no comparison of models." + poor_fit(best);
    return;
  }
  std::vector<Lead> leads;
  for (std::size_t k = 1; k < order.size(); ++k) {
    leads.push_back(lead_over(best, r, order[k], false));
    if (r.models[order[k]].extension) leads.push_back(lead_over(best, r, order[k], true));
  }
  const Lead plain = leads.front(),
             next = *std::min_element(leads.begin(), leads.end(),
                                      [](const Lead&a, const Lead&b) { return a.mean < b.mean; });
  if (best.scores.size() < 2) {
    r.score_lead = plain.mean;
    r.words =
        fmt::format(
            "No evidence: a comparison needs at least two experiments. The energy score of {} is lower than "
            "that of {}.",
            best.name, r.models[plain.model].name) +
        poor_fit(best);
    return;
  }
  rate(r, plain, next);
}

}  // namespace faba
