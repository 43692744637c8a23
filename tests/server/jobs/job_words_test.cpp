#include "server/jobs/job_words.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

/// A workspace with files of difficult names.
struct Files {
  test::TemporaryFolder folder{"job-words"};
  Files() {
    for (const char* name :
         {"a.mp4", "b c.mp4", "-o", "--out=x", "quote'\".mp4", "line\nbreak.mp4", "rig.toml"})
      write_file(folder.path() / name, "");
    fs::create_directories(folder.path() / "sub");
    write_file(folder.path() / "sub/d.mp4", "");
    write_file(folder.path() / ".hidden", "");
    fs::create_symlink("/etc/passwd", folder.path() / "link.mp4");
  }
  Workspace workspace{folder.path(), {}};
  Words words(const char* kind, const Json& values) const {
    return job_words(job_kind(kind), values, workspace, "runs/x");
  }
  /// The error of values, as "place: reason".
  std::string error(const char* kind, const Json& values) const {
    try {
      (void)words(kind, values);
    } catch (const Error& e) {
      CHECK(e.code() == Errc::usage);
      return e.what();
    }
    FAIL("accepted: " << values.dump());
    return "";
  }
};

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE(
    "the words of a command: files, values in the unit of the option, outputs in the folder of the job") {
  const Files f;
  CHECK(f.words("activity", {{"videos", {"a.mp4", "sub/d.mp4"}}, {"reversal", "1500 ms"}, {"from", 0.25}}) ==
        Words{"activity", "./a.mp4", "./sub/d.mp4", "--reversal=1.5", "--from=0.25",
              "--report=runs/x/report.html", "--out=runs/x/signature.csv", "--json"});
  CHECK(f.words("scale", {{"ruler", "a.mp4"}, {"tick", "0.01 mm"}})[2] == "--tick=10 um");
  CHECK(f.words(
            "field-map",
            {{"rig", "rig.toml"}, {"current", {"0.5 A", -250e-3, "10 mA"}}, {"size", {"6 mm", "4500 um"}}}) ==
        Words{"field", "map", "./rig.toml", "--current=0.5,-0.25,0.01", "--size=6 mm, 4.5 mm",
              "--picture=runs/x/field.png", "--out=runs/x/field.h5", "--json"});
  CHECK(f.words("identify", {{"study", "rig.toml"}})[2] == "--out=runs/x/");
  CHECK(f.words("field-fit",
                {{"rig", "rig.toml"}, {"map", "a.mp4"}, {"columns", "z, b"}, {"units", "cm,G"}})[4] ==
        "--columns=z,b");
  CHECK(f.words("track", {{"video", "a.mp4"}, {"drop", true}, {"keep_drift", false}, {"polarity", "dark"}}) ==
        Words{"track", "./a.mp4", "--polarity=dark", "--drop", "--report=runs/x/report.html",
              "--out=runs/x/tracks.csv", "--per-track=runs/x/per_track.csv", "--picture=runs/x/tracks.png",
              "--json"});
}

TEST_CASE("a direction of a page counts counter-clockwise, that of a command clockwise") {
  const JobInput d{
      .key = "direction", .kind = JobInput::Kind::direction, .unit = "deg", .min = -360, .max = 360};
  CHECK(word_of(d, "0 deg") == "0");
  CHECK(word_of(d, "90 deg") == "270");  // up
  CHECK(word_of(d, 270) == "90");        // down
  CHECK(word_of(d, -90) == "90");
  CHECK(word_of(d, "360 deg") == "0");
  CHECK(word_of(d, "45") == "315");
}

TEST_CASE("empty values are no values") {
  const Files f;
  const Words least = f.words("activity", {{"videos", {"a.mp4"}}});
  CHECK(f.words("activity",
                {{"videos", {"a.mp4"}}, {"direction", ""}, {"noise", nullptr}, {"fps", Json::array()}}) ==
        least);
}

