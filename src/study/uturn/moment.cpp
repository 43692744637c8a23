#include "study/uturn/moment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/constants.h"
#include "core/error.h"
#include "core/statistics.h"
#include "study/stats/study_random.h"
#include "study/tracks/track_measurement.h"
#include "study/uturn/cell_drag.h"
#include "study/uturn/moment_warnings.h"
#include "study/uturn/simulated_turns.h"

namespace faba {
namespace {

constexpr int kResampledCells = 1000;
constexpr std::size_t kSimulatedCells = 2000;  // turns: the median has a standard error of 3 % / sqrt(kappa)
constexpr std::uint64_t kMomentSeed = 1;

// All turns of one cell, as 1 / (rate per field), s T.
struct CellTurns {
  std::vector<double> inverse_rate;
};

// 1 / median of the inverse rates: as the median of the rates, but negative values of single turns count as
// fast ones.
double rate_of(const std::vector<const std::vector<CellTurns>*>& groups, StudyRandom* random) {
  std::vector<double> all;
  for (const auto* cells : groups)
    for (std::size_t i = 0; i < cells->size(); ++i) {
      const CellTurns& c = (*cells)[random ? random->below(cells->size()) : i];
      all.insert(all.end(), c.inverse_rate.begin(), c.inverse_rate.end());
    }
  return 1 / median(all);
}

// Median over the turns, resampled by cells within each video, times lognormal factors.
MedianInterval interval_of(const std::vector<const std::vector<CellTurns>*>& groups, double factor,
                           double factor_sd, std::uint64_t seed) {
  StudyRandom random(seed, StudyDraws::u_turn);
  std::vector<double> resampled;
  resampled.reserve(kResampledCells);
  for (int i = 0; i < kResampledCells; ++i)
    resampled.push_back(factor * rate_of(groups, &random) * std::exp(factor_sd * random.normal()));
  return {factor * rate_of(groups, nullptr), {quantile(resampled, 0.05), quantile(resampled, 0.95)}};
}

// Ratio of estimated and true rate in simulated turns with the frame rate, noise and alignment of the video.
double bias_of(const UTurnSurvey& s) {
  std::vector<double> times;
  for (const UTurn& t : s.turns) times.push_back(t.time_s);
  const double time = median(times);
  if (!(time > 0) || s.disorder >= 1) return 1;
  const double after = 3 * s.window_s + s.half_s;
  const UTurnSurvey simulated = find_u_turns(
      simulated_u_turns(1 / time, s.disorder, s.noise, s.frame_s, after, kSimulatedCells, kMomentSeed),
      {kSimulatedReversal_s}, s.frame_s);
  std::vector<double> found;
  for (const UTurn& t : simulated.turns) found.push_back(t.time_s);
  return found.empty() || !(median(found) > 0) ? 1 : time / median(found);
}

std::vector<CellTurns> cells_of(const FieldStrength& f) {
  std::map<std::uint64_t, CellTurns> cells;
  for (const UTurn& t : f.survey.turns) cells[t.track].inverse_rate.push_back(t.time_s * f.bias * f.field_t);
  std::vector<CellTurns> out;
  out.reserve(cells.size());
  for (auto& [track, turns] : cells) out.push_back(std::move(turns));
  return out;
}

class TrackKeeper final : public TrackListener {
 public:
  void frame(std::uint64_t, double, const GrayF&, const Tracker&) override {}
  void track(const Track& t) override {
    Track& kept = tracks_[t.number];
    kept.number = t.number;
    kept.points.insert(kept.points.end(), t.points.begin(), t.points.end());
  }
  std::vector<Track> tracks() const {
    std::vector<Track> out;
    for (const auto& [number, t] : tracks_) out.push_back(t);
    return out;
  }

 private:
  std::map<std::uint64_t, Track> tracks_;
};

}  // namespace

MomentEstimate moment_of(std::vector<FieldStrength> fields, const std::optional<CellBody>& cell,
                         double field_sd) {
  MomentEstimate m;
  std::vector<std::vector<CellTurns>> cells;
  for (FieldStrength& f : fields) {
    if (!f.survey.turns.empty()) f.bias = bias_of(f.survey);
    cells.push_back(cells_of(f));
    m.turns += f.survey.turns.size();
  }
  std::vector<const std::vector<CellTurns>*> all;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (cells[i].empty()) continue;
    all.push_back(&cells[i]);
    fields[i].rate_per_t = interval_of({&cells[i]}, 1, 0, kMomentSeed + 1 + i);
  }
  if (!all.empty()) m.rate_per_t = interval_of(all, 1, field_sd, kMomentSeed);
  if (cell) {
    m.drag = cell->drag_factor * rotational_drag(cell->length, cell->width, cell->viscosity);
    if (!all.empty()) m.moment = interval_of(all, *m.drag, std::hypot(field_sd, cell->drag_sd), kMomentSeed);
  }
  m.fields = std::move(fields);
  m.warnings = moment_warnings(m, cell);
  return m;
}

MomentEstimate measure_moment(const MomentJob& job) {
  std::vector<FieldStrength> fields;
  std::vector<Warning> warnings;
  for (const MomentVideo& v : job.videos) {
    TrackOptions options;
    options.video = v.file;
    options.part.fps = v.fps;
    options.threads = job.threads;
    const RunVideo source = run_video(v.file);
    std::uint64_t total = 0;
    const auto tick = [&](std::int64_t done) {
      job.progress(v.file.filename().string(), std::uint64_t(done), total);
      if (job.stop()) throw Error(Errc::interrupted, v.file.string(), "stopped before the end");
    };
    const TrackSurvey survey =
        survey_tracks(options, source.file, [&](std::int64_t done, std::int64_t stated) {
          total = 2 * std::uint64_t(stated);
          tick(done);
        });
    if (!survey.timed)
      throw Error(Errc::input, v.file.string(), "states no frame rate; give `fps` in the study file");
    total = 2 * std::uint64_t(survey.frames);
    TrackKeeper keeper;
    const TrackMeasurement measured = measure_tracks(options, source, survey, keeper,
                                                     [&](std::int64_t done) { tick(survey.frames + done); });
    for (Warning w : measured.warnings) {
      if (w.quality != Quality::poor) continue;
      w.evidence =
          fmt::format("{}{}{}", v.file.filename().string(), w.evidence.empty() ? "" : ": ", w.evidence);
      w.quality = Quality::doubtful;  // the median over complete turns ignores many wrong links
      warnings.push_back(std::move(w));
    }
    fields.push_back({.file = v.file,
                      .field_t = v.field_t,
                      .survey = find_u_turns(keeper.tracks(), v.reversals_s, survey.frame_s)});
  }
  MomentEstimate m = moment_of(std::move(fields), job.cell, job.field_sd);
  m.warnings.insert(m.warnings.end(), warnings.begin(), warnings.end());
  return m;
}

}  // namespace faba
