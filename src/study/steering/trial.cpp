#include "study/steering/trial.h"

#include "app/run/simulation.h"
#include "app/sinks/series_row.h"
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

}  // namespace

Series trial(const Scenario& s, std::uint64_t seed, const std::function<bool()>& stop) {
  Pool pool(1);
  Simulation simulation(s, seed, pool);
  SeriesInMemory columns(sink_context(s, simulation, pool, {}));
  simulation.loop().sinks.push_back(&columns);
  run(simulation.loop(), s.frames(), [&] {
    if (stop()) throw Error(Errc::interrupted, s.params.title, "stopped");
    return true;
  });
  return columns.series(s.params.title);
}

}  // namespace faba
