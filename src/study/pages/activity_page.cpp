#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "core/counted.h"
#include "study/motion/direction_text.h"
#include "study/motion/flow_histograms.h"
#include "study/pages/activity_report.h"
#include "study/pages/provenance_output.h"
#include "study/pages/quality_output.h"
#include "study/plot/markup.h"
#include "study/plot/plot_svg.h"
#include "study/plot/report_page.h"
#include "vision/draw/flow_picture.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

constexpr std::size_t kMaxSignatures = 24;  // figures of single videos

std::string title_of(const VideoActivity& a) {
  std::string text = a.input.file.filename().string();
  if (text.empty()) text = a.input.file.parent_path().filename().string();
  if (a.input.exposure_s) text += fmt::format(", air exposure {} s", three_digits(*a.input.exposure_s));
  return text;
}

// Unit of the times in a table: a video without a frame rate has frame numbers.
const char* time_unit(const ActivityResult& r) {
  const bool timed =
      std::all_of(r.videos.begin(), r.videos.end(), [](const VideoActivity& a) { return a.timed; });
  const bool none =
      std::none_of(r.videos.begin(), r.videos.end(), [](const VideoActivity& a) { return a.timed; });
  return timed ? "s" : none ? "frames" : "s or frames";
}

std::string onset_caption(const VideoActivity& a) {
  if (!a.response)
    return "The onset is unknown: no field reversal is known and no motion starts in the video.";
  if (const auto onset = onset_of(a))
    return fmt::format("(1) Onset of the response, with its 90 % interval in blue; {}.",
                       a.response->source == Response::Source::detected
                           ? "the time of the field reversal is unknown"
                           : fmt::format("field reversal at {:.3f} s", a.response->earliest_s));
  return "No response to the field reversal.";
}

// "0.118 px per pair", with the speed if the scale is known.
std::string threshold_text(const VideoActivity& a) {
  std::string px = three_digits(a.threshold_px) + " px per pair";
  if (!a.um_per_px || !a.timed || a.frame_s <= 0) return px;
  return fmt::format("{} ({} µm/s)", px, three_digits(a.threshold_px * *a.um_per_px / a.frame_s));
}

// The activity of a unit of the tables; empty without a scale, or if the videos differ.
std::string unit_note(const ActivityResult& r) {
  const VideoActivity& first = r.videos.front();
  const bool same = std::all_of(r.videos.begin(), r.videos.end(), [&](const VideoActivity& a) {
    return a.timed && a.um_per_px == first.um_per_px && a.frame_s == first.frame_s;
  });
  if (!same || !first.um_per_px || first.frame_s <= 0) return "";
  return fmt::format("<p class=\"note\">1 px × px² per pair is {} µm/s × µm².</p>\n",
                     three_digits(std::pow(*first.um_per_px, 3) / first.frame_s));
}

Figure signature_figure(const VideoActivity& a) {
  Figure f;
  f.heading = title_of(a);
  Plot& p = f.plot;
  p.inlined = true;
  p.description = "Activity of " + f.heading + " over time";
  p.x.label = a.timed ? "time (s)" : "time (frames)";
  p.y.label = "activity (px × px² per pair)";
  p.width = 620;
  for (const MotionSegment& s : a.segments) p.add(Band{s.t0_s, s.t1_s, {}, true, Ink::muted});
  p.add(Rule{.at = 0, .of_x = false});
  p.add(Line{
      .x = a.t_s, .y = a.amount, .label = "within 45° of the direction", .ink = Ink::blue, .width = 1.2});
  p.add(Line{.x = a.t_s,
             .y = a.along,
             .label = "net flow along the direction",
             .ink = Ink::vermillion,
             .width = 1.2});
  if (a.fit.good) {
    Line curve;
    curve.label = "Gaussian";
    curve.ink = Ink::text;
    curve.dashed = true;
    for (const double t : a.t_s) {
      const double z = (t - a.fit.peak_s) / a.fit.sigma_s;
      curve.x.push_back(t);
      curve.y.push_back(a.fit.amplitude * std::exp(-z * z / 2) + a.fit.offset);
    }
    p.add(std::move(curve));
  }
  if (const auto onset = onset_of(a)) {
    p.add(Band{onset->ci90[0], onset->ci90[1], {}, true, Ink::blue});
    p.add(Rule{.at = onset->t_s, .label = "(1)"});
  }
  if (a.maximum_s) p.add(Rule{.at = *a.maximum_s, .label = "(2)"});
  if (a.departure_s) p.add(Rule{.at = *a.departure_s, .label = "(3)"});
  f.caption =
      fmt::format("Flow above {}; direction {}. ", threshold_text(a), short_direction_text(a.direction_deg));
  if (!a.segments.empty()) f.caption += "Grey: motion in one direction. ";
  f.caption += onset_caption(a);
  f.caption += a.fit.good
                   ? fmt::format(
                         " (2) Maximum of the fitted Gaussian, standard error {} s; (3) departure of the "
                         "swarm, where it is at 10 % of its amplitude.",
                         three_digits(a.fit.se_peak_s))
                   : " The Gaussian fit failed: " + a.fit.reason + ". No maximum and departure are given.";
  return f;
}

