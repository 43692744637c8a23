// Links that lead out of the workspace, also those that another process makes while a request is served: S6
// of RELIABILITY.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/error.h"
#include "core/toml.h"
#include "server/api/api.h"
#include "server/experiments/imports.h"
#include "server/files/opened_path.h"
#include "tests/server/served_lab.h"
#include "vision/files/video_writer.h"

using namespace faba;
using test::Served;
using test::status_of;
namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

const std::string kSecret = "confidential content";
const std::string kPicture = "P5\n2 2\n255\nabcd";

// A uniform video of two frames.
void record(const fs::path& path, std::uint8_t grey) {
  VideoWriter writer(path.string() + ".part", VideoFormat::lossless_avi, 32, 32, 10, 0, VideoPixels::grey8);
  for (int k = 0; k < 2; ++k) writer.write(Gray8(32, 32, grey));
  writer.finish(path);
}

/// A run whose files are those of `from`, or links to them.
void add_run(const fs::path& dir, std::uint8_t grey) {
  fs::create_directories(dir);
  write_file(dir / "manifest.json",
             R"({"version":"0.1.0","title":"One","complete":true,"video_shows":"camera","um_per_px":1})");
  write_file(dir / "scenario.toml", "title = 'One'\n[[swarm]]\ncount = 1\n");
  write_file(dir / "series.csv", kSecret);
  record(dir / "video.avi", grey);
}

using Pause = std::chrono::microseconds;

/// Exchanges a folder and a link to a folder outside, again and again, until the end of its life. The pauses
/// between are 1, 2, 4 ... times the shortest one, up to the longest, and again: also an act that takes
/// nearly as long as the longest has time between two exchanges.
class Exchange {
 public:
  Exchange(const fs::path& folder, const fs::path& outside, Pause shortest = {}, Pause longest = {})
      : folder_(folder), link_(folder.string() + "-link") {
    fs::create_directory_symlink(outside, link_);
    thread_ = std::thread([this, shortest, longest] {
      Pause pause = shortest;
      while (!end_) {
        if (::renameat2(AT_FDCWD, folder_.c_str(), AT_FDCWD, link_.c_str(), RENAME_EXCHANGE) != 0)
          ++failures_;
        ++exchanges_;
        std::this_thread::sleep_for(pause);
        pause = pause < longest ? 2 * pause : shortest;
      }
    });
  }
  ~Exchange() {
    end_ = true;
    thread_.join();
    CHECK(failures_ == 0);
    CHECK(exchanges_ > 0);
    if (fs::is_symlink(folder_))
      ::renameat2(AT_FDCWD, folder_.c_str(), AT_FDCWD, link_.c_str(), RENAME_EXCHANGE);
    fs::remove(link_);
  }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

 private:
  fs::path folder_, link_;
  std::atomic<bool> end_ = false;
  std::atomic<int> failures_ = 0, exchanges_ = 0;
  std::thread thread_;
};

/// The answer to a request, without a server.
struct Requests {
  Workspace workspace;
  JobList jobs{FABA_PROGRAM, workspace.root(), [] {}};
  fs::path pictures = workspace.root() / "pictures-of-the-lab";
  Api api{workspace, jobs, pictures, {}, [](const Json&) {}};

  explicit Requests(const fs::path& root, const std::vector<fs::path>& allowed = {})
      : workspace(root, root / "scenes", allowed) {
    fs::create_directories(pictures);
  }
  WebResponse get(const std::string& path, std::map<std::string, std::string> query = {}) {
    return api.answer({.method = "GET", .path = path, .query = std::move(query), .body = {}, .upload = {}});
  }
  WebResponse post(const std::string& path, const Json& body) {
    return api.answer({.method = "POST", .path = path, .query = {}, .body = body.dump(), .upload = {}});
  }
};

struct Folders {
  test::TemporaryFolder all{"links"};
  fs::path root = fs::canonical(all.path()) / "lab", outside = fs::canonical(all.path()) / "outside";
  Folders() {
    fs::create_directories(root / "runs");
    fs::create_directories(outside);
  }
};

}  // namespace

