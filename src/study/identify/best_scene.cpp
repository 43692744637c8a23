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

// Six digits exceed the accuracy of all quantities of a scene.
std::string six_digits(const std::string& quantity) {
  double v = 0;
  const auto [end, error] = std::from_chars(quantity.data(), quantity.data() + quantity.size(), v);
  if (error != std::errc() || (*end != ' ' && *end != 0)) return quantity;
  return fmt::format("{:.6g}{}", v, end);
}

// A component that is negligible beside the other one of a pair, such as a field, becomes 0.
void round_off(Json& j) {
  if (j.is_number_float()) j = std::stod(fmt::format("{:.6g}", j.get<double>()));
  if (j.is_string()) j = six_digits(j.get<std::string>());
  if (j.is_structured())
    for (Json& one : j) round_off(one);
  if (!j.is_array() || j.size() != 2 || !j[0].is_string() || !j[1].is_string()) return;
  try {
    const Quantity a = parse_quantity(j[0].get<std::string>()), b = parse_quantity(j[1].get<std::string>());
    const std::string unit = j[0].get<std::string>().substr(j[0].get<std::string>().find(' ') + 1);
    constexpr double kNegligible = 1e-9;
    if (std::fabs(a.value) < kNegligible * std::fabs(b.value)) j[0] = "0 " + unit;
    if (std::fabs(b.value) < kNegligible * std::fabs(a.value)) j[1] = "0 " + unit;
  } catch (const std::invalid_argument&) {
    return;  // not quantities
  }
}

// Setpoint in the picture that is nearest to the centre of the drop.
Json reference_of(const ResponseVideo& v) {
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
                 [](float light) { return std::uint8_t(std::lround(std::clamp(light, 0.0F, 1.0F) * 255)); });
  write_png(dir / "background.png", picture);

  Document d = episode_scenario(
      video, episode, {r.study.boundary, r.study.scene, candidate.model, candidate.field_strength_in(video)},
      exact_timing(episode));
  for (const auto& [path, value] : best.best.items()) d.set(path, value, "best");
  d.root["title"] = fmt::format("{}: {}, identified from {}", r.study.title, best.name, episode.name);
  d.root["microscope"]["background"] = "background.png";
  d.root["microscope"]["noise"] = video.ground->noise_sd;
  for (const char* table : {"estimator", "record"}) d.root.erase(table);
  d.root["record"]["as_seen"] = true;
  d.root["reference"] = reference_of(video);
  round_off(d.root);
  write_file(dir / "best.toml", to_toml(d.root));
}

}  // namespace faba
