#include "study/steering/trial.h"

#include <fmt/format.h>

#include <chrono>

#include "app/run/simulation.h"
#include "app/sinks/series_row.h"
#include "control/plan/obstacles.h"
#include "core/error.h"

namespace faba {
namespace {

class SeriesInMemory final : public Sink {
 public:
  explicit SeriesInMemory(SinkContext c) : row_(std::move(c)), columns_(row_.names().size()) {}
  void take(const Tick& t) override {
    const std::vector<double> values = row_.values(t);
    for (std::size_t i = 0; i < values.size(); ++i) columns_[i].push_back(values[i]);
  }
  Series series(const std::string& source) { return {source, row_.names(), std::move(columns_)}; }

 private:
  SeriesRow row_;
  std::vector<std::vector<double>> columns_;
};

/// Counts frames with the mean, and cells, in the polygons.
class KeepOut final : public Sink {
 public:
  KeepOut(const Simulation& simulation, const std::vector<std::vector<Vec2>>& polygons_px)
      : simulation_(simulation) {
    for (const std::vector<Vec2>& one : polygons_px) {
      Polygon& p = polygons_.emplace_back();
      for (const Vec2 corner : one) p.push_back(simulation.frame().world_from_image(corner));
    }
  }
  void take(const Tick&) override {
    if (polygons_.empty()) return;
    const Columns& agents = simulation_.world().state().agents;
    const std::span<const float> x = agents["x"], y = agents["y"];
    Vec2 mean;
    std::size_t count = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec2 p{double(x[i]), double(y[i])};
      mean = mean + (1.0 / double(x.size())) * p;
      count += inside(p);
    }
    ++frames_;
    mean_ += inside(mean);
    cells_ += x.empty() ? 0 : double(count) / double(x.size());
  }
  void add_to(Metrics& m) const {
    if (frames_ == 0) return;
    m.keep_out_fraction = double(mean_) / double(frames_);
    m.keep_out_cells = cells_ / double(frames_);
  }

 private:
  bool inside(Vec2 p) const {
    for (const Polygon& polygon : polygons_)
      if (nearest_edge(polygon, p).distance < 0) return true;
    return false;
  }
  const Simulation& simulation_;
  std::vector<Polygon> polygons_;
  std::size_t frames_ = 0, mean_ = 0;
  double cells_ = 0;  ///< sum of the fractions
};

// Mean over the run, W; unknown without resistances.
void add_heat(const Simulation& simulation, const Series& series, Metrics& m) {
  const Field& field = *simulation.control().field;
  const std::span<const double> t = series.column("t_s");
  if (field.coils() == 0 || t.size() < 2) return;
  double joule = 0;
  bool known = false;
  for (std::size_t k = 0; k < field.coils(); ++k) {
    known = known || field.circuit(k).resistance > 0;
    const std::span<const double> current = series.column(fmt::format("current_{}_a", k));
    for (std::size_t i = 0; i + 1 < t.size(); ++i)
      joule += field.circuit(k).resistance * current[i] * current[i] * (t[i + 1] - t[i]);
  }
  if (known) m.coil_heat_w = joule / (t.back() - t.front());
}

void run_trial(Simulation& simulation, const Scenario& s, const std::function<bool()>& stop) {
  run(simulation.loop(), s.frames(), [&] {
    if (stop()) throw Error(Errc::interrupted, s.params.title, "stopped");
    return true;
  });
}

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class TimedEstimator final : public Estimator {
 public:
  TimedEstimator(Estimator& timed, double& time) : timed_(timed), time_(time) {}
  Estimate update(const Observation& o, const Command& last) override {
    const Clock::time_point start = Clock::now();
    Estimate e = timed_.update(o, last);
    time_ = seconds_since(start);
    return e;
  }

 private:
  Estimator& timed_;
  double& time_;
};

class TimedController final : public Controller {
 public:
  TimedController(Controller& timed, double& before, std::vector<double>& times)
      : timed_(timed), before_(before), times_(times) {}
  Command update(const Estimate& e, const Target& target, double dt) override {
    const Clock::time_point start = Clock::now();
    Command command = timed_.update(e, target, dt);
    times_.push_back(before_ + seconds_since(start));
    return command;
  }

 private:
  Controller& timed_;
  double& before_;
  std::vector<double>& times_;
};

}  // namespace

MeasuredTrial measured_trial(const Scenario& s, std::uint64_t seed, const TrialOptions& options,
                             const std::function<bool()>& stop) {
  Pool pool(1);
  Simulation simulation(s, seed, pool);
  SeriesInMemory columns(sink_context(s, simulation, pool, {}));
  KeepOut keep_out(simulation, options.keep_out_px);
  simulation.loop().sinks = {&columns, &keep_out};
  run_trial(simulation, s, stop);
  MeasuredTrial t{columns.series(s.params.title), {}};
  t.metrics = control_metrics(t.series, {}, options.setpoints);
  add_heat(simulation, t.series, t.metrics);
  keep_out.add_to(t.metrics);
  return t;
}

Series trial(const Scenario& s, std::uint64_t seed, const std::function<bool()>& stop) {
  Pool pool(1);
  Simulation simulation(s, seed, pool);
  SeriesInMemory columns(sink_context(s, simulation, pool, {}));
  simulation.loop().sinks = {&columns};
  run_trial(simulation, s, stop);
  return columns.series(s.params.title);
}

std::vector<double> cycle_times(const Scenario& s, std::uint64_t seed) {
  Pool pool(1);
  Simulation simulation(s, seed, pool);
  Loop& loop = simulation.loop();
  std::vector<double> times;
  double estimator_time = 0;
  TimedEstimator estimator(*loop.estimator, estimator_time);
  TimedController controller(*loop.controller, estimator_time, times);
  loop.estimator = &estimator;
  loop.controller = &controller;
  run_trial(simulation, s, [] { return false; });
  return times;
}

}  // namespace faba
