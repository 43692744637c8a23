#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/quantity.h"
#include "core/error.h"
#include "study/pages/scale.h"

namespace faba::cli {
namespace {

struct ScaleVerb {
  std::filesystem::path ruler, out, overlay;
  std::string tick;
  bool force = false;
};

double tick_of(const std::string& words) {
  if (words.empty())
    throw Error(Errc::usage, "--tick",
                "say how far neighbouring marks of the finest kind are apart, such as --tick \"10 um\"");
  const double tick = quantity_of(words, "m", "--tick", "10 um");
  if (!(tick >= 1e-9 && tick <= 1))
    throw Error(Errc::usage, "--tick",
                fmt::format("\"{}\" is not a length of 1 nm to 1 m such as \"10 um\"", words));
  return tick;
}

void print_table(const nlohmann::ordered_json& j) {
  const auto number = [&](const char* key) { return j[key].get<double>(); };
  const auto end = [&](const char* key, int i) { return j[key][std::size_t(i)].get<double>(); };
  fmt::print("  width um   um per px\n");
  for (std::size_t i = 0; i < j["ratios"].size(); ++i)
    fmt::print("{:10g}   {:9.6f}\n", end("widths_um", int(i)), end("ratios", int(i)));
  fmt::print(
      "ratio-mean   {:.6f} um/px, s.d. {:.6f}, s.e.m. {:.4f}; trend with width (Spearman) {:.2f}, p {:.3f}\n",
      number("ratio_mean"), number("ratio_sd"), number("ratio_sem"), number("spearman"),
      number("spearman_p"));
  fmt::print("regression   {:.4f} um/px, 95 % {:.3f} to {:.3f}\n", number("um_per_px"), end("ci95", 0),
             end("ci95", 1));
  fmt::print("             reading = {:.2f} px + {:.4f} px/um x width; edges {:.1f} to {:.1f} px",
             number("intercept_px"), number("slope_px_per_um"), end("intercept_ci95_px", 0),
             end("intercept_ci95_px", 1));
  if (!j["repeatability_px"].is_null()) fmt::print("; repeatability {:.2f} px", number("repeatability_px"));
  fmt::print("\n");
}

void print_picture(const nlohmann::ordered_json& j) {
  const auto number = [&](const char* key) { return j[key].get<double>(); };
  fmt::print(
      "marks        {} {} ones, {:.4f} px apart (s.e. {:.4f}), {:.2f} degrees, scatter {:.2f} px: {}\n",
      j["marks"].get<int>(), j["marks_are"].get<std::string>(), number("pitch_px"), number("pitch_se_px"),
      number("angle_deg"), number("residual_px"), j["quality"].get<std::string>());
  fmt::print("ratio-mean   {:.5f} um/px, s.d. {:.5f}, s.e.m. {:.5f}\n", number("ratio_mean"),
             number("ratio_sd"), number("ratio_sem"));
  fmt::print("regression   {:.5f} um/px, 95 % {:.5f} to {:.5f}\n", number("um_per_px"),
             j["ci95"][0].get<double>(), j["ci95"][1].get<double>());
}

int scale(const ScaleVerb& v, const Common& c) {
  check_output(v.out, ".toml", v.force, {v.ruler});
  check_output(v.overlay, ".png", v.force, {v.ruler});
  const bool table = is_ruler_table(v.ruler);
  if (table && !v.tick.empty())
    throw Error(Errc::usage, "--tick", "is for pictures; a table says how wide everything is");
  if (table && !v.overlay.empty()) throw Error(Errc::usage, "--overlay", "is for pictures");
  const auto j =
      table ? report_scale_table(v.ruler) : report_scale_picture(v.ruler, tick_of(v.tick), v.overlay);
  if (!v.out.empty() && !table && !v.force && j["quality"] == "poor")
    throw Error(
        Errc::input, v.ruler.string(),
        fmt::format("the marks found in it are too few or too uneven for a calibration ({} of them, scatter "
                    "{:.2f} px): look at them with --overlay; --force writes {} all the same",
                    j["marks"].get<int>(), j["residual_px"].get<double>(), v.out.string()));
  if (!v.out.empty()) write_calibration(v.out, calibration_of(j));
  if (!c.quiet && !c.json && !table && j["quality"] != "good")
    tell(fmt::format(
        "faba: note: the marks are few or uneven ({}); look at them with --overlay before you use the "
        "scale",
        j["quality"].get<std::string>()));
  if (c.json) {
    fmt::print("{}\n", j.dump());
  } else if (!c.quiet) {
    table ? print_table(j) : print_picture(j);
    fmt::print("note         {}\n", j["note"].get<std::string>());
    if (!v.overlay.empty()) fmt::print("overlay      {}\n", v.overlay.string());
    if (!v.out.empty())
      fmt::print("calibration  {}; in a scenario: [scale] file = \"{}\"\n", v.out.string(), v.out.string());
  }
  return 0;
}

}  // namespace

void add_scale(CLI::App& app, CommandLine& line) {
  const auto s = std::make_shared<ScaleVerb>();
  CLI::App* v = verb(app, line, "scale", "Micrometres per pixel, from a table or a picture of a ruler",
                     "  faba scale readings.csv --out calibration.toml\n"
                     "  faba scale ruler.png --tick \"10 um\" --overlay marks.png");
  v->add_option("ruler", s->ruler, "Readings as CSV (width_um,px_1,px_2), or a picture of a ruler")
      ->required();
  v->add_option("--tick", s->tick, "Distance between neighbouring finest marks of a ruler in a picture")
      ->check(not_empty);
  v->add_option("--out", s->out, "Write a calibration file, which scenarios and analyses take in, as TOML")
      ->check(not_empty);
  v->add_option("--overlay", s->overlay, "Write the picture with the marks drawn in, as PNG")
      ->check(not_empty);
  v->add_flag("--force", s->force, "Replace existing files");
  v->callback([s, &line] { line.code = scale(*s, line.common); });
}

}  // namespace faba::cli
