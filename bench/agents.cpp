// Measures ns per agent-step of the three models, of the limits of the machine and of a sequential program.
// Prints JSON lines for agents.py. `bench_agents [--quick]`.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "checks.h"
#include "core/toml.h"
#include "machine.h"
#include "peers/sequential.h"
#include "timing.h"

namespace faba::bench {
namespace {

struct Effort {
  std::vector<std::size_t> agents{1000, 10000, 100000, 1000000};
  double seconds = 1.5;  ///< per group of cases
  int least = 9;         ///< repeats
};

// Enough steps for the resolution of the clock, few enough that no cell crosses the box.
int steps(std::size_t agents) { return agents >= 1000000 ? 8 : agents >= 100000 ? 24 : 48; }

bool all_ok = true;

void print(const Json& j) {
  fmt::print("{}\n", j.dump());
  std::fflush(stdout);
}

Json time_of(const Timed& t) {
  const Spread s = spread(t.ns);
  return {{"ns", s.median}, {"ns_low", s.low}, {"ns_high", s.high}, {"repeats", t.ns.size()}};
}

Json verdict(const std::vector<Check>& all) {
  Json j = Json::array();
  for (const Check& c : all) {
    all_ok = all_ok && c.ok();
    j.push_back({{"what", c.what},
                 {"value", c.value},
                 {"expected", c.expected},
                 {"tolerance", c.tolerance},
                 {"ok", c.ok()}});
  }
  return j;
}

// The parameters of the models, for the programs in other languages.
Json description() {
  Json sizes = Json::array();
  for (const std::size_t n : Effort{}.agents) sizes.push_back({n, box(n).width, box(n).height});
  Pool pool(1);
  Swarm one({"dipole", 1000}, pool);
  const double turning = double(one.world().state().agents["turning"][0]), px = kMetresPerPixel;
  const double d_r = turning * kField / alignment();
  return {{"kind", "scene"},
          {"drift", {kDrift.x, kDrift.y}},
          {"hold", kHold},
          {"basic_noise", kBasicNoise},
          {"adapted_noise", kAdaptedNoise},
          {"dt_s", kStep},
          {"w_per_s", turning * kField},
          {"d_r_per_s", d_r},
          {"d_t_px2_per_s", 4.0 / 3 * d_r * 0.7e-6 * 0.7e-6 / (px * px)},  // kT/f_t from kT/f_r of a sphere
          {"speed_px_per_s", {186e-6 / px, 45e-6 / px, 320e-6 / px}},
          {"alignment", alignment()},
          {"settling", kSettling},
          {"sizes", sizes},
          {"vector_unit", vector_unit()},
          {"compiler", __VERSION__},
          {"version", FABA_VERSION}};
}

std::vector<Scene> scenes(const std::string& model, std::size_t agents) {
  std::vector<Scene> all;
  for (const char* order : {"none", "two-phase"})
    for (const unsigned threads : {1u, 2u}) all.push_back({model, agents, order, threads});
  if (model == "basic") all.push_back({model, agents, "published", 1});
  return all;
}

class Group {
 public:
  Group(const std::string& model, std::size_t agents, const Effort& effort)
      : model_(model), agents_(agents), steps_(steps(agents)), effort_(effort) {}

  void run(Pool& one, Pool& two) {
    for (const Scene& s : scenes(model_, agents_))
      swarms_.push_back(std::make_unique<Swarm>(s, s.threads == 1 ? one : two));
    if (model_ == "dipole") settle();
    for (auto& s : swarms_) add(*s);
    if (model_ == "basic") add_sequential();
    for (Pool* pool : {&one, &two}) add_limits(*pool);
    time_in_turns(timed_, effort_.least, effort_.seconds);
    for (std::size_t i = 0; i < timed_.size(); ++i) {
      head_[i].update(time_of(timed_[i]));
      head_[i]["checks"] = verdict(check_[i]());
      print(head_[i]);
    }
  }

 private:
  void settle() {
    swarms_[1]->advance(kSettling);  // without exclusion, two threads
    for (auto& s : swarms_)
      if (s != swarms_[1]) s->take_headings(*swarms_[1]);
    swarms_[1]->take_headings(*swarms_[1]);
  }

