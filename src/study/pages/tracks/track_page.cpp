#include "study/pages/tracks/track_page.h"

#include <cmath>

#include <fmt/format.h>

#include "core/counted.h"
#include "core/file.h"
#include "study/pages/provenance_output.h"
#include "study/pages/quality_output.h"
#include "study/pages/tracks/track_json.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "study/plot/plot_svg.h"
#include "study/plot/report_page.h"
#include "study/quality/rounded.h"

namespace faba {
namespace {

// Unit of lengths.
struct LengthUnit {
  double per_px = 1;
  const char* name = "px";
};

LengthUnit unit_of(const TrackMeasurement& m) {
  return m.um_per_px ? LengthUnit{*m.um_per_px, "µm"} : LengthUnit{};
}

std::string number(double v, const char* unit) {
  return std::isfinite(v) ? three_digits(v) + unit : std::string("–");
}

// "12.34 ± 0.41", `scale` times the value.
std::string with_error(const Estimated& e, double scale) {
  return with_uncertainty(scale * e.value, scale * e.se, "±");
}

std::string estimate(const Estimated& e, double scale, const std::string& unit) {
  return std::isfinite(scale * e.value) ? with_error(e, scale) + "\u00A0" + unit : std::string("–");
}

std::string velocity(const Estimated& e, const TrackMeasurement& m) {
  const LengthUnit unit = unit_of(m);
  return estimate(e, unit.per_px, std::string(unit.name) + "/s");
}

std::string mean_speed(const TrackMeasurement& m) {
  return m.summary.speed_count > 0 ? velocity(m.summary.mean_speed_px_s, m) : "–";
}

std::string diffusion(const TrackMeasurement& m) {
  const LengthUnit unit = unit_of(m);
  if (!m.summary.diffusion.good) return "–";
  return estimate(m.summary.d_px2_s, unit.per_px * unit.per_px, std::string(unit.name) + "²/s");
}

std::string walk_speed(const TrackMeasurement& m) {
  return m.summary.persistent.good ? velocity(m.summary.speed_rms_px_s, m) : "–";
}

std::string walk_time(const TrackMeasurement& m) {
  return m.summary.persistent.good ? estimate(m.summary.tau_s, 1, "s") : "–";
}

std::string drift(const TrackMeasurement& m) {
  const TrackSummary& s = m.summary;
  if (s.msd.size() == 0) return "– right, – down";
  return velocity(s.drift_x_px_s, m) + " right, " + velocity(s.drift_y_px_s, m) + " down";
}

std::string value_card(const std::string& name, const std::string& value, const std::string& detail) {
  return fmt::format("<div><dt>{}</dt><dd><b>{}</b><span>{}</span></dd></div>\n", escape_markup(name),
                     escape_markup(value), escape_markup(detail));
}
std::string row(const std::string& name, const std::string& value) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_markup(name),
                     escape_markup(value));
}

std::string speed_unit(const TrackMeasurement& m) {
  return std::string("\u00A0") + (m.um_per_px ? "µm" : "px") + (m.timed ? "/s" : "/frame");
}

std::string population_card(const SpeedPopulation& p, const TrackMeasurement& m) {
  const std::string name = fmt::format("{:.0f} % {}", 100 * p.fraction, word_of(p.motion));
  if (p.motion == PopulationMotion::still) return value_card(name, "–", "");
  return value_card(name, number(m.um_per_px.value_or(1) * p.speed_px_s, speed_unit(m).c_str()),
                    "median speed");
}

std::string localisation_card(const TrackSummary& s) {
  if (s.msd.size() < 2) return value_card("Localisation", "–", "sd per axis");
  if (s.localisation_px == 0) return value_card("Localisation", "–", "too small to be measured");
  return value_card("Localisation", number(s.localisation_px, "\u00A0px"), "sd per axis");
}

/// The motion models are stated when they describe the mean-square displacement.
SupportedWalk described_walk(const TrackSummary& s) {
  return misfit_of(s).significant ? SupportedWalk::none : supported_walk(s);
}