TEST_CASE("no value becomes an option") {
  const Files f;
  for (const char* name : {"-o", "--out=x", "b c.mp4", "quote'\".mp4", "line\nbreak.mp4"}) {
    INFO(name);
    const Words w = f.words("activity", {{"videos", {name}}, {"noise", name}});
    CHECK(w[1] == std::string("./") + name);
    CHECK(std::count(w.begin(), w.end(), std::string("--noise=./") + name) == 1);
  }
  for (const Json& bad :
       {Json("--out=/x"), Json("1 s --out=/x"), Json("-o"), Json("1\n2"), Json("$(x)"), Json("1;2")})
    CHECK(contains(f.error("activity", {{"videos", {"a.mp4"}}, {"from", bad}}), "from: "));
  for (const char* bad : {"--out=/x;", "a b;c", "'", "x\ny", "$(x)", "x=y"})
    CHECK(contains(f.error("field-fit", {{"rig", "rig.toml"}, {"map", "a.mp4"}, {"columns", bad}}),
                   "columns: "));
  CHECK(contains(f.error("track", {{"video", "a.mp4"}, {"polarity", "--out=x"}}),
                 "must be one of auto, dark, bright, both"));
}

TEST_CASE("files are inside the workspace") {
  const Files f;
  for (const char* name : {"/etc/passwd", "../a.mp4", "sub/../../x", "sub/..", "link.mp4", ".hidden",
                           "absent.mp4", "a.mp4/x", "~/x"}) {
    INFO(name);
    CHECK(f.error("flow", {{"video", name}}).starts_with("video: "));
  }
  CHECK(f.error("flow", {{"video", std::string("a.mp4\0b", 7)}}).starts_with("video: "));
  for (const Json& wrong : {Json(7), Json::object({{"a", 1}}), Json::array({"a.mp4"}), Json(true)})
    CHECK(contains(f.error("flow", {{"video", wrong}}), "is not a file name"));
}

TEST_CASE("a file of an allowed folder is named by its absolute path") {
  const Files f;
  const test::TemporaryFolder other("allowed");
  write_file(other.path() / "c.mp4", "");
  const Workspace w(f.folder.path(), {}, {other.path()});
  const std::string file = fs::canonical(other.path() / "c.mp4").string();
  const Words words =
      job_words(job_kind("activity"), {{"videos", {file, "a.mp4"}}, {"noise", file}}, w, "runs/x");
  CHECK(words[1] == file);
  CHECK(words[2] == "./a.mp4");
  CHECK(std::count(words.begin(), words.end(), "--noise=" + file) == 1);
}

TEST_CASE("messages have the input, the value, what is permitted and advice") {
  const Files f;
  const Json video = {{"videos", {"a.mp4"}}};
  const auto with = [&](const char* key, const Json& v) {
    Json all = video;
    all[key] = v;
    return f.error("activity", all);
  };
  CHECK(with("direction", "400 deg") ==
        "direction: 400 deg is out of range; it must be a number between -360 deg and 360 deg");
  CHECK(with("reversal", "3 um") ==
        "reversal: \"3 um\" has the wrong unit; it must be a number between 0 s and 1000000 s");
  CHECK(with("reversal", "soon") ==
        "reversal: \"soon\" is not a number; it must be a number between 0 s and 1000000 s");
  CHECK(with("fps", Json::object()) ==
        "fps: {} is not a number; it must be a number between 0.001 and 1000000");
  CHECK(with("fps", "nan") == "fps: \"nan\" is not a number; it must be a number between 0.001 and 1000000");
  CHECK(f.error("track", {{"video", "a.mp4"}, {"memory", 1.5}}) ==
        "memory: 1.5 is not an integer; it must be an integer between 0 and 1000");
  CHECK(f.error("activity", Json::object()) == "videos: missing; choose a file of the list");
  CHECK(contains(f.error("scale", {{"ruler", "a.mp4"}}),
                 "tick: missing; it must be a number between 0.01 um and 100000 um"));
  CHECK(contains(f.error("field-map", {{"rig", "rig.toml"}, {"current", "0.5"}}),
                 "current: 0.5 is not a list of 1 to 64 numbers in A"));
  CHECK(contains(f.error("field-null", {{"rig", "rig.toml"}, {"at", {1, 2, 3}}}),
                 "is not a list of 2 numbers in mm"));
  CHECK(contains(with("out", "/x"), "out: is not a value of activity; it must be one of videos, direction"));
  CHECK(contains(f.error("track", {{"video", "a.mp4"}, {"drop", "yes"}}), "must be true or false"));
  CHECK_THROWS_WITH_AS(job_kind("rm"),
                       doctest::Contains("\"rm\" is not a kind of job; it must be one of activity"), Error);
}

