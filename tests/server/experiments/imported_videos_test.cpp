// Removal of videos from experiments, as a page requests it.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/file.h"
#include "server/api/api.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

constexpr const char* kExperiment = R"(
title = "x"
[[drop]]
name = "A"
[[video]]
file = "videos/a.avi"
drop = "A"
exposure = "2 min"
[[video]]
file = "videos/b.avi"
drop = "A"
exposure = "5 min"
reversal = "4 s"
note = "late"
[[video]]
file = "../../films/c.avi"
)";

/// The experiment x with two imported videos and one of another folder.
struct Lab {
  test::TemporaryFolder folder{"imported"};
  fs::path root = made(folder.path());
  Workspace workspace{root, {}, {}};
  JobList jobs{"/bin/sleep", root, [] {}};
  int news = 0;
  Api api{workspace, jobs, folder.path() / "pictures", {}, [this](const Json&) { ++news; }};

  static fs::path made(const fs::path& folder) {
    const fs::path root = folder / "lab";
    fs::create_directories(root / "films");
    fs::create_directories(root / "experiments/x/videos");
    write_file(root / "experiments/x/experiment.toml", kExperiment);
    for (const char* file : {"experiments/x/videos/a.avi", "experiments/x/videos/b.avi", "films/c.avi"})
      write_file(root / file, std::string(1000, 'v'));
    return root;
  }
  Json ask(const std::string& method, const std::string& path, const std::string& file = "") {
    WebRequest r{.method = method, .path = path, .query = {}, .body = {}, .upload = {}};
    if (!file.empty()) r.query["file"] = file;
    if (method == "POST") r.body = "{}";
    const WebResponse a = api.answer(r);
    Json j = Json::parse(a.body);
    if (a.status != 200) j = {{"status", a.status}, {"what", j["what"]}};
    return j;
  }
  Json about(const std::string& file) { return ask("GET", "/api/experiments/x/videos", file); }
  Json remove(const std::string& file) { return ask("DELETE", "/api/experiments/x/videos", file); }
  Json videos() { return ask("GET", "/api/experiments/x")["experiment"]["video"]; }
  void another(const std::string& name, const std::string& toml) const {
    fs::create_directories(root / "experiments" / name);
    write_file(root / "experiments" / name / "experiment.toml", toml);
  }
};

bool has(const Json& refused, const char* part) {
  return refused.contains("what") && refused["what"].get<std::string>().find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an imported video is deleted with its entry, and one undo restores both with all values") {
  Lab lab;
  const Json before = lab.videos();
  CHECK(lab.about("videos/b.avi") ==
        Json{{"file", "videos/b.avi"}, {"imported", true}, {"bytes", 1000}, {"used_by", Json::array()}});
  const Json item = lab.remove("videos/b.avi");
  CHECK(item["name"] == "experiments/x/videos/b.avi");
  CHECK(item["bytes"] == 1000);
  CHECK(lab.news == 1);
  CHECK_FALSE(fs::exists(lab.root / "experiments/x/videos/b.avi"));
  CHECK(lab.videos() == Json::array({before[0], before[2]}));
  CHECK(lab.ask("GET", "/api/trash").size() == 1);

  const std::string undo = fmt::format("/api/trash/{}/undo", item["id"].get<int>());
  CHECK(lab.ask("POST", undo)["bytes"] == 1000);
  CHECK(fs::file_size(lab.root / "experiments/x/videos/b.avi") == 1000);
  CHECK(lab.videos() == before);
  CHECK(lab.news == 2);
  CHECK(lab.ask("POST", undo)["status"] == 404);
}

TEST_CASE("an undo after the drop was removed, or after the folder is gone") {
  Lab lab;
  const int id = lab.remove("videos/b.avi")["id"];
  const std::string undo = fmt::format("/api/trash/{}/undo", id);
  const fs::path file = lab.root / "experiments/x/experiment.toml";
  const std::string changed = read_file(file);
  fs::remove(file);
  CHECK(lab.ask("POST", undo)["status"] == 404);
  CHECK_FALSE(fs::exists(lab.root / "experiments/x/videos/b.avi"));
  CHECK(lab.ask("GET", "/api/trash").size() == 1);
  write_file(file, "[[video]]\nfile = \"videos/a.avi\"\n");
  CHECK(lab.ask("POST", undo)["id"] == id);
  REQUIRE(lab.videos().size() == 2);
  CHECK(lab.videos()[1]["exposure"] == "5 min");
  CHECK_FALSE(lab.videos()[1].contains("drop"));
}

TEST_CASE("a file that was not imported, or is used elsewhere, is not deleted") {
  Lab lab;
  const Json before = lab.videos();
  CHECK(lab.about("../../films/c.avi")["imported"] == false);
  CHECK(has(lab.remove("../../films/c.avi"), "is not in the folder videos/"));
  for (const char* other : {"videos/none.avi", "../../secret", "", "videos"})
    CHECK(lab.remove(other)["status"] == 404);

  lab.another("y", "[[video]]\nfile = \"../x/videos/a.avi\"\n");
  lab.another("invalid", "[[video]\n");
  CHECK(lab.about("videos/a.avi")["used_by"] == Json{"y"});
  CHECK(has(lab.remove("videos/a.avi"), "is used by the experiment y"));
  lab.another("y", "noise = \"../x/videos/a.avi\"\n");
  CHECK(has(lab.remove("videos/a.avi"), "is used by the experiment y"));

  fs::create_symlink(lab.root / "films/c.avi", lab.root / "experiments/x/videos/link.avi");
  write_file(
      lab.root / "experiments/x/experiment.toml",
      std::string("noise = \"videos/b.avi\"\n") + kExperiment + "[[video]]\nfile = \"videos/link.avi\"\n");
  CHECK(has(lab.remove("videos/b.avi"), "is used by the experiment x"));
  CHECK(has(lab.remove("videos/link.avi"), "is not in the folder videos/"));
  CHECK(lab.videos().size() == before.size() + 1);
  CHECK(lab.ask("GET", "/api/trash").empty());
}

TEST_CASE("no video is deleted while a job reads the experiment") {
  Lab lab;
  const int first = lab.jobs.add({.title = "first", .words = {"1000"}, .page = "a", .out = "b"});
  for (const char* word :
       {"./experiments/x/videos/a.avi", "./experiments/x", "--noise=./experiments/x/videos/b.avi"}) {
    const int job = lab.jobs.add({.title = "track: a", .words = {word}, .page = "a", .out = "b"});
    CHECK(has(lab.remove("videos/a.avi"), "the job \"track: a\" uses this experiment"));
    lab.jobs.cancel(job);
    while (!is_over(*lab.jobs.job(job))) usleep(10000);
  }
  CHECK(lab.remove("videos/a.avi")["bytes"] == 1000);
  lab.jobs.cancel(first);
}
