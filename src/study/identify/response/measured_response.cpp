#include "study/identify/response/measured_response.h"

#include <algorithm>

#include "core/error.h"
#include "study/data/run_video.h"
#include "study/identify/response/response_archive.h"
#include "study/identify/response/response_survey.h"
#include "study/identify/simulation_round.h"
#include "study/sweep/measured_file.h"

namespace faba {
namespace {

constexpr const char* kReferences = "-legacy";  // suffix of the key

std::optional<ResponseVideo> stored_response(const IdentifyStudy& study, std::size_t v,
                                             const std::filesystem::path& measured) {
  std::optional<Archive> a = read_measured(measured, measurement_key(study, v));
  if (!a) return {};
  ResponseVideo video;
  archive_response(*a, video);
  video.input = study.videos[v];
  for (const Episode& e : video.episodes)
    video.statistics.push_back(make_statistics(study.measure, e, video.view));
  return video;
}

std::optional<LegacyReferences> stored_references(const IdentifyStudy& study,
                                                  const std::filesystem::path& measured) {
  LegacyReferences all;
  for (std::size_t v = 0; v < study.videos.size(); ++v) {
    std::optional<Archive> a = read_measured(measured, measurement_key(study, v) + kReferences);
    if (!a) return {};
    archive_references(*a, all.emplace_back());
  }
  return all;
}

/// Everything that the tasks of a planned round refer to.
struct PlannedSimulations {
  IdentifyStudy study;
  std::vector<ResponseVideo> videos;
  LegacyReferences references;
  std::optional<ObservedStatistics> observed;
  std::optional<SimulationRound> simulations;
};

[[noreturn]] void not_measured(const std::filesystem::path& measured) {
  throw Error(
      Errc::input, measured.string(),
      "the measurement of a video is missing or damaged; run `faba study collect` to measure it again");
}

}  // namespace

std::vector<ResponseVideo> measured_responses(const IdentifyStudy& study, const SweepOptions& options,
                                              const std::function<void()>& reading) {
  std::vector<ResponseVideo> videos;
  for (std::size_t v = 0; v < study.videos.size(); ++v) {
    if (auto stored = stored_response(study, v, options.measured)) {
      stored->file = run_video(study.videos[v].file).file;
      videos.push_back(std::move(*stored));
      continue;
    }
    ResponseInput input = study.videos[v];
    input.threads = options.threads;
    videos.push_back(survey_response(input, study.boundary, study.measure, [&] {
      reading();
      if (options.stop()) throw study_stopped(study.videos[v].file.string());
    }));
    Archive a;
    archive_response(a, videos.back());
    write_measured(options.measured, measurement_key(study, v), a);
  }
  return videos;
}

std::vector<ResponseVideo> stored_responses(const IdentifyStudy& study,
                                            const std::filesystem::path& measured) {
  std::vector<ResponseVideo> videos;
  for (std::size_t v = 0; v < study.videos.size(); ++v) {
    auto stored = stored_response(study, v, measured);
    if (!stored) not_measured(measured);
    videos.push_back(std::move(*stored));
  }
  return videos;
}

LegacyReferences measured_references(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                     const SweepOptions& options, const std::function<void()>& reading) {
  if (auto stored = stored_references(study, options.measured)) return std::move(*stored);
  LegacyReferences all = legacy_references(videos, reading);
  for (std::size_t v = 0; v < all.size(); ++v) {
    Archive a;
    archive_references(a, all[v]);
    write_measured(options.measured, measurement_key(study, v) + kReferences, a);
  }
  return all;
}

Round planned_simulations(const IdentifyStudy& study, const std::filesystem::path& measured,
                          const std::string& description) {
  const auto all = std::make_shared<PlannedSimulations>();
  all->study = study;
  all->videos = stored_responses(study, measured);
  Round round;
  if (description == kLegacyRound) {
    auto stored = stored_references(study, measured);
    if (!stored) not_measured(measured);
    all->references = std::move(*stored);
    round = legacy_round(all->study, all->videos, all->references);
  } else {
    all->observed = observed_statistics(all->videos);
    all->simulations.emplace(all->study, all->videos, *all->observed);
    all->simulations->add_described(description);
    round = all->simulations->tasks();
  }
  // The tasks keep alive what they refer to.
  round.work = [all, work = round.work](std::uint64_t task) { return work(task); };
  round.labels = [all, labels = round.labels](std::uint64_t task) { return labels(task); };
  return round;
}

}  // namespace faba