  void put(Json head, std::function<void()> prepare, std::function<void()> work, double units,
           std::function<std::vector<Check>()> check) {
    head["model"] = model_;
    head["agents"] = agents_;
    head_.push_back(std::move(head));
    timed_.push_back({std::move(prepare), std::move(work), units});
    check_.push_back(std::move(check));
  }

  void add(Swarm& s) {
    Json head{{"kind", "faba"},
              {"order", s.scene().order},
              {"threads", s.scene().threads},
              {"bytes_per_agent", s.bytes_per_agent()}};
    const auto prepare = [&s] {
      s.restore();
      s.advance(kCycle);
    };
    // The state must be identical for any number of threads. The previous swarm is the same with one thread.
    const Swarm* alone = s.scene().threads == 2 ? swarms_[head_.size() - 1].get() : nullptr;
    const auto check = [&s, alone] {
      auto all = checks(s);
      if (alone)
        all.push_back({"same state as one thread",
                       alone->world().state().hash() == s.world().state().hash() ? 1.0 : 0.0, 1, 0});
      return all;
    };
    put(
        head, prepare, [this, &s] { s.advance(steps_); }, double(steps_) * double(agents_), check);
  }

  void add_sequential() {
    const Size size = box(agents_);
    peer_ = std::make_unique<Sequential>(agents_, size.width, size.height, kBasicNoise, kHold);
    const auto go = [this](int n) {
      for (int i = 0; i < n; ++i) {
        const double sign = peer_->iteration() % kCycle < kHold ? 1 : -1;
        peer_->iterate(sign * kDrift.x, sign * kDrift.y);
      }
    };
    const auto check = [this] {
      double mean = 0, square = 0;
      for (const auto& b : peer_->bacteria()) {
        mean += b.vx / double(agents_);
        square += b.vx * b.vx / double(agents_);
      }
      const double variance = kBasicNoise * (kBasicNoise + 1) / 3.0;
      // The fourth moment of a discrete uniform distribution is at most 1.8 variance^2.
      return std::vector<Check>{
          {"mean vx", mean, -kDrift.x, 5 * std::sqrt(variance / double(agents_))},
          {"var vx", square - mean * mean, variance, 5 * variance * std::sqrt(0.8 / double(agents_))},
          {"occupied sites", double(peer_->occupied()), double(agents_), 0}};
    };
    put(
        {{"kind", "sequential"}, {"order", "published"}, {"threads", 1}},
        [this, go] {
          peer_->restore();
          go(kCycle);
        },
        [this, go] { go(steps_); }, double(steps_) * double(agents_), check);
  }

  void add_limits(Pool& pool) {
    machines_.push_back(std::make_unique<Machine>(agents_, pool));
    Machine& m = *machines_.back();
    for (const auto& name : Machine::names())
      put(
          {{"kind", "limit"}, {"what", name}, {"threads", pool.threads()}}, [&m, name] { m.run(name, 2); },
          [this, &m, name] { m.run(name, steps_); }, double(steps_) * double(agents_),
          [] { return std::vector<Check>{}; });
  }

  std::string model_;
  std::size_t agents_;
  int steps_;
  Effort effort_;
  std::vector<std::unique_ptr<Swarm>> swarms_;
  std::unique_ptr<Sequential> peer_;
  std::vector<std::unique_ptr<Machine>> machines_;
  std::vector<Json> head_;
  std::vector<Timed> timed_;
  std::vector<std::function<std::vector<Check>()>> check_;
};

}  // namespace
}  // namespace faba::bench

int main(int argc, char** argv) {
  using namespace faba::bench;
  Effort effort;
  if (argc > 1 && std::strcmp(argv[1], "--quick") == 0) effort = {{1000, 10000, 100000}, 0.4, 7};
  try {
    print(description());
    faba::Pool one(1), two(2);
    for (const std::size_t n : effort.agents)
      for (const char* model : {"basic", "adapted", "dipole"}) Group(model, n, effort).run(one, two);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_agents: {}\n", e.what());
    return 1;
  }
  if (!all_ok) fmt::print(stderr, "bench_agents: a check failed\n");
  return all_ok ? 0 : 1;
}
