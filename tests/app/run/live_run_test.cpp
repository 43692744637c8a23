#include "app/run/live_run.h"
#include "app/scenario/read_scenario.h"

#include <doctest/doctest.h>

#include "app/recording/session.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

const char* kScene = R"(
[arena]
type = "drop"
radius_px = 200
[[swarm]]
count = 60
start = { type = "disc", radius_px = 40 }
)";

/// Runs a live run until frame `end`, as the lab does: in one loop, with exchanges in between.
void play(LiveRun& live, const std::vector<std::pair<std::uint64_t, Json>>& script, std::uint64_t end) {
  std::size_t next = 0;
  const auto due = [&] {
    for (; next < script.size() && script[next].first == live.frame(); ++next)
      live.exchange(script[next].second);
  };
  due();
  live.run([&] {
    due();
    return live.frame() < end;
  });
}

Json field(const char* x, const char* y) { return {{"controller", {{"type", "manual"}, {"field", {x, y}}}}}; }

std::string hash_of(const Scenario& s, unsigned threads) {
  test::TemporaryFolder folder("live");
  RunOptions o;
  o.out = folder.path() / "run";
  o.threads = threads;
  Session session = Session::begin(s, *s.params.seed, o);
  REQUIRE(session.run());
  return session.manifest().simulated->state_hash;
}

}  // namespace

TEST_CASE("the recorded scenario repeats a live run bit by bit") {
  const Parts parts = builtin_parts();
  Pool pool(2);
  LiveRun live(parse_toml(kScene, "test"), 5, parts, pool);
  play(live,
       {{0, field("0.2 mT", "0 T")},
        {7, field("0 T", "0.3 mT")},
        {7, field("0 T", "-0.3 mT")},
        {20, {{"controller", "fuzzy"}, {"reference", {{"type", "hold"}, {"setpoint_px", {300, 200}}}}}},
        {33, {{"swarm", 0}, {"model", {{"type", "dipole"}, {"speed", "90 um/s"}}}}},
        {40, {{"model", "basic"}}},
        {50, {{"model", {{"type", "dipole"}, {"preset", "MSR-1"}}}}}},
       60);
  const Scenario s = live.recorded();
  CHECK(s.events.size() == 6);  // two changes of the field before frame 7 are merged
  CHECK(s.frames() == 60);
  const Document again = parse_toml(to_toml(s.resolved()), "again");
  const Scenario read = read_scenario(again, parts);
  CHECK(read.hash() == s.hash());
  for (const unsigned threads : {1U, 3U}) CHECK(hash_of(read, threads) == live.state_hash());

  Scenario without = read;
  without.events.pop_back();
  CHECK(hash_of(without, 1) != live.state_hash());
}

TEST_CASE("events of the file are applied in a live run, after exchanges before the same frame") {
  const Parts parts = builtin_parts();
  Pool pool(1);
  const std::string text =
      std::string(kScene) +
      "[[event]]\nframe = 10\ncontroller = { type = 'manual', field = ['0.2 mT', '0 T'] }\n"
      "[[event]]\nframe = 50\ncontroller = 'fuzzy'\n";
  LiveRun live(parse_toml(text, "test"), 5, parts, pool);
  play(live, {{10, field("0 T", "0.3 mT")}, {20, {{"estimator", "visible"}}}}, 30);
  CHECK(live.scenario().controller.resolved["field"][0] == "0.0002 T");
  const Scenario s = live.recorded();
  CHECK(s.events.size() == 3);
  CHECK(hash_of(s, 1) == live.state_hash());
}

TEST_CASE("unsuitable exchanges are rejected and change nothing") {
  const Parts parts = builtin_parts();
  Pool pool(1);
  LiveRun live(parse_toml(kScene, "test"), 5, parts, pool);
  const std::string before = live.scenario().hash();
  const std::vector<Json> wrong = {{{"controller", "fuzy"}},
                                   {{"arena", "box"}},
                                   {{"swarm", 3}, {"model", "basic"}},
                                   {{"estimator", "image"}},
                                   {{"controller", {{"type", "manual"}, {"field", {"1 T", "0 T"}}}}},
                                   {{"model", {{"type", "dipole"}, {"moment", "1e-13 A m^2"}}}},
                                   Json::array({1}),
                                   "stop"};
  for (const Json& j : wrong) {
    INFO(j.dump());
    CHECK_THROWS_AS(live.exchange(j), const Error&);
    CHECK(live.scenario().hash() == before);
    CHECK(live.recorded().events.empty());
  }
}

TEST_CASE("an interrupted run with events is resumed with bit-identical results") {
  const Parts parts = builtin_parts();
  const std::string text =
      std::string(kScene) +
      "[[event]]\nframe = 6\ncontroller = { type = 'manual', field = ['0.2 mT', '0 T'] }\n"
      "[[event]]\nframe = 12\nmodel = 'basic'\n"
      "[[event]]\nframe = 18\ncontroller = 'fuzzy'\n";
  Document d = parse_toml(text, "test");
  d.root["duration"] = "2 s";
  d.root["seed"] = 1;
  const Scenario s = read_scenario(d, parts);
  const std::string uninterrupted = hash_of(s, 1);
  for (const std::uint64_t at : {6U, 12U, 15U}) {
    test::TemporaryFolder folder("live");
    RunOptions o;
    o.out = folder.path() / "run";
    std::atomic<bool> stop = false;
    o.stop = &stop;
    o.progress = [&](std::uint64_t done, std::uint64_t) { stop = done == at; };
    {
      Session first = Session::begin(s, 1, o);
      REQUIRE_FALSE(first.run());
    }
    o.progress = {};
    stop = false;
    Session second = Session::resume(parts, o);
    REQUIRE(second.run());
    CHECK(second.manifest().simulated->state_hash == uninterrupted);
  }
}
