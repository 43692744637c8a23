// The lab of the demonstration, compiled for this machine: the page's messages, the pace, the state hash.
#include "demo/browser_lab.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "app/scenario/read_scenario.h"
#include "tests/golden/hashes.h"

using namespace faba;

namespace {

constexpr double kPeriod = 1 / 60.0;  // s, of the scene steer
constexpr double kBudget = 1;         // s

struct Page {
  std::vector<Json> news;
  std::size_t frames = 0;
  double now = 100;  // s
  BrowserLab lab{{[this](const std::string& text) { news.push_back(Json::parse(text)); },
                  [this](const std::string&) { ++frames; }, [this] { return now; }},
                 FABA_SCENES};

  Json ask(Json message) {
    message["id"] = 1;
    lab.receive(message.dump());
    return news.back();
  }
  Json newest(const std::string& say) const {
    for (auto n = news.rbegin(); n != news.rend(); ++n)
      if (n->value("say", "") == say) return *n;
    return {};
  }
  Json scene(const std::string& name) { return lab.answer("/api/scenes/" + name, "")["scenario"]; }
  void run_to_pause() {
    while (std::isfinite(lab.advance(kBudget))) now += kPeriod;
  }
};

}  // namespace

TEST_CASE("a run of the demonstration has the golden state hash after as many frames") {
  Page page;
  const Golden& golden = kGolden[4];
  REQUIRE(golden.scene == "steer");
  REQUIRE(page.ask({{"do", "start"}, {"scenario", page.scene("steer")}, {"seed", 1}})["ok"] == true);
  page.ask({{"do", "step"}, {"frames", golden.frames}});
  page.run_to_pause();
  const Json hash = page.newest("hash");
  CHECK(hash["frame"] == golden.frames);
  CHECK(hash["hash"] == golden.hash);
  CHECK(hash["end"] == false);
  CHECK(hash["changed"] == false);
  CHECK(page.frames > 0);
}

TEST_CASE("the run pauses at the end of the scenario; it can be resumed") {
  Page page;
  Json scenario = page.scene("steer");
  scenario["duration"] = "1 s";
  page.ask({{"do", "start"}, {"scenario", scenario}, {"seed", 1}});
  page.ask({{"do", "finish"}});
  page.run_to_pause();
  CHECK(page.newest("hash")["frame"] == 60);
  CHECK(page.newest("hash")["end"] == true);
  CHECK(page.newest("state")["running"] == false);
  page.ask({{"do", "go"}});
  CHECK(std::isfinite(page.lab.advance(kBudget)));
  page.ask({{"do", "pause"}});
  CHECK(page.newest("hash")["frame"] == 61);
  CHECK(page.newest("hash")["end"] == false);
}

TEST_CASE("frames are simulated when they are due, at the chosen speed") {
  Page page;
  page.ask({{"do", "start"}, {"scenario", page.scene("steer")}, {"seed", 1}});
  CHECK(page.lab.advance(kBudget) == doctest::Approx(kPeriod));  // the first frame is due at once
  page.ask({{"do", "speed"}, {"factor", 2}});
  CHECK(page.lab.advance(kBudget) == doctest::Approx(kPeriod / 2));
  page.now += 6.75 * kPeriod;  // 13 frames are due, the next one after a quarter of kPeriod
  CHECK(page.lab.advance(kBudget) == doctest::Approx(kPeriod / 4));
  page.ask({{"do", "pause"}});
  CHECK(page.newest("hash")["frame"] == 2 + 13);
}

TEST_CASE("a lag of more than a quarter of a second is not made up for") {
  Page page;
  page.ask({{"do", "start"}, {"scenario", page.scene("steer")}, {"seed", 1}});
  page.lab.advance(kBudget);
  page.now += 60;
  page.lab.advance(kBudget);
  page.ask({{"do", "pause"}});
  CHECK(page.newest("hash")["frame"] == 2);
}

TEST_CASE("an exchange marks the hash as changed; a restart repeats the scenario") {
  Page page;
  page.ask({{"do", "start"}, {"scenario", page.scene("steer")}, {"seed", 1}});
  page.ask({{"do", "step"}, {"frames", 20}});
  page.run_to_pause();
  const Json before = page.newest("hash");
  CHECK(page.ask({{"do", "exchange"},
                  {"event", {{"reference", {{"type", "hold"}, {"setpoint_px", {300, 200}}}}}}})["ok"] ==
        true);
  CHECK(page.newest("hash")["changed"] == true);
  CHECK(page.newest("parts")["setpoints"][0][0] == 300);
  page.ask({{"do", "restart"}});
  page.ask({{"do", "step"}, {"frames", 20}});
  page.run_to_pause();
  CHECK(page.newest("hash")["changed"] == false);
  CHECK(page.newest("hash")["hash"] == before["hash"]);
  CHECK(page.newest("run")["run"] == 2);
}

TEST_CASE("requests that fail have a place and a reason, and the run remains") {
  Page page;
  CHECK(page.ask({{"do", "pause"}})["what"] == "no run; start a scenario first");
  CHECK(page.ask({{"do", "finish"}})["ok"] == false);
  page.ask({{"do", "start"}, {"scenario", page.scene("steer")}, {"seed", 1}});
  Json wrong = page.scene("steer");
  wrong["swarm"][0]["count"] = -1;
  const Json refused = page.ask({{"do", "start"}, {"scenario", wrong}});
  CHECK(refused["ok"] == false);
  CHECK(refused["where"] == "swarm[0].count");
  CHECK(page.ask({{"do", "save"}, {"name", "a"}})["ok"] == false);
  CHECK(page.newest("run")["run"] == 1);
  CHECK(page.lab.answer("/api/runs", "")["ok"] == false);
  CHECK(page.lab.answer("/api/scenes/../../etc/passwd", "")["ok"] == false);
  CHECK(page.lab.answer("/api/check", "no JSON")["ok"] == false);
  const Json checked =
      page.lab.answer("/api/check", Json{{"toml", "[[swarm]]\ncount = 0\n"}, {"name", "a.toml"}}.dump());
  CHECK(checked["where"].get<std::string>().starts_with("a.toml:2"));
}

TEST_CASE("the gallery of the demonstration has all scenes, and the engine can read them") {
  Page page;
  const Json scenes = page.lab.answer("/api/scenes", "");
  CHECK(scenes.size() > 20);
  CHECK(scenes[0]["name"] == "steer");
  for (const Json& s : scenes) {
    INFO(s.dump());
    CHECK_FALSE(s.contains("error"));
  }
  CHECK(page.lab.answer("/api/schema", "").contains("properties"));
}
