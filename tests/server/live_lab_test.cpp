#include "server/live_lab.h"

#include <doctest/doctest.h>

#include <future>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "server/workspace.h"
#include "tests/temporary_folder.h"

using namespace faba;
using namespace std::chrono_literals;

namespace {

const char* kScene =
    "[arena]\ntype = 'drop'\nradius_px = 200\n[[swarm]]\ncount = 60\nstart = { type = 'disc', radius_px = 40 "
    "}\n";

/// Sends a request and waits for the answer.
template <class Ask>
Json answer(Ask ask) {
  std::promise<Json> given;
  auto f = given.get_future();
  ask([&](Json j) { given.set_value(std::move(j)); });
  REQUIRE(f.wait_for(30s) == std::future_status::ready);
  return f.get();
}

/// A page that stores all messages and frames.
class Page {
 public:
  LiveLab::Listener listener() {
    return {[this](const std::shared_ptr<const std::string>& b) { take([&] { frames_.push_back(b); }); },
            [this](const Json& j) { take([&] { news_.push_back(j); }); }};
  }
  /// Waits for a message of this kind for which `right` is true.
  Json news(
      const std::string& say,
      const std::function<bool(const Json&)>& right = [](const Json&) { return true; }) {
    Json found;
    wait([&] {
      for (const Json& j : news_)
        if (j["say"] == say && right(j)) {
          found = j;
          return true;
        }
      return false;
    });
    return found;
  }
  std::shared_ptr<const std::string> frame(std::size_t number) {
    wait([&] { return frames_.size() > number; });
    const std::lock_guard lock(mutex_);
    return frames_[number];
  }

 private:
  template <class F>
  void take(F f) {
    {
      const std::lock_guard lock(mutex_);
      f();
    }
    changed_.notify_all();
  }
  template <class F>
  void wait(F there) {
    std::unique_lock lock(mutex_);
    REQUIRE(changed_.wait_for(lock, 30s, there));
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<const std::string>> frames_;
  std::vector<Json> news_;
};

}  // namespace

TEST_CASE("every resolved scene of the gallery can be started by the page") {
  const Workspace workspace(std::filesystem::path(FABA_SCENES).parent_path(), {});
  const std::vector<std::filesystem::path> scenes = workspace.scenes();
  REQUIRE(scenes.size() >= 18);
  LiveLab lab(1);
  for (const std::filesystem::path& scene : scenes) {
    INFO(scene.filename().string());
    const Json resolved = read_scenario(read_toml(scene), builtin_parts()).resolved();
    CHECK_NOTHROW(workspace.check_files(resolved));
    const Json a = answer([&](auto done) { lab.start(workspace.page_document(resolved), 1, done); });
    CHECK_MESSAGE(a.value("ok", true), a.dump());
  }
}

TEST_CASE("a run is started, displayed, steered, paused, stepped and recorded with the same state hash") {
  Page page;
  LiveLab lab(2);
  lab.watch(1, page.listener());
  CHECK(page.news("state")["running"] == false);
  CHECK(answer([&](auto done) { lab.pause(true, done); })["ok"] == false);  // no run yet
  const Json started = answer([&](auto done) { lab.start(parse_toml(kScene, "test"), 9, done); });
  CHECK(started["ok"] == true);
  CHECK(started["seed"] == 9);
  const Json run = page.news("run");
  CHECK(run["populations"][0]["end"] == 60);
  CHECK(run["outline"]["radius_px"] == 200);
  CHECK(run["columns"][0] == "frame");
  CHECK(page.frame(2)->substr(0, 4) == "FABA");

  CHECK(answer([&](auto done) { lab.speed(8, done); })["ok"] == true);
  const Json steered = answer([&](auto done) {
    lab.exchange({{"controller", {{"type", "manual"}, {"field", {"0.3 mT", "0 T"}}}}}, done);
  });
  CHECK(steered["ok"] == true);
  CHECK(page.news("parts", [](const Json& j) {
    return j["events"] == 1;
  })["scenario"]["controller"]["type"] == "manual");
  const Json wrong = answer([&](auto done) { lab.exchange({{"controller", "fuzy"}}, done); });
  CHECK(wrong["ok"] == false);
  CHECK(wrong["where"] == "controller.type");
  CHECK(wrong["what"].get<std::string>().find("fuzzy") != std::string::npos);

  const Json at = answer([&](auto done) { lab.pause(true, done); });
  const std::uint64_t frame = at["frame"];
  answer([&](auto done) { lab.step(5, done); });
  page.news("state", [&](const Json& j) { return j["running"] == false && j["frame"] == frame + 5; });

  std::optional<Scenario> recorded;
  std::string hash;
  const Json taken = answer([&](auto done) {
    lab.recorded(
        [&](const Scenario& s, const std::string& h) {
          recorded = s;
          hash = h;
          return Json{{"name", "run"}};
        },
        done);
  });
  CHECK(taken["ok"] == true);
  CHECK(taken["name"] == "run");
  REQUIRE(recorded);
  CHECK(recorded->frames() == frame + 5);
  test::TemporaryFolder folder("live-lab");
  RunOptions o;
  o.out = folder.path() / "run";
  Session session = Session::begin(*recorded, *recorded->params.seed, o);
  REQUIRE(session.run());
  CHECK(session.manifest().simulated->state_hash == hash);

  CHECK(answer([&](auto done) { lab.restart(done); })["seed"] == 9);
  page.news("run", [](const Json& j) { return j["run"] == 2; });
}

TEST_CASE("an invalid scenario does not stop the running one") {
  Page page;
  LiveLab lab(1);
  lab.watch(1, page.listener());
  answer([&](auto done) { lab.start(parse_toml(kScene, "test"), 1, done); });
  page.frame(0);
  const Json bad =
      answer([&](auto done) { lab.start(parse_toml("[arena]\nradius_px = 3\n", "test"), 1, done); });
  CHECK(bad["ok"] == false);
  CHECK(answer([&](auto done) { lab.pause(true, done); })["ok"] == true);
}

TEST_CASE("a page that connects to a run receives its rows since the start, and the coils") {
  Page first, second;
  LiveLab lab(1);
  lab.watch(1, first.listener());
  answer([&](auto done) { lab.start(parse_toml(kScene, "test"), 9, done); });
  const Json run = first.news("run");
  REQUIRE(run["coils"].is_array());
  for (const Json& coil : run["coils"]) CHECK(coil["max_a"] > 0);
  first.frame(3);
  answer([&](auto done) { lab.pause(true, done); });

  lab.watch(2, second.listener());
  const Json history = second.news("history");
  CHECK(history["run"] == run["run"]);
  REQUIRE(history["rows"].size() >= 4);
  CHECK(history["rows"][0].size() == run["columns"].size());
  for (std::size_t k = 0; k < history["rows"].size(); ++k) CHECK(history["rows"][k][0] == k);
}
