#include "server/tracks/track_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "server/request_values.h"

namespace faba {
namespace {

// A number that is an option of `faba track`, with the limits of this option.
struct NumberSetting {
  const char* key;
  const char* unit;
  double min, max;
  bool integer;
  void (*set)(TrackOptions& o, double value);
};
constexpr std::array<NumberSetting, 10> kNumberSettings{{
    {"size", " px", 1, 60, false, [](TrackOptions& o, double v) { o.size_px = v; }},
    {"threshold", "", 1, 1e6, false, [](TrackOptions& o, double v) { o.threshold_sd = v; }},
    {"reach", " px", 0.1, 1e5, false, [](TrackOptions& o, double v) { o.tracker.search_radius_px = v; }},
    {"memory", " frames", 0, 1000, true,
     [](TrackOptions& o, double v) { o.tracker.max_gap_frames = int(v); }},
    {"least", " detections", 1, 1e5, true, [](TrackOptions& o, double v) { o.tracker.min_points = int(v); }},
    {"interval", " frames", 1, 1e5, true, [](TrackOptions& o, double v) { o.interval_frames = int(v); }},
    {"fps", " frames/s", 1e-6, 1e7, false, [](TrackOptions& o, double v) { o.part.fps = v; }},
    {"from", " s", 0, 1e7, false, [](TrackOptions& o, double v) { o.part.from_s = v; }},
    {"to", " s", 0, 1e7, false, [](TrackOptions& o, double v) { o.part.to_s = v; }},
    {"um-per-px", " um/px", 1e-3, 1e3, false,
     [](TrackOptions& o, double v) {
       o.scale = {v, "typed", ""};
     }},
}};

struct WordSetting {
  const char* key;
  std::vector<std::string> words;
  void (*set)(TrackOptions& o, std::size_t word);
};
const std::array<WordSetting, 3> kWordSettings{{
    {"polarity",
     {"auto", "dark", "bright", "both"},
     [](TrackOptions& o, std::size_t w) { o.polarity = Polarity(w); }},
    {"background",
     {"auto", "median", "spatial"},
     [](TrackOptions& o, std::size_t w) { o.background = BackgroundKind(w); }},
    {"motion",
     {"auto", "nearest", "velocity"},
     [](TrackOptions& o, std::size_t w) { o.tracker.motion = Motion(w); }},
}};

void take_number(const NumberSetting& s, const Json& asked, TrackRequest& out) {
  const auto it = asked.find(s.key);
  if (it == asked.end() || it->is_null()) return;
  const double v = it->is_number() ? it->get<double>() : std::nan("");
  if (!(v >= s.min && v <= s.max) || (s.integer && v != std::floor(v)))
    throw Error(Errc::usage, s.key,
                fmt::format("{} must be {} between {:g} and {:g}{}", it->dump(),
                            s.integer ? "an integer" : "a number", s.min, s.max, s.unit));
  s.set(out.options, v);
  out.words.insert(out.words.end(), {fmt::format("--{}", s.key), fmt::format("{}", v)});
}

void take_word(const WordSetting& s, const Json& asked, TrackRequest& out) {
  const auto it = asked.find(s.key);
  if (it == asked.end() || it->is_null()) return;
  const std::string word = it->is_string() ? it->get<std::string>() : it->dump();
  const auto at = std::find(s.words.begin(), s.words.end(), word);
  if (at == s.words.end())
    throw Error(Errc::usage, s.key,
                fmt::format("\"{}\" must be one of {}", word.substr(0, 40), fmt::join(s.words, ", ")));
  s.set(out.options, std::size_t(at - s.words.begin()));
  if (at != s.words.begin()) out.words.insert(out.words.end(), {fmt::format("--{}", s.key), word});
}

void take_region(const Json& asked, TrackRequest& out) {
  const auto it = asked.find("region");
  if (it == asked.end() || it->is_null()) return;
  const auto is_side = [](const Json& v) { return v.is_number_integer() && v >= 0 && v <= 1000000; };
  if (!it->is_array() || it->size() != 4 || !std::all_of(it->begin(), it->end(), is_side))
    throw Error(Errc::usage, "region",
                "must be column, row, width and height in px: four integers that are not negative");
  const auto r = it->get<std::vector<int>>();
  out.options.region = PixelRegion{r[0], r[1], r[2], r[3]};
  out.words.insert(out.words.end(), {"--region", fmt::format("{}", fmt::join(r, ","))});
}

}  // namespace

TrackRequest track_request(const Workspace& workspace, const Json& asked) {
  TrackRequest out;
  out.file = text_of(asked, "file");
  out.options.video = workspace.existing(out.file);
  for (const NumberSetting& s : kNumberSettings) take_number(s, asked, out);
  for (const WordSetting& s : kWordSettings) take_word(s, asked, out);
  take_region(asked, out);
  if (const auto it = asked.find("drop"); it != asked.end() && it->is_boolean() && it->get<bool>()) {
    out.options.inside_drop = true;
    out.words.emplace_back("--drop");
  }
  const VideoPart& part = out.options.part;
  if (part.to_s && *part.to_s <= part.from_s)
    throw Error(Errc::usage, "to",
                fmt::format("{:g} s must be later than from = {:g} s", *part.to_s, part.from_s));
  return out;
}

}  // namespace faba