// A quantity of each video that is plotted against air exposure time; empty when it is not available.
struct AgainstExposure {
  std::string heading, label;
  const std::optional<ExposureLine>& line;
  std::function<std::optional<double>(const VideoActivity&)> value;
};

std::vector<AgainstExposure> against_exposure(const ActivityResult& r) {
  return {{"Time of the maximum against air exposure time", "time of the maximum (s)", r.peak_line,
           [&r](const VideoActivity& a) -> std::optional<double> {
             if (!has_peak(a) || (r.cutoff && *a.input.exposure_s >= r.cutoff->cutoff_s)) return {};
             return a.fit.peak_s - a.input.from_s;
           }},
          {"Mean activity against air exposure time", "mean activity (px × px² per pair)", r.mean_line,
           [](const VideoActivity& a) { return std::optional(a.mean_amount); }},
          {"Mean activity per visible cell against air exposure time",
           "mean activity per cell (px × px² per pair)", r.per_cell_line, activity_per_cell}};
}

Figure line_figure(const ActivityResult& r, const AgainstExposure& what) {
  Figure f;
  const auto& line = what.line;
  f.heading = what.heading;
  Plot& p = f.plot;
  p.inlined = true;
  p.x.label = "air exposure time (s)";
  p.y.label = what.label;
  p.width = 620;
  p.height = 300;
  double longest = 0;
  std::vector<std::string> experiments;
  for (const VideoActivity& a : r.videos) {
    if (!a.input.exposure_s) continue;
    longest = std::max(longest, *a.input.exposure_s);
    if (std::find(experiments.begin(), experiments.end(), a.input.experiment) == experiments.end())
      experiments.push_back(a.input.experiment);
  }
  for (const std::string& name : experiments) {
    Scatter dots;
    dots.label = name.empty() ? "" : fmt::format("{} {}", r.group, name);
    for (const VideoActivity& a : r.videos) {
      if (!a.input.exposure_s || a.input.experiment != name) continue;
      if (const auto value = what.value(a)) {
        dots.x.push_back(*a.input.exposure_s);
        dots.y.push_back(*value);
      }
    }
    p.add(std::move(dots));
  }
  if (r.cutoff) p.add(Rule{.at = r.cutoff->cutoff_s, .label = "cut-off"});
  p.add(
      Line{.x = {0, longest},
           .y = {line->intercept, line->intercept + line->slope * longest},
           .label = line->experiments > 1 ? fmt::format("line fit, one offset per {}", r.group) : "line fit",
           .ink = Ink::text});
  f.caption = fmt::format("Slope {} (95 % interval {} to {}); intercept {} ({} to {}); {} in {}.",
                          three_digits(line->slope), three_digits(line->slope_ci95[0]),
                          three_digits(line->slope_ci95[1]), three_digits(line->intercept),
                          three_digits(line->intercept_ci95[0]), three_digits(line->intercept_ci95[1]),
                          counted(std::uint64_t(line->values), "video"),
                          counted(std::uint64_t(line->experiments), r.group.c_str()));
  return f;
}

std::string text_row(std::vector<std::string> cells, const char* tag) {
  for (std::string& cell : cells) cell = escape_markup(cell);
  return table_row(cells, tag);
}

