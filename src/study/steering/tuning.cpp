#include "study/steering/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <nlopt.hpp>

#include "app/run/simulation.h"
#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "control/setpoint_count.h"
#include "core/hash.h"
#include "core/units.h"
#include "study/steering/metric_list.h"
#include "study/steering/trial.h"

namespace faba {
namespace {

using Point = std::vector<double>;  // values of the parameters; empty: the controller as given

const Parts& parts_of(const TuningStudy& study) { return study.parts ? *study.parts : builtin_parts(); }

Scenario scenario_of(const TuningStudy& study, const Point& point) {
  Document d = study.scene;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const TunedParameter& p = study.parameters[i];
    const bool pure = p.unit.empty() || p.unit == "px";
    d.set("controller." + p.key, pure ? Json(point[i]) : Json(format_quantity(point[i], p.unit)),
          "faba tune");
  }
  return read_scenario(d, parts_of(study));
}

// Four digits, so that a scenario with the value is easy to read.
double rounded(double v) { return std::stod(fmt::format("{:.4g}", v)); }

// Position of a point within the ranges, 0 to 1 on a logarithmic scale, and back.
Point point_at(const TuningStudy& study, const std::vector<double>& u) {
  Point p;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const TunedParameter& t = study.parameters[i];
    const double x = std::clamp(u[i], 0.0, 1.0);
    p.push_back(std::clamp(rounded(t.low * std::pow(t.high / t.low, x)), t.low, t.high));
  }
  return p;
}
std::vector<double> position_of(const TuningStudy& study, const Point& p) {
  std::vector<double> u;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const TunedParameter& t = study.parameters[i];
    u.push_back(std::clamp(std::log(p[i] / t.low) / std::log(t.high / t.low), 0.0, 1.0));
  }
  return u;
}

// Halton's sequence, which fills the unit cube evenly for any number of points.
double halton(int index, int base) {
  double value = 0;
  for (double f = 1.0 / base; index > 0; index /= base, f /= base) value += f * (index % base);
  return value;
}

std::vector<Point> design(const TuningStudy& study) {
  constexpr std::array kBases{2, 3, 5, 7, 11, 13, 17, 19};
  const std::size_t n = study.parameters.size();
  const int points = std::min(study.evaluations / 2, int(8 * n));
  std::vector<Point> all;
  Point given;
  for (const TunedParameter& p : study.parameters)
    if (p.given && *p.given >= p.low && *p.given <= p.high) given.push_back(*p.given);
  all.push_back(given.size() == n ? given : Point{});
  for (int k = 1; k <= points; ++k) {
    std::vector<double> u;
    for (std::size_t i = 0; i < n; ++i) u.push_back(halton(k, kBases[i % kBases.size()]));
    all.push_back(point_at(study, u));
  }
  return all;
}

std::string description_of(const std::vector<Point>& points, std::uint64_t first_seed, int seeds) {
  return Json{{"points", points}, {"first_seed", first_seed}, {"seeds", seeds}}.dump();
}

// The value of a trial that is minimised; NaN if it is undefined.
double trial_value(const TuningStudy& study, const Scenario& s, std::size_t setpoints, std::uint64_t seed,
                   const std::function<bool()>& stop) {
  const Metrics m = measured_trial(s, seed, {setpoints}, stop).metrics;
  return (m.*metric(study.metric).value).value_or(std::numeric_limits<double>::quiet_NaN());
}

// Thrown through NLopt when the tasks of a round are computed elsewhere.
struct Missing {};

class TuningSearch {
 public:
  TuningSearch(const TuningStudy& study, ResultStore& results, const SweepOptions& options)
      : study_(study), results_(results), options_(options) {}

  /// Values of all trials, by point.
  std::vector<std::vector<double>> trials(const std::vector<Point>& points, std::uint64_t first, int seeds) {
    refused.assign(points.size(), false);
    const Round round = tuning_round(study_, description_of(points, first, seeds), options_.stop);
    if (!sweep(results_, round, options_)) throw Missing{};
    const std::uint64_t key = results_.key(round);
    std::vector<std::vector<double>> all(points.size());
    for (std::uint64_t task = 0; task < round.size; ++task) {
      const auto values = results_.find({key, task}).value();
      all[task / std::uint64_t(seeds)].push_back(values[0]);
      if (values[1] != 0) refused[task / std::uint64_t(seeds)] = true;
    }
    return all;
  }
  void evaluate(const std::vector<Point>& points) {
    const auto values = trials(points, study_.first_seed, study_.seeds);
    for (std::size_t i = 0; i < points.size(); ++i)
      evaluated.push_back({points[i], mean_over_seeds(values[i]), refused[i]});
  }
  /// The mean, infinite if it is undefined in some of the trials.
  double cost(std::size_t i) const {
    return evaluated[i].metric.n == study_.seeds ? evaluated[i].metric.mean
                                                 : std::numeric_limits<double>::infinity();
  }
  std::size_t best() const {
    std::size_t at = 0;
    for (std::size_t i = 1; i < evaluated.size(); ++i)
      if (cost(i) < cost(at)) at = i;
    return at;
  }
  void refine();

  std::vector<TunedPoint> evaluated;
  std::vector<bool> refused;  ///< of the last trials(): points that the controller refuses

