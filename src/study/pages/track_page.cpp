#include "study/pages/track_page.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/file.h"
#include "core/toml.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "study/plot/plot_svg.h"
#include "study/plot/report_page.h"

namespace faba {
namespace {

// "12.3 ± 0.4 µm/s", in um where the report has it.
std::string value_of(const Json& from, const std::string& name, const char* px, const char* um,
                     const char* px_words, const char* um_words) {
  if (!from.is_object()) return "–";
  const bool scaled = from.contains(name + "_" + um);
  const std::string key = name + "_" + (scaled ? um : px);
  if (!from.contains(key) || from[key].is_null()) return "–";
  std::string words = three_digits(from[key].get<double>());
  if (!from[key + "_se"].is_null()) words += " ± " + three_digits(from[key + "_se"].get<double>());
  return words + "\u00A0" + (scaled ? um_words : px_words);
}

std::string number(const Json& v, const char* unit) {
  return v.is_number() ? three_digits(v.get<double>()) + unit : std::string("–");
}

std::string card(const std::string& name, const std::string& value, const std::string& detail) {
  return fmt::format("<div><dt>{}</dt><dd><b>{}</b><span>{}</span></dd></div>\n", escape_markup(name),
                     escape_markup(value), escape_markup(detail));
}
std::string row(const std::string& name, const std::string& value) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_markup(name),
                     escape_markup(value));
}

std::string cards(const Json& r) {
  std::string out = "<dl class=\"cards\">\n";
  out += card("Tracks", r["tracks"].dump(),
              fmt::format("{} in {}", counted(r["points"].get<std::uint64_t>(), "place"),
                          counted(r["frames"].get<std::uint64_t>(), "frame")));
  if (r["supported"] == "diffusion")
    out += card("Diffusion", value_of(r["diffusion"], "d", "px2_s", "um2_s", "px²/s", "µm²/s"),
                "± standard error");
  if (r["supported"] == "persistent_walk")
    out +=
        card("Speed of the walk", value_of(r["persistent_walk"], "speed_rms", "px_s", "um_s", "px/s", "µm/s"),
             "root mean square");
  out += card("Mean speed", value_of(r["speed"], "mean", "px_s", "um_s", "px/s", "µm/s"),
              r["speed"].is_object() ? "over " + number(r["speed"]["interval_s"], " s") : "");
  out += card("Localisation", r["localisation_px"] == 0 ? "–" : number(r["localisation_px"], "\u00A0px"),
              r["localisation_px"] == 0 ? "too small to be told" : "sd of an axis");
  return out + "</dl>\n";
}

std::string table(const Json& r) {
  const Json &d = r["detection"], &t = r["tracking"];
  std::string out = "<h2>Numbers</h2>\n<table class=\"facts\"><tbody>\n";
  out += row("Video",
             fmt::format("{}, {}, {} s", r["video"].get<std::string>(),
                         counted(r["frames"].get<std::uint64_t>(), "frame"), number(r["duration_s"], "")));
  out += row("Scale", r["um_per_px"].is_null() ? "not given" : number(r["um_per_px"], " µm per px"));
  out += row("Spots", fmt::format("{}, {} wide, signal-to-noise from {}; {} in a frame",
                                  d["polarity"].get<std::string>(), number(d["size_px"], " px"),
                                  number(d["threshold_snr"], ""), number(d["spots_per_frame"], "")));
  out += row("Background", d["background"] == "median"
                               ? fmt::format("median of {} frames; {} still spots in it",
                                             d["background_frames"].dump(), d["still_spots"].dump())
                               : "each frame, smoothed");
  out += row("Joined",
             fmt::format("reach {}, by {}, {} frames of memory; {} tracks shorter than {} left out",
                         number(t["reach_px"], " px"), t["motion"].get<std::string>(),
                         t["memory_frames"].dump(), t["unsure_tracks"].dump(), t["least_points"].dump()));
  out += row("Drift", value_of(r["drift"], "x", "px_s", "um_s", "px/s", "µm/s") + " right, " +
                          value_of(r["drift"], "y", "px_s", "um_s", "px/s", "µm/s") + " down");
  out += row("Diffusion", value_of(r["diffusion"], "d", "px2_s", "um2_s", "px²/s", "µm²/s"));
  out += row("Persistent walk", value_of(r["persistent_walk"], "speed_rms", "px_s", "um_s", "px/s", "µm/s") +
                                    ", direction kept for " +
                                    value_of(r["persistent_walk"], "tau", "s", "-", "s", ""));
  out += row("Exponent α",
             number(r["alpha"], "") + (r["alpha_se"].is_null() ? "" : " ± " + number(r["alpha_se"], "")));
  if (r["turn"].is_object())
    out += row("Turning", fmt::format("{} on average; localisation error alone makes {}",
                                      number(r["turn"]["mean_size_deg_s"], "°/s"),
                                      number(r["turn"]["noise_deg_s"], "°/s")));
  return out + "</tbody></table>\n";
}

std::string lead(const Json& r) {
  if (r["tracks"] == 0) return "Nothing was tracked.";
  const std::string tracks = counted(r["tracks"].get<std::uint64_t>(), "track");
  if (r["order"].is_number() && r["order"].get<double>() > 0.5)
    return fmt::format("{}: they move together, at {} on average.", tracks,
                       value_of(r["speed"], "mean", "px_s", "um_s", "px/s", "µm/s"));
  if (r["supported"] == "persistent_walk")
    return fmt::format("{}: they swim, at {} on average.", tracks,
                       value_of(r["speed"], "mean", "px_s", "um_s", "px/s", "µm/s"));
  if (r["supported"] == "diffusion")
    return fmt::format("{}: no direction is kept from one frame to the next; D = {}.", tracks,
                       value_of(r["diffusion"], "d", "px2_s", "um2_s", "px²/s", "µm²/s"));
  return tracks + ".";
}

}  // namespace

std::string track_page(const Json& r, const std::vector<Figure>& figures, const RgbImage& tracks) {
  std::string out = fmt::format("<h1>Tracks</h1>\n<p class=\"lead\">{}</p>\n", escape_markup(lead(r)));
  for (const Json& note : r["notes"])
    out += fmt::format("<p class=\"warning\">{}.</p>\n", escape_markup(note.get<std::string>()));
  out += cards(r);
  out += "<h2>Figures</h2>\n<figure class=\"wide\">\n<h3>Tracks</h3>\n" +
         inline_picture(tracks, "Tracks on the first frame") +
         "<figcaption>All tracks on the first frame.</figcaption>\n</figure>\n";
  out += "<div class=\"figures\">\n";
  int number_of_figure = 0;
  for (const Figure& f : figures) out += figure_markup(f, ++number_of_figure);
  out += "</div>\n" + table(r);
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
