// Tests `faba activity` with a study as in the thesis (theory A16, eq. 4.1): renders videos of four
// experiments at eight air exposure times, with camera noise and without, and measures them. Prints one JSON
// object per seed for bench/exposure.py.
//
//   bench_exposure SCENE FIRST LAST [FOLDER]
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "app/run/simulation.h"
#include "app/scenario/read_scenario.h"
#include "study/pages/activity_report.h"
#include "study/pages/flow_report.h"
#include "vision/flow/flow_file.h"

using namespace faba;

namespace {

constexpr double kFrom = 19;  // s: cells gather at the edge until 20 s
constexpr int kExposures = 8, kExperiments = 4;

struct Sample {
  double exposure_s;
  int experiment;
  std::uint64_t seed;
  bool noise;
};

Scenario scenario_of(const std::string& scene, const Sample& s) {
  Document d = read_toml(scene);
  d.set("exposure", Json(fmt::format("{} s", s.exposure_s)), "bench");
  d.set("swarm[0].count", Json(240 + 40 * s.experiment), "bench");  // drops differ
  if (!s.noise) d.set("microscope.noise", Json(0.0), "bench");
  return read_scenario(d, builtin_parts());
}

// Writes the optical flow of one rendered video from kFrom on, in the format of `faba run`.
void record(const std::string& scene, const Sample& sample, const std::filesystem::path& file, Pool& pool) {
  const Scenario s = scenario_of(scene, sample);
  Simulation simulation(s, sample.seed, pool);
  const auto method = s.flow.make({&pool});
  const FlowInfo info{
      simulation.frame().width, simulation.frame().height, s.camera.rate, {}, s.flow.resolved.dump(), scene};
  FlowFileWriter writer(file, info);
  GrayF before, after;
  Flow flow;
  struct Camera final : Sink {
    std::function<void(const Tick&)> take_one;
    void take(const Tick& t) override { take_one(t); }
  } camera;
  camera.take_one = [&](const Tick& t) {
    const double now = double(t.index) / s.camera.rate;
    if (now < kFrom) return;
    const ImageRef picture = simulation.rig().picture();
    after = GrayF(picture->width, picture->height);
    after.px.assign(picture->px.begin(), picture->px.end());
    if (!before.empty()) {
      method->between(before, after, flow);
      writer.write(t.index, now - kFrom - 1 / s.camera.rate, now - kFrom, flow);
    }
    std::swap(before, after);
  };
  simulation.loop().sinks = {&camera};
  run(simulation.loop(), s.frames(), [] { return true; });
  writer.close();
}

// `noise_free_above`: flow threshold of videos without noise, px; without a value, videos have camera noise
// and the threshold is determined from them.
ActivityResult study(const std::string& scene, std::uint64_t seed, std::optional<double> noise_free_above,
                     const std::filesystem::path& folder, Pool& pool) {
  ActivityJob job;
  job.threshold_px = noise_free_above;
  job.method = flow_part({}, published_flow());
  job.threads = pool.threads();
  for (int e = 0; e < kExperiments; ++e)
    for (int i = 1; i <= kExposures; ++i) {
      const Sample sample{100.0 * i, e, seed * 1000 + std::uint64_t(10 * e + i), !noise_free_above};
      const auto file = folder / fmt::format("{}-{}.h5", e, i);
      record(scene, sample, file, pool);
      job.videos.push_back({file, sample.exposure_s, std::to_string(e), 0.0});
    }
  return measure_activity(job);
}

nlohmann::ordered_json shown(const ActivityResult& r) {
  const auto j = activity_json(r);
  auto peaks = nlohmann::ordered_json::array();
  for (const VideoActivity& v : r.videos)
    peaks.push_back({{"exposure_s", *v.input.exposure_s},
                     {"experiment", v.input.experiment},
                     {"peak_s", v.fit.peak_s},
                     {"se_s", v.fit.se_peak_s},
                     {"has_peak", has_peak(v)},
                     {"responds", v.responds}});
  return {{"peak_line", j["peak_line"]}, {"cutoff_s", j["cutoff_s"]}, {"peaks", peaks}};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    fmt::print(stderr, "bench_exposure SCENE FIRST LAST [FOLDER]\n");
    return 2;
  }
  const std::string scene = argv[1];
  const int first = std::atoi(argv[2]), last = std::atoi(argv[3]);
  const std::filesystem::path folder =
      argc > 4 ? argv[4] : std::filesystem::temp_directory_path() / "faba-exposure";
  std::filesystem::create_directories(folder);
  Pool pool;
  for (int k = first; k <= last; ++k) {
    const ActivityResult noisy = study(scene, std::uint64_t(k), {}, folder, pool);
    const double threshold = noisy.videos.front().threshold_px;
    const ActivityResult plain = study(scene, std::uint64_t(k), threshold, folder, pool);
    fmt::print(
        "{}\n",
        nlohmann::ordered_json{
            {"seed", k}, {"threshold_px", threshold}, {"noisy", shown(noisy)}, {"noise_free", shown(plain)}}
            .dump());
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& e) {
  fmt::print(stderr, "bench_exposure: {}\n", e.what());
  return 1;
}
