#include "server/experiments/experiment_store.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

struct Lab {
  test::TemporaryFolder folder{"experiments"};
  Workspace workspace{folder.path(), {}, {}};
  int changes = 0;
  ExperimentStore store{workspace, [this](const std::string&) { ++changes; }};

  Json change(const std::string& name, std::vector<std::string> path, const Json& from, const Json& to) {
    return store.change(name, {{"changes", Json::array({{{"path", path}, {"from", from}, {"to", to}}})}});
  }
};

}  // namespace

TEST_CASE("an experiment is created, changed and listed") {
  Lab lab;
  CHECK(lab.store.create("Ageing drops: 1/2") == "ageing-drops-1-2");
  CHECK(lab.store.create("Ageing drops: 1/2") == "ageing-drops-1-2-2");
  CHECK_THROWS_WITH_AS(lab.store.create("../.."), doctest::Contains("at least one letter"), const Error&);
  const Json one = lab.change("ageing-drops-1-2", {"drop", "A"}, nullptr, {{"polarity", "south"}});
  CHECK(one["experiment"]["drop"][0] == Json{{"polarity", "south"}, {"name", "A"}});
  CHECK(lab.changes == 1);
  CHECK(lab.store.read("ageing-drops-1-2")["revision"] == one["revision"]);
  // Times of files have the resolution of the clock of the kernel.
  fs::last_write_time(lab.folder.path() / "experiments/ageing-drops-1-2-2/experiment.toml",
                      fs::file_time_type::clock::now() - std::chrono::seconds(5));
  const Json list = lab.store.list();
  REQUIRE(list.size() == 2);
  CHECK(list[0]["name"] == "ageing-drops-1-2");  // changed last
  CHECK(list[0]["drops"] == 1);
}

TEST_CASE("changes of two pages are merged, or refused without a loss") {
  Lab lab;
  lab.store.create("x");
  lab.change("x", {"video", "videos/a.mp4"}, nullptr, {{"exposure", "1 min"}});
  // Other values of the same video, and another item.
  CHECK(!lab.change("x", {"video", "videos/a.mp4", "reversal"}, nullptr, "4 s").contains("conflicts"));
  CHECK(!lab.change("x", {"title"}, "x", "y").contains("conflicts"));
  // The page has not seen the present value.
  const Json refused = lab.change("x", {"video", "videos/a.mp4", "exposure"}, "2 min", "3 min");
  REQUIRE(refused["conflicts"].size() == 1);
  CHECK(refused["conflicts"][0]["now"] == "1 min");
  CHECK(lab.store.read("x")["experiment"]["video"][0]["exposure"] == "1 min");
  // Both pages made the same change.
  CHECK(!lab.change("x", {"video", "videos/a.mp4", "exposure"}, "2 min", "1 min").contains("conflicts"));
  // A video that another page has removed.
  lab.change("x", {"video", "videos/a.mp4"}, lab.store.read("x")["experiment"]["video"][0], nullptr);
  CHECK(lab.change("x", {"video", "videos/a.mp4", "exposure"}, "1 min", "3 min").contains("conflicts"));
  CHECK(lab.store.read("x")["experiment"].value("video", Json::array()).empty());
}

TEST_CASE("all changes of a request are made, or none") {
  Lab lab;
  lab.store.create("x");
  const Json answer = lab.store.change(
      "x", {{"changes", Json::array({{{"path", {"title"}}, {"from", "x"}, {"to", "y"}},
                                     {{"path", {"note"}}, {"from", "old"}, {"to", "new"}}})}});
  CHECK(answer["conflicts"].size() == 1);
  CHECK(answer["experiment"]["title"] == "x");
}

TEST_CASE("invalid changes are refused, and the file does not change") {
  Lab lab;
  lab.store.create("x");
  const std::string before = read_file(lab.folder.path() / "experiments/x/experiment.toml");
  const auto fails = [&](std::vector<std::string> path, const Json& to, const char* what) {
    CHECK_THROWS_WITH_AS(lab.change("x", std::move(path), nullptr, to), doctest::Contains(what),
                         const Error&);
  };
  fails({"video", "videos/a.mp4"}, {{"exposure", "2 bananas"}}, "unit");
  fails({"colour"}, "red", "colour");
  fails({"video"}, Json::array(), "is not the path");
  fails({"title", "a"}, "b", "is not the path");
  fails({"video", "a", "b", "c"}, "b", "is not the path");
  fails({}, "b", "is not the path");
  fails({"video", "../../../etc/passwd"}, Json::object(), "--allow");
  fails({"video", "/etc/passwd"}, Json::object(), "--allow");
  fails({"video", "../../.ssh/id"}, Json::object(), "--allow");
  CHECK_THROWS_AS(lab.store.change("x", {{"changes", 3}}), const Error&);
  CHECK_THROWS_AS(lab.store.change("x", Json::object()), const Error&);
  CHECK(read_file(lab.folder.path() / "experiments/x/experiment.toml") == before);
  for (const char* bad : {"", "..", "../x", "x/..", ".x", "y", "x/experiment.toml"})
    CHECK_THROWS_AS(lab.store.read(bad), const Error&);
}

TEST_CASE("S6: an experiment folder that is a link to another place is refused") {
  Lab lab;
  test::TemporaryFolder other("elsewhere");
  write_file(other.path() / "experiment.toml", "title = \"secret\"\n");
  fs::create_directories(lab.folder.path() / "experiments");
  fs::create_symlink(other.path(), lab.folder.path() / "experiments/link");
  CHECK_THROWS_AS(lab.store.read("link"), const Error&);
}

TEST_CASE("names of files are safe") {
  CHECK(safe_name("a b/c\\d.mp4") == "a-b-c-d.mp4");
  CHECK(safe_name("-rf.mp4") == "rf.mp4");
  CHECK(safe_name("..") == "");
  CHECK(safe_name(".hidden") == "hidden");
  CHECK(safe_name("<img src=x onerror=alert(1)>.mp4") == "img-src-x-onerror-alert-1-.mp4");
  CHECK(safe_name("gota-ção.avi") == "gota-ção.avi");
  CHECK(safe_name(std::string(300, 'a')).size() == 80);
  CHECK(safe_name(std::string("a\n\0b", 4)) == "a-b");
  CHECK(safe_name("a\xff.avi") == "a-.avi");  // not UTF-8
  // Invisible characters and those that change the direction of text.
  CHECK(safe_name("a\u202Eiva.exe.avi") == "a-iva.exe.avi");
  CHECK(safe_name("a\u200B\u2066\uFEFF\u061C\u0085b.avi") == "a-b.avi");
  CHECK(safe_name("\u05D0\u0628\u6F22.avi") == "\u05D0\u0628\u6F22.avi");
}
