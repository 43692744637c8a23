#include "study/calibrate/rendered_experiment.h"

#include <fmt/format.h>

#include <stdlib.h>
#include <algorithm>

#include "app/run/simulation.h"
#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "app/sinks/sinks.h"
#include "core/error.h"
#include "study/identify/response/response_survey.h"
#include "study/identify/sampled_episode.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed at the end.
class RenderedFolder {
 public:
  RenderedFolder() {
    std::string name = (fs::temp_directory_path() / "faba-calibrate-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(Errc::internal, name, "cannot create this folder; set TMPDIR");
    path_ = name;
  }
  ~RenderedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  RenderedFolder(const RenderedFolder&) = delete;
  RenderedFolder& operator=(const RenderedFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Renders video.avi.
void render(const SampledEpisode& sampled, const ResponseVideo& v, std::uint64_t seed, const fs::path& dir) {
  Pool pool(1);
  Scenario s = read_scenario(sampled.scenario, builtin_parts());
  s.record = {};
  s.record.as_seen = true;
  s.microscope.noise = v.ground->noise_sd;
  Simulation simulation(s, seed, pool, v.ground);
  const auto video = video_sink(sink_context(s, simulation, pool, dir), true, nullptr);
  simulation.loop().sinks.push_back(video.get());
  run(simulation.loop(), s.frames(), [] { return true; });
  video->finish(false);
}

}  // namespace

std::vector<ResponseVideo> rendered_experiment(const IdentifyStudy& study, const Candidate& c,
                                               const std::vector<ResponseVideo>& design,
                                               const Eigen::VectorXd& u, std::uint64_t seed,
                                               const ModelFamily& difference,
                                               const std::function<void()>& tick) {
  const RenderedFolder folder;
  std::vector<ResponseVideo> videos;
  for (std::size_t i = 0; i < design.size(); ++i) {
    const ResponseVideo& v = design[i];
    const Episode& episode = v.episodes.front();  // with a boundary there is one
    const EpisodeSeeds seeds{seed, seed + i + 1};
    const SampledEpisode sampled = sampled_episode(study, c, v, episode, u, seeds, &difference);
    const fs::path dir = folder.path() / fmt::format("{}", i + 1);
    fs::create_directories(dir);
    render(sampled, v, seeds.episode, dir);
    ResponseInput input;
    input.file = dir / "video.avi";
    input.experiment = v.input.experiment.empty() ? fmt::format("video {}", i + 1) : v.input.experiment;
    input.exposure_s = std::max(0.0, v.input.exposure_s + episode.start_s - sampled.timing.lead_s);
    input.threads = 1;
    input.um_per_px = v.um_per_px;
    input.segments = episode.segments;
    // The study knows the times of the field reversals only with their errors.
    for (FieldSegment& segment : input.segments) {
      segment.t0_s += sampled.timing.lead_s;
      segment.t1_s += sampled.timing.lead_s;
    }
    videos.push_back(survey_response(input, study.boundary, study.measure, tick));
    videos.back().field_t = v.field_t;
    videos.back().segments_detected = v.segments_detected;
  }
  return videos;
}

}  // namespace faba