std::string with_error(const std::optional<double>& value, const std::optional<double>& error) {
  return value && error ? fmt::format("{} ± {}", three_digits(*value), three_digits(*error)) : "–";
}

std::string onset_text(const VideoActivity& a) {
  const auto onset = onset_of(a);
  return onset ? fmt::format("{} [{}, {}]", decimals(onset->t_s, width_of(onset->ci90)),
                             decimals(onset->ci90[0], width_of(onset->ci90)),
                             decimals(onset->ci90[1], width_of(onset->ci90)))
               : "–";
}

std::string fraction_text(const VideoActivity& a) {
  if (!a.response || !a.response->fraction) return "–";
  const Measured& f = *a.response->fraction;
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", f.value, f.ci90[0], f.ci90[1]);
}

std::string speed_text(const VideoActivity& a) {
  if (!a.response || !a.response->speed_px_s) return "–";
  const std::optional<Measured> um = speed_um_s(a);
  const Measured& v = um ? *um : *a.response->speed_px_s;
  const double width = width_of(v.ci90);
  return fmt::format("{} [{}, {}] {}/s", decimals(v.value, width), decimals(v.ci90[0], width),
                     decimals(v.ci90[1], width), um ? "µm" : "px");
}

std::string segments_table(const ActivityResult& r) {
  std::string out = "<h2>Motion in one direction</h2>\n<table class=\"numbers\">\n<thead>";
  const std::string unit = time_unit(r);
  out += text_row({"video", "from (" + unit + ")", "to (" + unit + ")", "direction"}, "th") +
         "</thead><tbody>\n";
  for (const VideoActivity& a : r.videos)
    for (const MotionSegment& s : a.segments)
      out += text_row({title_of(a), fmt::format("{:.2f}", s.t0_s), fmt::format("{:.2f}", s.t1_s),
                       short_direction_text(s.direction_deg)},
                      "td");
  return out + "</tbody></table>\n";
}

std::string table(const ActivityResult& r) {
  std::string out = "<h2>Results</h2>\n<div class=\"wide\"><table class=\"numbers\">\n<thead>";
  const std::string unit = time_unit(r);
  out += text_row({"video", "direction", "threshold (px)", "mean activity (px × px² per pair)",
                   "per visible cell", "signal-to-noise ratio", "onset (" + unit + ")", "responding fraction",
                   "speed", "maximum (" + unit + ")", "width (" + unit + ")"},
                  "th") +
         "</thead><tbody>\n";
  const auto if_good = [](const VideoActivity& a, double value) {
    return a.fit.good ? std::optional(value) : std::nullopt;
  };
  for (const VideoActivity& a : r.videos)
    out += text_row({title_of(a), fmt::format("{}°", counter_clockwise_deg(a.direction_deg)),
                     three_digits(a.threshold_px), three_digits(a.mean_amount),
                     activity_per_cell(a) ? three_digits(*activity_per_cell(a)) : "–",
                     a.signal_to_noise ? three_digits(*a.signal_to_noise) : "–", onset_text(a),
                     fraction_text(a), speed_text(a), with_error(if_good(a, a.fit.peak_s), a.fit.se_peak_s),
                     with_error(if_good(a, a.fit.sigma_s), a.fit.se_sigma_s)},
                    "td");
  out += "</tbody></table></div>\n";
  out +=
      "<p class=\"note\">Directions in the picture count counter-clockwise: 0° is right, 90° is up. Values "
      "after ± are standard errors. A dash: not defined, for example onset, maximum and width without a "
      "valid Gaussian "
      "fit.</p>\n" +
      unit_note(r);
  const bool none = std::all_of(r.videos.begin(), r.videos.end(),
                                [](const VideoActivity& a) { return a.segments.empty(); });
  return none ? out : out + segments_table(r);
}

// The response to a field reversal at a known time.
std::string response_lead(const VideoActivity& a) {
  if (quality_of(a.warnings) == Quality::poor)
    return "The response to the field reversal could not be measured.";
  if (!a.response->responds) return "No response to the field reversal was detected.";
  std::string text = "The cells respond to the field reversal";
  if (a.response->fraction) text += fmt::format(": a fraction of {}", fraction_text(a));
  if (a.response->fraction && a.response->speed_px_s) text += fmt::format(" at {}", speed_text(a));
  return text + (a.response->fraction ? " (90 % intervals)." : ".");
}

