#include "study/best_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "vision/picture.h"

namespace faba {

void write_best_scene(const Identification& r, const std::filesystem::path& dir) {
  const ResponseVideo& video = r.videos.front();
  const Episode& episode = video.episodes.front();
  const FoundModel& best = r.models[r.best];
  const Candidate& candidate = r.study.candidates[r.best];

  Gray8 picture(video.view.width, video.view.height);
  std::transform(video.ground->light.px.begin(), video.ground->light.px.end(), picture.px.begin(),
                 [](float share) { return std::uint8_t(std::clamp(share, 0.0F, 1.0F) * 255 + 0.5F); });
  write_png(dir / "background.png", picture);

  Document d =
      episode_scenario(video, episode, {r.study.boundary, r.study.scene, candidate.model, candidate.drive_t},
                       exact_timing(episode));
  for (const auto& [path, value] : best.best.items()) d.set(path, value, "best");
  d.root["title"] = fmt::format("{}, as {} was found in {}", r.study.title, best.name, episode.name);
  d.root["microscope"]["background"] = "background.png";
  d.root["microscope"]["noise"] = video.ground->noise_sd;
  for (const char* ours : {"estimator", "record"}) d.root.erase(ours);
  write_file(dir / "best.toml", to_toml(d.root));
}

}  // namespace faba
