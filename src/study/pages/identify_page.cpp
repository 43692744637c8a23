#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/identify/identify_warnings.h"
#include "study/pages/calibration/calibration_report.h"
#include "study/pages/identify_figures.h"
#include "study/pages/identify_report.h"
#include "study/pages/provenance_output.h"
#include "study/pages/quality_output.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"
#include "study/quality/rounded.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

std::string with_interval(const FoundParameter& p) {
  const FreeParameter& q = p.parameter;
  const RoundedInterval text = rounded_interval(q.shown(p.median), {q.shown(p.ci90[0]), q.shown(p.ci90[1])});
  return fmt::format("{} [{}, {}]{}", text.value, text.low, text.high,
                     q.shown_unit().empty() ? "" : " " + q.shown_unit());
}

// The key of a parameter, which is the same in every language, and its interval.
std::string estimate_markup(const FoundParameter& p) {
  return fmt::format("<code>{}</code> {}", escape_markup(p.parameter.name()),
                     escape_markup(with_interval(p)));
}

std::string lead(const Identification& r) {
  const FoundModel& best = r.models[r.best];
  std::string found;
  for (const FoundParameter& p : best.parameters)
    if (!p.parameter.nuisance()) found += (found.empty() ? "" : ", ") + estimate_markup(p);
  return fmt::format(
      "<p class=\"lead\">{}</p>\n<p class=\"details\"><span>{}</span>: {} <span>(posterior median and 90 % "
      "interval)</span>.</p>\n",
      escape_markup(r.words), escape_markup(best.name), found);
}

bool single_experiment(const Identification& r) {
  const std::string& first = r.videos.front().input.experiment;
  return r.videos.size() == 1 ||
         (!first.empty() && std::all_of(r.videos.begin(), r.videos.end(),
                                        [&](const auto& v) { return v.input.experiment == first; }));
}

/// What the number of simulations in the table counts.
std::string simulations_text(const Identification& r) {
  std::string rounds;
  for (const FoundModel& m : r.models)
    if (m.failed.empty()) rounds += fmt::format("{}{} {}", rounds.empty() ? "" : ", ", m.name, m.rounds);
  return fmt::format(
      "Valid simulations: per video, of all rounds. The study requests {} in four rounds, and "
      "two more rounds if a model has more than three parameters; rounds are added while the posterior "
      "extends beyond the last one (rounds: {}), and simulations without "
      "a result, for example without cells in view, are not counted.",
      r.study.simulations, escape_markup(rounds));
}

/// What the bootstrap resamples, and when its interval is not reliable.
std::string bootstrap_text(const Identification& r) {
  constexpr std::size_t kFew = 10;
  const std::size_t n = r.experiments.size();
  if (n < 3) {
    return fmt::format(
        "<p class=\"note\">No bootstrap interval: it needs at least three {}, and the study has {}.</p>\n",
        r.parts, n);
  }
  std::string out = fmt::format(
      "<p class=\"note\">Bootstrap: the {0} {1} are resampled with replacement 1000 times, each with all of "
      "its "
      "statistics; the parameters are estimated from each resample.",
      n, r.parts);
  if (n < kFew) {
    out += fmt::format(
        " With fewer than ten {} this interval is not reliable: it is too narrow on average (by the factor "
        "√((n − 1)/n) = {:.2f} for n = {}), and its limits depend on single {}.",
        r.parts, std::sqrt(double(n - 1) / double(n)), n, r.parts);
  }
  if (single_experiment(r)) {
    out +=
        " Field segments of one swarm have the same cells: the interval does not contain the variation "
        "between "
        "experiments.";
  }
  return out + "</p>\n";
}

// The parameters of the study, or the nuisance parameters.
std::string parameters_text(const FoundModel& m, bool nuisance) {
  std::string out;
  for (const FoundParameter& p : m.parameters)
    if (p.parameter.nuisance() == nuisance) out += (out.empty() ? "" : "<br />") + estimate_markup(p);
  return out.empty() ? "–" : out;
}