std::string cards(const TrackMeasurement& m) {
  const TrackSummary& s = m.summary;
  const SupportedWalk walk = described_walk(s);
  std::string out = "<dl class=\"cards\">\n";
  out += value_card(
      "Tracks", std::to_string(s.tracks),
      fmt::format("{} in {}", counted(s.points, "position"), counted(std::uint64_t(m.frames), "frame")));
  if (quality_of(m.warnings) == Quality::poor) return out + "</dl>\n";
  if (walk == SupportedWalk::diffusion) out += value_card("Diffusion", diffusion(m), "± standard error");
  if (walk == SupportedWalk::persistent && one_population(m))
    out += value_card("Persistent walk speed", walk_speed(m), "root mean square");
  if (one_population(m))
    out += value_card("Mean speed", mean_speed(m),
                      s.speed_count > 0 ? "over " + number(s.interval_s, " s") : "");
  else
    for (const SpeedPopulation& p : m.populations) out += population_card(p, m);
  return out + localisation_card(s) + "</dl>\n";
}

/// The rate of turn, and whether it exceeds what the localisation error alone gives by two standard errors.
std::string turning(const TrackSummary& s) {
  const Estimated& turn = s.turn_deg_s;
  const double error = std::isfinite(turn.se) ? turn.se : 0;
  const std::string noise = number(s.turn_noise_deg_s, "°/s");
  if (turn.value - 2 * error > s.turn_noise_deg_s) {
    return fmt::format("mean absolute rate {}; {} from the localisation error alone",
                       estimate(turn, 1, "°/s"), noise);
  }
  return fmt::format(
      "not distinguishable from zero: the mean absolute rate is {}, and the localisation error alone gives "
      "{}",
      estimate(turn, 1, "°/s"), noise);
}

/// "62 % moving, median speed 49.2 px/s (90 % interval 47 to 51)".
std::string population(const SpeedPopulation& p, const TrackMeasurement& m) {
  const double scale = m.um_per_px.value_or(1);
  const std::string words = speed_unit(m);
  const char* unit = words.c_str();
  if (p.motion == PopulationMotion::still)
    return fmt::format("{:.0f} % {}", 100 * p.fraction, word_of(p.motion));
  return fmt::format("{:.0f} % {}, median speed {} (90 % interval {} to {})", 100 * p.fraction,
                     word_of(p.motion), number(scale * p.speed_px_s, unit), number(scale * p.ci90[0], ""),
                     number(scale * p.ci90[1], unit));
}

/// "; does not fit: -30 ± 2 % at 0.5 s", or nothing.
std::string misfit(const MsdMisfit& f) {
  if (!f.significant) return "";
  return fmt::format("; does not fit: {:+.0f} ± {:.2g} % at {}", 100 * f.deviation, 100 * f.se,
                     number(f.lag_s, " s"));
}

std::string track_quality(const TrackMeasurement& m) {
  const ScoreSummary s = summary_of(m.scores);
  if (!s.mean) return "–";
  return fmt::format("mean score {:.2f}; 10, 50 and 90 % of the tracks below {:.2f}, {:.2f}, {:.2f}", *s.mean,
                     s.quantiles[0], s.quantiles[1], s.quantiles[2]);
}

std::string stage(const TrackMeasurement& m) {
  const StageDrift& d = m.stage;
  if (d.references == 0) return "no objects keep their distances";
  return fmt::format("{} tracks keep their distances: drift {} ± {}, jitter {}{}", d.references,
                     number(norm(d.drift_px_s), ""), number(d.drift_se_px_s, " px/s"),
                     number(d.jitter_px, " px"), d.removed ? "; speeds are relative to them" : "");
}