TEST_CASE("a path with a link is not opened; an opened file stays the same file") {
  const Folders f;
  fs::create_directories(f.root / "a/b");
  write_file(f.root / "a/b/file", "inside");
  write_file(f.outside / "file", kSecret);
  const OpenedPath file(f.root / "a/b/file"), folder(f.root / "a/b/");
  CHECK(file.is_regular_file());
  CHECK(folder.is_directory());
  fs::rename(f.root / "a/b", f.root / "a/moved");
  fs::create_directory_symlink(f.outside, f.root / "a/b");
  CHECK(read_file(file.path()) == "inside");
  CHECK(read_file(folder.path() / "file") == "inside");
  write_file(folder.path() / "new", "x");
  CHECK(fs::exists(f.root / "a/moved/new"));
  CHECK_FALSE(fs::exists(f.outside / "new"));
  CHECK_THROWS_WITH_AS(OpenedPath(f.root / "a/b/file"), doctest::Contains("replaced by a link"),
                       const Error&);
  CHECK_THROWS_WITH_AS(OpenedPath(f.root / "a/b"), doctest::Contains("replaced by a link"), const Error&);
  CHECK_THROWS_WITH_AS(OpenedPath(f.root / "a/none"), doctest::Contains("not found"), const Error&);
}

TEST_CASE("files of a run that are links to places outside are not read") {
  const Folders f;
  add_run(f.outside / "run", 200);
  for (const char* name : {"manifest.json", "scenario.toml", "series.csv", "video.avi"}) {
    const fs::path run = f.root / "runs" / (std::string("with-") + name);
    add_run(run, 20);
    fs::remove(run / name);
    fs::create_symlink(f.outside / "run" / name, run / name);
  }
  Requests lab(f.root);
  for (const char* name : {"manifest.json", "scenario.toml", "series.csv", "video.avi"})
    for (const char* request : {"about", "scenario", "frames", "picture.png", "size"}) {
      const WebResponse r = lab.get("/api/runs/with-" + std::string(name) + "/" + request);
      INFO(name, " ", request, " ", r.body);
      CHECK(r.status == 422);
      CHECK(r.body.find("is a link to a place outside") != std::string::npos);
    }
  CHECK(lab.get("/api/videos/frame", {{"file", "runs/with-video.avi"}}).status == 422);
  CHECK(lab.get("/api/videos/about", {{"file", "runs/with-manifest.json"}}).status == 422);
  CHECK(Json::parse(lab.get("/api/runs").body).empty());
  // A job would read them too.
  const WebResponse job =
      lab.post("/api/jobs", {{"kind", "flow"}, {"values", {{"video", "runs/with-video.avi"}}}});
  CHECK(job.status == 422);
  // In a folder that the user allows, they are files like others.
  Requests allowed(f.root, {f.outside});
  CHECK(allowed.get("/api/videos/about", {{"file", "runs/with-video.avi"}}).status == 200);
}

TEST_CASE("nothing is written through links of a workspace") {
  const Folders f;
  Requests lab(f.root);
  REQUIRE(lab.post("/api/experiments", {{"title", "x"}}).status == 200);
  const fs::path experiment = f.root / "experiments/x";
  const auto import = [&](const std::string& name) {
    return lab.api.answer({.method = "POST",
                           .path = "/api/experiments/x/imports",
                           .query = {{"name", name}, {"size", std::to_string(kPicture.size())}},
                           .body = kPicture,
                           .upload = {}});
  };
  const auto change = [&] {
    return lab.post("/api/experiments/x",
                    {{"changes", Json::array({{{"path", Json::array({"note"})}, {"to", "n"}}})}});
  };
  // The temporary file of a write, as a link and as a second name of a file.
  write_file(f.outside / "file", kSecret);
  fs::create_symlink(f.outside / "file", experiment / "experiment.toml.tmp");
  CHECK(change().status == 422);  // the experiment has a link to outside
  fs::remove(experiment / "experiment.toml.tmp");
  fs::create_hard_link(f.outside / "file", experiment / "experiment.toml.tmp");
  CHECK(change().status == 200);
  CHECK(read_file(f.outside / "file") == kSecret);
  write_file(f.root / "there", "old");
  fs::create_symlink(f.outside / "file", f.root / "there.tmp");
  write_file(f.root / "there", "new");
  CHECK(read_file(f.root / "there") == "new");
  CHECK(read_file(f.outside / "file") == kSecret);
  // An incomplete upload.
  const std::string part = fmt::format(".{}-b.pgm.part", kPicture.size());
  write_file(f.outside / "empty", "");
  fs::create_hard_link(f.outside / "empty", experiment / "videos" / part);
  CHECK(import("b.pgm").status == 422);
  CHECK(fs::file_size(f.outside / "empty") == 0);
  // The folders of videos and results.
  fs::rename(experiment / "videos", f.root / "moved");
  fs::create_directory_symlink(f.outside, experiment / "videos");
  CHECK(import("c.pgm").status == 422);
  fs::remove(experiment / "videos");
  fs::create_directory_symlink(f.outside, experiment / "results");
  record(f.root / "a.avi", 20);
  const Json job = {{"kind", "flow"}, {"values", {{"video", "a.avi"}}}, {"experiment", "x"}};
  CHECK(lab.post("/api/jobs", job).status == 422);
  fs::remove(experiment / "results");
  fs::rename(f.root / "runs", f.root / "runs-moved");
  fs::create_directory_symlink(f.outside, f.root / "runs");
  CHECK(lab.post("/api/jobs", {{"kind", "flow"}, {"values", {{"video", "a.avi"}}}}).status == 422);
  for (const auto& e : fs::directory_iterator(f.outside))
    CHECK((e.path().filename() == "file" || e.path().filename() == "empty"));
}

