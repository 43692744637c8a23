#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/pages/identify_figures.h"
#include "study/pages/identify_report.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

std::string with_interval(const FoundParameter& p) {
  const FreeParameter& q = p.parameter;
  return fmt::format("{} [{}, {}]{}", three_digits(q.shown(p.median)), three_digits(q.shown(p.ci90[0])),
                     three_digits(q.shown(p.ci90[1])), q.shown_unit().empty() ? "" : " " + q.shown_unit());
}

std::string lead(const Identification& r) {
  const FoundModel& best = r.models[r.best];
  std::string found;
  for (const FoundParameter& p : best.parameters)
    found += fmt::format("{}{} {}", found.empty() ? "" : ", ", p.parameter.name(), with_interval(p));
  std::string out = fmt::format(
      "<p class=\"lead\">{}</p>\n<p class=\"details\">{}: {}. Medians and 90 % of the posterior.</p>\n",
      escape_markup(r.words), escape_markup(best.name), escape_markup(found));
  for (const FoundParameter& p : best.parameters)
    if (!p.doubt.empty()) out += fmt::format("<p class=\"warning\">{}.</p>\n", escape_markup(p.doubt));
  return out;
}

bool one_drop(const Identification& r) {
  const std::string& first = r.videos.front().input.experiment;
  return r.videos.size() == 1 ||
         (!first.empty() && std::all_of(r.videos.begin(), r.videos.end(),
                                        [&](const auto& v) { return v.input.experiment == first; }));
}

std::string models_table(const Identification& r) {
  std::string out =
      "<h2>Models</h2>\n<div class=\"wide\"><table "
      "class=\"numbers\">\n<thead><tr><th>model</th><th>parameters, 90 "
      "%</th><th>energy score</th><th>fit p</th><th>simulations</th></tr></thead>\n<tbody>\n";
  for (const FoundModel& m : r.models) {
    if (!m.failed.empty()) {
      out += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>–</td><td>–</td><td>–</td></tr>\n",
                         escape_markup(m.name), escape_markup(m.failed));
      continue;
    }
    std::string parameters;
    for (const FoundParameter& p : m.parameters)
      parameters += fmt::format("{}{} {}", parameters.empty() ? "" : "<br />",
                                escape_markup(p.parameter.name()), escape_markup(with_interval(p)));
    out += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{:.2g}</td><td>{}</td></tr>\n",
                       escape_markup(m.name), parameters, three_digits(m.score), m.fit_p, m.simulations);
  }
  return out + fmt::format(
                   "</tbody></table></div>\n<p class=\"note\">Energy score: how well each of {} experiments "
                   "is predicted from "
                   "the others; less is better. Fit p: how often simulations of the model are as far from "
                   "their own mean as "
                   "the videos are; below 0.01 the model does not explain them.{}</p>\n",
                   r.experiments.size(),
                   one_drop(r) ? " The experiments are segments of one swarm and share its cells: intervals "
                                 "of the lead are "
                                 "too narrow by what they share."
                               : "");
}

// Both in the greys of the real one.
RgbImage side_by_side(const GrayF& real, const GrayF& simulated) {
  const int gap = 4;
  RgbImage out(2 * real.width + gap, real.height);
  std::fill(out.px.begin(), out.px.end(), Rgb{255, 255, 255});
  const auto put = [&](const GrayF& from, int at) {
    for (int r = 0; r < from.height; ++r)
      for (int c = 0; c < from.width; ++c) {
        const auto g = std::uint8_t(std::lround(std::clamp(from.at(c, r), 0.0F, 255.0F)));
        out.at(at + c, r) = {g, g, g};
      }
  };
  put(real, 0);
  put(simulated, real.width + gap);
  return out;
}

std::string pictures(const Identification& r) {
  std::string out = "<h2>Video and simulation</h2>\n";
  for (const EpisodePictures& e : episode_pictures(r)) {
    out += "<div class=\"figures\">\n";
    for (std::size_t k = 0; k < e.t_s.size(); ++k)
      out += fmt::format(
          "<figure>\n<h3>{}, {:.2g} s</h3>\n{}<figcaption>Left the video, right {} as it was "
          "found.</figcaption>\n</figure>\n",
          escape_markup(e.name), e.t_s[k],
          inline_picture(side_by_side(e.real[k], e.simulated[k]), "The video beside a simulation"),
          escape_markup(r.models[r.best].name));
    if (r.study.measure == Measure::density) out += figure_markup(e.spread);
    out += "</div>\n";
  }
  return out;
}

std::string legacy(const Identification& r) {
  if (r.legacy.empty()) return "";
  std::string out =
      "<h2>Legacy: what the rule of the 2016 thesis says</h2>\n<p class=\"warning\">Not to be trusted: it "
      "looks for a "
      "difference that does not grow, and one that is large from the beginning does not grow either. With "
      "known truth "
      "it fails; the figures above do not rest on it.</p>\n<div class=\"wide\"><table "
      "class=\"numbers\">\n<thead><tr><th>model</th><th>slope is zero at</th><th>95 %</th><th>difference, "
      "mean ± "
      "s.d.</th><th>least difference at</th></tr></thead>\n<tbody>\n";
  for (const LegacyModel& m : r.legacy) {
    const FreeParameter& q = m.parameter;
    const std::string interval = m.zero_ci95
                                     ? fmt::format("{} to {}", three_digits(q.shown((*m.zero_ci95)[0])),
                                                   three_digits(q.shown((*m.zero_ci95)[1])))
                                     : "no bounds";
    out += fmt::format(
        "<tr><th scope=\"row\">{}<small>{}</small></th><td>{}</td><td>{}</td><td>{} ± "
        "{}</td><td>{}</td></tr>\n",
        escape_markup(m.name),
        escape_markup(m.meaningless.empty() ? "" : "Means nothing: " + m.meaningless + "."),
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
        "<li>{}: {:.4g} um per px, {:.4g} frames per second, field {:.3g} uT; times count from {:.4g} "
        "s.</li>\n",
        escape_markup(v.input.file.string()), v.um_per_px, v.fps,
        1e6 * r.study.candidates[r.best].field_strength_in(v), v.episodes.front().begins_s);
  out += fmt::format("<li>Seed {}, {} simulations with each model; Faba {}.</li>\n", r.study.seed,
                     r.study.simulations, FABA_VERSION);
  return "<h2>Notes</h2>\n<ul>\n" + out + "</ul>\n";
}

}  // namespace

std::string identify_page(const Identification& r) {
  std::string out = fmt::format("<h1>{}</h1>\n", escape_markup(r.study.title)) + lead(r) + models_table(r);
  out += "<h2>What was seen, and what the best model shows</h2>\n<div class=\"figures\">\n";
  for (const Figure& f : predictive_figures(r)) out += figure_markup(f);
  out += "</div>\n" + pictures(r) + "<h2>Parameters of the best model</h2>\n<div class=\"figures\">\n";
  for (const FoundParameter& p : r.models[r.best].parameters)
    out += figure_markup(posterior_figure(p)) + figure_markup(profile_figure(p));
  return html_page(r.study.title, out + "</div>\n" + legacy(r) + notes(r));
}

}  // namespace faba
