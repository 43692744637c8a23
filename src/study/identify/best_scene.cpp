#include "study/identify/best_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/file.h"
#include "core/units.h"
#include "vision/files/picture.h"

namespace faba {

namespace {

// Digits beyond what anything here is known to are noise to a reader.
std::string six_digits(const std::string& quantity) {
  double v = 0;
  const auto [end, error] = std::from_chars(quantity.data(), quantity.data() + quantity.size(), v);
  if (error != std::errc() || (*end != ' ' && *end != 0)) return quantity;
  return fmt::format("{:.6g}{}", v, end);
}

// Of a pair such as a field's what is lost beside the other component is none.
void round_off(Json& j) {
  if (j.is_number_float()) j = std::stod(fmt::format("{:.6g}", j.get<double>()));
  if (j.is_string()) j = six_digits(j.get<std::string>());
  if (j.is_structured())
    for (Json& one : j) round_off(one);
  if (!j.is_array() || j.size() != 2 || !j[0].is_string() || !j[1].is_string()) return;
  try {
    const Quantity a = parse_quantity(j[0].get<std::string>()), b = parse_quantity(j[1].get<std::string>());
    const std::string unit = j[0].get<std::string>().substr(j[0].get<std::string>().find(' ') + 1);
    constexpr double kNothing = 1e-9;
    if (std::fabs(a.value) < kNothing * std::fabs(b.value)) j[0] = "0 " + unit;
    if (std::fabs(b.value) < kNothing * std::fabs(a.value)) j[1] = "0 " + unit;
  } catch (const std::invalid_argument&) {
    return;  // words
  }
}

// A goal that can be seen: the place in view that is nearest to the drop's middle.
Json goal_of(const ResponseVideo& v) {
  constexpr double kMargin = 0.15;  // of the view
  const double w = v.view.width, h = v.view.height;
  Vec2 at{w / 2, h / 2};
  if (v.edge) at = v.edge->centre_image;
  at = {std::clamp(at.x, kMargin * w, (1 - kMargin) * w), std::clamp(at.y, kMargin * h, (1 - kMargin) * h)};
  return {{"type", "hold"}, {"setpoint_px", {std::round(at.x), std::round(at.y)}}};
}

}  // namespace

void write_best_scene(const Identification& r, const std::filesystem::path& dir) {
  const ResponseVideo& video = r.videos.front();
  const Episode& episode = video.episodes.front();
  const FoundModel& best = r.models[r.best];
  const Candidate& candidate = r.study.candidates[r.best];

  Gray8 picture(video.view.width, video.view.height);
  std::transform(video.ground->light.px.begin(), video.ground->light.px.end(), picture.px.begin(),
                 [](float share) { return std::uint8_t(std::lround(std::clamp(share, 0.0F, 1.0F) * 255)); });
  write_png(dir / "background.png", picture);

  Document d = episode_scenario(
      video, episode, {r.study.boundary, r.study.scene, candidate.model, candidate.field_strength_in(video)},
      exact_timing(episode));
  for (const auto& [path, value] : best.best.items()) d.set(path, value, "best");
  d.root["title"] = fmt::format("{}, as {} was found in {}", r.study.title, best.name, episode.name);
  d.root["microscope"]["background"] = "background.png";
  d.root["microscope"]["noise"] = video.ground->noise_sd;
  for (const char* ours : {"estimator", "record"}) d.root.erase(ours);
  d.root["record"]["as_seen"] = true;
  d.root["reference"] = goal_of(video);
  round_off(d.root);
  write_file(dir / "best.toml", to_toml(d.root));
}

}  // namespace faba