TEST_CASE("a folder that is replaced by a link during a request does not lead out of the workspace") {
  const Folders f;
  add_run(f.root / "runs/one", 20);
  add_run(f.outside / "one", 200);
  write_file(f.outside / "one/series.csv", kSecret + " of another user");
  constexpr int kTries = 1500;
  const Exchange exchange(f.root / "runs/one", f.outside / "one");
  Requests lab(f.root);
  int read = 0;
  for (int k = 0; k < kTries; ++k) {
    const WebResponse file = lab.get("/api/runs/one/series.csv");
    if (file.status != 200) continue;
    ++read;
    std::string content;
    try {
      content = read_file(OpenedPath(file.file).path());
    } catch (const Error&) {
      continue;  // the server answers 404
    }
    REQUIRE(content == kSecret);
  }
  INFO(read, " of ", kTries, " requests were answered");
  CHECK(read > 0);
  for (int k = 0; k < kTries / 10; ++k) {
    const WebResponse frame = lab.get("/api/videos/frames", {{"file", "runs/one/video.avi"}});
    if (frame.status == 200) REQUIRE(std::uint8_t(frame.body.back()) < 100);
    const WebResponse run = lab.get("/api/videos/frames", {{"file", "runs/one"}});
    if (run.status == 200) REQUIRE(std::uint8_t(run.body.back()) < 100);
  }
}

TEST_CASE("an import and a change write into the experiment, whatever replaces its folders") {
  const Folders f;
  const Workspace workspace(f.root, {});
  ExperimentStore store(workspace, [](const std::string&) {});
  Imports imports(store);
  store.create("x");
  fs::create_directories(f.outside / "x/videos");
  write_file(f.outside / "x/experiment.toml", "title = 'another'\n");
  int imported = 0, changed = 0;
  const auto try_to = [](int& done, const auto& act) {
    try {
      act();
      ++done;
    } catch (const std::exception&) {
      return;  // the link was there
    }
  };
  {
    // A slow exchange, because a request checks a path several times.
    const Exchange exchange(f.root / "experiments/x", f.outside / "x", 1ms, 64ms);
    const auto latest = std::chrono::steady_clock::now() + 60s;
    for (int k = 0; k < 180 || ((imported == 0 || changed == 0) && std::chrono::steady_clock::now() < latest);
         ++k) {
      try_to(imported, [&] {
        imports.take("x", {.name = fmt::format("a{}.pgm", k), .size = 2 * kPicture.size()}, kPicture);
      });
      try_to(changed, [&] {
        store.change("x",
                     {{"changes", Json::array({{{"path", Json::array({"note"})},
                                                {"from", store.read("x")["experiment"].value("note", Json())},
                                                {"to", std::to_string(k)}}})}});
      });
    }
  }
  CHECK(imported > 0);
  CHECK(changed > 0);
  CHECK(fs::is_empty(f.outside / "x/videos"));
  CHECK(read_file(f.outside / "x/experiment.toml") == "title = 'another'\n");
}

TEST_CASE("the server delivers the file that it checked") {
  const Served lab;
  const fs::path root = fs::canonical(lab.folder());
  fs::create_directories(root / "runs/one");
  write_file(root / "runs/one/series.csv", "frame\n");
  test::TemporaryFolder other("elsewhere");
  write_file(other.path() / "series.csv", "of another user");
  int read = 0;
  {
    const Exchange exchange(root / "runs/one", fs::canonical(other.path()));
    for (int k = 0; k < 300; ++k) {
      const std::string a = lab.get("/api/runs/one/series.csv");
      REQUIRE(a.find("another") == std::string::npos);
      const std::string part = lab.ask("GET /api/runs/one/series.csv", lab.own() + "Range: bytes=0-3\r\n");
      REQUIRE(part.find("of a") == std::string::npos);
      read += status_of(a) == 200;
    }
  }
  CHECK(read > 0);
  // A FIFO does not block the server.
  CHECK(::mkfifo((root / "runs/one/pipe.csv").c_str(), 0600) == 0);
  CHECK(status_of(lab.get("/api/runs/one/pipe.csv")) == 404);
}