std::string lead(const ActivityResult& r) {
  if (r.videos.size() == 1) {
    const VideoActivity& a = r.videos.front();
    if (a.response && a.response->source != Response::Source::detected) return response_lead(a);
    return a.segments.empty() ? "No significant motion in one direction was detected."
                              : fmt::format("Motion in one direction was detected in {}.",
                                            counted(a.segments.size(), "time interval"));
  }
  std::size_t respond = 0;
  for (const VideoActivity& a : r.videos) respond += a.responds;
  std::string text = fmt::format("{} of {} videos show a response.", respond, r.videos.size());
  if (r.cutoff)
    text += fmt::format(
        " The cut-off air exposure time is {} s (between {} and {} s); {}.", three_digits(r.cutoff->cutoff_s),
        three_digits(r.cutoff->between_s[0]), three_digits(r.cutoff->between_s[1]),
        r.cutoff->wrong == 0   ? "no video beyond it shows a response"
        : r.cutoff->wrong == 1 ? "one video is inconsistent with it"
                               : fmt::format("{} videos are inconsistent with it", r.cutoff->wrong));
  return text;
}

}  // namespace

std::vector<Figure> activity_figures(const ActivityResult& r) {
  std::vector<Figure> figures;
  bool exposures = false;
  for (const VideoActivity& a : r.videos) exposures = exposures || a.input.exposure_s;
  if (exposures)
    for (const AgainstExposure& what : against_exposure(r))
      if (what.line) figures.push_back(line_figure(r, what));
  for (std::size_t i = 0; i < std::min(r.videos.size(), kMaxSignatures); ++i)
    figures.push_back(signature_figure(r.videos[i]));
  return figures;
}

std::string activity_page(const ActivityResult& r, const Provenance& provenance) {
  std::string out = fmt::format("<h1>Activity</h1>\n<p class=\"lead\">{}</p>\n", escape_markup(lead(r)));
  out += quality_markup(all_warnings(r));
  std::string notes;
  for (const VideoActivity& a : r.videos)
    for (const std::string& note : a.notes) notes += note_markup(note, title_of(a), "note");
  if (r.videos.size() > 1 && !notes.empty())
    notes = "<details>\n<summary>Notes</summary>\n" + notes + "</details>\n";
  out += notes;
  int number = 0;
  for (const Figure& f : activity_figures(r))
    out += fmt::format(
        "<figure class=\"wide\">\n<h3>{}</h3>\n{}<figcaption>Figure {}. {}</figcaption>\n</figure>\n",
        escape_markup(f.heading), svg(f.plot), ++number, escape_markup(f.caption));
  return html_page("Activity", out + table(r) + provenance_markup(provenance));
}

void write_activity_picture(const std::filesystem::path& file, const VideoActivity& a) {
  if (!a.busiest.image)
    throw Error(Errc::usage, "--picture", "a flow file contains no frames; give the video");
  const double direction = a.direction_given ? a.direction_deg : a.busiest_deg;
  const Flow kept = filtered_flow(a.busiest.flow, {a.threshold_px, direction});
  FlowDrawing how;
  how.full_px = std::max(full_speed(a.busiest.flow), 1e-6);
  how.arrow_step_px = 0;
  how.words = a.timed ? fmt::format("flow at {:.2f} s", a.busiest.t1_s)
                      : fmt::format("flow at frame {:.0f}", a.busiest.t1_s);
  const RgbImage all = draw_flow(a.busiest.flow, how);
  how.words = fmt::format("above {:.3g} px, direction {}", a.threshold_px, direction_text(direction));
  const RgbImage filtered = draw_flow(kept, how);
  RgbImage out(2 * all.width + 8, all.height, Rgb{255, 255, 255});
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      out.at(x, y) = all.at(x, y);
      out.at(all.width + 8 + x, y) = filtered.at(x, y);
    }
  write_png(file, out);
}

}  // namespace faba