TEST_CASE("a job starts only with a command that the lab makes, and with files that it may read") {
  const Files f;
  const auto job = [&](const Words& words) {
    return Job{.title = "j", .words = words, .out = "runs/x", .kind = "activity"};
  };
  const auto error = [&](const Job& j) {
    try {
      check_job(j, f.workspace);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const Words made =
      f.words("activity", {{"videos", {"b c.mp4", "-o"}}, {"direction", 10}, {"noise", "a.mp4"}});
  CHECK(error(job(made)) == "");
  for (const char* word : {"--engine=slurm", "--engine", "slurm", "--out=/tmp/x", "--report=../x.html",
                           "b.mp4", "--noise=a.mp4", "-o", "--json=x", "--", "--noise"}) {
    Words more = made;
    more.push_back(word);
    INFO(word);
    CHECK(contains(error(job(more)), "its command was changed outside of the lab"));
  }
  for (const char* word :
       {"./link.mp4", "/etc/passwd", "./../x", "--noise=./link.mp4", "--noise=/etc/passwd"}) {
    Words more = made;
    more.push_back(word);
    INFO(word);
    CHECK_FALSE(error(job(more)).empty());
  }
  CHECK(contains(error(job({"run", "./a.mp4"})), "its command was changed"));
  CHECK(contains(error(job({})), "its command was changed"));
  // Recordings have no kind.
  const Job run{.title = "r", .words = {"run", "./link.mp4", "--out", "runs/x"}, .out = "runs/x"};
  CHECK(contains(error(run), "outside"));
  Job elsewhere = job(made);
  elsewhere.out = "../x";
  CHECK(contains(error(elsewhere), "outside"));
}

TEST_CASE("files of an allowed folder are named by their path; an experiment has no others") {
  test::TemporaryFolder folder("job-allowed");
  const fs::path all = fs::canonical(folder.path()), root = all / "lab";
  for (const fs::path& dir : {root / "experiments/x", all / "data", all / "other"})
    fs::create_directories(dir);
  for (const fs::path& file : {all / "data/a.mp4", all / "other/a.mp4"}) write_file(file, "");
  const Workspace w(root, {}, {all / "data"});
  const std::string video = (all / "data/a.mp4").string();
  const Words words = job_words(job_kind("flow"), {{"video", video}}, w, "runs/x");
  CHECK(words[1] == video);
  CHECK_NOTHROW(check_job({.words = words, .out = "runs/x", .kind = "flow"}, w));
  const auto experiment = [&](const fs::path& file) {
    write_file(root / "experiments/x/experiment.toml",
               "title = 'x'\n[[video]]\nfile = '" + file.string() + "'\n");
    return job_words(job_kind("activity-exposure"), {{"experiment", "experiments/x"}}, w, "runs/x");
  };
  CHECK_NOTHROW((void)experiment(all / "data/a.mp4"));
  for (const fs::path& bad : {all / "other/a.mp4", fs::path("../../../other/a.mp4"), fs::path("/etc/passwd")})
    CHECK_THROWS_WITH_AS((void)experiment(bad), doctest::Contains("--allow"), const Error&);
}

TEST_CASE("every kind has a schema with its inputs") {
  for (const JobKind& k : job_kinds()) {
    INFO(k.name);
    const Json j = job_kind_json(k);
    CHECK(j["schema"]["properties"].size() == k.inputs.size());
    CHECK_FALSE(j["schema"]["required"].empty());
    for (const auto& [key, p] : j["schema"]["properties"].items()) {
      INFO(key);
      CHECK_FALSE(p["description"].get<std::string>().empty());
      CHECK((p.contains("type")));
    }
    // A result page is one of the outputs, or in the folder of a study.
    const bool study =
        std::any_of(k.outputs.begin(), k.outputs.end(), [](const JobOutput& o) { return o.file.empty(); });
    const bool listed =
        std::any_of(k.outputs.begin(), k.outputs.end(), [&](const JobOutput& o) { return o.file == k.page; });
    CHECK((k.page.empty() || study || listed));
  }
}