std::string table(const TrackMeasurement& m) {
  const TrackDetection& d = m.detection;
  const TrackJoining& t = m.joining;
  const TrackSummary& s = m.summary;
  std::string out = "<h2>Results</h2>\n<table class=\"facts\"><tbody>\n";
  out += row("Video", fmt::format("{}, {}, {} s", m.video.string(), counted(std::uint64_t(m.frames), "frame"),
                                  number(m.duration_s, "")));
  out += row("Scale", m.um_per_px ? number(*m.um_per_px, " µm per px") : "not given");
  const auto& region = d.region;
  if (region)
    out += row("Region", fmt::format("column {}, row {}, {} x {} px", region->col, region->row, region->width,
                                     region->height));
  out += row("Spots", fmt::format("{}, width {}, signal-to-noise ratio at least {}; {} per frame",
                                  word_of(d.polarity), number(d.size_px, " px"), number(d.threshold_snr, ""),
                                  number(d.spots_per_frame, "")));
  out += row("Background", d.temporal ? fmt::format("median of {} frames, with {} stationary spots",
                                                    d.background_frames, d.stationary_spots)
                                      : "spatial, from each frame");
  out += row("Linking", fmt::format("search radius {}, motion model {}, gaps of at most {} frames; {} tracks "
                                    "with fewer than {} points ignored",
                                    number(t.search_radius_px, " px"), word_of(t.motion), t.max_gap_frames,
                                    t.discarded_tracks, t.min_points));
  for (const SpeedPopulation& p : m.populations) out += row("Population", population(p, m));
  out += row("Track quality", track_quality(m));
  out += row("Mean velocity", drift(m));
  out += row("Stage", stage(m));
  out += row("Diffusion", diffusion(m) + misfit(s.diffusion_misfit));
  out += row("Persistent walk",
             walk_speed(m) + ", persistence time " + walk_time(m) + misfit(s.persistent_misfit));
  out += row("Exponent α", std::isfinite(s.alpha.value) ? with_error(s.alpha, 1) : "–");
  if (s.turn_count > 0) out += row("Turning", turning(s));
  return out + "</tbody></table>\n";
}

/// As markup: each text that a page translates is an element.
std::string lead(const TrackMeasurement& m) {
  const TrackSummary& s = m.summary;
  if (s.tracks == 0) return "No tracks.";
  const std::string tracks = counted(s.tracks, "track");
  if (quality_of(m.warnings) == Quality::poor)
    return tracks + "; the quality of the measurement is poor, and no speed is stated here.";
  if (!one_population(m)) {
    std::string text = fmt::format("<span>{}</span>", tracks);
    for (const SpeedPopulation& p : m.populations)
      text += fmt::format("{}<span>{}</span>", &p == m.populations.data() ? ": " : "; ", population(p, m));
    return text + ".";
  }
  if (s.speed_count > 0 && s.order > 0.5)
    return fmt::format("{}: collective motion, mean speed {}.", tracks, mean_speed(m));
  if (described_walk(s) == SupportedWalk::persistent)
    return fmt::format("{}: persistent motion, mean speed {}.", tracks, mean_speed(m));
  if (described_walk(s) == SupportedWalk::diffusion)
    return fmt::format("{}: diffusion without persistence of direction, D = {}.", tracks, diffusion(m));
  return tracks + ".";
}

}  // namespace

std::string track_page(const TrackMeasurement& m, const std::vector<Figure>& figures, const RgbImage& tracks,
                       const Provenance& provenance) {
  std::string out = fmt::format("<h1>Tracks</h1>\n<p class=\"lead\">{}</p>\n", lead(m));
  out += quality_markup(m.warnings);
  for (const std::string& note : m.notes) out += note_markup(note, "", "warning");
  out += cards(m);
  out += "<h2>Figures</h2>\n<figure class=\"wide\">\n<h3>Tracks</h3>\n" +
         inline_picture(tracks, "Tracks on the first frame") +
         "<figcaption>All tracks on the first frame.</figcaption>\n</figure>\n";
  out += "<div class=\"figures\">\n";
  int number_of_figure = 0;
  out += figures_markup(figures, number_of_figure) + "</div>\n" + table(m) + provenance_markup(provenance);
  return html_page("Tracks", out);
}

void write_track_figures(const std::filesystem::path& where, const std::vector<Figure>& figures,
                         const Plot& paths) {
  std::filesystem::create_directories(where);
  write_file(where / "tracks.svg", svg(paths));
  for (Figure f : figures) {
    f.plot.inlined = false;
    const char* name = f.heading == "Speeds"  ? "speeds.svg"
                       : f.plot.x.logarithmic ? "msd.svg"
                                              : "heading.svg";
    write_file(where / name, svg(f.plot));
  }
}

}  // namespace faba