std::string families_table(const Identification& r) {
  const FoundModel& m = r.models[r.best];
  if (m.families.empty()) return "";
  std::string out = fmt::format(
      "<h2>Extensions of {}</h2>\n<div class=\"wide\"><table "
      "class=\"numbers\">\n<thead><tr><th>extension</th><th>amount ± standard "
      "error</th><th>t</th><th>p</th></tr></thead>\n<tbody>\n",
      escape_markup(m.name));
  for (const FamilyCheck& c : m.families)
    out += fmt::format(
        "<tr><th scope=\"row\">{}{}</th><td>{:.2g} ± {:.1g} {}</td><td>{:.1f}</td><td>{:.2g}</td></tr>\n",
        escape_markup(c.what), c.significant ? " (significant)" : "", c.amount, c.sd, escape_markup(c.unit),
        c.t, c.p);
  return out +
         "</tbody></table></div>\n<p class=\"note\">Score tests: does an extension explain how the videos "
         "deviate from the model, while all its parameters may adapt? The amounts are extrapolated from "
         "simulations with a fixed amount. Significant: the probability that any of these tests is "
         "significant for a model that is right is 1 %.</p>\n";
}

std::string models_table(const Identification& r) {
  std::string out =
      "<h2>Models</h2>\n<div class=\"wide\"><table "
      "class=\"numbers\">\n<thead><tr><th>model</th><th>parameters, median "
      "and 90 % interval</th><th>nuisance parameters</th><th>energy score</th><th>fit p</th><th>valid "
      "simulations</th></tr></thead>\n<tbody>\n";
  for (const FoundModel& m : r.models) {
    if (!m.failed.empty()) {
      out += fmt::format(
          "<tr><th scope=\"row\">{}</th><td>{}</td><td>–</td><td>–</td><td>–</td><td>–</td></tr>\n",
          escape_markup(m.name), escape_markup(m.failed));
      continue;
    }
    out += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{:.2g}</td><td>{}</td></tr>\n",
        escape_markup(m.name), parameters_text(m, false), parameters_text(m, true), three_digits(m.score),
        m.fit_p, m.simulations);
  }
  return out + fmt::format(
                   "</tbody></table></div>\n<p class=\"note\">Energy score: mean over {} "
                   "{}, each predicted from the others; lower is better. Fit p: fraction of the "
                   "simulations that deviate from their mean as much as the videos do; below 0.01 the model "
                   "does not explain the videos. Nuisance parameters: free by default, with assumed priors. "
                   "{}{}</p>\n",
                   r.experiments.size(), r.parts, simulations_text(r),
                   single_experiment(r)
                       ? " The field segments show the same swarm and are not independent: the "
                         "interval of the score difference is too narrow."
                       : "");
}

// Both with the grey scale of the video.
RgbImage side_by_side(const GrayF& real, const GrayF& simulated) {
  const int gap = 4;
  RgbImage out(2 * real.width + gap, real.height);
  std::fill(out.px.begin(), out.px.end(), Rgb{255, 255, 255});
  const auto copy = [&](const GrayF& from, int at) {
    for (int r = 0; r < from.height; ++r)
      for (int c = 0; c < from.width; ++c) {
        const auto g = std::uint8_t(std::lround(std::clamp(from.at(c, r), 0.0F, 255.0F)));
        out.at(at + c, r) = {g, g, g};
      }
  };
  copy(real, 0);
  copy(simulated, real.width + gap);
  return out;
}

std::string pictures(const Identification& r) {
  std::string out = "<h2>Video and simulation</h2>\n";
  for (const EpisodePictures& e : episode_pictures(r)) {
    out += "<div class=\"figures\">\n";
    for (std::size_t k = 0; k < e.t_s.size(); ++k)
      out += fmt::format(
          "<figure>\n<h3>{}, {:.2g} s</h3>\n{}<figcaption>Left: video. Right: simulation with {} at the "
          "posterior median.</figcaption>\n</figure>\n",
          escape_markup(e.name), e.t_s[k],
          inline_picture(side_by_side(e.real[k], e.simulated[k]),
                         "Frame of the video beside a frame of a simulation"),
          escape_markup(r.models[r.best].name));
    if (r.study.measure == Measure::density) out += figure_markup(e.distribution);
    out += "</div>\n";
  }
  return out;
}

