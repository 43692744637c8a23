// A limit on file sizes: a run is complete, or it ends with an error that names the file and is marked
// incomplete.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include "tests/e2e/incomplete_run.h"
#include "tests/e2e/playback_scene.h"

using namespace faba;

namespace {

// One call with files of at most `blocks` of 512 bytes, after `before`. The message comes through a pipe,
// because a file would have the same limit.
Called call_limited(const std::filesystem::path& folder, int blocks, const std::string& before,
                    const std::string& arguments) {
  const std::string command = "cd '" + folder.string() + "' && " + before + " && ulimit -f " +
                              std::to_string(blocks) + " && exec '" FABA_PROGRAM "' " + arguments + " 2>&1";
  Called c;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) c.err.append(buffer, n);
  const int status = pclose(pipe);
  c.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return c;
}

Called run_limited(const std::filesystem::path& folder, int blocks) {
  return call_limited(folder, blocks, "rm -rf run", "run s.toml --seed 1 --quiet --out run");
}

}  // namespace

TEST_CASE("file size limit: every recorder reports the file, and the run is marked incomplete") {
  struct Recorder {
    const char* record;  ///< keys of [record]
    const char* file;    ///< the file that an error must name for at least one limit
  };
  // Checkpoints in every frame, so that each recorder is flushed often.
  for (const Recorder& r :
       {Recorder{"video = false\ntracks = false", "run/series.csv"},
        Recorder{"video = false\ntracks = false", "run/report.html"},
        Recorder{"video = false", "run/tracks.h5"}, Recorder{"tracks = false", "run/video.mp4"},
        Recorder{"video = false\ntracks = false\nlossless = true", "run/video.avi"},
        Recorder{"video = false\ntracks = false\nflow = true", "run/flow.h5"}}) {
    const TestFolder f;
    write_file(f.path / "s.toml", kSmallScene + "[record]\ncheckpoint = '0.1 s'\n" + r.record + "\n");
    bool named = false;
    int failed = 0, complete = 0;
    for (const int blocks : {0, 1, 2, 4, 6, 8, 12, 20, 40, 80, 200, 400, 2000, 40000}) {
      const Called c = run_limited(f.path, blocks);
      INFO(r.record, ", ", blocks, " blocks");
      complete_or_marked(f.path / "run", c);
      named = named || c.err.find(r.file) != std::string::npos;
      (c.exit == 0 ? complete : failed) += 1;
    }
    INFO(r.file);
    CHECK(named);
    CHECK(failed > 2);
    CHECK(complete > 0);
  }
}

TEST_CASE("file size limit: a capture names the file, and is complete or not under its name") {
  const TestFolder f;
  write_playback_scene(f.path, 12);
  int failed = 0, complete = 0;
  for (const int blocks : {0, 1, 4, 6, 8, 12, 40, 200, 4000}) {
    INFO(blocks, " blocks");
    const Called video = call_limited(f.path, blocks, "rm -rf a.avi*",
                                      "rig capture bench.toml --frames 12 --quiet --out a.avi");
    const Called pictures =
        call_limited(f.path, blocks, "rm -rf pictures",
                     "rig capture bench.toml --frames 12 --quiet --format pgm --out pictures");
    for (const auto& [c, name] : {std::pair{&video, "a.avi"}, {&pictures, "pictures/"}}) {
      INFO(c->exit, ": ", c->err);
      (c->exit == 0 ? complete : failed) += 1;
      if (c->exit == 0) continue;
      CHECK(c->exit == 1);
      CHECK(one_clear_line(c->err));
      CHECK(c->err.find(name) != std::string::npos);
    }
    const auto folder = f.path / "pictures";
    CHECK(std::filesystem::exists(f.path / "a.avi") == (video.exit == 0));
    if (pictures.exit == 0) CHECK_FALSE(std::filesystem::exists(folder / "incomplete"));
    if (pictures.exit != 0)
      CHECK((std::filesystem::exists(folder / "incomplete") || std::filesystem::is_empty(folder)));
  }
  CHECK(failed > 5);
  CHECK(complete > 2);
}

TEST_CASE("manifest or checkpoint cannot be written: exit 1, the file is named, the run stays marked") {
  for (const std::string name : {"manifest.json", "checkpoint"}) {
    INFO(name);
    const TestFolder f;
    write_file(f.path / "s.toml", kSmallScene);
    // A folder takes the temporary name of the file; a run that replaces another keeps unknown files.
    std::filesystem::create_directories(f.path / "run" / (name + ".tmp") / "x");
    write_file(f.path / "run/incomplete",
               "faba process 1\nThis run is not complete. Resume it with: faba resume run\n");
    const Called c = faba_in(f.path, "run s.toml --seed 1 --force --quiet --out run");
    complete_or_marked(f.path / "run", c);
    CHECK(c.exit == 1);
    CHECK_MESSAGE(c.err.find("run/" + name + ": cannot be written") != std::string::npos, c.err);
    CHECK_FALSE(std::filesystem::exists(f.path / "run" / name));
    CHECK_FALSE(std::filesystem::exists(f.path / "run/report.html"));
  }
}

TEST_CASE("resume with a full disk keeps the mark of the incomplete run") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run s.toml --seed 1 --quiet --out run").exit == 0);
  write_file(f.path / "run/incomplete",
             "faba process 1\nThis run is not complete. Resume it with: faba resume run\n");
  const std::string command = "cd '" + f.path.string() +
                              "' && ulimit -f 0 && exec '" FABA_PROGRAM
                              "' resume run --quiet > /dev/null 2>&1";
  CHECK(WEXITSTATUS(std::system(command.c_str())) == 1);
  CHECK(read_file(f.path / "run/incomplete").find("This run is not complete. ") != std::string::npos);
}