 private:
  double cost_at(const Point& p) {
    const auto same = std::find_if(evaluated.begin(), evaluated.end(),
                                   [&](const TunedPoint& one) { return one.value == p; });
    if (same != evaluated.end()) return cost(std::size_t(same - evaluated.begin()));
    evaluate({p});
    return cost(evaluated.size() - 1);
  }

  const TuningStudy& study_;
  ResultStore& results_;
  const SweepOptions& options_;
  std::exception_ptr failure_;  ///< of an evaluation
};

void TuningSearch::refine() {
  const int left = study_.evaluations - int(evaluated.size()) + 1;
  const Point from = evaluated[best()].value;
  if (left <= 0 || from.empty()) return;
  nlopt::opt optimiser(nlopt::LN_SBPLX, unsigned(from.size()));
  optimiser.set_lower_bounds(0);
  optimiser.set_upper_bounds(1);
  optimiser.set_initial_step(0.15);  // the mean distance of the points of the design, 8 for each parameter
  optimiser.set_maxeval(left);
  optimiser.set_xtol_abs(0.01);  // 1 % of the logarithm of the range
  const auto value = [](const std::vector<double>& u, std::vector<double>&, void* self) {
    auto& search = *static_cast<TuningSearch*>(self);
    try {
      const double c = search.cost_at(point_at(search.study_, u));
      return std::isfinite(c) ? c : 1e300;  // NLopt requires numbers
    } catch (...) {                         // NLopt would replace it by an error of its own
      search.failure_ = std::current_exception();
      throw nlopt::forced_stop();
    }
  };
  optimiser.set_min_objective(value, this);
  std::vector<double> at = position_of(study_, from);
  double smallest = 0;
  try {
    optimiser.optimize(at, smallest);
  } catch (const nlopt::roundoff_limited&) {
    // The best point so far is used.
  } catch (const nlopt::forced_stop&) {
    std::rethrow_exception(failure_);
  }
}

}  // namespace

Round tuning_round(const TuningStudy& study, const std::string& description,
                   const std::function<bool()>& stop) {
  const Json j = Json::parse(description);
  const auto points = std::make_shared<const std::vector<Point>>(j.at("points").get<std::vector<Point>>());
  const auto first = j.at("first_seed").get<std::uint64_t>(), seeds = j.at("seeds").get<std::uint64_t>();
  Round round;
  round.description = description;
  round.size = points->size() * seeds;
  Pool pool(1);
  const std::size_t setpoints =
      setpoint_count(Simulation(scenario_of(study, {}), study.first_seed, pool).reference());
  round.work = [&study, points, first, seeds, setpoints, stop](std::uint64_t task) -> std::vector<double> {
    try {
      const Scenario s = scenario_of(study, (*points)[task / seeds]);
      return {trial_value(study, s, setpoints, first + task % seeds, stop), 0};
    } catch (const Error& e) {
      // A combination that the controller refuses, such as near_px > far_px, is not a candidate.
      if (e.code() != Errc::usage) throw;
      return {std::numeric_limits<double>::quiet_NaN(), 1};
    }
  };
  round.labels = [&study, points, first, seeds](std::uint64_t task) {
    std::vector<TaskLabel> labels;
    const Point& p = (*points)[task / seeds];
    for (std::size_t i = 0; i < p.size(); ++i)
      labels.push_back({study.parameters[i].key, fmt::format("{}", p[i]), p[i]});
    const std::uint64_t seed = first + task % seeds;
    labels.push_back({"seed", fmt::format("{}", seed), double(seed)});
    return labels;
  };
  return round;
}

std::string study_hash(const TuningStudy& study) {
  Hash h;
  h.text("tune");
  h.text(scenario_of(study, {}).hash());
  for (const TunedParameter& p : study.parameters) {
    h.text(p.key);
    h.value(p.low);
    h.value(p.high);
  }
  h.text(study.metric);
  for (const int n : {study.evaluations, study.seeds, study.held_out_seeds}) h.value(n);
  h.value(study.first_seed);
  h.value(study.first_held_out);
  return h.hex();
}

std::optional<Tuning> tune(const TuningStudy& study, ResultStore& results, const SweepOptions& options) {
  TuningSearch search(study, results, options);
  Tuning t{study, {}, 0, {}, {}, {}, {}};
  try {
    search.evaluate(design(study));
    search.refine();
    t.best = search.best();
    if (search.evaluated[t.best].metric.n == 0)
      throw Error(
          Errc::usage, study.scene.name,
          fmt::format("{} is undefined in every trial of all {} parameter sets, of which the "
                      "controller refuses {}; choose another --metric, a longer duration, or other ranges",
                      study.metric, search.evaluated.size(),
                      std::count_if(search.evaluated.begin(), search.evaluated.end(),
                                    [](const TunedPoint& p) { return p.refused; })));
    const Point& best = search.evaluated[t.best].value;
    const auto held = search.trials({{}, best}, study.first_held_out, study.held_out_seeds);
    t.held_out_given = {{}, mean_over_seeds(held[0]), false};
    t.held_out_best = {best, mean_over_seeds(held[1]), false};
    std::vector<double> difference;
    for (std::size_t k = 0; k < held[0].size(); ++k) difference.push_back(held[1][k] - held[0][k]);
    t.held_out_difference = mean_over_seeds(difference);
  } catch (const Missing&) {
    return {};
  }
  t.evaluated = std::move(search.evaluated);
  t.scene = scenario_of(study, t.evaluated[t.best].value).resolved();
  return t;
}

}  // namespace faba