std::string legacy(const Identification& r) {
  if (r.legacy.empty()) return "";
  std::string out =
      "<h2>Legacy: selection rule of the 2016 thesis</h2>\n<p class=\"warning\">Not reliable: the rule "
      "selects the value at which the difference between video and simulation does not grow over time, and a "
      "difference that is large from the start does not grow either. It fails in tests with known true "
      "values. The results above do not use it.</p>\n<div class=\"wide\"><table "
      "class=\"numbers\">\n<thead><tr><th>model</th><th>slope is zero at</th><th>95 % "
      "interval</th><th>difference, mean ± s.d.</th><th>smallest difference at</th></tr></thead>\n<tbody>\n";
  for (const LegacyModel& m : r.legacy) {
    const FreeParameter& q = m.parameter;
    const std::string interval = m.zero_ci95
                                     ? fmt::format("{} to {}", three_digits(q.shown((*m.zero_ci95)[0])),
                                                   three_digits(q.shown((*m.zero_ci95)[1])))
                                     : "unbounded";
    out += fmt::format(
        "<tr><th scope=\"row\">{}<small>{}</small></th><td>{}</td><td>{}</td><td>{} ± "
        "{}</td><td>{}</td></tr>\n",
        escape_markup(m.name),
        escape_markup(m.invalid_reason.empty() ? "" : "Invalid: " + m.invalid_reason + "."),
        three_digits(q.shown(m.zero)), interval, three_digits(m.mean), three_digits(m.sd),
        three_digits(q.shown(m.least_distance_at)));
  }
  out += "</tbody></table></div>\n<div class=\"figures\">\n";
  for (const LegacyModel& m : r.legacy)
    for (const Figure& f : legacy_figures(m)) out += figure_markup(f);
  return out + "</div>\n";
}

std::string notes(const Identification& r) {
  std::string out;
  for (const std::string& note : notes_of(r)) out += fmt::format("<li>{}</li>\n", escape_markup(note));
  for (const ResponseVideo& v : r.videos)
    out += fmt::format(
        "<li>{}: {:.4g} um per px, {:.4g} frames per second, field strength {:.3g} uT; time zero is at "
        "{:.4g} s of the video.</li>\n",
        escape_markup(v.input.file.string()), v.um_per_px, v.fps,
        1e6 * r.study.candidates[r.best].field_strength_in(v), v.episodes.front().start_s);
  out += fmt::format("<li>Seed {}.</li>\n", r.study.seed);
  return "<h2>Notes</h2>\n<ul>\n" + out + "</ul>\n";
}

}  // namespace

std::string identify_page(const Identification& r, const Provenance& provenance) {
  std::string out = fmt::format("<h1>{}</h1>\n", escape_markup(r.study.title)) + lead(r) +
                    calibration_note(r.study) + quality_markup(identify_warnings(r)) + models_table(r) +
                    families_table(r);
  out += "<h2>Observation and posterior prediction of the best model</h2>\n<div class=\"figures\">\n";
  for (const Figure& f : predictive_figures(r)) out += figure_markup(f);
  out += "</div>\n" + pictures(r) + "<h2>Parameters of the best model</h2>\n" + bootstrap_text(r) +
         "<div class=\"figures\">\n";
  for (const FoundParameter& p : r.models[r.best].parameters)
    out += figure_markup(posterior_figure(p, r.parts)) + figure_markup(profile_figure(p));
  return html_page(r.study.title, out + "</div>\n" + legacy(r) + notes(r) + provenance_markup(provenance));
}

}  // namespace faba
